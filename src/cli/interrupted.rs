//! Signals during one run: it ends after its step, what it has recorded is written and closed, and the exit code says
//! which signal it was.

use super::error::CliError;
use super::output::say;
use crate::interrupt;
use crate::record::story::shortest;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::process::ExitCode;
use std::time::Duration;

/// Time that a step and what is to be written may take.
const GRACE: Duration = Duration::from_secs(30);

/// Listens for Ctrl-C and SIGTERM from now on; a second one ends the program at once.
///
/// # Errors
/// The machine lets nobody listen.
pub(super) fn listen() -> Result<(), CliError> {
    let signals = Signals::new([SIGINT, SIGTERM]);
    let mut signals = signals.map_err(|error| CliError::Machine(format!("cannot listen for signals: {error}")))?;
    std::thread::spawn(move || {
        for signal in signals.forever() {
            if interrupt::asked().is_some() {
                std::process::exit(128 + signal);
            }
            interrupt::ask(signal);
            std::thread::spawn(move || {
                std::thread::sleep(GRACE);
                std::process::exit(128 + signal);
            });
        }
    });
    Ok(())
}

/// Exit code of a run that was interrupted at a time, which it says; None of another one.
pub(super) fn code(time_s: f64) -> Option<ExitCode> {
    let signal = interrupt::asked()?;
    say(format!("interrupted at t = {} s: no row is kept, what was recorded is", shortest(time_s)));
    Some(ExitCode::from(128 + u8::try_from(signal).unwrap_or(0)))
}
