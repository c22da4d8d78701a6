//! Watch over every step of a recorded run: what happens becomes events, and the story that a recording opens with.
//!
//! It looks at what a step shows and at what the judges have found, and computes next to nothing of its own, so that a
//! recorded run is as fast as another one.

use super::sample::{Event, Severity, sticks};
use super::story::{Decisive, EnergyGain, Story, TurningPoint, brief};
use crate::collide::Contact;
use crate::measure::Judge;
use crate::measure::energy::Energy;
use crate::model::Model;
use crate::outcome::Outcome;
use crate::shown::{Acted, ContactForce, Shown};
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;

/// Gain of a step, of the largest kinetic energy so far, from which it is one: above what a sound method's error of
/// position makes of a potential energy, and below every gain that has ever ended a run.
const GAIN: f64 = 1e-3;
/// Least of the energy that a gain is held against, of a fall of all bodies by their size.
const LEAST: f64 = 1e-2;
/// Approach, of the fastest so far, below which a touch is no impact, and steps of gravity that are none either.
const SLOW: f64 = 1e-3;
const STEPS_OF_GRAVITY: f64 = 2.0;
/// Residual and ghost from which they are events, as in the doubts about a row; a next one is ten times as large.
const TOLERATED: f64 = 1e-6;
const MORE: f64 = 10.0;
/// Energy above the start's, of the largest kinetic energy, up to which a run is calm.
const CALM: f64 = 0.1;
/// Growth of the energy, of the start's or of a fall, from which a run that ends is one that has exploded.
const EXPLODED: f64 = 10.0;
/// Rounding of an energy's parts.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Most events of a kind that are logged; the end says how many more there were.
const MOST_EVENTS: u64 = 200;

/// Kinds of event; each has a limit of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Happening {
    Impact,
    Slip,
    Stick,
    LiftOff,
    Gain,
    Unsolved,
    Residual,
    Ghost,
    Passage,
    Fallback,
}

impl Happening {
    const ALL: [(Happening, &'static str); 10] = [
        (Happening::Impact, "impacts"),
        (Happening::Slip, "beginnings of sliding"),
        (Happening::Stick, "ends of sliding"),
        (Happening::LiftOff, "lift-offs"),
        (Happening::Gain, "gains of energy"),
        (Happening::Unsolved, "steps that are not solved"),
        (Happening::Residual, "residuals"),
        (Happening::Ghost, "ghosts"),
        (Happening::Passage, "passages"),
        (Happening::Fallback, "stretches of equal steps"),
    ];
}

/// Two bodies, or a body and the container, that are near each other.
#[derive(Clone, Copy, Debug)]
struct NearBodies {
    bodies: (usize, Option<usize>),
    touches: bool,
    slides: bool,
}

/// What a step did between two bodies.
struct Touch {
    pair: NearBodies,
    /// The fastest; −∞ of what touched before, where nobody asks.
    approach_m_s: f64,
    /// Along the normals.
    pushed: f64,
}

/// The watch of one run.
pub struct Watch {
    solves: bool,
    up_to_now: Story,
    pairs: Vec<NearBodies>,
    next: Vec<NearBodies>,
    found: Vec<Touch>,
    events: Vec<Event>,
    /// One of the step's is an impact, or worse.
    is_major: bool,
    counts: [u64; Happening::ALL.len()],
    g_m_s2: f64,
    fall_j: f64,
    /// Energy up to which the run is calm, and whether it was after the last step.
    calm_j: f64,
    is_calm: bool,
    kinetic_max_j: f64,
    last_j: f64,
    most_j: f64,
    fastest_m_s: f64,
    residual: f64,
    ghost: f64,
    passages: u64,
    unsolved: u64,
    fallbacks: u64,
    most: Option<(usize, u64, f64)>,
    largest: Option<(f64, EnergyGain)>,
    /// The step that left the calm, if it was never found again.
    onset: Option<EnergyGain>,
    first_s: Option<f64>,
    last_s: f64,
}

impl Watch {
    /// Of a run from `start`; `solves`: its method claims to solve the law of contact.
    pub fn new(model: &Model, start: &State, solves: bool) -> Self {
        let g = model.gravity_m_s2.norm();
        let energy = Energy::of(model, start);
        let weigh = |body: &crate::model::Body| body.mass_kg * g * body.bounding_radius_m;
        let fall_j: f64 = model.bodies.iter().filter(|body| !body.driven).map(weigh).sum();
        let start_j = energy.total_j();
        Watch {
            solves,
            up_to_now: Story { start_j, ..Story::default() },
            pairs: Vec::new(),
            next: Vec::new(),
            found: Vec::new(),
            events: Vec::new(),
            is_major: false,
            counts: [0; Happening::ALL.len()],
            g_m_s2: g,
            fall_j,
            calm_j: start_j + CALM * start_j.abs().max(LEAST * fall_j),
            is_calm: false,
            kinetic_max_j: energy.kinetic_j,
            last_j: start_j,
            most_j: f64::NEG_INFINITY,
            fastest_m_s: 0.0,
            residual: TOLERATED,
            ghost: TOLERATED,
            passages: 0,
            unsolved: 0,
            fallbacks: 0,
            most: None,
            largest: None,
            onset: None,
            first_s: None,
            last_s: 0.0,
        }
    }

