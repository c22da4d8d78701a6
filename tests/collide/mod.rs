//! Contact geometry of solids: planes, pairs, hulls, candidate pairs.

mod broad;
mod hulls;
mod manifolds;
pub mod oracle;
mod pairs;
mod planes;
mod resting;
