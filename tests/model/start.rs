use crate::yaml::{CUBE_IN_BOX, experiment, file};
use gotai::scene::build;
use gotai::state::BodyState;
use gotai::sweep::plan::single_case;
use nalgebra::Vector3;

fn start(text: &str, sets: &[&str]) -> BodyState {
    build(&experiment(text, sets)).unwrap().1.bodies[0]
}

#[test]
fn draws_depend_on_the_seed_and_the_name_alone() {
    let drawn = start(CUBE_IN_BOX, &[]);
    assert!((drawn.v_WB.norm() - 4.0).abs() < 1e-14 && (drawn.w_WB.norm() - 6.0).abs() < 1e-14);
    let elsewhere = start(CUBE_IN_BOX, &["scene.bodies.cube.mass_kg=5", "scene.bodies.cube.mesh.nodes_per_edge=5"]);
    assert_eq!((drawn.v_WB, drawn.w_WB, drawn.q_WB), (elsewhere.v_WB, elsewhere.w_WB, elsewhere.q_WB));
    assert_ne!(drawn.v_WB, start(CUBE_IN_BOX, &["seed=4"]).v_WB);
    assert_ne!(drawn.v_WB, start(CUBE_IN_BOX, &["scene.bodies.cube.name=other"]).v_WB);
    // Asking for less does not change the rest.
    let no_spin = start(CUBE_IN_BOX, &["scene.random.spin_rad_s=null"]);
    assert_eq!((no_spin.v_WB, no_spin.w_WB), (drawn.v_WB, Vector3::zeros()));
    assert!(start(CUBE_IN_BOX, &["scene.random.direction=downward"]).v_WB.y < 0.0);
}

/// Means of the components and of their squares over many seeds; on SO(3) those of a turned axis.
#[test]
fn directions_and_attitudes_are_uniform() {
    const SEEDS: usize = 4000;
    let base = experiment(CUBE_IN_BOX, &[]);
    let starts: Vec<BodyState> = (0..SEEDS as u64)
        .map(|seed| build(&gotai::experiment::types::Experiment { seed, ..base.clone() }).unwrap().1.bodies[0])
        .collect();
    let directions: [fn(&BodyState) -> Vector3<f64>; 4] =
        [|s| s.v_WB / 4.0, |s| s.w_WB / 6.0, |s| s.q_WB * Vector3::x(), |s| s.q_WB * Vector3::y()];
    for direction in directions {
        for i in 0..3 {
            let mean = |f: &dyn Fn(f64) -> f64| starts.iter().map(|s| f(direction(s)[i])).sum::<f64>() / SEEDS as f64;
            // Five standard deviations: 5 / √(3·4000) and 5 √(4/45) / √4000.
            assert!(mean(&|x| x).abs() < 0.046);
            assert!((mean(&|x| x * x) - 1.0 / 3.0).abs() < 0.024);
        }
    }
}

#[test]
fn an_overlap_at_the_start_is_one_clear_error() {
    let sunk = file(CUBE_IN_BOX, &["scene.bodies.cube.position_m=[0, 0.3, 0]"]);
    let message = single_case(&sunk).unwrap_err().to_string();
    assert!(message.starts_with("--set scene.bodies.cube.position_m="), "{message}");
    assert!(message.contains("expected no overlap") && message.contains("cube inside a face by"), "{message}");
    // Resting on the floor is no overlap.
    let still = ["scene.random=null", "scene.bodies.cube.position_m=[0, 0.5, 0]"];
    assert!(single_case(&file(CUBE_IN_BOX, &still)).is_ok());
}

#[test]
fn the_body_frame_is_where_the_file_says_and_the_centre_of_mass_where_it_follows() {
    let sets = [
        "scene.random=null",
        "scene.bodies.cube.center_of_mass_m=[0.1, 0, 0]",
        "scene.bodies.cube.orientation={axis: [0, 0, 1], angle_deg: 90}",
        "scene.bodies.cube.angular_velocity_body_rad_s=[1, 0, 0]",
    ];
    let (model, state) = build(&experiment(CUBE_IN_BOX, &sets)).unwrap();
    let (body, at) = (&model.bodies[0], &state.bodies[0]);
    assert!((body.p_WBo(at) - Vector3::new(0.0, 2.0, 0.0)).norm() < 1e-15);
    assert!((at.p_WB - Vector3::new(0.0, 2.1, 0.0)).norm() < 1e-15);
    assert!((at.w_WB - Vector3::new(0.0, 1.0, 0.0)).norm() < 1e-15);
}

#[test]
fn euler_angles_turn_about_x_then_y_then_z() {
    let sets = ["scene.random=null", "scene.bodies.cube.orientation={euler_xyz_deg: [90, 90, 0]}"];
    let at = start(CUBE_IN_BOX, &sets);
    // Rx sends y to z, Ry sends z to x.
    assert!((at.q_WB * Vector3::y() - Vector3::x()).norm() < 1e-15);
}
