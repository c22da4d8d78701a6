//! Torque-free rotation of a body of revolution by elementary functions: the axis circles L at the rate |L|/I₁ while
//! the body turns about its axis at (1 − I₃/I₁) ω₃ (Kane, Likins & Levinson, Spacecraft Dynamics, 1983, 3.1). A sphere
//! only circles L. Rates are double-double, for long times.

use super::facts::{Lacks, SAME, point};
use super::form::{ClosedForm, ExactMotion};
use super::free_rotation::{power_of_two, turn};
use super::principal::body_axes;
use crate::math::dd::{Dd, dot};
use crate::model::Model;
use crate::state::State;
use nalgebra::{Matrix3, SymmetricEigen, UnitQuaternion, Vector3};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Parabola and torque-free rotation, by elementary functions.",
    source: "Kane, Likins & Levinson 1983, 3.1",
    scenes: "The same forces; every body with two equal moments of inertia; no air, no pins, no contact.",
    motion,
};

#[derive(Clone, Debug)]
pub struct SymmetricBody {
    q_WB: UnitQuaternion<f64>,
    axis_B: Vector3<f64>,
    /// Direction of L.
    axis_W: Vector3<f64>,
    /// Rate |L|/I₁ of the axis about L.
    precession: Dd,
    /// Rate (1 − I₃/I₁) ω₃ about the axis.
    spin: Dd,
    w_W: Vector3<f64>,
}

impl SymmetricBody {
    /// The rotation from its start, by the moments across (positive) and along the axis, which has any length but zero.
    pub fn new(
        transverse_kg_m2: f64,
        axial_kg_m2: f64,
        axis_B: &Vector3<f64>,
        q_WB: &UnitQuaternion<f64>,
        w_W: &Vector3<f64>,
    ) -> Self {
        let scale = power_of_two(w_W.amax());
        let w_B = body_axes(q_WB, &(w_W / scale));
        let axis = unit([axis_B.x, axis_B.y, axis_B.z].map(|x| Dd::from(x / axis_B.amax())));
        let w_3 = dot(&w_B, &axis);
        let excess = Dd::ONE - Dd::from(axial_kg_m2) / Dd::from(transverse_kg_m2);
        // L/I₁ = ω − (1 − I₃/I₁) ω₃ axis.
        let L_B = [0, 1, 2].map(|i| w_B[i] - excess * w_3 * axis[i]);
        let L = dot(&L_B, &L_B).sqrt();
        let along = if L > Dd::ZERO { L_B.map(|x| (x / L).f64()) } else { [0.0; 3] };
        let scale = Dd::from(scale);
        SymmetricBody {
            q_WB: *q_WB,
            axis_B: Vector3::from(axis.map(Dd::f64)),
            axis_W: q_WB * Vector3::from(along),
            precession: L * scale,
            spin: excess * w_3 * scale,
            w_W: *w_W,
        }
    }

    /// Attitude and angular velocity (q_WB, w_WB) at a time of either sign.
    pub fn at(&self, t_s: f64) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let t = Dd::from(t_s);
        let around = turn(&self.axis_W, self.precession * t);
        let mut q_WB = around * self.q_WB * turn(&self.axis_B, self.spin * t);
        q_WB.renormalize();
        (q_WB, around * self.w_W)
    }
}

fn unit(v: [Dd; 3]) -> [Dd; 3] {
    let length = dot(&v, &v).sqrt();
    v.map(|x| x / length)
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let (body, at) = (&model.bodies[index], &start.bodies[index]);
    let (transverse, axial, axis) = of_revolution(&body.I_B)
        .ok_or_else(|| format!("`{}` a body of revolution, with two equal moments of inertia", body.name))?;
    let rotation = SymmetricBody::new(transverse, axial, &axis, &at.q_WB, &at.w_WB);
    let way = point(model, index, at)?;
    Ok(ExactMotion::of(move |t_s| way.at(t_s), move |t_s| rotation.at(t_s)))
}

/// Moments across and along the axis of revolution, and the axis.
pub(super) fn of_revolution(I_B: &Matrix3<f64>) -> Option<(f64, f64, Vector3<f64>)> {
    let eigen = SymmetricEigen::new(*I_B);
    let moments = eigen.eigenvalues;
    let pairs = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];
    let nearest = pairs.into_iter().min_by(|a, b| {
        let apart = |(i, j, _): &(usize, usize, usize)| (moments[*i] - moments[*j]).abs();
        apart(a).total_cmp(&apart(b))
    })?;
    let (i, j, axis) = nearest;
    let same = (moments[i] - moments[j]).abs() <= SAME * moments.amax();
    same.then(|| ((moments[i] + moments[j]) / 2.0, moments[axis], eigen.eigenvectors.column(axis).into_owned()))
}
