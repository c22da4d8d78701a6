//! Slips that are slow (`forces::Slip`): which of them follow a line, how stiff the others are, and how long a step may
//! be then.
//!
//! A contact's friction turns its slip s toward the acceleration without friction at the rate μ a_n (1 + m r²/I)/|s|,
//! which has no bound as s → 0. Where contacts slide side by side along a line, nothing turns: they have one direction,
//! which is kept, and one equation, which is not stiff. All else is left to a method that is stable however stiff it is
//! (`stiff`), from the first moment of a slip on; only what rounding leaves of a slip has the direction in which it
//! begins.
//!
//! A slip that turns ends in a point where its direction is singular (Z. Farkas et al., Phys. Rev. Lett. 90 (2003)
//! 248302): all speeds go to zero together. What is left of it, some ten-thousandth of the tolerance, is one step at
//! whose end impulses obey the law.
//!
//! Of more than three coplanar contacts that turn, how they share the load is not given by the motion of rigid bodies,
//! and decides how fast they turn. The shares are the smallest ones in the sense of Σ |p|², none of which pulls.

use super::forces::{Gathered, Held, Mode, Slip, Solved, meeting_m_s};
use super::touch::Touch;
use crate::math::full_pivot::Selection;
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector3;

/// A fading slip's energy over that of a fall by the tolerance, twice: its way, s²/2a, is some ten-thousandth of the
/// tolerance.
const FADING: f64 = 2e-4;

/// What is left of a slip by rounding, over the speeds that meet: less has no direction of its own.
const KNOWN: f64 = 1e-12;

/// Beside a line: velocity over the speeds that meet, and acceleration over the largest without contact, of a slip that
/// follows it.
const BESIDE: f64 = 1e-11;

/// Speed below which a slip fades, before it ends: what is left out is a part of the tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Slow {
    fading_m_s: f64,
    /// Slips that were to end, and did not, since the last other event: what is pushed on however slowly.
    pub failed: u32,
}

/// Of the speed below which a slip fades, after one that did not.
const FAILED: f64 = 0.25;

impl Slow {
    /// One that fades ends after s²/2a.
    pub fn new(model: &Model, tolerance_m: f64) -> Self {
        let (g, size_m) = falls(model);
        Slow { fading_m_s: (g * size_m).sqrt() * (FADING * tolerance_m / size_m).sqrt(), failed: 0 }
    }

    pub fn fading_m_s(&self) -> f64 {
        self.fading_m_s * libm::pow(FAILED, f64::from(self.failed))
    }
}

/// Of the speed below which a slip fades: so much of it is left where it has not.
const STILL_SLIPS: f64 = 1e-3;

/// Whether some slip that was to end goes on.
pub fn go_on_fading(slow: &Slow, state: &State, held: &[Held]) -> bool {
    let slips = |held: &Held| held.touch.here(state).slip_W().norm() > STILL_SLIPS * slow.fading_m_s();
    held.iter().any(|held| held.slip == Slip::Fading && slips(held))
}

/// A slip that has just begun.
pub fn young(model: &Model, state: &State, touch: &Touch) -> Slip {
    Slip::Young(KNOWN * meeting_m_s(model, state, touch.bodies()))
}

/// A step's part of the time in which a slip would end.
const BEFORE_END: f64 = 0.9;

/// The last step of a slip that fades, in the times in which it would end.
const OVER_END: f64 = 2.0;

/// A step's part of a radian of the fastest force that swings: it is not stepped over.
const SWING_RAD: f64 = 0.5;

/// How a step may be made.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// The longest one.
    pub most_s: f64,
    /// The rate at which the stiffest slip turns.
    pub stiff_hz: f64,
    /// Slips end in this time.
    pub ends_s: Option<f64>,
}

impl Pace {
    pub const FREE: Pace = Pace { most_s: f64::INFINITY, stiff_hz: 0.0, ends_s: None };
}

