//! Pins as constraints (L17): forces λ at the pins for which their points stay together, A λ = c with A = J M⁻¹ Jᵀ,
//! first for the accelerations of an integrator, then for what a step has left of the positions and velocities (E.
//! Hairer, G. Wanner, Solving Ordinary Differential Equations II, VII.2: index reduction and projection).
//!
//! The projection is the smallest change in the metric of the masses. Pins that say the same twice (two on one body: an
//! axis) are allowed: of all forces the smallest are taken.

use super::drive::Drive;
use super::rotation::{exponential, gyroscopic_torque_B};
use crate::math::least_norm::least_norm;
use crate::model::Model;
use crate::model::pins::Anchor;
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// One end of a pin, on a body that it can move.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub pin: usize,
    /// Index among the island's bodies.
    pub member: usize,
    pub r_B: Vector3<f64>,
    /// Sign of the force: +1 on the pin's own body, −1 on the other one.
    pub sign: f64,
    /// Lever arm from the centre of mass to the pin, world axes, at the present states.
    r_W: Vector3<f64>,
}

/// A point of a body that moves as it is told, or of the world.
#[derive(Clone, Copy, Debug)]
struct Hook {
    pin: usize,
    start: BodyState,
    r_B: Vector3<f64>,
}

impl Hook {
    /// Lever arm from the body's centre of mass.
    fn arm(&self, t_s: f64) -> Vector3<f64> {
        exponential(&(self.start.w_WB * t_s)) * (self.start.q_WB * self.r_B)
    }

    /// Position, velocity and acceleration.
    fn at(&self, t_s: f64) -> [Vector3<f64>; 3] {
        let (BodyState { p_WB, v_WB, w_WB, .. }, r) = (&self.start, self.arm(t_s));
        let turning = w_WB.cross(&r);
        [p_WB + v_WB * t_s + r, v_WB + turning, w_WB.cross(&turning)]
    }
}

#[derive(Debug)]
pub struct PinSolver {
    /// Indices of the island's bodies in the model.
    members: Vec<usize>,
    ends: Vec<End>,
    hooks: Vec<Hook>,
    I_W_inverse: Vec<Matrix3<f64>>,
    /// Matrix A, 3 rows a pin.
    A: DMatrix<f64>,
    factor: DMatrix<f64>,
    /// Right-hand side: what is missing at the pins; after `solve` the forces.
    rows: DVector<f64>,
}

/// Part of a pivot before elimination below which it is rounding, and its row said nothing new.
const REDUNDANT: f64 = 1e-11;

impl PinSolver {
    /// Solver of an island's pins; None where no pin holds these bodies.
    pub fn new(members: &[usize], model: &Model, start: &State) -> Option<Self> {
        let member = |body: usize| members.iter().position(|i| *i == body);
        let (mut ends, mut hooks, mut pins) = (Vec::new(), Vec::new(), 0);
        for pin in &model.pins {
            let Some(own) = member(pin.body) else { continue };
            let mut end = |member, r_B, sign| ends.push(End { pin: pins, member, r_B, sign, r_W: r_B });
            end(own, pin.r_B, 1.0);
            match pin.anchor {
                Anchor::World(p_W) => hooks.push(Hook { pin: pins, start: at_rest(p_W), r_B: Vector3::zeros() }),
                Anchor::Body(other, r_B) => match member(other) {
                    Some(other) => end(other, r_B, -1.0),
                    None => hooks.push(Hook { pin: pins, start: start.bodies[other], r_B }),
                },
            }
            pins += 1;
        }
        (pins > 0).then(|| PinSolver {
            members: members.to_vec(),
            ends,
            hooks,
            I_W_inverse: vec![Matrix3::zeros(); members.len()],
            A: DMatrix::zeros(3 * pins, 3 * pins),
            factor: DMatrix::zeros(3 * pins, 3 * pins),
            rows: DVector::zeros(3 * pins),
        })
    }

    /// Adds the pins' forces to the drives.
    pub fn drive(&mut self, model: &Model, t_s: f64, at: &[BodyState], drives: &mut [Drive], work: &mut Work) {
        self.gather(model, at);
        let acceleration = |solver: &Self, end: &End| {
            let (body, at, drive) = (&model.bodies[solver.members[end.member]], &at[end.member], &drives[end.member]);
            let w_B = at.q_WB.inverse_transform_vector(&at.w_WB);
            let torque_W = at.q_WB * (drive.torque_B + gyroscopic_torque_B(body, &w_B));
            let turning = solver.I_W_inverse[end.member] * torque_W;
            drive.acceleration + turning.cross(&end.r_W) + at.w_WB.cross(&at.w_WB.cross(&end.r_W))
        };
        self.fill_rows(t_s, 2, acceleration);
        self.solve(work);
        for end in &self.ends {
            let force = self.force(end);
            let drive = &mut drives[end.member];
            drive.acceleration += force / model.bodies[self.members[end.member]].mass_kg;
            drive.torque_B += at[end.member].q_WB.inverse_transform_vector(&end.r_W.cross(&force));
        }
    }

