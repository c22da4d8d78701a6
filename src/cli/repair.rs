//! `gotai repair`: a recording that was cut, with all that is whole of it, as a file that every reader takes.

use super::cut::{ends_at, half_written, no_recording};
use super::error::CliError;
use super::ghosts::forget;
use super::output::print;
use crate::record::mend::{Whole, mend_mcap};
use crate::record::read::{experiment_of, recording_of};
use crate::record::writer::Target;
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// A recording that was cut (.mcap or .rrd)
    file: PathBuf,
    /// The mended file [default: <name>.repaired.<ending> beside it]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The file is no recording, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let file = &self.file;
        if file.is_dir() {
            let (dir, more) = (file.display(), half_written(file));
            return Err(CliError::Input(format!("{dir}: expected a recording, found a folder{more}")));
        }
        if !file.is_file() {
            return Err(CliError::Input(format!("{}: expected a recording, found no such file", file.display())));
        }
        let ending = file.extension().map(|ending| ending.to_string_lossy().into_owned()).unwrap_or_default();
        let out = self.out.clone().unwrap_or_else(|| file.with_extension(format!("repaired.{ending}")));
        if out == *file {
            return Err(CliError::Input(format!("--out {}: expected another file than the torn one", out.display())));
        }
        let is_ours = match Target::ALL.into_iter().find(|target| target.extension() == ending) {
            Some(Target::Mcap) => experiment_of(file)?.is_some(),
            Some(Target::Rerun) => is_recording(file)?,
            None => true,
        };
        if !is_ours {
            return Err(no_recording(file));
        }
        let mended = match Target::ALL.into_iter().find(|target| target.extension() == ending) {
            Some(Target::Mcap) => mend_mcap(file, &out).inspect_err(|_| forget(&out))?,
            Some(Target::Rerun) => mend_rrd(file, &out).inspect_err(|_| forget(&out))?,
            None => {
                return Err(CliError::Input(format!(
                    "{}: expected a recording (.mcap or .rrd), found another file",
                    file.display()
                )));
            }
        };
        // Messages have the times at which they were written; what it shows ends with its last sample.
        let shown = match mended {
            Some(_) if ending == Target::Mcap.extension() => recording_of(&out)?.map(|recording| recording.until_s()),
            _ => None,
        };
        let Some(Whole { messages, until_s }) = mended.map(|mended| match shown {
            Some(until_s) => Whole { until_s, ..mended },
            None => mended,
        }) else {
            return Err(CliError::Input(format!(
                "{}: expected a recording of which something is whole, found no message of one; nothing is written",
                file.display()
            )));
        };
        print(format!("{}: {messages} messages; {}", out.display(), ends_at(until_s)));
        Ok(ExitCode::SUCCESS)
    }
}

#[cfg(feature = "rerun")]
fn is_recording(file: &Path) -> Result<bool, CliError> {
    Ok(crate::record::rerun::mend::is_recording(file)?)
}

#[cfg(not(feature = "rerun"))]
fn is_recording(_: &Path) -> Result<bool, CliError> {
    Ok(true)
}

#[cfg(feature = "rerun")]
fn mend_rrd(torn: &Path, mended: &Path) -> Result<Option<Whole>, CliError> {
    Ok(crate::record::rerun::mend::mend_rrd(torn, mended)?)
}

#[cfg(not(feature = "rerun"))]
fn mend_rrd(_: &Path, _: &Path) -> Result<Option<Whole>, CliError> {
    Err(CliError::Input("this gotai was built without Rerun (cargo feature `rerun`)".into()))
}
