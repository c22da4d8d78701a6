//! `exact:` as an experiment meets it: which scenes a closed form is the motion of, and which it refuses.

use crate::yaml::{experiment, file, run};
use gotai::exact::heavy_top::{HeavyTop, Top};
use gotai::experiment::types::Exact;
use gotai::sweep::plan;
use nalgebra::{UnitQuaternion, Vector3};

const TIME: &str = "time: { step_s: 0.05, end_s: 3 }\n";

/// A scene of every closed form.
fn scene(which: Exact) -> String {
    let spun = "inertia_kg_m2: [1, 2, 2.5], angular_velocity_rad_s: [0.3, 2, 0.1]";
    let (body, more) = match which {
        Exact::FreeMotion => (
            format!("shape: none, mass_kg: 2, velocity_m_s: [1, 2, 3], {spun}"),
            "forces: [{ body: b, force_n: [1, 0, 2] }, { body: b, force_n: [0, 3, 1], as: { cosine: { frequency_rad_s: 2, phase_rad: 0.3 } } }]",
        ),
        Exact::SymmetricBody => (
            "shape: none, mass_kg: 2, orientation: { axis: [1, 2, 0], angle_deg: 50 }, \
             inertia_kg_m2: [2, 1, 2], angular_velocity_rad_s: [0.3, 2, 0.1]"
                .into(),
            "restitution: 0",
        ),
        Exact::LinearDrag => (
            format!("shape: none, mass_kg: 2, velocity_m_s: [1, 2, 3], {spun}"),
            "air: { linear_drag_n_s_m: 3 }\n  forces: [{ body: b, force_n: [1, 0, 2] }]",
        ),
        Exact::QuadraticDrag => (
            "shape: { sphere: { radius_m: 0.3 } }, mass_kg: 2, velocity_m_s: [0, -1, 0], angular_velocity_rad_s: [1, 2, 3]".into(),
            "air: { density_kg_m3: 1.2, drag_coefficient: 0.5 }",
        ),
        Exact::HeavyTop => (
            "shape: none, mass_kg: 2, inertia_kg_m2: [0.3, 0.1, 0.3], orientation: { axis: [1, 0, 1], angle_deg: 40 }, \
             angular_velocity_body_rad_s: [0.5, 30, 1]"
                .into(),
            "pins: [{ body: b, point_m: [0, -0.4, 0] }]",
        ),
        Exact::Pendulum => (
            "shape: { box: { size_m: [0.1, 1, 0.2] } }, mass_kg: 2, orientation: { axis: [0, 0, 1], angle_deg: 160 }, \
             angular_velocity_rad_s: [0, 0, 2]"
                .into(),
            "pins: [{ body: b, point_m: [0, 0.5, 0] }]",
        ),
        _ => return super::contact::scene(which),
    };
    format!("scene:\n  bodies: [{{ name: b, {body} }}]\n  {more}\n{TIME}exact: {}\n", which.word())
}

#[test]
fn an_accurate_run_meets_every_closed_form() {
    for which in Exact::ALL.iter().copied().filter(|which| !which.touches()) {
        let sets = ["method.free={integrator: dop853, tolerance: 1e-14}"];
        let m = run(&experiment(&scene(which), &sets)).measured;
        let errors =
            [m.error_position_m, m.error_orientation_rad, m.error_velocity_m_s, m.error_angular_velocity_rad_s];
        let largest = errors.map(Option::unwrap).into_iter().fold(0.0, f64::max);
        // measured: 4.3e-14 and less, but 1.2e-12 for the top
        assert!(largest < 1e-11, "{}: {errors:?}", which.word());
        // Of the columns that mean something none is zero by not being compared.
        let euler = run(&experiment(&scene(which), &["method=free"])).measured;
        assert!(euler.error_position_m.unwrap().max(euler.error_orientation_rad.unwrap()) > 1e-4, "{}", which.word());
    }
}

