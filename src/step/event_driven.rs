//! From event to event (`event`): a stretch of smooth motion up to the next one, then the event.
//!
//! A step is one of both. The clock means nothing here but its end: where a recorder looks is read off the motion, so that
//! the run is the same with or without it.

use super::{Clock, Scratch, Span, time_stepping};
use crate::collide::{Contact, Detector, Key, Reach, SolvedContact};
use crate::event::decide::{Change, Decision, decide, margin};
use crate::event::dense::{Dense, Field, look_at_slips, project};
use crate::event::forces::{Choice, Forces, Held, Mode, NO_SLIP, Slip, meeting_m_s};
use crate::event::impact;
use crate::event::motion::Motion;
use crate::event::touch::Touch;
use crate::event::watch::{self, Paths, Window};
use crate::exact::arc::Arc;
use crate::experiment::types::{EventDriven as Settings, Impact, Method, Scheme, Solver, TimeStepping};
use crate::measure::Moment;
use crate::measure::divergence::Criterion;
use crate::measure::work::Work;
use crate::collide::solid::Solid;
use crate::model::{Body, Geometry, Model};
use crate::plan::Plan;
use crate::solve::problem::Twist;
use crate::state::State;
use nalgebra::Vector3;

/// What ends a stretch.
#[derive(Clone, Debug)]
enum Event {
    /// The beginning: whatever touches.
    Start,
    Impact,
    Change(Change),
    /// A step of the integrator, and nothing else.
    Step,
}

pub struct EventDriven {
    tolerance: f64,
    law: Impact,
    contact: bool,
    motions: Vec<Motion>,
    held: Vec<Held>,
    dense: Option<Dense>,
    /// Ends of slips that are known in closed form.
    changes_s: Option<f64>,
    next: Event,
    detector: Detector,
    found: Vec<Contact>,
    forces: Forces,
    /// Of the projection.
    placing: Forces,
    scratch: State,
    /// Events without any time between them; and when counting of events began, with how many.
    at_once: u32,
    counted_from: (f64, u64),
    /// Events lead no further from here.
    trouble: Option<()>,
    /// Steps of equal length instead, and how many are left.
    stretch: Option<(Box<time_stepping::TimeStepping>, u32)>,
    pub(super) span: Span,
    pub(super) stalled: Option<Criterion>,
    pub(super) solved: Vec<SolvedContact>,
    pub(super) work: Work,
}

/// Of the tolerance: the error of one step of the integrator; and of the bounces that are left out (`event`).
const LOCAL: f64 = 0.01;
const ZENO: f64 = 1e-6;

/// Of the speeds at a contact.
const BOUNCED_OUT: f64 = 1e-11;

/// Looks at the forces in a step of the integrator.
const LOOKS: u32 = 4;

/// Events at one moment, of all contacts, before something is wrong.
const AT_ONCE: u32 = 200;

/// More events than this in the time of a stretch are too many: those that cost an integration, and others.
const MANY_DENSE: u64 = 2_000;
const MANY: u64 = 100_000;

/// Steps of equal length in one go.
const STRETCH: u32 = 32;

/// Of the bounding radius: what is nearer is looked at when something touches.
const MARGIN: f64 = 1e-9;

impl EventDriven {
    pub fn new(settings: &Settings, plan: &Plan, model: &Model, start: &State) -> Self {
        EventDriven {
            tolerance: settings.tolerance,
            law: settings.impact,
            contact: plan.contact,
            motions: Vec::with_capacity(model.bodies.len()),
            held: Vec::new(),
            dense: None,
            changes_s: None,
            next: Event::Start,
            detector: Detector::default(),
            found: Vec::with_capacity(16),
            forces: Forces::default(),
            placing: Forces::default(),
            scratch: start.clone(),
            at_once: 0,
            counted_from: (start.time_s, 0),
            trouble: None,
            stretch: None,
            span: Span::Motion,
            stalled: None,
            solved: Vec::with_capacity(16),
            work: Work::default(),
        }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, end_s: f64) {
        if self.stretch.is_none() {
            self.step_to_event(model, state, end_s);
        }
        if self.trouble.take().is_some() {
            self.begin_stretch(model, state);
        }
        if self.stretch.is_some() {
            self.step_of_stretch(model, state, end_s);
        }
    }

