//! Velocity–impulse time-stepping: the sound default.
//!
//! As the lecture's constraint method, but every contact is put back into its cone right after its rows (projected
//! Gauss–Seidel; or another solver of the same law), started from last step's impulses. Contacts are foreseen: a gap
//! may close to zero in a step and no further (`collide::approach`); what its impulses show of others is asked for in
//! further rounds (`foreseen.rs`). Between impulses bodies turn freely, in closed form.
//!
//! A step is a motion, a kick and a motion: `semi-implicit` kicks first and moves for the whole step, `moreau` kicks
//! half-way (J. J. Moreau, Comput. Methods Appl. Mech. Engrg 177 (1999) 329). A step of the clock is made in parts
//! where bodies hit each other that would be through by its end.

use super::blow::{Blow, normal_motion};
use super::closing::{close_slowly, left_m};
use super::drift::drift;
use super::foreseen::Foreseen;
use super::held::Held;
use super::push_out::push_out;
use super::rebounds::Rebounds;
use super::scratch::Scratch;
use super::still;
use super::turning::Turning;
use crate::clock::Clock;
use crate::collide::approach::Approach;
use crate::collide::lasting::{Hold, Lasting};
use crate::collide::reduce::Reduction;
use crate::collide::{Contact, Key, SolvedContact};
use crate::deadline::Deadline;
use crate::experiment::types::{
    Cone, Correction, Iteration, PositionCorrection, Skip, Skips, TimeStepping as Settings,
};
use crate::model::pins::Pin as Joint;
use crate::model::{Body, Model};
use crate::plan::Plan;
use crate::solve::gauss_seidel::{Sweeps, Variant};
use crate::solve::missed::strict_residual;
use crate::solve::pins::{self, Pin};
use crate::solve::position::Push;
use crate::solve::problem::ContactProblem;
use crate::solve::solver::ContactSolver;
use crate::solve::twist::Twist;
use crate::solve::{self, Impulse};
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// Most solves of a step: after each, friction may be put against another velocity where the kick is half-way, and
/// bodies may turn on otherwise where it is not.
const MOST_SOLVES: u32 = 6;

/// Residual up to which impulses that are no solution are near enough to one to tell what friction is against.
const NEAR: f64 = 1e-6;

/// A residual from which sweeps have ended far from a solution.
const FAR: f64 = 1e-3;

/// A way in a step, of the least width of all bodies, or a turn in radians, from which bodies are looked at before a
/// step whose kick is half-way.
const FAST: f64 = 0.25;
/// Most cuts of a step of the clock.
const MOST_PARTS: u32 = 2_000;

pub struct TimeStepping {
    solver: ContactSolver,
    scheme: Approach,
    /// That of the last step or part of one.
    pub(super) approach: Approach,
    sweeps: Sweeps,
    reduction: Option<Reduction>,
    position_correction: PositionCorrection,
    /// Which contact had which impulse in the last step, in world axes and in the order of contacts.
    last: Vec<(Key, Vector3<f64>)>,
    /// The same of the step before, and of this step, as far as it is solved.
    last_but_one: Vec<(Key, Vector3<f64>)>,
    solved: Vec<(Key, Vector3<f64>)>,
    /// Impulses of this step, if those of the last two go on as they changed.
    expected: Vec<Impulse>,
    /// Contacts that last into this step, of a scheme whose kick is half-way.
    lasting: Lasting,
    /// Contacts last from step to step; else every step takes them for new ones, and what rocks comes to rest.
    may_last: bool,
    /// The same of the next step.
    last_on: Vec<(Key, Hold)>,
    foreseen: Foreseen,
    /// What is left of a step of the clock of which a part is made, and how often it was cut.
    left_s: Option<f64>,
    parts: u32,
    /// Time from the start of the next one to its kick, if bodies hit each other before its middle.
    before_s: Option<f64>,
    /// Least width of all bodies.
    width_m: f64,
    /// Length of the last step.
    pub(super) made_s: f64,
    pins: Vec<Pin>,
    last_pins: Vec<Impulse>,
    push: Push,
    blow: Option<Blow>,
    /// Where the last step's impulses acted, if not where the step began.
    pub(super) kicked: Option<State>,
    skips: Skips,
    /// Nothing changes with time but what moves freely.
    is_steady: bool,
    /// The bodies where the last step began, in flight where it ended; and whether it led back there, with the impulses
    /// of the one before.
    began: Vec<BodyState>,
    is_at_rest: bool,
    /// The step up to which rest may be passed at once; else step by step.
    pub(super) rests_to: u64,
    /// Steps ahead in which nothing can be touched.
    flight: u64,
    turning: Turning,
    rebounds: Rebounds,
    held: Held,
    /// Sweeps have ended far from a solution, of this step as far as it is solved and of the last one.
    is_far: bool,
    was_far: bool,
    /// The last step was left when time was up.
    pub(super) is_cut: bool,
    pub(super) scratch: Scratch,
}

