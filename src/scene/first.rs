//! The first state: where bodies are at t = 0, and how they move.

use super::error::BuildError;
use super::place::{Landing, MOST_DRAWS};
use super::random::Draws;
use crate::experiment::types as file;
use crate::model::Body;
use crate::model::container::Container;
use crate::state::BodyState;
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};

/// The state at t = 0, and how deep `place: at-contact` has put it into the floor.
pub(super) fn first_state(
    described: &file::Body,
    body: &Body,
    experiment: &file::Experiment,
    landing: Option<&Landing>,
) -> Result<(BodyState, f64), BuildError> {
    let given = given_state(described);
    let placed = |mut state: BodyState| {
        state.p_WB = Vector3::from(described.position_m) + state.q_WB * body.p_BoBcm;
        state
    };
    let random = experiment.scene.random.as_ref().filter(|_| !body.driven);
    let Some(random) = random else { return Ok((placed(given), 0.0)) };
    let mut draws = Draws::new(experiment.seed, &described.name);
    let mut draw = || {
        let mut state = given;
        let part = draws.next(random, &mut state);
        (placed(state), part)
    };
    match landing {
        Some(landing) if body.feels_container() => landing.first(body, draw).ok_or_else(|| BuildError {
            path: "scene.random.place".into(),
            expected: "a body that approaches the floor in some draw".into(),
            found: format!("{} receding in all of {MOST_DRAWS}", body.name),
        }),
        _ => Ok((draw().0, 0.0)),
    }
}

/// State as the file says it, but for the position, which follows from the attitude.
pub(super) fn given_state(described: &file::Body) -> BodyState {
    let mut state = BodyState {
        p_WB: Vector3::zeros(),
        q_WB: described.orientation.as_ref().map_or_else(UnitQuaternion::identity, attitude),
        v_WB: described.velocity_m_s.map_or_else(Vector3::zeros, Vector3::from),
        w_WB: described.angular_velocity_rad_s.map_or_else(Vector3::zeros, Vector3::from),
    };
    if let Some(kinematic) = described.kinematic {
        state.v_WB = Vector3::from(kinematic.velocity_m_s);
        state.w_WB = Vector3::from(kinematic.angular_velocity_rad_s);
    }
    if let Some(w_B) = described.angular_velocity_body_rad_s {
        state.w_WB = state.q_WB * Vector3::from(w_B);
    }
    state
}

pub(super) fn attitude(orientation: &file::Orientation) -> UnitQuaternion<f64> {
    let about =
        |axis: Vector3<f64>, deg: f64| UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), deg.to_radians());
    if let Some([x, y, z, w]) = orientation.quaternion_xyzw {
        return UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    }
    if let Some([x, y, z]) = orientation.euler_xyz_deg {
        return about(Vector3::z(), z) * about(Vector3::y(), y) * about(Vector3::x(), x);
    }
    match (orientation.axis, orientation.angle_deg) {
        (Some(axis), Some(deg)) => about(Vector3::from(axis), deg),
        _ => UnitQuaternion::identity(),
    }
}

/// Point of zero potential: the container's lowest point; without a closed one below, the lowest start position.
pub(super) fn potential_zero(
    gravity: &Vector3<f64>,
    container: Option<&Container>,
    bodies: &[Body],
    states: &[BodyState],
) -> Vector3<f64> {
    let Some(down) = gravity.try_normalize(0.0) else {
        return Vector3::zeros();
    };
    let up = -down;
    let moving = bodies.iter().zip(states).filter(|(body, _)| !body.driven);
    let lowest_start = moving.map(|(_, s)| up.dot(&s.p_WB)).reduce(f64::min).unwrap_or_default();
    let height = container.and_then(|c| c.lowest_m(&up)).unwrap_or(lowest_start);
    up * height
}
