//! Two balls, each somewhere in its body.

use super::rates::{Rates, pair};
use crate::collide::Contact;
use crate::event::shown::Ball;
use crate::state::BodyState;

pub(super) fn here<'a>(
    found: &Contact,
    bodies: &impl Fn(usize) -> &'a BodyState,
    balls: &[Ball; 2],
) -> (Contact, Rates) {
    let at = pair(found, bodies);
    let arm = [0, 1].map(|i| at[i].q_WB * balls[i].centre_B);
    let arm_rate = [0, 1].map(|i| at[i].w_WB.cross(&arm[i]));
    let apart = at[0].p_WB + arm[0] - at[1].p_WB - arm[1];
    let apart_rate = at[0].v_WB + arm_rate[0] - at[1].v_WB - arm_rate[1];
    let distance = apart.norm();
    let normal = apart / distance;
    let normal_rate = (apart_rate - normal * normal.dot(&apart_rate)) / distance;
    let [radius_A, radius_B] = [balls[0].radius_m, balls[1].radius_m];
    let contact = Contact {
        p_WC: at[0].p_WB + arm[0] - normal * radius_A,
        normal,
        gap_m: distance - radius_A - radius_B,
        ..*found
    };
    let (r_A, r_B) = (arm_rate[0] - normal_rate * radius_A, arm_rate[1] + normal_rate * radius_B);
    (contact, Rates { r_A, r_B, normal: normal_rate })
}
