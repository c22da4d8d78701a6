//! The same run whoever looks, and however often.

use crate::scratch;
use crate::sweep::{planned, sweep};
use crate::yaml::{CUBE_IN_BOX, experiment, run};
use gotai::record::writer::Target;

#[test]
fn two_runs_are_the_same_to_the_bit() {
    for e in ["0", "0.5", "0.95"] {
        let sets = [format!("scene.restitution={e}"), "method=event-driven".into()];
        let runs = [(); 2].map(|()| run(&experiment(CUBE_IN_BOX, &sets.each_ref().map(String::as_str))));
        assert_eq!(runs[0].state, runs[1].state);
        assert_eq!(runs[0].measured.without_wall_time(), runs[1].measured.without_wall_time());
    }
}

#[test]
fn a_recorder_changes_nothing() {
    let text = CUBE_IN_BOX.replace("time: { step_s: 0.01, end_s: 2.0 }", "time: { end_s: 2.0 }");
    for e in ["0", "0.5"] {
        for every in ["0.003", "0.1", "5"] {
            let folder = scratch::folder();
            let sets = [
                "method=event-driven",
                "measure=[state]",
                &format!("scene.restitution={e}"),
                &format!("record.every_s={every}"),
            ];
            let (_, rows) = sweep(&planned(&text, &sets), folder.path(), Target::AVAILABLE);
            let alone = run(&experiment(&text, &sets)).measured;
            assert!(!alone.more.is_empty());
            assert_eq!(rows[0].measured.without_wall_time(), alone.without_wall_time(), "{e}, {every}");
        }
    }
}
