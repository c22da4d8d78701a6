//! Contacts of a step before its impulses are known, and what these show: which have to be asked for, and which not.
//!
//! A step asks of every contact that may close that it stays open; then its impulses say what they close or hold up
//! besides. Contacts that were left out and would close are asked for as well, pairs in doubt (`collide::doubt`) are
//! judged with the impulses of all others, and bodies that impulses lead farther than they were looked at are looked
//! at again. That is repeated until nothing changes; where nothing is in doubt, once is enough.
//!
//! Bodies that would come together and be through each other, or deep inside, within the step are not asked to stay
//! apart from afar: the step is to end where they meet (`hit_s`), and the next one begins with a contact.

use super::scratch::Scratch;
use crate::collide::approach::{Approach, foresee};
use crate::collide::closed::{is_closed_to_rounding, rounding_m};
use crate::collide::doubt::{DoubtfulPair, Doubts, band_m};
use crate::collide::way::{FreeTurn, Moving, Way};
use crate::collide::{Ahead, Contact, Key};
use crate::exact::free_rotation::FreeRotation;
use crate::model::{Body, Model};
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// Sine of the angle by which an axis may turn that stays the same.
const SAME_AXIS: f64 = 1e-3;
/// A slack to begin with, in ways that the step's forces lead a body: impulses hold it against them, with some to
/// spare. What impulses lead farther is looked at again.
const SLACK: f64 = 3.0;
/// Rounds after which what is asked for stays so, and rounds in all.
const SETTLING: u32 = 8;
const MOST: u32 = 16;
/// Of a step: one that bodies turn too far in is cut by this at least.
const SHORTER: f64 = 0.9;
/// Cuts of a step of the clock by which it is left to lead bodies as much deeper into each other again.
const OFTEN: f64 = 200.0;
/// Of a step that ends where bodies hit each other: its end.
const AT_THE_END: f64 = 1.0 - 1e-6;
/// Cosine of the angle within which two axes bear the same load, and how near their points are, of the smaller body.
const BESIDE: f64 = 0.99;
const NEXT: f64 = 0.05;
/// Of a slack: a lead beyond it that is rounding.
const LED: f64 = 1.0 + 1e-6;
/// Of an overlap that others leave: what may come of it at another place of the same bodies.
const AS_DEEP: f64 = 2.0;

/// How deep a body is in what it touches, or will be at the end of the step: the most, the pair that is, and the most
/// of any other pair.
#[derive(Clone, Copy, Debug, Default)]
struct Depth {
    most_m: f64,
    with: Option<usize>,
    next_m: f64,
}

impl Depth {
    fn note(&mut self, with: Option<usize>, depth_m: f64) {
        if self.with == with && self.most_m > 0.0 {
            self.most_m = self.most_m.max(depth_m);
        } else if depth_m > self.most_m {
            *self = Depth { most_m: depth_m, with, next_m: self.most_m };
        } else {
            self.next_m = self.next_m.max(depth_m);
        }
    }

    fn beside(&self, pair: Option<usize>) -> f64 {
        if self.with == pair { self.next_m } else { self.most_m }
    }
}

/// Contacts of a step as far as they are known.
#[derive(Debug, Default)]
pub(super) struct Foreseen {
    /// Those of which one axis may close, and whether they are asked for.
    contacts: Vec<Contact>,
    may_close: Vec<bool>,
    doubts: Doubts,
    /// What was asked for when bodies are looked at again.
    earlier: Doubts,
    /// Keys of what is asked for, sorted.
    asked: Vec<Key>,
    /// How far the step's forces lead every body, and how far it was looked ahead for what impulses do.
    fall_m: Vec<f64>,
    slack_m: Vec<f64>,
    depths: Vec<Depth>,
    points: Vec<Contact>,
    round: u32,
    /// The last impulses ask for other contacts still.
    pub(super) is_given_up: bool,
    /// The first time in the step at which two bodies come together that would be through each other by its end.
    hit_s: Option<f64>,
    /// The first time at which bodies have turned too far beside each other for their way to be known.
    turned_s: Option<f64>,
    /// The first time at which bodies that are asked to stay apart turn deep into each other.
    deep_s: Option<f64>,
    /// Of every body: it turns so far beside another one that its turn is to be one in closed form.
    pub(super) turns_far: Vec<bool>,
    /// The step ends where bodies hit each other: what meets then is the next one's.
    pub(super) is_up_to_hit: bool,
    /// How often the step of the clock has been cut.
    pub(super) cuts: u32,
    /// The step is not to be cut any more: what hits is asked to stay apart from afar.
    pub(super) is_whole: bool,
}

