//! What stands on a plane with a corner, or with a rim.

use super::Touch;
use super::parts::Parts;
use crate::event::shown::Part;
use crate::model::Model;
use crate::shape::solid::Solid;
use crate::state::State;
use nalgebra::Vector3;

/// A body on a plane.
pub struct Standing {
    pub of: usize,
    /// Away from the plane; and its rate.
    pub normal_W: Vector3<f64>,
    pub normal_rate_W: Vector3<f64>,
    /// From the centre of mass, body axes. None: a rim.
    pub corner_B: Option<Vector3<f64>>,
}

impl Standing {
    /// It stands with a cylinder's corner.
    pub fn is_on_rim(&self, model: &Model) -> bool {
        let is_cylinder = matches!(model.bodies[self.of].solid(), Some((Solid::Cylinder { .. }, _)));
        is_cylinder && self.corner_B.is_some()
    }
}

impl Touch {
    /// None: neither a corner nor a rim on a plane.
    pub fn standing(&self, state: &State) -> Option<Standing> {
        let Parts::OnPlane { of, part, plane } = &self.parts else { return None };
        let corner_B = match part {
            Part::Ball(ball) if ball.radius_m == 0.0 => Some(ball.centre_B),
            Part::Rim { .. } => None,
            Part::Ball(_) | Part::Ellipsoid { .. } => return None,
        };
        let base = plane.of.map(|of| &state.bodies[of]);
        let normal_W = base.map_or(plane.normal, |base| base.q_WB * plane.normal);
        let normal_rate_W = base.map_or_else(Vector3::zeros, |base| base.w_WB.cross(&normal_W));
        Some(Standing { of: *of, normal_W, normal_rate_W, corner_B })
    }
}
