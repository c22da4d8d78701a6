//! Two edges, or round sides, that cross.

use super::rates::{Rates, pair};
use crate::collide::Contact;
use crate::event::shown::Line;
use crate::state::BodyState;
use nalgebra::Vector3;

/// The nearest points of two lines: w = c_1 + s d_1 − c_2 − t d_2 is across both, always.
pub(super) fn here<'a>(
    found: &Contact,
    bodies: &impl Fn(usize) -> &'a BodyState,
    lines: &[Line; 2],
) -> (Contact, Rates) {
    let at = pair(found, bodies);
    let Crossing { arm, d, s, t, w } = Crossing::new(&at, lines);
    let arm_rate = [0, 1].map(|i| at[i].w_WB.cross(&arm[i]));
    let d_rate = [0, 1].map(|i| at[i].w_WB.cross(&d[i]));
    let fixed = at[0].v_WB + arm_rate[0] + d_rate[0] * s - at[1].v_WB - arm_rate[1] - d_rate[1] * t;
    let across = [0, 1].map(|i| -d[i].dot(&fixed) - d_rate[i].dot(&w));
    let [s_rate, t_rate] = crossed(d[0].dot(&d[1]), across);
    let cross = d[0].cross(&d[1]);
    let (sign, length) = (cross.dot(&found.normal).signum(), cross.norm());
    let normal = cross * (sign / length);
    let cross_rate = (d_rate[0].cross(&d[1]) + d[0].cross(&d_rate[1])) * sign;
    let normal_rate = (cross_rate - normal * normal.dot(&cross_rate)) / length;
    let [radius_A, radius_B] = [lines[0].radius_m, lines[1].radius_m];
    let contact = Contact {
        p_WC: at[0].p_WB + arm[0] + d[0] * s - normal * radius_A,
        normal,
        gap_m: normal.dot(&w) - radius_A - radius_B,
        ..*found
    };
    let r_A = arm_rate[0] + d_rate[0] * s + d[0] * s_rate - normal_rate * radius_A;
    let r_B = arm_rate[1] + d_rate[1] * t + d[1] * t_rate + normal_rate * radius_B;
    (contact, Rates { r_A, r_B, normal: normal_rate })
}

/// Two lines: where they are nearest to each other.
pub(super) struct Crossing {
    arm: [Vector3<f64>; 2],
    d: [Vector3<f64>; 2],
    pub(super) s: f64,
    pub(super) t: f64,
    w: Vector3<f64>,
}

impl Crossing {
    pub(super) fn new(at: &[&BodyState; 2], lines: &[Line; 2]) -> Self {
        let arm = [0, 1].map(|i| at[i].q_WB * lines[i].point_B);
        let d = [0, 1].map(|i| at[i].q_WB * lines[i].direction_B);
        let apart = at[0].p_WB + arm[0] - at[1].p_WB - arm[1];
        let [s, t] = crossed(d[0].dot(&d[1]), d.map(|d| -d.dot(&apart)));
        Crossing { arm, d, s, t, w: apart + d[0] * s - d[1] * t }
    }
}

/// x − b y = r_1, b x − y = r_2.
fn crossed(b: f64, r: [f64; 2]) -> [f64; 2] {
    let determinant = b * b - 1.0;
    [(b * r[1] - r[0]) / determinant, (r[1] - b * r[0]) / determinant]
}
