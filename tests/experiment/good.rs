//! What can be written, and what it means.

use super::{BASE, experiment, file};
use gotai::experiment::ExperimentFile;
use gotai::experiment::types::*;
use gotai::experiment::vocabulary::words;

/// The complete example of the documentation.
const COMPLETE: &str = "\
question: Does a finer mesh diverge sooner?
scene:
  gravity_m_s2: [0, -9.8, 0]                     # y is up; this is the default
  friction: 0.3                                  # default of all pairs
  restitution: 0.0
  container: { box: { size_m: [4, 4, 4] } }      # faces inward
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 5 }
      mass_kg: 1.0
      inertia_from: lumped
      position_m: [0, 2, 0]
  random: { speed_m_s: 4, spin_rad_s: 6, attitude: true }
seed: 0
method: { lecture: { sweeps: 50 } }
time: { step_s: 0.01, end_s: 4.0 }
diverge: { energy_factor: 1000, escape: true }
record: { to: both, every_s: 0.01, cases: few }
sweep:
  axes:
    time.step_s: { log: { from: 1e-3, to: 5e-2, count: 8 } }
    scene.bodies.cube.mesh.nodes_per_edge: { range: { from: 2, to: 6 } }
    seed: { range: { from: 0, to: 39 } }
";

const SMALLEST: &str = "\
scene: { bodies: [{ name: a, shape: none, mass_kg: 1 }] }
time: { step_s: 0.01, end_s: 1 }
";

fn with_method(method: &str) -> Method {
    experiment(&BASE.replace("method: lecture", &format!("method: {method}")), &[]).unwrap().method
}

fn with_cube(lines: &str) -> Body {
    let text = BASE.replace("      mass_kg: 1.0\n", lines);
    experiment(&text, &[]).unwrap().scene.bodies.swap_remove(0)
}

#[test]
fn the_complete_example_is_read() {
    let file = file(COMPLETE, &[]).unwrap();
    assert_eq!(file.axes().len(), 8 * 5 * 40);
    let last = file.case(&file.axes().point(8 * 5 * 40 - 1)).unwrap();
    assert_eq!((last.seed, last.time.step_s), (39, Some(5e-2)));
    let cube = &last.scene.bodies[0];
    let six = Some(NodesPerEdge::Shortest(6));
    assert_eq!(cube.mesh, Some(MeshSpec { nodes_per_edge: six, subdivisions: None }));
    assert_eq!(cube.inertia_from, InertiaFrom::Lumped);
    assert_eq!(last.record.to, Some(RecordTo::Both));
    assert_eq!(last.scene.random.as_ref().unwrap().spin_rad_s, Some(6.0));
}

#[test]
fn every_case_of_the_complete_example_resolves() {
    let file = file(COMPLETE, &[]).unwrap();
    let seeds: u64 = (0..file.axes().len()).map(|i| file.case(&file.axes().point(i)).unwrap().seed).sum();
    assert_eq!(seeds, 8 * 5 * (39 * 40 / 2));
}

#[test]
fn what_is_not_written_has_its_default() {
    let experiment = experiment(SMALLEST, &[]).unwrap();
    assert_eq!(experiment.scene.gravity_m_s2, [0.0, -9.8, 0.0]);
    assert_eq!((experiment.scene.friction, experiment.seed), (0.0, 0));
    assert_eq!(experiment.method, Method::TimeStepping(TimeStepping::default()));
    assert_eq!(experiment.diverge, Diverge::default());
    assert_eq!(experiment.record, Record::default());
    assert!(experiment.scene.container.is_none());
}

#[test]
fn an_empty_section_has_its_defaults() {
    let text = format!("{SMALLEST}diverge:\nrecord:\nmethod:\n  lecture:\n");
    let experiment = experiment(&text, &[]).unwrap();
    assert_eq!((experiment.diverge, experiment.record), (Diverge::default(), Record::default()));
    assert_eq!(experiment.method, Method::Lecture(Lecture::default()));
}

#[test]
fn null_switches_the_energy_criterion_off() {
    let text = format!("{SMALLEST}diverge: {{ energy_factor: null }}\n");
    assert_eq!(experiment(&text, &[]).unwrap().diverge.energy_factor, None);
}

#[test]
fn a_word_is_the_one_that_the_parser_reads() {
    let methods = words::<Method>().into_iter().map(|word| (word.name, word.value.word()));
    let solvers = words::<Solver>().into_iter().map(|word| (word.name, word.value.word()));
    let laws = words::<Impact>().into_iter().map(|word| (word.name, word.value.word()));
    let all: Vec<_> = methods.chain(solvers).chain(laws).collect();
    assert_eq!(all.len(), 6 + Solver::ALL.len() + 3);
    for (read, said) in all {
        assert_eq!(read, said);
    }
}

#[test]
fn where_a_tolerance_is_a_method_says_its_own() {
    for word in words::<Method>() {
        if let Accuracy::Tolerance(path) = word.value.facts().accuracy {
            assert_eq!(path, ["method", word.name, "tolerance"]);
        }
    }
}

#[test]
fn a_method_is_one_word_or_one_key_with_settings() {
    let lecture = Method::Lecture(Lecture::default());
    for text in ["lecture", "{ lecture: {} }", "{ lecture: }", "{ lecture: { sweeps: 50 } }"] {
        assert_eq!(with_method(text), lecture, "{text}");
    }
    let direct = Lecture { start: Start::Direct, iteration: Iteration::Jacobi, ..Lecture::default() };
    assert_eq!(with_method("{ lecture: { start: direct, iteration: jacobi } }"), Method::Lecture(direct));
    assert_eq!(with_method("time-stepping"), Method::default());
    assert_eq!(
        with_method("{ free: { integrator: explicit-euler } }"),
        Method::Free(Free { integrator: Integrator::ExplicitEuler, tolerance: None })
    );
}

