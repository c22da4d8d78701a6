//! When a contact that holds stops doing so: its slip ends, it begins to slip, it opens, or it comes to the border of a
//! face or the end of an edge.

use super::caps;
use super::decide::{AskedOf, Change, Margin, PULL, margin_by};
use super::forces::{Gathered, Held, Mode, NO_SLIP, Slip, Solved, meeting_m_s};
use super::last_forces::LastForces;
use super::look::Paths;
use super::proportion::are_beside;
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

/// Of the time between two looks: for slopes.
const BESIDE: f64 = 1e-3;

/// A grip that is not lost between two looks, of the most that there could be.
const FIRM: f64 = 0.1;

/// A grip that is none but for rounding.
const AT_EDGE: f64 = 1e-9;

/// Times that the interval of a least grip is made smaller.
const NARROWER: u32 = 12;

/// Of the time that is left: how much later the law may see what has changed, forces by so much less than their largest
/// that it is rounding.
const LATER: [f64; 4] = [0.0, 1e-10, 1e-7, 1e-5];

/// How far off the secant, of the square of the time between two looks over the first; and how many times wider than by
/// bisection that time may be.
const AWAY: f64 = 0.2;
const SLACK: f64 = 2.0;

/// Looks at forces that are remembered.
const REMEMBERED: usize = 4;

/// Margins of the forces at one time: the least of all, and the least grip.
#[derive(Clone, Debug)]
pub struct Margins {
    t_s: f64,
    least: f64,
    grip: f64,
    solved: Solved,
}

/// A step of the integrator, looked at.
pub struct Looking<'a> {
    pub paths: Paths<'a>,
    pub held: &'a [Held],
    /// Its end puts to rest what holds: only borders are looked at, and caps.
    pub ends: bool,
    pub gathered: &'a mut Gathered,
    /// Forces of the last look.
    pub last: &'a mut LastForces,
    /// Where the bodies are at the time looked at.
    pub at: &'a mut State,
    pub work: &'a mut Work,
    /// Linear systems beyond which nothing is looked for.
    pub until: u64,
    /// The last looks at forces.
    pub seen: Vec<Margins>,
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
        if self.ends || self.paths.dense.is_empty() || !self.held.iter().any(|held| held.mode == Mode::Stick) {
            return None;
        }
        let beside_s = (high_s - low_s) * BESIDE;
        for _ in 0..NARROWER {
            let [low, high] = [self.grip(low_s), self.grip(high_s)];
            // What needs all of its friction at both looks slides as one with others.
            if low.min(high) > FIRM || low.max(high) <= AT_EDGE || high_s - low_s <= 4.0 * beside_s {
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

    fn grip(&mut self, t_s: f64) -> f64 {
        self.seen(t_s).grip
    }

    fn seen(&mut self, t_s: f64) -> &Margins {
        if let Some(k) = self.seen.iter().position(|seen| seen.t_s == t_s) {
            return &self.seen[k];
        }
        self.look(t_s);
        let Margin { least, solved } = self.forces(AskedOf::Law);
        let seen = Margins { t_s, least, grip: self.grip_of(&solved), solved };
        if self.seen.len() == REMEMBERED {
            self.seen.remove(0);
        }
        self.seen.push(seen);
        &self.seen[self.seen.len() - 1]
    }

    /// What is left of the friction of contacts that stick side by side, over the most that there could be; the least
    /// of all. It changes smoothly however they share it.
    fn grip_of(&self, solved: &Solved) -> f64 {
        let Gathered { here, problem, .. } = &*self.gathered;
        let beside = |i: usize, j: usize| self.held[j].mode == Mode::Stick && are_beside(self.gathered, [i, j]);
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
        self.left(t_s, AskedOf::Law) < 0.0
    }

    /// What is left before something changes, of borders in metres, of slips and forces relative to the largest:
    /// negative, it has.
    fn left(&mut self, t_s: f64, asked: AskedOf) -> f64 {
        self.look(t_s);
        let border_m = self.held.iter().map(|held| held.touch.left_m(self.at)).fold(f64::INFINITY, f64::min);
        if border_m < 0.0 || self.paths.dense.is_empty() {
            return border_m;
        }
        if self.has_turned() {
            return -1.0;
        }
        if self.ends {
            return border_m;
        }
        let slip = self.slip_left();
        if slip < 0.0 {
            return slip;
        }
        let least = match asked {
            AskedOf::Law => self.seen(t_s).least,
            AskedOf::Modes => self.forces(AskedOf::Modes).least,
        };
        border_m.min(slip).min(least - PULL)
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

    fn forces(&mut self, asked: AskedOf) -> Margin {
        margin_by(self.paths.model, self.at, self.held, (self.gathered, self.last), (asked, self.work))
    }

    /// The first moment after the change. What seems to change without the law does change most often, there or so
    /// little later that its forces are still rounding to the law; where it does not, the law is asked from there on.
    fn when(&mut self, low_s: f64, high_s: f64) -> f64 {
        let seems_s = self.when_by(low_s, high_s, AskedOf::Modes);
        let mut goes_on_s = seems_s;
        for part in LATER {
            let later_s = seems_s + (high_s - seems_s) * part;
            if self.has_changed(later_s) {
                return later_s;
            }
            goes_on_s = later_s;
        }
        self.when_by(goes_on_s, high_s, AskedOf::Law)
    }

    /// The same, to the last bit but some: by the secant of what is left, moved toward the middle so that the change
    /// comes to lie on either side, and never much later than by bisection, as what is left may jump (I. F. D.
    /// Oliveira & R. H. C. Takahashi, ACM Trans. Math. Softw. 47 (2020) 5).
    fn when_by(&mut self, mut low_s: f64, mut high_s: f64, asked: AskedOf) -> f64 {
        let all_s = high_s - low_s;
        let width_s = (all_s * WIDTH).max(f64::EPSILON * high_s);
        let [mut low, mut high] = [self.left(low_s, asked), self.left(high_s, asked)];
        // How wide bisection would have left it, and a little more.
        let mut allowed_s = all_s * SLACK;
        while high_s - low_s > width_s && !self.is_over() {
            let (middle_s, wide_s) = (0.5 * (low_s + high_s), high_s - low_s);
            let secant_s = if low.is_finite() && low > high { low_s + wide_s * (low / (low - high)) } else { middle_s };
            let off_s = middle_s - secant_s;
            let toward_s = secant_s + off_s.abs().min(AWAY * wide_s * wide_s / all_s).copysign(off_s);
            let most_s = 0.5 * (allowed_s - wide_s).max(0.0);
            let t_s = toward_s.clamp(middle_s - most_s, middle_s + most_s);
            // Beyond the change by less than what it is known to, so that it is between two looks.
            let t_s = t_s.clamp(low_s + 0.5 * width_s, high_s - 0.5 * width_s);
            if t_s <= low_s || t_s >= high_s {
                break;
            }
            allowed_s *= 0.5;
            let left = self.left(t_s, asked);
            if left < 0.0 {
                (high_s, high) = (t_s, left);
            } else {
                (low_s, low) = (t_s, left);
            }
        }
        high_s
    }

    /// Which contacts open and which begin to slip.
    fn what(&mut self, t_s: f64) -> Change {
        let mut change = Change::default();
        self.look(t_s);
        if self.ends || self.paths.dense.is_empty() {
            return change;
        }
        let Margins { least, solved, .. } = self.seen(t_s).clone();
        if least >= PULL {
            return change;
        }
        self.gathered.gather(self.paths.model, self.at, self.held.iter().map(|held| &held.touch));
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
