//! From event to event (`event`): a stretch of smooth motion up to the next one, then the event.
//!
//! A step is one of both. The clock means nothing here but its end: where a recorder looks is read off the motion, so
//! that the run is the same with or without it.

use super::stretch::{self, Stretch};
use crate::collide::approach::Approach;
use crate::collide::closed::MARGIN;
use crate::collide::{Contact, Detector, Key, Reach, SolvedContact};
use crate::deadline::Deadline;
use crate::event::caps::{self, Sinking};
use crate::event::change::Looking;
use crate::event::decide::{Change, Margin, margin};
use crate::event::dense::{Dense, project};
use crate::event::ending;
use crate::event::field::Field;
use crate::event::forces::{Gathered, Held};
use crate::event::impact;
use crate::event::last_forces::LastForces;
use crate::event::look::{Paths, Window};
use crate::event::motion::Motion;
use crate::event::patience::Patience;
use crate::event::pressing::{Laid, Pressed, pressed, turn};
use crate::event::slip::{self, Pace, Slow};
use crate::event::touch::{Touch, beyond_edge_W, is_nothing};
use crate::event::watch;
use crate::event::which;
use crate::event::zeno::{self, Zeno, keep_closed, lose_together};
use crate::experiment::types::{EventDriven as Settings, Impact};
use crate::math::full_pivot::Selection;
use crate::model::Model;
use crate::outcome::Criterion;
use crate::plan::Plan;
use crate::shown::Acted;
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;
use std::cell::RefCell;

/// What ends a stretch.
#[derive(Clone, Debug)]
pub(super) enum Event {
    /// The beginning: whatever touches.
    Start,
    Impact,
    Change(Change),
    /// No force keeps a slip going, and none ends it: an impulse has to (Painlevé).
    Jam,
    /// What holds after an impact.
    Struck,
    /// A step of the integrator, and nothing else.
    Step,
}

/// What the last step was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Span {
    /// An impact, which takes no time.
    Blow,
    /// A smooth motion whose beginning puts to rest what is left of a rocking.
    Ending { step_s: f64 },
    /// A step of equal length, between events that were too many.
    Short { step_s: f64 },
    /// A smooth motion.
    Motion,
}

pub struct EventDriven {
    pub(super) tolerance: f64,
    pub(super) slow: Slow,
    /// Of the integrator: a force that swings is not stepped over.
    longest_s: f64,
    law: Impact,
    contact: bool,
    pub(super) motions: Vec<Motion>,
    pub(super) held: Vec<Held>,
    /// Their forces, world axes, while no body needs the integrator: closed forms have constant ones. None where they
    /// are shared so that some contact would pull: redundant ones move the same.
    pub(super) steady_W: Vec<Vector3<f64>>,
    pub(super) dense: Dense,
    /// Ends of slips that are known in closed form.
    pub(super) ends_s: Option<f64>,
    pub(super) next: Event,
    /// What has begun to open since the last impact, and where.
    opened: Vec<(Key, Vector3<f64>)>,
    detector: Detector,
    pub(super) found: Vec<Contact>,
    /// Flat caps of the last look at what touches.
    laid: Vec<Laid>,
    /// Looked into from outside between two steps, too.
    pub(super) gathered: RefCell<Gathered>,
    /// Forces of the last look at what is held.
    pub(super) last: LastForces,
    pub(super) zeno: Zeno,
    /// Of the projection.
    pub(super) placing: Gathered,
    /// The state before what holds was put to rest, and the time that this takes.
    pub(super) kicked: State,
    pub(super) ending_s: Option<f64>,
    /// How the next step of the integrator may be made.
    pace: Pace,
    scratch: State,
    patience: Patience,
    /// Events lead no further from here.
    pub(super) trouble: bool,
    /// Steps of equal length instead.
    stretch: Option<Stretch>,
    pub(super) span: Span,
    /// A step that takes longer is not made.
    pub(super) deadline: Deadline,
    pub(super) stalled: Option<Criterion>,
    pub(super) solved: Vec<SolvedContact>,
    pub(super) work: Work,
}

/// Error of one step of the integrator, relative to the tolerance.
pub(super) const LOCAL: f64 = 0.01;

/// Change of a velocity by the projection, over the integrator's own error, that is none of it.
const SLAP: f64 = 1e3;

/// Points of a rim that are tried, one after another: each is nearer to the one that bears.
pub(super) const POINTS: u32 = 40;

/// Steps of the integrator in the time in which something is put to rest, at most: every one is up to five times as
/// long as the one before.
const SHORTER: u32 = 33;

