//! A scene in the words of a comparison of engines.

use gotai::bench::peer::run;

const TOP: &str = "\
scene free_top
duration 2.0
gravity 0.0 0.0 0.0
mu 0.0
restitution 0.0
body none 0 0 0  1.0  1.0 2.0 3.0  0.0 0.0 0.0  1.0 0.0 0.0 0.0  0.5 0.0 0.0  0.01 5.0 0.01
";

const SLAB: &str = "\
scene slide
duration 3.0
gravity 0.0 0.0 -9.81
mu 0.3
restitution 0.0
plane 0.0 0.0 1.0 0.0
body box 0.5 0.5 0.1  1.0  0.0866666666666667 0.0866666666666667 0.166666666666667  0 0 0.1  1 0 0 0  5 0 0  0 0 0
";

fn settings(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_string).collect()
}

/// Step, number of steps, time, and the numbers of the one body.
fn result(scene: &str, step_s: f64, given: &str) -> (f64, u64, f64, Vec<f64>) {
    let line = run(scene, 1, step_s, &settings(given)).unwrap_or_else(|error| panic!("{error}"));
    let words: Vec<&str> = line.split(' ').collect();
    assert_eq!((words[0], words[4], words.len()), ("RESULT", "1", 5 + 13), "{line}");
    let numbers: Vec<f64> = words[5..].iter().map(|word| word.parse().unwrap()).collect();
    (words[1].parse().unwrap(), words[2].parse().unwrap(), words[3].parse().unwrap(), numbers)
}

#[test]
fn a_scene_becomes_a_result_of_thirteen_numbers_a_body() {
    let (step_s, steps, wall_s, body) = result(TOP, 0.01, "method=time-stepping scheme=moreau solver=newton");
    assert_eq!((step_s, steps), (0.01, 200));
    assert!(wall_s > 0.0);
    // Place and velocity without forces. measured: 1.0e-14
    assert!((body[0] - 1.0).abs() < 1e-13 && body[7] == 0.5, "{body:?}");
    let norm: f64 = body[3..7].iter().map(|q| q * q).sum();
    assert!((norm - 1.0).abs() < 1e-14, "{norm}");
    // It has turned.
    assert!(body[3].abs() < 0.999, "{body:?}");
}

#[test]
fn the_same_motion_follows_from_a_tolerance() {
    let by_step = result(TOP, 0.001, "scheme=moreau").3;
    for given in ["method=event-driven tolerance=1e-10", "method=auto tolerance=1e-8"] {
        let (step_s, steps, _, body) = result(TOP, 0.01, given);
        // A flight is one stretch.
        assert_eq!((step_s, steps), (2.0, 1), "{given}");
        let apart = body.iter().zip(&by_step).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Of the steps, of order 2 in the rotation. measured: 3.5e-6
        assert!(apart < 1e-5, "{given}: {apart:e}");
    }
}

#[test]
fn planes_friction_and_half_extents_are_those_of_the_scene() {
    let (.., body) = result(SLAB, 1e-3, "solver=newton");
    // v²/2μg = 4.2474 m, and at rest on the plane; half a step of the first velocity short. measured: 2.5e-3, 2e-17
    assert!((body[0] - 25.0 / (0.6 * 9.81)).abs() < 4e-3, "{body:?}");
    assert!((body[2] - 0.1).abs() < 1e-12 && body[7].abs() < 1e-12, "{body:?}");
}

#[test]
fn what_is_wrong_is_said_with_its_line_or_setting() {
    let wrong = |scene: &str, given: &str| run(scene, 1, 0.01, &settings(given)).unwrap_err().to_string();
    for (found, message) in [
        (wrong(&TOP.replace("mu 0.0", "my 0.0"), ""), "line 4: expected scene, duration, gravity, mu,"),
        (wrong(&TOP.replace("none", "cone"), ""), "line 6: expected a body of shape"),
        (wrong(&TOP.replace("duration 2.0", "duration long"), ""), "line 2: expected numbers"),
        (wrong(&TOP.replace("gravity 0.0", "gravity"), ""), "line 3: expected another count of numbers"),
        (wrong(TOP, "sweeps=3"), "sweeps=3: expected one of method, tolerance"),
        (wrong(TOP, "method=rk4"), "method"),
        (wrong(TOP, "method=event-driven tolerance=1e-20"), "expected a number of at least 1e-13"),
    ] {
        assert!(found.contains(message), "{message}: {found}");
    }
}
