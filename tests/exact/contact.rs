//! `exact:` of scenes with contact, as an experiment meets it: methods come near, other scenes are refused.

use crate::yaml::{experiment, file, run};
use gotai::exact::Closed;
use gotai::experiment::types::Exact;
use gotai::state::BodyState;
use gotai::sweep::plan;

/// A scene of every closed form with contact.
pub fn scene(which: Exact) -> String {
    let plane = "container: { plane: { normal: [0, 1, 0] } }";
    let (scene, bodies) = match which {
        Exact::Sliding => (
            format!("friction: 0.3, {plane}"),
            "{ name: b, shape: { box: { size_m: [1, 0.4, 0.8] } }, mass_kg: 2, position_m: [0, 0.2, 0], velocity_m_s: [2, 0, 1] }",
        ),
        Exact::Ball => (
            format!("friction: 0.2, restitution: 0.5, {plane}"),
            "{ name: b, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 2, position_m: [0, 0.5, 0], velocity_m_s: [2, 0, 1], \
             angular_velocity_rad_s: [1, 2, 3] }",
        ),
        // It rolls: v − r ω × n = Ω n × ρ.
        Exact::Turntable => (
            "friction: 0.5".into(),
            "{ name: b, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 2, position_m: [0.5, 0.2, 0], velocity_m_s: [0.3, 0, 0.2], angular_velocity_rad_s: [12, 7, -3] }, \
             { name: table, shape: { cylinder: { radius_m: 3, height_m: 0.2 } }, mass_kg: 9, \
             kinematic: { velocity_m_s: [0, 0, 0], angular_velocity_rad_s: [0, 2, 0] } }",
        ),
        Exact::RockingBlock => (
            format!("friction: 0.9, {plane}"),
            // Tilted by asin 0.1 about its edge at x = z = 0: the centre is where its half sizes turn to.
            "{ name: b, shape: { box: { size_m: [0.4, 1, 0.8] } }, mass_kg: 2, \
             position_m: [0.14899748742132402, 0.51749371855331, 0], \
             orientation: { quaternion_xyzw: [0, 0, 0.050062775059818876, 0.9987460731103327] } }",
        ),
        Exact::FallingRod => (
            plane.into(),
            "{ name: b, shape: { capsule: { radius_m: 0.01, height_m: 1 } }, mass_kg: 2, \
             inertia_kg_m2: [0.16666666666666666, 0.0001, 0.16666666666666666], \
             position_m: [0, 0.44301270189221936, 0], orientation: { axis: [1, 0, 2], angle_deg: 30 } }",
        ),
        Exact::Ladder => (
            "container: { planes: [{ normal: [0, 1, 0] }, { normal: [1, 0, 0] }] }".into(),
            "{ name: b, shape: { capsule: { radius_m: 0.01, height_m: 1 } }, mass_kg: 2, \
             inertia_kg_m2: [0.16666666666666666, 0.0001, 0.16666666666666666], \
             position_m: [0.26, 0.44301270189221936, 0], orientation: { axis: [0, 0, 1], angle_deg: 30 } }",
        ),
        Exact::RimlessWheel => (
            format!("friction: 1, {plane}"),
            "{ name: b, shape: { convex: { vertices_m: [[0.5, 0, -0.2], [0.25, 0.4330127018922193, -0.2], [-0.25, 0.4330127018922193, -0.2], \
             [-0.5, 0, -0.2], [-0.25, -0.4330127018922193, -0.2], [0.25, -0.4330127018922193, -0.2], \
             [0.5, 0, 0.2], [0.25, 0.4330127018922193, 0.2], [-0.25, 0.4330127018922193, 0.2], \
             [-0.5, 0, 0.2], [-0.25, -0.4330127018922193, 0.2], [0.25, -0.4330127018922193, 0.2]] } }, \
             mass_kg: 2, position_m: [0, 0.4330127018922193, 0], velocity_m_s: [1.7320508075688772, 1, 0], \
             angular_velocity_rad_s: [0, 0, -4] }",
        ),
        Exact::Dome => (
            "gravity_m_s2: [0, -9.81, 0], friction: 0".into(),
            "{ name: b, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 2, position_m: [0.19101299543362332, 1.0832885283134288, 0] }, \
             { name: dome, shape: { sphere: { radius_m: 1 } }, position_m: [0, 0, 0], fixed: true }",
        ),
        Exact::StickSlip => (
            format!(
                "friction: 0.3, {plane}, \
                 forces: [{{ body: b, force_n: [8, 0, 6], as: {{ cosine: {{ frequency_rad_s: 5, phase_rad: 1 }} }} }}]"
            ),
            "{ name: b, shape: { box: { size_m: [1, 0.2, 1] } }, mass_kg: 2, position_m: [0, 0.1, 0] }",
        ),
        _ => (
            format!("friction: 0.3, {plane}"),
            "{ name: b, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 2, position_m: [0, 0.5, 0] }",
        ),
    };
    let end_s = match which {
        Exact::FallingRod => 0.2,
        Exact::Ladder => 0.45,
        _ => 0.9,
    };
    format!(
        "scene: {{ {scene}, bodies: [{bodies}] }}\ntime: {{ step_s: 0.001, end_s: {end_s} }}\n\
         method: {{ time-stepping: {{ solver: newton }} }}\nexact: {}\n",
        which.word()
    )
}

