//! Columns of a row: their names.

/// The vectors of a state and their components.
pub const STATE: [(&str, &[&str]); 4] = [
    ("position_m", &["x", "y", "z"]),
    ("orientation_xyzw", &["x", "y", "z", "w"]),
    ("velocity_m_s", &["x", "y", "z"]),
    ("angular_velocity_rad_s", &["x", "y", "z"]),
];