    /// Looks at a step, judged already; says if it is one to be recorded, with those around it.
    pub fn look(&mut self, model: &Model, shown: &Shown, judge: &Judge) -> bool {
        if shown.stalled.is_some() {
            return false;
        }
        let Shown { before, after, .. } = *shown;
        if judge.repeats {
            // The same contacts do the same, and no energy comes or goes.
            if self.is_calm {
                self.up_to_now.calm_until_s = after.time_s;
            }
            return false;
        }
        self.is_major = false;
        let at = (after.step, acted_s(shown));
        match shown.acted {
            Acted::Kick { contacts: [], .. } if self.pairs.is_empty() => {}
            Acted::Kick { contacts, step_s, .. } => {
                let slow_m_s = STEPS_OF_GRAVITY * self.g_m_s2 * step_s;
                self.touches(model, (before, at), contacts.iter().map(|s| (&s.contact, s.impulse_W)), slow_m_s);
            }
            Acted::Blow { contacts } => {
                let pushes = contacts.iter().map(|s| (&s.contact, s.impulse_W));
                for touch in touches(before, pushes, |_| false) {
                    self.impact(model, at, &touch);
                }
            }
            Acted::Motion(_) => {
                let forces = shown.way.map(|way| way.forces_at(model, after)).unwrap_or_default();
                let pushes = forces.iter().map(|ContactForce { contact, force_W }| (contact, *force_W));
                // Whoever follows events has its impacts apart from its motion.
                self.touches(model, (before, at), pushes, f64::INFINITY);
            }
        }
        let is_major = self.is_major;
        let gained = self.energy(after, at.1, judge);
        let doubted = self.judged(at, judge);
        let is_notable = is_major || gained || doubted;
        if is_notable {
            self.first_s.get_or_insert(before.time_s);
            self.last_s = after.time_s;
        }
        is_notable
    }

    /// Whether the step that led to a state has gained more than any before.
    pub fn gains_most(&self, after: &State) -> bool {
        self.largest.is_some_and(|(_, gain)| gain.time_s == after.time_s && gain.step == after.step)
    }

    /// Looks at the counters of work after a step.
    pub fn count(&mut self, work: &Work, at: (u64, f64)) {
        if work.unsolved > self.unsolved {
            self.unsolved = work.unsolved;
            let severity = self.doubt();
            self.happen(Happening::Unsolved, at, severity, || "contacts of this step are not solved".to_string());
        }
        if work.fallbacks > self.fallbacks {
            self.fallbacks = work.fallbacks;
            self.happen(Happening::Fallback, at, Severity::Warning, || {
                "events follow too fast: steps of equal length from here".to_string()
            });
        }
    }

    /// Events since the last call.
    pub fn events(&mut self) -> std::vec::Drain<'_, Event> {
        self.events.drain(..)
    }

