//! A block that rocks on its two lower edges, without slip or restitution (Housner, Bull. Seism. Soc. Am. 53 (1963)
//! 403).
//!
//! ψ is the angle from the vertical through the edge to the centre of mass, α flat, p² = m g R/I of the edge. Between
//! impacts it is an inverted pendulum, ψ̇² = 4p² (sin²(ψ/2) − x₁²). An impact leaves the part
//! (I_c + m R² cos 2α)/(I_c + m R²) of the speed, 1 − ³/₂ sin² α for a homogeneous block. SI units.

use super::inverted_pendulum::{Turning, from_highest_s};

/// Impacts slower than this part of the first leave the block at rest: their times differ by less than rounding.
const WEAKEST: f64 = 1e-18;

#[derive(Clone, Debug)]
pub struct RockingBlock {
    alpha_rad: f64,
    /// x₁ of the first arc.
    highest: f64,
    /// Until the first impact, then from one to the next.
    arcs: Vec<Rock>,
    end_s: f64,
}

#[derive(Clone, Debug)]
struct Rock {
    begin_s: f64,
    highest_s: f64,
    turning: Turning,
}

impl RockingBlock {
    /// From a tilt θ ≥ 0 and its rate; α, p and what an impact leaves of the speed. None if it overturns, or never
    /// leaves the ground.
    pub fn new(alpha_rad: f64, natural_rad_s: f64, left: f64, tilt_rad: f64, rate_rad_s: f64) -> Option<Self> {
        let flat = libm::sin(alpha_rad / 2.0);
        let kinetic = (rate_rad_s / (2.0 * natural_rad_s)).powi(2);
        // sin²(α/2) − sin²(ψ/2), without the difference.
        let fallen = libm::sin(alpha_rad - tilt_rad / 2.0) * libm::sin(tilt_rad / 2.0);
        let mut excess = fallen + kinetic;
        if excess >= flat * flat || tilt_rad >= alpha_rad || excess <= 0.0 {
            return None;
        }
        let weakest = excess * WEAKEST * WEAKEST;
        let time_s = |excess: f64, squared: f64| from_highest_s(natural_rad_s, excess, squared);
        let since = libm::copysign(time_s(kinetic, flat * flat - fallen), -rate_rad_s);
        let mut block =
            RockingBlock { alpha_rad, highest: (flat * flat - excess).sqrt(), arcs: Vec::new(), end_s: 0.0 };
        let (mut begin_s, mut highest_s) = (0.0, -since);
        while excess > weakest {
            let highest = (flat * flat - excess).sqrt();
            block.arcs.push(Rock { begin_s, highest_s, turning: Turning::new(natural_rad_s, highest) });
            begin_s = highest_s + time_s(excess, flat * flat);
            excess *= left * left;
            highest_s = begin_s + time_s(excess, flat * flat);
        }
        block.end_s = begin_s;
        Some(block)
    }

    /// Impacts so far, tilt about the edge of that number (0: the first; even and odd take turns) and its rate.
    pub fn at(&self, t_s: f64) -> (usize, f64, f64) {
        let begun = self.arcs.partition_point(|arc| arc.begin_s <= t_s).max(1);
        if t_s >= self.end_s {
            return (begun, 0.0, 0.0);
        }
        let arc = &self.arcs[begun - 1];
        let (psi, rate) = arc.turning.at(t_s - arc.highest_s);
        (begun - 1, self.alpha_rad - psi, -rate)
    }

    /// The least that never slips, of I/(m R²) about the edge. In an impact it is cot α (1 − ε)/(1 + ε) for the part ε
    /// that is left of the speed; in between |ẍ|/(g + z̈), which is monotone in ψ̇², 0 in some later arc.
    pub fn friction(&self, inertia: f64, left: f64) -> f64 {
        const SAMPLES: u32 = 1000;
        let highest = self.highest;
        let first = 2.0 * libm::asin(highest);
        let in_impacts = (1.0 - left) / (1.0 + left) / libm::tan(self.alpha_rad);
        (0..=SAMPLES).fold(in_impacts, |most, i| {
            let psi = first + (self.alpha_rad - first) * f64::from(i) / f64::from(SAMPLES);
            let (sin, cos, half) = (libm::sin(psi), libm::cos(psi), libm::sin(psi / 2.0));
            [0.0, 4.0 * (half * half - highest * highest)].into_iter().fold(most, |most, squared| {
                let press = inertia - sin * sin - squared * cos;
                let needed = (sin * cos - squared * sin).abs() / press;
                if press > 0.0 { most.max(needed) } else { f64::INFINITY }
            })
        })
    }

    /// When each impact comes.
    pub fn impacts_s(&self) -> impl Iterator<Item = f64> {
        let later = self.arcs.iter().skip(1).map(|arc| arc.begin_s);
        later.chain(std::iter::once(self.end_s))
    }
}
