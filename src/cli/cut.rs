//! What is said of a recording that was cut, and of a file that is none.

use super::error::CliError;
use super::output::say;
use crate::files::quoted;
use crate::record::read::ReadBack;
use crate::record::story::shortest;
use crate::sweep::leftovers::partial;
use std::path::Path;

/// Says on stderr that a file has lost its end, where it ends now, and what helps.
pub(super) fn warn_of_cut(path: &Path, until_s: Option<f64>) {
    let path = path.display().to_string();
    let command = format!("gotai repair {}", quoted(&path));
    say(format!("warning: {path}: the file was cut; {}; `{command}` gives it an end", ends_at(until_s)));
}

/// The same of a recording that was read, and of a mended one, whose run has no end in it.
pub(super) fn warn_of_end(path: &Path, recording: &ReadBack) {
    let until_s = recording.until_s();
    if recording.is_cut {
        warn_of_cut(path, until_s);
    } else if !recording.said.contains_key("outcome") {
        let path = path.display();
        say(format!("warning: {path}: the end of the run is not in this recording; {}", ends_at(until_s)));
    }
}

/// The recordings in a folder that a kill has left half written, and what helps; nothing where there are none.
pub(super) fn half_written(dir: &Path) -> String {
    let found = partial(dir).unwrap_or_default();
    let mends: Vec<String> =
        found.iter().map(|path| format!("`gotai repair {}`", quoted(&path.display().to_string()))).collect();
    match mends.len() {
        0 => String::new(),
        1 => format!("; one was cut while it was written: {} mends it", mends[0]),
        n => format!("; {n} were cut while they were written: {} mends one, and so on", mends[0]),
    }
}

pub(super) fn ends_at(until_s: Option<f64>) -> String {
    until_s.map_or("it holds no sample".to_string(), |until_s| format!("it ends at t = {} s", shortest(until_s)))
}

/// A file with the name of a recording that is none, or in which nothing is whole.
pub(super) fn no_recording(path: &Path) -> CliError {
    CliError::Input(format!(
        "{}: expected a recording of gotai, found another file, or one that was cut in its head",
        path.display()
    ))
}
