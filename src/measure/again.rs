//! A step that is the one before over again, as bodies at rest make them: what judges would find is known.

use crate::collide::SolvedContact;
use crate::collide::approach::Approach;
use crate::shown::{Acted, Shown};
use crate::state::{BodyState, State};

/// The last step that kicked, if bodies were after it as they had been before.
#[derive(Clone, Debug, Default)]
pub(super) struct Again {
    bodies: Vec<BodyState>,
    contacts: Vec<SolvedContact>,
    step_s: f64,
    /// In how many steps one after another.
    times: u64,
}

fn is_same(a: &[BodyState], b: &[BodyState]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.has_bits_of(b))
}

/// Bodies that are after a step as they were before it, kicked at its start.
fn rests<'a>(shown: &Shown<'a>) -> Option<(&'a [SolvedContact], f64)> {
    let Acted::Kick { kicked, contacts, step_s, approach: Approach::Start } = shown.acted else { return None };
    let is_placed = |state: &State| is_same(&state.bodies, &shown.before.bodies);
    (!contacts.is_empty() && is_placed(shown.after) && is_placed(kicked)).then_some((contacts, step_s))
}

impl Again {
    /// With room for so many bodies and contacts.
    pub fn with_capacity(bodies: usize, contacts: usize) -> Self {
        let (bodies, contacts) = (Vec::with_capacity(bodies), Vec::with_capacity(contacts));
        Again { bodies, contacts, ..Again::default() }
    }

    /// Whether this step has been judged so many times in all that its judges need not look.
    pub fn is(&self, shown: &Shown, enough: u64) -> bool {
        self.is_enough(enough) && rests(shown).is_some_and(|(contacts, step_s)| self.is_known(shown, contacts, step_s))
    }

    /// Whether the last step is one that its judges need not look at, should it come again.
    pub fn is_enough(&self, enough: u64) -> bool {
        self.times >= enough
    }

    fn is_known(&self, shown: &Shown, contacts: &[SolvedContact], step_s: f64) -> bool {
        step_s == self.step_s && is_same(&self.bodies, &shown.after.bodies) && contacts == self.contacts
    }

    /// Takes note of a step that has been judged.
    pub fn note(&mut self, shown: &Shown) {
        let Some((contacts, step_s)) = rests(shown) else {
            self.times = 0;
            return;
        };
        let is_known = self.times > 0 && self.is_known(shown, contacts, step_s);
        self.times = if is_known { self.times + 1 } else { 1 };
        if !is_known {
            self.bodies.clear();
            self.bodies.extend_from_slice(&shown.after.bodies);
            self.contacts.clear();
            self.contacts.extend_from_slice(contacts);
            self.step_s = step_s;
        }
    }
}
