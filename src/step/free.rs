//! Motion without contact (L4, L5).

use super::Clock;
use crate::exact::free_motion::FreeMotion;
use crate::experiment::types::{Free as Settings, Integrator, Update};
use crate::integrate::{crank_nicolson, dop853, euler, implicit_midpoint, moser_veselov, rk4};
use crate::measure::work::Work;
use crate::model::Model;
use crate::state::State;

pub struct Free {
    integrator: Integrator,
    /// Of every body, for `dop853`.
    controls: Vec<dop853::Control>,
    /// From the start, for `exact`.
    motion: Option<FreeMotion>,
    /// The tolerance is out of reach.
    pub(super) stalled: bool,
    pub(super) work: Work,
}

impl Free {
    pub fn new(settings: &Settings, model: &Model, start: &State) -> Self {
        let control = dop853::Control::new(settings.tolerance.unwrap_or(dop853::DEFAULT_TOLERANCE));
        let controls = vec![control; model.bodies.len()];
        let motion = (settings.integrator == Integrator::Exact).then(|| FreeMotion::new(model, start));
        Free { integrator: settings.integrator, controls, motion, stalled: false, work: Work::default() }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        if let Some(motion) = &self.motion {
            clock.advance(state);
            return motion.write(state);
        }
        let (g, h, work) = (&model.gravity_m_s2, clock.step_s, &mut self.work);
        for ((body, at), control) in model.bodies.iter().zip(&mut state.bodies).zip(&mut self.controls) {
            match self.integrator {
                Integrator::ExplicitEuler => euler::step(body, at, g, Update::Explicit, h, work),
                Integrator::SemiImplicitEuler => euler::step(body, at, g, Update::SemiImplicit, h, work),
                Integrator::CrankNicolson => crank_nicolson::step(body, at, g, h, work),
                Integrator::ImplicitMidpoint => implicit_midpoint::step(body, at, g, h, work),
                Integrator::Rk4 => rk4::step(body, at, g, h, work),
                Integrator::MoserVeselov => moser_veselov::step(body, at, g, h, work),
                Integrator::Dop853 => self.stalled |= !dop853::step(body, at, g, h, control, work),
                // Not a step from the state before, see above.
                Integrator::Exact => {}
            }
        }
        clock.advance(state);
    }
}