impl TimeStepping {
    pub(super) fn new(settings: &Settings, plan: &Plan, start: &State, scratch: Scratch) -> Self {
        let sweeps = Sweeps {
            iteration: Iteration::GaussSeidel,
            correction: Correction::PerContact,
            cone: Cone::Disc,
            most: settings.sweeps().unwrap_or(u32::MAX),
            tolerance: settings.tolerance(),
            friction: plan.friction,
            variant: Variant { local: settings.local, relaxation: settings.relaxation, order: settings.order },
            deadline: Deadline::default(),
        };
        TimeStepping {
            solver: ContactSolver::new(
                settings.solver,
                scratch.contacts(),
                scratch.free.capacity(),
                plan.skips.has(Skip::KeptImpulses),
            ),
            scheme: plan.approach,
            approach: plan.approach,
            sweeps,
            reduction: settings.contacts_per_face.map(|most| Reduction::new(most, scratch.contacts())),
            position_correction: settings.position_correction,
            last: Vec::with_capacity(scratch.contacts()),
            last_but_one: Vec::with_capacity(scratch.contacts()),
            solved: Vec::with_capacity(scratch.contacts()),
            expected: Vec::with_capacity(scratch.contacts()),
            lasting: Lasting::default(),
            may_last: true,
            last_on: Vec::with_capacity(scratch.contacts()),
            foreseen: Foreseen::with_capacity(scratch.contacts(), scratch.free.capacity()),
            left_s: None,
            parts: 0,
            before_s: None,
            width_m: f64::INFINITY,
            made_s: 0.0,
            pins: Vec::new(),
            last_pins: Vec::new(),
            push: Push::new(sweeps.tolerance, scratch.contacts(), scratch.free.capacity()),
            blow: Blow::new(settings.impact, plan.approach, start),
            kicked: (plan.approach == Approach::Middle).then(|| start.clone()),
            skips: plan.skips,
            is_steady: false,
            began: Vec::with_capacity(scratch.free.capacity()),
            is_at_rest: false,
            rests_to: 0,
            flight: 0,
            turning: Turning::with_capacity(scratch.free.capacity()),
            rebounds: Rebounds::default(),
            held: Held::with_capacity(scratch.free.capacity(), scratch.contacts()),
            is_far: false,
            was_far: false,
            is_cut: false,
            scratch,
        }
    }

    /// The same, to whose steps all contacts are new.
    pub(super) fn without_lasting(self) -> Self {
        TimeStepping { may_last: false, ..self }
    }

    /// Steps from now on have time until then.
    pub fn hurry(&mut self, deadline: Deadline) {
        self.sweeps.deadline = deadline;
    }

