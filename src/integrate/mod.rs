//! Motion without contact: one method a file. `claims` says what each promises, and the tests hold it to that.

pub mod chain;
pub mod claims;
pub mod crank_nicolson;
pub mod dop853;
pub mod dop853_tableau;
pub mod dop853_try;
pub mod drive;
pub mod euler;
pub mod field;
pub mod implicit;
pub mod implicit_midpoint;
pub mod momentum;
pub mod moser_veselov;
pub mod phase;
pub mod pin_solver;
pub mod rk4;
pub mod rotation;
pub mod taylor;
