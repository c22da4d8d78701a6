//! Same case, same bits: for any number of threads, recorders on or off.

use super::{SWEEP, planned, sweep};
use crate::scratch;
use gotai::digest::sha256;
use gotai::record::writer::Target;
use gotai::rows::Row;

fn hash(rows: &[Row]) -> String {
    let bits: Vec<Row> = rows
        .iter()
        .map(|row| Row { measured: row.measured.without_wall_time().into(), recording: None, ..row.clone() })
        .collect();
    sha256(serde_json::to_vec(&bits).unwrap(), 32)
}

fn rows(threads: usize, targets: &[Target], sets: &[&str]) -> Vec<Row> {
    let folder = scratch::folder();
    let cases = planned(SWEEP, sets);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| sweep(&cases, folder.path(), targets)).1
}

#[test]
fn threads_and_recorders_change_no_bit() {
    let one = rows(1, &[], &[]);
    assert!(one.iter().any(|row| row.measured.criterion.is_some()), "some case explodes");
    let reference = hash(&one);
    assert_eq!(hash(&rows(2, &[], &[])), reference);
    assert_eq!(hash(&rows(2, Target::AVAILABLE, &[])), reference);
    assert_eq!(hash(&rows(1, Target::AVAILABLE, &["record.every_s=0"])), reference);
}