    fn step_to_event(&mut self, model: &Model, state: &mut State, end_s: f64) {
        state.step += 1;
        self.span = Span::Motion;
        let from_s = state.time_s;
        let event = std::mem::replace(&mut self.next, Event::Step);
        self.work.events += u64::from(!matches!(event, Event::Start | Event::Step));
        let blow = match event {
            Event::Step => false,
            Event::Start => {
                self.detect(model, state);
                let struck = self.strike(model, state);
                self.regroup(model, state, &Change::default()) || struck
            }
            Event::Impact => {
                self.detect(model, state);
                let struck = self.strike(model, state);
                self.regroup(model, state, &Change::default()) || struck
            }
            Event::Change(change) => {
                self.detect(model, state);
                self.regroup(model, state, &change)
            }
        };
        if blow {
            self.span = Span::Blow;
        } else if self.stalled.is_none() && self.trouble.is_none() {
            self.advance(model, state, end_s);
        }
        self.at_once = if state.time_s > from_s { 0 } else { self.at_once + 1 };
        if self.at_once > AT_ONCE || self.accumulates(model, state) {
            self.trouble = Some(());
        }
    }

    /// Events come faster than steps of equal length would take.
    fn accumulates(&mut self, model: &Model, state: &State) -> bool {
        if state.time_s - self.counted_from.0 > f64::from(STRETCH) * short_step_s(model) {
            self.counted_from = (state.time_s, self.work.events);
        }
        let most = if self.dense.is_some() { MANY_DENSE } else { MANY };
        self.work.events - self.counted_from.1 > most
    }

    fn begin_stretch(&mut self, model: &Model, state: &State) {
        self.work.fallbacks += 1;
        let settings = TimeStepping { solver: Solver::Newton, scheme: Scheme::Moreau, impact: self.law, ..Default::default() };
        let plan = Plan::new(model, &Method::TimeStepping(settings.clone()));
        let stepper = time_stepping::TimeStepping::new(&settings, &plan, state, Scratch::new(model, &plan));
        self.stretch = Some((Box::new(stepper), STRETCH));
        self.motions.clear();
        self.held.clear();
        self.dense = None;
    }

    /// One step of equal length by time-stepping; after the last one, back to events.
    fn step_of_stretch(&mut self, model: &Model, state: &mut State, end_s: f64) {
        let Some((stepper, left)) = &mut self.stretch else { return };
        let (step, from_s) = (state.step, state.time_s);
        let h = short_step_s(model).min(end_s - from_s);
        let until_s = if from_s + h * 1.000_001 >= end_s { end_s } else { from_s + h };
        stepper.step(model, state, &Clock { steps: u64::MAX, end_s, step_s: until_s - from_s });
        (state.step, state.time_s) = (step + 1, until_s);
        self.span = Span::Short { step_s: until_s - from_s };
        self.solved.clear();
        self.solved.extend_from_slice(&stepper.scratch.solved);
        *left -= 1;
        if *left == 0 {
            self.work.unsolved += stepper.scratch.work.unsolved;
            self.stretch = None;
            self.next = Event::Start;
            self.counted_from = (until_s, self.work.events);
            self.at_once = 0;
        }
    }

    /// Where the last step of equal length had its impulses.
    pub fn kicked(&self) -> Option<&State> {
        self.stretch.as_ref().and_then(|(stepper, _)| stepper.kicked.as_ref())
    }

