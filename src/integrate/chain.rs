//! The unit that an integrator advances: bodies that pins join (most often one body alone), with what drives them.

use super::drive::Drive;
use super::pin_solver::PinSolver;
use crate::model::pins::Anchor;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use crate::work::Work;

pub struct Chain {
    /// Indices of its bodies, rising.
    members: Vec<usize>,
    /// States of its bodies, between `take` and `give`.
    pub at: Vec<BodyState>,
    /// Drives of its bodies, as of the last `drive`.
    pub drives: Vec<Drive>,
    pins: Option<PinSolver>,
    /// Whether some applied force or the air acts on a body.
    loaded: bool,
}

impl Chain {
    /// All islands of a model, in the order of their first bodies; bodies that move as they are told are in none.
    pub fn all(model: &Model, start: &State) -> Vec<Chain> {
        let mut island_of: Vec<usize> = (0..model.bodies.len()).collect();
        for pin in &model.pins {
            if let Anchor::Body(other, _) = pin.anchor
                && !model.bodies[other].driven
            {
                let (kept, gone) =
                    (island_of[pin.body].min(island_of[other]), island_of[pin.body].max(island_of[other]));
                island_of.iter_mut().filter(|island| **island == gone).for_each(|island| *island = kept);
            }
        }
        let moving = |i: &usize| !model.bodies[*i].driven;
        let members = |first: usize| (0..island_of.len()).filter(|i| island_of[*i] == first).collect();
        let first = (0..island_of.len()).filter(moving).filter(|i| island_of[*i] == *i);
        first.map(|first| Chain::new(members(first), model, start)).collect()
    }

    fn new(members: Vec<usize>, model: &Model, start: &State) -> Self {
        let has_load = |i: &usize| !model.bodies[*i].drag.is_none() || model.forces.iter().any(|f| f.body == *i);
        Chain {
            at: members.iter().map(|i| start.bodies[*i]).collect(),
            drives: vec![Drive::of_gravity(model); members.len()],
            pins: PinSolver::new(&members, model, start),
            loaded: members.iter().any(has_load),
            members,
        }
    }

    /// Whether nothing acts on its bodies but gravity: every one is on its own, and its drive never changes.
    pub fn is_free(&self) -> bool {
        !self.loaded && self.pins.is_none()
    }

    pub fn take(&mut self, state: &State) {
        self.at.iter_mut().zip(&self.members).for_each(|(at, i)| *at = state.bodies[*i]);
    }

    pub fn give(&self, state: &mut State) {
        self.at.iter().zip(&self.members).for_each(|(at, i)| state.bodies[*i] = *at);
    }

    /// Indices of its bodies in the model.
    pub fn members(&self) -> &[usize] {
        &self.members
    }

    pub fn pins(&self) -> Option<&PinSolver> {
        self.pins.as_ref()
    }

    /// Its pins, with A at the present states; None without any.
    pub fn gathered_pins(&mut self, model: &Model) -> Option<&mut PinSolver> {
        let pins = self.pins.as_mut()?;
        pins.gather(model, &self.at);
        Some(pins)
    }

    /// One of its bodies, by the order of `at`.
    pub fn body<'a>(&self, member: usize, model: &'a Model) -> &'a Body {
        &model.bodies[self.members[member]]
    }

    pub fn bodies<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = &'a Body> {
        self.members.iter().map(|i| &model.bodies[*i])
    }

    /// Its bodies with their states and drives.
    pub fn each<'a>(&'a mut self, model: &'a Model) -> impl Iterator<Item = (&'a Body, &'a mut BodyState, &'a Drive)> {
        let bodies = self.members.iter().map(|i| &model.bodies[*i]);
        bodies.zip(&mut self.at).zip(&self.drives).map(|((body, at), drive)| (body, at, drive))
    }

    /// Works out the drives at the present states, at a time (s).
    pub fn drive(&mut self, model: &Model, t_s: f64, work: &mut Work) {
        if self.is_free() {
            return;
        }
        for ((i, at), drive) in self.members.iter().zip(&self.at).zip(&mut self.drives) {
            let load = model.load(*i, t_s, at);
            drive.acceleration = model.gravity_m_s2 + load.force / model.bodies[*i].mass_kg;
            drive.torque_B = at.q_WB.inverse_transform_vector(&load.torque);
        }
        if let Some(pins) = &mut self.pins {
            pins.drive(model, t_s, &self.at, &mut self.drives, work);
        }
    }

    /// Puts the bodies back where the pins hold them, in position and velocity.
    pub fn hold(&mut self, model: &Model, t_s: f64, work: &mut Work) {
        if let Some(pins) = &mut self.pins {
            pins.hold(model, t_s, &mut self.at, work);
        }
    }
}
