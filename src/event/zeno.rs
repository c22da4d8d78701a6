//! Impacts that would never end (Zeno): which bounce is the last that matters, and which rocking is rest.

use super::forces::{NO_SLIP, meeting_m_s};
use crate::collide::closed::{SOME, delta_at_m, is_closed_to_delta};
use crate::collide::{Contact, Key};
use crate::model::Model;
use crate::state::State;
use std::collections::BTreeMap;

/// Height of the bounces that are left out, relative to the tolerance.
const LEFT_OUT: f64 = 1e-6;

/// The same in δ, where that is more: what is nearer cannot be followed.
const LEFT_OUT_DELTAS: f64 = 10.0;

/// A ball's approach that is none, relative to the speeds at its contact.
const BOUNCED_OUT: f64 = 1e-11;

pub struct Zeno {
    tolerance: f64,
    /// Of contacts that have had an impact.
    struck: BTreeMap<Key, Struck>,
}

/// A contact's last impact: when it was, and how long it had been open since the one before; at first, for ever.
#[derive(Clone, Copy, Debug)]
struct Struck {
    at_s: f64,
    open_s: f64,
    /// It was the last of its bounces, between which others brought the bodies back sooner than gravity.
    is_squeezed_out: bool,
}

/// Times for which a contact was open before its last impact: one that opens again so soon after that rattles.
const RATTLES: f64 = 100.0;

/// Height of a bounce over that by which gravity would bring it back, of one that others bring back.
const SQUEEZED: f64 = 0.1;

/// Times for which a contact was open that has ended so: what closes again within that has bounced with it. Gaps of a
/// body between two others fall by e² from bounce to bounce, e ≥ 0.01.
const SQUEEZED_WITH: f64 = 1e4;

impl Zeno {
    pub fn new(tolerance: f64) -> Self {
        Zeno { tolerance, struck: BTreeMap::new() }
    }

    /// Takes the restitution of what strikes, and whose bounces that are left do not matter: of each contact by itself,
    /// then of those that bounce on between it and others. `is_all`: nothing else is closed.
    pub fn end_bounces(&mut self, model: &Model, state: &State, found: &mut [Contact], is_all: bool) {
        let has_just_struck =
            |contact: &Contact| self.struck.get(&contact.key()).is_some_and(|s| s.at_s == state.time_s);
        // To and fro at one moment: the gap between the two cannot be told from none.
        let is_once_more = |contact: &Contact, other: &Contact| {
            push_against(model, contact, other) && strikes(model, state, contact) && has_just_struck(other)
        };
        let once_more: Vec<bool> = (0..found.len())
            .map(|k| found.iter().any(|other| is_once_more(&found[k], other) || is_once_more(other, &found[k])))
            .collect();
        for k in 0..found.len() {
            let contact = found[k];
            if self.bounces_out(model, state, &contact, found.len() == 1 && is_all) || once_more[k] {
                self.lose(model, state, &mut found[k]);
            }
        }
        while let Some(k) = (0..found.len()).find(|k| self.is_lost_to_another(model, state, found, *k)) {
            self.lose(model, state, &mut found[k]);
        }
        // What the last of these impacts presses together does not spring apart.
        let has_just_ended = |contact: &Contact| {
            let ended = self.squeezed_out(contact);
            ended.is_some_and(|with| state.time_s - with.at_s <= SQUEEZED_WITH * with.open_s)
        };
        found.iter_mut().filter(|contact| has_just_ended(contact)).for_each(|contact| contact.restitution = 0.0);
    }

    fn squeezed_out(&self, contact: &Contact) -> Option<&Struck> {
        self.struck.get(&contact.key()).filter(|struck| struck.is_squeezed_out)
    }

    fn lose(&mut self, model: &Model, state: &State, contact: &mut Contact) {
        let (approach, _) = approach_m_s(model, state, contact);
        let fallen_m = fallen_m(falling_m_s2(model, contact), approach);
        contact.restitution = 0.0;
        if let Some(struck) = self.struck.get_mut(&contact.key()) {
            struck.is_squeezed_out = approach * struck.open_s / 4.0 <= SQUEEZED * fallen_m;
        }
    }

