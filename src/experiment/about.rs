//! What lists say of the words of the vocabulary: what each is, and where it comes from. Settings, their words and
//! defaults are asked of the parser (`vocabulary.rs`).

use super::tolerances::{DEFAULT_TOLERANCE, SMALLEST_GLOBAL};
use super::types::{Measure, Method, Shape, Solver, TimeStepping};
use serde::Serialize;

/// What a word is, as a noun, and its source; empty where it has none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct About {
    pub what: String,
    pub source: &'static str,
}

fn about(what: impl Into<String>, source: &'static str) -> About {
    About { what: what.into(), source }
}

impl Method {
    pub fn about(&self) -> About {
        match self {
            Method::Free(_) => about(
                "Motion without contact, with pins; `tolerance` is of one inner step of dop853 and taylor, relative \
                 and absolute.",
                "lecture L4, L5, L24",
            ),
            Method::Lecture(_) => about(
                "The lecture's constraint method, of order 1; unstable at long steps and with many nodes.",
                "lecture L16–L21",
            ),
            Method::Penalty(_) => about(
                "A spring and a damper in every penetrating node, of order 1; critical step 2/√λmax.",
                "lecture L15",
            ),
            Method::TimeStepping(_) => about(
                "Velocity and impulse, by projected Gauss–Seidel, its conjugate gradients or the exact law of \
                 contact; gaps close to zero and no further; free rotation in closed form; of order 1, with `moreau` \
                 of order 2 between impacts.",
                "Moreau 1988, 1999; Stewart & Trinkle 1996; Anitescu & Potra 1997; Glocker & Pfeiffer 1995; Stronge \
                 1990",
            ),
            Method::EventDriven(_) => about(
                format!(
                    "Closed forms between events, else order 8 with a continuous extension of order 7; impacts, ends \
                     and beginnings of slips, and openings are roots in time; where events lead no further, short \
                     steps of `time-stepping` (column `work_fallbacks`). `tolerance` is of positions at the end, in \
                     metres, times the column `sensitivity` where that is above 1; at least {SMALLEST_GLOBAL:e}."
                ),
                "Dormand & Prince 8(5,3); Glocker 2001; Mirtich 1996",
            ),
            Method::Auto(_) => about(
                "`event-driven`, or `time-stepping` where that stalls or falls back: whatever two runs say is \
                 accurate enough (columns `method_used`, `error_estimate_m`). `tolerance` is of positions at the \
                 end, in metres.",
                "",
            ),
        }
    }

    /// What a setting of the method is where it is left out and has no default of its own.
    pub fn unless_set(&self, setting: &str) -> String {
        let of_newton = TimeStepping { solver: Solver::Newton, ..TimeStepping::default() };
        let of_sweeps = TimeStepping::default();
        match (self, setting) {
            (Method::Free(_), "tolerance") => format!("{DEFAULT_TOLERANCE:e}"),
            (Method::TimeStepping(_), "sweeps") => {
                format!("{} ({}: {})", of_sweeps.sweeps(), Solver::Newton.word(), of_newton.sweeps())
            }
            (Method::TimeStepping(_), "tolerance") => {
                format!("{:e} ({}: {:e})", of_sweeps.tolerance(), Solver::Newton.word(), of_newton.tolerance())
            }
            (Method::TimeStepping(_), "contacts_per_face") => "all".to_string(),
            _ => "none".to_string(),
        }
    }
}

impl Shape {
    /// What of it touches.
    pub fn about(&self) -> About {
        match self {
            Shape::Sphere(_) => about("Touches with its surface, or the nodes of its mesh (`subdivisions`).", ""),
            Shape::Box(_) => about("Touches with its corners, or the nodes of its mesh (`nodes_per_edge`).", ""),
            Shape::Cylinder(_) => about("Axis y; touches with its rims and caps.", ""),
            Shape::Capsule(_) => {
                about("Axis y, its height between the centres of its two spheres; touches with its surface.", "")
            }
            Shape::Ellipsoid(_) => about("Touches with its surface.", ""),
            Shape::Convex(_) => about("Hull of its vertices, all of which are corners; touches with them.", ""),
            Shape::None => about("A point with mass and inertia, without contact.", ""),
        }
    }
}

impl Measure {
    pub fn about(self) -> About {
        match self {
            Measure::State => about("Every body's state at the end.", ""),
            Measure::Inertia => about("Every body's mass properties, as the run used them.", "lecture L8, L9"),
            Measure::ContactMatrix => about(
                "A = J M⁻¹ Jᵀ of the contacts: its rank, and how fast Jacobi's iteration grows.",
                "lecture L16, L20",
            ),
            Measure::CriticalStep => about("The longest stable step of `penalty`, by linear theory.", "lecture L15"),
            Measure::DifferenceQuotients => {
                about("Difference quotients of the positions of a run against its velocities.", "lecture L1")
            }
            Measure::Sensitivity => about(
                "Twin runs whose start is displaced a little. The column is always filled \
                 for methods that follow events.",
                "",
            ),
        }
    }
}
