//! `gotai export`: the series of recordings as CSV or Parquet.

use super::cut::{half_written, no_recording, warn_of_end};
use super::error::CliError;
use super::ghosts::REPLAYS;
use super::output::{print, say};
use crate::files::{FileError, make_folder, write_whole};
use crate::record::read::{ReadBack, recording_of};
use crate::record::series::{SeriesTable, TABLES, tables};
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
    /// Take an .rrd too, whose positions are rounded and which has no velocities, no contacts' numbers
    #[arg(long)]
    rounded: bool,
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
        // One that holds nothing keeps no other one from its tables.
        let mut first = Ok(ExitCode::SUCCESS);
        for path in self.recordings()? {
            match self.export(&path) {
                Err(error @ CliError::Input(_)) if first.is_ok() => first = Err(error),
                Err(CliError::Input(more)) => say(format!("gotai: {more}")),
                done => done?,
            }
        }
        first
    }

    fn export(&self, path: &Path) -> Result<(), CliError> {
        let beside = path.parent().unwrap_or(Path::new("."));
        let dir = self.out.as_deref().unwrap_or(beside);
        let name = path.file_stem().map_or_else(|| "recording".into(), |stem| stem.to_string_lossy());
        let ending = match self.format {
            Kind::Csv => "csv",
            Kind::Parquet => "parquet",
        };
        let file_of = |table: &str| dir.join(format!("{name}.{table}.{ending}"));
        let found = if is_rrd(path) { rounded(path)? } else { recording_of(path)? };
        let made: Vec<SeriesTable> = found.iter().flat_map(tables).filter(|table| !table.is_empty()).collect();
        // Older tables that this file does not make anew would stand as if they were of it.
        for table in TABLES.iter().filter(|name| made.iter().all(|table| table.name != **name)) {
            put_aside(&file_of(table))?;
        }
        let Some(recording) = found else { return Err(no_recording(path)) };
        if made.is_empty() {
            return Err(CliError::Input(format!(
                "{}: expected a recording with samples, found none that is whole",
                path.display()
            )));
        }
        warn_of_end(path, &recording);
        make_folder(dir)?;
        for table in made {
            let content = match self.format {
                Kind::Csv => table.to_csv().map_err(|error| failed(&error))?,
                Kind::Parquet => table.to_parquet().map_err(|error| failed(&error))?,
            };
            let file = file_of(table.name);
            write_whole(&file, &content)?;
            print(file.display());
        }
        Ok(())
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
            true => {
                let replays = path.join(REPLAYS);
                let look = match replays.is_dir() {
                    true => format!(", or look into {}", replays.display()),
                    false => String::new(),
                };
                Err(CliError::Input(format!(
                    "{}: expected recordings (.mcap), found none{}; make them with --record mcap{look}",
                    path.display(),
                    half_written(path)
                )))
            }
        }
    }

    fn recording(&self) -> Result<PathBuf, CliError> {
        let path = &self.path;
        if !path.is_file() {
            return Err(CliError::Input(format!("{}: expected a recording, found no such file", path.display())));
        }
        if is_rrd(path) && !self.rounded {
            // A file that is none would not be one with --rounded.
            let cut = cut_rrd(path)?;
            return Err(CliError::Input(format!(
                "{}: expected an .mcap, found an .rrd{cut}, whose positions are rounded; export the .mcap beside it, \
                 record one with --record mcap, or take what there is with --rounded",
                path.display()
            )));
        }
        Ok(path.clone())
    }
}

fn is_rrd(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == Target::Rerun.extension())
}

/// What is to be said of an .rrd of ours that was cut.
///
/// # Errors
/// It is none, or was cut in its head.
#[cfg(feature = "rerun")]
fn cut_rrd(path: &Path) -> Result<&'static str, CliError> {
    use crate::record::rerun::mend::{is_cut, is_recording};
    if !is_recording(path)? {
        return Err(no_recording(path));
    }
    Ok(if is_cut(path)? { " that was cut" } else { "" })
}

#[cfg(not(feature = "rerun"))]
fn cut_rrd(_: &Path) -> Result<&'static str, CliError> {
    Ok("")
}

/// What an .rrd of ours shows.
#[cfg(feature = "rerun")]
fn rounded(path: &Path) -> Result<Option<ReadBack>, CliError> {
    use crate::record::rerun::{mend, rounded};
    if !mend::is_recording(path)? {
        return Ok(None);
    }
    let cut = mend::is_cut(path)?;
    Ok(rounded::rounded(path)?.map(|found| ReadBack {
        is_cut: cut,
        // The end of the run is in its page, which is no number.
        said: [("outcome".to_string(), String::new())].into(),
        ..found
    }))
}

#[cfg(not(feature = "rerun"))]
fn rounded(_: &Path) -> Result<Option<ReadBack>, CliError> {
    Err(CliError::Input("this gotai was built without Rerun (cargo feature `rerun`)".into()))
}

/// Gives an older table another name, and says so.
fn put_aside(file: &Path) -> Result<(), CliError> {
    if !file.is_file() {
        return Ok(());
    }
    let ending = file.extension().map(|ending| ending.to_string_lossy().into_owned()).unwrap_or_default();
    let aside = file.with_extension(format!("{ending}.old"));
    std::fs::rename(file, &aside).map_err(|error| FileError::new(&aside, error))?;
    say(format!("warning: {}: an older table, not of this file; it is now {}", file.display(), aside.display()));
    Ok(())
}

fn failed(error: &dyn std::error::Error) -> CliError {
    CliError::Machine(format!("cannot write a table: {error}"))
}
