//! Checks of one value: its bounds, and the message where it is outside.

use super::error::{ExperimentError, number};
use super::key_path::Path;
use super::tolerances::SMALLEST_GLOBAL;

pub(super) type Result<T> = std::result::Result<T, ExperimentError>;

pub(super) fn unexpected(at: Path, expected: &str, found: &str) -> ExperimentError {
    ExperimentError::unexpected(at.to_key_path(), expected, found)
}

/// Text «a, b and c».
pub(super) fn series(items: &[impl AsRef<str>], last: &str) -> String {
    let items: Vec<&str> = items.iter().map(AsRef::as_ref).collect();
    match &items[..] {
        [first @ .., end] if !first.is_empty() => format!("{} {last} {end}", first.join(", ")),
        _ => items.concat(),
    }
}

/// Words of the file as part of a sentence.
pub(super) fn listed(words: impl Iterator<Item = &'static str>) -> String {
    series(&words.map(|word| format!("`{word}`")).collect::<Vec<_>>(), "and")
}

pub(super) fn positive(x: f64, at: Path) -> Result<()> {
    if x > 0.0 { Ok(()) } else { Err(unexpected(at, "a number greater than 0", &number(x))) }
}

pub(super) fn not_negative(x: f64, at: Path) -> Result<()> {
    if x >= 0.0 { Ok(()) } else { Err(unexpected(at, "a number of at least 0", &number(x))) }
}

/// Checks a coefficient of restitution.
pub(super) fn a_part(x: f64, at: Path) -> Result<()> {
    if (0.0..=1.0).contains(&x) { Ok(()) } else { Err(unexpected(at, "a number from 0 to 1", &number(x))) }
}

pub(super) fn at_least_one(n: u32, at: Path) -> Result<()> {
    if n >= 1 { Ok(()) } else { Err(unexpected(at, "a whole number of at least 1", &n.to_string())) }
}

/// Checks a relaxation; outside of these bounds no sweep converges.
pub(super) fn relaxation(x: f64, at: Path) -> Result<()> {
    if x > 0.0 && x < 2.0 { Ok(()) } else { Err(unexpected(at, "a number between 0 and 2", &number(x))) }
}

pub(super) fn holds_a_face(contacts: u32, at: Path) -> Result<()> {
    let expected = "a whole number of at least 3, as fewer contacts hold no face";
    if contacts >= 3 { Ok(()) } else { Err(unexpected(at, expected, &contacts.to_string())) }
}

/// Checks a tolerance of the whole motion.
pub(super) fn reachable(tolerance: f64, at: Path) -> Result<()> {
    if tolerance >= SMALLEST_GLOBAL {
        return Ok(());
    }
    let expected = format!(
        "a number of at least {SMALLEST_GLOBAL:e}: positions of some metres are known to 1e-16 of them, and events to \
         some hundred times that"
    );
    Err(unexpected(at, &expected, &number(tolerance)))
}

pub(super) fn sizes(sizes: &[f64; 3], at: Path) -> Result<()> {
    sizes.iter().enumerate().try_for_each(|(i, size)| positive(*size, at.item(i, None)))
}

pub(super) fn direction(v: &[f64], at: Path) -> Result<()> {
    let is_zero = v.iter().all(|x| *x == 0.0);
    if is_zero { Err(unexpected(at, "a direction", "the zero vector")) } else { Ok(()) }
}
