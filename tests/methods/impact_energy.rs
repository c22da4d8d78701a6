//! No law of impact gains energy, whatever bodies, contacts, friction and restitution.

use super::assemblies::{Spread, sweeps};
use super::impact::plastic;
use crate::yaml::experiment;
use gotai::collide::Contact;
use gotai::collide::approach::Approach;
use gotai::deadline::Deadline;
use gotai::model::Model;
use gotai::solve::Impulse;
use gotai::solve::gauss_seidel::{self, Scratch};
use gotai::solve::impact::{Law, Plastic, darboux_keller, resolve};
use gotai::solve::problem::ContactProblem;
use gotai::solve::twist::Twist;
use gotai::state::State;
use gotai::work::Work;
use nalgebra::{Matrix3, Vector3};
use std::fmt::Write;

const BODIES: usize = 4;
const MODELS: usize = 50;
const IMPACTS_PER_MODEL: usize = 220;

fn unit(spread: &mut Spread) -> f64 {
    (spread.next() + 1.0) / 2.0
}

/// Bodies of random boxes' inertia, masses 1 : 100.
fn bodies(spread: &mut Spread) -> (Model, State) {
    let mut text = "scene:\n  bodies:\n".to_string();
    for i in 0..BODIES {
        let [x, y, z] = [(); 3].map(|()| (0.1 + unit(spread)).powi(2));
        let mass = 10.0_f64.powf(spread.next());
        let inertia = [y + z, x + z, x + y].map(|sum| sum * mass / 12.0);
        writeln!(text, "    - {{ name: b{i}, shape: none, mass_kg: {mass:e}, inertia_kg_m2: {inertia:?} }}").unwrap();
    }
    writeln!(text, "time: {{ step_s: 0.01, end_s: 0.01 }}").unwrap();
    gotai::scene::build(&experiment(&text, &[])).unwrap()
}

fn contact(spread: &mut Spread, number: u32, friction: f64) -> Contact {
    let pick = |spread: &mut Spread| (unit(spread) * BODIES as f64) as usize;
    let (a, b) = (pick(spread), pick(spread));
    Contact {
        body: a.min(b),
        other: (a != b).then_some(a.max(b)),
        feature: (0, number),
        r_BC_W: spread.vector() * 0.5,
        r_OC_W: spread.vector() * 0.5,
        p_WC: Vector3::zeros(),
        normal: spread.vector().normalize(),
        gap_m: 0.0,
        friction,
        restitution: 0.0,
        tangential_restitution: 0.0,
    }
}

/// One random impact.
struct Drawn {
    problem: ContactProblem,
    before: Vec<Twist>,
    restitution: Vec<f64>,
}

fn draw(spread: &mut Spread, model: &Model, state: &State, number: usize) -> Drawn {
    let before: Vec<Twist> = (0..BODIES).map(|_| Twist { v: spread.vector(), w: spread.vector() }).collect();
    // μ from 0 to 3, and e from 0 to 1, the ends included; one for all contacts or not.
    let contacts: Vec<Contact> =
        (0..1 + number as u32 % 6).map(|i| contact(&mut *spread, i, [0.0, 0.3, 1.0, 3.0][number / 6 % 4])).collect();
    let e = [0.0, 0.5, 0.9, 1.0, -1.0][number / 24 % 5];
    let restitution = contacts.iter().map(|_| if e < 0.0 { unit(spread) } else { e }).collect();
    let mut problem = ContactProblem::default();
    problem.gather(model, state, &before, &mut contacts.to_vec(), (Approach::Inside, 0.01));
    Drawn { problem, before, restitution }
}

fn kinetic_energy(model: &Model, state: &State, twists: &[Twist]) -> f64 {
    let of = |((body, at), twist): ((&gotai::model::Body, &gotai::state::BodyState), &Twist)| {
        (body.mass_kg * twist.v.norm_squared() + twist.w.dot(&(body.I_W(at) * twist.w))) / 2.0
    };
    model.bodies.iter().zip(&state.bodies).zip(twists).map(of).sum()
}

#[derive(Debug, Default)]
struct Found {
    impacts: usize,
    own_end: usize,
    most_gained: f64,
    /// Of the fastest contact velocity.
    worst_approach: f64,
    /// By which |p_t| ≤ μ p_n is missed, of |p|.
    outside_cone: f64,
}