fn refusal(text: &str, sets: &[&str]) -> String {
    match plan::cases(&file(text, sets)) {
        Ok(_) => panic!("{sets:?} is accepted:\n{text}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_scene_that_is_not_the_closed_forms_is_refused() {
    let rows: [(Exact, &str, &str); 14] = [
        (Exact::FreeMotion, "scene.air={linear_drag_n_s_m: 1}", "expected a scene with no `air`"),
        (Exact::SymmetricBody, "scene.pins=[{body: b, point_m: [0, 0, 0]}]", "no `pins`"),
        (Exact::FreeMotion, "scene.forces.0.at_m=[1, 0, 0]", "`forces` of the world's frame at the centre of mass"),
        (Exact::FreeMotion, "scene.forces.0.frame=body", "`forces` of the world's frame"),
        (Exact::SymmetricBody, "scene.bodies.b.inertia_kg_m2=[1, 1.5, 2]", "`b` a body of revolution"),
        (Exact::LinearDrag, "scene.forces.0.as={cosine: {frequency_rad_s: 1}}", "forces that are constant"),
        (Exact::QuadraticDrag, "scene.bodies.b.velocity_m_s=[1, 0, 0]", "`b` moving along the line of its weight"),
        (Exact::QuadraticDrag, "scene.air.linear_drag_n_s_m=1", "no linear drag"),
        (Exact::HeavyTop, "scene.bodies.b.inertia_kg_m2=[0.3, 0.1, 0.25]", "a body of revolution, pinned on its axis"),
        (Exact::HeavyTop, "scene.pins.0.point_m=[0.1, -0.4, 0]", "pinned on its axis"),
        (Exact::HeavyTop, "scene.pins=[]", "`b` on one pin, to the world"),
        (Exact::HeavyTop, "scene.air={linear_drag_n_s_m: 1}", "no `forces` and no `air`"),
        (
            Exact::Pendulum,
            "scene.bodies.b.angular_velocity_rad_s=[0.1, 0, 2]",
            "swinging about a horizontal principal axis",
        ),
        (
            Exact::Pendulum,
            "scene.gravity_m_s2=[0, 0, 0]",
            "swinging about a horizontal principal axis of its pin, under gravity",
        ),
    ];
    for (which, set, fragment) in rows {
        let message = refusal(&scene(which), &["method=free", set]);
        assert!(message.contains("exact: expected a scene with") && message.contains(fragment), "{set}: {message}");
        assert!(message.starts_with("test.yaml:"), "{message}");
    }
    let text = scene(Exact::HeavyTop).replace("exact: heavy-top\n", "");
    let message = refusal(&text, &["method.free.integrator=exact"]);
    assert!(message.contains("method.free.integrator: expected a scene with no `pins`"), "{message}");
}

#[test]
fn the_list_of_closed_forms_has_every_word_that_the_parser_knows() {
    let words: Vec<&str> = Exact::ALL.iter().map(|which| which.word()).collect();
    let error = plan::single_case(&file(&scene(Exact::Pendulum), &["exact=nonsense"])).unwrap_err().to_string();
    assert!(error.contains(&format!("expected one of {}, found", words.join(", "))), "{error}");
}

/// M g l I₁ 4/I₃² below ω₃² an upright top sleeps, above it wakes: ω₃ = 2 √(9.81 · 0.4 · 2 · 0.62)/0.1 here.
#[test]
fn a_sleeping_top_is_stable_above_its_critical_spin() {
    let text = scene(Exact::HeavyTop);
    let critical = 2.0 * (9.81_f64 * 0.4 * 2.0 * (0.3 + 2.0 * 0.16)).sqrt() / 0.1;
    let tilt = |part: f64| {
        let sets = [
            "method.free={integrator: dop853, tolerance: 1e-12}".to_string(),
            "scene.gravity_m_s2=[0, -9.81, 0]".into(),
            "scene.bodies.b.orientation={axis: [0, 0, 1], angle_deg: 0.01}".into(),
            format!("scene.bodies.b.angular_velocity_body_rad_s=[0, {}, 0]", part * critical),
            "time={step_s: 0.05, end_s: 20}".into(),
        ];
        let experiment = experiment(&text, &sets.each_ref().map(String::as_str));
        let (model, start) = gotai::scene::build(&experiment).unwrap();
        let clock = experiment.clock();
        let plan = gotai::plan::Plan::new(&model, &experiment.method);
        let mut stepper = gotai::step::Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &start);
        let (mut state, mut largest) = (start, 0.0_f64);
        while state.step < clock.steps {
            stepper.step(&model, &mut state, &clock);
            largest = largest.max((state.bodies[0].q_WB * Vector3::y()).angle(&Vector3::y()));
        }
        largest
    };
    let (asleep, awake) = (tilt(1.02), tilt(0.98));
    // measured: 8.9e-4, 0.40
    assert!(asleep < 2e-3 && awake > 0.2, "{asleep}, {awake}");
}

/// Released with its spin alone a top swings between its start u₀ and the other root of β (1 − u²) = a² (u₀ − u).
#[test]
fn a_released_top_swings_between_its_two_bounds() {
    let text = std::fs::read_to_string("configs/free/heavy-top.yaml").unwrap();
    let (transverse, axial, spin, moment) = (0.02 + 0.2 * 0.2, 0.01, 60.0, 9.81 * 0.2);
    let (a, beta): (f64, f64) = (axial * spin / transverse, 2.0 * moment / transverse);
    let u0 = 0.75_f64.sqrt();
    let low = (a * a - (a * a * a * a - 4.0 * beta * (a * a * u0 - beta)).sqrt()) / (2.0 * beta);
    let top = Top {
        transverse_kg_m2: transverse,
        axial_kg_m2: axial,
        axis_B: Vector3::y(),
        first_moment_kg_m: 0.2,
        gravity_m_s2: Vector3::new(0.0, -9.81, 0.0),
    };
    let q_WB = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -30_f64.to_radians());
    let closed = HeavyTop::new(&top, &q_WB, &(q_WB * Vector3::new(0.0, spin, 0.0))).unwrap();
    let period_s = closed.nutation_period_s().unwrap();
    for (halves, bound) in [(1, low), (2, u0), (21, low), (40, u0)] {
        let end_s = period_s / 2.0 * f64::from(halves);
        let method = "method.free={integrator: dop853, tolerance: 1e-13}";
        let step_s = end_s / f64::from(halves) / 10.0;
        let sets = [method.to_string(), format!("time.step_s={step_s}"), format!("time.end_s={end_s}")];
        let ended = run(&experiment(&text, &sets.each_ref().map(String::as_str)));
        let u = ended.state.bodies[0].p_WB.y / 0.2;
        // measured: 7.8e-14
        assert!((u - bound).abs() < 1e-9, "{halves}: {:e}", u - bound);
        let (low_closed, high_closed) = closed.nutation().unwrap();
        assert!((low_closed - low).abs() < 1e-14 && (high_closed - u0).abs() < 1e-14);
    }
}
