//! The judge of contact: exact solutions pass, wrong ones are found, units do not matter.

use crate::yaml::{CUBE_IN_BOX, experiment, measured};
use gotai::collide::{Contact, SolvedContact};
use gotai::experiment::types::Diverge;
use gotai::measure::Judge;
use gotai::plan::Plan;
use gotai::shown::{Acted, Shown};
use nalgebra::Vector3;

/// A ball on a floor with what it meets it with, SI.
#[derive(Clone, Copy)]
struct Impact {
    mass: f64,
    radius: f64,
    velocity: [f64; 3],
    friction: f64,
    restitution: f64,
    tangential_restitution: f64,
    gravity: f64,
    step: f64,
}

const IMPACT: Impact = Impact {
    mass: 3.0,
    radius: 0.7,
    velocity: [1.3, -2.0, -0.4],
    friction: 0.2,
    restitution: 0.0,
    tangential_restitution: 0.0,
    gravity: 9.8,
    step: 0.01,
};

impl Impact {
    /// In closed form: A is diagonal, 1/m and twice 7/2m. The spin is zero, the ball slips with v.
    fn solved(&self) -> Vector3<f64> {
        let [x, y, z] = self.velocity;
        // Forces act during the step of an impact.
        let rebound = -self.restitution * y.min(0.0);
        let least = if rebound > 0.0 { (rebound - self.gravity * self.step).max(0.0) } else { 0.0 };
        let approach = y - self.gravity * self.step - least;
        let normal = (-self.mass * approach).max(0.0);
        let given_back = if rebound > self.gravity * self.step { self.tangential_restitution } else { 0.0 };
        let stick = Vector3::new(-x, 0.0, -z) * (self.mass * 2.0 / 7.0 * (1.0 + given_back));
        let tangent = stick * (self.friction * normal / stick.norm()).min(1.0);
        tangent + Vector3::new(0.0, normal, 0.0)
    }

    fn residual(&self, impulse_W: Vector3<f64>) -> f64 {
        let Impact { mass, radius, velocity, gravity, .. } = *self;
        let text = format!(
            "
scene:
  gravity_m_s2: [0, {}, 0]
  container: {{ plane: {{ normal: [0, 1, 0] }} }}
  bodies:
    - name: ball
      shape: {{ sphere: {{ radius_m: {radius} }} }}
      mass_kg: {mass}
      position_m: [0, {radius}, 0]
      velocity_m_s: {velocity:?}
time: {{ step_s: {}, end_s: {} }}
",
            -gravity, self.step, self.step
        );
        let experiment = experiment(&text, &[]);
        let (model, start) = gotai::scene::build(&experiment).unwrap();
        let plan = Plan::new(&model, &experiment.method);
        let mut judge = Judge::new(&model, &start, &Diverge::default(), &plan);
        let contact = Contact {
            body: 0,
            other: None,
            feature: (0, 0),
            r_OC_W: Vector3::zeros(),
            r_BC_W: Vector3::new(0.0, -radius, 0.0),
            p_WC: Vector3::zeros(),
            normal: Vector3::y(),
            gap_m: 0.0,
            friction: self.friction,
            restitution: self.restitution,
            tangential_restitution: self.tangential_restitution,
        };
        let contacts = &[SolvedContact { contact, impulse_W }];
        let acted = Acted::Kick { kicked: &start, contacts, step_s: self.step, approach: plan.approach };
        judge.observe(&model, &Shown { before: &start, after: &start, acted, way: None, stalled: None, is_last: true });
        judge.residual.max.unwrap()
    }
}

/// Sticking, slipping, bouncing, at rest, separating, and with a slip that is given back, in part, where friction holds
/// and where it does not, and not without a bounce.
fn impacts() -> [Impact; 10] {
    let back = Impact { tangential_restitution: 0.6, ..IMPACT };
    [
        IMPACT,
        Impact { friction: 2.0, ..IMPACT },
        Impact { friction: 0.0, ..IMPACT },
        Impact { restitution: 0.8, ..IMPACT },
        Impact { velocity: [0.0, 0.0, 0.0], ..IMPACT },
        Impact { velocity: [1.0, 1.0, 0.0], ..IMPACT },
        Impact { restitution: 0.8, friction: 2.0, ..back },
        Impact { restitution: 0.8, friction: 2.0, tangential_restitution: 1.0, ..IMPACT },
        Impact { restitution: 0.8, ..back },
        Impact { friction: 2.0, ..back },
    ]
}

