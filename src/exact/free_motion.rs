//! Bodies without contact or force but gravity: a parabola and a torque-free rotation each (L4, L5).

use super::free_rotation::FreeRotation;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{Matrix3, Vector3};

pub struct FreeMotion {
    bodies: Vec<Falling>,
}

struct Falling {
    start: BodyState,
    gravity_m_s2: Vector3<f64>,
    rotation: FreeRotation,
}

impl FreeMotion {
    pub fn new(model: &Model, start: &State) -> Self {
        let rotation = |(body, at): (&Body, &BodyState)| {
            // A body that moves as it is told turns evenly, as if all its moments were equal.
            let (I_B, gravity) =
                if body.driven { (Matrix3::identity(), Vector3::zeros()) } else { (body.I_B, model.gravity_m_s2) };
            Falling { start: *at, gravity_m_s2: gravity, rotation: FreeRotation::new(&I_B, &at.q_WB, &at.w_WB) }
        };
        FreeMotion { bodies: model.bodies.iter().zip(&start.bodies).map(rotation).collect() }
    }

    /// u = g t²/2 + v₀ t + u₀, v = g t + v₀; attitude and ω by elliptic functions.
    pub fn state_at(&self, t_s: f64) -> State {
        State { step: 0, time_s: t_s, bodies: self.bodies.iter().map(|body| body.at(t_s)).collect() }
    }

    /// Puts the bodies where they are at the state's time.
    pub fn write(&self, state: &mut State) {
        let t_s = state.time_s;
        self.bodies.iter().zip(&mut state.bodies).for_each(|(body, at)| *at = body.at(t_s));
    }
}

impl Falling {
    fn at(&self, t_s: f64) -> BodyState {
        let Falling { start, gravity_m_s2, rotation } = self;
        let (q_WB, w_WB) = rotation.at(t_s);
        BodyState {
            p_WB: start.p_WB + (start.v_WB + gravity_m_s2 * (t_s / 2.0)) * t_s,
            q_WB,
            v_WB: start.v_WB + gravity_m_s2 * t_s,
            w_WB,
        }
    }
}
