//! Assemblies of stones with contacts given by hand, solved for one step.

use crate::yaml::experiment;
use gotai::collide::approach::Approach;
use gotai::collide::{Contact, SolvedContact};
use gotai::deadline::Deadline;
use gotai::experiment::types::{Cone, Correction, Diverge, Iteration, Skips, Solver};
use gotai::measure::Judge;
use gotai::model::Model;
use gotai::plan::Plan;
use gotai::shown::{Acted, Shown};
use gotai::solve::Impulse;
use gotai::solve::block::Block;
use gotai::solve::gauss_seidel::{Sweeps, Variant};
use gotai::solve::pins::{Pin, PinEnd};
use gotai::solve::problem::ContactProblem;
use gotai::solve::solver::ContactSolver;
use gotai::solve::twist::Twist;
use gotai::state::State;
use gotai::work::Work;
use nalgebra::Vector3;
use std::fmt::Write;

const STEP_S: f64 = 0.01;
pub const GRAVITY: f64 = 9.8;

/// A block of uniform density.
#[derive(Clone, Copy)]
pub struct Stone {
    pub mass: f64,
    pub size: [f64; 3],
    pub at: Vector3<f64>,
    pub v: Vector3<f64>,
    pub w: Vector3<f64>,
}

impl Stone {
    pub fn new(mass: f64, size: [f64; 3], at: [f64; 3]) -> Self {
        Stone { mass, size, at: at.into(), v: Vector3::zeros(), w: Vector3::zeros() }
    }
}

#[derive(Clone, Default)]
pub struct Assembly {
    pub stones: Vec<Stone>,
    contacts: Vec<Contact>,
    pins: Vec<Pin>,
    friction: f64,
}

impl Assembly {
    pub fn new(friction: f64) -> Self {
        Assembly { friction, ..Default::default() }
    }

    /// `normal` from the other one, or the container, to the body.
    pub fn touch(&mut self, body: usize, other: Option<usize>, point: Vector3<f64>, normal: Vector3<f64>) {
        let (body, other, normal) = match other {
            Some(other) if other < body => (other, Some(body), -normal),
            _ => (body, other, normal),
        };
        let arm = |i: usize| point - self.stones[i].at;
        self.contacts.push(Contact {
            body,
            other,
            feature: (0, self.contacts.len() as u32),
            r_BC_W: arm(body),
            r_OC_W: other.map_or_else(Vector3::zeros, arm),
            p_WC: point,
            normal,
            gap_m: 0.0,
            friction: self.friction,
            restitution: 0.0,
            tangential_restitution: 0.0,
        });
    }

    /// A point of a stone that another one, or the container, holds.
    fn hold(&mut self, body: usize, other: Option<usize>, point: Vector3<f64>) {
        let end = |body: usize, sign: f64| PinEnd { body, sign, r_W: point - self.stones[body].at };
        let pin = Pin { end: end(body, 1.0), other: other.map(|i| end(i, -1.0)), velocity_W: Vector3::zeros() };
        self.pins.push(pin);
    }

    fn model(&self) -> (Model, State) {
        let mut text = format!("scene:\n  gravity_m_s2: [0, -{GRAVITY}, 0]\n  bodies:\n");
        for (i, stone) in self.stones.iter().enumerate() {
            let [x, y, z] = stone.size.map(|s| s * s * stone.mass / 12.0);
            writeln!(
                text,
                "    - {{ name: b{i}, shape: none, mass_kg: {:e}, inertia_kg_m2: {:?}, position_m: {:?}, \
                 velocity_m_s: {:?}, angular_velocity_rad_s: {:?} }}",
                stone.mass,
                [y + z, x + z, x + y],
                stone.at.as_slice(),
                stone.v.as_slice(),
                stone.w.as_slice()
            )
            .unwrap();
        }
        writeln!(text, "time: {{ step_s: {STEP_S}, end_s: {STEP_S} }}").unwrap();
        gotai::scene::build(&experiment(&text, &[])).unwrap()
    }