fn try_all(law: Law, solver: &mut Plastic) -> Found {
    let (mut spread, mut found) = (Spread(11), Found { most_gained: -1.0, ..Found::default() });
    for _ in 0..MODELS {
        let (model, state) = bodies(&mut spread);
        for number in 0..IMPACTS_PER_MODEL {
            let Drawn { problem, before, restitution } = draw(&mut spread, &model, &state, number);
            let (mut p, mut u) = (Vec::new(), Vec::new());
            let own = resolve(law, &problem, &restitution, solver, Deadline::default(), &mut p);
            problem.response(&p, &mut u);
            let after: Vec<Twist> = before.iter().zip(&u).map(|(a, b)| Twist { v: a.v + b.v, w: a.w + b.w }).collect();
            let energy = kinetic_energy(&model, &state, &before);
            let gained = kinetic_energy(&model, &state, &after) / energy - 1.0;
            let fastest = problem.blocks.iter().map(|block| block.b.norm()).fold(0.0, f64::max);
            let slowest = problem.after(&u).blocks.iter().map(|block| block.b.x).fold(0.0, f64::min);
            for (block, p) in problem.blocks.iter().zip(&p) {
                let outside = p.yz().norm() - block.friction * p.x;
                found.outside_cone = found.outside_cone.max(if outside > 0.0 { outside / p.norm() } else { 0.0 });
            }
            found.impacts += 1;
            found.own_end += usize::from(own);
            found.most_gained = found.most_gained.max(gained);
            if own {
                found.worst_approach = found.worst_approach.max(-slowest / fastest);
            }
        }
    }
    found
}

fn obeys(found: &Found) {
    assert!(found.impacts > 10_000);
    // measured: 4.4e-16
    assert!(found.most_gained <= 1e-14, "{found:?}");
    // measured: 3.7e-12
    assert!(found.worst_approach <= 1e-11, "{found:?}");
    // measured: 4.2e-16
    assert!(found.outside_cone <= 1e-14, "{found:?}");
}

#[test]
fn poisson_never_gains_energy() {
    let found = try_all(Law::Poisson, &mut plastic);
    obeys(&found);
    // measured: 10842 of 11000
    assert!(found.own_end > 10_700, "{found:?}");
}

#[test]
fn a_sequence_never_gains_energy() {
    let found = try_all(Law::Sequential, &mut plastic);
    obeys(&found);
    // measured: 10931 of 11000
    assert!(found.own_end > 10_800, "{found:?}");
}

#[test]
fn a_solver_that_has_not_settled_gains_nothing_either() {
    for (law, most) in [(Law::Poisson, 1), (Law::Poisson, 5), (Law::Sequential, 1)] {
        let mut hasty = |problem: &ContactProblem, p: &mut [Impulse]| {
            let sweeps = sweeps(most, 1e-10, true);
            gauss_seidel::iterate(problem, &sweeps, p, &mut Scratch::with_capacity(0, 0), &mut Work::default())
        };
        let found = try_all(law, &mut hasty);
        obeys(&found);
    }
}

#[test]
fn one_contact_never_gains_energy() {
    let (mut spread, mut gained, mut approach, mut outside) = (Spread(5), -1.0_f64, 0.0_f64, 0.0_f64);
    for number in 0..20_000 {
        let J = Matrix3::from_fn(|_, _| spread.next());
        let A = J * J.transpose() + Matrix3::identity() * 10.0_f64.powi(-(number % 5));
        let v = spread.vector();
        let friction = [0.1, 0.5, 1.0, 3.0][number as usize % 4];
        let restitution = [0.0, 0.5, 1.0][number as usize % 3];
        let p = darboux_keller::impulse(&A, &v, friction, restitution);
        let after = v + A * p;
        let before = v.dot(&(A.cholesky().unwrap().solve(&v)));
        gained = gained.max(p.dot(&(v + after)) / before);
        approach = approach.max(-after.x / v.norm());
        outside = outside.max(p.yz().norm() - friction * p.x);
    }
    // measured: 0.0 (where nothing touches), 8.4e-14, 0.0
    assert!(gained <= 1e-14 && approach <= 1e-12 && outside <= 1e-13);
}
