//! `gotai view`: opens recordings in the Rerun Viewer; several cases as ghosts, on one timeline.

use super::cut::{half_written, no_recording, warn_of_end};
use super::error::CliError;
use super::frames::FilmArgs;
use super::ghosts::{self, Ghosts};
use super::output::say;
use super::rows::{filter, takes};
use super::viewer::Viewer;
use crate::record::name::RecordingName;
use crate::record::read::recording_of;
use crate::record::writer::Target;
use crate::rows::Row;
use crate::rows::table::Table;
use crate::sweep::folder::Folder;
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// Recordings (.rrd, .mcap), or a folder of results (it has plan.json)
    #[arg(required = true, value_name = "FILE|DIR")]
    paths: Vec<PathBuf>,
    /// Only rows of a folder of which this holds: COLUMN=VALUE, or another sign: != < <= > >=
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
    filters: Vec<String>,
    /// Return when the viewer is closed, not when it runs
    #[arg(long, conflicts_with_all = ["gif", "frames"])]
    wait: bool,
    /// Write what the viewer shows as a moving picture, and open no window
    #[arg(long, value_name = "FILE")]
    gif: Option<PathBuf>,
    /// Write what the viewer shows as PNGs into a folder, and open no window
    #[arg(long, value_name = "DIR")]
    frames: Option<PathBuf>,
    #[command(flatten)]
    film: FilmArgs,
    /// Nothing on stderr but warnings and errors
    #[arg(long)]
    quiet: bool,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, there is no viewer, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let files = self.files()?;
        let viewer = Viewer::find(self.quiet)?;
        if self.gif.is_some() || self.frames.is_some() {
            let [file] = files.as_slice() else {
                return Err(CliError::Input(
                    "--gif, --frames: expected one recording, or .mcap files of several".into(),
                ));
            };
            self.film.make(&viewer, file, self.gif.as_deref(), self.frames.as_deref(), self.quiet)?;
            return Ok(ExitCode::SUCCESS);
        }
        if !self.quiet {
            for file in &files {
                say(format!("opening {}", file.display()));
            }
        }
        viewer.open(&files, self.wait)?;
        Ok(ExitCode::SUCCESS)
    }

    /// The files that are opened: what is given, or one that is made of several cases.
    fn files(&self) -> Result<Vec<PathBuf>, CliError> {
        match self.paths.as_slice() {
            [dir] if dir.is_dir() => Ok(vec![self.of_folder(dir)?]),
            paths => {
                if !self.filters.is_empty() {
                    return Err(CliError::Input("--where: expected a folder of results with it, found files".into()));
                }
                of_files(paths)
            }
        }
    }

    fn of_folder(&self, dir: &Path) -> Result<PathBuf, CliError> {
        let folder = Folder::read(dir)?;
        let rows = folder.rows();
        let table = Table::new(&folder.plan.axes, &rows);
        let known: Vec<&str> = table.names().collect();
        let filter = filter(&self.filters, &known, &folder.plan)?;
        let chosen: Vec<&Row> =
            rows.iter().zip(table.rows()).filter(|(_, cells)| takes(&filter, cells)).map(|(row, _)| row).collect();
        match chosen.as_slice() {
            [] if filter.0.is_empty() => Err(CliError::Input(format!(
                "{}: expected a row to show, found none of {} planned{}",
                dir.display(),
                folder.plan.rows,
                half_written(dir)
            ))),
            [] => Err(CliError::Input(format!(
                "{}: expected a row to show, found none of {} that --where takes",
                dir.display(),
                rows.len()
            ))),
            [row] => {
                let file = ghosts::recording_of_row(&folder, row, &Target::ALL)?;
                shown(file, &dir.join(ghosts::REPLAYS))
            }
            several if several.len() > Ghosts::MOST => Err(CliError::Input(format!(
                "{}: expected at most {} rows to show together, found {}; choose with --where, or give a file",
                dir.display(),
                Ghosts::MOST,
                several.len()
            ))),
            several => Ghosts::of_rows(&folder, several)?.write(&dir.join(ghosts::REPLAYS)),
        }
    }
}

/// One file as it is; several .mcap as ghosts; an .rrd stands for the .mcap beside it.
fn of_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, CliError> {
    for path in paths {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        if !Target::ALL.iter().any(|target| target.extension() == ending) {
            return Err(CliError::Input(format!(
                "{}: expected a recording (.rrd or .mcap) or a folder of results",
                path.display()
            )));
        }
        if !path.is_file() {
            return Err(CliError::Input(format!("{}: expected a recording, found no such file", path.display())));
        }
        let is_mcap = ending == Target::Mcap.extension();
        if is_mcap { check_mcap(path)? } else { check_rrd(path)? }
    }
    let beside = |path: &PathBuf, target: Target| {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned())?;
        let file = target.path(path.parent()?, &name);
        // What is being written has no name of its own yet.
        (RecordingName::values_of(&name).is_some() || &file == path).then_some(file).filter(|file| file.is_file())
    };
    if let [path] = paths {
        let dir = path.parent().unwrap_or(Path::new("."));
        return match beside(path, Target::Rerun) {
            Some(file) => Ok(vec![file]),
            None => Ok(vec![shown(path.clone(), dir)?]),
        };
    }
    if paths.len() > Ghosts::MOST {
        return Err(CliError::Input(format!("expected at most {} files, found {}", Ghosts::MOST, paths.len())));
    }
    let sources: Option<Vec<PathBuf>> = paths.iter().map(|path| beside(path, Target::Mcap)).collect();
    match sources {
        Some(sources) => {
            let dir = paths[0].parent().unwrap_or(Path::new(".")).to_path_buf();
            Ok(vec![Ghosts::of_files(&sources)?.write(&ghosts::writable(&dir))?])
        }
        // The viewer shows them one after the other.
        None => Ok(paths.to_vec()),
    }
}

/// What shows a file as a recording opens: of an .mcap, which is numbers to a viewer, an .rrd in a folder.
fn shown(file: PathBuf, dir: &Path) -> Result<PathBuf, CliError> {
    let is_mcap = file.extension().is_some_and(|ending| ending == Target::Mcap.extension());
    if is_mcap && Target::AVAILABLE.contains(&Target::Rerun) {
        return Ghosts::of_files(&[file])?.write_whole(&ghosts::writable(dir));
    }
    Ok(file)
}

/// An .mcap of ours, with a warning if it was cut.
fn check_mcap(path: &Path) -> Result<(), CliError> {
    let Some(recording) = recording_of(path)? else { return Err(no_recording(path)) };
    warn_of_end(path, &recording);
    Ok(())
}

/// An .rrd of ours, with a warning if it was cut.
#[cfg(feature = "rerun")]
fn check_rrd(path: &Path) -> Result<(), CliError> {
    use crate::record::rerun::mend::{is_cut, is_recording, whole_of};
    if !is_recording(path)? {
        return Err(no_recording(path));
    }
    if is_cut(path)? {
        super::cut::warn_of_cut(path, whole_of(path)?.and_then(|whole| whole.until_s));
    }
    Ok(())
}

/// Without Rerun, what begins like an .rrd is one.
#[cfg(not(feature = "rerun"))]
fn check_rrd(path: &Path) -> Result<(), CliError> {
    if crate::files::read(path)?.starts_with(b"RRF2") { Ok(()) } else { Err(no_recording(path)) }
}
