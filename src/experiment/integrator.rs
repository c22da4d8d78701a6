//! The integrators of `free`, a part of `method.rs`.

use super::accuracy::Accuracy;
use serde::{Deserialize, Serialize};
use strum::{IntoStaticStr, VariantArray};

/// Integrator of `free`; `integrate::claims` says what each promises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Integrator {
    /// The slide's formula (L5): u uses the old v.
    ExplicitEuler,
    /// The slide's C program (L5): u uses the new v.
    #[default]
    SemiImplicitEuler,
    /// The trapezoidal rule.
    CrankNicolson,
    /// The implicit midpoint rule, which keeps energy and angular momentum.
    ImplicitMidpoint,
    /// The classical Runge–Kutta method.
    Rk4,
    /// The discrete Moser–Veselov equations, which keep energy, angular momentum and the symplectic form.
    MoserVeselov,
    /// Dormand and Prince's 8(5,3) with error control.
    Dop853,
    /// Taylor's series, of as high an order as the tolerance asks for.
    Taylor,
    /// The closed form: a parabola and elliptic functions, from the start in one leap to every time.
    Exact,
}

impl Integrator {
    pub const ALL: &'static [Integrator] = Integrator::VARIANTS;

    /// Word of the integrator in the file.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// Setting that makes the integrator more accurate.
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

    /// Whether forces need a Taylor series everywhere on the way.
    pub fn needs_series(self) -> bool {
        self == Integrator::Taylor
    }
}
