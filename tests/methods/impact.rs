//! Laws of impact against closed forms.

use super::assemblies::{Assembly, Gathered, Spread, Stone, sweeps};
use gotai::deadline::Deadline;
use gotai::solve::gauss_seidel::Scratch;
use gotai::solve::impact::{Law, darboux_keller, resolve};
use gotai::solve::problem::ContactProblem;
use gotai::solve::{Impulse, newton};
use gotai::work::Work;
use nalgebra::{Matrix3, Vector3};

/// The exact solver for plastic contacts.
pub fn plastic(problem: &ContactProblem, p: &mut [Impulse]) -> bool {
    newton::solve(problem, &sweeps(50, 1e-10, true), p, &mut Scratch::with_capacity(0, 0), &mut Work::default())
}

/// Whether the law came to its own end, and the impulses.
fn impact(law: Law, at: &Gathered, restitution: f64) -> (bool, Vec<Impulse>) {
    let mut p = Vec::new();
    let own = resolve(
        law,
        &at.problem,
        &vec![restitution; at.problem.blocks.len()],
        &mut plastic,
        Deadline::default(),
        &mut p,
    );
    (own, p)
}

fn is_near(found: &[f64], wanted: &[f64], bound: f64) {
    let apart = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(found.len() == wanted.len() && apart <= bound, "{found:?}, not {wanted:?}: {apart:e}");
}

/// What moves in one plane: normal, tangent.
fn planar(normal: f64, coupling: f64, tangent: f64) -> Matrix3<f64> {
    Matrix3::new(normal, coupling, 0.0, coupling, tangent, 0.0, 0.0, 0.0, 1.0)
}

/// A of a rod of length 1 and mass 1 at 45°, and its tip's velocity.
fn rod() -> (Matrix3<f64>, Vector3<f64>) {
    (planar(2.5, 1.5, 2.5), Vector3::new(-1.0, -0.6, 0.0))
}

/// The same rod as a body (only its inertia about z matters); tangent 1 of the floor is x.
fn rod_on_floor(friction: f64) -> Gathered {
    let mut all = Assembly::new(friction);
    let half = 0.125_f64.sqrt();
    let mut rod = Stone::new(1.0, [0.5_f64.sqrt(); 3], [-half, half, 0.0]);
    rod.v = Vector3::new(-0.6, -1.0, 0.0);
    all.stones.push(rod);
    all.touch(0, None, Vector3::zeros(), Vector3::y());
    all.struck()
}

/// Of the frame's tangents, that along x.
fn along_x(at: &Gathered, p: &Impulse) -> f64 {
    at.problem.blocks[0].in_world(p).x
}

fn energy_ratio(at: &Gathered, p: &[Impulse]) -> f64 {
    let before = at.assembly.stones.iter().map(|stone| stone.mass * stone.v.norm_squared() / 2.0).sum::<f64>();
    1.0 + at.energy(p) / before
}

#[test]
fn newtons_law_gains_energy_where_a_rod_sticks_and_the_other_laws_do_not() {
    let mut at = rod_on_floor(0.5);
    let mut newtons = at.problem.clone();
    newtons.blocks[0].b.x -= 0.9;
    let mut p = [Impulse::zeros()];
    assert!(plastic(&newtons, &mut p));
    // measured: 1.7e-16 and 2.2e-16
    is_near(&[p[0].x, along_x(&at, &p[0])], &[0.9625, -0.3375], 1e-13);
    is_near(&[energy_ratio(&at, &p)], &[1.078125], 1e-13);
    // By hand: compression ends stuck at (0.4, 0), the expansion slips. Measured: 2.2e-16.
    let (own, p) = impact(Law::Poisson, &at, 0.9);
    assert!(own);
    is_near(&[p[0].x, along_x(&at, &p[0])], &[0.76, -0.18], 1e-13);
    assert!(energy_ratio(&at, &p) < 1.0);
    let (own, p) = impact(Law::Sequential, &at, 0.9);
    assert!(own);
    assert!(energy_ratio(&at, &p) < 1.0);
    // At e = 1 with friction that holds.
    at.problem.blocks[0].friction = 10.0;
    for law in [Law::Poisson, Law::Sequential] {
        assert!(energy_ratio(&at, &impact(law, &at, 1.0).1) <= 1.0 + 1e-14, "{law:?}");
    }
}

#[test]
fn a_planar_slip_that_reverses_or_sticks_is_exact() {
    let (A, v) = rod();
    // Slip −0.6 ends at p_n = 0.6/(1.5 + 2.5 μ), then f = −0.5 (it would need −0.6), or −0.6.
    for (friction, then) in [(0.5_f64, -0.5), (0.7, -0.6)] {
        let ends = 0.6 / (1.5 + 2.5 * friction);
        let (first, second) = (2.5 + 1.5 * friction, 2.5 + 1.5 * then);
        let u_n = -1.0 + first * ends;
        let compression = (1.0 - u_n * u_n) / (2.0 * first) + u_n * u_n / (2.0 * second);
        let normal = ends - u_n / second + (2.0_f64 * 0.81 * compression / second).sqrt();
        let p = darboux_keller::impulse(&A, &v, friction, 0.9);
        // measured: 6.4e-16
        is_near(p.as_slice(), &[normal, friction * ends + then * (normal - ends), 0.0], 1e-15);
        let slip = (v + A * p).y;
        // measured where it sticks: 1.1e-15
        assert!(if friction == 0.5 { slip > 0.1 } else { slip.abs() < 1e-14 }, "{slip}");
    }
}

