//! What a method with contacts needs in every step and nobody outside does; how a body is moved.

use crate::collide::{Contact, Detector, Reach, SolvedContact};
use crate::experiment::types::{Rotation, Update};
use crate::integrate::rotation::{turn_at_momentum, turn_literally, w_from_momentum};
use crate::model::{Body, Model};
use crate::plan::Plan;
use crate::solve::Impulse;
use crate::solve::problem::ContactProblem;
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::Vector3;

/// What a method needs in every step and nobody outside does.
#[derive(Debug)]
pub(super) struct Scratch {
    pub(super) detector: Detector,
    pub(super) found: Vec<Contact>,
    pub(super) problem: ContactProblem,
    /// V[n] + M⁻¹ F_E Δt of every body.
    pub(super) free: Vec<Twist>,
    /// What the mean angular velocity of every body's free turn through the step has beyond that after the impulses.
    pub(super) turning: Vec<Vector3<f64>>,
    pub(super) impulses: Vec<Impulse>,
    /// M⁻¹ Jᵀ p of every body.
    pub(super) response: Vec<Twist>,
    pub(super) solved: Vec<SolvedContact>,
    pub(super) work: Work,
}

impl Scratch {
    /// With room for as many contacts as the plan expects, so that no step allocates.
    pub(super) fn new(model: &Model, plan: &Plan) -> Self {
        let contacts = plan.contacts;
        let bodies = model.bodies.len();
        Scratch {
            detector: Detector::default(),
            found: Vec::with_capacity(contacts),
            problem: ContactProblem::with_capacity(contacts, bodies),
            free: Vec::with_capacity(bodies),
            turning: Vec::with_capacity(bodies),
            impulses: Vec::with_capacity(contacts),
            response: Vec::with_capacity(bodies),
            solved: Vec::with_capacity(contacts),
            work: Work::default(),
        }
    }

    /// Contacts that there is room for.
    pub(super) fn contacts(&self) -> usize {
        self.found.capacity()
    }

    /// Step 1 of L21.
    pub(super) fn detect(&mut self, model: &Model, state: &State, reach: &Reach) {
        self.detector.detect(model, state, reach, &mut self.found, &mut self.work);
    }

    /// V + M⁻¹ F_E Δt (L14).
    pub(super) fn free_velocities(&mut self, model: &Model, state: &State, step_s: f64) {
        self.free.clear();
        self.free.extend(state.bodies.iter().enumerate().map(|(i, at)| {
            let (v, w) = model.gained(i, state.time_s, at, step_s);
            Twist { v: at.v_WB + v, w: at.w_WB + w }
        }));
    }

    /// Contacts of this step with their impulses in world axes.
    pub(super) fn take_solution(&mut self) {
        self.work.contacts += self.found.len() as u64;
        self.work.contact_solves += u64::from(!self.found.is_empty());
        self.solved.clear();
        let solved = self.found.iter().zip(&self.problem.blocks).zip(&self.impulses);
        self.solved.extend(
            solved.map(|((contact, block), p)| SolvedContact { contact: *contact, impulse_W: block.in_world(p) }),
        );
    }
}

/// Position and attitude by the old or the new velocity; `new` becomes the body's velocity (steps 3 and 4 of L21).
pub(super) fn move_body(
    body: &Body,
    at: &mut BodyState,
    new: &Twist,
    update: Update,
    rotation: Rotation,
    step_s: f64,
    work: &mut Work,
) {
    let old = Twist { v: at.v_WB, w: at.w_WB };
    let moving = match update {
        Update::Explicit => &old,
        Update::SemiImplicit => new,
    };
    at.p_WB += moving.v * step_s;
    at.v_WB = new.v;
    match rotation {
        Rotation::Literal => {
            turn_literally(at, &moving.w, step_s);
            at.w_WB = new.w;
        }
        Rotation::Momentum => {
            let I_W = body.I_W(at);
            turn_at_momentum(body, at, &(I_W * moving.w), step_s, work);
            at.w_WB = if body.spins_steadily { new.w } else { w_from_momentum(body, at, &(I_W * new.w)) };
        }
    }
}