/// The earlier of two times.
fn note_earlier(hit_s: &mut Option<f64>, other_s: f64) {
    *hit_s = Some(hit_s.map_or(other_s, |first_s| first_s.min(other_s)));
}

/// Mean velocities of a body through the step, with its forces and impulses.
fn moving(Scratch { free, response, turning, .. }: &Scratch, body: usize) -> Moving {
    let (free, u, turning) = (&free[body], &response[body], turning[body]);
    Moving { v: free.v + u.v, w: free.w + u.w + turning, turning }
}

/// How a body turns on without a torque.
fn freely<'a>(body: &'a Body, at: &'a BodyState, w_WB: &Vector3<f64>) -> FreeTurn<'a> {
    let rotation = FreeRotation::new(&body.I_B, &at.q_WB, w_WB);
    Box::new(move |time_s| rotation.at(time_s).0)
}

/// How far a gap opens in the step, in metres.
fn opens_m(scratch: &Scratch, contact: &Contact, step_s: f64) -> f64 {
    let velocities = |i: usize| {
        let Moving { v, w, .. } = moving(scratch, i);
        [v, w]
    };
    step_s * contact.normal.dot(&contact.velocity(velocities))
}

impl Foreseen {
    /// With room for so many contacts and bodies, so that no step allocates.
    pub(super) fn with_capacity(contacts: usize, bodies: usize) -> Self {
        Foreseen {
            contacts: Vec::with_capacity(contacts),
            may_close: Vec::with_capacity(contacts),
            asked: Vec::with_capacity(contacts),
            fall_m: Vec::with_capacity(bodies),
            slack_m: Vec::with_capacity(bodies),
            depths: Vec::with_capacity(bodies),
            turns_far: vec![false; bodies],
            ..Foreseen::default()
        }
    }

    /// Looks at what may come in the step. `last`: impulses of the step before, in the order of contacts.
    pub(super) fn look(
        &mut self,
        model: &Model,
        state: &State,
        scratch: &mut Scratch,
        last: &[(Key, Vector3<f64>)],
        step_s: f64,
    ) {
        (self.round, self.is_given_up) = (0, false);
        (self.hit_s, self.turned_s, self.deep_s) = (None, None, None);
        self.fall_m.clear();
        let bodies = model.bodies.iter().zip(&state.bodies).zip(&scratch.free);
        self.fall_m.extend(bodies.map(|((body, at), free)| {
            step_s * ((free.v - at.v_WB).norm() + body.bounding_radius_m * (free.w - at.w_WB).norm())
        }));
        self.slack_m.clear();
        self.slack_m.extend(self.fall_m.iter().map(|fall_m| SLACK * fall_m));
        self.see(model, state, scratch, step_s);
        self.ask_what_pushed(model, last);
        self.ask(&mut scratch.found);
    }

    /// What pushed in the last step mostly pushes on. But what has come off an edge that another contact bears beside:
    /// an iteration would go on to share the load between the two.
    fn ask_what_pushed(&mut self, model: &Model, last: &[(Key, Vector3<f64>)]) {
        for k in 0..self.doubts.list().len() {
            let doubt = &self.doubts.list()[k];
            let [a, b] = doubt.pair;
            let first = last.partition_point(|(key, _)| (key.0, key.1) < (a, Some(b)));
            let mut own = last[first..].iter().take_while(|(key, _)| (key.0, key.1) == (a, Some(b)));
            let pushed = own.any(|(_, p)| *p != Vector3::zeros());
            if pushed && (doubt.touches || !self.is_borne_beside(model, doubt)) {
                self.doubts.list_mut()[k].is_imposed = true;
            }
        }
    }