impl EventDriven {
    pub fn new(settings: &Settings, plan: &Plan, model: &Model, start: &State) -> Self {
        EventDriven {
            tolerance: settings.tolerance,
            slow: Slow::new(model, settings.tolerance),
            longest_s: slip::longest_s(model),
            law: settings.impact,
            contact: plan.looks,
            motions: Vec::with_capacity(model.bodies.len()),
            held: Vec::new(),
            steady_W: Vec::new(),
            dense: Dense::default(),
            ends_s: None,
            next: Event::Start,
            opened: Vec::new(),
            detector: Detector::default(),
            found: Vec::with_capacity(16),
            laid: Vec::new(),
            gathered: RefCell::default(),
            last: LastForces::default(),
            zeno: Zeno::new(settings.tolerance),
            placing: Gathered::default(),
            kicked: start.clone(),
            ending_s: None,
            pace: Pace::FREE,
            scratch: start.clone(),
            patience: stretch::patience(model, start),
            trouble: false,
            stretch: None,
            span: Span::Motion,
            deadline: Deadline::default(),
            stalled: None,
            solved: Vec::with_capacity(16),
            work: Work::default(),
        }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, end_s: f64) {
        if self.stretch.is_some() || !self.step_to_event(model, state, end_s) {
            self.step_of_stretch(model, state, end_s);
        }
        // Whatever was left in the middle of it asked the same clock before.
        if self.deadline.is_over() {
            self.stalled = Some(Criterion::Limit);
        }
    }

    /// Steps from now on have time until then.
    pub fn hurry(&mut self, deadline: Deadline) {
        self.deadline = deadline;
        self.gathered.get_mut().deadline = deadline;
        self.placing.deadline = deadline;
        if let Some(stretch) = &mut self.stretch {
            stretch.hurry(deadline);
        }
    }

    /// False: nothing has changed yet.
    fn step_to_event(&mut self, model: &Model, state: &mut State, end_s: f64) -> bool {
        state.step += 1;
        self.span = Span::Motion;
        let from_s = state.time_s;
        let event = std::mem::replace(&mut self.next, Event::Step);
        self.work.events += u64::from(matches!(event, Event::Impact | Event::Change(_)));
        let mut blow = false;
        if !matches!(event, Event::Step | Event::Change(_)) {
            self.opened.clear();
        }
        let goes_on = matches!(&event, Event::Step | Event::Change(Change { slips_on: true, .. }));
        self.slow.failed *= u32::from(goes_on);
        match event {
            Event::Step => {}
            Event::Start | Event::Impact => {
                self.detect(model, state);
                blow = self.strike(model, state);
                if blow {
                    self.held.clear();
                    self.next = Event::Struck;
                } else {
                    self.regroup(model, state, &Change::default());
                }
            }
            Event::Struck => {
                turn(model, state, (&mut self.found, &mut self.laid), (&[], &mut Change::default()));
                self.regroup(model, state, &Change::default());
            }
            Event::Change(change) => {
                let mut change = Change { opened: self.opened.clone(), ..change };
                let held = (&self.held[..], &change.opening[..]);
                let pressed = pressed(model, state, held, self.gathered.get_mut(), &mut self.work);
                self.detect_as(model, state, (&pressed, &mut change));
                self.regroup(model, state, &change);
                self.opened.extend_from_slice(&change.opening);
            }
            Event::Jam => {
                self.detect(model, state);
                let (gathered, solved) = (self.gathered.get_mut(), &mut self.solved);
                blow = impact::jam(model, state, &self.found, gathered, solved, &mut self.work);
                // Of one contact there is no such impulse; of several none may have been found.
                let is_alone = self.found.len() == 1 && model.pins.is_empty();
                self.stalled = (!blow && is_alone).then_some(Criterion::Painleve);
                self.trouble |= !blow && !is_alone;
                self.next = Event::Change(Change::default());
            }
        };
        let ending_s = self.ending_s.take();
        if blow {
            self.span = Span::Blow;
        } else if self.stalled.is_none() && !self.trouble && !matches!(self.next, Event::Jam) {
            blow = self.go_on(model, state, ending_s, end_s);
        }
        let is_over = self.patience.is_over([from_s, state.time_s], &self.work, !self.dense.is_empty());
        if std::mem::take(&mut self.trouble) || is_over {
            self.begin_stretch(model, state);
        }
        blow || state.time_s > from_s
    }

