//! From a scene to the closed form that is its motion: every body's way and turning, or what a pin leaves of them;
//! bodies that touch something: `contact_scene.rs`.

use super::contact_scene::{self, Touching};
use super::facts::{Lacks, SAME, constant_acceleration, only_pin, point, unpinned};
use super::free_rotation::FreeRotation;
use super::heavy_top::{HeavyTop, Top};
use super::linear_drag::LinearDrag;
use super::pendulum::Pendulum;
use super::point_motion::PointMotion;
use super::quadratic_drag::QuadraticDrag;
use super::symmetric_body::SymmetricBody;
use crate::experiment::types::Exact;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{Matrix3, SymmetricEigen, UnitQuaternion, Vector3};

/// The exact motion of one body.
#[derive(Clone, Debug)]
pub enum Motion {
    Free(Way, Turning),
    /// A body on a pin: attitude, from which the position follows.
    Top {
        top: HeavyTop,
        pin_W: Vector3<f64>,
        r_B: Vector3<f64>,
    },
    Pendulum(Box<Swing>),
    Touching(Touching),
}

/// Of the centre of mass.
#[derive(Clone, Debug)]
pub enum Way {
    Point(PointMotion),
    Linear(LinearDrag),
    Quadratic(QuadraticDrag),
}

#[derive(Clone, Debug)]
pub enum Turning {
    Free(Box<FreeRotation>),
    Symmetric(SymmetricBody),
}

/// A body that turns about a horizontal axis through its pin.
#[derive(Clone, Debug)]
pub struct Swing {
    pendulum: Pendulum,
    start: BodyState,
    angle: f64,
    axis_W: Vector3<f64>,
    pin_W: Vector3<f64>,
}

impl Motion {
    pub fn at(&self, t_s: f64) -> BodyState {
        match self {
            Motion::Free(way, turning) => {
                let (p_WB, v_WB) = match way {
                    Way::Point(point) => point.at(t_s),
                    Way::Linear(drag) => drag.at(t_s),
                    Way::Quadratic(drag) => drag.at(t_s),
                };
                let (q_WB, w_WB) = match turning {
                    Turning::Free(rotation) => rotation.at(t_s),
                    Turning::Symmetric(rotation) => rotation.at(t_s),
                };
                BodyState { p_WB, q_WB, v_WB, w_WB }
            }
            Motion::Top { top, pin_W, r_B } => {
                let (q_WB, w_WB) = top.at(t_s);
                let r_W = q_WB * r_B;
                BodyState { p_WB: pin_W - r_W, q_WB, v_WB: -w_WB.cross(&r_W), w_WB }
            }
            Motion::Pendulum(swing) => swing.at(t_s),
            Motion::Touching(touching) => touching.at(t_s),
        }
    }

    pub fn holds_until_s(&self) -> f64 {
        if let Motion::Touching(touching) = self { touching.holds_until_s() } else { f64::INFINITY }
    }
}

impl Swing {
    fn at(&self, t_s: f64) -> BodyState {
        let (angle, rate) = self.pendulum.at(t_s);
        let turn = UnitQuaternion::from_scaled_axis(self.axis_W * (angle - self.angle));
        let (r_W, w_WB) = (turn * (self.start.p_WB - self.pin_W), self.axis_W * rate);
        BodyState { p_WB: self.pin_W + r_W, q_WB: turn * self.start.q_WB, v_WB: w_WB.cross(&r_W), w_WB }
    }
}

/// The motion of one of the model's bodies from its start.
pub fn motion(which: Exact, model: &Model, start: &State, index: usize) -> Result<Motion, Lacks> {
    let (body, at) = (&model.bodies[index], &start.bodies[index]);
    if body.driven && which != Exact::Rest {
        return Ok(driven(at));
    }
    match which {
        Exact::HeavyTop => heavy_top(model, index, at),
        Exact::Pendulum => pendulum(model, index, at),
        Exact::FreeMotion => Ok(Motion::Free(Way::Point(point(model, index, at)?), free_turning(body, at))),
        Exact::LinearDrag => Ok(Motion::Free(Way::Linear(linear(model, index, at)?), free_turning(body, at))),
        Exact::QuadraticDrag => Ok(Motion::Free(Way::Quadratic(quadratic(model, index, at)?), free_turning(body, at))),
        Exact::SymmetricBody => {
            let (transverse, axial, axis) = of_revolution(&body.I_B)
                .ok_or_else(|| format!("`{}` a body of revolution, with two equal moments of inertia", body.name))?;
            let turning = SymmetricBody::new(transverse, axial, &axis, &at.q_WB, &at.w_WB);
            Ok(Motion::Free(Way::Point(point(model, index, at)?), Turning::Symmetric(turning)))
        }
        Exact::Rest
        | Exact::Sliding
        | Exact::Ball
        | Exact::Turntable
        | Exact::RockingBlock
        | Exact::FallingRod
        | Exact::Ladder
        | Exact::RimlessWheel
        | Exact::Dome
        | Exact::StickSlip => contact_scene::motion(which, model, start, index).map(Motion::Touching),
    }
}