    /// Fills `found` with what touches now.
    fn detect(&mut self, model: &Model, state: &State) {
        self.found.clear();
        if self.contact {
            self.detector.detect(model, state, &Reach { margin: MARGIN, ahead_s: 0.0 }, &mut self.found, &mut self.work);
            self.found.retain(|contact| watch::is_closed(model, contact));
        }
    }

    /// Of a contact, and what it is compared with.
    fn approach_m_s(model: &Model, state: &State, contact: &Contact) -> (f64, f64) {
        let speed = contact.normal.dot(&contact.velocity(|i| [state.bodies[i].v_WB, state.bodies[i].w_WB]));
        (-speed, meeting_m_s(model, state, contact.ends().map(|(i, ..)| i)))
    }

    /// An impact, if something comes nearer.
    fn strike(&mut self, model: &Model, state: &mut State) -> bool {
        let strikes = |contact: &Contact| {
            let (approach, scale) = Self::approach_m_s(model, state, contact);
            approach > NO_SLIP * scale
        };
        if !self.found.iter().any(strikes) {
            return false;
        }
        for k in 0..self.found.len() {
            if self.bounces_out(model, state, &self.found[k]) {
                self.found[k].restitution = 0.0;
            }
        }
        let (forces, solved, work) = (&mut self.forces, &mut self.solved, &mut self.work);
        if !impact::strike(model, state, &self.found, self.law, forces, solved, work) {
            work.unsolved += 1;
        }
        true
    }

    /// The bounces that are left after this one do not matter (Zeno).
    fn bounces_out(&self, model: &Model, state: &State, contact: &Contact) -> bool {
        let falling = -contact.normal.dot(&model.gravity_m_s2);
        let left = 1.0 - contact.restitution;
        if falling <= 0.0 || left <= 0.0 || contact.restitution == 0.0 {
            return false;
        }
        let (approach, scale) = Self::approach_m_s(model, state, contact);
        // A ball's bounces cost so little that they are followed to rounding.
        if self.found.len() == 1 && contact.ends().all(|(i, ..)| is_centred_ball(&model.bodies[i])) {
            return approach <= BOUNCED_OUT * scale;
        }
        approach * approach / (2.0 * falling * left * left) <= self.negligible_m(model, contact)
    }

    /// A height that does not matter.
    fn negligible_m(&self, model: &Model, contact: &Contact) -> f64 {
        let radius_m = contact.ends().map(|(i, ..)| model.bodies[i].bounding_radius_m).fold(f64::INFINITY, f64::min);
        (ZENO * self.tolerance).max(10.0 * watch::DELTA * radius_m)
    }

    /// What holds from now on, and how everything moves. True: an impulse was needed to end a slip.
    fn regroup(&mut self, model: &Model, state: &mut State, change: &Change) -> bool {
        let Some(touches) = self.resting(model, state) else { return false };
        let change = &Change { slow_m_s: self.slow_m_s(model)[1], ..change.clone() };
        let decision = decide(model, state, touches, change, &mut self.forces, &mut self.work);
        let mut jammed = false;
        self.held = match decision {
            Decision::Holds(held) => held,
            Decision::Jams(touch) => {
                jammed = impact::jam(model, state, &touch, &mut self.forces, &mut self.solved);
                self.stalled = (!jammed).then_some(Criterion::Painleve);
                self.next = Event::Change(Change::default());
                return jammed;
            }
            Decision::Unsolved => {
                self.trouble = Some(());
                return false;
            }
        };
        if project(model, state, &self.held, &mut self.placing) || self.held.len() != self.forces.here.len() {
            self.forces.gather(model, state, self.held.iter().map(|held| &held.touch));
            self.forces.hold(&self.held, Choice::Least);
        }
        self.set_motions(model, state);
        jammed
    }

