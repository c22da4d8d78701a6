//! Work is counted in integers and held exactly: a change that makes more of it shows here.

use crate::yaml::{CUBE_IN_BOX, measured};

#[test]
fn the_work_of_a_run_is_known() {
    let counters = |sets: &[&str]| {
        let m = measured(CUBE_IN_BOX, &[sets, &["diverge.escape=false"]].concat());
        [m.work.contact_tests, m.work.contacts, m.work.contact_solves, m.work.sweeps, m.work.gyroscopic]
    };
    assert_eq!(counters(&["method=free"]), [0, 0, 0, 0, 200]);
    assert_eq!(counters(&["method=free", "method.free.integrator=rk4"]), [0, 0, 0, 0, 800]);
    assert_eq!(counters(&["method=lecture"]), [7371, 179, 80, 2448, 0]);
    assert_eq!(counters(&["method={time-stepping: {solver: pgs}}"]), [8613, 1592, 156, 3211, 350]);
    assert_eq!(counters(&["method=time-stepping"]), [8613, 1259, 156, 993, 350]);
    let m = measured(CUBE_IN_BOX, &["method=time-stepping", "diverge.escape=false"]);
    assert_eq!([m.work.kept_solves, m.work.exact_solves, m.work.newton_steps], [92, 64, 4313]);
}
