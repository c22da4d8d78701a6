//! Reports of folders and files: what they hold as a subject, and their page and pictures.

use super::error::CliError;
use super::output::say;
use crate::build_info::{BUILD, PROGRAM};
use crate::check::{Cells, Judged, Magnitudes, Schema, judge};
use crate::experiment::ExperimentFile;
use crate::experiment::filter::shown_cell;
use crate::experiment::types::Experiment;
use crate::files::{self, FileError, write_whole};
use crate::outcome::Outcome;
use crate::report::choose::figures;
use crate::report::figure::Figure;
use crate::report::frame::RowFrame;
use crate::report::page::Page;
use crate::report::subject::{Ground, Subject};
use crate::report::tried::{self, trials_of};
use crate::rows::plan_file::{FORMAT, PlanAxis, PlanFile};
use crate::rows::trials::Trial;
use crate::rows::{Row, cells};
use crate::sweep::folder::Folder;
use crate::sweep::kept::{EXPERIMENT, PLAN};
use serde_json::Value;
use std::fs::File;
use std::path::{Component, Path, PathBuf};

/// Page of a folder of results.
pub(super) const REPORT: &str = "report.html";
/// Folder of its pictures.
const PLOTS: &str = "plots";
/// Rows of a bench in a folder of results, and the experiment that they are of. (No ending of an experiment file: a
/// folder of experiments may hold this one.)
pub(super) const BENCH: &str = "bench.json";
pub(super) const OF_BENCH: &str = "bench.txt";

/// What a report is of, and where it goes.
pub(super) struct Reported {
    pub(super) subject: Subject,
    pub(super) page: PathBuf,
    plots: PathBuf,
}

/// Results of a folder that are in memory already.
#[derive(Clone, Copy, Default)]
pub(super) struct Known<'a> {
    pub(super) rows: Option<&'a [Row]>,
}

impl Reported {
    /// What a folder of results, or a file of rows, holds.
    ///
    /// # Errors
    /// It holds no rows that can be read.
    pub(super) fn of(path: &Path) -> Result<Self, CliError> {
        if path.is_dir() {
            return Self::of_folder(path, Known::default());
        }
        let of_results = path.parent().map(|dir| if dir.as_os_str().is_empty() { Path::new(".") } else { dir });
        let is_its_table = ["rows.csv", "rows.parquet", PLAN].iter().any(|name| path.ends_with(name));
        match of_results.filter(|dir| is_its_table && Folder::is_one(dir) && path.is_file()) {
            Some(dir) => Self::of_folder(dir, Known::default()),
            None => Self::of_file(path),
        }
    }

    /// What a folder of results holds.
    ///
    /// # Errors
    /// It holds no rows that can be read.
    pub(super) fn of_folder(dir: &Path, known: Known) -> Result<Self, CliError> {
        let shown = dir.display();
        let bench = dir.join(BENCH);
        if !Folder::is_one(dir) && !bench.is_file() && !dir.join("rows.csv").is_file() {
            let expected = format!("expected a folder of results, found neither {PLAN} nor {BENCH} nor rows.csv in it");
            return Err(CliError::Input(format!("{shown}: {expected}")));
        }
        let mut subject = Subject { name: name_of(dir), ..Subject::default() };
        if bench.is_file() {
            subject.trials = read_trials(&bench)?;
        }
        if Folder::is_one(dir) || dir.join("rows.csv").is_file() {
            add_rows(&mut subject, dir, known)?;
        } else {
            subject.frame = frame_of(&subject.trials);
            subject.is_bench = true;
            subject.warnings.extend(doubts_of_bench(&bench, subject.trials.len())?);
        }
        add_experiment(&mut subject, dir);
        add_conditions(&mut subject);
        Ok(Reported { subject, page: dir.join(REPORT), plots: dir.join(PLOTS) })
    }