    /// Of what touches, what does not leave. None: a contact of parts whose motion is not known.
    fn resting(&mut self, model: &Model, state: &State) -> Option<Vec<Touch>> {
        let mut resting = Vec::new();
        for contact in &self.found {
            let (approach, scale) = Self::approach_m_s(model, state, contact);
            // What has lost its restitution may rock on: at last it rests.
            let falling = -contact.normal.dot(&model.gravity_m_s2);
            let rocks = contact.restitution == 0.0 && falling > 0.0;
            let rests_m_s = if rocks { (2.0 * falling * self.negligible_m(model, contact)).sqrt() } else { 0.0 };
            if -approach > rests_m_s.max(NO_SLIP * scale) {
                continue;
            }
            let Some(touch) = Touch::new(model, state, contact) else {
                self.trouble = Some(());
                return None;
            };
            resting.push(touch);
        }
        Some(resting)
    }

    fn set_motions(&mut self, model: &Model, state: &mut State) {
        self.changes_s = None;
        let bodies = if self.held.is_empty() { 0 } else { model.bodies.len() };
        let resting: Vec<bool> = (0..bodies).map(|i| self.is_at_rest(model, state, i)).collect();
        let mut dense = Vec::new();
        self.motions.clear();
        for i in 0..model.bodies.len() {
            let motion = self.closed(model, state, i, &resting);
            if motion.is_none() {
                dense.push(i);
            }
            self.motions.push(motion.unwrap_or(Motion::Dense));
        }
        self.dense = match self.dense.take() {
            _ if dense.is_empty() => None,
            Some(mut known) if known.bodies == dense => {
                known.restart(state);
                Some(known)
            }
            _ => Some(Dense::new(model, dense, state, LOCAL * self.tolerance)),
        };
    }

    fn is_at_rest(&self, model: &Model, state: &State, i: usize) -> bool {
        let (body, at) = (&model.bodies[i], &state.bodies[i]);
        let a = self.forces.acceleration(i);
        let (radius_m, fall) = (body.bounding_radius_m, model.gravity_m_s2.norm());
        let still = at.v_WB.norm() + radius_m * at.w_WB.norm() <= NO_SLIP * (fall * radius_m).sqrt();
        let stays = a.v.norm() + radius_m * a.w.norm() <= 1e-11 * self.forces.free[i].v.norm();
        still && (body.driven || (stays && model.constant_pull(i).is_some()))
    }

    /// None: there is no closed form of it.
    fn closed(&mut self, model: &Model, state: &mut State, i: usize, resting: &[bool]) -> Option<Motion> {
        let (body, at) = (&model.bodies[i], state.bodies[i]);
        if body.driven {
            return Some(Motion::Driven(state.time_s, at));
        }
        if model.pins.iter().any(|pin| pin.holds(i)) {
            return None;
        }
        let pull = model.constant_pull(i)?;
        if self.held.is_empty() {
            return Some(Motion::free(body, state.time_s, &at, pull));
        }
        let own: Vec<usize> = (0..self.held.len()).filter(|k| self.held[*k].touch.bodies().any(|b| b == i)).collect();
        if own.is_empty() {
            return Some(Motion::free(body, state.time_s, &at, pull));
        }
        let still = |b: usize| b == i || resting[b];
        if resting[i] && own.iter().all(|k| self.held[*k].touch.bodies().all(still)) {
            state.bodies[i].v_WB = Vector3::zeros();
            state.bodies[i].w_WB = Vector3::zeros();
            return Some(Motion::Arc(Arc::straight(state.time_s, state.bodies[i], Vector3::zeros())));
        }
        if !own.iter().all(|k| self.held[*k].touch.bodies().all(|b| b == i || (model.bodies[b].driven && resting[b]))) {
            return None;
        }
        self.steady(model, state, i, &own).map(Motion::Arc)
    }

