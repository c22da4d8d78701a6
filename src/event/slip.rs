//! Slips that are slow: how slow, and how long a step may be then (`forces::Slip`).

use super::forces::{Gathered, Held, Mode, Slip, Solved};
use crate::model::Model;
use crate::state::State;

/// A young slip's greatest speed over that of a fall by the bodies' size, at a tolerance of that size (chosen): its
/// place is wrong by the fifth power of time and its speed goes with the second, so that the tolerance counts to the
/// power of 2/5.
const YOUNG: f64 = 0.01;
const YOUNG_POWER: f64 = 0.4;

/// A fading slip's energy over that of a fall by the tolerance, twice: its way, s²/2a, is some ten-thousandth of the
/// tolerance.
const FADING: f64 = 2e-4;

/// Speeds below which a slip is young, after it has begun, and fades, before it ends: what is left out is a part of the
/// tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Slow {
    pub young_m_s: f64,
    pub fading_m_s: f64,
    /// However slowly a slip begins: what accelerates it grows with the fall.
    youth_s: f64,
}

impl Slow {
    /// A young slip s ≈ ½ j t² has its direction wrong by about t², and its place by t⁵; one that fades ends after
    /// s²/2a.
    pub fn new(model: &Model, tolerance_m: f64) -> Self {
        let (g, size_m) = falls(model);
        let (speed, part) = ((g * size_m).sqrt(), tolerance_m / size_m);
        let young_m_s = YOUNG * speed * libm::pow(part, YOUNG_POWER);
        let youth_s = (2.0 * young_m_s / (g * (g / size_m).sqrt())).sqrt();
        Slow { young_m_s, fading_m_s: speed * (FADING * part).sqrt(), youth_s }
    }
}

/// A step's part of the time in which a slip would end.
const BEFORE_END: f64 = 0.9;

/// Steps of one that fades, in the times in which it would end: over its end, which `change` finds.
const OVER_END: f64 = 4.0;

/// What is next to nothing has the direction of rounding: of the speeds below which a slip is young or fades.
const NEXT_TO_NOTHING: f64 = 0.01;

/// A step's part of a radian of the fastest force that swings: it is not stepped over.
const SWING_RAD: f64 = 0.5;

/// Says of all slips what they are at the beginning of a step, from the accelerations by its forces. The longest step
/// for which that stays so.
pub fn look(slow: &Slow, held: &mut [Held], state: &State, gathered: &Gathered, solved: &Solved) -> f64 {
    let mut most_s = f64::INFINITY;
    for (held, block) in held.iter_mut().zip(&gathered.problem.blocks).filter(|(held, _)| held.slides().is_some()) {
        let slip = held.touch.here(state).slip_W();
        let speed = slip.norm();
        let a = block.velocity(&solved.added);
        let a_W = block.along_W(&a);
        held.slip = match held.slip {
            Slip::Young if speed < slow.young_m_s => Slip::Young,
            _ if speed < slow.fading_m_s && a_W.dot(&slip) < 0.0 => Slip::Fading,
            _ => Slip::Fast,
        };
        let braked = -a_W.dot(&slip);
        most_s = match held.slip {
            // Not over its end, where its direction is singular, before it fades.
            Slip::Fast if braked > 0.0 => most_s.min(BEFORE_END * speed * speed / braked),
            Slip::Fast => most_s,
            Slip::Young => most_s.min(slow.youth_s).min(slow.young_m_s / a_W.norm()),
            Slip::Fading => most_s.min(OVER_END * speed / a_W.norm()),
        };
        let known = match held.slip {
            Slip::Fast => 0.0,
            Slip::Young => NEXT_TO_NOTHING * slow.young_m_s,
            Slip::Fading => NEXT_TO_NOTHING * slow.fading_m_s,
        };
        if speed > known {
            held.mode = Mode::Slide(slip / speed);
        }
    }
    most_s
}

/// Gravity, and the size of the largest body.
pub fn falls(model: &Model) -> (f64, f64) {
    let size_m = model.largest_radius_m();
    (model.gravity_m_s2.norm(), if size_m > 0.0 { size_m } else { 1.0 })
}

/// The longest step of the integrator.
pub fn longest_s(model: &Model) -> f64 {
    let fastest = model.forces.iter().filter_map(|force| force.cosine).map(|(w, _)| w.abs()).fold(0.0, f64::max);
    if fastest > 0.0 { SWING_RAD / fastest } else { f64::INFINITY }
}
