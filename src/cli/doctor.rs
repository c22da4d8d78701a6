//! `gotai doctor`: what is there on this machine: the viewer and its version, Slurm, cores, space.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{Hue, megabytes, print, print_json};
use super::viewer::Viewer;
use crate::build_info::{BUILD, PROGRAM};
use crate::record::schema::RERUN_VERSION;
use crate::record::writer::Target;
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::process::{ExitCode, Stdio};

#[derive(Args)]
pub struct Command {
    /// Folder for results, of which the space is said
    #[arg(default_value = "recordings")]
    dir: PathBuf,
    #[command(flatten)]
    output: OutputArgs,
}

/// One thing that may be there.
struct Finding {
    key: &'static str,
    is_there: bool,
    said: String,
}

impl Command {
    /// Says what is there; nothing that is missing is an error.
    ///
    /// # Errors
    /// None.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let free = free_bytes(&self.dir);
        let used = bytes_below(&self.dir);
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let writes: Vec<&str> = Target::AVAILABLE.iter().map(|target| target.extension()).collect();
        let findings = [viewer(), slurm()];
        if self.output.json {
            let mut document = json!({
                "program": PROGRAM, "build": BUILD, "cores": cores, "writes": writes, "recordings_of": RERUN_VERSION,
                "dir": self.dir, "free_bytes": free, "used_bytes": used,
            });
            for Finding { key, is_there, said } in &findings {
                document[*key] = json!({ "is_there": is_there, "said": said });
            }
            print_json(&document);
            return Ok(ExitCode::SUCCESS);
        }
        print(format!("{PROGRAM}, build {BUILD}, {cores} cores; writes .{}", writes.join(" and .")));
        let is_colored = self.output.is_colored();
        for Finding { key, is_there, said } in &findings {
            let hue = if *is_there { Hue::Good } else { Hue::Doubtful };
            print(format!("{} {said}", hue.paint(&format!("{key:7}"), is_colored)));
        }
        let free = free.map_or("unknown".to_string(), megabytes);
        print(format!("space   {free} free for {}, which takes {}", self.dir.display(), megabytes(used)));
        Ok(ExitCode::SUCCESS)
    }
}

fn viewer() -> Finding {
    match Viewer::find(true) {
        Ok(viewer) => Finding { key: "viewer", is_there: true, said: viewer.to_string() },
        Err(error) => Finding { key: "viewer", is_there: false, said: error.to_string() },
    }
}

fn slurm() -> Finding {
    let said = output_of("sbatch", &["--version"]);
    let is_there = said.is_some();
    let said = said.map_or("no Slurm: `sbatch` is not on the PATH".to_string(), |said| said.trim().to_string());
    Finding { key: "slurm", is_there, said }
}

/// What a program prints, if it is there and ends well.
fn output_of(program: &str, args: &[&str]) -> Option<String> {
    let ran = std::process::Command::new(program).args(args).stdin(Stdio::null()).output().ok()?;
    ran.status.success().then(|| String::from_utf8_lossy(&ran.stdout).into_owned())
}

/// Free space where a folder is, or will be, by `df` of POSIX.
fn free_bytes(dir: &Path) -> Option<u64> {
    let whole = std::path::absolute(dir).ok()?;
    let there = whole.ancestors().find(|folder| folder.exists())?.to_str()?.to_string();
    let said = output_of("df", &["-Pk", "--", &there]).or_else(|| output_of("df", &["-Pk", &there]))?;
    let kibibytes: u64 = said.lines().nth(1)?.split_whitespace().nth(3)?.parse().ok()?;
    Some(kibibytes * 1024)
}

/// Bytes of all files below a folder; links are not followed.
fn bytes_below(dir: &Path) -> u64 {
    let mut bytes = 0;
    let mut folders = vec![dir.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            match entry.metadata() {
                Ok(about) if about.is_dir() => folders.push(entry.path()),
                Ok(about) if about.is_file() => bytes += about.len(),
                _ => {}
            }
        }
    }
    bytes
}
