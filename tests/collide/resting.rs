//! The new shapes in a run: what lies on the floor of a container stays there.

use crate::yaml::experiment;
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::step::Stepper;
use nalgebra::Vector3;

/// Shape, height of its origin, angle about z, contacts.
const ROWS: [(&str, f64, f64, usize); 6] = [
    ("cylinder: { radius_m: 0.3, height_m: 0.8 }", 0.4, 0.0, 4),
    ("cylinder: { radius_m: 0.3, height_m: 0.8 }", 0.3, 90.0, 2),
    ("capsule: { radius_m: 0.2, height_m: 0.8 }", 0.2, 90.0, 2),
    ("capsule: { radius_m: 0.2, height_m: 0.8 }", 0.6, 0.0, 1),
    ("ellipsoid: { semi_axes_m: [0.3, 0.2, 0.4] }", 0.2, 0.0, 1),
    ("convex: { vertices_m: [[-0.5, 0, -0.5], [0.5, 0, -0.5], [0, 0, 0.7], [0, 0.6, 0]] }", 0.0, 0.0, 3),
];

#[test]
fn a_solid_that_lies_on_the_floor_stays_and_its_contacts_carry_it() {
    for (shape, height_m, angle_deg, contacts) in ROWS {
        let text = format!(
            "
scene:
  friction: 0.5
  container: {{ box: {{ size_m: [4, 4, 4] }} }}
  bodies:
    - name: one
      shape: {{ {shape} }}
      density_kg_m3: 100
      position_m: [0, {height_m}, 0]
      orientation: {{ axis: [0, 0, 1], angle_deg: {angle_deg} }}
method: time-stepping
time: {{ step_s: 0.01, end_s: 1 }}
"
        );
        let experiment = experiment(&text, &[]);
        let (model, start) = build(&experiment).unwrap();
        let clock = experiment.clock();
        let plan = Plan::new(&model, &experiment.method);
        let mut stepper = Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &start);
        let mut state = start.clone();
        while state.step < clock.steps {
            stepper.step(&model, &mut state, &clock);
            assert_eq!(stepper.contacts().len(), contacts, "{shape}");
        }
        let impulse_W: Vector3<f64> = stepper.contacts().iter().map(|solved| solved.impulse_W).sum();
        let weight = model.bodies[0].mass_kg * 9.8 * clock.step_s;
        let (before, after) = (&start.bodies[0], &state.bodies[0]);
        // measured: 1.3e-13 m
        assert!((after.p_WB - before.p_WB).norm() < 1e-11 && after.q_WB.angle_to(&before.q_WB) < 1e-7, "{shape}");
        assert!((impulse_W - Vector3::y() * weight).norm() < 1e-10 * weight, "{shape}: {impulse_W} {weight}");
    }
}
