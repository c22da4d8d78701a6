//! Taylor's series of the motion, as many terms as the tolerance asks for (A. Jorba, M. Zou, Exp. Math. 14 (2005) 99).
//!
//! Without the air's |v| v the equations are made of sums and products, so that coefficients follow from coefficients
//! (`tape`, `equations`). An expansion serves every step of the clock that ends within its reach: it is its own dense
//! output.

mod equations;
mod invariants;
mod series;
mod tape;

pub use series::Taylor;
