//! Symmetries of mechanics: whatever is rotated, mirrored, moved far away, boosted, listed in another order or written
//! in other units moves the same; what loses no energy runs backward.

use crate::yaml::{experiment, run};
use gotai::state::BodyState;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::fmt::Write;

/// A box and an egg that fly into each other, tumbling.
fn bodies() -> [BodyState; 2] {
    let turned = |axis: Vector3<f64>| UnitQuaternion::from_scaled_axis(axis);
    [
        BodyState {
            p_WB: Vector3::new(-0.9, 0.1, 0.05),
            q_WB: turned(Vector3::new(0.3, -0.5, 0.7)),
            v_WB: Vector3::new(1.5, 0.1, 0.0),
            w_WB: Vector3::new(1.0, -2.0, 3.0),
        },
        BodyState {
            p_WB: Vector3::new(0.8, -0.1, -0.05),
            q_WB: turned(Vector3::new(-0.2, 0.4, 0.9)),
            v_WB: Vector3::new(-1.0, 0.0, 0.1),
            w_WB: Vector3::new(-3.0, 0.5, 1.0),
        },
    ]
}

/// Of lengths, masses and times.
#[derive(Clone, Copy)]
struct Units {
    m: f64,
    kg: f64,
    s: f64,
}

const SI: Units = Units { m: 1.0, kg: 1.0, s: 1.0 };

fn list(v: Vector3<f64>) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

/// The end after half a second, in the order of `bodies`.
fn end(starts: &[BodyState; 2], order: [usize; 2], units: Units) -> [BodyState; 2] {
    let shapes = ["box: { size_m: ", "ellipsoid: { semi_axes_m: "];
    let sizes = [Vector3::new(0.8, 0.5, 0.6), Vector3::new(0.5, 0.3, 0.4)];
    let mut text = "scene:\n  gravity_m_s2: [0, 0, 0]\n  friction: 0.3\n  restitution: 0.4\n  bodies:\n".to_string();
    for i in order {
        let at = &starts[i];
        let [x, y, z, w] = at.q_WB.coords.into();
        let (size, mass) = (list(sizes[i] * units.m), units.kg * [1.0, 1.7][i]);
        let (p, v, spin) = (list(at.p_WB * units.m), list(at.v_WB * (units.m / units.s)), list(at.w_WB / units.s));
        writeln!(
            text,
            "    - {{ name: b{i}, shape: {{ {}{size} }} }}, mass_kg: {mass:?}, position_m: {p}, \
             orientation: {{ quaternion_xyzw: [{x:?}, {y:?}, {z:?}, {w:?}] }}, velocity_m_s: {v}, angular_velocity_rad_s: {spin} }}",
            shapes[i]
        )
        .unwrap();
    }
    let time = format!("time: {{ step_s: {:?}, end_s: {:?} }}\n", 0.005 * units.s, 0.75 * units.s);
    text.push_str("method: { time-stepping: { solver: newton } }\n");
    let ended = run(&experiment(&(text + &time), &[]));
    assert!(ended.measured.contacts_max > 0, "they meet");
    let states = ended.state.bodies;
    let state = |i: usize| {
        let at = states[usize::from(order[0] != i)];
        BodyState { p_WB: at.p_WB / units.m, v_WB: at.v_WB * (units.s / units.m), w_WB: at.w_WB * units.s, ..at }
    };
    [state(0), state(1)]
}

fn apart(a: &[BodyState; 2], b: &[BodyState; 2]) -> f64 {
    let one = |(a, b): (&BodyState, &BodyState)| {
        let (p, v) = ((a.p_WB - b.p_WB).norm(), (a.v_WB - b.v_WB).norm());
        p.max(v).max((a.w_WB - b.w_WB).norm()).max(a.q_WB.angle_to(&b.q_WB))
    };
    a.iter().zip(b).map(one).fold(0.0, f64::max)
}

const ORDER: [usize; 2] = [0, 1];

#[test]
fn a_rotated_scene_moves_the_same() {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.7, -1.1, 0.4));
    let turned = |at: &BodyState, turn: &UnitQuaternion<f64>| BodyState {
        p_WB: turn * at.p_WB,
        q_WB: turn * at.q_WB,
        v_WB: turn * at.v_WB,
        w_WB: turn * at.w_WB,
    };
    let rotated = end(&bodies().map(|at| turned(&at, &turn)), ORDER, SI).map(|at| turned(&at, &turn.inverse()));
    let difference = apart(&rotated, &end(&bodies(), ORDER, SI));
    // measured: 9.5e-14
    assert!(difference < 1e-11, "{difference}");
}

