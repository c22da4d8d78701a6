//! `gotai explain`: what a scene needs, what is skipped and why, and what the sweep will cost.

use super::args::{ExperimentArgs, OutputArgs};
use super::error::CliError;
use super::output::{counted, print, print_json};
use crate::experiment::types::{Shape, Skip};
use crate::plan::{self, Plan, Stage};
use crate::record::sampler::steps_between;
use crate::run::ticks::ticks;
use crate::scene;
use crate::study::{reference, sensitivity, trial};
use crate::sweep::plan::cases;
use crate::sweep::planned::Planned;
use crate::sweep::recordings::{FEW, known_before};
use crate::sweep::runner::targets;
use clap::Args;
use serde_json::json;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// The experiment file (YAML)
    config: PathBuf,
    #[command(flatten)]
    experiment: ExperimentArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// Cost of a sweep, before it is run.
struct Cost {
    cases: usize,
    references: usize,
    steps: u64,
    seconds: f64,
    bytes: u64,
}

/// A stage with the number of cases that have it, and the reasons given, each once.
struct Tally {
    name: &'static str,
    runs: usize,
    skipped: usize,
    whys: Vec<String>,
    /// Least and most of what there is of it in a case.
    sizes: Vec<(&'static str, [usize; 2])>,
    skip: Option<Skip>,
    counter: Option<&'static str>,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let file = self.experiment.load(&self.config)?;
        let cases = cases(&file)?;
        let cost = cost(&cases);
        let tallies = tallies(&cases);
        if self.output.json {
            let stages: Vec<_> = tallies.iter().map(tally_json).collect();
            print_json(&json!({
                "cases": cost.cases, "references": cost.references, "steps": cost.steps,
                "estimated_cpu_s": cost.seconds, "estimated_bytes": cost.bytes, "stages": stages,
            }));
            return Ok(ExitCode::SUCCESS);
        }
        let at_most = if file.search().is_some() { "at most " } else { "" };
        print(format!("{}, {at_most}{}", counted(cost.cases, "case"), counted(cost.steps as usize, "step")));
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let wall_s = cost.seconds / cores.min(cost.cases.max(1)) as f64;
        print(format!("{at_most}about {wall_s:.1} s on {cores} cores (from a trial of some cases)"));
        print(format!("about {:.1} MB of recordings", cost.bytes as f64 / 1e6));
        if cost.references > 0 {
            print(format!(
                "{} reference runs before them, not in this time; those that are there are read",
                cost.references
            ));
        }
        for axis in &file.axes().axes {
            print(format!("  axis {}: {}", axis.path, counted(axis.values.len(), "value")));
        }
        tallies.iter().for_each(|tally| print(describe(tally)));
        Ok(ExitCode::SUCCESS)
    }
}

fn describe(tally: &Tally) -> String {
    let how = match (tally.runs, tally.skipped) {
        (_, 0) => "runs".to_string(),
        (0, _) => "skipped".to_string(),
        (runs, skipped) => format!("runs in {runs} cases, skipped in {skipped}"),
    };
    let size = |(name, [least, most]): &(_, [usize; 2])| match least == most {
        true => format!("{least} {name}"),
        false => format!("{least} to {most} {name}"),
    };
    let mut why = tally.whys.clone();
    why.extend((!tally.sizes.is_empty()).then(|| tally.sizes.iter().map(size).collect::<Vec<_>>().join(", ")));
    let mut text = format!("  {}: {how} — {}", tally.name, why.join("; "));
    let word = |skip: Skip| format!("skip `{}`: {}", skip.word(), skip.bound());
    let shown = [tally.skip.map(word), tally.counter.map(|by| format!("see `{by}`"))];
    let shown: Vec<String> = shown.into_iter().flatten().collect();
    if !shown.is_empty() {
        text += &format!(" ({})", shown.join("; "));
    }
    text
}

fn tally_json(tally: &Tally) -> serde_json::Value {
    let sizes: serde_json::Map<_, _> = tally.sizes.iter().map(|(name, ends)| (name.to_string(), json!(ends))).collect();
    json!({
        "name": tally.name, "runs": tally.runs, "skipped": tally.skipped, "why": tally.whys, "sizes": sizes,
        "skip": tally.skip, "counter": tally.counter,
    })
}

