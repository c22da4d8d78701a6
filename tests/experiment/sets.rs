//! `--set PATH=VALUE`.

use super::{BASE, experiment, file, swept};
use gotai::experiment::types::*;

fn message(sets: &[&str]) -> String {
    experiment(BASE, sets).unwrap_err().to_string()
}

#[test]
fn a_value_is_set_by_its_path() {
    let experiment = experiment(BASE, &["scene.friction=0.5", "seed=3", "question=Does it hold?"]).unwrap();
    assert_eq!((experiment.scene.friction, experiment.seed), (0.5, 3));
    assert_eq!(experiment.question.as_deref(), Some("Does it hold?"));
}

#[test]
fn list_items_are_found_by_name_and_by_index() {
    let masses = |path: &str| {
        let bodies = &experiment(BASE, &[&format!("scene.bodies.{path}.mass_kg=2")]).unwrap().scene.bodies;
        [bodies[0].mass_kg, bodies[1].mass_kg]
    };
    assert_eq!(masses("cube"), [Some(2.0), Some(0.5)]);
    assert_eq!(masses("0"), [Some(2.0), Some(0.5)]);
    assert_eq!(masses("point"), [Some(1.0), Some(2.0)]);
    assert_eq!(masses("1"), [Some(1.0), Some(2.0)]);
    let moved = experiment(BASE, &["scene.bodies.cube.position_m.1=3"]).unwrap();
    assert_eq!(moved.scene.bodies[0].position_m, [0.0, 3.0, 0.0]);
}

#[test]
fn a_name_goes_before_an_index() {
    let text = BASE.replace("name: point", "name: 0").replace("name: 0", "name: '0'");
    let bodies = &experiment(&text, &["scene.bodies.0.mass_kg=9"]).unwrap().scene.bodies;
    assert_eq!([bodies[0].mass_kg, bodies[1].mass_kg], [Some(1.0), Some(9.0)]);
}

#[test]
fn the_value_may_be_any_yaml() {
    let set = "scene.container={ plane: { normal: [0, 1, 0] } }";
    let plane = Plane { normal: [0.0, 1.0, 0.0], offset_m: 0.0 };
    assert_eq!(experiment(BASE, &[set]).unwrap().scene.container, Some(Container::Plane(plane)));
    let free = experiment(BASE, &["method=free", "scene.bodies.cube.mesh=null"]).unwrap();
    assert_eq!(free.scene.bodies[0].mesh, None);
    assert_eq!(experiment(BASE, &["question=a=b"]).unwrap().question.as_deref(), Some("a=b"));
}

#[test]
fn missing_sections_are_created() {
    let experiment = experiment(BASE, &["diverge.escape=false", "record.streams=[energy]"]).unwrap();
    assert!(!experiment.diverge.escape);
    assert_eq!(experiment.diverge.energy_factor, Some(1000.0));
    assert_eq!(experiment.record.streams, [Stream::Energy]);
}

#[test]
fn the_last_set_of_a_path_wins() {
    assert_eq!(experiment(BASE, &["seed=1", "seed=2"]).unwrap().seed, 2);
    let method =
        experiment(BASE, &["method={time-stepping: {solver: pgs}}", "method.time-stepping.sweeps=3"]).unwrap().method;
    let wanted = TimeStepping { solver: Solver::Pgs, sweeps: Some(3), ..TimeStepping::default() };
    assert_eq!(method, Method::TimeStepping(wanted));
}

#[test]
fn a_method_of_one_word_takes_settings() {
    let method = experiment(BASE, &["method.lecture.sweeps=10", "method.lecture.start=direct"]).unwrap().method;
    assert_eq!(method, Method::Lecture(Lecture { sweeps: 10, start: Start::Direct, ..Lecture::default() }));
}

#[test]
fn settings_of_another_method_are_refused() {
    let word = message(&["method.time-stepping.sweeps=10"]);
    assert_eq!(
        word,
        "--set method.time-stepping.sweeps=10: method.time-stepping: `method` is `lecture`: there is no `time-stepping` in it"
    );
    let text = BASE.replace("method: lecture", "method: { lecture: { sweeps: 3 } }");
    let key = experiment(&text, &["method.time-stepping.sweeps=10"]).unwrap_err().to_string();
    assert!(
        key.starts_with("--set method.time-stepping.sweeps=10: method.time-stepping: expected only one of"),
        "{key}"
    );
    assert!(key.contains("found `time-stepping` beside `lecture`"), "{key}");
}