    /// A step of the clock, or a part of it: up to where bodies hit each other that would be through by its end. What
    /// is left of a step goes on with a kick at its start, whatever the scheme.
    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        if self.is_skipped(model, state, clock) {
            return;
        }
        let unsolved = self.scratch.work.unsolved;
        self.held.begin(&mut self.began, self.made_s);
        self.began.clear();
        self.began.extend_from_slice(&state.bodies);
        if state.step == 0 {
            self.is_steady = still::is_steady(model, state);
            let widths_m = model.bodies.iter().filter_map(|body| Some(body.solid()?.0.least_width_m()));
            self.width_m = widths_m.fold(f64::INFINITY, f64::min);
            if self.scheme == Approach::Middle && self.may_last {
                self.lasting = Lasting::at_start(model, state);
            }
        }
        self.foreseen.turns_far.fill(false);
        let left_s = self.left_s.unwrap_or(clock.step_s);
        let mut before_s = 0.0;
        let is_half_way = self.parts == 0 && self.scheme == Approach::Middle && !self.is_hit(model, state, left_s);
        self.approach = if is_half_way { Approach::Middle } else { Approach::Start };
        self.blow.iter_mut().for_each(|blow| blow.approach = self.approach);
        if self.approach == Approach::Middle {
            before_s = self.before_s.take().map_or(left_s / 2.0, |hit_s| hit_s.min(left_s / 2.0));
        }
        drift(model, state, before_s, &self.foreseen.turns_far, &mut self.scratch.work);
        if let Some(kicked) = &mut self.kicked {
            kicked.copy_from(state);
        }
        self.made_s = left_s;
        loop {
            // 1. Contact test.
            self.foreseen.is_up_to_hit = self.made_s < left_s;
            self.foreseen.is_whole = self.parts >= MOST_PARTS;
            self.foreseen.cuts = self.parts;
            // Until the next kick.
            let ahead_s = if self.made_s < left_s { self.made_s - before_s } else { self.made_s };
            self.scratch.free_velocities(model, state, self.made_s);
            self.turning.begin(model, state, &mut self.scratch, (self.approach, self.made_s));
            self.foreseen.look(model, state, &mut self.scratch, &self.last, ahead_s);
            // 2. Contact impulses, until they ask for no other contacts; displacements that remove penetration.
            self.solve_rounds(model, state, self.made_s, ahead_s);
            let after_s = self.made_s - before_s;
            let cut_s = self.foreseen.cut_s(after_s).filter(|_| !self.foreseen.is_whole && !self.is_cut);
            let Some(hit_s) = cut_s else { break };
            if hit_s >= after_s {
                // On the way to the next kick, which comes when they meet.
                self.before_s = Some(hit_s - after_s);
                break;
            }
            self.parts += 1;
            self.made_s = before_s + hit_s;
        }
        let after_s = self.made_s - before_s;
        self.note_lasting(model, state);
        self.take_solution();
        self.turning.note(model, &self.scratch.solved);
        let pushed = self.find_push(model, state, self.made_s);
        // 3. Velocities. 4. Position and attitude.
        let s = &mut self.scratch;
        for (i, at) in state.bodies.iter_mut().enumerate() {
            at.v_WB = s.free[i].v + s.response[i].v;
            at.w_WB = s.free[i].w + s.response[i].w;
        }
        drift(model, state, after_s, &self.foreseen.turns_far, &mut s.work);
        if pushed {
            push_out(model, state, &self.push);
        }
        // 5. Time.
        self.left_s = (self.made_s < left_s).then_some(left_s - self.made_s);
        if self.left_s.is_none() {
            self.parts = 0;
            let is_solved = self.scratch.work.unsolved == unsolved && !self.is_cut;
            self.look_for_rest(model, state, self.made_s == clock.step_s && is_solved);
            clock.advance(state);
        }
    }

    /// Makes a step of which the end is known, or that touches nothing. Whether it is one.
    fn is_skipped(&mut self, model: &Model, state: &mut State, clock: &Clock) -> bool {
        let is_here = || state.bodies.iter().zip(&self.began).all(|(at, began)| at.has_bits_of(began));
        let may_be = (self.is_at_rest || self.flight > 0) && clock.step_s == self.made_s && is_here();
        if !may_be {
            return false;
        }
        if self.is_at_rest {
            let steps = self.rests_to.saturating_sub(state.step).max(1);
            self.scratch.work.rest_steps += steps;
            clock.advance_by(state, steps);
        } else {
            self.flight -= 1;
            let s = &mut self.scratch;
            s.work.flight_steps += 1;
            s.free_velocities(model, state, clock.step_s);
            for (at, free) in state.bodies.iter_mut().zip(&s.free) {
                (at.v_WB, at.w_WB) = (free.v + Twist::ZERO.v, free.w + Twist::ZERO.w);
            }
            drift(model, state, clock.step_s, &self.foreseen.turns_far, &mut s.work);
            self.began.copy_from_slice(&state.bodies);
            clock.advance(state);
        }
        true
    }

    /// After a step of the clock, `is_plain`: made in one part and solved.
    fn look_for_rest(&mut self, model: &Model, state: &mut State, is_plain: bool) {
        (self.is_at_rest, self.flight) = (false, 0);
        if self.scheme != Approach::Start || !is_plain {
            return;
        }
        let s = &self.scratch;
        if self.last.is_empty() {
            if self.skips.has(Skip::Flight) && self.foreseen.is_empty() && model.pins.is_empty() {
                self.flight = still::steps_of_flight(model, state, self.made_s);
                self.began.copy_from_slice(&state.bodies);
            }
            return;
        }
        let kept = (&s.solved[..], self.solver.left());
        let is_same = still::put_to_rest(model, state, &self.began, (&s.free, &s.response), kept);
        self.is_at_rest = is_same && self.is_steady && self.skips.has(Skip::Rest) && self.last == self.last_but_one;
    }

    /// Whether bodies that are fast hit each other in the step, or turn too far beside each other: a kick half-way
    /// would come too late, or too seldom.
    fn is_hit(&mut self, model: &Model, state: &State, step_s: f64) -> bool {
        let is_fast = |(body, at): (&Body, &BodyState)| {
            let turns = if body.is_centred_ball() { 0.0 } else { at.w_WB.norm() };
            let way_m = step_s * (at.v_WB.norm() + turns * body.bounding_radius_m);
            body.solid().is_some() && (way_m > FAST * self.width_m || step_s * turns > FAST)
        };
        if !model.touching_pairs || !model.bodies.iter().zip(&state.bodies).any(is_fast) {
            return false;
        }
        self.scratch.free_velocities(model, state, 0.0);
        self.turning.begin(model, state, &mut self.scratch, (Approach::Middle, 0.0));
        self.foreseen.look(model, state, &mut self.scratch, &self.last, step_s);
        self.scratch.found.clear();
        self.scratch.response.clear();
        self.scratch.response.resize(model.bodies.len(), Twist::ZERO);
        self.foreseen.revise(model, state, &mut self.scratch, (Approach::Middle, step_s));
        self.foreseen.cut_s(step_s).is_some()
    }

    fn solve_rounds(&mut self, model: &Model, state: &State, step_s: f64, ahead_s: f64) {
        let unsolved = self.scratch.work.unsolved;
        self.solved.clear();
        self.rebounds.begin();
        self.solve_contacts(model, state, step_s);
        while !self.is_cut && self.asks_again(model, state, step_s, ahead_s) {
            self.scratch.work.unsolved = unsolved;
            self.solve_contacts(model, state, step_s);
        }
        if self.foreseen.is_given_up {
            self.scratch.work.unsolved = unsolved + 1;
        }
    }

    /// Whether impulses ask for other contacts than those that they are of, or for other rebounds.
    fn asks_again(&mut self, model: &Model, state: &State, step_s: f64, ahead_s: f64) -> bool {
        if self.foreseen.revise(model, state, &mut self.scratch, (self.approach, ahead_s)) {
            return true;
        }
        if self.blow.is_none() && self.approach == Approach::Start && self.held.revise(model, &self.scratch) {
            return true;
        }
        let struck = self.blow.as_ref().map(|blow| &blow.impulses[..]).filter(|struck| !struck.is_empty());
        self.approach == Approach::Start && self.rebounds.revise(model, &self.scratch, struck, step_s)
    }

    /// Keeps what lasts into the next step.
    fn note_lasting(&mut self, model: &Model, state: &State) {
        let TimeStepping { scratch: s, approach, made_s, blow, lasting, may_last, last_on, .. } = self;
        if *approach != Approach::Middle || !*may_last {
            return lasting.renew(std::iter::empty());
        }
        let known = &*lasting;
        let is_struck = |i: usize| blow.as_ref().is_some_and(|blow| blow.is_struck[i]);
        let lasts = |(i, (contact, p)): (usize, (&Contact, &Impulse))| {
            let motion = normal_motion(contact, state, &s.free);
            let lasts = approach.lasts(model, contact, motion, *made_s, known.of(contact)) && !is_struck(i);
            let after = |i: usize| [s.free[i].v + s.response[i].v, s.free[i].w + s.response[i].w];
            let hold = Hold::of(contact, p.x, p.yz().norm(), &contact.velocity(after)).filter(|_| lasts)?;
            Some((contact.key(), hold))
        };
        last_on.clear();
        last_on.extend(s.found.iter().zip(&s.impulses).enumerate().filter_map(lasts));
        lasting.renew(last_on.drain(..));
    }

    fn take_solution(&mut self) {
        std::mem::swap(&mut self.last_but_one, &mut self.last);
        std::mem::swap(&mut self.last, &mut self.solved);
        self.was_far = self.is_far;
        self.last_pins.clear();
        self.last_pins.extend_from_slice(&self.scratch.impulses[self.scratch.found.len()..]);
        self.scratch.take_solution();
        if let Some(reduction) = &self.reduction {
            show(&reduction.left_out, &mut self.scratch.solved);
        }
    }

    /// The impulses of the contacts that are asked for. `solved`: of this step's round before, if there was one.
    fn solve_contacts(&mut self, model: &Model, state: &State, step_s: f64) {
        let s = &mut self.scratch;
        if let Some(reduction) = &mut self.reduction {
            reduction.apply(&mut s.found);
        }
        let is_half_way = self.approach == Approach::Middle;
        let hold = |contact: &Contact| self.lasting.of(contact).filter(|_| is_half_way);
        // Whatever rebounds by another law than Newton's has done so before the step's own impulses.
        let is_newton = self.blow.is_none();
        let mut asked = if is_newton || is_half_way { self.rebounds.asked(&s.found) } else { Some(plastic(&s.found)) };
        let contacts = asked.as_mut().unwrap_or(&mut s.found);
        s.problem.gather_held(model, state, &s.free, contacts, (self.approach, step_s), hold);
        if !model.pins.is_empty() {
            // The velocity that closes what gap there is until the next step.
            let closing = |pin: &Joint, _: &_, _: Option<&_>| -pin.apart_W(&state.bodies) / step_s;
            pins::at(model, state, closing, &mut self.pins);
            s.problem.pin(model, state, &s.free, &self.pins);
        }
        let struck = self.blow.as_mut().filter(|_| !s.found.is_empty()).and_then(|blow| {
            let (solver, work) = (&mut self.solver, &mut s.work);
            let mut plastic =
                |problem: &ContactProblem, p: &mut [Impulse]| solver.solve(problem, &self.sweeps, (p, &[]), work);
            let may_strike = |contact: &Contact| hold(contact).is_none() && !self.rebounds.is_waived(contact);
            let through = (step_s, self.sweeps.deadline);
            let ended = blow.strike(model, state, &s.free, (&s.found, &may_strike), through, &mut plastic)?;
            s.work.unsolved += u64::from(!ended);
            self.is_cut |= !ended && self.sweeps.deadline.is_over();
            let plastic = go_on_after(blow, model, &mut s.problem, &s.free, &s.found, (self.approach, step_s), hold);
            Some((blow, plastic))
        });
        let unmoved = asked.as_ref().map_or_else(Vec::new, |_| vec![Twist::ZERO; model.bodies.len()]);
        let after = struck.as_ref().map(|(blow, plastic)| (&plastic[..], &blow.response[..]));
        let after = after.or(asked.as_ref().map(|asked| (&asked[..], &unmoved[..])));
        let through = (self.approach, step_s);
        self.turning.ask(model, after, s, through);
        warm_start(&s.found, &s.problem, &self.last, &mut s.impulses);
        if is_newton && !is_half_way {
            self.held.ask(model, state, s, asked.as_deref(), step_s);
        }
        if self.was_far && !is_half_way {
            close_slowly(&mut s.problem, &s.found, &s.impulses, step_s);
        }
        if !self.solved.is_empty() {
            warm_start(&s.found, &s.problem, &self.solved, &mut s.impulses);
        }
        s.impulses.extend(&self.last_pins);
        s.impulses.resize(s.problem.blocks.len(), Impulse::zeros());
        self.expected.clear();
        if self.solved.is_empty() && !self.solver.is_iteration() {
            warm_start(&s.found, &s.problem, &self.last_but_one, &mut self.expected);
            go_on(&s.impulses, &s.problem, &mut self.expected);
            self.expected.extend(&s.impulses[s.found.len()..]);
        }
        s.work.tangent_rows += if self.sweeps.friction { 2 * s.found.len() as u64 } else { 0 };
        let mut settled = s.problem.blocks.is_empty();
        let enough = self.solver.may_miss(self.sweeps.tolerance);
        for _ in 0..MOST_SOLVES {
            settled =
                settled || self.solver.solve(&s.problem, &self.sweeps, (&mut s.impulses, &self.expected), &mut s.work);
            self.expected.clear();
            s.problem.response(&s.impulses, &mut s.response);
            let changes = match self.approach {
                Approach::Middle => {
                    let (p, u) = (&s.impulses, &s.response);
                    let is_near = settled || strict_residual(&s.problem, p, u) <= NEAR;
                    is_near && (s.problem.stop(p, u) || s.problem.take_mean(&s.found, model, p, u))
                }
                _ => self.turning.revise(model, state, s, after, (through, settled, enough)),
            };
            if !changes {
                break;
            }
            settled = false;
        }
        self.is_far =
            !settled && self.solver.is_iteration() && strict_residual(&s.problem, &s.impulses, &s.response) > FAR;
        if !settled {
            self.is_cut |= self.sweeps.deadline.is_over();
            s.work.unsolved += 1;
            // Projected Gauss–Seidel only descends: from a start that adds energy it may not come below zero in time.
            // That is seen here, at the end, alone: a stack needs such a start when it has just been held too well.
            s.problem.take_back(&mut s.impulses, &s.response);
        }
        if let Some((blow, _)) = struck {
            s.problem.take_off(&blow.response);
            s.impulses.iter_mut().zip(&blow.impulses).for_each(|(p, blow)| *p += blow);
        }
        self.solved.clear();
        let solved = s.found.iter().zip(&s.problem.blocks).zip(&s.impulses);
        self.solved.extend(solved.map(|((contact, block), p)| (contact.key(), block.in_world(p))));
        s.problem.response(&s.impulses, &mut s.response);
    }

    fn find_push(&mut self, model: &Model, state: &State, step_s: f64) -> bool {
        let s = &mut self.scratch;
        let is_half_way = self.approach == Approach::Middle;
        // Whatever kicks at the start of a step loses what its forces do in it to bodies at rest: ½ m (g Δt)².
        let lost_j_kg = if is_half_way { 0.0 } else { (model.gravity_m_s2 * step_s).norm_squared() / 2.0 };
        let free = is_half_way.then_some(&s.free[..]);
        let taken_j = |taken: &mut Vec<f64>| s.problem.taken_j(state, free, (&s.impulses, &s.response), taken);
        let of = (&s.problem, &s.found[..], model);
        let through = (&s.impulses[..], &s.response[..], step_s);
        let left_m = |contact: &Contact| if self.is_far { left_m(contact, state, &s.free, step_s) } else { 0.0 };
        self.position_correction == PositionCorrection::Projection
            && self.push.find(of, through, (taken_j, lost_j_kg, left_m), &mut s.work)
    }
}

