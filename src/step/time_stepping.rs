//! Velocity–impulse time-stepping: the sound default.
//!
//! As the lecture's constraint method, but every contact is put back into its cone right after its rows (projected
//! Gauss–Seidel; or another solver of the same law), started from last step's impulses; rotation conserves angular momentum; penetration is removed by a
//! displacement of its own that is no velocity and adds no kinetic energy (split impulse).

use super::{Clock, Scratch};
use crate::collide::reduce::Reduction;
use crate::collide::{Contact, Key, SolvedContact, detect};
use crate::experiment::types::{Cone, Correction, Iteration, PositionCorrection, Solver, TimeStepping as Settings};
use crate::integrate::rotation::{exponential, turn_at_momentum, w_from_momentum};
use crate::model::Model;
use crate::solve::gauss_seidel::{self, Sweeps, Variant};
use crate::solve::position::push_out;
use crate::solve::problem::Twist;
use crate::solve::{Impulse, newton, nncg};
use crate::state::State;
use nalgebra::Vector3;

/// Of a body's bounding radius: a body resting at gap zero is in contact whatever its last bit says.
const MARGIN: f64 = 1e-9;

pub struct TimeStepping {
    solver: Solver,
    sweeps: Sweeps,
    reduction: Option<Reduction>,
    position_correction: PositionCorrection,
    /// Which contact had which impulse in the last step, in the order of contacts.
    last: Vec<(Key, Impulse)>,
    /// Multipliers and displacements of the position correction.
    pushes: Vec<f64>,
    pushed: Vec<Twist>,
    pub(super) scratch: Scratch,
}

impl TimeStepping {
    pub(super) fn new(settings: &Settings, friction: bool, scratch: Scratch) -> Self {
        TimeStepping {
            solver: settings.solver,
            sweeps: Sweeps {
                iteration: Iteration::GaussSeidel,
                correction: Correction::PerContact,
                cone: Cone::Disc,
                most: settings.sweeps,
                tolerance: settings.tolerance(),
                friction,
                variant: Variant { local: settings.local, relaxation: settings.relaxation, order: settings.order },
            },
            reduction: settings.contacts_per_face.map(|most| Reduction::new(most, scratch.contacts())),
            position_correction: settings.position_correction,
            last: Vec::with_capacity(scratch.contacts()),
            pushes: Vec::with_capacity(scratch.contacts()),
            pushed: Vec::with_capacity(scratch.free.capacity()),
            scratch,
        }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        // 1. Contact test.
        detect(model, state, MARGIN, &mut self.scratch.found, &mut self.scratch.work);
        if let Some(reduction) = &mut self.reduction {
            reduction.apply(&mut self.scratch.found);
        }
        // 2. Contact impulses; displacements that remove penetration.
        self.scratch.free_velocities(model, state, clock.step_s);
        self.solve_contacts(model, state);
        let pushed = self.push_out(model);
        // 3. Velocities. 4. Position and attitude, at constant angular momentum.
        let s = &mut self.scratch;
        for (i, (body, at)) in model.bodies.iter().zip(&mut state.bodies).enumerate() {
            at.v_WB = s.free[i].v + s.response[i].v;
            at.w_WB = s.free[i].w + s.response[i].w;
            at.p_WB += at.v_WB * clock.step_s;
            let L_W = body.I_W(at) * at.w_WB;
            turn_at_momentum(body, at, &L_W, clock.step_s, &mut s.work);
            if pushed {
                at.p_WB += self.pushed[i].v;
                at.q_WB = exponential(&self.pushed[i].w) * at.q_WB;
            }
            if !body.isotropic {
                at.w_WB = w_from_momentum(body, at, &L_W);
            }
        }
        // 5. Time.
        clock.advance(state);
    }

    fn solve_contacts(&mut self, model: &Model, state: &State) {
        let s = &mut self.scratch;
        s.problem.gather(model, state, &s.free, &s.found);
        warm_start(&s.found, &self.last, &mut s.impulses);
        s.problem.response(&s.impulses, &mut s.response);
        // Projected Gauss–Seidel only descends: from a start that adds energy it might not come below zero in time.
        if s.problem.energy(&s.impulses, &s.response) > 0.0 {
            s.impulses.fill(Impulse::zeros());
        }
        let solve = match self.solver {
            Solver::Pgs => gauss_seidel::iterate,
            Solver::Nncg => nncg::iterate,
            Solver::Newton => newton::solve,
        };
        if !s.found.is_empty() && !solve(&s.problem, &self.sweeps, &mut s.impulses, &mut s.solver, &mut s.work) {
            s.work.unsolved += 1;
            s.problem.response(&s.impulses, &mut s.response);
            s.problem.take_back(&mut s.impulses, &s.response);
        }
        self.last.clear();
        self.last.extend(s.found.iter().zip(&s.impulses).map(|(c, p)| (c.key(), *p)));
        s.take_solution();
        if let Some(reduction) = &self.reduction {
            show(&reduction.left_out, &mut s.solved);
        }
    }

    fn push_out(&mut self, model: &Model) -> bool {
        let s = &mut self.scratch;
        self.position_correction == PositionCorrection::Projection
            && push_out(&s.problem, &s.found, model, &self.sweeps, &mut self.pushes, &mut self.pushed, &mut s.work)
    }
}

/// Contacts that were left out are there, without an impulse.
fn show(left_out: &[Contact], solved: &mut Vec<SolvedContact>) {
    solved.extend(left_out.iter().map(|contact| SolvedContact { contact: *contact, impulse_W: Vector3::zeros() }));
    solved.sort_unstable_by_key(|s| s.contact.key());
}

/// Last step's impulse of every contact that is still there, else 0. Both lists are in the order of contacts.
fn warm_start(found: &[Contact], last: &[(Key, Impulse)], impulses: &mut Vec<Impulse>) {
    impulses.clear();
    let mut last = last.iter().peekable();
    for contact in found {
        let key = contact.key();
        while last.next_if(|(known, _)| *known < key).is_some() {}
        let same = last.next_if(|(known, _)| *known == key);
        impulses.push(same.map_or_else(Impulse::zeros, |(_, p)| *p));
    }
}
