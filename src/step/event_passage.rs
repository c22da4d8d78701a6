//! What a step from event to event shows: the way between two events, and the forces on it.

use super::event_driven::{EventDriven, Span};
use super::moments::moments;
use crate::event::decide::{Margin, margin};
use crate::event::dense::project_velocities;
use crate::event::forces::{Gathered, Held};
use crate::event::look::Paths;
use crate::model::Model;
use crate::outcome::Criterion;
use crate::shown::{ContactForce, Moment, Passage, Smooth};
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;

impl Passage for EventDriven {
    /// Within the last stretch. Velocities are along what holds, as where the stretch ends: what the integrator leaves
    /// of others is below its tolerance, but not nothing beside what forces do in a moment.
    fn state_at(&self, model: &Model, state: &mut State) {
        self.put(model, state);
        if !self.dense.is_empty() && !self.held.is_empty() {
            project_velocities(model, state, &self.held, &mut self.gathered.borrow_mut());
        }
    }

    fn forces_at(&self, model: &Model, state: &State) -> Vec<ContactForce> {
        if let Span::Short { step_s } = self.span {
            return self.solved.iter().map(|solved| ContactForce::mean(solved, step_s)).collect();
        }
        // What a step holds that was not made is not known.
        if self.held.is_empty() || self.stalled == Some(Criterion::Limit) {
            return Vec::new();
        }
        if self.dense.is_empty() && self.steady_W.len() == self.held.len() {
            let force = |(held, force_W): (&Held, &Vector3<f64>)| ContactForce {
                contact: held.touch.here(state).contact,
                force_W: *force_W,
            };
            return self.held.iter().zip(&self.steady_W).map(force).collect();
        }
        let mut gathered = self.gathered.borrow_mut();
        // What a recorder looks at is not known to the steps that follow.
        let last = &mut self.last.clone();
        let Margin { solved, .. } = margin(model, state, &self.held, (&mut gathered, last), &mut Work::default());
        let Gathered { here, problem, .. } = &*gathered;
        let of = here.iter().zip(&problem.blocks).zip(&solved.p);
        of.map(|((here, block), p)| ContactForce { contact: here.contact, force_W: block.in_world(p) }).collect()
    }
}

impl EventDriven {
    /// Puts the bodies where the last stretch has them at the state's time.
    pub(super) fn put(&self, model: &Model, state: &mut State) {
        let paths = Paths { model, motions: &self.motions, dense: &self.dense, deadline: self.deadline };
        if !self.motions.is_empty() {
            (0..state.bodies.len()).for_each(|i| state.bodies[i] = paths.at(i, state.time_s));
        }
    }
}

impl Smooth for EventDriven {
    fn moments(&self, model: &Model, [before, after]: [&State; 2]) -> Vec<Moment> {
        let span_s = after.time_s - before.time_s;
        if span_s <= 0.0 || (self.held.is_empty() && !model.has_loads() && !model.has_driven_pins()) {
            return Vec::new();
        }
        moments(before, span_s, |state| {
            self.state_at(model, state);
            self.forces_at(model, state)
        })
    }
}
