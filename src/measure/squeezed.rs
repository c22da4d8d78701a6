//! Bodies between others that come nearer to each other: infinitely many impacts in a finite time, by Newton's law of
//! each. When they are over, nothing moves along any of their normals; a contact that still rebounds there breaks the
//! law, though by itself, at that moment, it seems to keep it.

use super::exchange::Met;
use crate::collide::{Contact, Key, SolvedContact};
use crate::model::Model;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// A velocity along a normal that is none, of the speeds there.
const NOTHING: f64 = 1e-9;

/// The time for which a contact was open over that in which gravity would bring it back: sooner than that others do.
const SOONER: f64 = 0.1;

/// Times for which the contact that has ended was open: what has struck within that, and strikes again, is of the same
/// sequence.
const OF_ONE: f64 = 1e4;

/// The last impact of a contact, and how long it was open before; at first, for ever.
#[derive(Clone, Copy, Debug)]
struct Struck {
    at_s: f64,
    open_s: f64,
    /// Without rebounding, though it has restitution, and though others brought it back.
    has_ended: bool,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Squeezed {
    struck: BTreeMap<Key, Struck>,
}

impl Squeezed {
    /// Looks at the impacts of one instant. Contacts, by their places, that rebound after one on the other side of a
    /// body has ended, with which they bounced on: they have no restitution left.
    pub fn look(&mut self, model: &Model, at_s: f64, contacts: &[SolvedContact], met: &[Met]) -> Vec<usize> {
        let g = model.gravity_m_s2.norm();
        let mut rebounding = Vec::new();
        for (k, (SolvedContact { contact, impulse_W }, met)) in contacts.iter().zip(met).enumerate() {
            let (approach, least) = (-contact.normal.dot(&met.before), NOTHING * met.speed());
            if approach <= least || *impulse_W == Vector3::zeros() {
                continue;
            }
            let open_s = self.struck.get(&contact.key()).map_or(f64::INFINITY, |last| at_s - last.at_s);
            let rebounds = contact.normal.dot(&met.after) > least;
            let is_squeezed = open_s.is_finite() && open_s * g <= SOONER * 2.0 * approach;
            let has_ended = !rebounds && is_squeezed && model.pair(contact.body, contact.other).restitution > 0.0;
            self.struck.insert(contact.key(), Struck { at_s, open_s, has_ended });
            if rebounds {
                rebounding.push((k, open_s));
            }
        }
        // Of more bodies than these the others may go on.
        let is_disturbed = |own: [&Contact; 2], since_s: f64| {
            let keys = own.map(Contact::key);
            let is_of_own =
                |i: usize| own.iter().flat_map(|c| c.ends()).any(|(j, ..)| i == j && !model.bodies[i].driven);
            let mut later = self.struck.iter().filter(|(key, struck)| !keys.contains(key) && struck.at_s >= since_s);
            later.any(|(key, _)| is_of_own(key.0) || key.1.is_some_and(is_of_own))
        };
        let is_of_ended = |(k, open_s): &(usize, f64)| {
            let own = &contacts[*k].contact;
            contacts.iter().map(|other| &other.contact).filter(|other| own.pushes_against(other, model)).any(|other| {
                let ended = self.struck.get(&other.key()).filter(|struck| struck.has_ended);
                let is_with = |ended: &&Struck| open_s.max(at_s - ended.at_s) <= OF_ONE * ended.open_s;
                ended.filter(is_with).is_some_and(|ended| !is_disturbed([own, other], ended.at_s - ended.open_s))
            })
        };
        rebounding.into_iter().filter(is_of_ended).map(|(k, _)| k).collect()
    }
}
