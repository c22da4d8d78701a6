//! When a contact that holds stops doing so: its slip ends, it begins to slip, it opens, or it comes to the border of a
//! face or the end of an edge.

use super::decide::{Change, Margin, margin};
use super::forces::{Gathered, Held, Mode, NO_SLIP, Slip, meeting_m_s};
use super::watch::Paths;
use crate::collide::Key;
use crate::state::State;
use crate::work::Work;

/// Looks at the forces in a step of the integrator.
const LOOKS: u32 = 4;

/// A pull, or a force outside of its cone, relative to the largest: more is no rounding.
const PULL: f64 = -1e-11;

/// A force that is next to none, and one next to the edge of its cone, relative to the largest: where a change has been
/// found to the last bit of time, what changes is nearer by far.
const NEAR: f64 = 1e-6;

/// How closely a change is found, relative to the time between two looks: to the last bit but some.
const WIDTH: f64 = 1e-14;

/// A step of the integrator, looked at.
pub struct Looking<'a> {
    pub paths: Paths<'a>,
    pub held: &'a [Held],
    pub gathered: &'a mut Gathered,
    /// Where the bodies are at the time looked at.
    pub at: &'a mut State,
    pub work: &'a mut Work,
}

impl Looking<'_> {
    fn look(&mut self, t_s: f64) {
        self.at.time_s = t_s;
        (0..self.at.bodies.len()).for_each(|i| self.at.bodies[i] = self.paths.at(i, t_s));
    }

    /// The first of the looks at which a contact pulls, slips, or has ended its slip; then when it began to.
    pub fn first(&mut self, from_s: f64, to_s: f64) -> Option<(f64, Change)> {
        let mut low_s = from_s;
        for look in 1..=LOOKS {
            let high_s = from_s + (to_s - from_s) * f64::from(look) / f64::from(LOOKS);
            if self.gathered.deadline.is_over() {
                return None;
            }
            if self.has_changed(high_s) {
                let t_s = self.when(low_s, high_s);
                return Some((t_s, self.what(t_s)));
            }
            low_s = high_s;
        }
        None
    }

    fn has_changed(&mut self, t_s: f64) -> bool {
        self.look(t_s);
        self.has_left() || (!self.paths.dense.is_empty() && (self.slip_left() < 0.0 || self.forces().least < PULL))
    }

    /// A face or an edge, at its border.
    fn has_left(&self) -> bool {
        self.held.iter().any(|held| held.touch.left_m(self.at) < 0.0)
    }

    /// The least slip along its direction, of all that slide, over the speeds there; with room for rounding.
    fn slip_left(&self) -> f64 {
        let left = self.held.iter().map(|held| match held.slides() {
            Some(d) if !matches!(held.slip, Slip::Young(_)) => {
                held.touch.here(self.at).slip_W().dot(&d) / meeting_m_s(self.paths.model, self.at, held.touch.bodies())
                    + NO_SLIP
            }
            _ => 1.0,
        });
        left.fold(1.0, f64::min)
    }

    fn forces(&mut self) -> Margin {
        margin(self.paths.model, self.at, self.held, self.gathered, self.work)
    }

    /// Bisection: the first moment after the change, to the last bit but some.
    fn when(&mut self, mut low_s: f64, mut high_s: f64) -> f64 {
        let width_s = (high_s - low_s) * WIDTH;
        while high_s - low_s > width_s.max(f64::EPSILON * high_s) && !self.gathered.deadline.is_over() {
            let middle_s = 0.5 * (low_s + high_s);
            if self.has_changed(middle_s) {
                high_s = middle_s;
            } else {
                low_s = middle_s;
            }
        }
        high_s
    }

    /// Which contacts open and which begin to slip.
    fn what(&mut self, t_s: f64) -> Change {
        let mut change = Change::default();
        self.look(t_s);
        if self.paths.dense.is_empty() {
            return change;
        }
        let Margin { least, solved } = self.forces();
        if least >= PULL {
            return change;
        }
        let near = NEAR * solved.largest();
        for ((held, p), block) in self.held.iter().zip(&solved.p).zip(&self.gathered.problem.blocks) {
            let key: Key = held.touch.key();
            if p.x <= near {
                change.opening.push(key);
            } else if held.mode == Mode::Stick && p.yz().norm() >= held.touch.friction() * p.x - near {
                let d = -block.along_W(p);
                change.slipping.extend(d.try_normalize(0.0).map(|d| (key, d)));
            }
        }
        change
    }
}
