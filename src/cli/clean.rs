//! `gotai clean`: drops from a folder of results what nobody needs any more.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{megabytes, print, print_json};
use crate::files;
use crate::sweep::folder::Folder;
use crate::sweep::journal::JournalFile;
use crate::sweep::unneeded::{Unneeded, size};
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
    pub fn run(self) -> Result<ExitCode, CliError> {
        let mut folder = Folder::read(&self.dir)?;
        // Nobody writes while it is cleaned.
        let (_alone, _) = JournalFile::open(&self.dir)?;
        let unneeded = Unneeded::of(&folder)?;
        let of = |files: &[PathBuf]| (files.len(), size(files));
        let dropped = [
            ("replays", of(&unneeded.replays)),
            ("half-written or older recordings", of(&unneeded.leftovers)),
            ("recordings of other builds", of(&unneeded.recordings)),
            ("references of other builds", of(&unneeded.references)),
        ];
        unneeded.replays.iter().chain(unneeded.files()).try_for_each(|path| files::remove(path))?;
        files::remove_empty_folder(&self.dir.join("replays"))?;
        folder.journal.retain_build();
        folder.write_tables()?;
        JournalFile::rewrite(&self.dir, &folder.journal)?;
        if self.output.json {
            print_json(&json!({
                "dir": self.dir,
                "files": dropped.iter().map(|(_, (files, _))| files).sum::<usize>(),
                "bytes": dropped.iter().map(|(_, (_, bytes))| bytes).sum::<u64>(),
                "rows": unneeded.rows,
            }));
            return Ok(ExitCode::SUCCESS);
        }
        for (what, (files, bytes)) in dropped.into_iter().filter(|(_, (files, _))| *files > 0) {
            print(format!("dropped {files} {what}, {}", megabytes(bytes)));
        }
        if unneeded.rows > 0 {
            print(format!("dropped {} rows of other builds", unneeded.rows));
        }
        if unneeded.rows == 0 && dropped.iter().all(|(_, (files, _))| *files == 0) {
            print("nothing to drop");
        }
        Ok(ExitCode::SUCCESS)
    }
}
