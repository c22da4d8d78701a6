//! The vocabulary of `plan:`: parts of the work that are left out where a property of the scene says that they change
//! nothing. A part of `types.rs`.

use super::defaults::is_default;
use serde::{Deserialize, Serialize};
use strum::{IntoStaticStr, VariantArray};

/// How a run is made, which changes its time and not what it says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Planning {
    /// Skips that are allowed; an empty list runs the full path.
    #[serde(skip_serializing_if = "is_default")]
    pub skip: Skips,
}

/// A part of the work that is left out where a property that is checked says that it changes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Skip {
    /// Looking for contacts where nothing can touch.
    ContactTest,
    /// Points of a body against a face, and pairs of bodies, that are farther away than their bounding spheres reach.
    Bounds,
    /// Tangent rows of sweeps where no contact has friction.
    FrictionRows,
    /// The gyroscopic term of bodies whose moments of inertia are all equal.
    GyroscopicTerm,
    /// Solving contacts whose last impulses still obey the law.
    KeptImpulses,
    /// Faces of the container that bodies in flight cannot have come to yet.
    Flight,
    /// Steps of bodies at rest that would be the one before over again.
    Rest,
    /// The integrator of `event-driven` where the motion between events has a closed form.
    ClosedForms,
}

impl Skip {
    pub const ALL: &'static [Skip] = Skip::VARIANTS;

    /// Word of the skip in the file.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// Counter that shows it: the column `work_…` of what is left out, or of what is still done.
    pub fn counter(self) -> &'static str {
        match self {
            Skip::ContactTest | Skip::Bounds => "work_contact_tests",
            Skip::FrictionRows => "work_tangent_rows",
            Skip::GyroscopicTerm => "work_gyroscopic",
            Skip::KeptImpulses => "work_kept_solves",
            Skip::Flight => "work_flight_steps",
            Skip::Rest => "work_rest_steps",
            Skip::ClosedForms => "work_inner_steps",
        }
    }

    /// How far the motion with it is from the one without.
    pub fn bound(self) -> &'static str {
        match self {
            Skip::ContactTest | Skip::Bounds | Skip::Flight | Skip::Rest => "the same bits",
            Skip::FrictionRows => "to rounding; of `pgs` and `nncg` the same bits",
            Skip::GyroscopicTerm => {
                "exact; without it the method's rule errs, the implicit midpoint by (|ω|Δt)³/12 a step"
            }
            Skip::KeptImpulses => "within a hundredth of the solver's tolerance, or 1e-13 of the impulses",
            Skip::ClosedForms => "within the tolerance",
        }
    }
}

/// A set of skips; by default all that there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<Skip>", into = "Vec<Skip>")]
pub struct Skips(u32);

impl Skips {
    /// No skip at all: the full path.
    pub const NONE: Skips = Skips(0);

    pub fn has(self, skip: Skip) -> bool {
        self.0 & bit(skip) != 0
    }

    pub fn without(self, skip: Skip) -> Skips {
        Skips(self.0 & !bit(skip))
    }
}

fn bit(skip: Skip) -> u32 {
    1 << skip as u32
}

impl Default for Skips {
    fn default() -> Self {
        Skip::ALL.to_vec().into()
    }
}

impl From<Vec<Skip>> for Skips {
    fn from(listed: Vec<Skip>) -> Self {
        Skips(listed.into_iter().fold(0, |set, skip| set | bit(skip)))
    }
}

impl From<Skips> for Vec<Skip> {
    fn from(skips: Skips) -> Self {
        Skip::ALL.iter().copied().filter(|skip| skips.has(*skip)).collect()
    }
}
