//! From event to event.

use crate::collide::SolvedContact;
use crate::exact::arc::Arc;
use crate::exact::free_rotation::FreeRotation;
use crate::experiment::types::EventDriven as Settings;
use crate::measure::Moment;
use crate::measure::divergence::Criterion;
use crate::measure::work::Work;
use crate::model::Model;
use crate::plan::Plan;
use crate::state::State;

use super::Span;

pub struct EventDriven {
    tolerance: f64,
    motions: Vec<(Arc, FreeRotation)>,
    pub(super) span: Span,
    pub(super) stalled: Option<Criterion>,
    pub(super) solved: Vec<SolvedContact>,
    pub(super) work: Work,
}

impl EventDriven {
    pub fn new(settings: &Settings, _plan: &Plan, model: &Model, start: &State) -> Self {
        let motion = |(i, at): (usize, &crate::state::BodyState)| {
            let (v, _) = model.gained(i, 0.0, at, 1.0);
            let rotation = FreeRotation::new(&model.bodies[i].I_B, &at.q_WB, &at.w_WB);
            (Arc::straight(start.time_s, *at, v), rotation)
        };
        EventDriven {
            tolerance: settings.tolerance,
            motions: start.bodies.iter().enumerate().map(motion).collect(),
            span: Span::Motion,
            stalled: None,
            solved: Vec::new(),
            work: Work::default(),
        }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, end_s: f64) {
        let _ = self.tolerance;
        state.step += 1;
        state.time_s = end_s;
        self.state_at(model, state);
    }

    pub fn state_at(&mut self, _model: &Model, state: &mut State) {
        let t_s = state.time_s;
        for ((arc, rotation), at) in self.motions.iter().zip(&mut state.bodies) {
            *at = arc.at(t_s);
            (at.q_WB, at.w_WB) = rotation.at(t_s);
        }
    }

    pub fn forces_at(&mut self, _model: &Model, _state: &State) -> Vec<SolvedContact> {
        Vec::new()
    }

    pub fn moments(&mut self, _model: &Model, _span: [&State; 2]) -> Vec<Moment> {
        Vec::new()
    }
}
