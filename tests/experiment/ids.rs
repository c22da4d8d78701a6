//! Ids of cases. Rows in folders of results are found by them, so that a case keeps its id as long as it means the
//! same.

use crate::yaml;
use gotai::experiment::ExperimentFile;
use gotai::sweep::plan::cases;
use std::path::Path;

/// Experiment, ids of its first and its last case, as written at version 0.1.0, and since the default solver is `auto`.
const GOLDEN: &[(&str, [&str; 2])] = &[
    ("smoke", ["f685addf71e9db6f", "a87ea50e96ec5318"]),
    ("projectile", ["d4fdd65720c85a89", "7b0844b7f393dd32"]),
    ("lecture/stability", ["76796862837ac1a5", "4f0eeda04bed3d23"]),
    ("lecture/penalty", ["c5ee73b4734b0466", "d5d67106064d40dc"]),
    ("lecture/friction-critical", ["0e041f39ae00fbca", "90e60d569b908148"]),
    ("contact/ball", ["292a4879061f814b", "40c9adae1cd92f64"]),
    ("contact/superball", ["f0b334642f1b33a1", "84f5b9a5370c284c"]),
    ("contact/threshold-tip", ["6deba5a87890293e", "6deba5a87890293e"]),
    ("stack/pile", ["6c3922139e965cca", "6c3922139e965cca"]),
    ("stack/overhang", ["e512f494f3ee4d96", "c6ad9c92d3ccf525"]),
    ("event/cost", ["06f61b40b3ec0617", "5441c9fc8ffaa967"]),
    ("free/heavy-top", ["a1bedadc4af2c5e3", "2ecaeb7b5061006c"]),
    ("free/drag", ["2a917044183314b7", "b6e062738bc7337b"]),
];

#[test]
fn a_case_keeps_its_id() {
    let mut changed = Vec::new();
    for (name, ids) in GOLDEN {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name).with_extension("yaml");
        let planned = cases(&ExperimentFile::load(&path, &[]).unwrap()).unwrap();
        let ends = [planned.first(), planned.last()].map(|planned| planned.unwrap().case.id.clone());
        changed.extend((ends != *ids).then_some((name, ends)));
    }
    assert!(changed.is_empty(), "{changed:?}");
}

const FALLING: &str = "
scene:
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1 }]
method: free
time: { step_s: 0.1, end_s: 1 }
";

/// What a file holds beside its experiment: why it is run, how it is shown, judged and compared.
#[test]
fn an_id_is_of_the_experiment_alone() {
    let id = |more: &str| cases(&yaml::file(&format!("{FALLING}{more}"), &[])).unwrap()[0].case.id.clone();
    let alone = id("");
    for more in [
        "question: why?\n",
        "record: { every_s: 0 }\n",
        "plan: { skip: [] }\n",
        "expect: [{ column: steps, min: 1 }]\n",
        "bench: { repeats: 2, error: steps }\n",
        "sweep: { axes: { seed: [0, 1] } }\n",
    ] {
        assert_eq!(id(more), alone, "{more}");
    }
    assert_ne!(id("seed: 1\n"), alone);
}