    /// Whether another contact of one of the two touches next to it, along the same axis.
    fn is_borne_beside(&self, model: &Model, doubt: &DoubtfulPair) -> bool {
        let touching = self.contacts.iter().filter(|contact| is_closed_to_rounding(model, contact));
        let others = self.doubts.list().iter().filter(|other| other.touches).flat_map(|other| &other.points);
        let sizes_m = doubt.pair.map(|i| model.bodies[i].bounding_radius_m);
        let near_m = NEXT * sizes_m[0].min(sizes_m[1]);
        touching.chain(others).any(|contact| {
            let bears = |point: &Contact| {
                let is_next = (contact.p_WC - point.p_WC).norm() <= near_m;
                let along = contact.normal.dot(&point.normal);
                let same = |(i, _, s): (usize, Vector3<f64>, f64), (j, _, t): (usize, Vector3<f64>, f64)| {
                    i == j && s * t * along > BESIDE
                };
                is_next && contact.ends().any(|of| point.ends().any(|own| same(of, own)))
            };
            (contact.body, contact.other) != (doubt.pair[0], Some(doubt.pair[1])) && doubt.points.iter().any(bears)
        })
    }

    /// Whether nothing was near in the step looked at.
    pub(super) fn is_empty(&self) -> bool {
        self.contacts.is_empty() && self.doubts.list().is_empty()
    }

    /// When the step is to end, of which so much is left after its kick: where bodies hit each other, turn into each
    /// other, or have turned too far.
    pub(super) fn cut_s(&self, after_s: f64) -> Option<f64> {
        let turned_s = self.turned_s.filter(|turned_s| *turned_s < SHORTER * after_s);
        let is_before_end = |deep_s: &f64| *deep_s < AT_THE_END * after_s;
        let deep_s = self.deep_s.filter(is_before_end).map(|deep_s| deep_s.min(SHORTER * after_s));
        [self.hit_s, turned_s, deep_s].into_iter().flatten().reduce(f64::min)
    }

    /// Fills `contacts` and `doubts`.
    fn see(&mut self, model: &Model, state: &State, scratch: &mut Scratch, step_s: f64) {
        let Scratch { detector, free, work, .. } = scratch;
        let free = |i: usize| [free[i].v, free[i].w];
        let ahead = Ahead { model, state, free: &free, slack_m: &self.slack_m, step_s };
        detector.look_ahead(model, state, &ahead, (&mut self.contacts, &mut self.doubts), work);
        foresee(model, &self.contacts, free, |i| self.fall_m[i], step_s, &mut self.may_close);
    }

    /// Fills `found` with what is asked for, in the order of contacts.
    fn ask(&mut self, found: &mut Vec<Contact>) {
        found.clear();
        let asked = self.contacts.iter().zip(&self.may_close).filter(|(_, may_close)| **may_close);
        found.extend(asked.map(|(contact, _)| *contact));
        let simple = found.len();
        found.extend(self.doubts.list().iter().filter(|doubt| doubt.is_imposed).flat_map(|doubt| &doubt.points));
        if found.len() > simple {
            found.sort_unstable_by_key(Contact::key);
        }
        self.asked.clear();
        self.asked.extend(found.iter().map(Contact::key));
    }

    /// Whether the impulses in `scratch` ask for other contacts than those that they are of, which then are in
    /// `scratch.found`.
    pub(super) fn revise(
        &mut self,
        model: &Model,
        state: &State,
        scratch: &mut Scratch,
        (approach, step_s): (Approach, f64),
    ) -> bool {
        self.round += 1;
        self.look_farther(model, state, scratch, step_s);
        let mut changed = self.ask_what_closes(model, scratch, step_s);
        if !self.doubts.list().is_empty() {
            self.measure_depths(model, scratch, step_s);
            changed |= self.judge(model, state, scratch, (approach, step_s));
        }
        if !changed || self.round == MOST {
            self.watch_what_turns(model, state, scratch, (approach, step_s));
        }
        self.is_given_up = changed && self.round == MOST;
        if changed && !self.is_given_up {
            self.ask(&mut scratch.found);
            return true;
        }
        false
    }