    fn begin_stretch(&mut self, model: &Model, state: &State) {
        self.work.fallbacks += 1;
        let level = self.patience.give_up(state.time_s);
        let mut stretch = Stretch::new(self.law, model, state, level);
        stretch.hurry(self.deadline);
        self.stretch = Some(stretch);
        self.motions.clear();
        self.held.clear();
        self.laid.clear();
        self.dense = Dense::default();
    }

    /// One step of equal length by time-stepping; after the last one, back to events.
    fn step_of_stretch(&mut self, model: &Model, state: &mut State, end_s: f64) {
        let Some(stretch) = &mut self.stretch else { return };
        self.kicked.copy_from(state);
        self.span = Span::Short { step_s: stretch.step(model, state, end_s) };
        if let Some(kicked) = stretch.kicked() {
            self.kicked.copy_from(kicked);
        }
        self.solved.clear();
        self.solved.extend_from_slice(stretch.contacts());
        if stretch.is_over() {
            self.work.unsolved += stretch.unsolved();
            self.stretch = None;
            self.next = Event::Start;
            self.patience.begin(state.time_s, &self.work);
        }
    }

    /// Fills `found` with what touches now.
    fn detect(&mut self, model: &Model, state: &mut State) {
        self.detect_as(model, state, (&[], &mut Change::default()));
    }

    /// The same, as caps are pressed.
    fn detect_as(&mut self, model: &Model, state: &mut State, pressed: (&[Pressed], &mut Change)) {
        self.found.clear();
        if self.contact {
            caps::level(model, state);
            self.look_around(model, state);
            if caps::level_found(model, state, &self.found) {
                self.look_around(model, state);
            }
            if model.touching_pairs {
                which::choose(model, state, &mut self.found, self.gathered.get_mut(), &mut self.work);
            }
            turn(model, state, (&mut self.found, &mut self.laid), pressed);
        }
    }

    fn look_around(&mut self, model: &Model, state: &State) {
        let reach = Reach { margin: MARGIN };
        self.detector.detect(model, state, &reach, &mut self.found, &mut self.work);
        if model.touching_pairs {
            let is_nothing = |contact: &Contact| {
                let at = (&contact.p_WC, &contact.normal);
                contact.both(model, state).is_some_and(|bodies| is_nothing(bodies, contact.feature, at))
            };
            self.found.retain(|contact| !is_nothing(contact));
            for contact in &mut self.found {
                let bodies = contact.both(model, state);
                let beyond = |bodies| beyond_edge_W(bodies, contact.feature, &contact.p_WC);
                if let Some(beyond_W) = bodies.and_then(beyond) {
                    contact.p_WC -= beyond_W;
                    contact.r_BC_W -= beyond_W;
                    contact.r_OC_W -= beyond_W;
                }
            }
            self.found = self.found.iter().flat_map(|contact| Touch::refined(model, state, contact)).collect();
            self.found.sort_by_key(Contact::key);
            caps::along_caps(model, state, &mut self.found);
            caps::leave_arcs(model, state, &mut self.found);
        }
        keep_closed(model, state, &mut self.found);
    }

    /// An impact, if something comes nearer.
    fn strike(&mut self, model: &Model, state: &mut State) -> bool {
        let strikes = |contact: &Contact| zeno::strikes(model, state, contact);
        if !self.found.iter().any(strikes) {
            return false;
        }
        let apart = self.zeno.set_apart(model, state, &mut self.found);
        self.zeno.end_bounces(model, state, &mut self.found, apart.is_empty());
        lose_together(&mut self.found, strikes);
        for contact in self.found.iter_mut().filter(|contact| contact.restitution == 0.0) {
            contact.tangential_restitution = 0.0;
        }
        let (gathered, solved, work) = (self.gathered.get_mut(), &mut self.solved, &mut self.work);
        self.scratch.copy_from(state);
        let (mut ended, mut sinking) = (false, Sinking::default());
        for _ in 0..POINTS {
            state.copy_from(&self.scratch);
            ended = impact::strike(model, state, &self.found, self.law, gathered, solved, work);
            let velocities = |i: usize, arm_W: &Vector3<f64>| caps::velocities(state, i, arm_W);
            let rates = (velocities, |contact: &Contact| caps::sinks_m_s(model, state, contact));
            if !sinking.add(model, state, &mut self.found, (1, |_| true), rates) {
                break;
            }
        }
        self.work.unsolved += u64::from(!ended);
        // What strikes next is found as any other gap that closes.
        self.found.extend(apart.into_iter().filter(|contact| !zeno::strikes(model, state, contact)));
        self.found.sort_by_key(Contact::key);
        true
    }

