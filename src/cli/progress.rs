//! Progress on stderr: a bar with the tally of outcomes, rate and time left, only on a terminal; or events as JSON
//! lines.

use super::args::OutputArgs;
use super::output::{Hue, ProgressFlag, say};
use crate::outcome::Outcome;
use crate::sweep::runner::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};
use std::time::Duration;

/// Progress of one file.
pub struct Bar {
    bar: Mutex<ProgressBar>,
    /// The file, as it was given.
    file: String,
    shown: ProgressFlag,
    is_colored: bool,
    /// Cases of each outcome, in the order of `Outcome::ALL`.
    tally: [AtomicUsize; Outcome::ALL.len()],
    total: AtomicUsize,
    stops_at_failure: bool,
    is_stopped: AtomicBool,
}

/// Most letters of a file's name beside a bar.
const NAME: usize = 24;

impl Bar {
    pub(super) fn new(file: &Path, output: OutputArgs, how: ProgressFlag) -> Self {
        Bar {
            bar: Mutex::new(ProgressBar::hidden()),
            file: file.display().to_string(),
            // What a program has asked for is no noise.
            shown: if output.quiet && how == ProgressFlag::Auto { ProgressFlag::None } else { how },
            is_colored: output.color.is_on(&std::io::stderr()),
            tally: Default::default(),
            total: AtomicUsize::new(0),
            stops_at_failure: false,
            is_stopped: AtomicBool::new(false),
        }
    }

    /// A bar that lets no further case begin once one has failed.
    pub(super) fn stopping_at_failure(self, stops_at_failure: bool) -> Self {
        Bar { stops_at_failure, ..self }
    }

    fn current(&self) -> MutexGuard<'_, ProgressBar> {
        self.bar.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn counts(&self) -> impl Iterator<Item = (Outcome, usize)> {
        Outcome::ALL.into_iter().zip(self.tally.iter().map(|count| count.load(Ordering::Relaxed)))
    }

    /// Outcomes that there are, with their numbers.
    fn tallied(&self) -> String {
        let counts = self.counts().filter(|(_, count)| *count > 0);
        let said = counts.map(|(outcome, count)| {
            let hue = match outcome {
                Outcome::Finished => Hue::Good,
                Outcome::Diverged | Outcome::Stalled => Hue::Doubtful,
                Outcome::Failed => Hue::Bad,
            };
            hue.paint(&format!("{count} {}", outcome.name()), self.is_colored)
        });
        said.collect::<Vec<_>>().join(" · ")
    }

    fn event(&self, event: &str, more: &[(&str, Value)]) {
        if self.shown == ProgressFlag::Json {
            let mut said = json!({ "event": event, "file": self.file });
            for (key, value) in more {
                said[key] = value.clone();
            }
            say(said);
        }
    }

    fn name(&self) -> String {
        let name = Path::new(&self.file).file_name().map(|name| name.to_string_lossy().into_owned());
        let name = name.unwrap_or_else(|| self.file.clone());
        if name.chars().count() <= NAME { name } else { name.chars().take(NAME - 1).chain(['…']).collect() }
    }
}

impl Progress for Bar {
    fn begin(&self, what: &str, total: usize) {
        self.total.store(total, Ordering::Relaxed);
        self.event("begin", &[("what", what.into()), ("total", total.into())]);
        // indicatif hides the bar by itself where stderr is no terminal.
        let target = match self.shown {
            ProgressFlag::Auto => ProgressDrawTarget::stderr(),
            ProgressFlag::Json | ProgressFlag::None => ProgressDrawTarget::hidden(),
        };
        let bar = ProgressBar::with_draw_target(Some(total as u64), target);
        // Of 80 columns: a name of 24, a bar of 12, numbers and the time left; the tally on a line of its own.
        let style = "{prefix} {pos}/{len} [{bar:12}] {rate} {eta} left\n{msg}";
        if let Ok(style) = ProgressStyle::with_template(style) {
            let rate = |state: &ProgressState, out: &mut dyn Write| {
                // A bar has no one to report a failed write to.
                let _ = write!(out, "{:.1}/s", state.per_sec());
            };
            bar.set_style(style.with_key("rate", rate).progress_chars("=> "));
        }
        bar.set_prefix(format!("{}: {what}", self.name()));
        bar.set_message(self.tallied());
        bar.enable_steady_tick(Duration::from_millis(200));
        *self.current() = bar;
    }

    fn one_done(&self) {
        self.current().inc(1);
    }

    fn case_ended(&self, id: &str, outcome: Outcome) {
        let counted = self.tally.iter().zip(Outcome::ALL).find(|(_, of)| *of == outcome);
        if let Some((count, _)) = counted {
            count.fetch_add(1, Ordering::Relaxed);
        }
        if self.stops_at_failure && outcome == Outcome::Failed {
            self.is_stopped.store(true, Ordering::Relaxed);
        }
        let bar = self.current();
        if self.shown == ProgressFlag::Json {
            let counts: Vec<(&str, Value)> = self.counts().map(|(of, n)| (of.name(), n.into())).collect();
            let done: usize = self.counts().map(|(_, count)| count).sum();
            let total = self.total.load(Ordering::Relaxed);
            let own = [("case", id.into()), ("outcome", outcome.name().into()), ("done", done.into())];
            self.event("case", &[&own[..], &[("total", total.into())], &counts].concat());
        }
        bar.set_message(self.tallied());
        bar.inc(1);
    }

    fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    fn end(&self) {
        self.event("end", &[]);
        self.current().finish_and_clear();
    }
}
