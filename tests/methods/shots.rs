//! Shots: fast bodies at thin ones, which spin up as they are hit and turn many times within a step. Kinds that
//! `.ci/shots.py` found, as they were found.

use crate::yaml::measured;
use gotai::outcome::Outcome;

/// What flies at what, and the scene.
const SHOTS: &[(&str, &str)] = &[
    (
        "a rod that its face alone meets spins up in the step",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.3
  restitution: 0
  bodies:
    - { name: shot, shape: { box: { size_m: [0.654369, 0.032718, 0.032718] } }, mass_kg: 0.026818,
        position_m: [45.566333, -26.848197, -32.672246], velocity_m_s: [-811.180914, 481.895138, 579.917627],
        orientation: { axis: [-0.600977, -0.500778, 0.622933], angle_deg: 74.402674 } }
    - { name: target, shape: { box: { size_m: [0.005290, 2, 2] } }, mass_kg: 0.944440, position_m: [0, 0, 0],
        angular_velocity_rad_s: [0, 2.858502, 0] }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.01, end_s: 0.08 }
",
    ),
    (
        "a thin plate around a beam",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0
  restitution: 0
  bodies:
    - { name: shot, shape: { box: { size_m: [0.283284, 0.001476, 0.283284] } }, mass_kg: 0.046940,
        position_m: [-30.096320, -5.743884, 69.072211], velocity_m_s: [603.493207, 116.591681, -1374.938233],
        orientation: { axis: [-0.464846, -0.580357, -0.668657], angle_deg: 74.524990 } }
    - { name: target, shape: { box: { size_m: [4.111952, 0.205597, 0.205597] } }, mass_kg: 0.780396,
        position_m: [0, 0, 0], fixed: true }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.01, end_s: 0.12 }
",
    ),
    (
        "a rod at 5e4 rad/s beside a thin plate",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.8
  restitution: 0
  bodies:
    - { name: shot, shape: { box: { size_m: [0.351448, 0.017572, 0.017572] } }, mass_kg: 0.683152,
        position_m: [40.960749, -166.319300, -123.669616], velocity_m_s: [-374.229291, 1526.703241, 1138.462047],
        angular_velocity_rad_s: [0.031198, -0.986819, 0.158791],
        orientation: { axis: [0.023996, 0.684676, 0.728452], angle_deg: 141.150395 } }
    - { name: target, shape: { box: { size_m: [0.000452, 2, 2] } }, mass_kg: 2.068762, position_m: [0, 0, 0],
        fixed: true }
method: { time-stepping: { solver: pgs } }
time: { step_s: 0.016, end_s: 0.176 }
",
    ),
    (
        "a capsule that rolls and spins on a plate",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.8
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.000566, 2, 2] } }, mass_kg: 0.149268, position_m: [0, 0, 0],
        angular_velocity_rad_s: [0, -0.170446, 1.033129] }
    - { name: shot, shape: { capsule: { radius_m: 0.061637, height_m: 0.283904 } }, mass_kg: 0.124066,
        position_m: [14.650529, -6.608993, 26.551730], velocity_m_s: [-195.569095, 87.800490, -355.748524],
        orientation: { axis: [0.077960, 0.914594, -0.396786], angle_deg: 41.740280 } }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.016, end_s: 0.14400000000000002 }
",
    ),
    (
        "a thin plate at a can",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.3
  restitution: 0
  bodies:
    - { name: shot, shape: { box: { size_m: [0.510499, 0.004370, 0.510499] } }, mass_kg: 0.081349,
        position_m: [-1.628258, -5.158069, 0.322050], velocity_m_s: [260.660452, 668.249663, -68.177348],
        orientation: { axis: [-0.862974, -0.407296, -0.298972], angle_deg: 57.300208 } }
    - { name: target, shape: { cylinder: { radius_m: 0.522092, height_m: 2.014487 } }, mass_kg: 0.690906,
        position_m: [0, 0, 0] }
method: { time-stepping: { solver: newton, scheme: moreau } }
time: { step_s: 0.001, end_s: 0.007 }
",
    ),
    (
        "a thin plate that slides along a corner",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.016138, 2, 2] } }, mass_kg: 0.563992, position_m: [0, 0, 0],
        angular_velocity_rad_s: [1.318239, 0, 0] }
    - { name: shot, shape: { box: { size_m: [0.927191, 0.001163, 0.927191] } }, mass_kg: 0.010717,
        position_m: [11.199792, -31.347342, 70.523403], velocity_m_s: [-94.039122, 263.538732, -594.271913],
        angular_velocity_rad_s: [0.533637, -20.074912, 14.587040],
        orientation: { axis: [0.919258, 0.220237, -0.326280], angle_deg: 109.893324 } }
