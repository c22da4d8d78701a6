//! The Rerun Viewer: where it is, whether it can show what this program writes, and starting it.

use super::error::CliError;
use super::output::say;
use crate::record::schema::RERUN_VERSION;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Names another viewer than the one on the PATH.
const VARIABLE: &str = "GOTAI_VIEWER";
/// Viewers listen for this machine alone.
const LOOPBACK: &str = "127.0.0.1";
/// The version that recordings are of.
const INSTALL: &str = "install it with `pip install rerun-sdk==0.36.3`";
/// Time in which a viewer that cannot open a window gives up.
const MOMENT: Duration = Duration::from_millis(400);

/// A viewer that can be started.
pub(super) struct Viewer {
    program: PathBuf,
    version: String,
}

impl std::fmt::Display for Viewer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Rerun Viewer {} ({})", self.version, self.program.display())
    }
}

impl Viewer {
    /// The viewer that the environment names, or the one on the PATH, of this version or a later one.
    ///
    /// # Errors
    /// There is none, or an older one.
    pub(super) fn find(quiet: bool) -> Result<Self, CliError> {
        let install = INSTALL;
        let program = match std::env::var_os(VARIABLE) {
            Some(named) => PathBuf::from(named),
            None => on_path("rerun").ok_or_else(|| {
                CliError::Machine(format!(
                    "no Rerun Viewer: `rerun` is not on the PATH; {install}, or name another one in {VARIABLE}"
                ))
            })?,
        };
        let asked = Command::new(&program).arg("--version").stdin(Stdio::null()).output();
        let told = asked.map_err(|error| {
            CliError::Machine(format!("no Rerun Viewer: cannot run {}: {error}; {install}", program.display()))
        })?;
        let text = String::from_utf8_lossy(&told.stdout).into_owned();
        let Some(version) = version_in(&text) else {
            return Err(CliError::Machine(format!(
                "{}: expected a Rerun Viewer, found a program that says no version; {install}",
                program.display()
            )));
        };
        let ours = version_in(RERUN_VERSION).unwrap_or_default();
        let shown = version.map(|part| part.to_string()).join(".");
        if version[..2] < ours[..2] {
            return Err(CliError::Machine(format!(
                "{}: the Rerun Viewer {shown} is older than these recordings ({RERUN_VERSION}); {install}",
                program.display()
            )));
        }
        if version[..2] > ours[..2] && !quiet {
            say(format!("note: the Rerun Viewer {shown} is newer than these recordings ({RERUN_VERSION})"));
        }
        Ok(Viewer { program, version: shown })
    }

    /// Starts a viewer that listens at a port of this machine.
    ///
    /// # Errors
    /// It cannot be started.
    pub(super) fn listen(&self, port: u16) -> Result<Child, CliError> {
        self.started(&["--port", &port.to_string(), "--bind", LOOPBACK])
    }

    /// Starts a viewer without a window that shows files and obeys at a port of this machine.
    ///
    /// # Errors
    /// It cannot be started.
    pub(super) fn headless(&self, files: &[PathBuf], port: u16, size: &str) -> Result<Child, CliError> {
        let port = port.to_string();
        let mut arguments = vec!["--headless", "--port", &port, "--bind", LOOPBACK, "--window-size", size];
        let files: Vec<String> = files.iter().map(|file| file.to_string_lossy().into_owned()).collect();
        arguments.extend(files.iter().map(String::as_str));
        self.started(&arguments)
    }

    /// The server that steers a viewer; it speaks JSON, a line each.
    ///
    /// # Errors
    /// It cannot be started.
    pub(super) fn steering(&self) -> Result<Child, CliError> {
        let mut command = Command::new(&self.program);
        command.arg("viewer-mcp").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        own_group(&mut command);
        command.spawn().map_err(|error| CliError::Machine(format!("{}: {error}", self.program.display())))
    }

    fn started(&self, arguments: &[&str]) -> Result<Child, CliError> {
        let mut command = Command::new(&self.program);
        command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        own_group(&mut command);
        command.spawn().map_err(|error| CliError::Machine(format!("{}: {error}", self.program.display())))
    }

    /// Opens files, and returns once the viewer runs, or, asked to wait, when it is closed.
    ///
    /// # Errors
    /// It cannot be started, or has ended at once.
    pub(super) fn open(&self, files: &[PathBuf], wait: bool) -> Result<(), CliError> {
        let failed = |reason: String| CliError::Machine(format!("{}: {reason}", self.program.display()));
        let mut command = Command::new(&self.program);
        command.args(files).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        own_group(&mut command);
        let mut child = command.spawn().map_err(|error| failed(error.to_string()))?;
        let code = if wait { child.wait().map(Some) } else { ended_within(&mut child, MOMENT) };
        match code.map_err(|error| failed(error.to_string()))? {
            Some(code) if !code.success() => {
                Err(failed(format!("the viewer has ended ({code}); it needs a display, or look at its own messages")))
            }
            _ => Ok(()),
        }
    }
}

/// Gives a program a group of processes of its own: Ctrl-C does not end it, and all of it can be ended at once.
fn own_group(command: &mut Command) {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    #[cfg(not(unix))]
    let _ = command;
}

fn ended_within(child: &mut Child, time: Duration) -> std::io::Result<Option<std::process::ExitStatus>> {
    let until = Instant::now() + time;
    loop {
        let ended = child.try_wait()?;
        if ended.is_some() || Instant::now() >= until {
            return Ok(ended);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// The first `a.b.c` of a text.
fn version_in(text: &str) -> Option<[u32; 3]> {
    let numbers = |word: &str| {
        let parts: Vec<u32> = word.split(['.', '-', '+']).take(3).map_while(|part| part.parse().ok()).collect();
        <[u32; 3]>::try_from(parts).ok()
    };
    text.split_whitespace().find_map(numbers)
}

fn on_path(name: &str) -> Option<PathBuf> {
    let path: OsString = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|file| is_program(file))
}

fn is_program(file: &Path) -> bool {
    let Ok(about) = std::fs::metadata(file) else { return false };
    #[cfg(unix)]
    let may_run = std::os::unix::fs::PermissionsExt::mode(&about.permissions()) & 0o111 != 0;
    #[cfg(not(unix))]
    let may_run = true;
    about.is_file() && may_run
}
