//! Rebounds that are not due: of a contact whose gap the free motion would close within the step, and that another
//! impulse of the same step sends away first.
//!
//! A step knows no order in time. Where a body comes at a floor and a wall, both gaps close by its free motion, and
//! both would send it back, though after the floor's impulse it never comes to the wall. So what rebounds at a gap that
//! is not closed yet is moved on with all impulses but its own: if its gap stays open, it is no impact of this step,
//! and the step is solved again without its restitution. Of several such contacts that keep each other open the one
//! whose gap closes last is left out first, as it would come last. What then presses all the same does rebound.

use super::scratch::Scratch;
use crate::collide::closed::{is_closed_to_rounding, rounding_m};
use crate::collide::{Contact, Key};
use crate::model::Model;
use crate::solve::Impulse;
use crate::solve::twist::Twist;
use std::ops::Range;

/// Rounds of a step in which it is asked.
const MOST: u32 = 8;

/// What contacts of a step are not to do.
#[derive(Debug, Default)]
pub(super) struct Rebounds {
    round: u32,
    /// Contacts without a rebound, and those that are to have theirs whatever else is found.
    waived: Vec<Key>,
    due: Vec<Key>,
}

impl Rebounds {
    pub(super) fn begin(&mut self) {
        self.round = 0;
        self.waived.clear();
        self.due.clear();
    }

    pub(super) fn is_waived(&self, contact: &Contact) -> bool {
        self.waived.contains(&contact.key())
    }

    /// The contacts as they are asked for; none: as they are.
    pub(super) fn asked(&self, found: &[Contact]) -> Option<Vec<Contact>> {
        let plastic = |contact: &Contact| Contact { restitution: 0.0, tangential_restitution: 0.0, ..*contact };
        let asked = |contact: &Contact| if self.is_waived(contact) { plastic(contact) } else { *contact };
        (!self.waived.is_empty()).then(|| found.iter().map(asked).collect())
    }

    /// Whether the impulses in `scratch` show that some contact is to do something else. `struck`: what of them is of
    /// an impact by a law of its own.
    pub(super) fn revise(&mut self, model: &Model, scratch: &Scratch, struck: Option<&[Impulse]>, step_s: f64) -> bool {
        let Scratch { found, problem, impulses, .. } = scratch;
        let rebounds = |i: usize| {
            let (block, contact) = (&problem.blocks[i], &found[i]);
            let is_asked = block.least + block.turning > -contact.gap_m / step_s;
            contact.restitution > 0.0
                && impulses[i].x > 0.0
                && !is_closed_to_rounding(model, contact)
                && struck.map_or(is_asked, |struck| struck[i].x > 0.0)
        };
        let is_settled = self.waived.is_empty() && !(0..found.len()).any(rebounds);
        if is_settled || self.round == MOST {
            return false;
        }
        self.round += 1;
        let with = |contact: &Contact| (contact.body, contact.other, contact.other.map_or(contact.feature.0, |_| 0));
        let (mut first, mut is_pressed, mut latest) = (0, false, None);
        for group in found.chunk_by(|a, b| with(a) == with(b)) {
            let places = first..first + group.len();
            first = places.end;
            if group.iter().any(|contact| self.is_waived(contact)) {
                if impulses[places].iter().any(|p| p.x > 0.0) {
                    self.waived.retain(|key| group.iter().all(|contact| contact.key() != *key));
                    self.due.extend(group.iter().map(Contact::key));
                    is_pressed = true;
                }
                continue;
            }
            let is_known = group.iter().any(|contact| self.due.contains(&contact.key()));
            if is_known || !places.clone().any(rebounds) || closes(model, scratch, places.clone(), step_s) {
                continue;
            }
            let closes_s = places.clone().map(|i| closes_s(scratch, i)).fold(f64::INFINITY, f64::min);
            if latest.as_ref().is_none_or(|(latest_s, _)| *latest_s < closes_s) {
                latest = Some((closes_s, places));
            }
        }
        let is_new = latest.is_some();
        self.waived.extend(latest.into_iter().flat_map(|(_, places)| &found[places]).map(Contact::key));
        is_pressed || is_new
    }
}

/// Whether a gap of some contacts of one pair, or face, would close by the end of the step without their impulses.
fn closes(model: &Model, scratch: &Scratch, places: Range<usize>, step_s: f64) -> bool {
    let Scratch { found, problem, impulses, free, response, turning, .. } = scratch;
    let (body, other) = (found[places.start].body, found[places.start].other);
    let ends = [body, other.unwrap_or(body)];
    let mut without = ends.map(|i| Twist { v: free[i].v + response[i].v, w: free[i].w + response[i].w });
    for (block, p) in problem.blocks[places.clone()].iter().zip(&impulses[places.clone()]) {
        block.ends().zip(&mut without).for_each(|(end, without)| end.take_off(p, without));
    }
    found[places].iter().any(|contact| {
        let moving = |i: usize| {
            let at = usize::from(i != body);
            [without[at].v, without[at].w + turning[i]]
        };
        contact.gap_m + step_s * contact.normal.dot(&contact.velocity(moving)) < rounding_m(model, contact)
    })
}

/// When the free motion closes a gap.
fn closes_s(scratch: &Scratch, place: usize) -> f64 {
    let contact = &scratch.found[place];
    let closing = -contact.normal.dot(&contact.velocity(|i| [scratch.free[i].v, scratch.free[i].w]));
    if closing > 0.0 { contact.gap_m / closing } else { f64::INFINITY }
}