    /// A ball, or a body that does not turn, on what does not move, and every slip keeps its direction: all forces are
    /// constant.
    fn steady(&mut self, model: &Model, state: &mut State, i: usize, own: &[usize]) -> Option<Arc> {
        let body = &model.bodies[i];
        let radius_m = body.bounding_radius_m;
        let Twist { v: a, w: mut alpha } = self.forces.acceleration(i);
        let at = &mut state.bodies[i];
        if !is_centred_ball(body) {
            let scale = self.forces.free[i].v.norm();
            let turning = at.w_WB.norm() * radius_m > NO_SLIP * (at.v_WB.norm() + (scale * radius_m).sqrt());
            if turning || alpha.norm() * radius_m > 1e-11 * scale {
                return None;
            }
            at.w_WB = Vector3::zeros();
            alpha = Vector3::zeros();
        }
        let mut ends_s = f64::INFINITY;
        for k in own {
            let (here, block) = (&self.forces.here[*k], &self.forces.problem.blocks[*k]);
            let Some(d) = self.held[*k].slides() else { continue };
            let change = block.velocity(&self.forces.added);
            let change_W = block.frame[1] * change.y + block.frame[2] * change.z;
            let along = d.dot(&change_W);
            let scale = self.forces.free[i].v.norm();
            if (change_W - d * along).norm() > 1e-11 * scale {
                return None;
            }
            if along < -1e-14 * scale {
                ends_s = ends_s.min(state.time_s + here.slip_W().norm() / -along);
            }
        }
        if ends_s < f64::INFINITY {
            self.changes_s = Some(self.changes_s.map_or(ends_s, |t_s| t_s.min(ends_s)));
        }
        Some(Arc { t_s: state.time_s, from: *at, acceleration_m_s2: a, angular_rad_s2: alpha })
    }

    /// Smooth motion up to the next event, or to the end of a step of the integrator.
    fn advance(&mut self, model: &Model, state: &mut State, end_s: f64) {
        let mut to_s = end_s;
        if !self.integrate(model, state, end_s) {
            self.trouble = Some(());
            return;
        }
        if let Some(dense) = &self.dense {
            to_s = dense.t_s + dense.h;
        }
        self.next = Event::Step;
        if let Some(t_s) = self.changes_s.filter(|t_s| *t_s <= to_s) {
            (to_s, self.next) = (t_s, Event::Change(Change::default()));
        }
        if self.contact {
            let paths = Paths { model, motions: &self.motions, dense: self.dense.as_ref() };
            let window = Window { from_s: state.time_s, to_s };
            if let Some(t_s) = watch::first(&paths, &self.held, window, &mut self.work) {
                (to_s, self.next) = (t_s, Event::Impact);
            }
        }
        if let Some((t_s, change)) = self.first_change(model, state.time_s, to_s) {
            (to_s, self.next) = (t_s, Event::Change(change));
        }
        self.end_at(model, state, to_s);
    }

    /// A step of the integrator, if a body needs one.
    fn integrate(&mut self, model: &Model, state: &State, end_s: f64) -> bool {
        let Some(mut dense) = self.dense.take() else { return true };
        self.scratch.copy_from(state);
        let mut most_s = longest_s(model);
        if self.held.iter().any(|held| held.slides().is_some()) {
            margin(model, state, &self.held, &mut self.forces, &mut self.work);
            let slow_m_s = self.slow_m_s(model);
            most_s = most_s.min(look_at_slips(&mut self.held, state, slow_m_s, &self.forces));
            if self.held.iter().any(|held| held.slip == Slip::Young) {
                // However slowly it begins: what accelerates it grows with the fall.
                let (g, size_m) = falls(model);
                most_s = most_s.min((2.0 * slow_m_s[0] / (g * (g / size_m).sqrt())).sqrt());
            }
        }
        dense.restart(state);
        let good = dense.step(&mut self.field(model), end_s, most_s);
        self.dense = Some(dense);
        good
    }

    /// Slips that are young and that fade: what is left out is a part of the tolerance (`Slip`).
    fn slow_m_s(&self, model: &Model) -> [f64; 2] {
        let (g, size_m) = falls(model);
        let tolerance = self.tolerance / size_m;
        let speed = (g * size_m).sqrt();
        [0.05 * speed * libm::pow(tolerance, 0.4), speed * (2e-4 * tolerance).sqrt()]
    }