#[test]
fn an_exact_impulse_has_no_residual() {
    for impact in impacts() {
        let residual = impact.residual(impact.solved());
        // measured: 3.5e-17 at most
        assert!(residual < 1e-15, "{:?} {}: {residual}", impact.velocity, impact.friction);
    }
}

/// Without friction the cone is a line: what is on its other half is outside.
#[test]
fn a_contact_that_pulls_is_found() {
    let leaving = Impact { velocity: [0.0, 1.0, 0.0], friction: 0.0, ..IMPACT };
    assert!(leaving.residual(Vector3::new(0.0, -2.7, 0.0)) > 0.1);
}

#[test]
fn a_wrong_impulse_is_found() {
    let exact = IMPACT.solved();
    let wrong = [
        ("none", Vector3::zeros()),
        ("half", exact / 2.0),
        ("twice", exact * 2.0),
        ("no friction", Vector3::new(0.0, exact.y, 0.0)),
        ("friction the other way", Vector3::new(-exact.x, exact.y, -exact.z)),
        ("friction askew", Vector3::new(exact.z, exact.y, exact.x)),
    ];
    for (what, impulse) in wrong {
        let residual = IMPACT.residual(impulse);
        // measured: 0.080 (twice) … 0.98 (none)
        assert!(residual > 0.05, "{what}: {residual}");
    }
    let pulled = Impact { velocity: [0.0, 1.0, 0.0], ..IMPACT }.residual(Vector3::new(0.0, -1.0, 0.0));
    // measured: 1
    assert!(pulled > 0.5, "{pulled}");
}

/// Masses × 8, lengths × 2, times × 4: nothing that has a unit is left. Powers of ten leave rounding.
#[test]
fn the_residual_has_no_unit() {
    for (mass, length, time, bound) in [(8.0, 2.0, 4.0, 0.0), (1e6, 1e-3, 1e-2, 1e-12)] {
        let scaled = |impact: &Impact| Impact {
            mass: impact.mass * mass,
            radius: impact.radius * length,
            velocity: impact.velocity.map(|v| v * length / time),
            gravity: impact.gravity * length / (time * time),
            step: impact.step * time,
            ..*impact
        };
        for impact in impacts() {
            let impulse = impact.solved() * 0.9 + Vector3::new(0.1, 0.0, 0.0);
            let (one, other) = (impact.residual(impulse), scaled(&impact).residual(impulse * (mass * length / time)));
            // measured: 0 and 3.6e-15
            assert!((other / one - 1.0).abs() <= bound, "{mass}: {one} {other}");
        }
    }
}

const FLAT: [&str; 5] = [
    "scene.random=null",
    "scene.bodies.cube.position_m=[0, 0.5, 0]",
    "scene.bodies.cube.velocity_m_s=[1, -2, 0.5]",
    "scene.bodies.cube.angular_velocity_rad_s=[0.3, 0.1, -0.2]",
    "time.end_s=0.01",
];

#[test]
fn more_sweeps_leave_less_residual() {
    let residual = |sweeps: u32| {
        let method = format!("method={{time-stepping: {{solver: pgs, sweeps: {sweeps}, tolerance: 0}}}}");
        measured(CUBE_IN_BOX, &[&FLAT[..], &[&method]].concat()).residual_max.unwrap()
    };
    let residuals = [1, 4, 16, 64, 256].map(residual);
    assert!(residuals.windows(2).all(|pair| pair[1] < pair[0] || pair[1] < 1e-14), "{residuals:?}");
    // measured: 0.19, 1.1e-2, 1.1e-5, 1.5e-16, 1.6e-16
    assert!(residuals[0] > 1e-3 && residuals[4] < 1e-14, "{residuals:?}");
}

#[test]
fn only_those_who_claim_to_solve_contact_are_judged() {
    let of = |method: &str, sets: &[&str]| measured(CUBE_IN_BOX, &[sets, &[method]].concat()).residual_max;
    assert_eq!(of("method=free", &[]), None);
    assert_eq!(of("method={penalty: {stiffness_n_m: 1e4}}", &[]), None);
    assert_eq!(of("method=time-stepping", &["time.end_s=0.01"]), None, "no contact yet");
    // measured: 1.77 and 6.1e-6
    let (lecture, sound) = (of("method=lecture", &[]).unwrap(), of("method=time-stepping", &[]).unwrap());
    assert!(lecture > 0.1 && sound < 1e-3, "{lecture} {sound}");
}
