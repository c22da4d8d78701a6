//! Messages of caught panics.

use std::any::Any;

/// The message of `panic!`, whichever kind of text it was given.
pub fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or(panic.downcast_ref::<&str>().copied()).unwrap_or("panic without a message")
}
