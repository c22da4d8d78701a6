//! The exact motion from a given start, of a scene that a closed form is named for.

use super::facts::Lacks;
use super::form::{ClosedForm, ExactMotion};
use super::{
    ball, dome, falling_rod, free_motion, heavy_top, ladder, linear_drag, pendulum, quadratic_drag, rest,
    rimless_wheel, rocking_block, sliding, stick_slip, symmetric_body, turntable,
};
use crate::experiment::types::{Accuracy, Exact, Experiment};
use crate::model::Model;
use crate::state::State;

/// The exact motion from a given start.
pub struct Closed {
    bodies: Vec<ExactMotion>,
}

impl Closed {
    /// The motion of the closed form in this scene.
    ///
    /// # Errors
    /// What the scene should have, if it is not one of the closed form's.
    pub fn new(which: Exact, model: &Model, start: &State) -> Result<Self, Lacks> {
        let bodies = (0..start.bodies.len()).map(|i| motion(which, model, start, i));
        Ok(Closed { bodies: bodies.collect::<Result<_, _>>()? })
    }

    /// The exact state at a time after the start.
    pub fn state_at(&self, t_s: f64) -> State {
        State { step: 0, time_s: t_s, bodies: self.bodies.iter().map(|motion| motion.at(t_s)).collect() }
    }

    /// Time up to which the closed form is the motion, in seconds.
    pub fn holds_until_s(&self) -> f64 {
        self.bodies.iter().map(|motion| motion.holds_until_s).fold(f64::INFINITY, f64::min)
    }

    /// Puts the bodies where they are at the state's time.
    pub fn write(&self, state: &mut State) {
        let t_s = state.time_s;
        self.bodies.iter().zip(&mut state.bodies).for_each(|(motion, at)| *at = motion.at(t_s));
    }
}

/// The facts of a closed form.
pub const fn form(which: Exact) -> ClosedForm {
    match which {
        Exact::FreeMotion => free_motion::FORM,
        Exact::SymmetricBody => symmetric_body::FORM,
        Exact::LinearDrag => linear_drag::FORM,
        Exact::QuadraticDrag => quadratic_drag::FORM,
        Exact::HeavyTop => heavy_top::FORM,
        Exact::Pendulum => pendulum::FORM,
        Exact::Rest => rest::FORM,
        Exact::Sliding => sliding::FORM,
        Exact::Ball => ball::FORM,
        Exact::Turntable => turntable::FORM,
        Exact::RockingBlock => rocking_block::FORM,
        Exact::FallingRod => falling_rod::FORM,
        Exact::Ladder => ladder::FORM,
        Exact::RimlessWheel => rimless_wheel::FORM,
        Exact::Dome => dome::FORM,
        Exact::StickSlip => stick_slip::FORM,
    }
}

/// The motion of one of the model's bodies from its start.
fn motion(which: Exact, model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    if model.bodies[index].driven && which != Exact::Rest {
        return Ok(free_motion::even(&start.bodies[index]));
    }
    (form(which).motion)(model, start, index)
}

/// The closed forms that an experiment names, and where.
pub fn named(experiment: &Experiment) -> Vec<(&'static str, Exact)> {
    let mut named: Vec<_> = experiment.exact.iter().map(|exact| ("exact", *exact)).collect();
    if experiment.method.accuracy() == Accuracy::Closed {
        named.push(("method.free.integrator", Exact::FreeMotion));
    }
    named
}