    fn field<'a>(&'a mut self, model: &'a Model) -> Field<'a> {
        let sliding = self.held.iter().filter(|held| held.slides().is_some()).count();
        Field {
            model,
            motions: &self.motions,
            held: &self.held,
            forces: &mut self.forces,
            state: &mut self.scratch,
            choice: if sliding > 2 { Choice::Least } else { Choice::Any },
            work: &mut self.work,
        }
    }

    /// Puts the state at the end of a stretch within the integrator's last step.
    fn end_at(&mut self, model: &Model, state: &mut State, to_s: f64) {
        if let Some(mut dense) = self.dense.take() {
            if to_s > dense.t_s && to_s < dense.t_s + dense.h {
                self.scratch.copy_from(state);
                dense.shorten(&mut self.field(model), to_s);
            }
            self.dense = Some(dense);
        }
        state.time_s = to_s;
        self.state_at(model, state);
        if self.dense.is_some() {
            project(model, state, &self.held, &mut self.placing);
        }
    }

    /// The first of the looks at which a contact pulls, slips, or has ended its slip; then when it began to.
    fn first_change(&mut self, model: &Model, from_s: f64, to_s: f64) -> Option<(f64, Change)> {
        self.dense.as_ref()?;
        if self.held.is_empty() {
            return None;
        }
        let mut low_s = from_s;
        for look in 1..=LOOKS {
            let high_s = from_s + (to_s - from_s) * f64::from(look) / f64::from(LOOKS);
            if self.has_changed(model, high_s) {
                let t_s = self.when(model, low_s, high_s);
                return Some((t_s, self.what(model, t_s)));
            }
            low_s = high_s;
        }
        None
    }

    fn has_changed(&mut self, model: &Model, t_s: f64) -> bool {
        self.slip_left(model, t_s) < 0.0 || self.force_left(model, t_s) < -1e-11
    }

    /// The least slip along its direction, of all that slide, over the speeds there; with room for rounding.
    fn slip_left(&mut self, model: &Model, t_s: f64) -> f64 {
        let mut at = std::mem::replace(&mut self.scratch, State { step: 0, time_s: t_s, bodies: Vec::new() });
        at.time_s = t_s;
        self.state_at(model, &mut at);
        let left = self.held.iter().map(|held| match held.slides() {
            Some(d) if held.slip != Slip::Young => {
                held.touch.here(&at).slip_W().dot(&d) / meeting_m_s(model, &at, held.touch.bodies()) + NO_SLIP
            }
            _ => 1.0,
        });
        let left = left.fold(1.0, f64::min);
        self.scratch = at;
        left
    }

    fn force_left(&mut self, model: &Model, t_s: f64) -> f64 {
        let mut at = std::mem::replace(&mut self.scratch, State { step: 0, time_s: t_s, bodies: Vec::new() });
        at.time_s = t_s;
        self.state_at(model, &mut at);
        let left = margin(model, &at, &self.held, &mut self.forces, &mut self.work);
        self.scratch = at;
        left
    }

    /// Bisection: the first moment after the change, to the last bit but some.
    fn when(&mut self, model: &Model, mut low_s: f64, mut high_s: f64) -> f64 {
        let width_s = (high_s - low_s) * 1e-14;
        while high_s - low_s > width_s.max(f64::EPSILON * high_s) {
            let middle_s = 0.5 * (low_s + high_s);
            if self.has_changed(model, middle_s) {
                high_s = middle_s;
            } else {
                low_s = middle_s;
            }
        }
        high_s
    }

