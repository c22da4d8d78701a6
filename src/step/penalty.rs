//! The penalty method (L15): a spring and a damper in every penetrating node, regularised Coulomb friction.

use super::scratch::{Scratch, move_body};
use crate::clock::Clock;
use crate::collide::{Contact, Reach, SolvedContact};
use crate::experiment::types::Penalty as Settings;
use crate::model::Model;
use crate::solve::end::Inertia;
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

pub struct Penalty {
    settings: Settings,
    pub(super) scratch: Scratch,
}

impl Penalty {
    pub(super) fn new(settings: &Settings, scratch: Scratch) -> Self {
        Penalty { settings: settings.clone(), scratch }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        // 1. Contact test.
        let s = &mut self.scratch;
        s.detect(model, state, &Reach::INSIDE);
        s.work.contacts += s.found.len() as u64;
        // 2. Contact forces, from the old positions and velocities. 3. Velocities.
        s.free_velocities(model, state, clock.step_s);
        s.solved.clear();
        for contact in &s.found {
            let impulse_W = force(&self.settings, contact, &state.bodies) * clock.step_s;
            for (i, r_W, sign) in contact.ends() {
                let Inertia { mass_kg, inverse_W } = Inertia::of(&model.bodies[i], &state.bodies[i]);
                s.free[i].v += impulse_W * sign / mass_kg;
                s.free[i].w += inverse_W * r_W.cross(&impulse_W) * sign;
            }
            s.solved.push(SolvedContact { contact: *contact, impulse_W });
        }
        // 4. Position and attitude.
        for (i, (body, at)) in model.bodies.iter().zip(&mut state.bodies).enumerate() {
            let new: Twist = s.free[i];
            move_body(body, at, &new, self.settings.update, self.settings.rotation, clock.step_s, &mut s.work);
        }
        // 5. Time.
        clock.advance(state);
    }
}

/// k depth − c v_n, never pulling; μ f_n against the slip, linear in it below `slip_speed_m_s`.
fn force(settings: &Settings, contact: &Contact, bodies: &[BodyState]) -> Vector3<f64> {
    let velocity = contact.velocity(|i| [bodies[i].v_WB, bodies[i].w_WB]);
    let along = velocity.dot(&contact.normal);
    let push = (-settings.stiffness_n_m * contact.gap_m - settings.damping_n_s_m * along).max(0.0);
    let slip = velocity - contact.normal * along;
    contact.normal * push - slip * (contact.friction * push / slip.norm().max(settings.slip_speed_m_s))
}