#[test]
fn an_error_in_a_set_value_points_to_the_set_and_not_to_a_line() {
    let error = experiment(BASE, &["scene.friction=-1"]).unwrap_err();
    assert_eq!(error.to_string(), "--set scene.friction=-1: scene.friction: expected a number of at least 0, found -1");
    assert_eq!((error.details().line, error.details().set.as_deref()), (None, Some("scene.friction=-1")));
    let nested = message(&["scene.container={ box: { size_m: [1, 1, 0] } }"]);
    assert!(nested.starts_with("--set scene.container={"), "{nested}");
    assert!(nested.contains(": scene.container.box.size_m.2: expected a number greater than 0, found 0"), "{nested}");
    let created = message(&["diverge.escap=false"]);
    assert!(
        created.starts_with("--set diverge.escap=false: diverge.escap: unknown key; did you mean `escape`?"),
        "{created}"
    );
    let section = message(&["scene.random.speed=3"]);
    assert!(
        section.starts_with("--set scene.random.speed=3: scene.random.speed: unknown key; did you mean `speed_m_s`?"),
        "{section}"
    );
    let removed = message(&["scene.bodies.cube.mesh=null"]);
    assert!(removed.starts_with("--set scene.bodies.cube.mesh=null: scene.bodies.cube.mesh: missing"), "{removed}");
}

#[test]
fn an_error_beside_a_set_value_keeps_its_line() {
    let text = BASE.replace("mass_kg: 0.5", "mass_kg: -1");
    let error = experiment(&text, &["scene.bodies.point.position_m=[0,1,0]", "seed=1"]).unwrap_err();
    assert!(error.to_string().starts_with("a.yaml:14: scene.bodies.point.mass_kg"), "{error}");
}

#[test]
fn a_set_that_leads_nowhere_says_what_is_there() {
    let item = message(&["scene.bodies.cub.mass_kg=2"]);
    assert!(item.contains("scene.bodies.cub: no such item; did you mean `cube`? (known here: cube, point)"), "{item}");
    let index = message(&["scene.bodies.2.mass_kg=2"]);
    assert!(index.contains("scene.bodies.2: no such item (known here: cube, point)"), "{index}");
    let coordinate = message(&["scene.bodies.cube.position_m.3=2"]);
    assert!(coordinate.contains("no such item (items 0 to 2)"), "{coordinate}");
    let number = message(&["scene.friction.static=1"]);
    assert!(number.contains("`scene.friction` is 0.3: there is no `static` in it"), "{number}");
}

#[test]
fn a_malformed_set_says_what_it_must_look_like() {
    assert_eq!(message(&["seed"]), "--set seed: expected PATH=VALUE, found `seed`");
    for set in ["=3", "scene..friction=1", ".seed=1", "seed.=1"] {
        let text = message(&[set]);
        assert!(text.starts_with(&format!("--set {set}: expected a path such as ")), "{text}");
    }
    assert!(message(&[&format!("{}=1", ["a"; 60_000].join("."))]).contains("expected a path such as "));
    let text = message(&["scene.container={ box"]);
    assert!(text.starts_with("--set scene.container={ box: scene.container: the value is not valid YAML"), "{text}");
}

#[test]
fn setting_an_axis_removes_it() {
    let text = swept("    seed: [1, 2]\n    scene.bodies.cube.mass_kg: [1, 2, 3]\n");
    let file = file(&text, &["scene.bodies.0.mass_kg=5"]).unwrap();
    assert_eq!(file.axes().axes.iter().map(|axis| axis.path.as_str()).collect::<Vec<_>>(), ["seed"]);
    assert_eq!(file.case(&[1]).unwrap().scene.bodies[0].mass_kg, Some(5.0));
    let single = experiment(&text, &["seed=4", "scene.bodies.cube.mass_kg=5"]).unwrap();
    assert_eq!(single.seed, 4);
}

#[test]
fn setting_an_axis_removes_it_from_its_group() {
    let text = swept("    seed: [1, 2]\n    scene.friction: [0.1, 0.2]\n  together: [[seed, scene.friction]]\n");
    let file = file(&text, &["scene.friction=0.7"]).unwrap();
    assert_eq!((file.axes().len(), file.axes().groups.clone()), (2, vec![vec![0]]));
    assert_eq!(file.case(&[1]).unwrap().scene.friction, 0.7);
}

#[test]
fn axes_can_be_set_too() {
    let text = swept("    scene.friction: { range: { from: 0, to: 1 } }\n");
    assert_eq!(file(BASE, &["sweep.axes.time.step_s=[0.1, 0.2, 0.3]"]).unwrap().axes().len(), 3);
    assert_eq!(file(&text, &["sweep.axes.scene.friction=[0.5]"]).unwrap().axes().len(), 1);
    assert_eq!(file(&text, &["sweep.axes.scene.friction.range.to=4"]).unwrap().axes().len(), 5);
    assert!(file(&text, &["sweep=null"]).unwrap().axes().is_empty());
    let error = file(BASE, &["sweep.axes.scene.friction=[0.5, -1]"]).unwrap().case(&[1]).unwrap_err();
    assert!(
        error.to_string().starts_with("--set sweep.axes.scene.friction=[0.5, -1]: scene.friction: expected"),
        "{error}"
    );
}

#[test]
fn a_set_that_an_axis_would_overwrite_is_refused() {
    let text = swept("    method: [lecture, free]\n");
    let error = file(&text, &["method.lecture.sweeps=3"]).unwrap_err().to_string();
    assert!(error.starts_with("--set method.lecture.sweeps=3: method: is an axis"), "{error}");
    file(&text, &["method.lecture.sweeps=3", "method=lecture"]).unwrap();
}