    /// Closes the gaps of the pins, then takes what velocity is left between the points.
    pub fn hold(&mut self, model: &Model, t_s: f64, at: &mut [BodyState], work: &mut Work) {
        /// Newton's method from what one step has left.
        const MOST: u32 = 10;
        let size = self.ends.iter().map(|end| at[end.member].p_WB.norm() + end.r_B.norm()).fold(0.0, f64::max);
        for _ in 0..MOST {
            self.gather(model, at);
            self.fill_rows(t_s, 0, |_, end| at[end.member].p_WB + end.r_W);
            if self.rows.amax() <= 4.0 * f64::EPSILON * size {
                break;
            }
            self.solve(work);
            for end in &self.ends {
                let (at, force) = (&mut at[end.member], self.force(end));
                at.p_WB += force / model.bodies[self.members[end.member]].mass_kg;
                let turn = self.I_W_inverse[end.member] * end.r_W.cross(&force);
                // ω is that of the body: it turns with it.
                let turn = exponential(&turn);
                (at.q_WB, at.w_WB) = (turn * at.q_WB, turn * at.w_WB);
            }
            at.iter_mut().for_each(|at| {
                at.q_WB.renormalize();
            });
        }
        self.fill_rows(t_s, 1, |_, end| at[end.member].v_WB + at[end.member].w_WB.cross(&end.r_W));
        self.solve(work);
        for end in &self.ends {
            let (at, force) = (&mut at[end.member], self.force(end));
            at.v_WB += force / model.bodies[self.members[end.member]].mass_kg;
            at.w_WB += self.I_W_inverse[end.member] * end.r_W.cross(&force);
        }
    }

    /// Number of the island's pins.
    pub fn count(&self) -> usize {
        self.rows.len() / 3
    }

    pub fn ends(&self) -> impl Iterator<Item = &End> {
        self.ends.iter()
    }

    /// Pins on bodies that move as they are told: index of the pin, and the body's ω.
    pub fn hooks(&self) -> impl Iterator<Item = (usize, Vector3<f64>)> {
        self.hooks.iter().map(|hook| (hook.pin, hook.start.w_WB))
    }

    /// Lever arm from such a body's centre of mass to the pin, at a time.
    pub fn arm(&self, hook: usize, t_s: f64) -> Vector3<f64> {
        self.hooks[hook].arm(t_s)
    }

    /// Sets what is missing at a pin, before `solve`.
    pub fn ask(&mut self, pin: usize, missing: &Vector3<f64>) {
        self.rows.fixed_rows_mut::<3>(3 * pin).copy_from(missing);
    }

    /// The force at a pin, after `solve`.
    pub fn answer(&self, pin: usize) -> Vector3<f64> {
        self.rows.fixed_rows::<3>(3 * pin).into_owned()
    }

    /// Gathers levers and A at these states.
    pub fn gather(&mut self, model: &Model, at: &[BodyState]) {
        for ((inverse, i), at) in self.I_W_inverse.iter_mut().zip(&self.members).zip(at) {
            *inverse = model.bodies[*i].I_W_inverse(at);
        }
        self.ends.iter_mut().for_each(|end| end.r_W = at[end.member].q_WB * end.r_B);
        self.A.fill(0.0);
        for a in &self.ends {
            for b in self.ends.iter().filter(|b| b.member == a.member) {
                let inverse_mass = 1.0 / model.bodies[self.members[a.member]].mass_kg;
                let turning = a.r_W.cross_matrix() * self.I_W_inverse[a.member] * b.r_W.cross_matrix();
                let block = (Matrix3::from_diagonal_element(inverse_mass) - turning) * (a.sign * b.sign);
                let mut place = self.A.fixed_view_mut::<3, 3>(3 * a.pin, 3 * b.pin);
                place += block;
            }
        }
    }

    /// −(value at one end − value at the other) of every pin; `derivative` says which of the hooks' values.
    fn fill_rows(&mut self, t_s: f64, derivative: usize, value: impl Fn(&Self, &End) -> Vector3<f64>) {
        self.rows.fill(0.0);
        for i in 0..self.ends.len() {
            let end = self.ends[i];
            let value = value(self, &end) * end.sign;
            let mut row = self.rows.fixed_rows_mut::<3>(3 * end.pin);
            row -= value;
        }
        for hook in &self.hooks {
            let mut row = self.rows.fixed_rows_mut::<3>(3 * hook.pin);
            row += hook.at(t_s)[derivative];
        }
    }

    /// Solves A λ = rows, by Cholesky, or by the pseudo-inverse where rows say the same twice.
    pub fn solve(&mut self, work: &mut Work) {
        work.pin_solves += 1;
        self.factor.copy_from(&self.A);
        if let Some(cholesky) = std::mem::take(&mut self.factor).cholesky() {
            let L = cholesky.l_dirty();
            let is_new = |i: usize| L[(i, i)] * L[(i, i)] > REDUNDANT * self.A[(i, i)];
            let regular = (0..L.nrows()).all(is_new);
            if regular {
                cholesky.solve_mut(&mut self.rows);
            }
            self.factor = cholesky.unpack_dirty();
            if regular {
                return;
            }
        } else {
            self.factor = self.A.clone();
        }
        self.rows = least_norm(self.A.clone(), &self.rows, REDUNDANT);
    }

    fn force(&self, end: &End) -> Vector3<f64> {
        self.answer(end.pin) * end.sign
    }
}

fn at_rest(p_W: Vector3<f64>) -> BodyState {
    BodyState { p_WB: p_W, q_WB: nalgebra::UnitQuaternion::identity(), v_WB: Vector3::zeros(), w_WB: Vector3::zeros() }
}
