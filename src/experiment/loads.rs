//! The vocabulary of what acts on bodies beside gravity and contact: `forces:`, `air:`, `pins:`, and bodies that move
//! as they are told. A part of `types.rs`.

use super::defaults::is_default;
use serde::{Deserialize, Serialize};

/// A force, a torque or both on one body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Force {
    pub body: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_n: Option<[f64; 3]>,
    /// Torque about the centre of mass, beside what the force exerts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_n_m: Option<[f64; 3]>,
    /// Point where the force acts, in the body frame; where absent, the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_m: Option<[f64; 3]>,
    /// Frame that the components are in.
    #[serde(default)]
    pub frame: Frame,
    #[serde(default, rename = "as")]
    pub course: Course,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Frame {
    #[default]
    World,
    Body,
}

/// Course of a force with time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Course {
    #[default]
    Constant,
    /// A harmonic course F cos(ωt + φ).
    Cosine(Cosine),
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cosine {
    /// Frequency ω.
    pub frequency_rad_s: f64,
    #[serde(default)]
    pub phase_rad: f64,
}

/// Resistance to every body's motion, at its centre of mass, without torque.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Air {
    #[serde(default, skip_serializing_if = "is_default")]
    pub density_kg_m3: f64,
    /// Coefficient C of ½ ρ C A |v| v, with a quarter of the body's surface as A: the mean over all attitudes of a
    /// convex body's silhouette (Cauchy), of a sphere always π r².
    #[serde(default, skip_serializing_if = "is_default")]
    pub drag_coefficient: f64,
    /// Coefficient c of c v, of every body (Stokes).
    #[serde(default, skip_serializing_if = "is_default")]
    pub linear_drag_n_s_m: f64,
}

/// A ball joint (L17): a point of a body stays where it is at the start, in the world or on another body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pin {
    pub body: String,
    /// Pinned point in the body frame.
    pub point_m: [f64; 3],
    /// Name of the other body; where absent, the pin is on the world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub with: Option<String>,
}

/// Constant velocities of a body, whatever acts on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Kinematic {
    /// Velocity of the centre of mass, world frame.
    pub velocity_m_s: [f64; 3],
    /// Angular velocity, world frame.
    pub angular_velocity_rad_s: [f64; 3],
}