    /// The story of a run that has ended so.
    pub fn story(&mut self, state: &State, outcome: Outcome, said: String) -> Story {
        let has_grown = self.grown() > EXPLODED;
        let mut story = std::mem::take(&mut self.up_to_now);
        if let Some((ratio, gain)) = self.largest {
            let EnergyGain { step, acted_s: time_s, before_j, after_j, .. } = gain;
            let text = format!("{} → {} J, × {}", brief(before_j), brief(after_j), brief(ratio));
            story.turns.push(TurningPoint { what: Decisive::LargestGain, step, time_s, text });
        }
        if let Some(EnergyGain { step, acted_s: time_s, before_j, after_j, .. }) =
            self.onset.filter(|_| outcome == Outcome::Diverged || has_grown)
        {
            let text = format!("{} → {} J", brief(before_j), brief(after_j));
            story.turns.push(TurningPoint { what: Decisive::Onset, step, time_s, text });
        }
        if let Some((contacts, step, time_s)) = self.most {
            let text = format!("{contacts} contact{} at once", if contacts == 1 { "" } else { "s" });
            story.turns.push(TurningPoint { what: Decisive::MostContacts, step, time_s, text });
        }
        story.turns.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        let (step, end_s) = (state.step, state.time_s);
        story.turns.push(TurningPoint { what: Decisive::End, step, time_s: end_s, text: said });
        // What has exploded and goes on is looked at as what has diverged: before its bodies are gone.
        let explodes = outcome == Outcome::Diverged || (self.onset.is_some() && has_grown);
        let stretch_s = match (explodes, self.first_s) {
            (true, _) if outcome == Outcome::Diverged => [story.calm_until_s - 0.15 * end_s, end_s],
            (true, _) => [0.85, 1.15].map(|part| part * story.calm_until_s),
            (false, Some(first_s)) if self.last_s > first_s => [first_s - 0.1 * end_s, self.last_s + 0.25 * end_s],
            (false, _) => [0.0, end_s],
        };
        story.stretch_s = stretch_s.map(|t| t.clamp(0.0, end_s));
        if !explodes {
            story.calm_until_s = end_s;
        }
        story
    }

    /// Numbers of the events of each kind that were not logged, in words.
    pub fn unlogged(&self) -> Option<String> {
        let more = Happening::ALL.iter().zip(self.counts).filter(|(_, count)| *count > MOST_EVENTS);
        let more: Vec<_> = more.map(|((_, name), count)| format!("{} {name}", count - MOST_EVENTS)).collect();
        (!more.is_empty()).then(|| format!("further events that are not listed: {}", more.join(", ")))
    }

    /// All pairs that are near in a step, against those of the step before.
    fn touches<'a>(
        &mut self,
        model: &Model,
        (before, at): (&State, (u64, f64)),
        pushes: impl ExactSizeIterator<Item = (&'a Contact, Vector3<f64>)>,
        slow_m_s: f64,
    ) {
        let count = pushes.len();
        if count == 0 && self.pairs.is_empty() {
            return;
        }
        if count > self.most.map_or(0, |(most, ..)| most) {
            self.most = Some((count, at.0, at.1));
        }
        let mut next = std::mem::take(&mut self.next);
        next.clear();
        let pairs = std::mem::take(&mut self.pairs);
        let mut known = pairs.iter().peekable();
        let mut found = std::mem::take(&mut self.found);
        found.clear();
        // Of most that stand in this order; of what is not found, an approach too many is asked for.
        let mut earlier = pairs.iter().peekable();
        let touched_already = |bodies| {
            while earlier.next_if(|pair| pair.bodies < bodies).is_some() {}
            earlier.peek().is_some_and(|pair| pair.bodies == bodies && pair.touches)
        };
        found.extend(touches(before, pushes, touched_already));
        if !found.is_sorted_by_key(|touch| touch.pair.bodies) {
            found.sort_by_key(|touch| touch.pair.bodies);
        }
        for touch in found.iter() {
            let bodies = touch.pair.bodies;
            while let Some(gone) = known.next_if(|pair| pair.bodies < bodies) {
                self.part(model, gone, at);
            }
            let was = known.next_if(|pair| pair.bodies == bodies);
            let touched = was.is_some_and(|was| was.touches);
            if touch.pair.touches && !touched {
                let floor_m_s = slow_m_s.max(SLOW * self.fastest_m_s);
                if touch.approach_m_s > floor_m_s {
                    self.impact(model, at, touch);
                } else {
                    self.first(model, at, touch);
                }
            }
            if let Some(was) = was.filter(|was| was.touches) {
                if !touch.pair.touches {
                    self.part(model, was, at);
                } else if touch.pair.slides != was.slides {
                    let (kind, does) = match touch.pair.slides {
                        true => (Happening::Slip, "slides"),
                        false => (Happening::Stick, "sticks"),
                    };
                    self.happen(kind, at, Severity::Info, || {
                        let [body, other] = names(model, bodies);
                        format!("{body} {does} on {other}")
                    });
                }
            }
            next.push(touch.pair);
        }
        for gone in known {
            self.part(model, gone, at);
        }
        (self.pairs, self.next, self.found) = (next, pairs, found);
    }

