//! The lecture's simulation (L16–L21), its five steps visible as five, in all literal variants.

use super::scratch::{Scratch, move_body};
use crate::clock::Clock;
use crate::collide::Reach;
use crate::collide::approach::Approach;
use crate::deadline::Deadline;
use crate::experiment::types::Lecture as Settings;
use crate::model::Model;
use crate::solve::gauss_seidel::{self, Sweeps, Variant, correct_all, iterate};
use crate::solve::start::first_guess;
use crate::solve::twist::Twist;
use crate::state::State;

pub struct Lecture {
    settings: Settings,
    iteration: gauss_seidel::Scratch,
    /// Steps have time until then.
    pub(super) deadline: Deadline,
    /// The last step was left when time was up.
    pub(super) is_cut: bool,
    pub(super) scratch: Scratch,
}

impl Lecture {
    pub(super) fn new(settings: &Settings, scratch: Scratch) -> Self {
        let iteration = gauss_seidel::Scratch::with_capacity(scratch.contacts(), scratch.free.capacity());
        Lecture { settings: settings.clone(), iteration, deadline: Deadline::default(), is_cut: false, scratch }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        // 1. Contact test.
        self.scratch.detect(model, state, &Reach::INSIDE);
        // 2. Constraint forces.
        self.scratch.free_velocities(model, state, clock.step_s);
        self.solve_constraints(model, state, clock.step_s);
        // 3. Velocities: M (V[n+1] − V[n]) = (F_E + F_C) Δt. 4. Position and attitude.
        let s = &mut self.scratch;
        for (i, (body, at)) in model.bodies.iter().zip(&mut state.bodies).enumerate() {
            let new = Twist { v: s.free[i].v + s.response[i].v, w: s.free[i].w + s.response[i].w };
            move_body(body, at, &new, self.settings.update, self.settings.rotation, clock.step_s, &mut s.work);
        }
        // 5. Time.
        clock.advance(state);
    }

    /// First guess, correction, sweeps (L20).
    fn solve_constraints(&mut self, model: &Model, state: &State, step_s: f64) {
        let s = &mut self.scratch;
        s.problem.gather(model, state, &s.free, &mut s.found, (Approach::Inside, step_s));
        first_guess(&s.problem, self.settings.start, &mut s.impulses);
        if !s.found.is_empty() {
            correct_all(&s.problem, self.settings.cone, &mut s.impulses);
            let sweeps = Sweeps {
                iteration: self.settings.iteration,
                correction: self.settings.correction,
                cone: self.settings.cone,
                most: self.settings.sweeps,
                tolerance: 0.0,
                friction: true,
                variant: Variant::default(),
                deadline: self.deadline,
            };
            let settled = iterate(&s.problem, &sweeps, &mut s.impulses, &mut self.iteration, &mut s.work);
            self.is_cut = !settled && self.deadline.is_over();
        }
        s.problem.response(&s.impulses, &mut s.response);
        s.take_solution();
    }
}
