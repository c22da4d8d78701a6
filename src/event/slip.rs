//! Slips that are slow: how slow, and how long a step may be then (`forces::Slip`).

use super::forces::{Forces, Held, Mode, Slip};
use crate::model::Model;
use crate::state::State;

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
        let young_m_s = 0.01 * speed * libm::pow(part, 0.4);
        let youth_s = (2.0 * young_m_s / (g * (g / size_m).sqrt())).sqrt();
        Slow { young_m_s, fading_m_s: speed * (2e-4 * part).sqrt(), youth_s }
    }
}

/// Of the time in which a slip would end.
const BEFORE_END: f64 = 0.9;

/// Says of all slips what they are at the beginning of a step, from the accelerations in `forces`. The longest step for
/// which that stays so.
pub fn look(slow: &Slow, held: &mut [Held], state: &State, forces: &Forces) -> f64 {
    let mut most_s = f64::INFINITY;
    for (held, block) in held.iter_mut().zip(&forces.problem.blocks).filter(|(held, _)| held.slides().is_some()) {
        let slip = held.touch.here(state).slip_W();
        let speed = slip.norm();
        let a = block.velocity(&forces.added);
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
            Slip::Fading => most_s.min(4.0 * speed / a_W.norm()),
        };
        // What is next to nothing has the direction of rounding.
        let known = match held.slip {
            Slip::Fast => 0.0,
            Slip::Young => 0.01 * slow.young_m_s,
            Slip::Fading => 0.01 * slow.fading_m_s,
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

/// A force that swings is not stepped over.
pub fn longest_s(model: &Model) -> f64 {
    let fastest = model.forces.iter().filter_map(|force| force.cosine).map(|(w, _)| w.abs()).fold(0.0, f64::max);
    if fastest > 0.0 { 0.5 / fastest } else { f64::INFINITY }
}