/// Even motion.
fn driven(at: &BodyState) -> Motion {
    let still = Vector3::zeros();
    let way = PointMotion { position_m: at.p_WB, velocity_m_s: at.v_WB, constant_m_s2: still, harmonics: Vec::new() };
    Motion::Free(Way::Point(way), Turning::Free(Box::new(FreeRotation::new(&Matrix3::identity(), &at.q_WB, &at.w_WB))))
}

fn free_turning(body: &Body, at: &BodyState) -> Turning {
    Turning::Free(Box::new(FreeRotation::new(&body.I_B, &at.q_WB, &at.w_WB)))
}

fn linear(model: &Model, index: usize, at: &BodyState) -> Result<LinearDrag, Lacks> {
    let body = unpinned(model, index)?;
    if body.drag.quadratic_n_s2_m2 != 0.0 {
        return Err("no quadratic drag of the `air`".into());
    }
    Ok(LinearDrag {
        position_m: at.p_WB,
        velocity_m_s: at.v_WB,
        acceleration_m_s2: constant_acceleration(model, index)?,
        rate_per_s: body.drag.linear_n_s_m / body.mass_kg,
    })
}

fn quadratic(model: &Model, index: usize, at: &BodyState) -> Result<QuadraticDrag, Lacks> {
    let body = unpinned(model, index)?;
    if body.drag.linear_n_s_m != 0.0 {
        return Err("no linear drag of the `air`".into());
    }
    let drag_per_m = body.drag.quadratic_n_s2_m2 / body.mass_kg;
    QuadraticDrag::new(at.p_WB, at.v_WB, constant_acceleration(model, index)?, drag_per_m)
        .ok_or_else(|| format!("`{}` moving along the line of its weight, or without one", body.name))
}

fn heavy_top(model: &Model, index: usize, at: &BodyState) -> Result<Motion, Lacks> {
    let (pin_W, r_B) = only_pin(model, index)?;
    let body = &model.bodies[index];
    let lacks = || format!("`{}` a body of revolution, pinned on its axis", body.name);
    let (transverse, axial, axis_B) = of_revolution(&about(body, &r_B)).ok_or_else(lacks)?;
    // A ball may turn about any line through its pin.
    let axis_B = if transverse == axial && r_B != Vector3::zeros() { -r_B.normalize() } else { axis_B };
    let along = -r_B.dot(&axis_B);
    if (r_B + axis_B * along).norm() > SAME * r_B.norm() {
        return Err(lacks());
    }
    let top = Top {
        transverse_kg_m2: transverse,
        axial_kg_m2: axial,
        axis_B,
        first_moment_kg_m: body.mass_kg * along,
        gravity_m_s2: model.gravity_m_s2,
    };
    let top = HeavyTop::new(&top, &at.q_WB, &at.w_WB).ok_or_else(lacks)?;
    Ok(Motion::Top { top, pin_W, r_B })
}

fn pendulum(model: &Model, index: usize, at: &BodyState) -> Result<Motion, Lacks> {
    let (pin_W, r_B) = only_pin(model, index)?;
    let body = &model.bodies[index];
    let lacks = || format!("`{}` swinging about a horizontal principal axis of its pin, under gravity", body.name);
    let down = model.gravity_m_s2.try_normalize(0.0).ok_or_else(lacks)?;
    let r_W = -(at.q_WB * r_B);
    let (length, sine) = (r_W.norm(), down.cross(&r_W));
    // About which it swings: its spin, or at rest what gravity turns it about.
    let axis_W = at.w_WB.try_normalize(0.0).or_else(|| sine.try_normalize(SAME * length)).ok_or_else(lacks)?;
    let I_axis = at.q_WB * (about(body, &r_B) * at.q_WB.inverse_transform_vector(&axis_W));
    let inertia = axis_W.dot(&I_axis);
    let tilted = axis_W.dot(&down).abs().max(axis_W.dot(&r_W).abs() / length);
    if length == 0.0 || tilted > SAME || (I_axis - axis_W * inertia).norm() > SAME * inertia {
        return Err(lacks());
    }
    let angle = libm::atan2(sine.dot(&axis_W), down.dot(&r_W));
    let moment = body.mass_kg * model.gravity_m_s2.norm() * length;
    let pendulum = Pendulum::new(moment, inertia, angle, at.w_WB.dot(&axis_W));
    Ok(Motion::Pendulum(Box::new(Swing { pendulum, start: *at, angle, axis_W, pin_W })))
}

/// Inertia about a point at `r_B` from the centre of mass.
fn about(body: &Body, r_B: &Vector3<f64>) -> Matrix3<f64> {
    body.I_B + (Matrix3::identity() * r_B.norm_squared() - r_B * r_B.transpose()) * body.mass_kg
}

/// Moments across and along the axis of revolution, and the axis.
fn of_revolution(I_B: &Matrix3<f64>) -> Option<(f64, f64, Vector3<f64>)> {
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
