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
    /// Counters that cost, after the last step.
    before: [u64; 7],
    spent: u64,
}

impl Effort {
    /// Adds a step of so many bodies, by the counters of work after it; says whether it has become much.
    pub fn add(&mut self, work: &Work, bodies: usize) -> bool {
        let now = [
            work.inner_steps,
            work.pin_solves,
            work.events,
            work.contacts,
            work.sweeps,
            work.newton_steps,
            work.contact_tests,
        ];
        if now == self.before {
            self.spent = self.spent.saturating_add(BODY.saturating_mul(bodies as u64));
            return self.spent >= MUCH;
        }
        let before = std::mem::replace(&mut self.before, now);
        let [inner_steps, pin_solves, events, contacts, sweeps, newton_steps, contact_tests] =
            std::array::from_fn(|i| now[i].saturating_sub(before[i]));
        let of_a_body = 1 + inner_steps + pin_solves + events;
        let of_bodies = BODY.saturating_mul(of_a_body).saturating_mul(bodies as u64);
        self.spent = self.spent.saturating_add(of_bodies);
        if contacts > 0 {
            let of_a_contact = CONTACT + SWEEP * sweeps + NEWTON_STEP * newton_steps;
            self.spent = self.spent.saturating_add(of_a_contact.saturating_mul(contacts));
        }
        self.spent = self.spent.saturating_add(contact_tests);
        self.spent >= MUCH
    }

    /// Begins anew: what there was is written.
    pub fn restart(&mut self) {
        self.spent = 0;
    }
}
