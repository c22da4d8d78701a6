//! Numerics that know numbers alone: linear systems, roots, elliptic functions, quadrature, statistics.

pub mod block_lu;
pub mod broyden;
pub mod dd;
pub mod elliptic;
pub mod few;
pub mod full_pivot;
pub mod interval;
pub mod least_norm;
pub mod lemke;
pub mod lu6;
pub mod newton;
pub mod not_negative;
pub mod order;
pub mod quadrature;
pub mod six;
pub mod trend;
