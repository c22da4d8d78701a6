//! What makes a method more accurate: the one place that says which method takes a step, which a tolerance.

use super::method::{Integrator, Method};
use super::tolerances::DEFAULT_TOLERANCE;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// A shorter `time.step_s`.
    Step,
    /// A smaller tolerance, which is at this path; the method finds its own steps inside those of the clock.
    Tolerance(&'static [&'static str]),
    /// Nothing: it is a closed form.
    Closed,
}

impl Method {
    pub fn accuracy(&self) -> Accuracy {
        match self {
            Method::Free(free) => free.integrator.accuracy(),
            Method::EventDriven(_) => Accuracy::Tolerance(&["method", "event-driven", "tolerance"]),
            Method::Auto(_) => Accuracy::Tolerance(&["method", "auto", "tolerance"]),
            // The tolerance of `time-stepping` is its solver's, not the motion's.
            Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => Accuracy::Step,
        }
    }

    /// What it controls its error by.
    pub fn tolerance(&self) -> Option<f64> {
        match (self, self.accuracy()) {
            (Method::Free(free), Accuracy::Tolerance(_)) => Some(free.tolerance.unwrap_or(DEFAULT_TOLERANCE)),
            (Method::EventDriven(settings), _) => Some(settings.tolerance),
            (Method::Auto(settings), _) => Some(settings.tolerance),
            _ => None,
        }
    }
}

impl Integrator {
    pub fn accuracy(self) -> Accuracy {
        match self {
            Integrator::Dop853 | Integrator::Taylor => Accuracy::Tolerance(&["method", "free", "tolerance"]),
            Integrator::Exact => Accuracy::Closed,
            Integrator::ExplicitEuler
            | Integrator::SemiImplicitEuler
            | Integrator::CrankNicolson
            | Integrator::ImplicitMidpoint
            | Integrator::Rk4
            | Integrator::MoserVeselov => Accuracy::Step,
        }
    }
}
