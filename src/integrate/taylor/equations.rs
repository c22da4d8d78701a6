//! The equations of motion of an island as operations on series. The body's axes are here the principal ones, in which
//! Euler's equation takes three products.
//!
//! Pins: their forces λ are such that the accelerations of their two points agree. The order k of that is linear in λₖ
//! with the matrix A = J M⁻¹ Jᵀ at the start: what is missing at λₖ = 0 says what λₖ is.

use super::invariants::Invariants;
use super::tape::{Id, Tape};
use crate::experiment::types::Frame;
use crate::integrate::chain::Chain;
use crate::integrate::phase::to_world;
use crate::integrate::pin_solver::PinSolver;
use crate::integrate::rotation::exponential;
use crate::model::loads::AppliedForce;
use crate::model::{Body, Model};
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::{Matrix3, Quaternion, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};

/// One body's series.
#[derive(Clone, Debug)]
struct Moving {
    p: Id,
    v: Id,
    /// Angular velocity in principal axes.
    w: Id,
    q: Id,
    /// Rotation from principal axes to the body's.
    q_BP: UnitQuaternion<f64>,
    gyroscopic: bool,
    /// Principal moments.
    I: Vector3<f64>,
    /// Gravity, if nothing else acts on the body.
    gravity: Option<Vector3<f64>>,
    /// Invariants of a free body that is not isotropic, from its start on.
    invariants: Option<Invariants>,
}

/// A point that moves in a circle: where a pin hangs on a body that moves as it is told.
#[derive(Clone, Debug)]
struct Circling {
    hook: usize,
    arm: Id,
}

#[derive(Clone, Debug)]
pub struct Equations {
    pub tape: Tape,
    bodies: Vec<Moving>,
    circling: Vec<Circling>,
    /// Force of every pin, and the acceleration between its two points.
    pins: Vec<(Id, Id)>,
    /// Number of the first operation that depends on the forces of the pins.
    pinned_from: usize,
}

impl Equations {
    pub fn new(island: &Chain, model: &Model) -> Self {
        let mut tape = Tape::default();
        let bodies: Vec<Moving> = {
            let gravity = island.is_free().then_some(model.gravity_m_s2);
            island.bodies(model).map(|body| Moving::new(body, gravity, &mut tape)).collect()
        };
        let mut drives: Vec<Driven> = Vec::new();
        for (i, (moving, index)) in bodies.iter().zip(island.members()).enumerate() {
            drives.push(Driven::new(moving, island.body(i, model), *index, model, &mut tape));
        }
        let mut equations = Equations { tape, bodies, circling: Vec::new(), pins: Vec::new(), pinned_from: 0 };
        equations.pin(island, model, &mut drives);
        for (moving, drive) in equations.bodies.iter().zip(drives) {
            drive.close(moving, &mut equations.tape);
        }
        equations
    }

