//! Facts of a method, whatever the scene: the one row that checks, the plan, the commands and the lists read.

use super::accuracy::Accuracy;
use super::checks::Result;
use super::integrator::Integrator;
use super::key_path::Path;
use super::solver::Solver;
use super::variants::{Impact, PositionCorrection};
use serde::Serialize;

/// A row of the table of methods. It follows from the settings; every method says all of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facts {
    pub accuracy: Accuracy,
    /// Tolerance that the method controls its error by.
    pub tolerance: Option<f64>,
    /// Whether the method goes from event to event; the clock then says only when to end.
    pub follows_events: bool,
    /// Whether the method tries others and takes one of them.
    pub chooses: bool,
    pub contact: ContactModel,
    /// Whether the method goes on until the law of contact is met, exactly or to a tolerance: what it misses is a fault
    /// of the run, and not of the method.
    pub solves_contacts: bool,
    pub approach: Approach,
    /// Law of impact; None where the method has no choice of them.
    pub impact: Option<Impact>,
    pub restitution: Restitution,
    /// Whether the nodes of meshes are what touches.
    pub needs_mesh: bool,
    pub pins: bool,
    /// Reason why tangent rows are solved where μ = 0 too.
    pub tangents_anyway: Option<&'static str>,
    /// Whether bodies turn as their moments of inertia ask; the slides leave that out.
    pub gyroscopic: bool,
    /// Position correction; None where the method has no such setting.
    pub position_correction: Option<PositionCorrection>,
    /// Contact solver; None where the method has no choice of them.
    pub solver: Option<Solver>,
    /// Integrator of the method. The integrators are methods of their own below it: they say its accuracy, and their
    /// word its name.
    pub integrator: Option<Integrator>,
}

/// Law of contact forces that a method has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactModel {
    /// No contact: the method does not look.
    None,
    /// Forces that grow with the depth: a step has a critical length.
    Springs,
    /// Impulses that are claimed to obey the law of contact, and are held to it.
    Law,
}

/// Way of a method through a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Approach {
    /// Reflection of what is inside, as the lecture's slides have it; or an impact takes no time, and forces do not act
    /// in it.
    Inside,
    /// Touching alone: nothing is asked for but that it does not come nearer.
    Touching,
    /// Contacts seen at the start of the step, with a new velocity that lasts for all of it.
    Start,
    /// Contacts seen in the middle of the step, with a new velocity that lasts to the middle of the next one.
    Middle,
}

/// Part of the scene's restitution that a method takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restitution {
    /// Normal and tangential restitution; or nothing touches.
    All,
    /// Normal restitution alone.
    Normal,
    /// No restitution.
    None {
        /// Sentence about what the method has in place of it.
        instead: &'static str,
    },
}

impl Restitution {
    /// Restitution that a law of impact takes.
    pub(super) fn of(law: Impact) -> Self {
        if law.has_all() { Restitution::All } else { Restitution::Normal }
    }
}

/// Noun that says what a word is, and its source; empty where it has none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct About {
    pub what: String,
    pub source: &'static str,
}

pub(super) fn about(what: impl Into<String>, source: &'static str) -> About {
    About { what: what.into(), source }
}

/// Settings of a method, with what they say of it.
pub trait MethodSettings {
    fn facts(&self) -> Facts;

    /// Noun and source for lists.
    fn about(&self) -> About;

    /// Text of a setting that is left out and has no default of its own.
    fn unless_set(&self, _setting: &str) -> String {
        "none".to_string()
    }

    /// Checks the bounds of the settings, and those that must fit together.
    ///
    /// # Errors
    /// The first setting that makes no sense.
    fn check(&self, at: Path) -> Result<()>;
}