#[test]
fn a_slip_that_ends_in_restitution_is_exact() {
    // Central: W_compression = 1/2A_nn, so p_n = (1 + e)/A_nn whatever the slip does.
    let p = darboux_keller::impulse(&planar(1.0, 0.0, 3.5), &Vector3::new(-1.0, 2.0, 0.0), 0.4, 0.5);
    // measured: 0.0
    is_near(p.as_slice(), &[1.5, -2.0 / 3.5, 0.0], 1e-15);
}

#[test]
fn a_slip_that_jams_compresses_on_until_it_ends() {
    // A_nn − 1.5 μ < 0: the slip pulls the contact on into the floor.
    let (A, v) = (planar(2.5, 1.5, 2.5), Vector3::new(-1.0, 2.0, 0.0));
    let friction = 2.0_f64;
    let ends = 2.0 / (2.5 * friction - 1.5);
    let (first, second) = (2.5 - 1.5 * friction, 2.5 - 1.5 * 0.6);
    let u_n = -1.0 + first * ends;
    let compression = (1.0 - u_n * u_n) / (2.0 * first) + u_n * u_n / (2.0 * second);
    let normal = ends - u_n / second + (2.0_f64 * 0.25 * compression / second).sqrt();
    let p = darboux_keller::impulse(&A, &v, friction, 0.5);
    // measured: 1.8e-15
    is_near(p.as_slice(), &[normal, -friction * ends - 0.6 * (normal - ends), 0.0], 1e-14);
}

#[test]
fn a_sphere_sticks_up_to_seven_halves_of_the_friction_impulse() {
    let (v_n, friction, restitution) = (2.0, 0.3, 0.6);
    let most = 3.5 * friction * (1.0 + restitution) * v_n;
    let (sin, cos) = 0.7_f64.sin_cos();
    for (slip, left) in [(0.0, 0.0), (most * 0.5, 0.0), (most * (1.0 - 1e-9), 0.0), (most * 1.25, most * 0.25)] {
        let mut all = Assembly::new(friction);
        // Of mass 2 and radius 1: I = 2/5 m r².
        let mut ball = Stone::new(2.0, [2.4_f64.sqrt(); 3], [0.0, 1.0, 0.0]);
        ball.v = Vector3::new(slip * cos, -v_n, slip * sin);
        all.stones.push(ball);
        all.touch(0, None, Vector3::zeros(), Vector3::y());
        let at = all.struck();
        for law in [Law::Poisson, Law::Sequential] {
            let (own, p) = impact(law, &at, restitution);
            let after = at.problem.blocks[0].in_world(&(at.problem.blocks[0].b + at.problem.blocks[0].A * p[0]));
            assert!(own);
            // measured: 1.8e-15
            is_near(after.as_slice(), &[left * cos, restitution * v_n, left * sin], 1e-14);
        }
    }
}

/// Equal balls in a row along x, the first coming.
fn chain(balls: usize) -> Gathered {
    let mut all = Assembly::new(0.0);
    for i in 0..balls {
        all.stones.push(Stone::new(1.0, [1.0; 3], [i as f64, 0.0, 0.0]));
    }
    all.stones[0].v = Vector3::x();
    for i in 1..balls {
        all.touch(i, Some(i - 1), Vector3::x() * (i as f64 - 0.5), Vector3::x());
    }
    all.struck()
}

fn speeds(at: &Gathered, p: &[Impulse]) -> Vec<f64> {
    at.after(p).iter().map(|at| at.v.x).collect()
}

