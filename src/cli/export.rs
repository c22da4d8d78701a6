//! `gotai export`: the series of recordings as CSV or Parquet.

use super::error::CliError;
use super::ghosts::REPLAYS;
use super::output::print;
use crate::files::{make_folder, write_whole};
use crate::record::read::recording_of;
use crate::record::series::tables;
use crate::record::writer::Target;
use crate::sweep::folder::Folder;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// A recording (.mcap), or a folder of results: all recordings in it
    #[arg(value_name = "FILE|DIR")]
    path: PathBuf,
    /// Kind of table
    #[arg(long, value_enum, default_value_t = Kind::Csv)]
    format: Kind,
    /// Folder for the tables [default: beside the recording]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Kind {
    Csv,
    Parquet,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        for path in self.recordings()? {
            let Some(recording) = recording_of(&path)? else {
                return Err(CliError::Input(format!(
                    "{}: expected a recording of gotai (.mcap), found another file",
                    path.display()
                )));
            };
            let beside = path.parent().unwrap_or(Path::new("."));
            let dir = self.out.as_deref().unwrap_or(beside);
            make_folder(dir)?;
            let name = path.file_stem().map_or_else(|| "recording".into(), |stem| stem.to_string_lossy());
            for table in tables(&recording).iter().filter(|table| !table.is_empty()) {
                let (ending, content) = match self.format {
                    Kind::Csv => ("csv", table.to_csv().map_err(|error| failed(&error))?),
                    Kind::Parquet => ("parquet", table.to_parquet().map_err(|error| failed(&error))?),
                };
                let file = dir.join(format!("{name}.{}.{ending}", table.name));
                write_whole(&file, &content)?;
                print(file.display());
            }
        }
        Ok(ExitCode::SUCCESS)
    }

    fn recordings(&self) -> Result<Vec<PathBuf>, CliError> {
        let path = &self.path;
        if !path.is_dir() {
            return self.recording().map(|file| vec![file]);
        }
        let folder = Folder::read(path)?;
        let rows = folder.rows();
        let names = rows.iter().filter_map(|row| row.recording.as_deref());
        let files = names.map(|name| Target::Mcap.path(path, name)).filter(|file| file.is_file());
        let files: Vec<PathBuf> = files.collect();
        match files.is_empty() {
            false => Ok(files),
            true => Err(CliError::Input(format!(
                "{}: expected recordings (.mcap), found none; make them with --record mcap, or look into {}",
                path.display(),
                path.join(REPLAYS).display()
            ))),
        }
    }

    fn recording(&self) -> Result<PathBuf, CliError> {
        let path = &self.path;
        if !path.is_file() {
            return Err(CliError::Input(format!("{}: expected a recording, found no such file", path.display())));
        }
        if path.extension().is_some_and(|ending| ending == Target::Rerun.extension()) {
            return Err(CliError::Input(format!(
                "{}: expected an .mcap, found an .rrd, whose positions are rounded; export the .mcap beside it, or \
                 record one with --record mcap",
                path.display()
            )));
        }
        Ok(path.clone())
    }
}

fn failed(error: &dyn std::error::Error) -> CliError {
    CliError::Machine(format!("cannot write a table: {error}"))
}
