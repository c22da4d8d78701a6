//! The way of a body between two impulses as the judge follows it: straight on, and turning steadily; or, where it
//! turns so far that it shows, turning as a body does that no torque acts on.

use super::figure::{Figure, Stand};
use super::leg::Leg;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::{UnitQuaternion, Vector3};

/// Of the least width of a pair: how far a body's steady turn may leave its true one.
const ASIDE: f64 = 2e-3;
/// Of ω²: the most that an angular velocity changes by without a torque, as (I₂ − I₃)/I₁ is below one: 3^-½.
const CHANGES: f64 = 0.578;
/// Difference of two energies that are one, relative: of slender bodies it shows how an overlap was taken away.
const SAME: f64 = 0.1;
/// Turn in radians of one step along a free turn: the fourth-order rule leaves 3e-11 rad of it.
const STEP: f64 = 0.02;
/// In radians: how far from its end a free turn may lead that is what a step of second order made, after which overlap
/// was taken away.
const ARRIVED: f64 = 0.05;

/// A way, in parts of it from 0 to 1.
pub struct Track<'a> {
    pub leg: Leg,
    /// Radius of what its turning moves; none of a ball about its centre.
    arm_m: f64,
    free: Option<Tumble<'a>>,
}

impl<'a> Track<'a> {
    /// Between two states; `width_m`: the least of the pair.
    pub fn between(
        (body, figure): (&'a Body, &Figure),
        [before, after]: [&BodyState; 2],
        span_s: f64,
        width_m: f64,
    ) -> Self {
        let turn = before.w_WB.norm().max(after.w_WB.norm()) * span_s;
        let is_far = turn * turn * CHANGES / 8.0 * figure.radius_m > ASIDE * width_m;
        let free = is_far.then(|| Tumble::between(body, [before, after], span_s)).flatten();
        let arm_m = if body.is_centred_ball() { 0.0 } else { figure.radius_m };
        Track { leg: Leg::between(before, after, span_s), arm_m, free }
    }

    pub fn at(&mut self, part: f64) -> Stand {
        let mut stand = self.leg.at(part);
        if let Some(free) = &mut self.free {
            stand.q_WB = free.at(part);
        }
        stand
    }

    /// The most that turning moves a point of the body, in metres along a unit vector.
    fn swing_m(&self, along: &Vector3<f64>) -> f64 {
        self.arm_m * self.free.as_ref().map_or_else(|| self.leg.turned.cross(along).norm(), |free| free.most_rad)
    }
}

/// The most that a gap along a unit vector, from the second body to the first, closes on their ways.
pub fn closing_m([a, b]: &[Track; 2], normal: &Vector3<f64>) -> f64 {
    a.swing_m(normal) + b.swing_m(normal) - normal.dot(&(a.leg.moved - b.leg.moved))
}

/// The most that a gap along a unit vector bends on their ways: its second derivative by the part of them.
pub fn bend_m([a, b]: &[Track; 2]) -> f64 {
    let bend_m = |of: &Track| {
        let (rad, changes) =
            of.free.as_ref().map_or((of.leg.turned.norm(), 1.0), |free| (free.most_rad, 1.0 + CHANGES));
        changes * rad * rad * of.arm_m
    };
    bend_m(a) + bend_m(b)
}

/// The most that the distance of two bodies can change on their ways.
pub fn most_m([a, b]: &[Track; 2]) -> f64 {
    let turned_m = |of: &Track| of.arm_m * of.free.as_ref().map_or_else(|| of.leg.turned.norm(), |free| free.most_rad);
    (a.leg.moved - b.leg.moved).norm() + turned_m(a) + turned_m(b)
}

/// A turn without torque: the angular momentum is a constant of the world.
struct Tumble<'a> {
    body: &'a Body,
    L_W: Vector3<f64>,
    span_s: f64,
    start: UnitQuaternion<f64>,
    known: (f64, UnitQuaternion<f64>),
    /// What is left from where it leads to the end of the way, turned along it steadily: angle times axis.
    left: Vector3<f64>,
    /// The most that it turns on the way, in radians.
    most_rad: f64,
}

impl<'a> Tumble<'a> {
    /// None: it is steady, or not what leads from one state to the other.
    fn between(body: &'a Body, [before, after]: [&BodyState; 2], span_s: f64) -> Option<Self> {
        if body.isotropic || body.driven {
            return None;
        }
        let L_W = body.I_W(after) * after.w_WB;
        let [energy, other] = [before, after].map(|at| L_W.dot(&(body.I_W_inverse(at) * L_W)));
        if (energy - other).abs() > SAME * other {
            return None;
        }
        let most_rad = body.fastest_turn_rad_s(after, &after.w_WB) * span_s;
        let known = (0.0, before.q_WB);
        let free = Tumble { body, L_W, span_s, start: before.q_WB, known, left: Vector3::zeros(), most_rad };
        let left = (after.q_WB * free.led_on(known, 1.0).inverse()).scaled_axis();
        let most_rad = most_rad + left.norm();
        (left.norm() <= ARRIVED).then_some(Tumble { left, most_rad, ..free })
    }

    fn at(&mut self, part: f64) -> UnitQuaternion<f64> {
        let from = if (part - self.known.0).abs() < part { self.known } else { (0.0, self.start) };
        self.known = (part, self.led_on(from, part));
        UnitQuaternion::from_scaled_axis(self.left * part) * self.known.1
    }

    fn led_on(&self, (from, mut q_WB): (f64, UnitQuaternion<f64>), part: f64) -> UnitQuaternion<f64> {
        let steps = ((part - from).abs() * self.most_rad / STEP).ceil().max(1.0);
        let step_s = (part - from) * self.span_s / steps;
        for _ in 0..steps as u64 {
            q_WB = self.step(&q_WB, step_s);
        }
        q_WB
    }

    /// One step of the classic fourth-order rule, of the turn from its start (W. Magnus 1954; H. Munthe-Kaas 1999).
    fn step(&self, q_WB: &UnitQuaternion<f64>, step_s: f64) -> UnitQuaternion<f64> {
        // Rate of the turn's vector θ at a turn: ω − ½ θ × ω + θ × (θ × ω)/12.
        let rate = |turned: &Vector3<f64>| {
            let q_WB = UnitQuaternion::from_scaled_axis(*turned) * q_WB;
            let w_W = q_WB * (self.body.I_B_inverse * q_WB.inverse_transform_vector(&self.L_W));
            let across = turned.cross(&w_W);
            w_W - across * 0.5 + turned.cross(&across) / 12.0
        };
        let first = rate(&Vector3::zeros());
        let second = rate(&(first * (0.5 * step_s)));
        let third = rate(&(second * (0.5 * step_s)));
        let fourth = rate(&(third * step_s));
        let turned = (first + (second + third) * 2.0 + fourth) * (step_s / 6.0);
        UnitQuaternion::new_normalize((UnitQuaternion::from_scaled_axis(turned) * q_WB).into_inner())
    }
}
