//! Promises of the integrators for a free rigid body. One table: `gotai list methods` prints it, and the tests run
//! every line of it.

use crate::experiment::types::Integrator;
use serde::Serialize;

/// Line of the table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// Order of attitude and angular velocity; of the position too, where it is not exact. None: there is no error of
    /// the step's, or one that the tolerance sets.
    pub order: Option<u32>,
    /// Promise about the rotational energy of a body without torque.
    pub energy: Kept,
    /// Promise about its angular momentum, as a vector of the world.
    pub angular_momentum: Kept,
    /// Promise about its parabola.
    pub parabola: Kept,
    pub source: &'static str,
}

/// Keeping of a quantity of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kept {
    /// Kept to rounding at any step for which the method has a solution: what is left walks by a rounding a step.
    ToRounding,
    No,
}

pub fn claim(integrator: Integrator) -> Claim {
    use Integrator::*;
    use Kept::{No, ToRounding};
    // 0: none of its own.
    let (order, energy, angular_momentum, parabola, source) = match integrator {
        ExplicitEuler => (1, No, No, No, "lecture L5, the formula"),
        SemiImplicitEuler => (1, No, No, No, "lecture L5, the C program"),
        CrankNicolson => (2, No, No, ToRounding, "Crank & Nicolson 1947"),
        ImplicitMidpoint => {
            (2, ToRounding, ToRounding, ToRounding, "Simo & Wong 1991; Austin, Krishnaprasad & Wang 1993")
        }
        Rk4 => (4, No, No, ToRounding, "Kutta 1901"),
        MoserVeselov => (2, ToRounding, ToRounding, ToRounding, "Moser & Veselov 1991; McLachlan & Zanna 2005"),
        Taylor => (0, ToRounding, ToRounding, ToRounding, "Jorba & Zou, Exp. Math. 14 (2005) 99"),
        Exact => (0, ToRounding, ToRounding, ToRounding, "van Zon & Schofield, JCP 225 (2007) 145"),
        Dop853 => (8, No, No, ToRounding, "Hairer, Nørsett & Wanner, Solving ODEs I, II.5, II.10"),
    };
    let order = (order > 0).then_some(order);
    Claim { order, energy, angular_momentum, parabola, source }
}