    /// Adds the pins' forces to the drives.
    fn pin(&mut self, island: &Chain, model: &Model, drives: &mut [Driven]) {
        let tape = &mut self.tape;
        let Some(solver) = island.pins() else {
            self.pinned_from = tape.operations();
            return;
        };
        // What does not depend on the forces comes first.
        let arms: Vec<(Id, Id)> = solver
            .ends()
            .map(|end| {
                let moving = &self.bodies[end.member];
                let r = tape.constant(moving.q_BP.inverse_transform_vector(&end.r_B));
                let turning = tape.cross(moving.w, r);
                (r, tape.cross(moving.w, turning))
            })
            .collect();
        let mut gaps: Vec<Vec<(f64, Id)>> = vec![Vec::new(); solver.count()];
        for (hook, (pin, w_WB)) in solver.hooks().enumerate() {
            let arm = tape.series();
            let rate = tape.linear(w_WB.cross_matrix(), arm);
            tape.integrate(rate, arm);
            let acceleration = tape.linear(w_WB.cross_matrix(), rate);
            gaps[pin].push((-1.0, acceleration));
            self.circling.push(Circling { hook, arm });
        }
        self.pinned_from = tape.operations();
        let forces: Vec<Id> = gaps.iter().map(|_| tape.series()).collect();
        for (end, (r, _)) in solver.ends().zip(&arms) {
            let (force, drive) = (forces[end.pin], &mut drives[end.member]);
            drive.acceleration.push((end.sign / island.body(end.member, model).mass_kg, force));
            let force_P = tape.rotated_back(self.bodies[end.member].q, force);
            let torque = tape.cross(*r, force_P);
            drive.torque.push((end.sign, torque));
        }
        let accelerations: Vec<[Id; 2]> = drives.iter_mut().map(|drive| drive.accelerations(tape)).collect();
        for (end, (r, centripetal)) in solver.ends().zip(&arms) {
            let [acceleration, angular] = accelerations[end.member];
            let tangential = tape.cross(angular, *r);
            let of_arm = tape.sum(vec![(1.0, tangential), (1.0, *centripetal)]);
            let of_arm_W = tape.rotated(self.bodies[end.member].q, of_arm);
            gaps[end.pin].extend([(end.sign, acceleration), (end.sign, of_arm_W)]);
        }
        self.pins = forces.into_iter().zip(gaps).map(|(force, gap)| (force, tape.sum(gap))).collect();
    }

    /// Starts at the island's states.
    pub fn start(&mut self, island: &Chain) {
        for (moving, at) in self.bodies.iter_mut().zip(&island.at) {
            moving.start(at, &mut self.tape);
        }
    }

    /// Starts anew at the end of `h` of the present expansion, from its own numbers, not from the island's: in world
    /// axes a small part of ω would be rounded like the whole.
    pub fn go_on(&mut self, order: usize, h: f64) {
        for moving in &self.bodies {
            moving.go_on(&mut self.tape, order, h);
        }
    }

    /// Works out all coefficients up to `order`, from the start, at `t_s`.
    pub fn expand(&mut self, island: &mut Chain, model: &Model, t_s: f64, order: usize, work: &mut Work) {
        work.gyroscopic += (self.bodies.iter().filter(|moving| moving.gyroscopic).count() * order) as u64;
        let (all, from) = (self.tape.operations(), self.pinned_from);
        let Some(solver) = island.gathered_pins(model) else {
            for k in 0..order {
                self.tape.evaluate(0..all, k, t_s);
                self.tape.advance(k);
            }
            return;
        };
        for Circling { hook, arm } in &self.circling {
            self.tape.set(*arm, 0, &solver.arm(*hook, t_s));
        }
        for k in 0..order {
            self.tape.evaluate(0..from, k, t_s);
            self.pins.iter().for_each(|(force, _)| self.tape.set(*force, k, &Vector3::zeros()));
            self.tape.evaluate(from..all, k, t_s);
            self.solve(solver, k, work);
            self.tape.evaluate(from..all, k, t_s);
            self.tape.advance(k);
        }
    }

    fn solve(&mut self, solver: &mut PinSolver, k: usize, work: &mut Work) {
        for (pin, (_, gap)) in self.pins.iter().enumerate() {
            solver.ask(pin, &-self.tape.coefficient(*gap, k));
        }
        solver.solve(work);
        for (pin, (force, _)) in self.pins.iter().enumerate() {
            self.tape.set(*force, k, &solver.answer(pin));
        }
    }

    /// Puts the states `h` after the expansion into the island.
    pub fn write(&self, order: usize, h: f64, island: &mut Chain) {
        for (moving, at) in self.bodies.iter().zip(&mut island.at) {
            *at = moving.at(&self.tape, order, h);
        }
    }

    /// Size of coefficient k against the motion's own: of the worst body and quantity.
    pub fn relative_size(&self, k: usize) -> f64 {
        let sizes = self.bodies.iter().flat_map(|b| [b.p, b.v, b.w, b.q]);
        sizes.map(|id| self.tape.size(id, k) / (1.0 + self.tape.size(id, 0))).fold(0.0, f64::max)
    }
}

