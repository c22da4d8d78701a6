use super::measured;
use crate::yaml::CUBE_IN_BOX;
use gotai::experiment::types::Measure;
use serde_json::{Value, json};

const TWO: &str = "
scene:
  bodies:
    - { name: bar, shape: { box: { size_m: [1, 2, 3] } }, mass_kg: 12, center_of_mass_m: [0.5, 0, 0] }
    - { name: point, shape: none, mass_kg: 2 }
    - name: top
      shape: none
      mass_kg: 1
      inertia_kg_m2: [[2, 0.5, 0.25], [0.5, 2, 0.125], [0.25, 0.125, 3]]
measure: [inertia, state]
time: { step_s: 0.1, end_s: 0.1 }
";

#[test]
fn mass_properties_are_columns_of_every_body() {
    let values = measured(TWO, &[]);
    let numbers = |range: std::ops::Range<usize>| values[range].iter().map(Value::as_f64).collect::<Vec<_>>();
    // 12 (b² + c²)/12, and 12 · 0.5² more about the moved axes.
    assert_eq!(numbers(0..10), [12.0, 0.5, 0.0, 0.0, 13.0, 13.0, 8.0, 0.0, 0.0, 0.0].map(Some));
    // A point has no inertia.
    assert_eq!(numbers(10..14), [2.0, 0.0, 0.0, 0.0].map(Some));
    assert!(values[14..20].iter().all(Value::is_null));
    assert_eq!(numbers(20..30), [1.0, 0.0, 0.0, 0.0, 2.0, 2.0, 3.0, 0.5, 0.125, 0.25].map(Some));
    assert_eq!(values.len(), 30 + 3 * 13);
}

/// The lumped moment of a cube is 1/6 (1 − ½/(n−1)²) of m a² (L9).
#[test]
fn the_inertia_is_the_one_that_the_run_uses() {
    let values = measured(CUBE_IN_BOX, &["measure=[inertia]", "time.end_s=0.01"]);
    // measured: 1.0e-15
    assert!(super::close(values[4].as_f64().unwrap(), (1.0 - 0.5 / 4.0) / 6.0, 1e-14), "{}", values[4]);
}

#[test]
fn a_measure_is_written_as_a_word() {
    let words = json!(["state", "inertia", "contact-matrix", "critical-step"]);
    let all = [Measure::State, Measure::Inertia, Measure::ContactMatrix, Measure::CriticalStep];
    assert_eq!(serde_json::to_value(all).unwrap(), words);
}
