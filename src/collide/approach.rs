//! What the law of contact asks of a contact's normal velocity at the end of a step: Signorini's condition for a gap
//! that may close within the step, and Newton's law of restitution for one that has closed (J. J. Moreau 1988; the gap
//! as in D. E. Stewart, J. C. Trinkle, Int. J. Numer. Meth. Engng 39 (1996) 2673).

use super::Contact;
use super::closed::{is_closed_to_rounding, rounding_m};
use super::lasting::Hold;
pub use crate::experiment::types::Approach;
use crate::model::Model;
use nalgebra::Vector3;

/// An approach, of the speeds that bodies have with the step's forces, that strikes nothing by a law of impact of its
/// own: bodies that rest on each other fall alike, and approach each other by rounding.
const NO_APPROACH: f64 = 1e-9;

/// Normal velocity of a contact: before the step, what the step's forces add to it, and what of the mean through the
/// step is beyond that after the impulses, as bodies turn on freely (`Body::turns_on`). In m/s.
#[derive(Clone, Copy, Debug)]
pub struct NormalMotion {
    pub before: f64,
    pub gained: f64,
    pub turning: f64,
}

/// Whether bodies of these speeds at a contact, with the step's forces, come together before the step.
pub fn comes(motion: NormalMotion, speeds_m_s: impl Iterator<Item = f64>) -> bool {
    -motion.before > NO_APPROACH * speeds_m_s.fold(0.0, f64::max)
}

/// Says of contacts which may close in the step: of every body and face (or other body) none beyond twice the way that
/// the fastest of them closes by itself, as one that touches may turn the body toward the others, nor beyond the way
/// that the step's forces lead the bodies, as impulses that hold one corner let another one fall. What impulses of
/// others close all the same is seen when they are known. `velocities`: of a body by its index, with the step's forces;
/// `fall_m`: how far these lead it in the step.
pub fn foresee(
    model: &Model,
    contacts: &[Contact],
    velocities: impl Fn(usize) -> [Vector3<f64>; 2],
    fall_m: impl Fn(usize) -> f64,
    step_s: f64,
    may_close: &mut Vec<bool>,
) {
    may_close.clear();
    let closing_m = |contact: &Contact| -step_s * contact.normal.dot(&contact.velocity(&velocities));
    let with = |contact: &Contact| (contact.body, contact.other, contact.other.map_or(contact.feature.0, |_| 0));
    for group in contacts.chunk_by(|a, b| with(a) == with(b)) {
        let closes_m = |contact: &Contact| if closing_m(contact) > contact.gap_m { closing_m(contact) } else { 0.0 };
        let alone_m = 2.0 * group.iter().map(closes_m).fold(0.0, f64::max);
        let reach_m = group[0].ends().map(|(i, ..)| fall_m(i)).fold(alone_m, f64::max);
        may_close.extend(group.iter().map(|contact| contact.gap_m <= reach_m.max(rounding_m(model, contact))));
    }
}

impl Approach {
    /// The least normal velocity after the step of a contact that may last: as it came, it is sent back.
    pub fn least_of(
        &self,
        model: &Model,
        contact: &Contact,
        motion: NormalMotion,
        step_s: f64,
        hold: Option<Hold>,
    ) -> Option<f64> {
        hold.map_or_else(|| self.least(model, contact, motion, step_s), |_| Some(-motion.before))
    }

    /// Whether a contact that pressed in this step lasts: it was held, or came to rest.
    pub fn lasts(
        &self,
        model: &Model,
        contact: &Contact,
        motion: NormalMotion,
        step_s: f64,
        hold: Option<Hold>,
    ) -> bool {
        let comes_to_rest = || {
            let rests = motion.before >= 0.0 || contact.restitution < 1.0;
            is_closed_to_rounding(model, contact) && rests && !self.strikes(model, contact, motion, step_s)
        };
        *self == Approach::Middle && (hold.is_some() || comes_to_rest())
    }

