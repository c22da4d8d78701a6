//! What the recording thread works out of samples, so that the simulating one need not: modes of contacts, depths of
//! overlap.

use super::sample::{Batch, Streams, contact_mode};
use crate::measure::geometry::GeometryLedger;
use crate::model::Model;
use crate::rows::BodyRow;
use crate::state::{BodyState, State};
use nalgebra::{Quaternion, UnitQuaternion};

/// Worker beside a run.
pub struct Aside {
    model: Model,
    state: State,
    /// Of samples as they are due, and of those that go ahead: what a judge remembers goes by the run alone.
    due: GeometryLedger,
    ahead: GeometryLedger,
    has_depths: bool,
}

impl Aside {
    /// Of a run from `start`.
    pub fn new(model: &Model, start: &State, streams: Streams) -> Self {
        let judge = || GeometryLedger::new(model, start, true);
        Aside {
            has_depths: Self::has_depths(streams),
            due: judge(),
            ahead: judge(),
            model: model.clone(),
            state: start.clone(),
        }
    }

    /// Whether depths are worked out here: where samples show the bodies.
    pub fn has_depths(streams: Streams) -> bool {
        streams.energy && streams.bodies
    }

    /// Works out what is left to be, of samples that are due.
    pub fn complete(&mut self, batch: &mut Batch) {
        if std::mem::take(&mut batch.is_raw) {
            modes(batch);
            if self.has_depths {
                depths(&self.model, &mut self.state, &mut self.due, batch);
            }
        }
    }

    /// The same of samples that a later batch brings again.
    pub fn complete_ahead(&mut self, batch: &mut Batch) {
        if std::mem::take(&mut batch.is_raw) {
            modes(batch);
            if self.has_depths {
                depths(&self.model, &mut self.state, &mut self.ahead, batch);
            }
        }
    }
}

fn modes(batch: &mut Batch) {
    for contact in &mut batch.contacts {
        (contact.mode, contact.friction_use) = contact_mode(contact.force_n, contact.normal, contact.friction_use);
    }
}

fn depths(model: &Model, state: &mut State, geometry: &mut GeometryLedger, batch: &mut Batch) {
    let bodies = state.bodies.len().max(1);
    for ((energy, sample), time_s) in batch.energy.iter_mut().zip(batch.bodies.chunks(bodies)).zip(&batch.time_s) {
        state.time_s = *time_s;
        for (at, row) in state.bodies.iter_mut().zip(sample) {
            *at = state_of(row);
        }
        energy.penetration_m = geometry.penetration_m(model, state).unwrap_or(0.0);
    }
}

/// The state that a row was made of, bit for bit.
fn state_of(row: &BodyRow) -> BodyState {
    let [i, j, k, w] = row.orientation_xyzw;
    BodyState {
        p_WB: row.position_m.into(),
        q_WB: UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k)),
        v_WB: row.velocity_m_s.into(),
        w_WB: row.angular_velocity_rad_s.into(),
    }
}