method: { time-stepping: { solver: newton, impact: poisson } }
time: { step_s: 0.016, end_s: 0.176 }
",
    ),
    (
        "a rod that spins for hundreds of turns in a step",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.3
  restitution: 1
  bodies:
    - { name: target, shape: { box: { size_m: [0.000123, 2, 2] } }, mass_kg: 0.154297, position_m: [0, 0, 0],
        angular_velocity_rad_s: [-2.013608, -0.647679, 0] }
    - { name: shot, shape: { box: { size_m: [0.709122, 0.035456, 0.035456] } }, mass_kg: 0.051202,
        position_m: [66.018771, 8.595839, 26.248636], velocity_m_s: [-1590.770012, -211.515259, -626.727896],
        angular_velocity_rad_s: [0.955492, -0.149205, -0.254501],
        orientation: { axis: [-0.097462, 0.816710, -0.568757], angle_deg: 140.942272 } }
method: { time-stepping: { solver: newton, impact: poisson } }
time: { step_s: 0.01, end_s: 0.12 }
",
    ),
    (
        "balls of which one comes from far",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.8
  restitution: 0
  bodies:
    - { name: shot, shape: { sphere: { radius_m: 0.079490 } }, mass_kg: 0.641304,
        position_m: [-17.881438, -47.345072, 38.077711], velocity_m_s: [490.907659, 1320.714192, -1053.707602],
        orientation: { axis: [0.908451, -0.408596, 0.088122], angle_deg: 118.115956 } }
    - { name: target, shape: { sphere: { radius_m: 0.523996 } }, mass_kg: 0.225699, position_m: [0, 0, 0],
        angular_velocity_rad_s: [0, 0, -0.558743] }
method: { time-stepping: { solver: pgs } }
time: { step_s: 0.016, end_s: 0.096 }
",
    ),
    (
        "a plate that tumbles over a plate of a tenth of a millimetre",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.8
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.000131, 2, 2] } }, mass_kg: 0.860060, position_m: [0, 0, 0],
        fixed: true }
    - { name: shot, shape: { box: { size_m: [0.591691, 0.001251, 0.591691] } }, mass_kg: 0.035936,
        position_m: [16.639236, 11.132370, 23.142731], velocity_m_s: [-761.713843, -490.916521, -1046.040077],
        angular_velocity_rad_s: [0.833858, -0.098902, 0.543044],
        orientation: { axis: [0.614204, 0.770600, 0.170080], angle_deg: 74.504308 } }
method: { time-stepping: { solver: pgs } }
time: { step_s: 0.005, end_s: 0.03 }
",
    ),
    (
        "a block that a plate turns into at the end of a step",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0
  restitution: 0.5
  bodies:
    - { name: target, shape: { box: { size_m: [0.000368, 2, 2] } }, mass_kg: 0.816339, position_m: [0, 0, 0],
        angular_velocity_rad_s: [0.0, 0.079833, 1.37412] }
    - { name: shot, shape: { box: { size_m: [0.070122, 0.072568, 0.06131] } }, mass_kg: 0.177667,
        position_m: [-2.081918, -2.018514, 9.093938], velocity_m_s: [61.789578, 62.214812, -252.783874],
        angular_velocity_rad_s: [0.343941, -0.911903, -0.223913], orientation: { axis: [0.284395, -0.309577,
        -0.907349], angle_deg: 154.765588 } }
method: { time-stepping: { solver: newton, scheme: moreau } }
time: { step_s: 0.01, end_s: 0.06 }
",
    ),
    (
        "a rod that turns into a plate at the end of a step",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.3
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.004048, 2, 2] } }, mass_kg: 0.124625, position_m: [0, 0, 0],
        fixed: true }
    - { name: shot, shape: { box: { size_m: [0.240166, 0.012008, 0.012008] } }, mass_kg: 0.01162,
        position_m: [-27.709045, 8.038828, 5.550134], velocity_m_s: [421.454427, -121.761773, -84.267469],
        angular_velocity_rad_s: [-163.650333, 179.893247, 89.531883], orientation: { axis: [-0.224818,
        -0.813703, 0.536045], angle_deg: 64.805333 } }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.016, end_s: 0.16 }
",
    ),
    (
        "a rod that lies down on a plate at the end of a step",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.3
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.004211, 2, 2] } }, mass_kg: 4.6426, position_m: [0, 0, 0],
        fixed: true }
    - { name: shot, shape: { box: { size_m: [0.437211, 0.021861, 0.021861] } }, mass_kg: 0.024725,
        position_m: [-18.498651, -11.77603, -2.279442], velocity_m_s: [296.38132, 187.360333, 32.345898],
        angular_velocity_rad_s: [0.367873, 0.329838, 0.869411], orientation: { axis: [-0.133663, 0.989095,
        0.061848], angle_deg: 102.561576 } }
method: { time-stepping: { solver: newton, impact: poisson } }
time: { step_s: 0.01, end_s: 0.11 }
",
    ),
    (
        "a plate that spins along a thin one for hundreds of parts of a step",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.8
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.000208, 2, 2] } }, mass_kg: 0.619829, position_m: [0, 0,
        0], angular_velocity_rad_s: [-2.672108, 0, 0] }
    - { name: shot, shape: { box: { size_m: [0.103294, 0.001676, 0.103294] } },
        mass_kg: 0.016435, position_m: [-38.007796, -42.818429, -24.517856], velocity_m_s: [1018.995138,
        1133.774433, 651.114052], angular_velocity_rad_s: [-3.053204, 2.972328, -3.23476],
        orientation: { axis: [0.056955, 0.244257, -0.968036], angle_deg: 81.888528 } }
