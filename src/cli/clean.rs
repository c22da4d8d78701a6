//! `gotai clean`: drops from a folder of results what nobody needs any more.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{megabytes, print, print_json};
use crate::files;
use crate::sweep::folder::{Folder, FolderError};
use crate::sweep::journal::{JournalFile, open_alone};
use crate::sweep::unneeded::{LOCK, REPLAYS, Unneeded, size};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// A folder of results (it has plan.json)
    dir: PathBuf,
    #[command(flatten)]
    output: OutputArgs,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        if !Folder::is_one(&self.dir) {
            return Err(FolderError::NoResults(self.dir.display().to_string()).into());
        }
        // Nobody writes while it is cleaned; only then is it read.
        let (_alone, _) = JournalFile::open(&self.dir)?;
        let mut folder = Folder::read(&self.dir)?;
        let unneeded = Unneeded::of(&folder)?;
        refuse_running(&unneeded.replays)?;
        let of = |files: &[PathBuf]| (files.len(), size(files));
        let dropped = [
            ("replays", of(&unneeded.replays)),
            ("half-written or older recordings", of(&unneeded.leftovers)),
            ("recordings of other builds", of(&unneeded.recordings)),
            ("references of other builds", of(&unneeded.references)),
        ];
        unneeded.replays.iter().chain(unneeded.files()).try_for_each(|path| files::remove(path))?;
        files::remove_empty_folder(&self.dir.join(REPLAYS))?;
        if unneeded.rows + unneeded.lines > 0 {
            folder.journal.retain_build();
            folder.write_tables()?;
            JournalFile::rewrite(&self.dir, &folder.journal)?;
        }
        if self.output.json {
            print_json(&json!({
                "dir": self.dir,
                "files": dropped.iter().map(|(_, (files, _))| files).sum::<usize>(),
                "bytes": dropped.iter().map(|(_, (_, bytes))| bytes).sum::<u64>(),
                "rows": unneeded.rows, "unreadable_lines": unneeded.lines,
            }));
            return Ok(ExitCode::SUCCESS);
        }
        for (what, (files, bytes)) in dropped.into_iter().filter(|(_, (files, _))| *files > 0) {
            print(format!("dropped {files} {what}, {}", megabytes(bytes)));
        }
        if unneeded.rows > 0 {
            print(format!("dropped {} rows of other builds", unneeded.rows));
        }
        if unneeded.lines > 0 {
            print(format!("dropped {} lines of the journal that nobody can read", unneeded.lines));
        }
        if unneeded.rows + unneeded.lines == 0 && dropped.iter().all(|(_, (files, _))| *files == 0) {
            print("nothing to drop");
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Refuses where a replay that is under way holds its lock.
fn refuse_running(replays: &[PathBuf]) -> Result<(), CliError> {
    let mut locks = replays.iter().filter(|path| path.extension().is_some_and(|ending| ending == LOCK));
    Ok(locks.try_for_each(|path| open_alone(path, path).map(drop))?)
}