    /// Smooth motion, with what had to be put to rest before it. True: that took no time, and is all of the step.
    fn go_on(&mut self, model: &Model, state: &mut State, ending_s: Option<f64>, end_s: f64) -> bool {
        self.look_at_slips(model, state, true);
        let from_s = state.time_s;
        if ending_s.is_none() {
            self.kicked.copy_from(state);
        }
        let over_s = ending_s.or(self.pace.ends_s);
        let at_once = over_s.is_some_and(|over_s| from_s + over_s <= from_s);
        // What is pushed takes part.
        let mut others = if at_once { ending::coming(model, state, &self.held, &self.found) } else { Vec::new() };
        if !at_once {
            let to_s = over_s.map_or(end_s, |over_s| end_s.min(from_s + over_s));
            let ends = ending_s.is_some();
            for _ in 0..SHORTER {
                self.advance(model, state, to_s, ends);
                // Steps of the integrator do not cut an end short: the weight could not make its impulses in them.
                if !ends || self.trouble || !matches!(self.next, Event::Step) || state.time_s >= to_s {
                    break;
                }
            }
            // What leaves its line may be seen to fade only then.
            if ending_s.is_none() && self.pace.ends_s.is_none() {
                return false;
            }
            if over_s.is_some() && state.time_s == from_s && !self.trouble {
                // What is put to rest is so against others that touch: they take part.
                self.motion_to(model, state, to_s);
                self.detect(model, state);
                others = ending::others(&self.held, &self.found);
            }
        }
        self.scratch.copy_from(state);
        self.end(model, state, &others);
        // So do those that are only just open, where that drives them back: they would strike at once, and open again
        // what has been put to rest.
        if ending::pushes(model, [&self.scratch, state], &self.found) {
            state.copy_from(&self.scratch);
            self.detect(model, state);
            others = ending::others(&self.held, &self.found);
            self.scratch.copy_from(state);
            self.end(model, state, &others);
        }
        if ending_s.is_none() || !others.is_empty() || ending::changes(model, [&self.scratch, state], ending::NOTHING) {
            // Not all of it holds, or slides on; before its end it does.
            let slips_on = ending_s.is_none() && over_s.is_none_or(|over_s| state.time_s < from_s + over_s);
            self.slow.failed += u32::from(slip::go_on_fading(&self.slow, state, &self.held));
            self.next = Event::Change(Change { slips_on, ..Change::default() });
        }
        self.span = if at_once { Span::Blow } else { Span::Ending { step_s: state.time_s - from_s } };
        at_once
    }

    /// Puts what is held to rest, with others that touch.
    fn end(&mut self, model: &Model, state: &mut State, others: &[Contact]) {
        let states = [&mut self.kicked, state];
        self.solved = ending::end(model, states, &self.held, others, &mut self.placing, &mut self.work);
    }

    /// Smooth motion up to the next event, or to the end of a step of the integrator. `ends`: what is put to rest is so
    /// at the end of it, where the law says by what impulses, whatever holds in between.
    fn advance(&mut self, model: &Model, state: &mut State, end_s: f64, ends: bool) {
        let mut to_s = end_s;
        if !self.integrate(model, state, end_s) {
            self.trouble = true;
            return;
        }
        if !self.dense.is_empty() {
            to_s = self.dense.t_s + self.dense.h;
        }
        self.next = Event::Step;
        if let Some(t_s) = self.ends_s.filter(|t_s| *t_s <= to_s) {
            (to_s, self.next) = (t_s, Event::Change(Change::default()));
        }
        let fades = self.pace.ends_s.is_some();
        if !fades && self.held.iter().any(|held| !self.dense.is_empty() || held.touch.is_bounded()) {
            let paths = Paths { model, motions: &self.motions, dense: &self.dense, deadline: self.deadline };
            let until = self.work.newton_steps + self.patience.left(&self.work);
            let (gathered, at, work) = (self.gathered.get_mut(), &mut self.scratch, &mut self.work);
            let last = &mut self.last;
            let mut looking =
                Looking { paths, held: &self.held, ends, gathered, last, at, work, until, seen: Vec::new() };
            if let Some((t_s, change)) = looking.first(state.time_s, to_s) {
                let turned = looking.has_turned();
                (to_s, self.next) = (t_s, if turned { Event::Impact } else { Event::Change(change) });
            }
        }
        if self.patience.left(&self.work) == 0 {
            self.trouble = true;
            return;
        }
        // Last: beyond the border of a face others touch that are not held.
        if self.contact {
            let paths = Paths { model, motions: &self.motions, dense: &self.dense, deadline: self.deadline };
            let window = Window { from_s: state.time_s, to_s };
            if let Some(t_s) = watch::first(&paths, &self.held, window, &mut self.work) {
                (to_s, self.next) = (t_s, Event::Impact);
            }
        }
        self.end_at(model, state, to_s);
    }

