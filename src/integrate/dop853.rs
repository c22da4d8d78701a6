//! Dormand and Prince's method of order 8 with error estimates of order 5 and 3 (Hairer, Nørsett & Wanner, Solving
//! Ordinary Differential Equations I, II.5 and II.10): as many steps inside one of the clock as the tolerance asks for.
//! A parabola is exact.

use super::chain::Chain;
use super::dop853_try;
use super::field::Field;
use super::phase::{Phase, phase, state};
use crate::deadline::Deadline;
use crate::model::Model;
use crate::work::Work;

/// Tries of a body in one step of the clock, after which it is given up, as below.
const MOST: u32 = 100_000;

/// Inner step of a body, kept from one step of the clock to the next.
#[derive(Clone, Copy, Debug)]
pub struct Control {
    pub tolerance: f64,
    inner_s: f64,
}

impl Control {
    /// Control of a tolerance; the first try is the clock's whole step.
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

/// Phases of every body of an island: the start and the end of a try, a place on the way, and the slopes.
#[derive(Debug)]
pub struct Scratch {
    y: Vec<Phase>,
    end: Vec<Phase>,
    k: [Vec<Phase>; 12],
}

impl Scratch {
    pub fn new(island: &Chain) -> Self {
        let room = || vec![Phase::zeros(); island.at.len()];
        Scratch { y: room(), end: room(), k: std::array::from_fn(|_| room()) }
    }

    fn start(&mut self, island: &mut Chain, model: &Model, t_s: f64, work: &mut Work) {
        self.y.iter_mut().zip(&island.at).for_each(|(y, at)| *y = phase(at));
        Field { island, model, work }.at(t_s, &self.y, &mut self.k[0]);
    }
}

/// Takes an island over one step of the clock. False where no inner step reaches the tolerance, or time is up; the
/// island is then left on the way.
pub fn step(
    island: &mut Chain,
    model: &Model,
    ([t_s, step_s], deadline): ([f64; 2], Deadline),
    control: &mut Control,
    scratch: &mut Scratch,
    work: &mut Work,
) -> bool {
    let (mut left_s, mut failed) = (step_s, false);
    scratch.start(island, model, t_s, work);
    for _ in 0..MOST {
        // A hundredth more is no reason for another step.
        let tried_s = if left_s <= 1.01 * control.inner_s { left_s } else { control.inner_s };
        let now_s = t_s + (step_s - left_s);
        let error = attempt(&mut Field { island, model, work }, [now_s, tried_s], control.tolerance, scratch);
        failed = !control.judge(error, tried_s, failed);
        if (failed && control.inner_s <= 16.0 * f64::EPSILON * step_s) || deadline.is_over() {
            break;
        }
        if !failed {
            work.inner_steps += 1;
            island.at.iter_mut().zip(&scratch.end).for_each(|(at, y)| *at = state(y));
            left_s -= tried_s;
            if left_s <= 0.0 {
                return true;
            }
            island.hold(model, now_s + tried_s, work);
            scratch.start(island, model, now_s + tried_s, work);
        }
    }
    false
}

/// Puts the end of a try into the scratch; its error over the tolerance.
fn attempt(f: &mut Field, span: [f64; 2], tolerance: f64, scratch: &mut Scratch) -> f64 {
    let Scratch { y, end, k } = scratch;
    let mut rates = |t_s: f64, y: &[Phase], rates: &mut [Phase]| f.at(t_s, y, rates);
    dop853_try::attempt(&mut rates, span, |size| tolerance + tolerance * size, y, end, k)
}