    /// Looks again where impulses lead bodies farther than they were looked at.
    fn look_farther(&mut self, model: &Model, state: &State, scratch: &mut Scratch, step_s: f64) {
        let mut farther = false;
        for ((slack_m, body), u) in self.slack_m.iter_mut().zip(&model.bodies).zip(&scratch.response) {
            let led_m = step_s * (u.v.norm() + u.w.norm() * body.bounding_radius_m);
            if led_m > *slack_m * LED && body.solid().is_some() {
                *slack_m = led_m;
                farther = true;
            }
        }
        if !farther {
            return;
        }
        std::mem::swap(&mut self.doubts, &mut self.earlier);
        self.see(model, state, scratch, step_s);
        for (contact, may_close) in self.contacts.iter().zip(&mut self.may_close) {
            *may_close |= self.asked.binary_search(&contact.key()).is_ok();
        }
        for doubt in self.doubts.list_mut() {
            let same = self.earlier.list().binary_search_by_key(&doubt.pair, |earlier| earlier.pair);
            if let Ok(at) = same {
                let earlier = &self.earlier.list()[at];
                doubt.is_imposed = earlier.is_imposed;
                doubt.is_sure = earlier.is_sure;
                doubt.points.clone_from(&earlier.points);
            }
        }
    }

    /// Contacts that were left out and close by what the others do.
    fn ask_what_closes(&mut self, model: &Model, scratch: &Scratch, step_s: f64) -> bool {
        let mut changed = false;
        for (contact, may_close) in self.contacts.iter().zip(&mut self.may_close).filter(|(_, may_close)| !**may_close)
        {
            let end_m = contact.gap_m + opens_m(scratch, contact, step_s);
            if end_m < -rounding_m(model, contact) {
                *may_close = true;
                changed = true;
            }
        }
        changed
    }

    /// How deep bodies are inside others that they touch, before the step or after it: what a solver leaves.
    fn measure_depths(&mut self, model: &Model, scratch: &Scratch, step_s: f64) {
        self.depths.clear();
        self.depths.resize(model.bodies.len(), Depth::default());
        for contact in &scratch.found {
            let depth_m = -(contact.gap_m + opens_m(scratch, contact, step_s).min(0.0));
            if depth_m > 0.0 {
                let other = contact.other;
                self.depths[contact.body].note(other, depth_m);
                if let Some(other) = other {
                    self.depths[other].note(Some(contact.body), depth_m);
                }
            }
        }
    }