fn tallies(cases: &[Planned]) -> Vec<Tally> {
    let mut tallies: Vec<Tally> = Vec::new();
    for Planned { case, .. } in cases {
        let Ok((model, _)) = scene::build(&case.experiment) else { continue };
        let twins = plan::twins(sensitivity::is_wanted(&case.experiment));
        for stage in Plan::new(&model, &case.experiment.method).stages.into_iter().chain([twins]) {
            match tallies.iter_mut().find(|tally| tally.name == stage.name) {
                Some(tally) => tally.add(stage),
                None => tallies.push(Tally::of(stage)),
            }
        }
    }
    tallies
}

impl Tally {
    fn of(stage: Stage) -> Self {
        let Stage { name, skip, counter, .. } = stage;
        let mut tally = Tally { name, runs: 0, skipped: 0, whys: Vec::new(), sizes: Vec::new(), skip, counter };
        tally.add(stage);
        tally
    }

    fn add(&mut self, stage: Stage) {
        *(if stage.runs { &mut self.runs } else { &mut self.skipped }) += 1;
        if !self.whys.contains(&stage.why) {
            self.whys.push(stage.why);
        }
        for (name, size) in stage.sizes {
            match self.sizes.iter_mut().find(|(known, _)| *known == name) {
                Some((_, [least, most])) => (*least, *most) = ((*least).min(size), (*most).max(size)),
                None => self.sizes.push((name, [size; 2])),
            }
        }
        self.skip = self.skip.or(stage.skip);
        self.counter = self.counter.or(stage.counter);
    }
}

/// Cost of all cases, extrapolated from trials of a few, evenly through the plan.
fn cost(cases: &[Planned]) -> Cost {
    const TRIALS: usize = 12;
    /// Time of all trials together, in seconds: nobody waits longer for an estimate.
    const MOMENT_S: f64 = 1.0;
    let steps = cases.iter().map(|planned| planned.case.experiment.clock().steps * runs(planned)).sum();
    let trials = cases.len().min(TRIALS);
    let tried = (0..trials).map(|i| &cases[i * cases.len() / trials]);
    let seconds = tried.map(|planned| trial_s(planned, MOMENT_S / trials as f64)).sum::<f64>() * cases.len() as f64
        / trials.max(1) as f64;
    let references: BTreeSet<_> = cases.iter().filter_map(|planned| reference::id(&planned.case.experiment)).collect();
    Cost { cases: cases.len(), references: references.len(), steps, seconds, bytes: bytes(cases) }
}

/// Time of all runs of a case or a search, in seconds.
fn trial_s(planned: &Planned, moment_s: f64) -> f64 {
    let experiment = &planned.case.experiment;
    let Ok((model, start)) = scene::build(experiment) else { return 0.0 };
    trial::seconds(experiment, &model, start, moment_s) * runs(planned) as f64
}

/// Number of runs of a case; of a search about how many. All are counted with the steps of the first one, which is
/// mostly the longest.
fn runs(planned: &Planned) -> u64 {
    planned.search.as_ref().map_or(1, |cell| cell.expected_runs() as u64)
}

/// Size of all recordings, in bytes: of a sample in one file, measured with one body and 0 to 8 contacts, zstd level 1.
fn bytes(cases: &[Planned]) -> u64 {
    const OF_A_BODY: u64 = 150;
    const OF_A_CONTACT: u64 = 60;
    const LIKELY_CONTACTS: u64 = 3;
    let Some(Planned { case: first, search: None, .. }) = cases.first() else { return 0 };
    let files = targets(first.experiment.record.to).len() as u64;
    let rule = first.experiment.record.cases;
    let recorded = known_before(rule, cases.len()).map_or(FEW.min(cases.len()), |known| known.len());
    let per_case = |Planned { case, .. }: &Planned| {
        let clock = ticks(&case.experiment);
        let samples = clock.steps / steps_between(&case.experiment.record, &clock) + 1;
        let bodies = &case.experiment.scene.bodies;
        let contacts = bodies.iter().filter(|body| body.shape != Shape::None).count() as u64 * LIKELY_CONTACTS;
        samples * (bodies.len() as u64 * OF_A_BODY + contacts * OF_A_CONTACT)
    };
    let mean = cases.iter().map(per_case).sum::<u64>() / cases.len() as u64;
    mean * recorded as u64 * files
}
