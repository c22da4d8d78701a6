//! Several cases in one recording, made of their own recordings; a case that has none is run again, with the same bits.

use super::cut::no_recording;
use super::error::CliError;
use super::output::say;
use crate::digest::sha256;
use crate::experiment::ExperimentFile;
use crate::files::make_folder;
use crate::record::head::header;
use crate::record::name::RecordingName;
use crate::record::read::{ReadBack, recording_of};
use crate::record::sample::Header;
use crate::record::schema::{self, label};
use crate::record::writer::Target;
use crate::rows::Row;
use crate::run::ticks::ticks;
use crate::study::Place;
use crate::sweep::build::build;
use crate::sweep::folder::Folder;
use crate::sweep::plan::SweepPlan;
use crate::sweep::runner::run_case;
pub(super) use crate::sweep::unneeded::REPLAYS;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Cases that are shown together.
pub(super) struct Ghosts {
    /// What they differ in.
    differing: String,
    cases: Vec<(String, Header, ReadBack)>,
}

impl Ghosts {
    /// Most of them that can be told apart.
    pub(super) const MOST: usize = schema::MOST_TOGETHER;

    /// Of recordings (.mcap), told apart by the axes in which they differ, or by their names.
    ///
    /// # Errors
    /// One cannot be read, or is no recording of ours.
    pub(super) fn of_files(paths: &[PathBuf]) -> Result<Self, CliError> {
        let read = paths.iter().map(|path| {
            let found = recording_of(path)?;
            found.ok_or_else(|| no_recording(path))
        });
        let recordings = read.collect::<Result<Vec<_>, _>>()?;
        let axes: Vec<String> = match recordings.first() {
            None => Vec::new(),
            Some(first) => {
                first.said.get(schema::AXES).and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default()
            }
        };
        let differs = |axis: &&String| {
            let value = |recording: &ReadBack| recording.said.get(*axis).cloned();
            recordings.windows(2).any(|pair| value(&pair[0]) != value(&pair[1]))
        };
        let differing: Vec<&String> = axes.iter().filter(differs).collect();
        let named = |(path, recording): (&PathBuf, &ReadBack)| {
            // As JSON where it is more than a word.
            let shown = |text: &String| serde_json::from_str(text).map_or_else(|_| text.clone(), |value| label(&value));
            let values: Vec<String> =
                differing.iter().filter_map(|axis| recording.said.get(*axis).map(shown)).collect();
            let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
            if values.is_empty() { name } else { values.join(", ") }
        };
        let labels = told_apart(paths.iter().zip(&recordings).map(named).collect(), paths);
        warn_of_scenes(paths, &recordings);
        let differing = match differing.as_slice() {
            [] => "recordings".to_string(),
            axes => axes.iter().map(|axis| axis.as_str()).collect::<Vec<_>>().join(", "),
        };
        let mut cases = Vec::new();
        for ((recording, label), path) in recordings.into_iter().zip(labels).zip(paths) {
            cases.push((label, head_of(&recording, path)?, recording));
        }
        Ok(Ghosts { differing, cases })
    }

    /// Of rows of a folder; those without an .mcap are run again.
    ///
    /// # Errors
    /// A row is not of the plan, or the machine failed.
    pub(super) fn of_rows(folder: &Folder, rows: &[&Row]) -> Result<Self, CliError> {
        let files = rows.iter().map(|row| recording_of_row(folder, row, &[Target::Mcap]));
        Self::of_files(&files.collect::<Result<Vec<_>, _>>()?)
    }

    /// Writes a recording that is alone as its run would have: with all that it opens with.
    ///
    /// # Errors
    /// The machine failed, or this build has no Rerun.
    pub(super) fn write_whole(mut self, dir: &Path) -> Result<PathBuf, CliError> {
        let is_whole = |(_, _, recording): &(String, Header, ReadBack)| recording.ending.is_some() || recording.is_cut;
        if self.cases.len() != 1 || !self.cases.iter().all(is_whole) {
            return self.write(dir);
        }
        make_folder(dir)?;
        let Some((label, header, recording)) = self.cases.pop() else { return self.write(dir) };
        let name = RecordingName::new(&["view".to_string(), label], &sha256(&header.case, 4)).begun();
        let path = Target::Rerun.path(dir, &name);
        write_alone(&path, &header, &recording).inspect_err(|_| forget(&path))?;
        Ok(path)
    }

