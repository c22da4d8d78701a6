//! Contact solvers: a `ContactProblem` (plain data) becomes impulses, one method a file, each owning its scratch.

mod active_set;
pub mod auto;
pub mod block;
mod complementary;
mod coupling;
pub mod end;
pub mod exact_contact;
pub mod gains;
pub mod gauss_seidel;
pub mod impact;
mod impulse;
mod interior;
pub mod island;
mod kept;
pub mod law;
pub mod missed;
mod modes;
pub mod newton;
pub mod nncg;
pub mod pins;
pub mod position;
pub mod problem;
mod proximal;
mod slope;
pub mod smallest;
pub mod solver;
mod speeds;
pub mod start;
pub mod twist;

pub use impulse::{Impulse, corrected, slips};
