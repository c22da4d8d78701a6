//! Tolerances: defaults of the vocabulary, and the least that mean anything.

/// Of the error-controlled integrators: error of one inner step, relative and absolute, in every part of the motion.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Below some units of rounding no estimate means anything.
pub const SMALLEST_TOLERANCE: f64 = 1e-15;

/// Of a whole motion with events.
pub const SMALLEST_GLOBAL: f64 = 1e-13;
