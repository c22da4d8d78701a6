//! A rimless wheel: a regular prism that rolls over its edges on a plane, without slip or restitution (T. McGeer, Int.
//! J. Robotics Research 9 (1990) 62).
//!
//! About an edge it is an inverted pendulum, θ̈ = p² sin θ, p² = (g/l)/(1 + κ), κ = I/(m l²), l from the edge to the
//! centre. The leg is at ψ = θ − γ from the plane's normal, γ the slope; at ψ = ±α, half the angle between two legs,
//! the next edge strikes and the part (κ + cos 2α)/(κ + 1) of the rate is left. It rolls on, or back and forth until it
//! stands. SI units.

use super::inverted_pendulum::InvertedPendulum;

/// Impacts slower than this part of the first leave the wheel standing: their times differ by less than rounding.
const WEAKEST: f64 = 1e-18;

#[derive(Clone, Copy, Debug)]
pub struct RimlessWheel {
    /// α.
    pub half_angle_rad: f64,
    /// γ: downward in the direction of positive ψ.
    pub slope_rad: f64,
    /// g/l.
    pub gravity_rad_s2: f64,
    /// κ.
    pub inertia: f64,
    /// ψ and its rate.
    pub start: [f64; 2],
}

/// From one impact to the next.
#[derive(Clone, Debug)]
struct Leg {
    begin_s: f64,
    /// Edges forward since the start.
    steps: i64,
    swing: InvertedPendulum,
}

/// Of the next edge: when, at which end of the leg's swing, at which rate.
#[derive(Clone, Copy, Debug)]
struct Impact {
    t_s: f64,
    side: f64,
    rate: f64,
}

/// Edges forward since the start, ψ, and its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    pub steps: i64,
    pub angle_rad: f64,
    pub rate_rad_s: f64,
}

impl RimlessWheel {
    fn natural_rad_s(&self) -> f64 {
        (self.gravity_rad_s2 / (1.0 + self.inertia)).sqrt()
    }

    /// Of the rate, by an impact.
    pub fn left(&self) -> f64 {
        (self.inertia + libm::cos(2.0 * self.half_angle_rad)) / (self.inertia + 1.0)
    }

    fn leg(&self, begin_s: f64, steps: i64, angle: f64, rate: f64) -> Leg {
        let swing = InvertedPendulum::new(self.natural_rad_s(), angle + self.slope_rad, rate);
        Leg { begin_s, steps, swing }
    }

    fn first(&self) -> Leg {
        self.leg(0.0, 0, self.start[0], self.start[1])
    }

    fn end(&self, leg: &Leg) -> Option<Impact> {
        let ends = [1.0, -1.0].into_iter().filter_map(|side| {
            let (after_s, rate) = leg.swing.comes_to(side * self.half_angle_rad + self.slope_rad)?;
            Some(Impact { t_s: leg.begin_s + after_s, side, rate })
        });
        ends.min_by(|a, b| a.t_s.total_cmp(&b.t_s))
    }

    fn next(&self, leg: &Leg, impact: &Impact) -> Leg {
        let steps = leg.steps + impact.side as i64;
        self.leg(impact.t_s, steps, -impact.side * self.half_angle_rad, impact.rate * self.left())
    }

    pub fn at(&self, t_s: f64) -> Stance {
        let (mut leg, mut weakest) = (self.first(), 0.0_f64);
        while let Some(impact) = self.end(&leg) {
            if impact.t_s > t_s {
                break;
            }
            if impact.rate.abs() <= weakest {
                return Stance { steps: leg.steps, angle_rad: impact.side * self.half_angle_rad, rate_rad_s: 0.0 };
            }
            weakest = weakest.max(WEAKEST * impact.rate.abs());
            leg = self.next(&leg, &impact);
        }
        let (angle, rate_rad_s) = leg.swing.at(t_s - leg.begin_s);
        Stance { steps: leg.steps, angle_rad: angle - self.slope_rad, rate_rad_s }
    }

    /// The least friction that never slips; infinite if the wheel leaves the plane. In an impact it is
    /// cot α (1 − ε)/(1 + ε) for the part ε that is left of the rate.
    pub fn friction(&self) -> f64 {
        const SAMPLES: u32 = 100;
        const MOST: u32 = 10_000;
        /// Of the rate: legs that differ by less are the same.
        const SAME: f64 = 1e-9;
        let (left, mut leg, mut before, mut fastest) = (self.left(), self.first(), [0.0; 2], 0.0_f64);
        let mut most = (1.0 - left) / (1.0 + left) / libm::tan(self.half_angle_rad);
        for _ in 0..MOST {
            let Some(impact) = self.end(&leg) else { return f64::INFINITY };
            let length_s = impact.t_s - leg.begin_s;
            most = (0..=SAMPLES)
                .map(|i| self.needed(leg.swing.at(length_s * f64::from(i) / f64::from(SAMPLES))))
                .fold(most, f64::max);
            // Two impacts ago: rolling repeats every step, rocking every other.
            fastest = fastest.max(impact.rate.abs());
            let repeats = (impact.rate - before[0]).abs() <= SAME * impact.rate.abs();
            if repeats || impact.rate.abs() <= SAME * fastest {
                break;
            }
            before = [before[1], impact.rate];
            leg = self.next(&leg, &impact);
        }
        most
    }

    /// Along the plane over across it, of the force of the contact.
    fn needed(&self, (angle, rate): (f64, f64)) -> f64 {
        let psi = angle - self.slope_rad;
        let gain = libm::sin(angle) / (1.0 + self.inertia);
        let squared = rate * rate / self.gravity_rad_s2;
        let (sin, cos) = (libm::sin(psi), libm::cos(psi));
        let press = libm::cos(self.slope_rad) - gain * sin - squared * cos;
        let along = gain * cos - squared * sin - libm::sin(self.slope_rad);
        if press > 0.0 { along.abs() / press } else { f64::INFINITY }
    }
}