fn plastic(contacts: &[Contact]) -> Vec<Contact> {
    contacts.iter().map(|contact| Contact { restitution: 0.0, ..*contact }).collect()
}

/// The step's contact problem after a blow that took care of all restitution, and its contacts.
fn go_on_after(
    blow: &Blow,
    model: &Model,
    problem: &mut ContactProblem,
    free: &[Twist],
    found: &[Contact],
    through: (Approach, f64),
    hold: impl Fn(&Contact) -> Option<Hold>,
) -> Vec<Contact> {
    let free: Vec<Twist> = free.iter().zip(&blow.response).map(|(a, b)| Twist { v: a.v + b.v, w: a.w + b.w }).collect();
    let mut plastic = plastic(found);
    let mut is_struck = blow.is_struck.iter();
    let hold = |contact: &Contact| {
        let is_struck = is_struck.next();
        hold(contact).filter(|_| is_struck == Some(&false))
    };
    problem.gather_held(model, &blow.after, &free, &mut plastic, through, hold);
    plastic
}

/// Contacts that were left out are there, without an impulse.
fn show(left_out: &[Contact], solved: &mut Vec<SolvedContact>) {
    solved.extend(left_out.iter().map(|contact| SolvedContact { contact: *contact, impulse_W: Vector3::zeros() }));
    solved.sort_unstable_by_key(|s| s.contact.key());
}

