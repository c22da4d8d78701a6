//! Linear momentum, and angular momentum about the centre of mass of all bodies: what is left of their change after
//! gravity, loads and the impulses of contacts have been taken off. 0 for a method that conserves it. It is relative to
//! what there was at the start, Σ m|v| and Σ(|Iω| + |r × mv|), and the sizes of all that was given and taken since.
//!
//! A pin to the world takes momentum, and how much only the solver knows. What is left to judge is the angular momentum
//! about the pin along gravity (a heavy top's L_z; without gravity all of it). Two such points leave nothing.

use super::moving::moving;
use super::push::{Push, ROUNDING};
use super::work::Done;
use crate::model::pins::Anchor;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::Vector3;

#[derive(Clone, Copy, Debug)]
struct Momentum {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
    /// Σ m|v| and Σ |Iω| + |r × m v|.
    linear_size: f64,
    angular_size: f64,
    /// Σ m|v| (|p| + R), whose rounding its moment has.
    moment_size: f64,
}

impl Momentum {
    fn of(model: &Model, state: &State, pivot: &Pivot) -> Self {
        let origin = pivot.of(model, state);
        let zero = Vector3::zeros();
        let mut sum = Momentum { linear: zero, angular: zero, linear_size: 0.0, angular_size: 0.0, moment_size: 0.0 };
        for (body, at) in moving(model, state) {
            let linear = at.v_WB * body.mass_kg;
            let spin = body.I_W(at) * at.w_WB;
            let orbit = (at.p_WB - origin.position).cross(&(linear - origin.velocity * body.mass_kg));
            sum.linear += linear;
            sum.angular += spin + orbit;
            sum.linear_size += linear.norm();
            sum.angular_size += spin.norm() + orbit.norm();
            sum.moment_size += linear.norm() * (at.p_WB.norm() + body.bounding_radius_m);
        }
        sum
    }
}

/// What angular momentum is about.
#[derive(Clone, Copy, Debug)]
enum Pivot {
    Centre,
    /// The one point of the world that a pin holds.
    Pin(Vector3<f64>),
    /// Several of them, or one that moves.
    None,
}

impl Pivot {
    fn new(model: &Model) -> Self {
        let mut held = model.pins.iter().filter_map(|pin| match pin.anchor {
            Anchor::World(p_W) => Some(Some(p_W)),
            Anchor::Body(other, _) => model.bodies[other].driven.then_some(None),
        });
        match (held.next(), held.next()) {
            (None, _) => Pivot::Centre,
            (Some(Some(p_W)), None) => Pivot::Pin(p_W),
            _ => Pivot::None,
        }
    }

    fn of(&self, model: &Model, state: &State) -> Origin {
        match self {
            Pivot::Pin(p_W) => Origin { position: *p_W, velocity: Vector3::zeros() },
            _ => Origin::centre(model, state),
        }
    }
}

/// Position and velocity of the pivot.
struct Origin {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
}

impl Origin {
    /// Of mass, of all bodies.
    fn centre(model: &Model, state: &State) -> Self {
        if let [at] = &state.bodies[..] {
            return Origin { position: at.p_WB, velocity: at.v_WB };
        }
        let mass_kg: f64 = moving(model, state).map(|(b, _)| b.mass_kg).sum();
        let position = moving(model, state).map(|(b, s)| s.p_WB * b.mass_kg).sum::<Vector3<f64>>() / mass_kg;
        let velocity = moving(model, state).map(|(b, s)| s.v_WB * b.mass_kg).sum::<Vector3<f64>>() / mass_kg;
        Origin { position, velocity }
    }
}

/// Change of momentum over a run that nothing outside explains.
#[derive(Clone, Copy, Debug)]
pub struct MomentumLedger {
    pivot: Pivot,
    start: Momentum,
    mass_kg: f64,
    /// Impulse of gravity, applied forces and contacts.
    linear_given: Vector3<f64>,
    angular_given: Vector3<f64>,
    /// Sums of the sizes of what they gave and took; and of impulses times how far from the origin they act.
    linear_size: f64,
    angular_size: f64,
    moment_size: f64,
    /// Along which gravity has no moment about the pivot.
    axis: Option<Vector3<f64>>,
}

