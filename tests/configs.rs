//! Every file under configs/ is an example and a test: all its cases are valid, and it runs (cut short).

use crate::scratch;
use crate::tidy::files;
use gotai::experiment::ExperimentFile;
use gotai::outcome::Outcome;
use gotai::sweep::plan::cases;
use gotai::sweep::runner::build_and_run;
use rayon::prelude::*;

#[test]
fn every_config_runs() {
    let folder = scratch::folder();
    for config in files("configs", "yaml") {
        let name = config.display().to_string();
        let whole = ExperimentFile::load(&config, &[]).unwrap_or_else(|error| panic!("{error}"));
        // The largest maps are small ones with more seeds.
        if whole.axes().len() <= 50_000 {
            let all = cases(&whole).unwrap_or_else(|error| panic!("{error}"));
            assert!(all.iter().all(|planned| planned.case.experiment.question.is_some()), "{name} asks a question");
        }
        // Cut short: one seed, a tenth of a second. A case is recorded, the others are not.
        let mut sets = vec!["time.end_s=0.1".to_string()];
        if whole.axes().axes.iter().any(|axis| axis.path == "seed") {
            sets.push("seed=1".into());
        }
        if let Some(search) = whole.search() {
            sets.push(format!("{}={}", search.critical, search.between[0]));
        }
        let cut = ExperimentFile::load(&config, &sets).unwrap_or_else(|error| panic!("{error}"));
        let cut = cases(&cut).unwrap();
        cut.par_iter().enumerate().for_each(|(i, planned)| {
            let targets = if i == 0 { gotai::record::writer::Target::AVAILABLE } else { &[] };
            let (measured, written) = build_and_run(planned, folder.path(), targets);
            written.unwrap();
            assert_ne!(measured.outcome, Outcome::Failed, "{name}: {:?}", planned.case.axes);
            assert!(measured.energy_end_j.is_some(), "{name}");
        });
    }
}
