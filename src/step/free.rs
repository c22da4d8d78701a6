//! Motion without contact (L4, L5).

use super::Clock;
use crate::experiment::types::{Free as Settings, Integrator, Update};
use crate::integrate::euler;
use crate::measure::work::Work;
use crate::model::Model;
use crate::state::State;

pub struct Free {
    update: Update,
    pub(super) work: Work,
}

impl Free {
    pub fn new(settings: &Settings) -> Self {
        let update = match settings.integrator {
            Integrator::ExplicitEuler => Update::Explicit,
            Integrator::SemiImplicitEuler => Update::SemiImplicit,
        };
        Free { update, work: Work::default() }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        for (body, at) in model.bodies.iter().zip(&mut state.bodies) {
            euler::step(body, at, &model.gravity_m_s2, self.update, clock.step_s, &mut self.work);
        }
        clock.advance(state);
    }
}
