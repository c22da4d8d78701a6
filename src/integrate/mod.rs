//! Motion without contact: one method a file.

pub mod euler;
pub mod rotation;
