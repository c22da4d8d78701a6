//! Axes → ordered plan.

pub mod axes;
