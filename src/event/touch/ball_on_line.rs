//! A ball beside an edge, or a round side.

use super::rates::{Rates, pair};
use crate::collide::Contact;
use crate::event::shown::{Ball, Line};
use crate::state::BodyState;
use nalgebra::Vector3;

pub(super) fn here<'a>(
    found: &Contact,
    bodies: &impl Fn(usize) -> &'a BodyState,
    first: bool,
    ball: &Ball,
    line: &Line,
) -> (Contact, Rates) {
    let Beside { of_ball, of_line, arm, foot, d, apart, s, off } = Beside::new(pair(found, bodies), first, ball, line);
    let w = &of_line.w_WB;
    let (arm_rate, foot_rate, d_rate) = (of_ball.w_WB.cross(&arm), w.cross(&foot), w.cross(&d));
    let apart_rate = of_ball.v_WB + arm_rate - of_line.v_WB - foot_rate;
    let s_rate = d_rate.dot(&apart) + d.dot(&apart_rate);
    let off_rate = apart_rate - d * s_rate - d_rate * s;
    let distance = off.norm();
    // From the line to the ball.
    let out = off / distance;
    let out_rate = (off_rate - out * out.dot(&off_rate)) / distance;
    let r_ball = arm_rate - out_rate * ball.radius_m;
    let r_line = foot_rate + d_rate * s + d * s_rate + out_rate * line.radius_m;
    let (sign, r_A, r_B) = if first { (1.0, r_ball, r_line) } else { (-1.0, r_line, r_ball) };
    let contact = Contact {
        p_WC: of_ball.p_WB + arm - out * ball.radius_m,
        normal: out * sign,
        gap_m: distance - ball.radius_m - line.radius_m,
        ..*found
    };
    (contact, Rates { r_A, r_B, normal: out_rate * sign })
}

/// A ball beside a line: c_ball = c_line + s d + off, off across the line.
pub(super) struct Beside<'a> {
    pub(super) of_ball: &'a BodyState,
    pub(super) of_line: &'a BodyState,
    arm: Vector3<f64>,
    foot: Vector3<f64>,
    d: Vector3<f64>,
    apart: Vector3<f64>,
    pub(super) s: f64,
    pub(super) off: Vector3<f64>,
}

impl<'a> Beside<'a> {
    pub(super) fn new([a, b]: [&'a BodyState; 2], first: bool, ball: &Ball, line: &Line) -> Self {
        let (of_ball, of_line) = if first { (a, b) } else { (b, a) };
        let (arm, foot) = (of_ball.q_WB * ball.centre_B, of_line.q_WB * line.point_B);
        let d = of_line.q_WB * line.direction_B;
        let apart = of_ball.p_WB + arm - of_line.p_WB - foot;
        let s = d.dot(&apart);
        Beside { of_ball, of_line, arm, foot, d, apart, s, off: apart - d * s }
    }
}