    /// Writes them into one .rrd in a folder; returns its path.
    ///
    /// # Errors
    /// The machine failed, or this build has no Rerun.
    pub(super) fn write(self, dir: &Path) -> Result<PathBuf, CliError> {
        make_folder(dir)?;
        let labels = self.cases.iter().map(|(label, ..)| label.clone());
        let word = if self.cases.len() == 1 { "view" } else { "ghosts" };
        let values: Vec<String> = std::iter::once(word.to_string()).chain(labels).collect();
        let ids: Vec<&str> = self.cases.iter().map(|(_, header, _)| header.case.as_str()).collect();
        let path = Target::Rerun.path(dir, &RecordingName::new(&values, &sha256(ids.join(" "), 4)).begun());
        write_into(&path, self).inspect_err(|_| forget(&path))?;
        Ok(path)
    }
}

/// Labels that are of one case each: what two recordings share gets the name of its folder, or a number.
fn told_apart(labels: Vec<String>, paths: &[PathBuf]) -> Vec<String> {
    let is_alone = |labels: &[String], i: usize| labels.iter().filter(|label| **label == labels[i]).count() == 1;
    let folder = |path: &PathBuf| {
        let whole = std::path::absolute(path).unwrap_or_else(|_| path.clone());
        whole.parent().and_then(|dir| Some(dir.file_name()?.to_string_lossy().into_owned()))
    };
    let in_folder = |i: usize| match folder(&paths[i]).filter(|_| !is_alone(&labels, i)) {
        Some(folder) => format!("{} in {folder}", labels[i]),
        None => labels[i].clone(),
    };
    let placed: Vec<String> = (0..labels.len()).map(in_folder).collect();
    let numbered =
        |i: usize| if is_alone(&placed, i) { placed[i].clone() } else { format!("{} ({})", placed[i], i + 1) };
    (0..placed.len()).map(numbered).collect()
}

/// Says which recordings are of other bodies than the first one: they are drawn together as they are.
fn warn_of_scenes(paths: &[PathBuf], recordings: &[ReadBack]) {
    let Some(first) = recordings.first() else { return };
    for (path, _) in paths.iter().zip(recordings).filter(|(_, other)| other.bodies != first.bodies) {
        say(format!("warning: {}: another scene than that of {}", path.display(), paths[0].display()));
    }
}

/// Drops what could not be written to its end: nobody is to take it for a recording.
pub(super) fn forget(path: &Path) {
    // The first error is the one to tell.
    let _ = std::fs::remove_file(path);
}

/// A folder itself if files can be made in it, else one for what is made for a while.
pub(super) fn writable(dir: &Path) -> PathBuf {
    let probe = dir.join(format!(".gotai-{}", std::process::id()));
    let can_write = make_folder(dir).is_ok() && std::fs::write(&probe, "").is_ok();
    let _ = std::fs::remove_file(&probe);
    if can_write { dir.to_path_buf() } else { std::env::temp_dir().join("gotai-views") }
}

#[cfg(feature = "rerun")]
fn write_into(path: &Path, ghosts: Ghosts) -> Result<(), CliError> {
    use crate::record::rerun::ghosts::{GhostCase, write_ghosts};
    let cases = ghosts.cases.into_iter().map(|(label, header, recording)| GhostCase { label, header, recording });
    Ok(write_ghosts(path, &ghosts.differing, &cases.collect::<Vec<_>>())?)
}

#[cfg(feature = "rerun")]
fn write_alone(path: &Path, header: &Header, recording: &ReadBack) -> Result<(), CliError> {
    use crate::record::Recorder;
    use crate::record::rerun::RerunRecorder;
    let mut file = RerunRecorder::create(path, header)?;
    file.write(&recording.samples)?;
    match &recording.ending {
        Some(ending) => Box::new(file).finish(ending)?,
        None => file.leave()?,
    }
    Ok(())
}