    fn part(&mut self, model: &Model, pair: &NearBodies, at: (u64, f64)) {
        if pair.touches {
            self.happen(Happening::LiftOff, at, Severity::Info, || {
                let [body, other] = names(model, pair.bodies);
                format!("{body} lifts off {other}")
            });
        }
    }

    fn impact(&mut self, model: &Model, at: (u64, f64), touch: &Touch) {
        self.fastest_m_s = self.fastest_m_s.max(touch.approach_m_s);
        self.first(model, at, touch);
        self.happen(Happening::Impact, at, Severity::Info, || {
            let [body, other] = names(model, touch.pair.bodies);
            let (speed, impulse) = (brief(touch.approach_m_s), brief(touch.pushed));
            format!("impact: {body} hits {other} at {speed} m/s, impulse {impulse} N s")
        });
    }

    /// The first touch of all.
    fn first(&mut self, model: &Model, (step, time_s): (u64, f64), touch: &Touch) {
        if self.up_to_now.turn(Decisive::FirstContact).is_some() {
            return;
        }
        let [body, other] = names(model, touch.pair.bodies);
        let speed = brief(touch.approach_m_s.max(0.0));
        let from_start = touch.approach_m_s <= SLOW * self.fastest_m_s || step <= 1 && touch.approach_m_s <= 0.0;
        let text = match from_start {
            true => format!("{body} and {other}"),
            false => format!("{body} and {other}, approaching at {speed} m/s"),
        };
        self.up_to_now.turns.push(TurningPoint { what: Decisive::FirstContact, step, time_s, text });
        self.first_s.get_or_insert(time_s);
        self.last_s = self.last_s.max(time_s);
    }

    /// Whether the step gained energy.
    fn energy(&mut self, after: &State, acted_s: f64, judge: &Judge) -> bool {
        let (before_j, after_j) = (self.last_j, judge.energy.without_work_j());
        self.last_j = after_j;
        // Against what there was before: an explosion is its own scale.
        let kinetic_max_j = self.kinetic_max_j;
        self.kinetic_max_j = kinetic_max_j.max(judge.energy.kinetic_j());
        self.most_j = self.most_j.max(after_j);
        self.is_calm = after_j <= self.calm_j;
        if self.is_calm {
            self.up_to_now.calm_until_s = after.time_s;
            self.onset = None;
        } else if self.onset.is_none() {
            self.onset = Some(EnergyGain { step: after.step, acted_s, time_s: after.time_s, before_j, after_j });
        }
        if after_j <= before_j {
            return false;
        }
        let scale_j = kinetic_max_j.max(LEAST * self.fall_j);
        let scale_j = if scale_j > 0.0 { scale_j } else { self.kinetic_max_j };
        let rounding_j = ROUNDING * (after_j.abs() + before_j.abs() + self.fall_j);
        let is_gain = after_j - before_j > (GAIN * scale_j).max(rounding_j);
        if !is_gain {
            return false;
        }
        let floor_j = before_j.max(GAIN * scale_j);
        let ratio = (floor_j + after_j - before_j) / floor_j;
        let gain = EnergyGain { step: after.step, acted_s, time_s: after.time_s, before_j, after_j };
        let story = &mut self.up_to_now;
        story.gains_count += 1;
        if story.gains.len() < Story::MOST_GAINS {
            story.gains.push(gain);
        }
        if story.gains_count == 1 {
            let text = format!("{} → {} J", brief(before_j), brief(after_j));
            let (step, time_s) = (gain.step, gain.acted_s);
            story.turns.push(TurningPoint { what: Decisive::FirstGain, step, time_s, text });
        }
        if self.largest.is_none_or(|(largest, _)| ratio > largest) {
            self.largest = Some((ratio, gain));
        }
        self.happen(Happening::Gain, (gain.step, acted_s), Severity::Warning, || {
            format!("gain of energy: {} → {} J, × {}", brief(before_j), brief(after_j), brief(ratio))
        });
        true
    }