    /// A body between two others bounces to and fro while these come nearer to each other, infinitely often in the time
    /// in which the gap between them closes: at the end of it none of the three moves along a normal. Where the bounces
    /// of one of its contacts have ended so, those of the other one have as well, however fast they still are: a
    /// contact that rebounded alone would send back what the sequence of impacts brings to rest.
    fn is_lost_to_another(&self, model: &Model, state: &State, found: &[Contact], k: usize) -> bool {
        let contact = &found[k];
        if contact.restitution == 0.0 || !strikes(model, state, contact) {
            return false;
        }
        let Some(own) = self.struck.get(&contact.key()) else { return false };
        found.iter().filter(|other| push_against(model, contact, other)).any(|other| {
            self.squeezed_out(other)
                .is_some_and(|with| own.open_s.max(state.time_s - with.at_s) <= SQUEEZED_WITH * with.open_s)
        })
    }

    /// Whether a contact opens, faster than what rests.
    pub fn leaves(&self, model: &Model, state: &State, contact: &Contact) -> bool {
        let (approach, scale) = approach_m_s(model, state, contact);
        -approach > self.rests_m_s(model, state, contact).max(NO_SLIP * scale)
    }

    /// Takes away what leaves, where another contact of the same body strikes from the other side: the gap that opens
    /// is there, if only within what is closed, and the body crosses it before it strikes there. Not what has struck at
    /// this very moment.
    pub fn set_apart(&self, model: &Model, state: &State, found: &mut Vec<Contact>) -> Vec<Contact> {
        let was_open = |contact: &Contact| self.struck.get(&contact.key()).is_none_or(|s| s.at_s < state.time_s);
        let is_struck_against =
            |of: &Contact| found.iter().any(|other| push_against(model, of, other) && strikes(model, state, other));
        let is_apart = |of: &Contact| self.leaves(model, state, of) && was_open(of) && is_struck_against(of);
        let apart: Vec<Contact> = found.iter().filter(|contact| is_apart(contact)).copied().collect();
        found.retain(|contact| !apart.iter().any(|other| other.key() == contact.key()));
        apart
    }

    /// The bounces that are left after this one do not matter. `is_alone`: nothing else touches.
    fn bounces_out(&mut self, model: &Model, state: &State, contact: &Contact, is_alone: bool) -> bool {
        let (approach, scale) = approach_m_s(model, state, contact);
        if approach <= 0.0 {
            return false;
        }
        let lasted_s = self.note(contact, state.time_s);
        if contact.restitution == 0.0 {
            return false;
        }
        let falling = falling_m_s2(model, contact);
        // A ball's bounces cost so little that they are followed to rounding.
        if is_alone && contact.ends().all(|(i, ..)| model.bodies[i].is_centred_ball()) {
            return falling > 0.0 && contact.restitution < 1.0 && approach <= BOUNCED_OUT * scale;
        }
        // How high the last bounce was: from how fast it ended, and when it began or what pulls.
        let height_m = fallen_m(falling, approach).min(approach * lasted_s / 4.0);
        let left = 1.0 - contact.restitution;
        // What stays within δ cannot be followed, however elastic.
        height_m <= left * left * self.negligible_m(model, contact) || height_m <= delta_at_m(model, contact)
    }

    /// Notes an impact. How long the contact had been open.
    fn note(&mut self, contact: &Contact, at_s: f64) -> f64 {
        let last = self.struck.get(&contact.key());
        let lasted_s = last.map_or(f64::INFINITY, |last| at_s - last.at_s);
        // Of several at one instant the first one counts.
        let open_s = last.filter(|_| lasted_s <= 0.0).map_or(lasted_s, |last| last.open_s);
        self.struck.insert(contact.key(), Struck { at_s, open_s, is_squeezed_out: false });
        lasted_s
    }

