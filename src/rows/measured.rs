//! Measurements of a run: the columns of every row, one line each.

use crate::heading::{CellKind, Datum, InCell, columns};
use crate::outcome::Outcome;
use crate::work::Work;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

columns! {
    /// Measurements of a run, whatever sweep it belongs to. Fields are columns, in this order; a number that means
    /// nothing here is null. What the relative ones are relative to: docs/numbers.md.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    #[serde(default)]
    pub struct Measured {
        /// Outcome of the run: `finished`, `diverged`, `stalled` or `failed`. Divergence is a result, a failure is a
        /// fault of the program.
        pub outcome: Outcome,
        /// Reason why the run stopped: `not-finite`, `energy`, `escape`, `speed` or `penetration` (diverged),
        /// `not-converged`, `painleve`, `limit` or `interrupted` (stalled), or a panic's message (failed). Null when it
        /// has finished.
        pub criterion: Option<String>,
        /// Time that was reached.
        pub end_time_s: Option<f64>,
        /// Number of steps that were made; of a method that follows events, of stretches.
        #[column(cheap)]
        pub steps: u64,
        /// Length of the steps; of a method that makes its own, their mean.
        pub step_used_s: Option<f64>,
        /// Method that `auto` has chosen; null for other methods.
        pub method_used: Option<String>,
        /// Contact solver that was used: the one that the method names; of the solver `auto` those that had something
        /// to solve, `newton`, `nncg` or `newton+nncg`. Null where none had, and for methods that have none to choose.
        pub solver_used: Option<String>,
        /// Tolerance that `auto` has chosen for it, in metres; null where the chosen method takes a step.
        pub tolerance_used: Option<f64>,
        /// Energy at the start, of all bodies that are not driven: kinetic and potential, with `penalty` also what its
        /// springs hold. The potential is zero at the container's lowest point, else at the lowest start.
        pub energy_start_j: Option<f64>,
        /// Energy at the end.
        pub energy_end_j: Option<f64>,
        /// Energy that was made (+) or lost (−) without a reason, of the energy scale: end − start − work of loads and
        /// driven bodies + what contacts may take. The column that a guard of accuracy looks at.
        #[column(signed, small = 1e-12)]
        pub energy_drift_rel: Option<f64>,
        /// Largest energy, less the work done until then, over that at the start. Null where the start has none, or
        /// less than none.
        #[column(small = 1.0)]
        pub energy_growth_max: Option<f64>,
        /// Largest rise of the energy over an earlier value, less the work between the two, of the energy scale: the
        /// guard against explosions, with no book-keeping of contacts in it.
        #[column(small = 1e-12)]
        pub energy_rise_max_rel: Option<f64>,
        /// The drift with all that contacts took, whether the law lets them or not: what is left is the error of the
        /// steps between contacts.
        #[column(signed, small = 1e-12)]
        pub energy_balance_rel: Option<f64>,
        /// Change of linear momentum that gravity, loads and the contacts' impulses do not explain, of Σ m|v| at the
        /// start and the sizes of all those impulses. Null where a pin holds a body to the world.
        #[column(small = 1e-12)]
        pub linear_momentum_drift_rel: Option<f64>,
        /// Change of angular momentum about the centre of mass of all bodies that is not explained, of Σ(|Iω| + |r ×
        /// mv|) at the start and the sizes of all moments. Where a pin holds a body to the world, it is about the pin
        /// along gravity.
        #[column(small = 1e-12)]
        pub angular_momentum_drift_rel: Option<f64>,
        /// Deepest overlap of two bodies, or of a body and the container, at the ends of all steps, whatever contacts
        /// the method has seen. Null where nothing can touch, or the method never looks for contacts.
        #[column(small = 1e-12)]
        pub penetration_max_m: Option<f64>,
        /// Deepest overlap at the end.
        #[column(small = 1e-12)]
        pub penetration_end_m: Option<f64>,
        /// Times that two bodies passed through each other: on the way through a step they overlapped by more than a
        /// hundredth of the thinner one's width, deeper than at either end. Above 50 bodies every eighth step is
        /// looked at. Null like `penetration_max_m`.
        #[column(small = 0.0)]
        pub passed_through: Option<u64>,
        /// Largest impulse for a contact that was not there: without it and with all others the two bodies would
        /// nowhere have overlapped in the step. Of m(|v| + what the forces of the step add) of the lighter body. Above
        /// 50 bodies every eighth step is looked at. Null like `penetration_max_m`.
        #[column(small = 1e-9)]
        pub ghost_impulse_max_rel: Option<f64>,
        /// Largest distance between the two points that a pin holds together. Null without pins.
        #[column(small = 1e-12)]
        pub pin_gap_max_m: Option<f64>,
        /// Distance of the worst contact of the worst step from the law of contact that was asked for, relative to the
        /// impulse that does to the lighter of its bodies what the step does to it. Rounding gives 1e-16 to 1e-13,
        /// times the ratio of masses; a wrong impulse O(1), one where nothing may push the largest number there is.
        /// Null for `free` and `penalty`, and where nothing has touched.
        #[column(small = 1e-9)]
        pub residual_max: Option<f64>,
        /// Largest kinetic energy after one contact solve over that before it. Above 1 contacts have made energy.
        #[column(small = 1.0)]
        pub contact_gain_max: Option<f64>,
        /// Error of position, against the closed form that `exact:` names, at the end, or against the states of
        /// `reference:`, at the last of their times that the run has met; the largest over all bodies. Null without
        /// either.
        #[column(small = 1e-12)]
        pub error_position_m: Option<f64>,
        /// Error of attitude, as an angle, at the same time.
        #[column(small = 1e-12)]
        pub error_orientation_rad: Option<f64>,
        /// Error of the velocity of the centre of mass, at the same time.
        #[column(small = 1e-12)]
        pub error_velocity_m_s: Option<f64>,
        /// Error of the angular velocity, at the same time.
        #[column(small = 1e-12)]
        pub error_angular_velocity_rad_s: Option<f64>,
        /// Time that the errors are of.
        pub error_time_s: Option<f64>,
        /// Estimate of the error of positions at the end, by what `auto` has seen of two runs. Null for other methods,
        /// and where no two runs came to the end, or the judges call what they agree on wrong.
        #[column(small = 1e-12)]
        pub error_estimate_m: Option<f64>,
        /// Whether the run has finished and its `error_estimate_m` is within the tolerance that `auto` was asked for:
        /// `yes` or `no`. Far from the origin rounding alone may be more than that. Of `event-driven` itself `no` where
        /// that is sure: it has not finished, had steps of equal length in between (`work_fallbacks`), is in doubt, or
        /// has bodies deeper in each other than its tolerance. Else null, and for other methods.
        pub tolerance_met: Option<String>,
        /// Distance between the two runs of the reference at `error_time_s`.
        pub reference_uncertainty_m: Option<f64>,
        /// Last time of the reference at which its two runs agree.
        pub reference_until_s: Option<f64>,
        /// Factor by which an error of the start has grown at the end, from three twin runs that start displaced a
        /// little. A body in free flight has 2. Measured if `measure:` asks for it, for `auto`, and with `reference:`;
        /// else null.
        pub sensitivity: Option<f64>,
        /// Largest number of contacts in a step.
        pub contacts_max: u64,
        /// Counters of work.
        #[serde(flatten)]
        pub work: Work,
        /// Time that the steps took on this machine, without the judges; of a search, those of all its runs.
        #[column(cheap)]
        pub wall_s: Option<f64>,
        /// Time that `auto` took to choose, on this machine.
        #[column(cheap)]
        pub wall_search_s: Option<f64>,
        /// Columns that only some experiments have: `columns::SEARCH`, and what `measure:` asks for.
        #[serde(flatten)]
        pub more: Map<String, Value>,
    }
}

impl InCell for Outcome {
    const KIND: CellKind = CellKind::Text;

    fn cell(&self) -> Datum<'_> {
        Datum::Text(self.name())
    }
}

impl Measured {
    /// Measurements of a case that panicked, with its message.
    pub fn failed(message: String) -> Self {
        Measured { outcome: Outcome::Failed, criterion: Some(message), ..Measured::default() }
    }

    /// The measurements without the time that they took: what two runs of one case must agree in.
    pub fn without_wall_time(&self) -> Self {
        Measured { wall_s: None, wall_search_s: None, ..self.clone() }
    }
}

/// A number that JSON can hold; None where it is not finite.
pub fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}
