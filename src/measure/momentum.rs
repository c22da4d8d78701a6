//! Linear momentum, and angular momentum about the centre of mass of all bodies: what is left of their change after
//! gravity, applied forces and the contacts' impulses have been taken off. 0 for a method that conserves it.
//!
//! A pin to the world takes momentum, and how much only the solver knows. What is left to judge is the angular momentum
//! about the pin along gravity (a heavy top's L_z; without gravity all of it). Two such points leave nothing.

use super::loads::Done;
use super::push::{Push, beyond_rounding};
use crate::model::pins::Anchor;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
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
    fn of(model: &Model, state: &State, pivot: &Pivot) -> Self {
        let origin = pivot.of(model, state);
        let zero = Vector3::zeros();
        let mut sum = Momentum { linear: zero, angular: zero, linear_scale: 0.0, angular_scale: 0.0 };
        for (body, at) in moving(model, state) {
            let linear = at.v_WB * body.mass_kg;
            let spin = body.I_W(at) * at.w_WB;
            let orbit = (at.p_WB - origin.position).cross(&(linear - origin.velocity * body.mass_kg));
            sum.linear += linear;
            sum.angular += spin + orbit;
            sum.linear_scale += linear.norm();
            sum.angular_scale += spin.norm() + orbit.norm();
        }
        sum
    }
}

fn moving<'a>(model: &'a Model, state: &'a State) -> impl Iterator<Item = (&'a Body, &'a BodyState)> {
    model.bodies.iter().zip(&state.bodies).filter(|(body, _)| !body.driven)
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
    end: Momentum,
    /// Impulse of gravity, applied forces and contacts.
    linear_given: Vector3<f64>,
    angular_given: Vector3<f64>,
    /// Sums of the sizes of what contacts gave and took.
    linear_moved: f64,
    angular_moved: f64,
    linear_scale: f64,
    angular_scale: f64,
    /// Along which gravity has no moment about the pivot.
    axis: Option<Vector3<f64>>,
}

impl MomentumLedger {
    pub fn new(model: &Model, start: &State) -> Self {
        let pivot = Pivot::new(model);
        let start = Momentum::of(model, start, &pivot);
        MomentumLedger {
            pivot,
            start,
            end: start,
            linear_given: Vector3::zeros(),
            angular_given: Vector3::zeros(),
            linear_moved: 0.0,
            angular_moved: 0.0,
            linear_scale: start.linear_scale,
            angular_scale: start.angular_scale,
            axis: model.gravity_m_s2.try_normalize(0.0),
        }
    }

    /// Where the pivot is in a state.
    pub fn pivot_m(&self, model: &Model, state: &State) -> Vector3<f64> {
        self.pivot.of(model, state).position
    }

    /// `pushes`: of the contacts, if there was one.
    pub fn observe(
        &mut self,
        model: &Model,
        [before, kicked, after]: [&State; 3],
        pushes: Option<&[Push]>,
        loads: &Done,
        step_s: f64,
    ) {
        let mass_kg: f64 = moving(model, before).map(|(body, _)| body.mass_kg).sum();
        self.linear_given += model.gravity_m_s2 * (mass_kg * step_s) + loads.impulse;
        self.angular_given += loads.angular_impulse;
        if let Some(pushes) = pushes {
            self.observe_pushes(model, kicked, pushes);
        }
        self.end = Momentum::of(model, after, &self.pivot);
        self.linear_scale = self.linear_scale.max(self.end.linear_scale);
        self.angular_scale = self.angular_scale.max(self.end.angular_scale);
    }

    /// What contacts gave at a state.
    pub fn observe_pushes(&mut self, model: &Model, state: &State, pushes: &[Push]) {
        let pivot = self.pivot_m(model, state);
        for ((push, at), body) in pushes.iter().zip(&state.bodies).zip(&model.bodies) {
            if body.driven {
                continue;
            }
            let about_pivot = (at.p_WB - pivot).cross(&push.linear);
            self.linear_given += push.linear;
            self.angular_given += push.angular + about_pivot;
            self.linear_moved += push.linear.norm();
            self.angular_moved += push.angular.norm() + about_pivot.norm();
        }
    }

    pub fn linear_drift_rel(&self) -> Option<f64> {
        let drift = (self.end.linear - self.start.linear - self.linear_given).norm();
        matches!(self.pivot, Pivot::Centre).then(|| beyond_rounding(drift, self.linear_moved, self.linear_scale))
    }

    pub fn angular_drift_rel(&self) -> Option<f64> {
        let drift = self.end.angular - self.start.angular - self.angular_given;
        let left = match (&self.pivot, self.axis) {
            (Pivot::None, _) => return None,
            (Pivot::Pin(_), Some(axis)) => axis.dot(&drift).abs(),
            _ => drift.norm(),
        };
        Some(beyond_rounding(left, self.angular_moved, self.angular_scale))
    }
}
