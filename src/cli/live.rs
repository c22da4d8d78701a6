//! `run --live`: a viewer that shows a run while it goes on. The run goes on without one.

use super::output::say;
use std::time::{Duration, Instant};

/// Time in which a viewer that is started listens.
#[cfg(feature = "rerun")]
const START: Duration = Duration::from_secs(15);

/// The port of a viewer that listens, which is started where none does; None, and a note, where there is none.
#[cfg(feature = "rerun")]
pub(super) fn viewer(port: u16, quiet: bool) -> Option<u16> {
    use super::viewer::Viewer;
    use crate::record::rerun::live::is_there;
    if is_there(port) {
        return Some(port);
    }
    let without = |reason: String| {
        say(format!("note: --live: {reason}; the run goes on without a viewer"));
        None
    };
    let started = Viewer::find(quiet).and_then(|viewer| viewer.listen(port));
    let mut child = match started {
        Ok(child) => child,
        Err(error) => return without(error.to_string()),
    };
    let until = Instant::now() + START;
    while !is_there(port) {
        if let Ok(Some(code)) = child.try_wait() {
            return without(format!("the viewer has ended ({code}); it needs a display"));
        }
        if Instant::now() >= until {
            return without(format!("the viewer does not listen at port {port}"));
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Some(port)
}

#[cfg(not(feature = "rerun"))]
pub(super) fn viewer(_: u16, _: bool) -> Option<u16> {
    say("note: --live: this gotai was built without Rerun; the run goes on without a viewer");
    None
}

/// Says that a viewer is no longer there at the end of the run.
pub(super) fn say_if_gone(port: u16) {
    #[cfg(feature = "rerun")]
    if !crate::record::rerun::live::is_there(port) {
        say(format!("note: the viewer at port {port} is gone; the run went on without it"));
    }
    #[cfg(not(feature = "rerun"))]
    let _ = port;
}
