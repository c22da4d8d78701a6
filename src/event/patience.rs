//! How long events are followed before steps of equal length take their place: by how many there are at one moment, and
//! by how much work the time of a few such steps has taken.
//!
//! Whoever gives up again soon after has less patience, and steps become longer: first ones are so short that what
//! they differ from the motion by is below the tolerance; where events go on to accumulate (a sliding mode, a rocking
//! without end), they grow until a run of any length ends.

use crate::work::Work;

/// Events at one moment, of all contacts, before something is wrong; and a moment, over the length of a stretch.
const AT_ONCE: u32 = 200;
const AT_ONCE_S: f64 = 1e-9;

/// Steps, however they end, in a part of the time of a stretch: a slip so slow that its direction hardly lasts. What
/// begins from nothing takes some hundred, each longer than the one before.
const STEPS_IN: f64 = 1e-6;
const MANY_STEPS: u32 = 1_000;

/// More events than this in the time of a stretch are too many: those that cost an integration, and others.
const MANY_DENSE: u64 = 2_000;
const MANY: u64 = 100_000;

/// Linear systems of the law (25 µs each, measured in stacks of six bodies) that may be spent at once, of all bodies
/// that move and of each of them; and the part of it that the time of a stretch gives. Looks at gaps and the
/// integration of what moves smoothly do not count: how many there are is a matter of what is skipped, and of how fast
/// bodies spin.
const EFFORT: u64 = 40_000;
const EFFORT_OF_EACH: u64 = 5_000;
const GIVEN: f64 = 1.0 / 64.0;

/// Of all of these: what is left after having given up often, halved so many times at most, and so many events at one
/// moment.
const LEAST_PART: u32 = 7;
const LEAST_AT_ONCE: u32 = 12;

/// Lengths of a stretch after the last one in which events have gone on well.
const SOON: f64 = 2.0;

/// Levels that steps grow by, at most.
const MOST_LEVEL: u32 = 11;

#[derive(Clone, Debug)]
pub struct Patience {
    /// Of a stretch of whole steps.
    stretch_s: f64,
    /// Effort that may be spent at once, and what is left of it.
    effort: u64,
    left: u64,
    /// Until when it is counted, and how much had been spent.
    counted_s: f64,
    spent: u64,
    /// Events without any time between them.
    at_once: u32,
    /// Steps since a time.
    steps_from_s: f64,
    steps: u32,
    /// When counting of events began, with how many.
    from_s: f64,
    events: u64,
    /// When the last stretch ended, and how often one soon followed another.
    ended_s: f64,
    level: u32,
}

impl Patience {
    /// With so many bodies that move.
    pub fn new(stretch_s: f64, moving: usize, start_s: f64) -> Self {
        let effort = EFFORT + EFFORT_OF_EACH * moving as u64;
        Patience {
            stretch_s,
            effort,
            left: effort,
            counted_s: start_s,
            spent: 0,
            at_once: 0,
            steps_from_s: start_s,
            steps: 0,
            from_s: start_s,
            events: 0,
            ended_s: f64::NEG_INFINITY,
            level: 0,
        }
    }

    /// Effort that may be spent; none: nothing is looked for any more.
    pub fn left(&self, work: &Work) -> u64 {
        (self.spent + self.left).saturating_sub(work.newton_steps)
    }

    /// Whether events come faster, or cost more, than steps of equal length would.
    pub fn is_over(&mut self, [from_s, to_s]: [f64; 2], work: &Work, is_dense: bool) -> bool {
        self.at_once = if to_s - from_s > AT_ONCE_S * self.stretch_s { 0 } else { self.at_once + 1 };
        self.steps += 1;
        if to_s - self.steps_from_s > STEPS_IN * self.stretch_s {
            (self.steps_from_s, self.steps) = (to_s, 0);
        }
        if to_s - self.from_s > self.stretch_s {
            (self.from_s, self.events) = (to_s, work.events);
        }
        let most = if is_dense { MANY_DENSE } else { MANY };
        self.left = self.left(work);
        let is_spent = self.left == 0;
        self.give(to_s, work);
        let part = self.level.min(LEAST_PART);
        let at_once = (AT_ONCE >> part).max(LEAST_AT_ONCE);
        self.at_once > at_once || self.steps > MANY_STEPS || work.events - self.events > most >> part || is_spent
    }

    /// What time gives.
    fn give(&mut self, to_s: f64, work: &Work) {
        let given = GIVEN * self.effort as f64 * (to_s - self.counted_s) / self.stretch_s;
        self.left = (self.left + given.min(self.effort as f64) as u64).min(self.effort);
        // What is less than one is given later.
        if given >= 1.0 {
            self.counted_s = to_s;
        }
        self.spent = work.newton_steps;
    }

    /// Events lead no further. The level of the steps that follow.
    pub fn give_up(&mut self, at_s: f64) -> u32 {
        let mut went_well_s = at_s - self.ended_s;
        if went_well_s < SOON * self.stretch_s {
            self.level = (self.level + 1).min(MOST_LEVEL);
        }
        while self.level > 0 && went_well_s >= SOON * self.stretch_s {
            self.level -= 1;
            went_well_s /= 2.0;
        }
        self.level
    }

    /// Back to events: to try them again costs something in any case.
    pub fn begin(&mut self, at_s: f64, work: &Work) {
        (self.ended_s, self.at_once) = (at_s, 0);
        (self.steps_from_s, self.steps) = (at_s, 0);
        (self.from_s, self.events) = (at_s, work.events);
        self.give(at_s, work);
        let least = (GIVEN * self.effort as f64) as u64;
        self.left = self.left.max(least);
    }
}