    fn of_file(path: &Path) -> Result<Self, CliError> {
        let wrong = |why: &str| {
            let expected = "expected rows of gotai (.csv or .parquet with a column `outcome`), or of a bench (.csv or \
                            .json with the columns method, error, wall_s)";
            CliError::Input(format!("{}: {expected}; {why}", path.display()))
        };
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let open = || File::open(path).map_err(|error| wrong(&error.to_string()));
        let mut subject = Subject { name: name_of(path), ..Subject::default() };
        match ending {
            "json" => subject.trials = read_trials(path)?,
            "parquet" => subject.frame = RowFrame::of_parquet(open()?).map_err(|why| wrong(&why))?,
            _ => {
                open()?;
                subject.frame = RowFrame::of_csv(&files::read(path)?).map_err(|why| wrong(&why))?;
            }
        }
        if ending != "json" && subject.frame.rows() == 0 {
            return Err(wrong("it has none"));
        }
        if subject.frame.has("outcome") && subject.frame.has("case") {
            let outcomes = (0..subject.frame.rows()).map(|row| subject.frame.text("outcome", row));
            if let Some(other) = outcomes.into_iter().find(|word| Outcome::ALL.iter().all(|known| known.name() != word))
            {
                let known: Vec<&str> = Outcome::ALL.iter().map(|known| known.name()).collect();
                return Err(wrong(&format!("an outcome is `{other}`, and not one of {}", known.join(", "))));
            }
            subject.axes = axes_of(&subject.frame);
            subject.planned = subject.frame.rows();
        } else {
            if ending != "json" {
                let names: Vec<&str> = subject.frame.names().take(6).collect();
                let found = format!("its columns are {}", names.join(", "));
                subject.trials = trials_of(&subject.frame).ok_or_else(|| wrong(&found))?;
            }
            subject.frame = frame_of(&subject.trials);
            subject.is_bench = true;
        }
        add_conditions(&mut subject);
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("rows");
        Ok(Reported {
            subject,
            page: path.with_file_name(format!("{stem}-report.html")),
            plots: path.with_file_name(format!("{stem}-{PLOTS}")),
        })
    }

    /// Adds rows of other programs, of one scene and of the same error.
    ///
    /// # Errors
    /// The file holds none, or those of several scenes.
    pub(super) fn overlay(&mut self, given: &str) -> Result<(), CliError> {
        let (path, scene) = match given.rsplit_once(':') {
            Some((path, scene)) if !Path::new(given).exists() => (Path::new(path), Some(scene)),
            _ => (Path::new(given), None),
        };
        let wrong = |why: &str| CliError::Input(format!("--with {}: {why}", path.display()));
        let mut others = others_of(path)?;
        if let Some(scene) = scene {
            others.retain(|trial| trial.scene == scene);
        }
        let mut scenes: Vec<&str> = Vec::new();
        for trial in &others {
            if !scenes.contains(&trial.scene.as_str()) {
                scenes.push(&trial.scene);
            }
        }
        if scenes.len() != 1 {
            let found = if scenes.is_empty() { "none of it".to_string() } else { scenes.join(", ") };
            return Err(wrong(&format!("expected rows of one scene (FILE:SCENE chooses one), found {found}")));
        }
        if self.subject.trials.is_empty() {
            // Of a sweep the medians are what is compared.
            let ours = tried::trials(&Ground::of(&self.subject));
            self.subject.trials = ours.into_iter().map(|tried| tried.trial).collect();
        }
        let kind = self.subject.trials.first().map(|trial| trial.error_kind.clone());
        let Some(kind) = kind else {
            return Err(wrong("there are no errors and times here that it could be compared with"));
        };
        let before = others.len();
        others.retain(|trial| trial.error_kind == kind || trial.error_kind.is_empty());
        if others.is_empty() {
            return Err(wrong(&format!("expected rows of the error {kind}, found other errors alone")));
        }
        if others.len() < before {
            let left_out = before - others.len();
            self.subject
                .warnings
                .push(format!("{left_out} rows of {} are of other errors and left out", name_of(path)));
        }
        for trial in &mut others {
            trial.error_kind.clone_from(&kind);
            if trial.engine == "gotai" || trial.engine.is_empty() {
                trial.engine = "other".to_string();
            }
        }
        self.subject.trials.extend(others);
        Ok(())
    }

    /// The page, with its figures.
    ///
    /// # Errors
    /// The machine failed.
    pub(super) fn write_page(&self, figures: &[Figure]) -> Result<Option<String>, FileError> {
        let page = Page::of(&self.subject, figures);
        write_whole(&self.page, page.html.as_bytes())?;
        Ok(page.left_out)
    }

