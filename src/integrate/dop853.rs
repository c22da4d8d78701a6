//! Dormand and Prince's method of order 8 with error estimates of order 5 and 3 (Hairer, Nørsett & Wanner, Solving
//! Ordinary Differential Equations I, II.5 and II.10): as many steps inside one of the clock as the tolerance asks for.
//! A parabola is exact.

use super::dop853_tableau::{A, B, B3, E5};
use super::phase::{Phase, phase, rate, state};
use crate::measure::work::Work;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::Vector3;

/// Error of one inner step, relative and absolute, in every part of the motion.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Below some units of rounding no estimate means anything.
pub const SMALLEST_TOLERANCE: f64 = 1e-15;

/// Tries of a body in one step of the clock; then it is given up, as below.
const MOST: u32 = 100_000;

/// The inner step of a body, kept from one step of the clock to the next.
#[derive(Clone, Copy, Debug)]
pub struct Control {
    pub tolerance: f64,
    inner_s: f64,
}

impl Control {
    /// The first try is the clock's whole step.
    pub fn new(tolerance: f64) -> Self {
        Control { tolerance, inner_s: f64::INFINITY }
    }

    /// Takes note of a try's error: the next step, at most 6 times as long and at least a third (II.4, with the
    /// program's factors). True if the try is good enough.
    fn judge(&mut self, error: f64, tried_s: f64, after_failure: bool) -> bool {
        // error^(1/8).
        let eighth_root = error.sqrt().sqrt().sqrt();
        let wanted_s = tried_s * (0.9 / eighth_root).clamp(1.0 / 3.0, 6.0);
        let good = error <= 1.0;
        self.inner_s = match (good, after_failure) {
            (false, _) if error.is_finite() => wanted_s,
            (false, _) => tried_s / 3.0,
            (true, true) => wanted_s.min(tried_s),
            // The end of the clock's step may have cut this one short.
            (true, false) if tried_s < self.inner_s => wanted_s.max(self.inner_s),
            (true, false) => wanted_s,
        };
        good
    }
}

/// One step of the clock, of a body under a constant acceleration. False: no inner step reaches the tolerance, and the
/// body is left on the way.
pub fn step(
    body: &Body,
    at: &mut BodyState,
    acceleration: &Vector3<f64>,
    step_s: f64,
    control: &mut Control,
    work: &mut Work,
) -> bool {
    let mut f = |y: &Phase| rate(body, acceleration, y, work);
    let (mut left_s, mut failed, mut made) = (step_s, false, 0);
    let mut y = phase(at);
    let mut first = f(&y);
    for _ in 0..MOST {
        // A hundredth more is no reason for another step.
        let tried_s = if left_s <= 1.01 * control.inner_s { left_s } else { control.inner_s };
        let (end, error) = attempt(&mut f, &y, &first, tried_s, control.tolerance);
        failed = !control.judge(error, tried_s, failed);
        if failed && control.inner_s <= 16.0 * f64::EPSILON * step_s {
            break;
        }
        if !failed {
            *at = state(&end);
            left_s -= tried_s;
            made += 1;
            if left_s <= 0.0 {
                break;
            }
            y = phase(at);
            first = f(&y);
        }
    }
    work.inner_steps += made;
    left_s <= 0.0
}

/// The end of a step, and its error over the tolerance.
fn attempt(f: &mut impl FnMut(&Phase) -> Phase, y: &Phase, first: &Phase, h: f64, tolerance: f64) -> (Phase, f64) {
    let mut k = [*first; 12];
    for (i, row) in A.iter().enumerate() {
        k[i + 1] = f(&(y + sum(row, &k) * h));
    }
    let slope = sum(&B, &k);
    let end = y + slope * h;
    let scale = y.zip_map(&end, |a, b| tolerance + tolerance * a.abs().max(b.abs()));
    let error5 = sum(&E5, &k).component_div(&scale).norm_squared();
    let error3 = (slope - sum(&B3, &k)).component_div(&scale).norm_squared();
    (end, combined(error5, error3, h, y.len()))
}

/// The estimate of order 5, made smaller where that of order 3 is much larger (II.10): of order 7 in h.
fn combined(error5: f64, error3: f64, h: f64, components: usize) -> f64 {
    let both = error5 + 0.01 * error3;
    if both == 0.0 { 0.0 } else { h * error5 / (both * components as f64).sqrt() }
}

/// Σ aⱼ kⱼ.
fn sum(weights: &[f64], k: &[Phase]) -> Phase {
    weights.iter().zip(k).filter(|(a, _)| **a != 0.0).fold(Phase::zeros(), |sum, (a, k)| sum + k * *a)
}