#[test]
fn a_mirrored_scene_moves_as_its_mirror_image() {
    let mirrored = |at: &BodyState| {
        let [x, y, z, w] = at.q_WB.coords.into();
        BodyState {
            p_WB: at.p_WB.component_mul(&Vector3::new(-1.0, 1.0, 1.0)),
            q_WB: UnitQuaternion::new_unchecked(Quaternion::new(w, x, -y, -z)),
            v_WB: at.v_WB.component_mul(&Vector3::new(-1.0, 1.0, 1.0)),
            w_WB: at.w_WB.component_mul(&Vector3::new(1.0, -1.0, -1.0)),
        }
    };
    let image = end(&bodies().map(|at| mirrored(&at)), ORDER, SI).map(|at| mirrored(&at));
    let difference = apart(&image, &end(&bodies(), ORDER, SI));
    // measured: 2.8e-17
    assert!(difference < 1e-11, "{difference}");
}

#[test]
fn a_scene_far_away_or_in_flight_moves_the_same() {
    let (far, fast) = (Vector3::new(1e6, -1e6, 5e5), Vector3::new(30.0, -20.0, 10.0));
    let seen = |at: BodyState, sign: f64, t: f64| BodyState {
        p_WB: at.p_WB + (far + fast * t) * sign,
        v_WB: at.v_WB + fast * sign,
        ..at
    };
    let moved = end(&bodies().map(|at| seen(at, 1.0, 0.0)), ORDER, SI).map(|at| seen(at, -1.0, 0.75));
    let difference = apart(&moved, &end(&bodies(), ORDER, SI));
    // measured: 4.5e-8: 1e6 m are known to 1.2e-10 m, and every step loses half of that
    assert!(difference < 1e-6, "{difference}");
}

#[test]
fn the_order_of_bodies_and_the_units_mean_nothing() {
    let base = end(&bodies(), ORDER, SI);
    let swapped = apart(&end(&bodies(), [1, 0], SI), &base);
    // measured: 3.2e-14
    assert!(swapped < 1e-11, "{swapped}");
    for units in [Units { m: 1e-3, ..SI }, Units { kg: 1e6, ..SI }, Units { s: 1e-3, ..SI }] {
        let difference = apart(&end(&bodies(), ORDER, units), &base);
        // measured: 3.1e-14
        assert!(difference < 1e-11, "{difference}");
    }
}

/// Moreau's scheme is symmetric in time. Each impact multiplies a difference by some number: few of them.
#[test]
fn elastic_impacts_run_backward() {
    let text = |at: &BodyState| {
        let [x, y, z, w] = at.q_WB.coords.into();
        format!(
            "
scene:
  restitution: 1
  container: {{ box: {{ size_m: [3, 3, 3] }} }}
  bodies:
    - name: box
      shape: {{ box: {{ size_m: [0.8, 0.5, 0.6] }} }}
      mass_kg: 1
      position_m: {}
      orientation: {{ quaternion_xyzw: [{x:?}, {y:?}, {z:?}, {w:?}] }}
      velocity_m_s: {}
      angular_velocity_rad_s: {}
  allow_overlap: true
method: {{ time-stepping: {{ solver: newton, scheme: moreau }} }}
time: {{ step_s: 0.004, end_s: 1.2 }}
",
            list(at.p_WB),
            list(at.v_WB),
            list(at.w_WB)
        )
    };
    let start = BodyState { p_WB: Vector3::new(0.0, 1.2, 0.0), ..bodies()[0] };
    let there = run(&experiment(&text(&start), &[]));
    assert!(there.measured.work.contact_solves >= 3, "{}", there.measured.work.contact_solves);
    let reversed = |at: &BodyState| BodyState { v_WB: -at.v_WB, w_WB: -at.w_WB, ..*at };
    let back = reversed(&run(&experiment(&text(&reversed(&there.state.bodies[0])), &[])).state.bodies[0]);
    let difference = apart(&[back, back], &[start, start]);
    // measured: 3.7e-12
    assert!(difference < 1e-9, "{difference}");
}