#[test]
fn a_word_without_settings_may_be_written_as_a_key() {
    let word = experiment(BASE, &[]).unwrap();
    for text in ["{ none: {} }", "{ none: }"] {
        assert_eq!(experiment(&BASE.replace("shape: none", &format!("shape: {text}")), &[]).unwrap(), word);
    }
}

#[test]
fn recorded_cases_are_a_word_or_a_sample() {
    let cases = |text: &str| experiment(&format!("{SMALLEST}record: {{ cases: {text} }}\n"), &[]).unwrap().record.cases;
    assert_eq!(cases("all"), RecordCases::All);
    assert_eq!(cases("{ sample: 20 }"), RecordCases::Sample(20));
}

#[test]
fn whole_numbers_are_numbers_and_whole_floats_are_whole() {
    let experiment = experiment(&BASE.replace("seed: 7", "seed: 7.0").replace("end_s: 1.0", "end_s: 1"), &[]).unwrap();
    assert_eq!((experiment.seed, experiment.time.end_s), (7, 1.0));
    let seed = file(&BASE.replace("seed: 7", "seed: 18446744073709551615"), &[]).unwrap().experiment().unwrap().seed;
    assert_eq!(seed, u64::MAX);
}

#[test]
fn nodes_are_counted_along_the_shortest_edge_or_along_each() {
    let nodes = |text: &str| {
        let text = BASE.replace("nodes_per_edge: 3", &format!("nodes_per_edge: {text}"));
        experiment(&text, &[]).unwrap().scene.bodies[0].mesh.clone().unwrap().nodes_per_edge
    };
    assert_eq!(nodes("4"), Some(NodesPerEdge::Shortest(4)));
    assert_eq!(nodes("4.0"), Some(NodesPerEdge::Shortest(4)));
    assert_eq!(nodes("[2, 3, 4]"), Some(NodesPerEdge::Each([2, 3, 4])));
}

#[test]
fn inertia_is_three_moments_or_a_matrix_and_may_be_that_of_a_flat_body() {
    let inertia = |text: &str| with_cube(&format!("      mass_kg: 1\n      inertia_kg_m2: {text}\n")).inertia_kg_m2;
    assert_eq!(inertia("[1, 2, 3]"), Some(Inertia::Principal([1.0, 2.0, 3.0])));
    assert_eq!(inertia("[0.1, 0.2, 0.3]"), Some(Inertia::Principal([0.1, 0.2, 0.3])));
    let rows = [[2.0, 0.5, 0.0], [0.5, 2.0, 0.0], [0.0, 0.0, 3.0]];
    assert_eq!(inertia("[[2, 0.5, 0], [0.5, 2, 0], [0, 0, 3]]"), Some(Inertia::Full(rows)));
}

#[test]
fn quaternions_are_normalised_whatever_their_size() {
    for scale in ["3", "1e-200", "1e200"] {
        let body =
            with_cube(&format!("      mass_kg: 1\n      orientation: {{ quaternion_xyzw: [0, 0, 0, -{scale}] }}\n"));
        assert_eq!(body.orientation.unwrap().quaternion_xyzw, Some([0.0, 0.0, 0.0, -1.0]), "{scale}");
    }
}

#[test]
fn a_point_with_an_inertia_spins() {
    let text = BASE.replace(
        "mass_kg: 0.5",
        "mass_kg: 0.5\n      inertia_kg_m2: [1, 1, 1]\n      angular_velocity_rad_s: [0, 1, 0]",
    );
    assert_eq!(experiment(&text, &[]).unwrap().scene.bodies[1].angular_velocity_rad_s, Some([0.0, 1.0, 0.0]));
}

#[test]
fn json_is_read_too() {
    let yaml = experiment(BASE, &[]).unwrap();
    let json = serde_json::to_string_pretty(&yaml).unwrap();
    assert_eq!(experiment(&json, &[]).unwrap(), yaml);
    assert_eq!(experiment(&json.replace("  ", "\t"), &[]).unwrap(), yaml);
}

#[test]
fn a_resolved_experiment_survives_json() {
    let file = file(COMPLETE, &[]).unwrap();
    let experiment = file.case(&[3, 2, 1]).unwrap();
    let json = serde_json::to_string(&experiment).unwrap();
    assert_eq!(serde_json::from_str::<Experiment>(&json).unwrap(), experiment);
}

#[test]
fn anchors_and_merged_keys_are_yaml() {
    let text = BASE.replace("- name: cube\n", "- &cube\n      name: cube\n")
        + "diverge: &d { speed_m_s: 3 }\nquestion: &q why\n";
    let merged = text.replace("diverge: &d { speed_m_s: 3 }", "diverge: { <<: { speed_m_s: 3 }, escape: false }");
    let diverge = experiment(&merged, &[]).unwrap().diverge;
    assert_eq!((diverge.speed_m_s, diverge.escape), (Some(3.0), false));
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_do_not_matter() {
    let text = format!("\u{feff}{}", BASE.replace('\n', "\r\n"));
    assert_eq!(experiment(&text, &[]).unwrap(), experiment(BASE, &[]).unwrap());
    assert_eq!(experiment(&text.replace("seed", "sede"), &[]).unwrap_err().details().line, Some(15));
}

#[test]
fn a_file_is_loaded_from_disk() {
    let folder = crate::scratch::folder();
    let path = folder.path().join("base.yaml");
    std::fs::write(&path, BASE).unwrap();
    let file = ExperimentFile::load(&path, &["seed=8".to_string()]).unwrap();
    assert_eq!((file.path(), file.experiment().unwrap().seed), (path.as_path(), 8));
}
