//! Whether the program is asked to end: what runs looks after every step, and leaves what it has in good order.

use std::sync::atomic::{AtomicI32, Ordering};

static SIGNAL: AtomicI32 = AtomicI32::new(0);

/// Asks every run of this program to end, because of a signal.
pub fn ask(signal: i32) {
    SIGNAL.store(signal, Ordering::Relaxed);
}

/// The signal because of which runs are to end.
pub fn asked() -> Option<i32> {
    match SIGNAL.load(Ordering::Relaxed) {
        0 => None,
        signal => Some(signal),
    }
}