    /// Smooth motion, whatever comes in its way.
    fn motion_to(&mut self, model: &Model, state: &mut State, to_s: f64) {
        self.next = Event::Step;
        if !self.integrate(model, state, to_s) {
            self.trouble = true;
            return;
        }
        let to_s = if self.dense.is_empty() { to_s } else { to_s.min(self.dense.t_s + self.dense.h) };
        self.end_at(model, state, to_s);
    }

    /// A step of the integrator, if a body needs one.
    fn integrate(&mut self, model: &Model, state: &State, end_s: f64) -> bool {
        if self.dense.is_empty() {
            return true;
        }
        let mut good = self.dense_step(model, state, end_s);
        if good && slip::leaves_lines(model, &self.dense_end(model, state), &self.held) {
            self.look_at_slips(model, state, false);
            let end_s = self.pace.ends_s.map_or(end_s, |over_s| end_s.min(state.time_s + over_s));
            good = self.dense_step(model, state, end_s);
        }
        good
    }

    fn dense_step(&mut self, model: &Model, state: &State, end_s: f64) -> bool {
        let mut dense = std::mem::take(&mut self.dense);
        self.scratch.copy_from(state);
        dense.restart(state);
        let most_s = self.longest_s.min(caps::longest_s(model, &self.held, state));
        let pace = (self.pace.most_s.min(most_s), self.pace.stiff_hz);
        let good = dense.step(&mut self.field(model), end_s, pace);
        self.dense = dense;
        good
    }

    /// What slips of bodies without closed form are from here on. `lines`: some may follow lines.
    fn look_at_slips(&mut self, model: &Model, state: &State, lines: bool) {
        self.pace = Pace::FREE;
        if !self.dense.is_empty() && self.held.iter().any(|held| held.slides().is_some()) {
            let gathered = self.gathered.get_mut();
            let Margin { solved, .. } = margin(model, state, &self.held, (gathered, &mut self.last), &mut self.work);
            self.pace = slip::look(&self.slow, (model, state), &mut self.held, (gathered, &solved), lines);
        }
    }

    /// The end of the integrator's last step.
    fn dense_end(&self, model: &Model, state: &State) -> State {
        let mut end = state.clone();
        end.time_s = self.dense.t_s + self.dense.h;
        let paths = Paths { model, motions: &self.motions, dense: &self.dense, deadline: self.deadline };
        (0..end.bodies.len()).for_each(|i| end.bodies[i] = paths.at(i, end.time_s));
        end
    }

    fn field<'a>(&'a mut self, model: &'a Model) -> Field<'a> {
        let sliding = self.held.iter().filter(|held| held.slides().is_some()).count();
        Field {
            model,
            motions: &self.motions,
            held: &self.held,
            gathered: self.gathered.get_mut(),
            state: &mut self.scratch,
            choice: if sliding > 2 { Selection::Least } else { Selection::Any },
            work: &mut self.work,
        }
    }

    /// Puts the state at the end of a stretch within the integrator's last step.
    fn end_at(&mut self, model: &Model, state: &mut State, to_s: f64) {
        if !self.dense.is_empty() && to_s > self.dense.t_s && to_s < self.dense.t_s + self.dense.h {
            self.dense.shorten(to_s);
        }
        state.time_s = to_s;
        self.put(model, state);
        if !self.dense.is_empty() {
            self.scratch.copy_from(state);
            project(model, state, &self.held, &mut self.placing);
            // What keeps a contact smoothly changes velocities by the integrator's error: more is an impact, of a face
            // that falls flat.
            if ending::changes(model, [&self.scratch, state], SLAP * LOCAL * self.tolerance) {
                state.copy_from(&self.scratch);
                self.next = Event::Impact;
            }
        }
    }

    /// What the contacts of the last step did.
    pub(super) fn acted(&self) -> Acted<'_> {
        match self.span {
            Span::Blow => Acted::Blow { contacts: &self.solved },
            Span::Motion => Acted::Motion(self),
            Span::Ending { step_s } => {
                let (kicked, contacts) = (&self.kicked, &self.solved[..]);
                Acted::Kick { kicked, contacts, step_s, approach: Approach::Touching }
            }
            Span::Short { step_s } => {
                let (kicked, contacts) = (&self.kicked, &self.solved[..]);
                Acted::Kick { kicked, contacts, step_s, approach: Approach::Middle }
            }
        }
    }
}
