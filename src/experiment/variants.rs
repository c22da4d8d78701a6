//! The words that settings of a method choose from. A part of `method.rs`.

use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// First guess of the constraint force (L20).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// F = 0.
    None,
    /// F = −A⁻¹ b by LU; a non-finite start is replaced by 0.
    Direct,
    /// The same with the inverse matrix.
    Inverse,
    /// The same with the Moore–Penrose inverse.
    PseudoInverse,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Iteration {
    /// The printed formula.
    Jacobi,
    /// In place.
    GaussSeidel,
}

/// When forces are put back into the friction cone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Correction {
    /// All contacts, once a sweep.
    AfterSweep,
    /// Right after the contact's three rows: this is projected Gauss–Seidel.
    PerContact,
}

/// What |f_c2, f_c3| < μ |f_c1| bounds (L19).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cone {
    /// The length of (f₂, f₃): Coulomb's law.
    #[default]
    Disc,
    /// f₂ and f₃ each, as the line can be read: up to √2 times the friction, by the direction.
    Box,
}

/// Which velocity moves the position (L5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Update {
    Explicit,
    #[default]
    SemiImplicit,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rotation {
    /// I dω/dt = τ, R ← dR R: the slide's, without the gyroscopic term.
    Literal,
    /// World-frame angular momentum conserved, midpoint rotation.
    Momentum,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Contacts and forces at the old position, position with the new velocity. Order 1.
    SemiImplicit,
    /// Half of the motion, contacts and forces there, the other half with the new velocity (J. J. Moreau 1999; θ = ½).
    /// Order 2 between impacts; without friction and with e = 1 the energy is kept.
    Moreau,
}

/// What happens to the normal velocity of an approaching contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Impact {
    /// Multiplied by −e, all contacts at once (Moreau). With friction it may gain energy.
    Newton,
    /// All contacts at once, compression and expansion (Glocker & Pfeiffer). Never gains energy.
    Poisson,
    /// One contact after the other, the fastest approach first, by the energy of its own compression (Stronge). Never
    /// gains energy.
    Sequential,
}

impl Impact {
    /// Its word in the file.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// It has pins and a tangential restitution.
    pub fn has_all(self) -> bool {
        match self {
            Impact::Newton => true,
            Impact::Poisson | Impact::Sequential => false,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PositionCorrection {
    /// Split impulse: penetration is removed by a pseudo-velocity that is forgotten after the step.
    Projection,
    None,
}

/// What a contact does at its turn in a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Local {
    /// The normal row, then both tangents by one step length, then the disc.
    #[default]
    Common,
    /// Every tangent row by its own diagonal (the common textbook form): it settles away from the solution.
    Rows,
    /// Its 3×3 problem solved exactly (nonlinear Gauss–Seidel).
    Exact,
}

/// In which order a sweep visits the contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// That of the contact test.
    #[default]
    Fixed,
    /// Another one every sweep, the same in every step.
    Shuffled,
}
