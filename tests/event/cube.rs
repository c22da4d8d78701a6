//! The lecture's cube in its box: it touches with its corners.

use super::{apart_m, impacts};
use crate::methods::order;
use crate::yaml::{experiment, run};
use gotai::outcome::Outcome;
use rayon::prelude::*;

const CUBE: &str = "
scene:
  friction: 0.3
  restitution: 0.5
  container: { box: { size_m: [4, 4, 4] } }
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 2 }
      mass_kg: 1.0
      position_m: [0, 2, 0]
  random: { speed_m_s: 4, spin_rad_s: 6, attitude: true }
method: { event-driven: { tolerance: 1e-9 } }
time: { end_s: 1.5 }
";

fn sets(e: f64, mu: f64, seed: u64) -> [String; 3] {
    [format!("scene.restitution={e}"), format!("scene.friction={mu}"), format!("seed={seed}")]
}

/// Every restitution and friction with some seeds.
fn throws() -> Vec<(f64, f64, u64)> {
    let mut throws = Vec::new();
    for e in [0.0, 0.5, 0.9] {
        for mu in [0.0, 0.3] {
            throws.extend([1, 3, 4, 5].map(|seed| (e, mu, seed)));
        }
    }
    throws
}

#[test]
fn its_end_is_right_to_the_tolerance() {
    let apart: Vec<f64> = throws()
        .into_par_iter()
        .map(|(e, mu, seed)| {
            let sets = sets(e, mu, seed);
            let [a, b, c] = sets.each_ref().map(String::as_str);
            let rough = run(&experiment(CUBE, &[a, b, c, "measure=[sensitivity]"]));
            let fine = run(&experiment(CUBE, &[a, b, c, "method.event-driven.tolerance=1e-11"]));
            assert_eq!([rough.measured.outcome, fine.measured.outcome], [Outcome::Finished; 2]);
            apart_m(&rough.state, &fine.state) / rough.measured.sensitivity.unwrap().max(1.0)
        })
        .collect();
    // One of the throws hits a wall flush while it slides on four corners: six contacts with friction, whose shares no
    // law of impact tells. Measured: 9.4e-7, the others 2.1e-12.
    let worst = apart.iter().copied().fold(0.0, f64::max);
    assert!(worst < 1e-5 && apart.iter().filter(|apart_m| **apart_m > 1e-10).count() <= 1, "{apart:?}");
}

#[test]
fn its_impacts_are_right_to_the_tolerance() {
    let apart = throws().into_par_iter().map(|(e, mu, seed)| {
        let sets = sets(e, mu, seed);
        let [a, b, c] = sets.each_ref().map(String::as_str);
        let rough = experiment(CUBE, &[a, b, c, "measure=[sensitivity]"]);
        let grown = run(&rough).measured.sensitivity.unwrap().max(1.0);
        let [rough, fine] =
            [rough, experiment(CUBE, &[a, b, c, "method.event-driven.tolerance=1e-11"])].map(|e| impacts(&e, 10));
        assert!(!rough.is_empty());
        let apart = rough.iter().zip(&fine).map(|(a, b)| apart_m(a, b).max((a.time_s - b.time_s).abs()));
        apart.fold(0.0, f64::max) / grown
    });
    let worst = apart.reduce(|| 0.0, f64::max);
    // measured: 5.5e-11
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn steps_converge_to_it_at_order_1() {
    let steps = [4e-3, 2e-3, 1e-3, 5e-4];
    let logs: Vec<[f64; 4]> = (0..16)
        .into_par_iter()
        .map(|seed| {
            let sets = sets(0.5, 0.3, seed);
            let [a, b, c] = sets.each_ref().map(String::as_str);
            let first = impacts(&experiment(CUBE, &[a, b, c, "time.end_s=4"]), 3);
            // Between the second impact and the third.
            let end_s = 0.5 * (first[1].time_s + first[2].time_s);
            let end = format!("time.end_s={end_s:?}");
            let wanted = run(&experiment(CUBE, &[a, b, c, &end])).state;
            let errors = steps.map(|h| {
                let step = format!("time.step_s={h}");
                let by_steps = experiment(CUBE, &[a, b, c, &end, &step, "method={time-stepping: {solver: newton}}"]);
                apart_m(&run(&by_steps).state, &wanted)
            });
            errors.map(f64::ln)
        })
        .collect();
    let means = [0, 1, 2, 3].map(|k| (logs.iter().map(|log| log[k]).sum::<f64>() / logs.len() as f64).exp());
    let order = order(&steps, &means);
    // measured: 0.95, from 17 mm to 2.3 mm
    assert!((order - 1.0).abs() < 0.15, "{order} {means:?}");
}

/// Flush with the floor it slides along a wall and rattles against it between two edges: friction brings them back, not
/// gravity, and that ends as a rocking on the floor does.
#[test]
fn a_rattling_against_a_wall_ends() {
    let sets = sets(0.0, 0.3, 159);
    let [a, b, c] = sets.each_ref().map(String::as_str);
    let ended = run(&experiment(CUBE, &[a, b, c, "method.event-driven.tolerance=1e-6"]));
    let work = &ended.measured.work;
    // Measured: 43; it was 1715, and five stretches of equal steps.
    assert!(work.events < 80, "{}", work.events);
    assert_eq!((ended.measured.outcome, work.fallbacks), (Outcome::Finished, 0));
    assert_eq!(ended.state.bodies[0].v_WB.norm(), 0.0);
    // Measured: 5.4e-10.
    assert!(ended.measured.energy_drift_rel.unwrap().abs() < 1e-8, "{:?}", ended.measured.energy_drift_rel);
}
