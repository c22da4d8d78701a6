//! What bodies exchange at the contacts of one step, one impact or one moment: impulses, and the velocities before and
//! after them. All judges of contact look at this one value.

use super::push::Push;
use crate::collide::islands::Islands;
use crate::collide::{Contact, SolvedContact};
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{Matrix3, Vector3};

/// Velocity of the centre of mass and angular velocity, world axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub v: Vector3<f64>,
    pub w: Vector3<f64>,
}

impl Motion {
    fn plus(&self, v: &Vector3<f64>, w: &Vector3<f64>) -> Motion {
        Motion { v: self.v + v, w: self.w + w }
    }

    /// Bound of the speed of a point at this distance from the centre of mass.
    pub fn reach(&self, r_m: f64) -> f64 {
        self.v.norm() + self.w.norm() * r_m
    }
}

/// One body: V, V + M⁻¹ F_E Δt, and that plus M⁻¹ Jᵀ p, all at the attitude where the impulses act.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    pub before: Motion,
    pub free: Motion,
    pub after: Motion,
    /// M⁻¹ F_E Δt, and M⁻¹ Jᵀ p of the contacts.
    pub gained: Motion,
    pub changed: Motion,
    /// What its mean angular velocity through the step is beyond that after, as it turns freely.
    pub turning: Vector3<f64>,
    /// What of Σ|p|/m counts beside them where contacts cancel: all of an impact that goes through a body at rest, a
    /// small part of what presses one without a force of its own.
    pub pressed_m_s: f64,
    /// With the velocities `free` and `after`.
    pub kinetic_j: [f64; 2],
    /// Infinite, and 0, of a body that moves as it is told.
    mass_kg: f64,
    I_W_inverse: Matrix3<f64>,
}

/// Part of the impulses of a step that counts though they cancel. A light body under one that is up to 10⁴ times as
/// heavy is judged by its own weight.
const CANCELLING: f64 = 1e-4;

/// In an impact nothing but rounding may reach a body that others shield, which is then at rest before and after: it is
/// judged by at least this part of the most that any body is pressed by. Rounding is some 1e-8 of that.
const AMONG: f64 = 1e-8;

/// How long it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Over {
    /// Impulses and the step's forces change the velocities.
    Step(f64),
    /// Forces, given as what they would do in this time; the velocities are those of the moment.
    Moment(f64),
}

impl Moved {
    /// With pins, whose impulses nobody tells, the motion after is that of the state after; turning freely keeps I ω.
    fn new(model: &Model, index: usize, [at, after]: [&State; 2], push: &Push, over: Over) -> Self {
        let (body, t_s, after, at) = (&model.bodies[index], at.time_s, &after.bodies[index], &at.bodies[index]);
        let before = Motion { v: at.v_WB, w: at.w_WB };
        let none = Motion { v: Vector3::zeros(), w: Vector3::zeros() };
        if body.driven {
            let I_W_inverse = Matrix3::zeros();
            let (free, after, gained, changed, pressed_m_s) = (before, before, none, none, 0.0);
            let turning = Vector3::zeros();
            return Moved {
                before,
                free,
                after,
                gained,
                changed,
                turning,
                pressed_m_s,
                kinetic_j: [0.0; 2],
                mass_kg: f64::INFINITY,
                I_W_inverse,
            };
        }
        let (Over::Step(span_s) | Over::Moment(span_s)) = over;
        let (v, w) = model.gained(index, t_s, at, span_s);
        let gained = Motion { v, w };
        let I_W_inverse = body.I_W_inverse(at);
        let changed = Motion { v: push.linear / body.mass_kg, w: I_W_inverse * push.angular };
        let (free, after) = match over {
            Over::Moment(_) => (before, before),
            Over::Step(_) if model.pins.is_empty() => {
                let free = before.plus(&v, &w);
                (free, free.plus(&changed.v, &changed.w))
            }
            Over::Step(_) => {
                let w_after = I_W_inverse * (body.I_W(after) * after.w_WB);
                (before.plus(&v, &w), Motion { v: after.v_WB, w: w_after })
            }
        };
        let turning = match over {
            Over::Step(span_s) => body.turns_on(at, &after.w, span_s),
            Over::Moment(_) => Vector3::zeros(),
        };
        let kinetic_j = [free, after].map(|motion| kinetic_j(body, at, &motion));
        let part = if span_s == 0.0 { 1.0 } else { CANCELLING };
        let pressed_m_s = part * push.linear_size / body.mass_kg;
        let mass_kg = body.mass_kg;
        Moved { before, free, after, gained, changed, turning, pressed_m_s, kinetic_j, mass_kg, I_W_inverse }
    }

