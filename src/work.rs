//! Work of a run, counted in integers: the same on every machine, so that a test can hold it.

use crate::heading::columns;
use serde::{Deserialize, Serialize};

columns! {
    /// Counters of a run, the columns `work_*` of a row.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(default)]
    pub struct Work {
        /// Points that were held against a face.
        #[serde(rename = "work_contact_tests")]
        #[column(cheap)]
        pub contact_tests: u64,
        /// Contacts that were found, summed over the steps.
        #[serde(rename = "work_contacts")]
        pub contacts: u64,
        /// Steps with at least one contact to solve.
        #[serde(rename = "work_contact_solves")]
        pub contact_solves: u64,
        /// Tangent rows of contacts that `time-stepping` has in its sweeps, two a contact and solve.
        #[serde(rename = "work_tangent_rows")]
        pub tangent_rows: u64,
        /// Sweeps over the contacts of a step, for velocities and for positions.
        #[serde(rename = "work_sweeps")]
        #[column(cheap)]
        pub sweeps: u64,
        /// Contact solves that missed their tolerance. A method that has no tolerance to miss has none.
        #[serde(rename = "work_unsolved")]
        #[column(small = 0.0)]
        pub unsolved: u64,
        /// Solves of a step, or with the solver `auto` of an island of it, for which the last step's impulses were
        /// taken as they were.
        #[serde(rename = "work_kept_solves")]
        pub kept_solves: u64,
        /// Those of `auto` that were exact, or that its first sweeps brought to a hundredth of the tolerance.
        #[serde(rename = "work_exact_solves")]
        pub exact_solves: u64,
        /// Islands that it left to an iteration.
        #[serde(rename = "work_iterated_solves")]
        pub iterated_solves: u64,
        /// Linear systems of an island's velocities that the exact contact solver (`newton`) solved.
        #[serde(rename = "work_newton_steps")]
        #[column(cheap)]
        pub newton_steps: u64,
        /// Steps of bodies in flight that were not held against anything: they could not have come to it yet.
        #[serde(rename = "work_flight_steps")]
        pub flight_steps: u64,
        /// Steps of bodies at rest that were not made: they would have been the one before over again.
        #[serde(rename = "work_rest_steps")]
        pub rest_steps: u64,
        /// Evaluations of the gyroscopic term, or of the momentum-conserving rotation in its place.
        #[serde(rename = "work_gyroscopic")]
        #[column(cheap)]
        pub gyroscopic: u64,
        /// Systems of all pins of an island that were solved.
        #[serde(rename = "work_pin_solves")]
        #[column(cheap)]
        pub pin_solves: u64,
        /// Steps inside those of the clock, summed over islands. Tries that were given up are not among them.
        #[serde(rename = "work_inner_steps")]
        #[column(cheap)]
        pub inner_steps: u64,
        /// Impacts, and changes between flight, sticking and sliding, of a method that follows events.
        #[serde(rename = "work_events")]
        pub events: u64,
        /// Stretches of `event-driven` that were handed over to steps of equal length.
        #[serde(rename = "work_fallbacks")]
        #[column(small = 0.0)]
        pub fallbacks: u64,
    }
}