method: { time-stepping: { solver: pgs } }
time: { step_s: 0.016, end_s: 0.096 }
",
    ),
    (
        "a rod whose turn is told by where its overlap was taken away",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.042225, 2, 2] } }, mass_kg: 0.34991, position_m: [0, 0,
        0], angular_velocity_rad_s: [0, 0, 0.039568] }
    - { name: shot, shape: { box: { size_m: [1.081261, 0.054063, 0.054063] } },
        mass_kg: 0.068246, position_m: [-18.357734, 26.413011, 44.380903], velocity_m_s: [366.510191,
        -524.230045, -888.076061], angular_velocity_rad_s: [0.490577, -0.810787, -0.319309],
        orientation: { axis: [-0.101635, 0.89139, -0.441695], angle_deg: 175.068211 } }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.005, end_s: 0.06 }
",
    ),
    (
        "a rod on an ellipsoid, of which the same holds",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.8
  restitution: 0
  bodies:
    - { name: target, shape: { ellipsoid: { semi_axes_m: [0.718, 0.442369, 0.407224] } },
        mass_kg: 3.108136, position_m: [0, 0, 0], fixed: true }
    - { name: shot, shape: { box: { size_m: [0.820569, 0.041028, 0.041028] } },
        mass_kg: 0.111943, position_m: [9.679179, -4.69088, -1.471705], velocity_m_s: [-231.467726,
        113.733265, 42.448899], angular_velocity_rad_s: [0, 0, 0], orientation: { axis: [-0.259839,
        0.409212, 0.874659], angle_deg: 175.344546 } }
method: { time-stepping: { solver: newton, impact: poisson } }
time: { step_s: 0.005, end_s: 0.05 }
",
    ),
    (
        "a capsule of two metres that turns by a quarter of a radian in a step",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0
  restitution: 0
  bodies:
    - { name: shot, shape: { capsule: { radius_m: 0.004927, height_m: 2 } }, mass_kg: 0.105751,
        position_m: [-1.033211, -0.489134, -0.092877], velocity_m_s: [1.6452, 0.321854,
        0.175077], angular_velocity_rad_s: [16.318123, -4.0937, -18.47079], orientation: { axis: [0.320635,
        0.258961, -0.911116], angle_deg: 74.889109 } }
    - { name: target, shape: { box: { size_m: [0.041459, 2, 2] } }, mass_kg: 0.109943, position_m: [0, 0,
        0], fixed: true }
method: { time-stepping: { solver: pgs } }
time: { step_s: 0.016, end_s: 0.16 }
",
    ),
    (
        "a rod that spins about itself as overlap is taken away",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.8
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.007219, 2, 2] } }, mass_kg: 1.022197, position_m: [0, 0,
        0], fixed: true }
    - { name: shot, shape: { box: { size_m: [0.3, 0.001508, 0.001508] } }, mass_kg: 0.016367,
        position_m: [-2.371719, 0.22085, -2.420042], velocity_m_s: [179.434888, -35.223373,
        221.191171], angular_velocity_rad_s: [91.851745, 133.917455, 142.677487],
        orientation: { axis: [-0.556636, 0.580431, 0.594354], angle_deg: 78.716758 } }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.005, end_s: 0.045 }
",
    ),
    (
        "a rod that a plate carries along",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0
  restitution: 0
  bodies:
    - { name: target, shape: { box: { size_m: [0.004639, 2, 2] } }, mass_kg: 4.982134, position_m: [0, 0,
        0], angular_velocity_rad_s: [-0.041706, 0, 25.022991] }
    - { name: shot, shape: { capsule: { radius_m: 0.002006, height_m: 0.3 } }, mass_kg: 0.171446,
        position_m: [5.652794, 3.679565, 3.017281], velocity_m_s: [-201.368504, -138.487559,
        -98.6236], angular_velocity_rad_s: [280.504894, -168.489528, -219.989651],
        orientation: { axis: [0.659171, 0.737447, -0.147192], angle_deg: 162.080747 } }
method: { time-stepping: { solver: pgs } }
time: { step_s: 0.005, end_s: 0.04 }
",
    ),
];

#[test]
fn what_spins_up_within_a_step_passes_nothing() {
    for (shot, text) in SHOTS {
        let ended = measured(text, &[]);
        assert_eq!((ended.outcome, ended.passed_through), (Outcome::Finished, Some(0)), "{shot}");
        assert!(ended.work.contact_solves > 0, "{shot}");
        if !text.contains("fixed: true") {
            // Measured: 0.
            assert!(ended.linear_momentum_drift_rel.unwrap().abs() < 1e-12, "{shot}");
        }
    }
}
