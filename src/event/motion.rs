//! What a body does between events: closed forms, and bounds on how fast any of its points can be accelerated, from
//! which a contact that is not there yet is known not to be missed.

use crate::exact::arc::Arc;
use crate::exact::free_rotation::FreeRotation;
use crate::integrate::momentum::momentum_W;
use crate::integrate::rotation::exponential;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::Vector3;

#[derive(Clone, Debug)]
pub enum Motion {
    Closed(ClosedMotion),
    /// By the dense steps of an integrator, which has it at this place among its bodies.
    Dense(usize),
}

/// A motion in closed form.
#[derive(Clone, Debug)]
pub enum ClosedMotion {
    /// Constant acceleration of both kinds: at rest, a ball that slides or rolls, a slab that slides, what does not
    /// turn.
    Arc(Arc),
    /// A parabola, and a rotation without torque.
    Fall(Arc, Box<FreeRotation>),
    /// As it is told.
    Driven(f64, BodyState),
}

/// No point of the body at a distance r from the centre of mass is accelerated by more than |a| + r (α + ω²).
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// The centre's: constant, and what it may be beside that.
    pub acceleration: Vector3<f64>,
    pub beside: f64,
    pub w: f64,
    pub alpha: f64,
}

impl Bounds {
    /// Of the acceleration, against n, of a point of radius r.
    pub fn toward(&self, n: &Vector3<f64>, r: f64) -> f64 {
        -n.dot(&self.acceleration) + self.beside + r * (self.alpha + self.w * self.w)
    }
}

impl ClosedMotion {
    /// Nothing but constant forces through the centre of mass act from `t_s` on.
    pub fn free(body: &Body, t_s: f64, at: &BodyState, acceleration: Vector3<f64>) -> Self {
        let arc = Arc::straight(t_s, *at, acceleration);
        if body.isotropic || at.w_WB == Vector3::zeros() {
            return ClosedMotion::Arc(arc);
        }
        ClosedMotion::Fall(arc, Box::new(FreeRotation::new(&body.I_B, &at.q_WB, &at.w_WB)))
    }

    pub fn at(&self, t_s: f64) -> BodyState {
        match self {
            ClosedMotion::Arc(arc) => arc.at(t_s),
            ClosedMotion::Fall(arc, rotation) => {
                let t = t_s - arc.t_s;
                let (q_WB, w_WB) = rotation.at(t);
                let from = &arc.from;
                let p_WB = from.p_WB + (from.v_WB + arc.acceleration_m_s2 * (t / 2.0)) * t;
                BodyState { p_WB, q_WB, v_WB: from.v_WB + arc.acceleration_m_s2 * t, w_WB }
            }
            ClosedMotion::Driven(from_s, at) => {
                let t = t_s - from_s;
                let q_WB = exponential(&(at.w_WB * t)) * at.q_WB;
                BodyState { p_WB: at.p_WB + at.v_WB * t, q_WB, ..*at }
            }
        }
    }

    /// Until `end_s`.
    pub fn bounds(&self, body: &Body, end_s: f64) -> Bounds {
        match self {
            ClosedMotion::Arc(arc) => {
                let alpha = arc.angular_rad_s2.norm();
                let w = arc.from.w_WB.norm() + alpha * (end_s - arc.t_s).max(0.0);
                Bounds { acceleration: arc.acceleration_m_s2, beside: 0.0, w, alpha }
            }
            ClosedMotion::Fall(arc, _) => {
                let L = momentum_W(body, &arc.from.q_WB, &arc.from.w_WB).norm();
                let energy = arc.from.w_WB.dot(&momentum_W(body, &arc.from.q_WB, &arc.from.w_WB));
                // 1/I of the least moment that is one: a rod does not spin about itself.
                let inverse = body.I_B_inverse.norm();
                let w = (energy * inverse).sqrt().min(L * inverse);
                Bounds { acceleration: arc.acceleration_m_s2, beside: 0.0, w, alpha: w * L * inverse }
            }
            ClosedMotion::Driven(_, at) => {
                Bounds { acceleration: Vector3::zeros(), beside: 0.0, w: at.w_WB.norm(), alpha: 0.0 }
            }
        }
    }
}