#[cfg(not(feature = "rerun"))]
fn write_alone(path: &Path, _: &Header, _: &ReadBack) -> Result<(), CliError> {
    Err(CliError::Input(format!("{}: this gotai was built without Rerun (cargo feature `rerun`)", path.display())))
}

#[cfg(not(feature = "rerun"))]
fn write_into(_: &Path, ghosts: Ghosts) -> Result<(), CliError> {
    let Ghosts { differing, .. } = ghosts;
    Err(CliError::Input(format!("{differing}: this gotai was built without Rerun (cargo feature `rerun`)")))
}

/// Head of a recording, from the experiment in it.
fn head_of(recording: &ReadBack, path: &Path) -> Result<Header, CliError> {
    let file = ExperimentFile::from_text(path, &recording.experiment, &[])?;
    let plan = SweepPlan::single(&file)?;
    let planned = &plan.cases[0];
    let (model, start) = build(&file, &planned.point, &planned.case.experiment)?;
    let clock = ticks(&planned.case.experiment);
    let mut header = header(&planned.case, &planned.name, &model, &start, &clock);
    // What the sweep knew, of which its case alone knows nothing.
    let said = |key: &str| recording.said.get(key);
    for (field, key) in [
        (&mut header.case, "case"),
        (&mut header.title, "title"),
        (&mut header.method, "method"),
        (&mut header.program, "program"),
        (&mut header.build, "build"),
    ] {
        said(key).into_iter().for_each(|text| field.clone_from(text));
    }
    let axes = said(schema::AXES).and_then(|text| serde_json::from_str::<Vec<String>>(text).ok()).unwrap_or_default();
    let value = |text: &String| serde_json::from_str(text).unwrap_or_else(|_| Value::from(text.as_str()));
    header.axes = axes.iter().filter_map(|path| Some((path.clone(), value(said(path)?)))).collect();
    if let Some(name) = said("name").and_then(|name| RecordingName::parse(name)) {
        header.name = name;
    }
    Ok(header)
}

/// File of a row's recording, of the first of these kinds that is there; a row without one is run again, recorded into
/// the first kind.
///
/// # Errors
/// The row is not of the plan, or the machine failed.
pub(super) fn recording_of_row(folder: &Folder, row: &Row, kinds: &[Target]) -> Result<PathBuf, CliError> {
    let available = || kinds.iter().filter(|kind| Target::AVAILABLE.contains(kind));
    let dirs = [folder.dir.clone(), folder.dir.join(REPLAYS)];
    let planned = folder.cases.iter().find(|planned| planned.case.id == row.case);
    let names =
        row.recording.clone().into_iter().chain(planned.map(|planned| planned.name.ended(row.measured.outcome)));
    let places = names.flat_map(|name| dirs.iter().map(move |dir| (dir.clone(), name.clone())).collect::<Vec<_>>());
    let found = places.flat_map(|(dir, name)| available().map(move |kind| kind.path(&dir, &name)).collect::<Vec<_>>());
    if let Some(path) = found.into_iter().find(|path| path.is_file()) {
        return Ok(path);
    }
    let Some(planned) = planned.filter(|planned| planned.search.is_none()) else {
        return Err(CliError::Input(format!("case {}: this row has no recording, and is no single run", row.case)));
    };
    let Some(&kind) = available().next() else {
        return Err(CliError::Input("this gotai was built without Rerun (cargo feature `rerun`)".into()));
    };
    let replays = folder.dir.join(REPLAYS);
    make_folder(&replays)?;
    let (model, start) = build(&folder.file, &planned.point, &planned.case.experiment)?;
    let kinds = [kind];
    let place = Place { references: Some(&folder.dir), recording: planned.recording(&replays, &kinds) };
    let (ended, written) = run_case(&planned.case, &model, start, &place);
    written?;
    Ok(kind.path(&replays, &planned.name.ended(ended.measured.outcome)))
}
