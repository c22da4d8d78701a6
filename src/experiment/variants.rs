//! Words that settings of a method choose from. A part of `method.rs`.

use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// First guess of the constraint force (L20).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// No guess: F = 0.
    None,
    /// Direct solution F = −A⁻¹ b by LU; a non-finite start is replaced by 0.
    Direct,
    /// Direct solution with the inverse matrix.
    Inverse,
    /// Direct solution with the Moore–Penrose inverse.
    PseudoInverse,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Iteration {
    /// Jacobi's iteration, as in the printed formula.
    Jacobi,
    /// Gauss–Seidel's iteration, in place.
    GaussSeidel,
}

/// Moment at which forces are put back into the friction cone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Correction {
    /// At the end of a sweep, for all contacts at once.
    AfterSweep,
    /// Right after the contact's three rows: this is projected Gauss–Seidel.
    PerContact,
}

/// Quantity that |f_c2, f_c3| < μ |f_c1| bounds (L19).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cone {
    /// Length of (f₂, f₃): Coulomb's law.
    #[default]
    Disc,
    /// Components f₂ and f₃ each, as the line can be read: up to √2 times the friction, by the direction.
    Box,
}

/// Velocity that moves the position (L5).
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
    /// The slide's rotation I dω/dt = τ, R ← dR R, without the gyroscopic term.
    Literal,
    /// Midpoint rotation that conserves the angular momentum of the world frame.
    Momentum,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Contacts and forces at the old position, position with the new velocity. Order 1.
    SemiImplicit,
    /// Half of the motion, contacts and forces there, the other half with the new velocity (J. J. Moreau 1999; θ = ½).
    /// Order 2 between impacts, whatever the shapes: a contact that lasts is held in the mean of the velocities before
    /// and after, along its normal and along the surface. Without friction and with e = 1 the energy is kept.
    Moreau,
}

/// Law of what happens to the normal velocity of an approaching contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Impact {
    /// Newton's law: the velocity of every contact is multiplied by −e, all contacts at once (Moreau); corners of a
    /// face and ends of a line count each for itself, and several bodies solve one law together. Without friction one
    /// e gains no energy in the impact; with friction it may.
    Newton,
    /// Poisson's law: compression and expansion, all contacts at once (Glocker & Pfeiffer). A face or a line gives back
    /// e times what it took in all, and of several bodies each at once: of a row of balls more than the last one
    /// leaves. It never gains energy.
    Poisson,
    /// One pair after the other, the fastest approach first: one contact by the energy of its own compression
    /// (Stronge), those of one face or line as one by Poisson's law. Several bodies are struck in that order: of a row
    /// of balls the last one leaves. It never gains energy, and needs no end (then: `work_unsolved`).
    Sequential,
}

impl Impact {
    /// Word of the law in the file.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// Whether the law has pins and a tangential restitution.
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

/// Solution that a contact takes at its turn in a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Local {
    /// Common step: the normal row, then both tangents by one step length, then the disc.
    #[default]
    Common,
    /// Row by row: every tangent row by its own diagonal (the common textbook form); it settles away from the solution.
    Rows,
    /// Exact solution of the contact's 3×3 problem (nonlinear Gauss–Seidel).
    Exact,
}

/// Order in which a sweep visits the contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// Order of the contact test, every other sweep backwards: what a sweep prefers the next one takes back, and a
    /// stack leans less.
    #[default]
    ForthAndBack,
    /// Order of the contact test.
    Fixed,
    /// Order that is another one every sweep, the same in every step.
    Shuffled,
}
