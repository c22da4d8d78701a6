//! A file that stands on another one.

use super::BASE;
use crate::scratch::{self, Folder};
use gotai::experiment::error::Kind;
use gotai::experiment::types::*;
use gotai::experiment::{ExperimentError, ExperimentFile};

/// `BASE` with a sweep, at `base.yaml`, and files beside it.
fn folder(files: &[(&str, &str)]) -> Folder {
    let folder = scratch::folder();
    let base = format!(
        "{BASE}sweep:\n  axes:\n    seed: [1, 2]\n    time.step_s: {{ log: {{ from: 1e-3, to: 1e-1, count: 3 }} }}\n\
         expect: [{{ column: steps, min: 1 }}]\n"
    );
    for (name, text) in [("base.yaml", base.as_str())].iter().chain(files) {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

fn load(folder: &Folder, name: &str, sets: &[&str]) -> Result<ExperimentFile, ExperimentError> {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    ExperimentFile::load(&folder.path().join(name), &sets)
}

/// `base.yaml` extended by these lines.
fn extended(lines: &str) -> ExperimentFile {
    let text = format!("extends: base.yaml\n{lines}");
    load(&folder(&[("a.yaml", &text)]), "a.yaml", &[]).unwrap_or_else(|error| panic!("{lines}: {error}"))
}

/// The first case.
fn case(lines: &str) -> Experiment {
    let file = extended(lines);
    file.case(&file.axes().point(0)).unwrap_or_else(|error| panic!("{lines}: {error}"))
}

fn refused(lines: &str) -> ExperimentError {
    let folder = folder(&[("a.yaml", &format!("extends: base.yaml\n{lines}"))]);
    let file = match load(&folder, "a.yaml", &[]) {
        Ok(file) => file,
        Err(error) => return error,
    };
    file.case(&file.axes().point(0)).expect_err(lines)
}

/// The message, without the folder.
fn shown(error: &ExperimentError, folder: &Folder) -> String {
    error.to_string().replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn mappings_are_merged_key_by_key_and_the_extending_file_wins() {
    let case = case("scene: { friction: 0.9, restitution: 0.5 }\ntime: { end_s: 3 }\nquestion: why?\n");
    assert_eq!((case.scene.friction, case.scene.restitution), (0.9, 0.5));
    assert_eq!((case.time.end_s, case.time.step_s), (3.0, Some(1e-3)));
    assert_eq!((case.scene.bodies.len(), case.question.as_deref()), (2, Some("why?")));
}

#[test]
fn lists_of_names_are_merged_by_name_and_others_are_replaced() {
    let case_of = case;
    let case = case_of(
        "scene:\n  bodies:\n    - { name: new, shape: none, mass_kg: 3 }\n    - { name: cube, mass_kg: 2, position_m: [1, 2, 0] }\n",
    );
    let names: Vec<&str> = case.scene.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["cube", "point", "new"]);
    let cube = &case.scene.bodies[0];
    assert_eq!((cube.mass_kg, cube.position_m, cube.mesh.is_some()), (Some(2.0), [1.0, 2.0, 0.0], true));
    assert!(extended("expect: [{ column: steps, min: 2 }]\n").expect().len() == 1);
    assert!(extended("expect: []\n").expect().is_empty());
    assert!(extended("expect:\n").expect().is_empty());
}

#[test]
fn another_word_replaces_all_settings_and_the_same_one_keeps_them() {
    let base = |method: &str, own: &str| {
        let base = BASE.replace("method: lecture", &format!("method: {method}"));
        let folder = folder(&[("b.yaml", &base), ("a.yaml", &format!("extends: b.yaml\nmethod: {own}\n"))]);
        load(&folder, "a.yaml", &[]).unwrap().experiment().unwrap().method
    };
    let lecture = |sweeps, start| Method::Lecture(Lecture { sweeps, start, ..Lecture::default() });
    let set = "{ lecture: { sweeps: 9 } }";
    assert_eq!(base(set, "free"), Method::Free(Free::default()));
    assert_eq!(base(set, "{ auto: { tolerance: 1e-3 } }"), Method::Auto(Auto { tolerance: 1e-3 }));
    assert_eq!(base("free", set), lecture(9, Start::None));
    assert_eq!(base(set, "{ lecture: { start: direct } }"), lecture(9, Start::Direct));
    for alone in ["lecture", "{ lecture: }", "{ lecture: {} }"] {
        assert_eq!(base(set, alone), lecture(9, Start::None), "{alone}");
    }
    let free = "{ free: { integrator: dop853, tolerance: 1e-9 } }";
    let Method::Free(settings) = base(free, "{ free: { integrator: rk4, tolerance: null } }") else { panic!() };
    assert_eq!(settings, Free { integrator: Integrator::Rk4, tolerance: None });
}

/// Every enum with settings, and every type whose keys are alternatives.
#[test]
fn what_is_said_in_another_way_is_replaced_as_a_whole() {
    let shape = &case("method: free\nscene: { bodies: [{ name: point, shape: { sphere: { radius_m: 0.2 } } }] }\n")
        .scene
        .bodies[1]
        .shape;
    assert_eq!(*shape, Shape::Sphere(Sphere { radius_m: 0.2 }));
    let cube =
        |own: &str| case(&format!("scene: {{ bodies: [{{ name: cube, {own} }}] }}\n")).scene.bodies.swap_remove(0);
    let sphere = cube("shape: { sphere: { radius_m: 0.2 } }, mesh: { subdivisions: 1 }");
    assert_eq!(sphere.shape, Shape::Sphere(Sphere { radius_m: 0.2 }));
    assert_eq!(sphere.mesh, Some(MeshSpec { nodes_per_edge: None, subdivisions: Some(1) }));
    let container = case("scene: { container: { plane: { normal: [0, 1, 0] } } }\n").scene.container.clone().unwrap();
    assert_eq!(container, Container::Plane(Plane { normal: [0.0, 1.0, 0.0], offset_m: 0.0 }));
    let boxed = case("scene: { container: { box: { center_m: [0, 0, 0] } } }\n").scene.container.clone().unwrap();
    assert_eq!(boxed, Container::Box(ContainerBox { size_m: [4.0; 3], center_m: Some([0.0; 3]) }));

    let twice = |first: &str, second: &str| {
        let folder = folder(&[
            ("b.yaml", &format!("extends: base.yaml\n{first}")),
            ("a.yaml", &format!("extends: b.yaml\n{second}")),
        ]);
        let file = load(&folder, "a.yaml", &[]).unwrap();
        (file.case(&file.axes().point(0)).unwrap(), file)
    };
    let cases = |cases: &str| format!("record: {{ cases: {cases} }}\n");
    assert_eq!(twice(&cases("{ sample: 4 }"), &cases("all")).0.record.cases, RecordCases::All);
    assert_eq!(twice(&cases("all"), &cases("{ sample: 4 }")).0.record.cases, RecordCases::Sample(4));
    let turned = |q: &str| format!("scene: {{ bodies: [{{ name: cube, orientation: {q} }}] }}\n");
    let euler = twice(&turned("{ axis: [0, 1, 0], angle_deg: 5 }"), &turned("{ euler_xyz_deg: [1, 2, 3] }"));
    assert_eq!(euler.0.scene.bodies[0].orientation.unwrap().euler_xyz_deg, Some([1.0, 2.0, 3.0]));
    let angle = twice(&turned("{ axis: [0, 1, 0], angle_deg: 5 }"), &turned("{ angle_deg: 9 }"));
    assert_eq!(angle.0.scene.bodies[0].orientation.unwrap().axis, Some([0.0, 1.0, 0.0]));
    let copies = |copies: &str| format!("scene: {{ bodies: [{{ name: point, copies: {copies} }}] }}\n");
    let grid = twice(&copies("{ count: 9, step_m: [1, 0, 0] }"), &copies("{ grid: [1, 2, 1], step_m: [0, 1, 0] }"));
    assert_eq!(grid.0.scene.bodies.len(), 3);
    let fewer = twice(&copies("{ count: 9, step_m: [1, 0, 0] }"), &copies("{ count: 2 }"));
    assert_eq!(fewer.0.scene.bodies[2].position_m, [1.0, 0.0, 0.0]);
    let search = |until: &str| {
        format!("sweep: {{ search: {{ critical: scene.friction, between: [0.1, 1], until: {until} }} }}\n")
    };
    let (_, file) = twice(&search("{ outcome: diverged }"), &search("{ column: steps, min: 3 }"));
    assert_eq!(file.search().unwrap().until.to_string(), "steps ≥ 3");
    let force = |course: &str| format!("scene: {{ forces: [{{ body: cube, force_n: [1, 0, 0], as: {course} }}] }}\n");
    let (cosine, _) = twice(&force("constant"), &force("{ cosine: { frequency_rad_s: 2 } }"));
    assert_eq!(cosine.scene.forces.len(), 1, "a list without names is replaced");
}

#[test]
fn axes_keep_their_place_and_their_values_are_replaced() {
    let axes = |own: &str| {
        let file = extended(&format!("sweep: {{ axes: {{ {own} }} }}\n"));
        let axes = file.axes().axes.iter();
        let shown = |axis: &gotai::experiment::axes::Axis| {
            let values: Vec<String> = axis.values.iter().map(|value| value.shown()).collect();
            format!("{}: {}", axis.path, values.join(" "))
        };
        axes.map(shown).collect::<Vec<_>>()
    };
    let step = "time.step_s: 0.001 0.01 0.1";
    assert_eq!(axes("seed: 7..9"), ["seed: 7 8 9", step]);
    assert_eq!(axes("seed: [3], scene.friction: [0, 1]"), ["seed: 3", step, "scene.friction: 0 1"]);
    assert_eq!(axes("seed: null"), [step]);
    assert_eq!(axes("time.step_s: { log: { count: 2 } }"), ["seed: 1 2", "time.step_s: 0.001 0.1"]);
    assert_eq!(axes("time.step_s: { linear: { from: 1, to: 2, count: 2 } }"), ["seed: 1 2", "time.step_s: 1 2"]);
    assert!(extended("sweep: null\n").axes().is_empty());

    let bodies = |first: &str| format!("sweep: {{ axes: {{ scene.bodies.1.shape: [{first}] }} }}\n");
    let folder = folder(&[
        (
            "b.yaml",
            &format!(
                "extends: base.yaml\n{}",
                bodies("{ label: a, value: none }, { label: b, value: { sphere: { radius_m: 1 } } }")
            ),
        ),
        ("a.yaml", &format!("extends: b.yaml\n{}", bodies("{ label: b, value: none }"))),
    ]);
    assert_eq!(load(&folder, "a.yaml", &[]).unwrap().axes().axes[2].values.len(), 1);
}

#[test]
fn a_base_may_stand_on_another_and_paths_are_those_of_the_extending_file() {
    let folder = folder(&[
        ("deep/b.yaml", "extends: ../base.yaml\nscene: { friction: 0.8 }\nseed: 5\n"),
        ("a.yaml", "extends: deep/b.yaml\nseed: 6\nsweep: null\n"),
    ]);
    let experiment = load(&folder, "a.yaml", &["time.end_s=9"]).unwrap().experiment().unwrap();
    assert_eq!((experiment.scene.friction, experiment.seed, experiment.time.end_s), (0.8, 6, 9.0));
    let file = load(&folder, "a.yaml", &["seed=7"]).unwrap();
    assert!(!file.written().contains("extends"), "{}", file.written());
    let again = ExperimentFile::from_text("b.yaml".as_ref(), &file.written(), &[]).unwrap();
    assert_eq!(again.experiment().unwrap(), file.experiment().unwrap());
}

/// What is wrong, the lines below `extends: base.yaml`, and how the message begins.
#[rustfmt::skip]
const ROWS: &[(&str, &str, &str)] = &[
    ("a value of its own", "scene:\n  friction: -1\n", "a.yaml:3: scene.friction: expected a number of at least 0"),
    ("a key of its own", "scene:\n  fricton: 1\n", "a.yaml:3: scene.fricton: unknown key; did you mean `friction`?"),
    ("a key at its top", "\nextend: b\n", "a.yaml:3: extend: unknown key; did you mean `extends`?"),
    ("a merged item of its own", "scene:\n  bodies:\n    - name: point\n      mass_kg: 0\n", "a.yaml:5: scene.bodies.point.mass_kg: expected"),
    ("a new item", "scene:\n  bodies:\n    - name: new\n      shape: none\n      mass_kg: 0\n", "a.yaml:6: scene.bodies.new.mass_kg: expected"),
    ("a name twice", "scene:\n  bodies:\n    - { name: new, shape: none, mass_kg: 1 }\n    - { name: new, shape: none, mass_kg: 1 }\n", "a.yaml:5: scene.bodies.3.name: expected a name of its own"),
    ("a base's item twice", "scene:\n  bodies:\n    - { name: cube }\n    - { name: cube, shape: none, mass_kg: 1 }\n", "a.yaml:5: scene.bodies.2.name: expected a name of its own"),
    ("a word of its own", "method:\n  lectur: {}\n", "a.yaml:3: method.lectur: expected one of"),
    ("two words", "method:\n  lecture: {}\n  free: {}\n", "a.yaml:4: method.free: expected only one of"),
    ("an axis of its own", "sweep:\n  axes:\n    seed: 3\n", "a.yaml:4: sweep.axes.seed: expected a list"),
    ("a word for a form", "sweep:\n  axes:\n    time.step_s: log\n", "a.yaml:4: sweep.axes.time.step_s: expected a list"),
    ("a value of an axis of its own", "sweep:\n  axes:\n    scene.friction: [-1]\n", "a.yaml:4: scene.friction: expected"),
    ("an expectation of its own", "expect:\n  - { colum: steps }\n", "a.yaml:3: expect.0.colum: unknown key"),
    ("the base's restitution does not fit its method", "scene: { restitution: 0.5 }\nmethod: { penalty: { stiffness_n_m: 1 } }\n", "a.yaml:2: scene.restitution: expected 0"),
    ("a mesh that the base has not for its method", "scene: { bodies: [{ name: cube, mesh: null }] }\n", "a.yaml:2: scene.bodies.cube.mesh: missing"),
    ("the base's position", "scene: { container: { plane: { normal: [0, 0, 0] } } }\n", "a.yaml:2: scene.container.plane.normal: expected a direction"),
    ("the base's step does not fit its method", "time: { step_s: null, end_s: -1 }\nsweep: null\n", "a.yaml:2: time.end_s: expected a number greater than 0"),
];

#[test]
fn an_error_is_on_the_line_of_the_file_that_said_it() {
    for (what, lines, begin) in ROWS {
        let error = refused(lines);
        let text = error.to_string();
        let file = text.find("a.yaml").or_else(|| text.find("base.yaml")).unwrap();
        assert!(text[file..].starts_with(begin), "{what}: {text}");
    }
    // Wrong in the base, whatever stands above it.
    for (wrong, begin) in [
        (("mass_kg: 1.0", "mass_kg: 0"), "b.yaml:10: scene.bodies.cube.mass_kg: expected"),
        (("shape: none", "shpe: none"), "b.yaml:13: scene.bodies.point.shpe: unknown key"),
        (("      mass_kg: 0.5\n", ""), "b.yaml:12: scene.bodies.point.mass_kg: missing"),
        (("seed: 7", "seed: [7"), "b.yaml:16: not valid YAML"),
        (("seed: 7", "seed: 7\nseed: 8"), "b.yaml:16: seed: this key is already there"),
    ] {
        let folder = folder(&[
            ("b.yaml", &BASE.replace(wrong.0, wrong.1)),
            (
                "a.yaml",
                "extends: b.yaml\nscene: { bodies: [{ name: new, shape: none, mass_kg: 1 }, { name: cube }] }\n",
            ),
        ]);
        let error = load(&folder, "a.yaml", &[]).and_then(|file| file.experiment()).unwrap_err();
        assert!(shown(&error, &folder).starts_with(begin), "{error}");
        assert_eq!(error.details().file.as_deref(), Some(folder.path().join("b.yaml").to_str().unwrap()));
    }
    let folder = folder(&[("b.yaml", "seed: 1\n"), ("a.yaml", "extends: b.yaml\nscene: {}\n")]);
    let error = load(&folder, "a.yaml", &[]).unwrap().experiment().unwrap_err();
    assert!(shown(&error, &folder).starts_with("a.yaml:2: scene.bodies: missing"), "{error}");
    let error = load(&folder, "b.yaml", &[]).unwrap().experiment().unwrap_err();
    assert!(shown(&error, &folder).starts_with("b.yaml: scene: missing"), "{error}");
}

#[test]
fn an_overlap_is_on_the_line_of_the_file_that_placed_the_body() {
    let folder = folder(&[(
        "a.yaml",
        "extends: base.yaml\nsweep: null\nscene:\n  bodies:\n    - name: point\n      position_m: [9, 9, 9]\n",
    )]);
    let file = load(&folder, "a.yaml", &[]).unwrap();
    for (body, begin) in
        [("point", "a.yaml:6: scene.bodies.point.position_m: "), ("cube", "base.yaml:11: scene.bodies.cube")]
    {
        let error = file.error_at(&[], &format!("scene.bodies.{body}.position_m"), "no overlap", "overlap");
        assert!(shown(&error, &folder).starts_with(begin), "{error}");
    }
    let set = load(&folder, "a.yaml", &["scene.bodies.point.position_m=[8, 8, 8]"]).unwrap();
    let error = set.error_at(&[], "scene.bodies.point.position_m", "no overlap", "overlap");
    assert!(error.to_string().starts_with("--set scene.bodies.point.position_m=[8, 8, 8]: "), "{error}");
}

#[test]
fn a_base_that_cannot_be_read_is_an_error_on_the_line_of_extends() {
    let mut files = vec![
        ("circle.yaml".to_string(), "extends: deep/back.yaml\n".to_string()),
        ("deep/back.yaml".to_string(), "# comment\nextends: ../deep/../circle.yaml\n".to_string()),
        ("self.yaml".to_string(), "extends: self.yaml\n".to_string()),
        ("missing.yaml".to_string(), "seed: 1\nextends: nowhere.yaml\n".to_string()),
        ("folder.yaml".to_string(), "extends: deep\n".to_string()),
        ("nothing.yaml".to_string(), "extends:\n".to_string()),
        ("number.yaml".to_string(), "extends: 3\n".to_string()),
        ("list.yaml".to_string(), "extends: [base.yaml]\n".to_string()),
        ("empty.yaml".to_string(), "extends: ''\n".to_string()),
        ("17.yaml".to_string(), BASE.to_string()),
    ];
    files.extend((0..17).map(|i| (format!("{i}.yaml"), format!("extends: {}.yaml\n", i + 1))));
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let folder = folder(&files);
    for (name, begin) in [
        (
            "circle.yaml",
            "deep/back.yaml:2: extends: files extend each other in a circle: circle.yaml → deep/back.yaml → \
             deep/../deep/../circle.yaml",
        ),
        ("self.yaml", "self.yaml:1: extends: files extend each other in a circle"),
        ("missing.yaml", "missing.yaml:2: extends: nowhere.yaml: cannot read the file"),
        ("folder.yaml", "folder.yaml:1: extends: deep: expected an experiment file, found a folder"),
        ("nothing.yaml", "nothing.yaml:1: extends: expected an experiment file, in quotes, found nothing"),
        ("number.yaml", "number.yaml:1: extends: expected an experiment file, in quotes, found 3"),
        ("list.yaml", "list.yaml:1: extends: expected an experiment file, in quotes, found a list of 1"),
        ("empty.yaml", "empty.yaml:1: extends: : expected an experiment file, found a folder"),
        ("0.yaml", "16.yaml:1: extends: expected at most 16 files below another, found more"),
    ] {
        let error = load(&folder, name, &[]).unwrap_err();
        assert!(shown(&error, &folder).starts_with(begin), "{name}: {error}");
        assert!(!error.is_machine(), "{name}");
    }
    assert_eq!(load(&folder, "missing.yaml", &[]).unwrap_err().details().kind, Kind::File);
    assert_eq!(load(&folder, "1.yaml", &[]).unwrap().experiment().unwrap().seed, 7);
    let nested = load(&folder, "base.yaml", &["scene.extends=a.yaml"]).unwrap();
    let error = nested.case(&[0, 0]).unwrap_err().to_string();
    assert!(error.contains("scene.extends: unknown key"), "{error}");
}
