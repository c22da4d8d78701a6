//! Tolerances: defaults of the vocabulary, and the least that mean anything.

/// Tolerance where none is given: of the error-controlled integrators, the error of one inner step, relative and
/// absolute, in every part of the motion; of `event-driven`, the error of positions at the end, in metres.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Smallest tolerance of an inner step: below some units of rounding no estimate means anything.
pub const SMALLEST_TOLERANCE: f64 = 1e-15;

/// Smallest tolerance of a whole motion with events, in metres.
pub const SMALLEST_GLOBAL: f64 = 1e-13;