impl Moving {
    fn new(body: &Body, gravity: Option<Vector3<f64>>, tape: &mut Tape) -> Self {
        let diagonal = Matrix3::from_diagonal(&body.I_B.diagonal());
        let axes = if body.I_B == diagonal { Matrix3::identity() } else { principal(&body.I_B) };
        let q_BP = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        let [p, v, w, q] = [(); 4].map(|()| tape.series());
        let I = axes.tr_mul(&(body.I_B * axes)).diagonal();
        Moving { p, v, w, q, q_BP, gyroscopic: !body.spins_steadily, I, gravity, invariants: None }
    }

    fn start(&mut self, at: &BodyState, tape: &mut Tape) {
        let q_WP = at.q_WB * self.q_BP;
        let w_P = q_WP.inverse_transform_vector(&at.w_WB);
        if self.gravity.is_some() && self.gyroscopic {
            self.invariants = Some(Invariants::new(&self.I, &w_P, &q_WP));
        }
        self.place(&at.p_WB, &at.v_WB, tape);
        tape.set(self.w, 0, &w_P);
        tape.set_four(self.q, 0, &q_WP.coords);
    }

    fn go_on(&self, tape: &mut Tape, order: usize, h: f64) {
        let (p_WB, v_WB) = self.moved(tape, order, h);
        self.place(&p_WB, &v_WB, tape);
        let (w_P, q_WP) = self.turned(tape, order, h);
        tape.set(self.w, 0, &w_P);
        tape.set_four(self.q, 0, &q_WP.coords);
    }

    fn at(&self, tape: &Tape, order: usize, h: f64) -> BodyState {
        let ((p_WB, v_WB), (w_P, q_WP)) = (self.moved(tape, order, h), self.turned(tape, order, h));
        BodyState { p_WB, q_WB: q_WP * self.q_BP.inverse(), v_WB, w_WB: to_world(&q_WP, &w_P) }
    }

    /// Position and velocity at the start; of a free body with all of its parabola.
    fn place(&self, p_WB: &Vector3<f64>, v_WB: &Vector3<f64>, tape: &mut Tape) {
        tape.set(self.p, 0, p_WB);
        tape.set(self.v, 0, v_WB);
        if let Some(gravity) = self.gravity {
            tape.set(self.p, 1, v_WB);
            tape.set(self.p, 2, &(gravity / 2.0));
            tape.set(self.v, 1, &gravity);
        }
    }

    fn moved(&self, tape: &Tape, order: usize, h: f64) -> (Vector3<f64>, Vector3<f64>) {
        let order = if self.gravity.is_some() { 2 } else { order };
        (tape.sum_at(self.p, order, h).xyz(), tape.sum_at(self.v, order, h).xyz())
    }

    /// Whether the body turns about one axis for ever.
    fn turns_evenly(&self) -> bool {
        self.gravity.is_some() && !self.gyroscopic
    }

    /// ω in principal axes, and their attitude.
    fn turned(&self, tape: &Tape, order: usize, h: f64) -> (Vector3<f64>, UnitQuaternion<f64>) {
        if self.turns_evenly() {
            let w_P = tape.coefficient(self.w, 0);
            let q_WP = UnitQuaternion::new_unchecked(Quaternion::from(tape.sum_at(self.q, 0, h)));
            return (w_P, q_WP * exponential(&(w_P * h)));
        }
        let mut w_P = tape.sum_at(self.w, order, h).xyz();
        let mut q_WP = UnitQuaternion::new_normalize(Quaternion::from(tape.sum_at(self.q, order, h)));
        if let Some(invariants) = &self.invariants {
            invariants.restore(&mut w_P, &mut q_WP);
        }
        (w_P, q_WP)
    }
}

/// Axes as columns, a right-handed set.
fn principal(I_B: &Matrix3<f64>) -> Matrix3<f64> {
    let mut axes = SymmetricEigen::new(*I_B).eigenvectors;
    if axes.determinant() < 0.0 {
        axes.column_mut(2).neg_mut();
    }
    axes
}