    /// Which contacts open and which begin to slip.
    fn what(&mut self, model: &Model, t_s: f64) -> Change {
        let mut change = Change::default();
        if self.force_left(model, t_s) >= -1e-11 {
            return change;
        }
        let largest = self.forces.p.iter().map(|p| p.norm()).fold(0.0, f64::max);
        let near = 1e-6 * largest;
        for ((held, p), block) in self.held.iter().zip(&self.forces.p).zip(&self.forces.problem.blocks) {
            let key: Key = held.touch.key();
            if p.x <= near {
                change.opening.push(key);
            } else if held.mode == Mode::Stick && p.yz().norm() >= held.touch.friction() * p.x - near {
                let d = -(block.frame[1] * p.y + block.frame[2] * p.z);
                change.slipping.extend(d.try_normalize(0.0).map(|d| (key, d)));
            }
        }
        change
    }

    /// Puts the bodies where they are at the state's time, within the last stretch.
    pub fn state_at(&mut self, model: &Model, state: &mut State) {
        let paths = Paths { model, motions: &self.motions, dense: self.dense.as_ref() };
        if !self.motions.is_empty() {
            (0..state.bodies.len()).for_each(|i| state.bodies[i] = paths.at(i, state.time_s));
        }
    }

    /// Forces of contact at a state of the last stretch.
    pub fn forces_at(&mut self, model: &Model, state: &State) -> Vec<SolvedContact> {
        if let Span::Short { step_s } = self.span {
            let force = |s: &SolvedContact| SolvedContact { impulse_W: s.impulse_W / step_s, ..*s };
            return self.solved.iter().map(force).collect();
        }
        if self.held.is_empty() {
            return Vec::new();
        }
        margin(model, state, &self.held, &mut self.forces, &mut Work::default());
        let Forces { here, problem, p, .. } = &self.forces;
        let of = here.iter().zip(&problem.blocks).zip(p);
        of.map(|((here, block), p)| SolvedContact { contact: here.contact, impulse_W: block.in_world(p) }).collect()
    }

    /// At the nodes of Gauss's quadrature with five points.
    pub fn moments(&mut self, model: &Model, [before, after]: [&State; 2]) -> Vec<Moment> {
        const NODES: [(f64, f64); 5] = [
            (0.046910077030668, 0.11846344252809454),
            (0.230765344947158, 0.23931433524968324),
            (0.5, 0.28444444444444444),
            (0.769234655052842, 0.23931433524968324),
            (0.953089922969332, 0.11846344252809454),
        ];
        let span_s = after.time_s - before.time_s;
        if self.held.is_empty() || span_s <= 0.0 {
            return Vec::new();
        }
        let moment = |(node, weight): (f64, f64)| {
            let mut state = before.clone();
            state.time_s = before.time_s + node * span_s;
            self.state_at(model, &mut state);
            let mut contacts = self.forces_at(model, &state);
            contacts.iter_mut().for_each(|solved| solved.impulse_W *= weight * span_s);
            Moment { state, contacts, weight_s: weight * span_s }
        };
        NODES.into_iter().map(moment).collect()
    }
}

/// Its forces turn nothing but itself about its centre of mass.
fn is_centred_ball(body: &Body) -> bool {
    let centred = matches!(&body.geometry, Geometry::Solid { solid: Solid::Sphere { .. }, centre } if *centre == Vector3::zeros());
    body.isotropic && centred
}

/// Of a fall by the size of the bodies, a thousandth.
fn short_step_s(model: &Model) -> f64 {
    let (g, size_m) = falls(model);
    if g > 0.0 { 1e-3 * (size_m / g).sqrt() } else { 1e-4 }
}

/// Gravity, and the size of the largest body.
fn falls(model: &Model) -> (f64, f64) {
    let size_m = model.bodies.iter().map(|body| body.bounding_radius_m).fold(0.0, f64::max);
    (model.gravity_m_s2.norm(), if size_m > 0.0 { size_m } else { 1.0 })
}

/// A force that swings is not stepped over.
fn longest_s(model: &Model) -> f64 {
    let fastest = model.forces.iter().filter_map(|force| force.cosine).map(|(w, _)| w.abs()).fold(0.0, f64::max);
    if fastest > 0.0 { 0.5 / fastest } else { f64::INFINITY }
}
