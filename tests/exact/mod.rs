//! Closed forms against references of more digits.

mod free_rotation;
mod point;
