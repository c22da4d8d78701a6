//! Effort of a run since its recording was last written: counted, not timed, so that a file depends on its run alone.

use crate::work::Work;

/// Effort that a kill may lose, about half a second of a usual machine, in tenths of a microsecond.
const MUCH: u64 = 5_000_000;

/// Costs in the same unit: of a body and a contact a step, of a contact in a sweep and in a step of Newton's method.
/// Measured: a cube with 7 contacts takes 22 µs a step and counts 33; a pile of 27 cubes with 64 contacts takes 38 ms
/// and counts 36.
const BODY: u64 = 10;
const CONTACT: u64 = 40;
const SWEEP: u64 = 1;
const NEWTON_STEP: u64 = 5;

/// Effort that is added up step by step.
#[derive(Default)]
pub struct Effort {
    work: Work,
    spent: u64,
}

impl Effort {
    /// Adds a step of so many bodies, by the counters of work after it; says whether it has become much.
    pub fn add(&mut self, work: &Work, bodies: usize) -> bool {
        let since = |of: fn(&Work) -> u64| of(work).saturating_sub(of(&self.work));
        let of_a_body = 1 + since(|w| w.inner_steps) + since(|w| w.pin_solves) + since(|w| w.events);
        let of_a_contact = CONTACT + SWEEP * since(|w| w.sweeps) + NEWTON_STEP * since(|w| w.newton_steps);
        let bodies = BODY.saturating_mul(of_a_body).saturating_mul(bodies as u64);
        let contacts = of_a_contact.saturating_mul(since(|w| w.contacts));
        self.spent = self.spent.saturating_add(bodies).saturating_add(contacts);
        self.spent = self.spent.saturating_add(since(|w| w.contact_tests));
        self.work = *work;
        self.spent >= MUCH
    }

    /// Begins anew: what there was is written.
    pub fn restart(&mut self) {
        self.spent = 0;
    }
}