    /// Largest energy, of the start's or of a fall.
    fn grown(&self) -> f64 {
        let of_j = self.up_to_now.start_j.abs().max(self.fall_j);
        if of_j > 0.0 { (self.most_j / of_j).max(0.0) } else { 0.0 }
    }

    /// What the judges have found in the step.
    fn judged(&mut self, at: (u64, f64), judge: &Judge) -> bool {
        let severity = self.doubt();
        let mut found = false;
        if let Some(residual) = judge.residual.max.filter(|residual| *residual > self.residual) {
            self.residual = residual * MORE;
            found = true;
            self.happen(Happening::Residual, at, severity, || {
                format!("the law of contact is missed: residual {}", brief(residual))
            });
        }
        if let Some(ghost) = judge.geometry.ghost_impulse_max_rel.filter(|ghost| *ghost > self.ghost) {
            self.ghost = ghost * MORE;
            found = true;
            self.happen(Happening::Ghost, at, severity, || {
                format!("ghost: an impulse where nothing touches, {} of m v", brief(ghost))
            });
        }
        if let Some(passages) = judge.geometry.passed_through.filter(|passages| *passages > self.passages) {
            self.passages = passages;
            found = true;
            self.happen(Happening::Passage, at, severity, || "bodies pass through each other".to_string());
        }
        found
    }

    /// What is a fault of a method that claims to solve is a property of another one.
    fn doubt(&self) -> Severity {
        if self.solves { Severity::Warning } else { Severity::Info }
    }

    fn happen(&mut self, kind: Happening, at: (u64, f64), severity: Severity, text: impl FnOnce() -> String) {
        let count = &mut self.counts[kind as usize];
        *count += 1;
        if *count <= MOST_EVENTS {
            self.is_major |= kind == Happening::Impact || severity != Severity::Info;
            self.events.push(Event { step: at.0, time_s: at.1, severity, text: text() });
        }
    }
}

/// Instant at which the contacts of a step act.
fn acted_s(shown: &Shown) -> f64 {
    match shown.acted {
        Acted::Kick { kicked, .. } => kicked.time_s,
        Acted::Blow { .. } | Acted::Motion(_) => shown.after.time_s,
    }
}

fn names(model: &Model, (body, other): (usize, Option<usize>)) -> [&str; 2] {
    [&model.bodies[body].name, other.map_or("container", |other| model.bodies[other].name.as_str())]
}

/// Contacts by the two bodies that they are between; contacts of two bodies stand together. How fast they approach is
/// asked of those alone that did not touch before.
fn touches<'a>(
    before: &State,
    pushes: impl Iterator<Item = (&'a Contact, Vector3<f64>)>,
    mut touched_already: impl FnMut((usize, Option<usize>)) -> bool,
) -> impl Iterator<Item = Touch> {
    let mut pushes = pushes.peekable();
    std::iter::from_fn(move || {
        let (first, _) = pushes.peek()?;
        let bodies = (first.body, first.other);
        let is_new = !touched_already(bodies);
        let mut touch = Touch {
            pair: NearBodies { bodies, touches: false, slides: true },
            approach_m_s: f64::NEG_INFINITY,
            pushed: 0.0,
        };
        while let Some((contact, push)) = pushes.next_if(|(contact, _)| (contact.body, contact.other) == bodies) {
            let along = push.dot(&contact.normal);
            if along > 0.0 {
                touch.pair.touches = true;
                touch.pushed += along;
                if touch.pair.slides {
                    touch.pair.slides = !sticks(push.into(), contact.normal.into(), contact.friction);
                }
            }
            if !is_new {
                continue;
            }
            let velocity = contact.velocity(|i| [before.bodies[i].v_WB, before.bodies[i].w_WB]);
            touch.approach_m_s = touch.approach_m_s.max(-velocity.dot(&contact.normal));
        }
        touch.pair.slides &= touch.pair.touches;
        Some(touch)
    })
}