    pub fn gathered(self) -> Gathered {
        self.after(Vector3::y() * -GRAVITY * STEP_S)
    }

    /// At an impact: velocities just before it.
    pub fn struck(self) -> Gathered {
        self.after(Vector3::zeros())
    }

    fn after(self, fall: Vector3<f64>) -> Gathered {
        let (model, state) = self.model();
        let free: Vec<Twist> = state.bodies.iter().map(|at| Twist { v: at.v_WB + fall, w: at.w_WB }).collect();
        let mut problem = ContactProblem::default();
        problem.gather(&model, &state, &free, &mut self.contacts.clone(), (Approach::Inside, STEP_S));
        problem.pin(&model, &state, &free, &self.pins);
        Gathered { assembly: self, model, state, problem, free }
    }
}

/// An assembly at its step.
pub struct Gathered {
    pub assembly: Assembly,
    model: Model,
    state: State,
    pub problem: ContactProblem,
    free: Vec<Twist>,
}

/// What a solver says and what it did.
pub struct Solved {
    pub says: bool,
    pub p: Vec<Impulse>,
    pub work: Work,
}

/// Of projected Gauss–Seidel with discs.
pub fn sweeps(most: u32, tolerance: f64, friction: bool) -> Sweeps {
    Sweeps {
        iteration: Iteration::GaussSeidel,
        correction: Correction::PerContact,
        cone: Cone::Disc,
        most,
        tolerance,
        friction,
        variant: Variant::default(),
        deadline: Deadline::default(),
    }
}

impl Gathered {
    /// From impulses `p`.
    pub fn solve_from(&self, mut p: Vec<Impulse>, solver: Solver, most: u32, tolerance: f64) -> Solved {
        let sweeps = sweeps(most, tolerance, self.assembly.friction > 0.0);
        let (mut solver, mut work) = (ContactSolver::new(solver, 0, 0, true), Work::default());
        let says = solver.solve(&self.problem, &sweeps, (&mut p, &[]), &mut work);
        Solved { says, p, work }
    }

    pub fn solve(&self, solver: Solver, most: u32, tolerance: f64) -> Solved {
        self.solve_from(vec![Impulse::zeros(); self.problem.blocks.len()], solver, most, tolerance)
    }

    /// The judge's, who works out the motion again from impulses in world axes.
    pub fn residual(&self, p: &[Impulse]) -> f64 {
        let world = self.problem.blocks.iter().zip(p).map(|(block, p)| block.in_world(p));
        let solved: Vec<SolvedContact> = self
            .assembly
            .contacts
            .iter()
            .zip(world)
            .map(|(contact, impulse_W)| SolvedContact { contact: *contact, impulse_W })
            .collect();
        let plan = Plan {
            contact: true,
            contacts: solved.len(),
            constraint: true,
            friction: true,
            approach: Approach::Inside,
            newton: true,
            stiffness_n_m: None,
            looks: true,
            skips: Skips::default(),
            stages: Vec::new(),
        };
        let mut judge = Judge::new(&self.model, &self.state, &Diverge::default(), &plan);
        let (kicked, step_s) = (&self.state, STEP_S);
        let acted = Acted::Kick { kicked, contacts: &solved, step_s, approach: Approach::Inside };
        let shown = Shown { before: kicked, after: kicked, acted, way: None, stalled: None, is_last: true };
        judge.observe(&self.model, &shown);
        judge.residual.max.unwrap()
    }

    /// How far pinned points are from rest against each other, in m/s.
    pub fn pin_error(&self, p: &[Impulse]) -> f64 {
        let after = self.after(p);
        let speed = |end: &PinEnd| (after[end.body].v + after[end.body].w.cross(&end.r_W)) * end.sign;
        let error = |pin: &Pin| (speed(&pin.end) + pin.other.as_ref().map_or_else(Vector3::zeros, speed)).norm();
        self.assembly.pins.iter().map(error).fold(0.0, f64::max)
    }