    /// Pairs in doubt, each with the impulses of all others.
    fn judge(
        &mut self,
        model: &Model,
        state: &State,
        scratch: &mut Scratch,
        (approach, step_s): (Approach, f64),
    ) -> bool {
        let Foreseen { doubts, depths, points, hit_s, is_whole, is_up_to_hit, round, turns_far, .. } = self;
        *hit_s = None;
        let Scratch { free, response, turning, problem, found, impulses, work, .. } = scratch;
        let mut changed = false;
        for doubt in doubts.list_mut() {
            let [a, b] = doubt.pair;
            let first = found.partition_point(|c| (c.body, c.other) < (a, Some(b)));
            let own = found[first..].iter().take_while(|c| (c.body, c.other) == (a, Some(b))).count();
            let mut without = [a, b].map(|i| Twist { v: free[i].v + response[i].v, w: free[i].w + response[i].w });
            let mut pushed = false;
            for (block, p) in problem.blocks[first..first + own].iter().zip(&impulses[first..first + own]) {
                pushed |= *p != Vector3::zeros();
                for (without, end) in without.iter_mut().zip(block.ends()) {
                    end.take_off(p, without);
                }
            }
            if doubt.is_imposed && !pushed {
                continue;
            }
            let moving = [0, 1].map(|end| {
                let turning = turning[doubt.pair[end]];
                Moving { v: without[end].v, w: without[end].w + turning, turning }
            });
            let Some(way) = Way::new(model, state, doubt.pair, moving, step_s, freely) else { continue };
            note_far(turns_far, &way, doubt.pair);
            let beside_m = depths[a].beside(Some(b)).max(depths[b].beside(Some(a)));
            let band_m = band_m(model, doubt.pair, &state.bodies[a]).max(AS_DEEP * beside_m);
            let Some(meet_s) = way.meet_s(band_m, work) else {
                if doubt.is_imposed && *round < SETTLING {
                    doubt.is_imposed = false;
                    doubt.is_sure = false;
                    changed = true;
                }
                continue;
            };
            // What is inside at the middle of a step is sent back from there, unless it is through by then.
            let is_half_way = approach == Approach::Middle;
            let is_far = if is_half_way { way.is_through(meet_s) } else { way.is_deep(meet_s) };
            if !doubt.is_imposed && way.is_from_afar(meet_s) && is_far && !*is_whole {
                note_earlier(hit_s, meet_s);
                continue;
            }
            if !doubt.is_imposed && *is_up_to_hit && meet_s > AT_THE_END * step_s {
                continue;
            }
            way.points(meet_s, points, work);
            if points.is_empty() {
                continue;
            }
            let is_same =
                doubt.is_sure || doubt.is_imposed && doubt.normal().cross(&points[0].normal).norm() <= SAME_AXIS;
            if is_same || (doubt.is_imposed && *round >= SETTLING) {
                continue;
            }
            if is_half_way && is_far {
                points.iter_mut().filter(|point| point.restitution > 0.0).for_each(|point| point.gap_m = 0.0);
            }
            doubt.points.clone_from(points);
            doubt.is_sure = !doubt.is_imposed;
            doubt.is_imposed = true;
            changed = true;
        }
        changed
    }

    /// Pairs that are asked to stay apart where they meet, or along the face that parts them, and turn through each
    /// other elsewhere, or too far for what they are asked.
    fn watch_what_turns(
        &mut self,
        model: &Model,
        state: &State,
        scratch: &mut Scratch,
        (approach, step_s): (Approach, f64),
    ) {
        let Foreseen { contacts, doubts, turned_s, deep_s, turns_far, cuts, .. } = self;
        let pairs = contacts.chunk_by(|a, b| (a.body, a.other) == (b.body, b.other));
        let asked = pairs.filter_map(|group| Some(([group[0].body, group[0].other?], false)));
        let doubted = doubts.list().iter().filter(|doubt| doubt.is_imposed).map(|doubt| (doubt.pair, true));
        for (pair, is_doubted) in asked.chain(doubted) {
            let moving = pair.map(|i| moving(scratch, i));
            let work = &mut scratch.work;
            if !is_doubted && !Way::may_be_deep(model, pair, &moving, step_s) {
                continue;
            }
            let Some(way) = Way::new(model, state, pair, moving, step_s, freely) else { continue };
            note_far(turns_far, &way, pair);
            let is_far = if approach == Approach::Middle { way.is_through(0.0) } else { way.is_deep(0.0) };
            // What slides far along a face that turns is inside it before that has turned far.
            let too_far_s = way.turned_s().filter(|_| is_doubted);
            too_far_s.iter().for_each(|other_s| note_earlier(turned_s, *other_s));
            let known_s = [turned_s.filter(|turned_s| *turned_s < SHORTER * step_s), *deep_s];
            let until_s = known_s.into_iter().flatten().fold(step_s, f64::min);
            let times = 1.0 + f64::from(*cuts) / OFTEN;
            let other_s = is_far.then(|| way.deep_s(times, until_s, work)).flatten();
            other_s.iter().for_each(|other_s| note_earlier(deep_s, *other_s));
        }
    }
}

fn note_far(turns_far: &mut [bool], way: &Way, pair: [usize; 2]) {
    for (i, far) in pair.into_iter().zip(way.turns_far()) {
        turns_far[i] |= far;
    }
}
