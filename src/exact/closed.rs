//! The exact motion from a given start, of a scene that a closed form is named for.

use super::facts::Lacks;
use super::scene::Motion;
use crate::experiment::types::{Accuracy, Exact, Experiment};
use crate::model::Model;
use crate::state::State;

/// The exact motion from a given start.
pub struct Closed {
    bodies: Vec<Motion>,
}

impl Closed {
    /// # Errors
    /// What the scene should have, if it is not one of the closed form's.
    pub fn new(which: Exact, model: &Model, start: &State) -> Result<Self, Lacks> {
        let bodies = (0..start.bodies.len()).map(|i| super::scene::motion(which, model, start, i));
        Ok(Closed { bodies: bodies.collect::<Result<_, _>>()? })
    }

    /// The exact state at a time after the start.
    pub fn state_at(&self, t_s: f64) -> State {
        State { step: 0, time_s: t_s, bodies: self.bodies.iter().map(|motion| motion.at(t_s)).collect() }
    }

    /// Up to when the closed form is the motion.
    pub fn holds_until_s(&self) -> f64 {
        self.bodies.iter().map(Motion::holds_until_s).fold(f64::INFINITY, f64::min)
    }

    /// Puts the bodies where they are at the state's time.
    pub fn write(&self, state: &mut State) {
        let t_s = state.time_s;
        self.bodies.iter().zip(&mut state.bodies).for_each(|(motion, at)| *at = motion.at(t_s));
    }
}

/// The closed forms that an experiment names, and where.
pub fn named(experiment: &Experiment) -> Vec<(&'static str, Exact)> {
    let mut named: Vec<_> = experiment.exact.iter().map(|exact| ("exact", *exact)).collect();
    if experiment.method.accuracy() == Accuracy::Closed {
        named.push(("method.free.integrator", Exact::FreeMotion));
    }
    named
}
