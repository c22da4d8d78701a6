//! How far a state is from the exact one.

use crate::rows::{Measured, finite};
use crate::state::{BodyState, State};

/// The largest over all bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    pub position_m: f64,
    /// Angle of the rotation from the exact attitude.
    pub orientation_rad: f64,
    pub velocity_m_s: f64,
    pub angular_velocity_rad_s: f64,
}

impl Errors {
    /// Both at the same time, the same bodies in the same order.
    pub fn between(state: &State, exact: &State) -> Self {
        let largest = |error: fn(&BodyState, &BodyState) -> f64| {
            let errors = state.bodies.iter().zip(&exact.bodies).map(|(at, exact)| error(at, exact));
            // Not `max`, which would pass over what is not a number.
            errors.fold(0.0, |worst: f64, error| if error <= worst { worst } else { error })
        };
        Errors {
            position_m: largest(|at, exact| (at.p_WB - exact.p_WB).norm()),
            orientation_rad: largest(angle),
            velocity_m_s: largest(|at, exact| (at.v_WB - exact.v_WB).norm()),
            angular_velocity_rad_s: largest(|at, exact| (at.w_WB - exact.w_WB).norm()),
        }
    }

    /// Fills the columns of a row; `time_s` is when.
    pub fn write(&self, time_s: f64, measured: &mut Measured) {
        measured.error_time_s = finite(time_s);
        measured.error_position_m = finite(self.position_m);
        measured.error_orientation_rad = finite(self.orientation_rad);
        measured.error_velocity_m_s = finite(self.velocity_m_s);
        measured.error_angular_velocity_rad_s = finite(self.angular_velocity_rad_s);
    }
}

/// By the tangent of its half, which is accurate at small angles and near π.
fn angle(at: &BodyState, exact: &BodyState) -> f64 {
    let turn = exact.q_WB.inverse() * at.q_WB;
    2.0 * libm::atan2(turn.imag().norm(), turn.scalar().abs())
}
