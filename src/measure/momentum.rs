//! Linear momentum, and angular momentum about the centre of mass of all bodies: what is left of their change after
//! gravity and the contacts' impulses have been taken off. 0 for a method that conserves it.

use super::{Push, relative};
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector3;

#[derive(Clone, Copy, Debug)]
struct Momentum {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
    /// Σ m|v| and Σ |Iω| + |r × m v|: what there is to be lost.
    linear_scale: f64,
    angular_scale: f64,
}

impl Momentum {
    fn of(model: &Model, state: &State) -> Self {
        let centre = Centre::of(model, state);
        let zero = Vector3::zeros();
        let mut sum = Momentum { linear: zero, angular: zero, linear_scale: 0.0, angular_scale: 0.0 };
        for (body, at) in model.bodies.iter().zip(&state.bodies) {
            let linear = at.v_WB * body.mass_kg;
            let spin = body.I_W(at) * at.w_WB;
            let orbit = (at.p_WB - centre.position).cross(&(linear - centre.velocity * body.mass_kg));
            sum.linear += linear;
            sum.angular += spin + orbit;
            sum.linear_scale += linear.norm();
            sum.angular_scale += spin.norm() + orbit.norm();
        }
        sum
    }
}

/// Centre of mass of all bodies.
struct Centre {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
}

impl Centre {
    fn of(model: &Model, state: &State) -> Self {
        let bodies = || model.bodies.iter().zip(&state.bodies);
        if let [at] = &state.bodies[..] {
            return Centre { position: at.p_WB, velocity: at.v_WB };
        }
        let mass_kg: f64 = model.bodies.iter().map(|b| b.mass_kg).sum();
        let position = bodies().map(|(b, s)| s.p_WB * b.mass_kg).sum::<Vector3<f64>>() / mass_kg;
        let velocity = bodies().map(|(b, s)| s.v_WB * b.mass_kg).sum::<Vector3<f64>>() / mass_kg;
        Centre { position, velocity }
    }
}

/// Change of momentum over a run that nothing outside explains.
#[derive(Clone, Copy, Debug)]
pub struct MomentumLedger {
    start: Momentum,
    end: Momentum,
    /// Impulse of gravity and contacts.
    linear_given: Vector3<f64>,
    angular_given: Vector3<f64>,
    linear_scale: f64,
    angular_scale: f64,
}

impl MomentumLedger {
    pub fn new(model: &Model, start: &State) -> Self {
        let start = Momentum::of(model, start);
        MomentumLedger {
            start,
            end: start,
            linear_given: Vector3::zeros(),
            angular_given: Vector3::zeros(),
            linear_scale: start.linear_scale,
            angular_scale: start.angular_scale,
        }
    }

    pub fn observe(
        &mut self,
        model: &Model,
        before: &State,
        after: &State,
        pushes: &[Push],
        contact: bool,
        step_s: f64,
    ) {
        let mass_kg: f64 = model.bodies.iter().map(|b| b.mass_kg).sum();
        self.linear_given += model.gravity_m_s2 * (mass_kg * step_s);
        if contact {
            let centre = Centre::of(model, before);
            for (push, at) in pushes.iter().zip(&before.bodies) {
                self.linear_given += push.linear;
                self.angular_given += push.angular + (at.p_WB - centre.position).cross(&push.linear);
            }
        }
        self.end = Momentum::of(model, after);
        self.linear_scale = self.linear_scale.max(self.end.linear_scale);
        self.angular_scale = self.angular_scale.max(self.end.angular_scale);
    }

    pub fn linear_drift_rel(&self) -> f64 {
        relative((self.end.linear - self.start.linear - self.linear_given).norm(), self.linear_scale)
    }

    pub fn angular_drift_rel(&self) -> f64 {
        relative((self.end.angular - self.start.angular - self.angular_given).norm(), self.angular_scale)
    }
}
