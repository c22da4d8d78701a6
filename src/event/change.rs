//! When a contact that holds stops doing so: its slip ends, it begins to slip, it opens, or it comes to the border of a
//! face or the end of an edge.

use super::caps;
use super::decide::{Change, Margin, PULL, margin};
use super::forces::{Gathered, Held, Mode, NO_SLIP, Slip, meeting_m_s};
use super::look::Paths;
use crate::collide::Key;
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;

/// Looks at the forces in a step of the integrator.
const LOOKS: u32 = 4;

/// A force that is next to none, and one next to the edge of its cone, relative to the largest: where a change has been
/// found to the last bit of time, what changes is nearer by far.
const NEAR: f64 = 1e-6;

/// How closely a change is found, relative to the time between two looks: to the last bit but some.
const WIDTH: f64 = 1e-14;

/// Normals that differ by less are one.
const SAME_NORMAL: f64 = 1e-9;

/// Of the time between two looks: for slopes.
const BESIDE: f64 = 1e-3;

/// A grip that is not lost between two looks, of the most that there could be.
const FIRM: f64 = 0.1;

/// Times that the interval of a least grip is made smaller.
const NARROWER: u32 = 12;

/// A step of the integrator, looked at.
pub struct Looking<'a> {
    pub paths: Paths<'a>,
    pub held: &'a [Held],
    pub gathered: &'a mut Gathered,
    /// Where the bodies are at the time looked at.
    pub at: &'a mut State,
    pub work: &'a mut Work,
    /// Linear systems beyond which nothing is looked for.
    pub until: u64,
}

impl Looking<'_> {
    fn is_over(&self) -> bool {
        self.gathered.deadline.is_over() || self.work.newton_steps > self.until
    }

    fn look(&mut self, t_s: f64) {
        self.at.time_s = t_s;
        (0..self.at.bodies.len()).for_each(|i| self.at.bodies[i] = self.paths.at(i, t_s));
    }

    /// The first of the looks at which a contact pulls, slips, or has ended its slip; then when it began to.
    pub fn first(&mut self, from_s: f64, to_s: f64) -> Option<(f64, Change)> {
        let mut low_s = from_s;
        for look in 1..=LOOKS {
            let high_s = from_s + (to_s - from_s) * f64::from(look) / f64::from(LOOKS);
            if self.is_over() {
                return None;
            }
            let changed_s = if self.has_changed(high_s) { Some(high_s) } else { self.slips_between(low_s, high_s) };
            if let Some(changed_s) = changed_s {
                let t_s = self.when(low_s, changed_s);
                return Some((t_s, self.what(t_s)));
            }
            low_s = high_s;
        }
        None
    }

    /// A time between two looks at which what sticks at both has slipped: where its grip, which falls from the one and
    /// rises to the other, is least. A convex grip is above its tangents; where those meet above zero, nothing slips.
    fn slips_between(&mut self, mut low_s: f64, mut high_s: f64) -> Option<f64> {
        if self.paths.dense.is_empty() || !self.held.iter().any(|held| held.mode == Mode::Stick) {
            return None;
        }
        let beside_s = (high_s - low_s) * BESIDE;
        for _ in 0..NARROWER {
            let [low, high] = [self.grip(low_s), self.grip(high_s)];
            if low.min(high) > FIRM || high_s - low_s <= 4.0 * beside_s {
                return None;
            }
            let falls = (self.grip(low_s + beside_s) - low) / beside_s;
            let rises = (high - self.grip(high_s - beside_s)) / beside_s;
            if falls >= 0.0 || rises <= 0.0 {
                return None;
            }
            let meet_s = (high - low - rises * high_s + falls * low_s) / (falls - rises);
            if !(meet_s > low_s && meet_s < high_s) || low + falls * (meet_s - low_s) > 0.0 {
                return None;
            }
            if self.has_changed(meet_s) {
                return Some(meet_s);
            }
            let here = self.grip(meet_s);
            if self.grip(meet_s + beside_s) < here { low_s = meet_s } else { high_s = meet_s }
        }
        None
    }

    /// What is left of the friction of contacts that stick side by side, over the most that there could be; the least
    /// of all. It changes smoothly however they share it.
    fn grip(&mut self, t_s: f64) -> f64 {
        self.look(t_s);
        let solved = self.forces().solved;
        let Gathered { here, problem, .. } = &*self.gathered;
        let beside = |i: usize, j: usize| {
            let [(of, other, _), with] = [i, j].map(|k| self.held[k].touch.key());
            self.held[j].mode == Mode::Stick
                && (of, other) == (with.0, with.1)
                && here[i].contact.friction == here[j].contact.friction
                && (here[i].contact.normal - here[j].contact.normal).norm() <= SAME_NORMAL
        };
        let contacts = self.held.len();
        let mut least = 1.0_f64;
        for i in (0..contacts).filter(|i| self.held[*i].mode == Mode::Stick) {
            let together = || (0..contacts).filter(|j| beside(i, *j));
            if together().next() != Some(i) {
                continue;
            }
            let rubs: Vector3<f64> = together().map(|j| problem.blocks[j].along_W(&solved.p[j])).sum();
            let most = here[i].contact.friction * together().map(|j| solved.p[j].x).sum::<f64>();
            least = least.min(if most > 0.0 { 1.0 - rubs.norm() / most } else { 1.0 });
        }
        least
    }

    fn has_changed(&mut self, t_s: f64) -> bool {
        self.look(t_s);
        self.has_left() || (!self.paths.dense.is_empty() && (self.slip_left() < 0.0 || self.forces().least < PULL))
    }

    /// A face or an edge, at its border.
    fn has_left(&self) -> bool {
        self.held.iter().any(|held| held.touch.left_m(self.at) < 0.0) || self.has_turned()
    }

    /// A cap falls flat, or tips.
    pub fn has_turned(&self) -> bool {
        !self.paths.dense.is_empty() && caps::has_turned(self.paths.model, self.held, self.at)
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
        while high_s - low_s > width_s.max(f64::EPSILON * high_s) && !self.is_over() {
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
        let Gathered { here, problem, .. } = &*self.gathered;
        for (((held, p), block), here) in self.held.iter().zip(&solved.p).zip(&problem.blocks).zip(here) {
            let key: Key = held.touch.key();
            if p.x <= near {
                change.opening.push((key, here.contact.p_WC));
            } else if held.mode == Mode::Stick && p.yz().norm() >= held.touch.friction() * p.x - near {
                let d = -block.along_W(p);
                change.slipping.extend(d.try_normalize(0.0).map(|d| (key, d)));
            }
        }
        change
    }
}