    /// Trace of E/m − [r] I⁻¹ [r].
    pub fn compliance(&self, r: &Vector3<f64>) -> f64 {
        let I = &self.I_W_inverse;
        3.0 / self.mass_kg + r.norm_squared() * I.trace() - r.dot(&(I * r))
    }
}

/// ½ m v² + ½ ω·I ω.
pub(super) fn kinetic_j(body: &Body, at: &BodyState, motion: &Motion) -> f64 {
    let w_B = if body.isotropic { motion.w } else { at.q_WB.inverse_transform_vector(&motion.w) };
    0.5 * body.mass_kg * motion.v.norm_squared() + 0.5 * w_B.dot(&(body.I_B * w_B))
}

/// One contact: the velocity of its body's point against the other's, before, with the forces, and after.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    pub before: Vector3<f64>,
    pub free: Vector3<f64>,
    pub after: Vector3<f64>,
    /// What a body that turns freely adds to the mean through the step, against what nothing moves.
    pub turning: Vector3<f64>,
    /// The first body of its island.
    pub island: usize,
}

impl Met {
    fn new(model: &Model, contact: &Contact, moved: &[Moved], island: usize) -> Self {
        let relative = |motion: fn(&Moved) -> &Motion| -> Vector3<f64> {
            contact.velocity(|i| [motion(&moved[i]).v, motion(&moved[i]).w])
        };
        let turns = |i: usize| if contact.is_fixed(model) { moved[i].turning } else { Vector3::zeros() };
        let turning = contact.velocity(|i| [Vector3::zeros(), turns(i)]);
        let [before, free, after] = [relative(|m| &m.before), relative(|m| &m.free), relative(|m| &m.after)];
        Met { before, free, after, turning, island }
    }

    /// The largest of the three speeds.
    pub fn speed(&self) -> f64 {
        self.before.norm().max(self.free.norm()).max(self.after.norm())
    }
}

/// The exchange at one set of contacts; it keeps its memory from set to set.
#[derive(Clone, Debug)]
pub(super) struct Exchange {
    /// Of every body.
    pub pushes: Vec<Push>,
    pub moved: Vec<Moved>,
    /// Of every contact.
    pub met: Vec<Met>,
    islands: Islands,
}

impl Exchange {
    /// With room for so many bodies and contacts.
    pub fn with_capacity(bodies: usize, contacts: usize) -> Self {
        Exchange {
            pushes: Vec::with_capacity(bodies),
            moved: Vec::with_capacity(bodies),
            met: Vec::with_capacity(contacts),
            islands: Islands::with_capacity(bodies),
        }
    }

    /// Of contacts whose impulses act at the first of two states; the second is that after the step.
    pub fn look(&mut self, model: &Model, states: [&State; 2], contacts: &[SolvedContact], over: Over) {
        self.pushes.clear();
        self.pushes.resize(model.bodies.len(), Push::default());
        for SolvedContact { contact, impulse_W } in contacts {
            for (i, r_W, sign) in contact.ends() {
                self.pushes[i].add(impulse_W * sign, &r_W);
            }
        }
        self.moved.clear();
        self.moved.extend(self.pushes.iter().enumerate().map(|(i, push)| Moved::new(model, i, states, push, over)));
        let (Over::Step(span_s) | Over::Moment(span_s)) = over;
        if span_s == 0.0 {
            let largest = self.moved.iter().map(|moved| moved.pressed_m_s).fold(0.0, f64::max);
            self.moved.iter_mut().for_each(|moved| moved.pressed_m_s = moved.pressed_m_s.max(AMONG * largest));
        }
        self.islands.find(model, contacts.iter().map(|solved| solved.contact));
        self.met.clear();
        for SolvedContact { contact, .. } in contacts {
            self.met.push(Met::new(model, contact, &self.moved, self.islands.of(model, contact)));
        }
    }
}
