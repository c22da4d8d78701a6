//! What is true of a method, whatever the scene: the one row that checks, the plan, the commands and the lists read.

use super::accuracy::Accuracy;
use super::checks::Result;
use super::integrator::Integrator;
use super::key_path::Path;
use super::variants::{Impact, PositionCorrection};
use serde::Serialize;

/// A row of the table of methods. It follows from the settings; every method says all of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facts {
    pub accuracy: Accuracy,
    /// What it controls its error by.
    pub tolerance: Option<f64>,
    /// It goes from event to event, and the clock says only when to end.
    pub follows_events: bool,
    /// It tries others and takes one of them.
    pub chooses: bool,
    pub contact: ContactModel,
    pub approach: Approach,
    /// None: it has no choice of them.
    pub impact: Option<Impact>,
    pub restitution: Restitution,
    /// It touches with the nodes of meshes.
    pub needs_mesh: bool,
    pub pins: bool,
    /// Why tangent rows are solved where μ = 0 too.
    pub tangents_anyway: Option<&'static str>,
    /// Bodies turn as their moments of inertia ask; the slides leave that out.
    pub gyroscopic: bool,
    /// None: it has no such setting.
    pub position_correction: Option<PositionCorrection>,
    /// The integrators are methods of their own below it: they say its accuracy, and their word its name.
    pub integrator: Option<Integrator>,
}

/// What a method makes of contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactModel {
    /// It does not look.
    None,
    /// Forces that grow with the depth: a step has a critical length.
    Springs,
    /// Its impulses are claimed to obey the law of contact, and are held to it.
    Law,
}

/// How a method steps through a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Approach {
    /// What is inside is reflected, as the lecture's slides have it; or an impact takes no time, and forces do not act
    /// in it.
    Inside,
    /// Nothing is asked for but that it does not come nearer.
    Touching,
    /// Contacts are seen at the start of the step and the new velocity lasts for all of it.
    Start,
    /// Contacts are seen in the middle of the step and the new velocity lasts to the middle of the next one.
    Middle,
}

/// How much of the scene's restitution a method takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Restitution {
    /// Normal and tangential; or nothing touches.
    All,
    /// Normal alone.
    Normal,
    /// Not any.
    None {
        /// What it has in place of it.
        instead: &'static str,
    },
}

impl Restitution {
    /// Of a law of impact.
    pub(super) fn of(law: Impact) -> Self {
        if law.has_all() { Restitution::All } else { Restitution::Normal }
    }
}

/// What a word is, as a noun, and its source; empty where it has none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct About {
    pub what: String,
    pub source: &'static str,
}

pub(super) fn about(what: impl Into<String>, source: &'static str) -> About {
    About { what: what.into(), source }
}

/// What the settings of every method say of it.
pub trait MethodSettings {
    fn facts(&self) -> Facts;

    /// What lists say of it.
    fn about(&self) -> About;

    /// What a setting is where it is left out and has no default of its own.
    fn unless_set(&self, _setting: &str) -> String {
        "none".to_string()
    }

    /// Its bounds, and settings that must fit together.
    ///
    /// # Errors
    /// The first setting that makes no sense.
    fn check(&self, at: Path) -> Result<()>;
}