/// Says of all slips what they are at the beginning of a step, from the accelerations by its forces, and how that step
/// may be made. `lines`: some may follow lines.
pub fn look(
    slow: &Slow,
    (model, state): (&Model, &State),
    held: &mut [Held],
    (gathered, solved): (&Gathered, &Solved),
    lines: bool,
) -> Pace {
    let mut pace = Pace::FREE;
    let scale = gathered.scale();
    for (i, held) in held.iter_mut().enumerate() {
        let (block, here) = (&gathered.problem.blocks[i], &gathered.here[i]);
        let Some(from) = held.slides() else { continue };
        let slip = here.slip_W();
        let (speed, meeting) = (slip.norm(), meeting_m_s(model, state, held.touch.bodies()));
        let a_W = block.along_W(&block.velocity(&solved.added));
        let is_known = speed > KNOWN * meeting;
        let along = if held.slip != Slip::Straight && is_known { slip / speed } else { from };
        let beside = |v: &Vector3<f64>| (v - along * along.dot(v)).norm();
        if lines && beside(&slip) <= BESIDE * meeting && beside(&a_W) <= BESIDE * scale {
            (held.slip, held.mode) = (Slip::Straight, Mode::Slide(along));
            continue;
        }
        let braked = -a_W.dot(&slip);
        held.slip = match held.slip {
            _ if braked > 0.0 && speed < slow.fading_m_s() && is_known => Slip::Fading,
            Slip::Young(until_m_s) if speed <= until_m_s => Slip::Young(until_m_s),
            _ if is_known => Slip::Fast,
            _ => Slip::Young(KNOWN * meeting),
        };
        if is_known {
            held.mode = Mode::Slide(slip / speed);
        }
        if held.slip == Slip::Fading {
            let ends_s = OVER_END * speed * speed / braked;
            pace.ends_s = Some(pace.ends_s.map_or(ends_s, |other_s: f64| other_s.max(ends_s)));
        } else if braked > 0.0 && is_known && (slow.failed == 0 || speed > slow.fading_m_s) {
            // Not over its end, where its direction is singular, before it fades.
            pace.most_s = pace.most_s.min(BEFORE_END * speed * speed / braked);
        }
        let turns = solved.p[i].yz().norm() * block.A[(1, 1)].max(block.A[(2, 2)]);
        pace.stiff_hz = pace.stiff_hz.max(turns / speed);
    }
    pace
}

/// Whether what follows lines has left one.
pub fn leaves_lines(model: &Model, state: &State, held: &[Held]) -> bool {
    held.iter().filter(|held| held.slip == Slip::Straight).any(|held| {
        let (slip, along) = (held.touch.here(state).slip_W(), held.slides().unwrap_or_default());
        (slip - along * along.dot(&slip)).norm() > BESIDE * meeting_m_s(model, state, held.touch.bodies())
    })
}

/// Directions of one pair's contacts that differ by less may be one.
const SAME_DIRECTION: f64 = 1e-3;

/// Newton's steps toward the direction of a line: it is linear but for the cone.
const TRIES: u32 = 6;

/// A turn that tells a derivative.
const TURN_RAD: f64 = 1e-3;

/// Acceleration beside a line over the largest without contact, of slips that begin along one: rounding.
const ON_LINE: f64 = 1e-14;

/// Gives slips that begin side by side, between the same two bodies, one direction, along which they accelerate; with
/// the forces. None: they do not, or it is theirs.
pub fn align(gathered: &Gathered, held: &mut [Held]) -> Option<Solved> {
    let (Some((first, _)), true) = (begins(held).next(), held.len() > 1) else { return None };
    let pair = |held: &Held| (held.touch.key().0, held.touch.key().1);
    let of = pair(&held[first]);
    if held.iter().any(|held| pair(held) != of || !matches!(held.slip, Slip::Young(_)) || held.slides().is_none()) {
        return None;
    }
    let mean = begins(held).fold(Vector3::zeros(), |sum, (_, d)| sum + d).try_normalize(0.0)?;
    let normal = gathered.problem.blocks[first].frame[0];
    if begins(held).any(|(_, d)| (d - mean).norm() > SAME_DIRECTION) {
        return None;
    }
    let contacts = held.len();
    let across = normal.cross(&mean).normalize();
    let at = |angle: f64| {
        let d = mean * libm::cos(angle) + across * libm::sin(angle);
        let solved = gathered.hold_as(std::iter::repeat_n(Mode::Slide(d), contacts), Selection::Least);
        let sideways = normal.cross(&d);
        let beside = |i: usize| {
            let block = &gathered.problem.blocks[i];
            sideways.dot(&block.along_W(&block.velocity(&solved.added)))
        };
        let beside: Vec<f64> = (0..contacts).map(beside).collect();
        (d, beside, solved)
    };
    let middle = |beside: &[f64]| beside.iter().sum::<f64>() / contacts as f64;
    let scale = gathered.scale();
    let slope = (middle(&at(TURN_RAD).1) - middle(&at(0.0).1)) / TURN_RAD;
    let mut angle = 0.0;
    for _ in 0..TRIES {
        let now = middle(&at(angle).1);
        if now.abs() <= ON_LINE * scale || slope == 0.0 {
            break;
        }
        angle -= now / slope;
    }
    let (d, beside, solved) = at(angle);
    if !solved.holds || angle.abs() > SAME_DIRECTION || beside.iter().any(|a| a.abs() > BESIDE * scale) {
        return None;
    }
    held.iter_mut().for_each(|held| held.mode = Mode::Slide(d));
    Some(solved)
}

/// Slips that have just begun.
fn begins(held: &[Held]) -> impl Iterator<Item = (usize, Vector3<f64>)> {
    let young = |(i, held): (usize, &Held)| matches!(held.slip, Slip::Young(_)).then(|| (i, held.slides()));
    held.iter().enumerate().filter_map(young).filter_map(|(i, d)| d.map(|d| (i, d)))
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