/// The exact motion of the first body.
pub fn reference(text: &str, sets: &[&str]) -> impl Fn(f64) -> BodyState + use<> {
    let experiment = experiment(text, sets);
    let (model, start) = gotai::scene::build(&experiment).unwrap();
    let exact = Closed::new(experiment.exact.unwrap(), &model, &start).unwrap();
    move |t_s| exact.state_at(t_s).bodies[0]
}

#[test]
fn time_stepping_comes_near_every_closed_form() {
    for which in Exact::ALL.iter().copied().filter(|which| which.touches()) {
        let errors = [0.001, 0.0001].map(|step_s| {
            let m = run(&experiment(&scene(which), &[&format!("time.step_s={step_s}")])).measured;
            m.error_position_m.unwrap().max(m.error_orientation_rad.unwrap())
        });
        // measured: 1.3e-2 and 2.0e-3 for the ball, 4e-3 and a tenth of it for the others
        assert!(errors[0] < 2e-2 && errors[1] < 0.2 * errors[0] + 1e-9, "{}: {errors:?}", which.word());
    }
}

#[test]
fn a_scene_that_is_not_the_closed_forms_is_refused() {
    let rows: [(Exact, &[&str], &str); 39] = [
        (Exact::Rest, &["scene.bodies.b.velocity_m_s=[0, 0, 1e-9]"], "`b` at rest at the start"),
        (Exact::Sliding, &["scene.bodies.b.velocity_m_s=[2, 0.1, 1]"], "moving along the plane without turning"),
        (Exact::Sliding, &["scene.bodies.b.angular_velocity_rad_s=[0, 1, 0]"], "without turning"),
        (Exact::Sliding, &["scene.bodies.b.position_m=[0, 0.21, 0]"], "lying flat on the plane"),
        (Exact::Sliding, &["scene.gravity_m_s2=[1, -9, 0]"], "along the line of slope"),
        (Exact::Sliding, &["scene.gravity_m_s2=[0, 1, 0]"], "pressed on the plane"),
        (
            Exact::Sliding,
            &["scene.friction=2.6", "scene.bodies.b.velocity_m_s=[1, 0, 0]"],
            "the resultant within its base",
        ),
        (Exact::Sliding, &["scene.container={box: {size_m: [4, 4, 4]}}"], "a `container` of one plane"),
        (Exact::Sliding, &["scene.air={linear_drag_n_s_m: 1}"], "no `air`"),
        (Exact::Sliding, &["scene.forces=[{body: b, torque_n_m: [0, 1, 0]}]"], "at the centre of mass"),
        (Exact::Ball, &["scene.bodies.b.shape={box: {size_m: [1, 1, 1]}}"], "`b` a sphere without a mesh"),
        (Exact::Ball, &["scene.gravity_m_s2=[1, -9, 0]", "scene.restitution=0"], "slipping along the line of slope"),
        (Exact::Turntable, &["scene.bodies.b.angular_velocity_rad_s=[10, 0, 0.1]"], "rolling on the table"),
        (Exact::Turntable, &["scene.bodies.table.kinematic.angular_velocity_rad_s=[0.1, 2, 0]"], "the vertical axis"),
        (
            Exact::Turntable,
            &["scene.bodies.b.velocity_m_s=[6, 0, 0]", "scene.bodies.b.angular_velocity_rad_s=[10, 0, -60]"],
            "staying on the table",
        ),
        (
            Exact::Turntable,
            &[
                "scene.friction=0.3",
                "scene.bodies.b.velocity_m_s=[6, 0, 0]",
                "scene.bodies.b.angular_velocity_rad_s=[10, 0, -60]",
            ],
            "more friction",
        ),
        (Exact::RockingBlock, &["scene.restitution=0.1"], "no restitution"),
        (Exact::RockingBlock, &["scene.friction=0.2"], "more friction than rocking"),
        (Exact::RockingBlock, &["scene.gravity_m_s2=[0.1, -9, 0]"], "a level plane"),
        (
            Exact::RockingBlock,
            &["scene.bodies.b.angular_velocity_rad_s=[0, 1, 0]"],
            "tilted about one of its lower edges",
        ),
        (Exact::RockingBlock, &["scene.bodies.b.center_of_mass_m=[0.1, 0, 0]"], "symmetric about the plane"),
        (Exact::FallingRod, &["scene.friction=0.1"], "no friction and no restitution"),
        (Exact::FallingRod, &["scene.bodies.b.inertia_kg_m2=[0.6, 0.0001, 0.6]"], "of at most m (L/2)²"),
        (Exact::FallingRod, &["scene.bodies.b.velocity_m_s=[1, 0, 0]"], "leaning at rest"),
        (Exact::Ladder, &["scene.friction=0.1"], "no friction and no restitution"),
        (Exact::Ladder, &["scene.container={plane: {normal: [0, 1, 0]}}"], "a `container` of two planes"),
        (Exact::Ladder, &["scene.gravity_m_s2=[1, -9, 0]"], "a level plane and an upright one"),
        (Exact::Ladder, &["scene.bodies.b.position_m=[0.27, 0.44301270189221936, 0]"], "one end on each plane"),
        (Exact::RimlessWheel, &["scene.restitution=0.1"], "no restitution"),
        (Exact::RimlessWheel, &["scene.friction=0.3"], "more friction than rolling takes"),
        (Exact::RimlessWheel, &["scene.bodies.b.angular_velocity_rad_s=[0, 0, 0]"], "turning about one"),
        (
            Exact::RimlessWheel,
            &[
                "scene.bodies.b.center_of_mass_m=[0.01, 0, 0]",
                "scene.bodies.b.velocity_m_s=[1.7320508075688772, 0.96, 0]",
            ],
            "a regular prism",
        ),
        (Exact::RimlessWheel, &["scene.gravity_m_s2=[0, -9, 1]"], "along the line of slope"),
        (Exact::Dome, &["scene.bodies.dome.fixed=false", "scene.bodies.dome.mass_kg=5"], "`dome` fixed"),
        (Exact::Dome, &["scene.bodies.b.position_m=[0, 1.1, 0]"], "off its top"),
        (Exact::Dome, &["scene.friction=0.01"], "more friction than rolling takes"),
        (Exact::StickSlip, &["scene.forces=[]"], "one cosine among the `forces`"),
        (Exact::StickSlip, &["scene.bodies.b.velocity_m_s=[1, 0, 0]"], "everything along one line"),
        (
            Exact::StickSlip,
            &["scene.bodies.b.shape.box.size_m=[0.1, 0.2, 0.1]", "scene.friction=0.7"],
            "too low to tip",
        ),
    ];
    for (which, sets, fragment) in rows {
        let message = match plan::cases(&file(&scene(which), &[sets, &["scene.allow_overlap=true"]].concat())) {
            Ok(_) => panic!("{sets:?} is accepted"),
            Err(error) => error.to_string(),
        };
        assert!(message.contains("exact: expected a scene with") && message.contains(fragment), "{sets:?}: {message}");
    }
}

#[test]
fn motions_with_contact_need_a_method_with_contact_and_the_others_one_without() {
    let refusal = |which: Exact, sets: &[&str]| {
        gotai::experiment::ExperimentFile::from_text(
            std::path::Path::new("test.yaml"),
            &scene(which),
            &sets.iter().map(ToString::to_string).collect::<Vec<_>>(),
        )
        .and_then(|file| plan::single_case(&file))
        .unwrap_err()
        .to_string()
    };
    for which in Exact::ALL.iter().copied().filter(|which| which.touches()) {
        let message = refusal(which, &["method=free"]);
        assert!(message.contains("expected a motion without contact, or a method with contact"), "{message}");
    }
    let message = refusal(Exact::Ball, &["exact=free-motion"]);
    assert!(message.contains("expected an exact motion with contact"), "{message}");
}
