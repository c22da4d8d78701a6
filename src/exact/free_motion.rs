//! Bodies without contact or force but gravity: a parabola and a torque-free rotation each (L4, L5).

use super::free_rotation::FreeRotation;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::Vector3;

pub struct FreeMotion {
    gravity_m_s2: Vector3<f64>,
    bodies: Vec<(BodyState, FreeRotation)>,
}

impl FreeMotion {
    pub fn new(model: &Model, start: &State) -> Self {
        let rotation = |(body, at): (&Body, &BodyState)| (*at, FreeRotation::new(&body.I_B, &at.q_WB, &at.w_WB));
        FreeMotion {
            gravity_m_s2: model.gravity_m_s2,
            bodies: model.bodies.iter().zip(&start.bodies).map(rotation).collect(),
        }
    }

    /// u = g t²/2 + v₀ t + u₀, v = g t + v₀; attitude and ω by elliptic functions.
    pub fn state_at(&self, t_s: f64) -> State {
        let bodies = self.bodies.iter().map(|(start, rotation)| self.body_at(start, rotation, t_s));
        State { step: 0, time_s: t_s, bodies: bodies.collect() }
    }

    /// Puts the bodies where they are at the state's time.
    pub fn write(&self, state: &mut State) {
        for ((start, rotation), at) in self.bodies.iter().zip(&mut state.bodies) {
            *at = self.body_at(start, rotation, state.time_s);
        }
    }

    fn body_at(&self, start: &BodyState, rotation: &FreeRotation, t_s: f64) -> BodyState {
        let (q_WB, w_WB) = rotation.at(t_s);
        BodyState {
            p_WB: start.p_WB + (start.v_WB + self.gravity_m_s2 * (t_s / 2.0)) * t_s,
            q_WB,
            v_WB: start.v_WB + self.gravity_m_s2 * t_s,
            w_WB,
        }
    }
}