    /// The figures as SVG and PNG.
    ///
    /// # Errors
    /// The machine failed.
    pub(super) fn write_plots(&self, figures: &[Figure]) -> Result<Vec<PathBuf>, FileError> {
        if !figures.is_empty() {
            files::make_folder(&self.plots)?;
        }
        let mut written = Vec::new();
        for figure in figures {
            let path = |ending: &str| self.plots.join(format!("{}.{ending}", figure.name));
            write_whole(&path("svg"), figure.svg().as_bytes())?;
            let pixels = figure.png().map_err(|error| FileError::new(&path("png"), error))?;
            write_whole(&path("png"), &pixels)?;
            written.push(path("svg"));
        }
        Ok(written)
    }
}

/// Writes the page of a folder that has just been filled. What fails is a warning: the rows are there.
pub(super) fn write_beside(reported: &Reported) -> Option<PathBuf> {
    match reported.write_page(&figures(&reported.subject)) {
        Ok(_) => Some(reported.page.clone()),
        Err(error) => {
            say(format!("warning: no report is written: {error}"));
            None
        }
    }
}

fn name_of(path: &Path) -> String {
    let whole = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    whole.file_name().map_or("rows".to_string(), |name| name.to_string_lossy().into_owned())
}

/// Rows of a bench, as it wrote them.
///
/// # Errors
/// They cannot be read.
pub(super) fn read_trials(path: &Path) -> Result<Vec<Trial>, CliError> {
    let read: Result<Vec<Trial>, _> = serde_json::from_slice(&files::read(path)?);
    read.map_err(|error| {
        CliError::Input(format!("{}: expected the rows of a bench, found something else ({error})", path.display()))
    })
}