    /// How far contacts are from Signorini's and Coulomb's law, in N s and m/s.
    pub fn law_error(&self, p: &[Impulse]) -> f64 {
        let after = self.after(p);
        let error = |(contact, (block, p)): (&Contact, (&Block, &Impulse))| {
            let point = |(i, r_W, sign): (usize, Vector3<f64>, f64)| (after[i].v + after[i].w.cross(&r_W)) * sign;
            let u_W: Vector3<f64> = contact.ends().map(point).sum();
            let u = Vector3::from_fn(|i, _| block.frame[i].dot(&u_W));
            let (slip, held) = (u.yz().norm(), p.yz().norm());
            let signorini = [-u.x, -p.x, (u.x * p.x).abs(), held - contact.friction * p.x];
            // Against the slip, and as large as can be.
            let dissipation = (p.yz() * slip + u.yz() * (contact.friction * p.x)).norm();
            signorini.into_iter().fold(dissipation, f64::max)
        };
        self.assembly.contacts.iter().zip(self.problem.blocks.iter().zip(p)).map(error).fold(0.0, f64::max)
    }

    /// Velocities of all bodies after the contacts.
    pub fn after(&self, p: &[Impulse]) -> Vec<Twist> {
        let mut response = Vec::new();
        self.problem.response(p, &mut response);
        self.free.iter().zip(&response).map(|(a, b)| Twist { v: a.v + b.v, w: a.w + b.w }).collect()
    }

    /// Kinetic energy that the impulses add.
    pub fn energy(&self, p: &[Impulse]) -> f64 {
        let mut response = Vec::new();
        self.problem.response(p, &mut response);
        self.problem.energy(p, &response)
    }
}

/// Unit cubes on each other, each shifted by so much against the one below it; four contacts on every overlap.
pub fn stack(masses: &[f64], shifts: &[f64], friction: f64) -> Assembly {
    let mut all = Assembly::new(friction);
    let (mut x, mut below) = (0.0_f64, 0.0_f64);
    for (i, mass) in masses.iter().enumerate() {
        x += shifts.get(i).copied().unwrap_or(0.0);
        below = if i == 0 { x } else { below };
        all.stones.push(Stone::new(*mass, [1.0; 3], [x, i as f64 + 0.5, 0.0]));
        for (px, pz) in [-0.5, 0.5].map(|z| [(x.max(below) - 0.5, z), (x.min(below) + 0.5, z)]).concat() {
            all.touch(i, i.checked_sub(1), Vector3::new(px, i as f64, pz), Vector3::y());
        }
        below = x;
    }
    all
}

/// The stack of the largest overhang times `part`: brick k from the top reaches out by L/2k.
pub fn overhanging(bricks: usize, part: f64, friction: f64) -> Assembly {
    let shifts: Vec<f64> = (0..bricks).map(|i| if i == 0 { 0.0 } else { 0.5 / (bricks - i) as f64 * part }).collect();
    stack(&vec![1.0; bricks], &shifts, friction)
}

/// A deterministic spread of numbers in [−1, 1).
pub struct Spread(pub u64);

impl Spread {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 * 2.0_f64.powi(-52) - 1.0
    }

    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.next())
    }
}

/// n³ stones of different masses thrown against each other and the floor, so many points where neighbours meet.
pub fn heap(n: usize, points: usize, friction: f64, seed: u64) -> Assembly {
    heap_of(n, points, friction, seed, |x| 1.0 + 0.9 * x)
}

