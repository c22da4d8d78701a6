//! The key `extends:`: a file that stands on another one, and from the merged tree back to the lines of both.

use super::error::{ExperimentError, Kind, describe};
use super::key_path::KeyPath;
use super::merge::{Graft, merge};
use super::positions;
use super::source::{parse, read};
use super::tree::Value;
use std::path::{Path, PathBuf};

type Result<T> = std::result::Result<T, ExperimentError>;

/// Most files below one another. More, each standing on the next, are a slip.
const DEEPEST: usize = 16;

/// Origin of every value: which file said it, and on which line.
#[derive(Clone, Debug)]
pub(super) struct Origins {
    /// The file itself, its base, the base of that, ….
    texts: Vec<SourceText>,
    /// Grafts by the place of their file in `texts`, in the order in which they were put over each other: the last one
    /// counts.
    grafts: Vec<(usize, Graft)>,
}

/// A file that was read.
#[derive(Clone, Debug)]
struct SourceText {
    path: PathBuf,
    text: String,
}

/// A file's tree, with that of its bases below.
///
/// # Errors
/// A file that is none, or a base that there is not; the message has the line.
pub(super) fn with_bases(path: &Path, text: &str) -> Result<(Value, Origins)> {
    let (mut texts, mut trees) = (Vec::new(), Vec::new());
    let mut next = Some((path.to_path_buf(), text.to_string()));
    while let Some((path, text)) = next {
        let own = SourceText { text: text.strip_prefix('\u{feff}').unwrap_or(&text).to_string(), path };
        let mut tree = parse(&own.text).map_err(|error| error.named(&own.path))?;
        let base = tree.as_mapping_mut().and_then(|mapping| mapping.shift_remove("extends"));
        texts.push(own);
        trees.push(tree);
        next = base.map(|base| read_base(&base, &texts)).transpose()?;
    }
    let mut merged = trees.pop().unwrap_or_default();
    let whole = Graft { at: KeyPath::default(), own: KeyPath::default() };
    let mut grafts = vec![(trees.len(), whole)];
    for (i, tree) in trees.into_iter().enumerate().rev() {
        grafts.extend(merge(&mut merged, tree).into_iter().map(|graft| (i, graft)));
    }
    Ok((merged, Origins { texts, grafts }))
}

/// The file that the last of them extends.
fn read_base(base: &Value, texts: &[SourceText]) -> Result<(PathBuf, String)> {
    let at = KeyPath::of_keys(&["extends"]);
    let own = texts.last().ok_or_else(|| ExperimentError::missing(at.clone(), "a file"))?;
    let wrong = |kind: Kind, message: String| own.placed(ExperimentError::new(kind, at.clone(), message), &at);
    let Value::String(name) = base else {
        let error = ExperimentError::unexpected(at.clone(), "an experiment file, in quotes", &describe(base));
        return Err(own.placed(error, &at));
    };
    let path = own.path.parent().unwrap_or(Path::new("")).join(name);
    if let Some(first) = texts.iter().position(|above| identity(&above.path) == identity(&path)) {
        let circle = texts[first..].iter().map(|text| &text.path).chain([&path]);
        let circle: Vec<String> = circle.map(|path| path.display().to_string()).collect();
        return Err(wrong(Kind::File, format!("files extend each other in a circle: {}", circle.join(" → "))));
    }
    if texts.len() > DEEPEST {
        return Err(wrong(Kind::File, format!("expected at most {DEEPEST} files below another, found more")));
    }
    match read(&path) {
        Ok(text) => Ok((path, text)),
        // A line of the base itself.
        Err(error) if error.details().line.is_some() => Err(error.named(&path)),
        Err(error) => Err(wrong(error.details().kind, format!("{}: {}", path.display(), error.details().message))),
    }
}

/// Path that is equal for two ways to name one file.
fn identity(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_path_buf())
}

impl SourceText {
    /// The error with this file's name, and the line of `own` or of what is nearest to it above.
    fn placed(&self, error: ExperimentError, own: &KeyPath) -> ExperimentError {
        let mut error = error.named(&self.path);
        if let Some(position) = positions::nearest(&self.text, own) {
            error.details_mut().line = Some(position.line);
            error.details_mut().column = Some(position.column);
        }
        error
    }
}

impl Origins {
    /// The error with the file and the line that its value came from.
    pub fn placed(&self, error: ExperimentError) -> ExperimentError {
        let path = error.details().path.clone();
        let Some((source, graft)) = self.grafts.iter().rev().find(|(_, graft)| path.starts_with(&graft.at)) else {
            return error;
        };
        let own = graft.own.clone().join(path.below(graft.at.len()));
        let placed = self.texts[*source].placed(error, &own);
        // What no file has is missing in the one that was asked for.
        if placed.details().line.is_some() { placed } else { self.texts[0].placed(placed, &path) }
    }
}
