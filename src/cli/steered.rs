//! A viewer without a window that is steered: any instant of a recording as a picture. It obeys `rerun viewer-mcp`,
//! which comes with it and speaks JSON-RPC, a line each.

use super::error::CliError;
use super::viewer::Viewer;
use crate::record::schema;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command};
use std::time::{Duration, Instant};

/// Time in which a viewer comes up and reads its files.
const PATIENCE: Duration = Duration::from_secs(60);
/// Frames of the viewer until what has changed is drawn.
const SETTLING: u32 = 12;

/// A headless viewer, and the server that steers it.
pub(super) struct Steered {
    viewer: Child,
    server: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    asked: u64,
}

impl Steered {
    /// Shows a file in a window of this size that nobody sees, once all of it is read: a large one takes seconds, and
    /// its end, if it has one, comes last.
    ///
    /// # Errors
    /// There is no driver of Vulkan's, or another reason why the viewer does not come up.
    pub(super) fn open(
        viewer: &Viewer,
        file: &Path,
        [width, height]: [u32; 2],
        has_end: bool,
    ) -> Result<Self, CliError> {
        let free = TcpListener::bind(("127.0.0.1", 0)).and_then(|socket| socket.local_addr());
        let port = free.map_err(|error| CliError::Machine(format!("no free port: {error}")))?.port();
        let child = viewer.headless(&[PathBuf::from(file)], port, &format!("{width}x{height}"))?;
        let mut server = viewer.steering()?;
        let (Some(to), Some(from)) = (server.stdin.take(), server.stdout.take()) else {
            return Err(CliError::Machine("the server of the viewer has no pipes".into()));
        };
        let mut steered = Steered { viewer: child, server, to, from: BufReader::new(from), asked: 0 };
        let about = json!({
            "protocolVersion": "2024-11-05", "capabilities": {},
            "clientInfo": { "name": "gotai", "version": env!("CARGO_PKG_VERSION") },
        });
        steered.ask("initialize", about)?;
        steered.send(&json!({ "jsonrpc": "2.0", "method": "notifications/initialized" }))?;
        steered.until("connect", &json!({ "endpoint": format!("http://127.0.0.1:{port}") }), |_| true)?;
        steered.until("viewer_state", &json!({}), |text| text.contains("gotai"))?;
        let is_open: fn(&str) -> bool = if has_end { tells_the_end } else { |text| text.contains(schema::PAGE) };
        steered.until("query_tree", &json!({}), is_open)?;
        steered.call("wait_for", &json!({ "min_steps": 2 * SETTLING }))?;
        Ok(steered)
    }

    /// Writes what is shown at a time as a PNG.
    ///
    /// # Errors
    /// The viewer has ended, or the file cannot be written.
    pub(super) fn picture(&mut self, time_s: f64, file: &Path) -> Result<(), CliError> {
        self.must("set_time", &json!({ "time": (time_s * 1e9).round() as i64 }))?;
        self.must("wait_for", &json!({ "min_steps": SETTLING }))?;
        let place = std::path::absolute(file).unwrap_or_else(|_| file.to_path_buf());
        self.must("screenshot", &json!({ "save_path": place, "pixels_per_point": 1 }))?;
        if place.is_file() { Ok(()) } else { Err(CliError::Machine(format!("{}: no picture came", file.display()))) }
    }

    fn must(&mut self, tool: &str, arguments: &Value) -> Result<(), CliError> {
        match self.call(tool, arguments)? {
            (true, _) => Ok(()),
            (false, text) => Err(CliError::Machine(format!("the viewer refuses to {tool}: {text}"))),
        }
    }

    fn until(&mut self, tool: &str, arguments: &Value, is_good: fn(&str) -> bool) -> Result<(), CliError> {
        let end = Instant::now() + PATIENCE;
        loop {
            let (is_fine, text) = self.call(tool, arguments)?;
            if is_fine && is_good(&text) {
                return Ok(());
            }
            if let Ok(Some(code)) = self.viewer.try_wait() {
                return Err(CliError::Machine(format!(
                    "the headless viewer has ended ({code}); it needs a driver of Vulkan's, e.g. mesa-vulkan-drivers"
                )));
            }
            if Instant::now() >= end {
                return Err(CliError::Machine(format!("the viewer did not come to {tool}: {text}")));
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    fn call(&mut self, tool: &str, arguments: &Value) -> Result<(bool, String), CliError> {
        let answer = self.ask("tools/call", json!({ "name": tool, "arguments": arguments }))?;
        let is_fine = answer["result"].is_object() && answer["result"]["isError"] != json!(true);
        Ok((is_fine, answer["result"]["content"].to_string()))
    }

    fn ask(&mut self, method: &str, params: Value) -> Result<Value, CliError> {
        self.asked += 1;
        self.send(&json!({ "jsonrpc": "2.0", "id": self.asked, "method": method, "params": params }))?;
        let mut line = String::new();
        loop {
            line.clear();
            let read = self.from.read_line(&mut line).map_err(|error| lost(&error))?;
            if read == 0 {
                return Err(CliError::Machine("the server of the viewer has ended".into()));
            }
            if let Ok(answer) = serde_json::from_str::<Value>(&line)
                && answer["id"] == json!(self.asked)
            {
                return Ok(answer);
            }
        }
    }

    fn send(&mut self, message: &Value) -> Result<(), CliError> {
        writeln!(self.to, "{message}").and_then(|()| self.to.flush()).map_err(|error| lost(&error))
    }
}

/// Whether the page of a run that has ended is shown, by its title: `Finished at t = 2 s: …`.
fn tells_the_end(text: &str) -> bool {
    let word_before = |end: usize| text[..end].rsplit(|c: char| !c.is_alphabetic()).next().unwrap_or_default();
    text.match_indices(" at t = ").any(|(i, _)| word_before(i).starts_with(char::is_uppercase))
}

impl Drop for Steered {
    fn drop(&mut self) {
        for child in [&mut self.server, &mut self.viewer] {
            // `rerun` starts the viewer as a child of its own: the whole group is ended.
            let group = format!("-{}", child.id());
            let ended = Command::new("kill").args(["-TERM", "--", &group]).status();
            if !ended.is_ok_and(|code| code.success()) {
                let _ = child.kill();
            }
            let _ = child.wait();
        }
    }
}

fn lost(error: &std::io::Error) -> CliError {
    CliError::Machine(format!("the viewer no longer answers: {error}"))
}