/// Last step's impulse of every contact that is still there, else 0. Both lists are in the order of contacts. `last`:
/// in world axes, as a contact's frame may turn over with the last bit of its normal.
fn warm_start(found: &[Contact], problem: &ContactProblem, last: &[(Key, Vector3<f64>)], impulses: &mut Vec<Impulse>) {
    impulses.clear();
    let mut last = last.iter().peekable();
    for (contact, block) in found.iter().zip(&problem.blocks) {
        let key = contact.key();
        while last.next_if(|(known, _)| *known < key).is_some() {}
        let same = last.next_if(|(known, _)| *known == key);
        impulses.push(same.map_or_else(Impulse::zeros, |(_, impulse_W)| block.in_frame(impulse_W)));
    }
}

/// Of the last impulse, a change that is small.
const SMALL: f64 = 0.1;

/// Lets impulses of contacts that slip go on from those of the step before (`expected`) to the last ones as they
/// changed. What sticks comes to rest, where impulses stay the same.
fn go_on(last: &[Impulse], problem: &ContactProblem, expected: &mut [Impulse]) {
    for ((p, last), block) in expected.iter_mut().zip(last).zip(&problem.blocks) {
        let change = last - *p;
        let is_small = change.norm() <= SMALL * last.norm();
        let slips = [*p, *last].iter().all(|p| solve::slips(p, block.friction));
        *p = if slips && is_small { last + change } else { *last };
    }
}