#[test]
fn a_chain_tells_the_laws_apart() {
    let three = chain(3);
    let simultaneous = [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
    let (own, p) = impact(Law::Poisson, &three, 1.0);
    assert!(own);
    // measured: 5.6e-17
    is_near(&speeds(&three, &p), &simultaneous, 1e-14);
    let mut newtons = three.problem.clone();
    newtons.blocks.iter_mut().for_each(|block| block.b.x *= 2.0);
    let mut p = vec![Impulse::zeros(); 2];
    plastic(&newtons, &mut p);
    is_near(&speeds(&three, &p), &simultaneous, 1e-14);
    for balls in [3, 5] {
        let at = chain(balls);
        let (own, p) = impact(Law::Sequential, &at, 1.0);
        assert!(own);
        let wanted: Vec<f64> = (0..balls).map(|i| if i + 1 == balls { 1.0 } else { 0.0 }).collect();
        // measured: 0.0
        is_near(&speeds(&at, &p), &wanted, 1e-15);
    }
}

#[test]
fn what_a_sequence_without_end_leaves_is_settled() {
    // Two balls closing on one of a tenth of their mass.
    let mut all = Assembly::new(0.0);
    for (i, (mass, v)) in [(10.0, 1.0), (1.0, 0.0), (10.0, -1.0)].into_iter().enumerate() {
        all.stones.push(Stone::new(mass, [1.0; 3], [i as f64, 0.0, 0.0]));
        all.stones[i].v = Vector3::x() * v;
    }
    all.touch(1, Some(0), Vector3::x() * 0.5, Vector3::x());
    all.touch(2, Some(1), Vector3::x() * 1.5, Vector3::x());
    let at = all.struck();
    for (restitution, ends) in [(1.0, true), (0.9, true), (0.05, false), (0.0, false)] {
        let (own, p) = impact(Law::Sequential, &at, restitution);
        assert_eq!(own, ends, "{restitution}");
        let v = speeds(&at, &p);
        assert!(v[1] - v[0] > -1e-11 && v[2] - v[1] > -1e-11, "{restitution}: {v:?}");
        assert!(at.energy(&p) <= 0.0);
    }
}

#[test]
fn symmetric_scenes_get_symmetric_impulses_from_poisson() {
    for (friction, turn) in [(0.0, 0.0), (0.3, 0.0), (0.3, 2.0), (1.5, 2.0)] {
        // A slab flat on four corners, turning about the normal or not.
        let mut all = Assembly::new(friction);
        let mut slab = Stone::new(2.0, [2.0, 0.5, 2.0], [0.0, 0.25, 0.0]);
        (slab.v, slab.w) = (Vector3::y() * -3.0, Vector3::y() * turn);
        all.stones.push(slab);
        for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            all.touch(0, None, Vector3::new(x, 0.0, z), Vector3::y());
        }
        let at = all.struck();
        let (own, p) = impact(Law::Poisson, &at, 0.5);
        let normals: Vec<f64> = p.iter().map(|p| p.x).collect();
        let tangents: Vec<f64> = p.iter().map(|p| p.yz().norm()).collect();
        assert!(own);
        // measured: 8.9e-16
        is_near(&normals, &[2.0 * 3.0 * 1.5 / 4.0; 4], 1e-13);
        is_near(&tangents, &[tangents[0]; 4], 1e-13);
        assert_eq!(tangents[0] > 0.1, friction * turn > 0.0);
    }
}

/// Euler's method in small steps of normal impulse, until its work has come back.
fn crude(A: &Matrix3<f64>, v: &Vector3<f64>, friction: f64, restitution: f64) -> Impulse {
    const STEP: f64 = 1e-6;
    let (mut p, mut taken) = (Impulse::zeros(), 0.0);
    loop {
        let u = v + A * p;
        let slip = Vector3::new(0.0, u.y, u.z);
        let along = Vector3::new(1.0, 0.0, 0.0) - slip * (friction / slip.norm());
        taken -= u.x * STEP * if u.x < 0.0 { restitution * restitution } else { 1.0 };
        if u.x >= 0.0 && taken <= 0.0 {
            return p;
        }
        p += along * STEP;
    }
}

#[test]
fn a_slip_that_turns_agrees_with_many_small_steps() {
    let mut spread = Spread(3);
    let mut worst = 0.0_f64;
    for case in 0..20 {
        let J = Matrix3::from_fn(|_, _| spread.next());
        let A = J * J.transpose() + Matrix3::identity() * 0.5;
        let v = Vector3::new(-1.0, spread.next(), spread.next()) * 0.5;
        let (friction, restitution) = (0.1 + 0.1 * f64::from(case % 10), 0.7);
        let exact = darboux_keller::impulse(&A, &v, friction, restitution);
        let apart = (exact - crude(&A, &v, friction, restitution)).norm() / exact.norm();
        worst = worst.max(apart);
    }
    // measured: 1.3e-6, the small steps' own error
    assert!(worst < 1e-5, "{worst:e}");
}

/// With A_tt = τ and A_tn = (a, 0), ds/dφ = −s cot φ + (μ τ/a) s/sin φ: s sin φ tan(φ/2)^(−μτ/a) stays what it is.
#[test]
fn a_slip_that_turns_stays_on_its_hodograph() {
    let (tau, a, friction) = (2.0, 0.8, 0.5);
    let A = Matrix3::new(1.5, a, 0.0, a, tau, 0.0, 0.0, 0.0, tau);
    let on = |u: &Vector3<f64>| {
        let (s, angle) = (u.y.hypot(u.z), u.z.atan2(u.y));
        s * angle.sin() * (angle / 2.0).tan().powf(-friction * tau / a)
    };
    let mut worst = 0.0_f64;
    for degrees in [1.0_f64, 30.0, 90.0, 150.0, 179.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let v = Vector3::new(-1.0, 3.0 * cos, 3.0 * sin);
        let after = v + A * darboux_keller::impulse(&A, &v, friction, 0.8);
        assert!(after.x > 0.5 && after.z.atan2(after.y) < degrees.to_radians(), "{degrees}: {after:?}");
        worst = worst.max((on(&after) / on(&v) - 1.0).abs());
    }
    // measured: 4.4e-15
    assert!(worst < 1e-13, "{worst:e}");
}