/// The same with masses of `mass` of numbers in [−1, 1).
pub fn heap_of(n: usize, points: usize, friction: f64, seed: u64, mass: impl Fn(f64) -> f64) -> Assembly {
    let (mut spread, mut all) = (Spread(seed), Assembly::new(friction));
    let place = |i: usize| [i % n, (i / n) % n, i / (n * n)];
    for i in 0..n * n * n {
        let [x, y, z] = place(i).map(|k| k as f64);
        let mut stone = Stone::new(mass(spread.next()), [1.0; 3], [x, y + 0.5, z]);
        stone.at += spread.vector() * 0.1;
        (stone.v, stone.w) = (spread.vector(), spread.vector());
        all.stones.push(stone);
    }
    for i in 0..n * n * n {
        let [x, y, z] = place(i);
        for _ in 0..if y == 0 { points } else { 0 } {
            let (at, aside) = (all.stones[i].at, spread.vector() * 0.4);
            all.touch(i, None, Vector3::new(at.x + aside.x, 0.0, at.z + aside.z), Vector3::y());
        }
        for (has_neighbour, step) in [(x + 1 < n, 1), (y + 1 < n, n), (z + 1 < n, n * n)] {
            if !has_neighbour || spread.next() > 0.6 {
                continue;
            }
            let (a, b) = (all.stones[i].at, all.stones[i + step].at);
            let normal = ((b - a).normalize() + spread.vector() * 0.2).normalize();
            for _ in 0..points {
                let aside = spread.vector() * 0.4;
                all.touch(i + step, Some(i), (a + b) / 2.0 + aside - normal * aside.dot(&normal), normal);
            }
        }
    }
    all
}

/// Half a ring of wedge stones between two springers.
pub fn arch(stones: usize, friction: f64) -> Assembly {
    const INNER: f64 = 1.0;
    const OUTER: f64 = 1.4;
    let mut all = Assembly::new(friction);
    let direction = |k: f64| (std::f64::consts::PI * k / stones as f64).sin_cos();
    for i in 0..stones {
        let (sin, cos) = direction(i as f64 + 0.5);
        let middle = (INNER + OUTER) / 2.0;
        all.stones.push(Stone::new(1.0, [0.4, 0.4, 0.5], [middle * cos, middle * sin, 0.0]));
    }
    for k in 0..=stones {
        let (sin, cos) = direction(k as f64);
        let onward = Vector3::new(-sin, cos, 0.0);
        for (r, z) in [(INNER, -0.25), (OUTER, -0.25), (INNER, 0.25), (OUTER, 0.25)] {
            let point = Vector3::new(r * cos, r * sin, z);
            match k {
                0 => all.touch(0, None, point, onward),
                _ if k == stones => all.touch(stones - 1, None, point, -onward),
                _ => all.touch(k, Some(k - 1), point, onward),
            }
        }
    }
    all
}

/// A box that swings on its upper corner edge's middle and leans against a wall with four points of a face.
pub fn pendulum_at_a_wall(friction: f64) -> Assembly {
    let mut all = Assembly::new(friction);
    let mut stone = Stone::new(2.0, [1.0, 1.0, 1.0], [0.5, -0.5, 0.0]);
    (stone.v, stone.w) = (Vector3::new(-1.0, 0.2, 0.3), Vector3::new(0.1, 0.2, -0.4));
    all.stones.push(stone);
    all.hold(0, None, Vector3::new(0.5, 0.0, 0.0));
    for (y, z) in [(-1.0, -0.5), (-1.0, 0.5), (-0.1, -0.5), (-0.1, 0.5)] {
        all.touch(0, None, Vector3::new(0.0, y, z), Vector3::x());
    }
    all
}

/// Three boxes in a chain from a fixed point, the last of which slides on the floor.
pub fn chain_to_the_floor(friction: f64) -> Assembly {
    let mut all = Assembly::new(friction);
    for (i, mass) in [1.0, 3.0, 0.5].into_iter().enumerate() {
        let mut stone = Stone::new(mass, [1.0, 0.5, 0.5], [i as f64, 2.0 - 0.75 * i as f64, 0.0]);
        stone.v = Vector3::new(0.3, -0.5, 0.2 * i as f64);
        all.stones.push(stone);
    }
    all.hold(0, None, Vector3::new(-0.5, 2.0, 0.0));
    for i in 1..3 {
        let between = (all.stones[i - 1].at + all.stones[i].at) / 2.0;
        all.hold(i, Some(i - 1), between);
    }
    for (x, z) in [(1.5, -0.25), (1.5, 0.25), (2.5, -0.25), (2.5, 0.25)] {
        all.touch(2, None, Vector3::new(x, 0.25, z), Vector3::y());
    }
    all
}