    /// Whether this is an impact with a rebound, by whatever law, and not a contact that comes to rest.
    pub fn strikes(&self, model: &Model, contact: &Contact, motion: NormalMotion, step_s: f64) -> bool {
        let NormalMotion { before, gained, .. } = motion;
        let gap_m = if is_closed_to_rounding(model, contact) { 0.0 } else { contact.gap_m };
        let rebounds = -contact.restitution * before.min(0.0) > -gained.min(0.0);
        match self {
            Approach::Inside | Approach::Touching => before < 0.0,
            Approach::Start => rebounds && before + gained < -gap_m / step_s,
            Approach::Middle => {
                rebounds && (gap_m == 0.0 || strikes_early(contact.restitution, gap_m, before + gained, step_s))
            }
        }
    }

    /// The least normal velocity after the step, from the one before it and what forces add in it; none: the contact is
    /// not there in this step.
    pub fn least(&self, model: &Model, contact: &Contact, motion: NormalMotion, step_s: f64) -> Option<f64> {
        let NormalMotion { before, gained, turning } = motion;
        // (How large a gap is matters to nothing at an instant.)
        let is_closed = *self == Approach::Touching || is_closed_to_rounding(model, contact);
        let gap_m = if is_closed { 0.0 } else { contact.gap_m };
        // The new velocity lasts until the next step's contacts are seen: the gap may close until then.
        let closing = -gap_m / step_s;
        let rebound = -contact.restitution * before.min(0.0);
        let falling = gained.min(0.0);
        match self {
            Approach::Inside => Some(rebound),
            Approach::Touching => Some(0.0),
            // Forces act during the impact's step as in any other, else it would add m g Δt v of energy.
            Approach::Start if rebound > 0.0 && before + gained < closing - turning => {
                Some(rebounding(model, contact, motion, gained, step_s))
            }
            // What opens may come back with its part e of that speed: so Moreau's form u⁺ + e u⁻ ≥ 0 has it of all
            // contacts that are closed, and one e for all of them gains no energy without friction.
            Approach::Start => Some(closing.min(-contact.restitution * (before + gained).max(0.0)) - turning),
            // What forces take back within the step comes to rest.
            Approach::Middle if gap_m == 0.0 && before < 0.0 => {
                Some(if contact.restitution < 1.0 && rebound <= -falling { 0.0 } else { rebound })
            }
            // What comes to rest is caught when its gap closes; what bounces, when it is inside, or before (see
            // `strikes_early`). What still opens is let back no faster than it came: no contact adds energy.
            Approach::Middle => {
                let rests = contact.restitution < 1.0 && rebound <= -falling;
                let is_early = strikes_early(contact.restitution, gap_m, before + gained, step_s);
                match gap_m == 0.0 || rests {
                    true => Some(closing.min(-before.max(0.0))),
                    false => is_early.then_some(rebound),
                }
            }
        }
    }
}

/// The least normal velocity after a step that kicks at its start of a contact that has an impact in it, where the
/// step's forces, and what holds its bodies, add `gained` (m/s) to that.
pub fn rebounding(model: &Model, contact: &Contact, motion: NormalMotion, gained: f64, step_s: f64) -> f64 {
    let gap_m = if is_closed_to_rounding(model, contact) { 0.0 } else { contact.gap_m };
    let rebound = -contact.restitution * motion.before.min(0.0);
    (-gap_m / step_s - motion.turning).max(rebound + gained.min(0.0))
}

/// Whether a contact bounces before its gap has closed: inside it would be so deep by the next kick that its rebound
/// does not lead it out by the one after. What loses nothing never does.
fn strikes_early(restitution: f64, gap_m: f64, next: f64, step_s: f64) -> bool {
    let inside_m = -(gap_m + step_s * next);
    inside_m > 0.0 && step_s * restitution * -next < inside_m
}