/// What the trials of a bench are in doubt of, as it wrote that beside them.
fn doubts_of_bench(path: &Path, of: usize) -> Result<Option<String>, CliError> {
    let read: Value = serde_json::from_slice(&files::read(path)?).unwrap_or_default();
    let trials = read.as_array().map_or(&[][..], Vec::as_slice);
    let mut doubts = Vec::new();
    for trial in trials {
        let said = trial["warnings"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let at = ["step_s", "tolerance"].iter().find_map(|key| Some(format!(" at {key} = {}", trial[key].as_f64()?)));
        let name = trial["method"].as_str().unwrap_or_default();
        doubts.extend(said.map(|said| format!("{name}{}: {said}", at.clone().unwrap_or_default())));
    }
    let n = doubts.len();
    Ok((n > 0).then(|| format!("In doubt: {n} of {of} trials. {}.", doubts.join("; "))))
}

fn frame_of(trials: &[Trial]) -> RowFrame {
    RowFrame::of_rows(Vec::new(), trials.iter().map(cells))
}

/// Axes of rows that come without their plan: what stands between the id and the outcome.
fn axes_of(frame: &RowFrame) -> Vec<PlanAxis> {
    let names = frame.names().skip_while(|name| *name != "case").skip(1).take_while(|name| *name != "outcome");
    let axis = |name: &str| {
        let mut values: Vec<Value> = Vec::new();
        let mut seen = std::collections::HashSet::new();
        for row in 0..frame.rows() {
            let text = frame.text(name, row);
            if !text.is_empty() && seen.insert(text.clone()) {
                values.push(frame.number(name, row).map_or(Value::from(text), Value::from));
            }
        }
        PlanAxis { path: name.to_string(), values }
    };
    names.map(axis).collect()
}

fn add_rows(subject: &mut Subject, dir: &Path, known: Known) -> Result<(), CliError> {
    let plan = read_plan(subject, dir)?;
    let axes = plan.as_ref().map(|plan| plan.axes.clone());
    let (parquet, csv) = (dir.join("rows.parquet"), dir.join("rows.csv"));
    let time = |path: &Path| std::fs::metadata(path).and_then(|about| about.modified()).ok();
    let is_current = |table: &Path| table.is_file() && time(table) >= time(&dir.join("journal.jsonl"));
    let unreadable = |path: &Path, why: String| {
        CliError::Input(format!("{}: expected rows, found something else ({why})", path.display()))
    };
    subject.frame = if let Some(rows) = known.rows {
        RowFrame::of_rows(Vec::new(), rows.iter().map(cells))
    } else if is_current(&parquet) {
        let file = File::open(&parquet).map_err(|error| FileError::new(&parquet, error))?;
        RowFrame::of_parquet(file).map_err(|why| unreadable(&parquet, why))?
    } else if is_current(&csv) {
        RowFrame::of_csv(&files::read(&csv)?).map_err(|why| unreadable(&csv, why))?
    } else {
        // A sweep that was killed: its rows are in its journal.
        let folder = Folder::read(dir)?;
        RowFrame::of_rows(Vec::new(), folder.rows().iter().map(cells))
    };
    if subject.frame.rows() > 0 && !subject.frame.has("outcome") {
        return Err(unreadable(&parquet, "no column `outcome`".to_string()));
    }
    subject.axes = axes.unwrap_or_else(|| axes_of(&subject.frame));
    subject.planned = plan.as_ref().map_or(subject.frame.rows(), |plan| plan.rows);
    if let Some(plan) = plan {
        subject.together = plan.together;
        subject.search = plan.search;
    }
    Ok(())
}

/// The plan of a folder, of whatever format; None where it has none that can be read.
fn read_plan(subject: &mut Subject, dir: &Path) -> Result<Option<PlanFile>, CliError> {
    let path = dir.join(PLAN);
    if !path.is_file() {
        return Ok(None);
    }
    let read: Value = serde_json::from_slice(&files::read(&path)?).map_err(|error| {
        CliError::Input(format!("{}: expected a plan, found something else ({error})", path.display()))
    })?;
    let format = read["format"].as_u64();
    if format != Some(u64::from(FORMAT)) {
        let found = format.map_or("none".to_string(), |format| format.to_string());
        subject.warnings.push(format!(
            "These rows are of format {found}, this program writes format {FORMAT}: a column may mean something else \
             than docs/columns.md says."
        ));
    }
    for (name, key) in [("program", "program"), ("build", "build"), ("plan", "hash")] {
        if let Some(value) = read[key].as_str() {
            subject.conditions.push((name.to_string(), value.to_string()));
        }
    }
    subject.question = read["question"].as_str().map(str::to_string);
    if let Some(name) = read["name"].as_str() {
        subject.name = name.to_string();
    }
    Ok(serde_json::from_value(read).ok())
}

/// Adds what the experiment file says: its text, its methods, the verdicts on what it expects.
fn add_experiment(subject: &mut Subject, dir: &Path) {
    let path = dir.join(if subject.is_bench { OF_BENCH } else { EXPERIMENT });
    let Ok(text) = files::read(&path) else { return };
    let text = String::from_utf8_lossy(&text).into_owned();
    let here = place_of(dir);
    subject.commands = match subject.is_bench {
        true => vec![format!("gotai bench CONFIG --out {here}    # CONFIG: a file with the configuration below")],
        false => vec![
            format!("gotai sweep {here}/{EXPERIMENT} --out {here}"),
            format!("gotai rows {here} --where outcome=diverged"),
            format!("gotai run {here} --case ID"),
        ],
    };
    subject.replay = (!subject.is_bench).then(|| format!("gotai run {here} --case"));
    let file = ExperimentFile::from_text(&path, &text, &[]);
    subject.configuration = Some(text);
    // Of another version it may be no experiment any more.
    let Ok(file) = file else { return };
    let cases = of_methods(&file);
    if subject.is_bench {
        for trial in subject.trials.iter().filter(|trial| trial.engine == "gotai") {
            if !subject.methods.contains(&trial.method) {
                subject.methods.push(trial.method.clone());
            }
        }
    }
    for experiment in &cases {
        let word = experiment.method.word().to_string();
        subject.claims_to_solve |= experiment.method.facts().solves_contacts;
        if !subject.is_bench && !subject.methods.contains(&word) {
            subject.methods.push(word);
        }
    }
    if let Some(first) = cases.first() {
        subject.magnitudes = Magnitudes::of(first);
        subject.question = subject.question.take().or_else(|| first.question.clone());
        let clock = first.clock();
        // A method that needs no step has none, and every trial of a bench has its own.
        let of_steps = match first.time.step_s {
            Some(_) if !subject.is_bench => format!(", the first case in steps of {} s", clock.step_s),
            _ => String::new(),
        };
        subject.conditions.push(("time".to_string(), format!("{} s{of_steps}", clock.end_s)));
        let parts =
            [("method", serde_json::to_value(&first.method)), ("divergence", serde_json::to_value(&first.diverge))];
        for (name, part) in parts
            .into_iter()
            .filter(|(name, _)| !(subject.is_bench && *name == "method"))
            .filter_map(|(name, part)| Some((name, part.ok()?)))
        {
            subject.conditions.push((format!("{name} of the first case"), part.to_string()));
        }
    }
    if !subject.is_bench {
        subject.verdicts = verdicts(&file, subject);
    }
}

/// The first case of every method on the axes, or in the bench.
fn of_methods(file: &ExperimentFile) -> Vec<Experiment> {
    let axes = &file.axes().axes;
    let mut points = vec![vec![0; axes.len()]];
    for (at, axis) in axes.iter().enumerate().filter(|(_, axis)| axis.path.starts_with("method")) {
        for value in 1..axis.values.len() {
            let mut point = vec![0; axes.len()];
            point[at] = value;
            points.push(point);
        }
    }
    points.iter().filter_map(|point| file.case(point).ok()).collect()
}

/// Verdicts on what a file expects, by the rows that there are.
fn verdicts(file: &ExperimentFile, subject: &mut Subject) -> Vec<Judged> {
    if file.expect().is_empty() || subject.frame.rows() == 0 {
        return Vec::new();
    }
    if subject.frame.rows() < subject.planned {
        subject
            .warnings
            .push("What was expected is judged by the rows that are there, and some are missing.".to_string());
    }
    let frame = &subject.frame;
    let known = Schema::new(file.axes(), file.search().and_then(|search| search.over), &[]);
    let more: Vec<String> =
        frame.names().filter(|name| !known.columns.iter().any(|known| known == name)).map(str::to_string).collect();
    let mut schema = Schema::new(file.axes(), file.search().and_then(|search| search.over), &more);
    schema.magnitudes = subject.magnitudes;
    // All columns of many rows by name would take more memory than the rows: those that an expectation can ask for.
    let asked = format!("{:?}", file.expect());
    let is_asked = |name: &&str| {
        let vector = name.rsplit_once('.').map_or(*name, |(vector, _)| vector);
        let is_axis = schema.axes.iter().any(|(path, _)| path == name);
        is_axis
            || ["case", "outcome", "criterion", "step_used_s"].contains(name)
            || asked.contains(*name)
            || asked.contains(vector)
            || (asked.contains("\"state\"") && name.contains('.'))
    };
    let names: Vec<&str> = schema.columns.iter().map(String::as_str).filter(is_asked).collect();
    let rows: Vec<Cells> = (0..frame.rows()).map(|row| frame.cells(&names, row)).collect();
    file.expect().iter().map(|expectation| judge(expectation, &schema, &rows)).collect()
}

/// A folder as a command names it that is typed where this one was; nothing of this machine is in it.
fn place_of(dir: &Path) -> String {
    let is_plain = dir.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    let text = dir.to_string_lossy();
    if !is_plain || dir.as_os_str().is_empty() {
        return ".".to_string();
    }
    let is_safe = text.chars().all(|c| c.is_ascii_alphanumeric() || "./_-+=~".contains(c));
    if is_safe { text.into_owned() } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

/// Adds what varies and how far it is to be trusted, which every report says.
fn add_conditions(subject: &mut Subject) {
    let mut said = Vec::new();
    for axis in &subject.axes {
        let ends = [axis.values.first(), axis.values.last()].map(|value| value.map(shown_cell).unwrap_or_default());
        let said_of = match axis.values.len() {
            1 => ends[0].clone(),
            n => format!("{n} values, {} to {}", ends[0], ends[1]),
        };
        said.push((axis.path.clone(), said_of));
    }
    for column in
        ["energy_drift_rel", "residual_max", "penetration_max_m", "error_position_m", "reference_uncertainty_m"]
    {
        let largest = subject
            .frame
            .numbers(column)
            .into_iter()
            .flatten()
            .filter(|x| x.is_finite())
            .map(|x| x.abs())
            .reduce(f64::max);
        if let Some(largest) = largest {
            said.push((format!("largest {column}"), format!("{largest:.2e}")));
        }
    }
    said.push(("report by".to_string(), format!("{PROGRAM}, build {BUILD}")));
    subject.conditions.extend(said);
}

/// Rows of other programs, as `--with` gives them.
///
/// # Errors
/// They cannot be read, or are none.
pub(super) fn others_of(path: &Path) -> Result<Vec<Trial>, CliError> {
    let wrong = |why: &str| CliError::Input(format!("--with {}: {why}", path.display()));
    let content = files::read(path).map_err(|error| wrong(&error.reason))?;
    let frame = RowFrame::of_csv(&content).map_err(|why| wrong(&why))?;
    trials_of(&frame).ok_or_else(|| {
        wrong("expected rows of a bench: engine, method, dt or step_s, error, error_kind, wall_s as columns")
    })
}