/// Accelerations of a body's velocities, as sums of series: world axes, and principal axes about the centre of mass.
struct Driven {
    acceleration: Vec<(f64, Id)>,
    torque: Vec<(f64, Id)>,
    inverse: Matrix3<f64>,
    spin: Option<Id>,
    closed: Option<[Id; 2]>,
}

impl Driven {
    fn new(moving: &Moving, body: &Body, index: usize, model: &Model, tape: &mut Tape) -> Self {
        let I = &moving.I;
        let ratios = Vector3::new((I.y - I.z) / I.x, (I.z - I.x) / I.y, (I.x - I.y) / I.z);
        let gravity = tape.constant(model.gravity_m_s2);
        let mut drive = Driven {
            acceleration: vec![(1.0, gravity)],
            torque: Vec::new(),
            inverse: Matrix3::from_diagonal(&I.map(|x| 1.0 / x)),
            spin: moving.gyroscopic.then(|| tape.spin(moving.w, ratios)),
            closed: None,
        };
        if body.drag.linear_n_s_m != 0.0 {
            drive.acceleration.push((-body.drag.linear_n_s_m / body.mass_kg, moving.v));
        }
        for applied in model.forces.iter().filter(|applied| applied.body == index) {
            drive.load(applied, moving, body.mass_kg, tape);
        }
        drive
    }

    fn load(&mut self, applied: &AppliedForce, moving: &Moving, mass_kg: f64, tape: &mut Tape) {
        let in_world = applied.frame == Frame::World;
        let mut course = |vector: Vector3<f64>| {
            if vector == Vector3::zeros() {
                return None;
            }
            let own = if in_world { vector } else { moving.q_BP.inverse_transform_vector(&vector) };
            Some(match applied.cosine {
                None => tape.constant(own),
                Some((rate, phase)) => tape.cosine(own, rate, phase),
            })
        };
        let (force, torque) = (course(applied.force_n), course(applied.torque_n_m));
        let r_P = moving.q_BP.inverse_transform_vector(&applied.r_B);
        if let Some(force) = force {
            let force_W = if in_world { force } else { tape.rotated(moving.q, force) };
            self.acceleration.push((1.0 / mass_kg, force_W));
            if r_P != Vector3::zeros() {
                let force_P = if in_world { tape.rotated_back(moving.q, force) } else { force };
                let r = tape.constant(r_P);
                self.torque.push((1.0, tape.cross(r, force_P)));
            }
        }
        if let Some(torque) = torque {
            let torque_P = if in_world { tape.rotated_back(moving.q, torque) } else { torque };
            self.torque.push((1.0, torque_P));
        }
    }

    /// Acceleration of the centre of mass, and the angular one.
    fn accelerations(&mut self, tape: &mut Tape) -> [Id; 2] {
        let acceleration = tape.sum(std::mem::take(&mut self.acceleration));
        let mut turning: Vec<(f64, Id)> = self.spin.iter().map(|spin| (1.0, *spin)).collect();
        if !self.torque.is_empty() {
            let torque = tape.sum(std::mem::take(&mut self.torque));
            turning.push((1.0, tape.linear(self.inverse, torque)));
        }
        let angular = if turning.is_empty() { tape.series() } else { tape.sum(turning) };
        *self.closed.insert([acceleration, angular])
    }

    /// The integrals.
    fn close(mut self, moving: &Moving, tape: &mut Tape) {
        let [acceleration, angular] = self.closed.unwrap_or_else(|| self.accelerations(tape));
        if moving.gravity.is_none() {
            tape.integrate(moving.v, moving.p);
            tape.integrate(acceleration, moving.v);
        }
        if !moving.turns_evenly() {
            tape.integrate(angular, moving.w);
            let turning = tape.turning(moving.q, moving.w);
            tape.integrate(turning, moving.q);
        }
    }
}
