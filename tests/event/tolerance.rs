//! What is asked for is what comes out: bodies of six shapes thrown on a floor, against themselves at the least
//! tolerance.

use super::apart_m;
use crate::yaml::experiment;
use gotai::experiment::types::Limits;
use gotai::run::advance::only_step;
use gotai::scene::build;
use gotai::study::choose;
use gotai::study::sensitivity::sensitivity;
use rayon::prelude::*;

const SHAPES: [&str; 6] = [
    "sphere: { radius_m: 0.4 }",
    "box: { size_m: [0.8, 0.5, 0.6] }",
    "cylinder: { radius_m: 0.3, height_m: 0.5 }",
    "capsule: { radius_m: 0.2, height_m: 0.6 }",
    "ellipsoid: { semi_axes_m: [0.5, 0.3, 0.4] }",
    "convex: { vertices_m: [[-0.4, -0.3, -0.2], [0.5, -0.2, -0.3], [0, 0.5, -0.1], [0.1, -0.1, 0.5]] }",
];

fn thrown(shape: &str, friction: f64, restitution: f64, seed: u64) -> String {
    format!(
        "
scene:
  friction: {friction}
  restitution: {restitution}
  container: {{ plane: {{ normal: [0, 1, 0] }} }}
  bodies: [{{ name: body, shape: {{ {shape} }}, mass_kg: 1, position_m: [0, 0.9, 0] }}]
  random: {{ speed_m_s: 2, spin_rad_s: 4, attitude: true }}
seed: {seed}
method: event-driven
time: {{ end_s: 1.5 }}
"
    )
}

/// Whether the error is within ten times what the tolerance allows; none: a run takes too long.
fn is_good(text: &str, tolerance: f64) -> Option<bool> {
    let rough = experiment(text, &[&format!("method.event-driven.tolerance={tolerance:e}")]);
    let least = experiment(text, &["method.event-driven.tolerance=1e-12"]);
    let (model, start) = build(&rough).unwrap();
    let limits = Limits { steps: Some(20_000), ..Limits::default() };
    let [a, b] =
        [&rough, &least].map(|e| only_step(&e.method.stepping().unwrap(), &model, start.clone(), &e.clock(), &limits));
    if a.stopped.is_some() || b.stopped.is_some() {
        return None;
    }
    let error = apart_m(&a.state, &b.state) / (10.0 * tolerance);
    // A sensitivity costs three runs.
    let rough = choose::method(&rough, &model, &start);
    Some(error <= 1.0 || sensitivity(&rough, &model, &start, &a.state).is_some_and(|grown| error <= grown))
}

/// Wrong and late ones among the scenes of which `chosen`, given their place in the grid and the tolerance's, says so.
fn not_good(chosen: impl Fn(usize, usize) -> bool) -> [Vec<(String, f64)>; 2] {
    let mut scenes = Vec::new();
    for shape in SHAPES {
        for friction in [0.0, 0.1, 0.4, 0.9] {
            for restitution in [0.0, 0.3, 0.7, 1.0] {
                scenes.push((shape, friction, restitution));
            }
        }
    }
    let tolerances = [1e-4, 1e-6, 1e-9];
    let grid = (0..scenes.len()).flat_map(|i| (0..tolerances.len()).map(move |k| (i, k)));
    let scenes: Vec<_> = grid
        .filter(|(i, k)| chosen(*i, *k))
        .map(|(i, k)| (thrown(scenes[i].0, scenes[i].1, scenes[i].2, k as u64), tolerances[k]))
        .collect();
    let judged: Vec<_> = scenes.par_iter().map(|(text, tolerance)| is_good(text, *tolerance)).collect();
    let those = |verdict| {
        let both = scenes.iter().zip(&judged);
        both.filter(|(_, judged)| **judged == verdict).map(|(scene, _)| scene.clone()).collect()
    };
    [those(Some(false)), those(None)]
}

/// Each scene at one of the three tolerances, which turn over from scene to scene.
#[test]
fn the_tolerance_means_what_it_says() {
    let [wrong, late] = not_good(|i, k| (i + i / 4 + i / 16) % 3 == k);
    // measured: 0 and 0 of 96
    assert!(wrong.len() + late.len() <= 1, "{wrong:?} {late:?}");
}

#[test]
#[ignore = "three times as many"]
fn the_tolerance_means_what_it_says_in_all_scenes() {
    let [wrong, late] = not_good(|_, _| true);
    // measured: 1 of 288, a box whose error is 1.6e-8 at 1e-9
    assert!(wrong.len() <= 2, "{wrong:?}");
    // measured: 1 of 288, a box on its edge whose events accumulate at 1e-12
    assert!(late.len() <= 1, "{late:?}");
}
