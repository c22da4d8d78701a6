//! Work, counted in integers: the same on every machine, so that a test can hold it.

/// Columns `work_*` of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Points held against a face.
    pub contact_tests: u64,
    /// Contacts found, summed over steps.
    pub contacts: u64,
    /// Steps with at least one contact to solve.
    pub contact_solves: u64,
    /// Sweeps over the contacts of a step, velocities and positions.
    pub sweeps: u64,
    /// Contact solves that missed their tolerance.
    pub unsolved: u64,
    /// Linear systems of an island's velocities that the exact contact solver solved.
    pub newton_steps: u64,
    /// Evaluations of the gyroscopic term, or of the momentum-conserving rotation in its place.
    pub gyroscopic: u64,
    /// Systems of all pins of an island that were solved.
    pub pin_solves: u64,
    /// Steps inside those of the clock, summed over islands; tries that were given up are not among them.
    pub inner_steps: u64,
    /// Impacts, and changes between flight, sticking and sliding.
    pub events: u64,
    /// Stretches that were handed over to steps of equal length.
    pub fallbacks: u64,
}
