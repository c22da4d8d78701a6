//! What is compiled: the program, and the program as its tests see it.

use std::collections::BTreeSet;
use std::process::Command;

/// Crates with their versions and features, along the edges of `kinds`.
fn crates(kinds: &str) -> BTreeSet<String> {
    let mut command = Command::new(env!("CARGO"));
    command.args(["tree", "--locked", "--offline", "--prefix", "none", "--format", "{p} {f}", "--edges", kinds]);
    let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| line.trim_end_matches(" (*)").to_owned()).filter(|line| line.contains(" v")).collect()
}

/// Otherwise the tests would judge other bits than the program's, and everything would be compiled twice.
#[test]
fn tests_add_no_feature_to_a_crate_of_the_program() {
    let (program, tests) = (crates("normal,no-proc-macro"), crates("normal,dev,no-proc-macro"));
    assert_eq!(program.difference(&tests).collect::<Vec<_>>(), Vec::<&String>::new());
    let named = |line: &String| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    let of_program: BTreeSet<_> = program.iter().map(named).collect();
    let twice: Vec<_> = tests.difference(&program).filter(|line| of_program.contains(&named(line))).collect();
    assert_eq!(twice, Vec::<&String>::new());
}

/// A step has the same bits on every host: no crate of it follows the host's libm or its instructions.
#[test]
fn numbers_of_a_step_are_made_by_portable_code() {
    let program = crates("normal");
    let of = |name: &str| program.iter().find(|line| line.starts_with(&format!("{name} v")));
    assert!(of("nalgebra").unwrap().contains("libm-force"));
    assert!(of("simba").unwrap().contains("libm_force"));
    for name in ["faer", "pulp", "parry3d", "parry3d-f64", "glamx"] {
        assert_eq!(of(name), None);
    }
}
