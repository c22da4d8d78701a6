//! Motion without contact: one method a file. `claims` says what each promises, and the tests hold it to that.

pub mod broyden;
pub mod claims;
pub mod crank_nicolson;
pub mod dop853;
pub mod dop853_tableau;
pub mod euler;
pub mod field;
pub mod implicit;
pub mod implicit_midpoint;
pub mod island;
pub mod momentum;
pub mod moser_veselov;
pub mod newton;
pub mod phase;
pub mod pin_solver;
pub mod rk4;
pub mod rotation;
pub mod taylor;

/// Of the error-controlled integrators: error of one inner step, relative and absolute, in every part of the motion.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Below some units of rounding no estimate means anything.
pub const SMALLEST_TOLERANCE: f64 = 1e-15;

/// Of a whole motion with events.
pub const SMALLEST_GLOBAL: f64 = 1e-13;
