//! The way of a body between two impulses as the judge follows it: straight on, and turning steadily; or, where it
//! turns so far that it shows, turning as a body does that no torque acts on.

use super::figure::{Figure, Stand};
use super::leg::Leg;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Of the least width of a pair: how far a body's steady turn may leave its true one.
const ASIDE: f64 = 2e-3;
/// Of ω²: the most that an angular velocity changes by without a torque, as (I₂ − I₃)/I₁ is below one: 3^-½.
const CHANGES: f64 = 0.578;
/// Turn in radians of one step along a free turn: the fourth-order rule leaves 3e-11 rad of it.
const STEP: f64 = 0.02;
/// Of a body's radius: how far its masses may be left from the other end, in the mean square, by a free turn that is
/// what a step of second order made, after which overlap was taken away.
const ARRIVED: f64 = 0.02;
/// Steps along a free turn: what turns farther is taken to turn steadily.
const MOST_STEPS: u32 = 20_000;

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

/// A turn without torque (Euler's equations, in the axes of the body), from one end of the way to the other. At its end
/// overlap may have been taken away, which leaves an angular momentum and, of a slender body, anything of how fast that
/// spins about its axis; or an angular velocity, and not the momentum.
struct Tumble<'a> {
    body: &'a Body,
    span_s: f64,
    /// Where on the way it begins.
    first: (f64, Turning),
    known: (f64, Turning),
    /// What is left from where it leads to the other end, turned along it steadily: angle times axis.
    left: Vector3<f64>,
    /// The most that it turns on the way, in radians.
    most_rad: f64,
}

#[derive(Clone, Copy)]
struct Turning {
    q_WB: UnitQuaternion<f64>,
    w_B: Vector3<f64>,
}

impl<'a> Tumble<'a> {
    /// None: it is steady, or farther from what leads from one state to the other than a steady turn is.
    fn between(body: &'a Body, [before, after]: [&BodyState; 2], span_s: f64) -> Option<Self> {
        if body.isotropic || body.driven {
            return None;
        }
        let in_body = |at: &BodyState, v: &Vector3<f64>| at.q_WB.inverse_transform_vector(v);
        let of_momentum = body.I_B_inverse * in_body(before, &(body.I_W(after) * after.w_WB));
        let left = |to: &BodyState, q_WB: UnitQuaternion<f64>| (to.q_WB * q_WB.inverse()).scaled_axis();
        // How far the masses of the body are left from there.
        let left_m = |to: &BodyState, left: &Vector3<f64>| (left.dot(&(body.I_W(to) * left)) / body.mass_kg).sqrt();
        let ways = [(before, after, 0.0, of_momentum), (after, before, 1.0, in_body(after, &after.w_WB))];
        let follow = |(at, to, part, w_B): (&BodyState, &BodyState, f64, Vector3<f64>)| {
            let first = (part, Turning { q_WB: at.q_WB, w_B });
            let mut free = Tumble { body, span_s, first, known: first, left: Vector3::zeros(), most_rad: 0.0 };
            let (end, fastest) = free.led_on(first, 1.0 - part)?;
            free.left = left(to, end.q_WB);
            free.most_rad = fastest * span_s + free.left.norm();
            Some((left_m(to, &free.left), free))
        };
        let nearer = ways.into_iter().filter_map(follow).min_by(|a, b| a.0.total_cmp(&b.0));
        // Of what is turned without gyroscopic forces that is the way.
        let steady = UnitQuaternion::from_scaled_axis(after.w_WB * span_s) * before.q_WB;
        let most_m = left_m(after, &left(after, steady)).min(ARRIVED * body.bounding_radius_m);
        nearer.filter(|(left_m, _)| *left_m < most_m).map(|(_, free)| free)
    }

    fn at(&mut self, part: f64) -> UnitQuaternion<f64> {
        let far = |from: f64| (part - from).abs();
        let from = if far(self.known.0) < far(self.first.0) { self.known } else { self.first };
        if let Some((turning, _)) = self.led_on(from, part) {
            self.known = (part, turning);
        }
        UnitQuaternion::from_scaled_axis(self.left * far(self.first.0)) * self.known.1.q_WB
    }

    /// The turn at another part of the way, and the fastest on the way there, in rad/s. None: that is too far.
    fn led_on(&self, (from, mut turning): (f64, Turning), part: f64) -> Option<(Turning, f64)> {
        let (mut left_s, mut fastest) = ((part - from) * self.span_s, 0.0_f64);
        for _ in 0..MOST_STEPS {
            let rad_s = turning.w_B.norm();
            fastest = fastest.max(rad_s);
            if left_s.abs() * rad_s <= STEP {
                return Some((self.step(&turning, left_s), fastest));
            }
            let step_s = (STEP / rad_s).copysign(left_s);
            turning = self.step(&turning, step_s);
            left_s -= step_s;
        }
        None
    }

    /// One step of the classic fourth-order rule.
    fn step(&self, Turning { q_WB, w_B }: &Turning, step_s: f64) -> Turning {
        let rate = |q: Quaternion<f64>, w: Vector3<f64>| {
            let turned = q * Quaternion::from_imag(w * 0.5);
            (turned, self.body.I_B_inverse * (self.body.I_B * w).cross(&w))
        };
        let q = q_WB.into_inner();
        let after = |(q_rate, w_rate): (Quaternion<f64>, Vector3<f64>), time_s: f64| {
            rate(q + q_rate * time_s, w_B + w_rate * time_s)
        };
        let first = rate(q, *w_B);
        let second = after(first, 0.5 * step_s);
        let third = after(second, 0.5 * step_s);
        let fourth = after(third, step_s);
        let q_rate = first.0 + (second.0 + third.0) * 2.0 + fourth.0;
        let w_rate = first.1 + (second.1 + third.1) * 2.0 + fourth.1;
        let part_s = step_s / 6.0;
        Turning { q_WB: UnitQuaternion::new_normalize(q + q_rate * part_s), w_B: w_B + w_rate * part_s }
    }
}