    /// The speed below which a contact that leaves is at rest: what rebounds no more may rock on, by the impulses of
    /// others, and at last it rests. What pulls it back is gravity, or whatever brought it back the last time.
    fn rests_m_s(&self, model: &Model, state: &State, contact: &Contact) -> f64 {
        let (falling, left) = (falling_m_s2(model, contact), 1.0 - contact.restitution);
        if left <= 0.0 {
            return 0.0;
        }
        let negligible_m = self.negligible_m(model, contact);
        let at = |falling: f64| left * (2.0 * falling * negligible_m).sqrt();
        if falling > 0.0 {
            return at(falling);
        }
        let rattles = |last: &&Struck| state.time_s - last.at_s <= RATTLES * last.open_s;
        // It is open for 2 v/a, v²/2a high; and what is faster than gravity would make it is no rest.
        let back_m_s = |last: &Struck| left * left * 4.0 * negligible_m / last.open_s;
        let rattles_m_s = self.struck.get(&contact.key()).filter(rattles).map_or(0.0, back_m_s);
        rattles_m_s.min(at(model.gravity_m_s2.norm()))
    }

    /// A height that does not matter.
    fn negligible_m(&self, model: &Model, contact: &Contact) -> f64 {
        (LEFT_OUT * self.tolerance).max(LEFT_OUT_DELTAS * delta_at_m(model, contact))
    }
}

/// Between two bodies, or a body and a face, what rests in one point has lost its restitution with the others, where
/// all that come nearer have: it rocks on without it, and at last it rests.
pub fn lose_together(found: &mut [Contact], approaches: impl Fn(&Contact) -> bool) {
    let mut from = 0;
    while from < found.len() {
        let len = found[from..].iter().take_while(|other| between(other) == between(&found[from])).count();
        let group = &mut found[from..from + len];
        let mut coming = group.iter().filter(|contact| approaches(contact)).peekable();
        if coming.peek().is_some() && coming.all(|contact| contact.restitution == 0.0) {
            group.iter_mut().for_each(|contact| contact.restitution = 0.0);
        }
        from += len;
    }
}

/// The two bodies of a contact, or the body and the face.
fn between(contact: &Contact) -> (usize, Option<usize>, u32) {
    (contact.body, contact.other, contact.other.map_or(contact.feature.0, |_| 0))
}

/// Gravity, that presses the two together: of a body on what does not move against the normal from there, whichever
/// of them is named first; of two that move the upper one's.
fn falling_m_s2(model: &Model, contact: &Contact) -> f64 {
    let falling = -contact.normal.dot(&model.gravity_m_s2);
    match contact.other {
        Some(other) if model.bodies[contact.body].driven && !model.bodies[other].driven => -falling,
        Some(other) if !model.bodies[other].driven => falling.abs(),
        _ => falling,
    }
}

/// How high a bounce was that gravity has brought back, from how fast it ended.
fn fallen_m(falling_m_s2: f64, approach_m_s: f64) -> f64 {
    if falling_m_s2 > 0.0 { approach_m_s * approach_m_s / (2.0 * falling_m_s2) } else { f64::INFINITY }
}

/// Whether two contacts, of other pairs, push a body that they share, and move, against each other.
fn push_against(model: &Model, contact: &Contact, other: &Contact) -> bool {
    between(contact) != between(other) && contact.pushes_against(other, model)
}

/// Of a contact, and what it is compared with.
pub fn approach_m_s(model: &Model, state: &State, contact: &Contact) -> (f64, f64) {
    let speed = contact.normal.dot(&contact.velocity(|i| [state.bodies[i].v_WB, state.bodies[i].w_WB]));
    (-speed, meeting_m_s(model, state, contact.ends().map(|(i, ..)| i)))
}

/// Whether a contact comes nearer.
pub fn strikes(model: &Model, state: &State, contact: &Contact) -> bool {
    let (approach, scale) = approach_m_s(model, state, contact);
    approach > NO_SLIP * scale
}

/// Leaves what is closed, and what strikes with it, however long its lever: what closes within the time in which it is
/// not known when the fastest of what is closed strikes.
pub fn keep_closed(model: &Model, state: &State, found: &mut Vec<Contact>) {
    let known_s = |contact: &Contact| {
        let (approach, scale) = approach_m_s(model, state, contact);
        (approach > NO_SLIP * scale).then(|| SOME * delta_at_m(model, contact) / approach)
    };
    let closed = found.iter().filter(|contact| is_closed_to_delta(model, contact));
    let within_s = closed.filter_map(known_s).reduce(f64::min).unwrap_or(0.0);
    let strikes = |contact: &Contact| contact.gap_m <= within_s * approach_m_s(model, state, contact).0;
    found.retain(|contact| is_closed_to_delta(model, contact) || strikes(contact));
}