impl MomentumLedger {
    pub fn new(model: &Model, start: &State) -> Self {
        let pivot = Pivot::new(model);
        MomentumLedger {
            pivot,
            start: Momentum::of(model, start, &pivot),
            mass_kg: moving(model, start).map(|(body, _)| body.mass_kg).sum(),
            linear_given: Vector3::zeros(),
            angular_given: Vector3::zeros(),
            linear_size: 0.0,
            angular_size: 0.0,
            moment_size: 0.0,
            axis: model.gravity_m_s2.try_normalize(0.0),
        }
    }

    /// Where the pivot is in a state.
    pub fn pivot_m(&self, model: &Model, state: &State) -> Vector3<f64> {
        self.pivot.of(model, state).position
    }

    /// What gravity and loads gave in a step that ended at a state.
    pub fn observe(&mut self, model: &Model, after: &State, loads: &Done, step_s: f64) {
        let g = model.gravity_m_s2;
        self.linear_given += g * (self.mass_kg * step_s) + loads.impulse;
        self.angular_given += loads.angular_impulse;
        self.linear_size += g.norm() * (self.mass_kg * step_s) + loads.impulse_size;
        self.angular_size += loads.angular_size;
        let is_own_pivot = model.bodies.len() == 1 && matches!(self.pivot, Pivot::Centre);
        if !is_own_pivot && step_s > 0.0 {
            let pivot = self.pivot_m(model, after);
            let moment = |(body, at): (&Body, &BodyState)| (at.p_WB - pivot).cross(&g).norm() * body.mass_kg;
            self.angular_size += moving(model, after).map(moment).sum::<f64>() * step_s;
        }
    }

    /// What contacts gave at a state, so many times.
    pub fn observe_pushes(&mut self, model: &Model, state: &State, pushes: &[Push], times: f64) {
        let pivot = self.pivot_m(model, state);
        for ((push, at), body) in pushes.iter().zip(&state.bodies).zip(&model.bodies) {
            if body.driven {
                continue;
            }
            let (linear, angular) = (push.linear * times, push.angular * times);
            let about_pivot = (at.p_WB - pivot).cross(&linear);
            self.linear_given += linear;
            self.angular_given += angular + about_pivot;
            self.linear_size += push.linear_size * times;
            self.angular_size += push.angular_size * times + about_pivot.norm();
            self.moment_size += push.linear_size * times * (at.p_WB.norm() + body.bounding_radius_m);
        }
    }

    /// None where a pin to the world takes momentum, and only the solver knows how much.
    pub fn linear_drift_rel(&self, model: &Model, end: &State) -> Option<f64> {
        let end = Momentum::of(model, end, &self.pivot);
        let drift = (end.linear - self.start.linear - self.linear_given).norm();
        let scale = self.start.linear_size + self.linear_size;
        let rounding = ROUNDING * (scale + end.linear_size);
        matches!(self.pivot, Pivot::Centre).then(|| of_scale(drift, rounding, scale))
    }

    pub fn angular_drift_rel(&self, model: &Model, end: &State) -> Option<f64> {
        let end = Momentum::of(model, end, &self.pivot);
        let drift = end.angular - self.start.angular - self.angular_given;
        let left = match (&self.pivot, self.axis) {
            (Pivot::None, _) => return None,
            (Pivot::Pin(_), Some(axis)) => axis.dot(&drift).abs(),
            _ => drift.norm(),
        };
        let scale = self.start.angular_size + self.angular_size;
        let moment_size = self.start.moment_size + self.moment_size + end.moment_size;
        Some(of_scale(left, ROUNDING * (scale + end.angular_size + moment_size), scale))
    }
}

/// 0 of what is rounding; else 1 where there is no scale.
fn of_scale(amount: f64, rounding: f64, scale: f64) -> f64 {
    match amount {
        _ if amount <= rounding => 0.0,
        _ if scale > 0.0 => amount / scale,
        _ => 1.0,
    }
}
