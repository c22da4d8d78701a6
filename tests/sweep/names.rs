//! Names of recordings: for people, unique, safe on every file system.

use gotai::outcome::Outcome;
use gotai::record::name::RecordingName;
use gotai::sweep::plan::SweepPlan;
use std::collections::HashSet;

const BALL: &str = "
scene: { bodies: [{ name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 1, 0] }] }
method: free
time: { step_s: 0.01, end_s: 0.1 }
";

/// Of the first case, should it finish.
fn first_name(axes: &str) -> String {
    let file = crate::yaml::file(&format!("{BALL}sweep: {{ axes: {axes} }}\n"), &[]);
    let plan = SweepPlan::unbuilt(&file, "my_config").unwrap();
    let name = plan.cases[0].name.ended(Outcome::Finished);
    let id = &plan.cases[0].case.id[..8];
    name.strip_suffix(&format!("_finished.{id}")).unwrap_or_else(|| panic!("{name} {id}")).to_string()
}

#[test]
fn values_stand_as_people_write_them() {
    for (axes, values) in [
        ("{}", "my-config"),
        ("{ time.step_s: [0.01] }", "my-config"),
        ("{ time.step_s: [0.01, 0.02] }", "0.01"),
        ("{ time.step_s: [1e-5, 0.02] }", "1e-5"),
        ("{ time.step_s: [1.0, 0.02] }", "1"),
        ("{ seed: [7], time.step_s: [0.01, 0.02] }", "0.01"),
        ("{ time.step_s: [0.01, 0.02], seed: [7, 8] }", "0.01_7"),
        ("{ method: [free, event-driven] }", "free"),
        ("{ method: [{ free: { integrator: rk4 } }, free] }", "v0"),
        ("{ method: [{ label: \"Störmer & Co/2\", value: free }, event-driven] }", "St-rmer---Co-2"),
        ("{ scene.bodies.ball.velocity_m_s: [[1, 0, 0], [2, 0, 0]] }", "v0"),
        ("{ scene.bodies.ball.position_m.1: [-1.5, 2] }", "-1.5"),
        ("{ diverge.escape: [true, false] }", "true"),
        ("{ scene.bodies.ball.mesh: [null, { subdivisions: 1 }] }", "v0"),
    ] {
        assert_eq!(first_name(axes), values, "{axes}");
    }
    let long = format!("{{ method: [{{ label: {}, value: free }}, event-driven] }}", "x".repeat(200));
    let name = first_name(&long);
    assert!(name.len() == 97 && name.ends_with("xx~"), "{name}");
}

/// 10,000 random labels on random axes; a hundred sweeps of a hundred cases.
#[test]
fn names_are_unique_safe_and_short() {
    let mut random = 1_u64;
    let mut next = move |below: u64| {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (random >> 33) % below
    };
    let mut names = HashSet::new();
    let mut longest = 0;
    for sweep in 0..100 {
        let mut label = || -> String {
            let kinds = ["ab_Z9.+-=", "/\\:*?\"<>|", "äöü剛体🧊", " \t~%$", "..", "CON", "-"];
            let len = if next(20) == 0 { 300 } else { next(40) };
            (0..=len).map(|_| kinds[next(7) as usize].chars().nth(next(9) as usize).unwrap_or('q')).collect()
        };
        let values: Vec<String> = (0..100)
            .map(|i| {
                // What tells them apart stands in front, or where it may be cut.
                let label = if sweep % 2 == 0 { format!("{i}{}", label()) } else { format!("{}{i}", label()) };
                format!("{{ label: {}, value: {} }}", serde_json::to_string(&label).unwrap(), sweep * 100 + i)
            })
            .collect();
        let text = format!("{BALL}sweep: {{ axes: {{ seed: [{}] }} }}\n", values.join(", "));
        for planned in SweepPlan::unbuilt(&crate::yaml::file(&text, &[]), "test").unwrap().cases {
            for outcome in Outcome::ALL {
                let name = format!("{}.mcap", planned.name.ended(outcome));
                let is_safe = |c: char| c.is_ascii_alphanumeric() || ".+-=_~".contains(c);
                assert!(name.len() <= 120 && name.chars().all(is_safe), "{name}");
                longest = longest.max(name.len());
                assert!(names.insert(name.clone()), "{name} twice");
                let values = RecordingName::values_of(name.strip_suffix(".mcap").unwrap()).unwrap();
                assert!(name.starts_with(values) && values.len() < name.len() - 9, "{name}: {values}");
            }
        }
    }
    assert!(longest == 120 && names.len() == 40_000, "{longest} {}", names.len());
}

/// Ids that begin alike are as good as never met: here the names are, with values cut away.
#[test]
fn cases_that_would_share_a_name_are_told_apart() {
    let labels: Vec<_> = (0..2).map(|i| format!("{{ label: {}{i}, value: {i} }}", "y".repeat(150))).collect();
    let file = crate::yaml::file(&format!("{BALL}sweep: {{ axes: {{ seed: [{}] }} }}\n", labels.join(", ")), &[]);
    let cases = SweepPlan::unbuilt(&file, "test").unwrap().cases;
    assert_ne!(cases[0].name, cases[1].name);
    // The same case twice on the axes (`seed` decides nothing where nothing is drawn, and is still another id).
    assert_ne!(cases[0].case.id, cases[1].case.id);
}
