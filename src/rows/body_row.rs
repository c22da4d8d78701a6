//! The state of one body in what is written: recordings, references, columns, `run --json`.

use crate::state::BodyState;
use nalgebra::{Quaternion, UnitQuaternion, Vector4};
use serde::{Deserialize, Serialize};

/// State of one body at its centre of mass, in the world frame. Its fields are the columns of `columns::STATE`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyRow {
    pub position_m: [f64; 3],
    /// Attitude, body → world, as a unit quaternion.
    pub orientation_xyzw: [f64; 4],
    pub velocity_m_s: [f64; 3],
    pub angular_velocity_rad_s: [f64; 3],
}

impl BodyRow {
    /// All numbers in the order of the fields, which is that of the columns.
    pub fn numbers(&self) -> impl Iterator<Item = f64> + use<> {
        let BodyRow { position_m, orientation_xyzw, velocity_m_s, angular_velocity_rad_s } = *self;
        position_m.into_iter().chain(orientation_xyzw).chain(velocity_m_s).chain(angular_velocity_rad_s)
    }

    /// The state that the row was made from, bit for bit: the quaternion is not normalised again.
    pub fn state(&self) -> BodyState {
        BodyState {
            p_WB: self.position_m.into(),
            q_WB: UnitQuaternion::new_unchecked(Quaternion::from_vector(Vector4::from(self.orientation_xyzw))),
            v_WB: self.velocity_m_s.into(),
            w_WB: self.angular_velocity_rad_s.into(),
        }
    }
}

impl From<&BodyState> for BodyRow {
    fn from(at: &BodyState) -> Self {
        BodyRow {
            position_m: at.p_WB.into(),
            orientation_xyzw: at.q_WB.coords.into(),
            velocity_m_s: at.v_WB.into(),
            angular_velocity_rad_s: at.w_WB.into(),
        }
    }
}
