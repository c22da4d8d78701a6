//! One error type for everything that can be wrong with an experiment file, `--set` and axes.

use super::key_path::{KeyPath, Path};
use super::nearest::nearest;
use super::tree::Value;
use serde::Serialize;
use std::fmt;

/// Error of the input: what is wrong, where, what was expected, what was found. `Display` is the whole message in one
/// line.
#[derive(Clone, Debug, PartialEq)]
pub struct ExperimentError(Box<Details>);

/// The machine-readable form of an `ExperimentError`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Details {
    pub kind: Kind,
    /// The experiment file, as it was named by the user.
    pub file: Option<String>,
    /// Line in the file, from 1; None where the value did not come from the file.
    pub line: Option<usize>,
    /// Column in the line, from 1.
    pub column: Option<usize>,
    /// The flag that the value came from: `--set` or `--axis`.
    pub flag: Option<&'static str>,
    /// The `PATH=VALUE` of that flag.
    pub set: Option<String>,
    /// `path = value` of the axis that the value came from.
    pub axis: Option<String>,
    /// Values of the axes, where the error shows only together with them.
    pub case: Option<String>,
    /// Place in the experiment; empty for the whole file.
    pub path: KeyPath,
    /// The complaint, without the place.
    pub message: String,
    pub expected: Option<String>,
    pub found: Option<String>,
    /// The known key or word nearest to the one found.
    pub nearest: Option<String>,
    /// All known keys or words at this place.
    pub known: Vec<String>,
    /// `path` still lacks its upper part: the error was made by serde, which knows no paths.
    #[serde(skip)]
    is_relative: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Failure of the machine: the file exists but cannot be read.
    Unreadable,
    /// File that is none: there is no such file, or it is a folder, not UTF-8, or empty.
    File,
    Syntax,
    DuplicateKey,
    UnknownKey,
    UnknownWord,
    /// Key, word or combination of a later version.
    NotAvailable,
    Missing,
    /// A value of the wrong type or out of its bounds, or one that does not fit another.
    Unexpected,
    /// A `--set` or an axis whose path leads nowhere, or where another one leads already.
    Path,
    /// Axes that are left where a single run was asked for.
    AxesLeft,
}

impl Details {
    /// Text of the place as messages begin with it: the flag, else the file and the line; empty where nothing is known.
    pub fn place(&self) -> String {
        match (&self.set, &self.file, self.line) {
            (Some(set), _, _) => format!("{} {}", self.flag.unwrap_or("--set"), in_one_line(set)),
            (None, Some(file), Some(line)) => format!("{file}:{line}"),
            (None, Some(file), None) => file.clone(),
            (None, None, _) => String::new(),
        }
    }
}

impl ExperimentError {
    pub(crate) fn new(kind: Kind, path: KeyPath, message: impl Into<String>) -> Self {
        ExperimentError(Box::new(Details {
            kind,
            file: None,
            line: None,
            column: None,
            flag: None,
            set: None,
            axis: None,
            case: None,
            path,
            message: message.into(),
            expected: None,
            found: None,
            nearest: None,
            known: Vec::new(),
            is_relative: false,
        }))
    }

    /// The error `expected …, found …`.
    pub(crate) fn unexpected(path: KeyPath, expected: &str, found: &str) -> Self {
        let mut error = Self::new(Kind::Unexpected, path, format!("expected {expected}, found {found}"));
        error.0.expected = Some(expected.to_string());
        error.0.found = Some(found.to_string());
        error
    }

    pub(crate) fn unknown_key(path: KeyPath, key: &str, known: &[&str]) -> Self {
        let near = nearest(key, known);
        let message = format!("unknown key{} (known here: {})", did_you_mean(near), known.join(", "));
        Self::new(Kind::UnknownKey, path, message).with_known(&format!("`{key}`"), known, near)
    }

    pub(crate) fn unknown_word(path: KeyPath, word: &str, known: &[&str]) -> Self {
        let near = nearest(word, known);
        let message = format!("expected {}, found `{word}`{}", one_of(known), did_you_mean(near));
        Self::new(Kind::UnknownWord, path, message).with_known(&format!("`{word}`"), known, near)
    }

    pub(crate) fn not_available(path: KeyPath, word: Option<&str>) -> Self {
        let subject = word.map(|word| format!("`{word}` is ")).unwrap_or_default();
        Self::new(Kind::NotAvailable, path, format!("{subject}not available in this version"))
    }

    /// The error of a combination that a later version can do.
    pub(crate) fn feature_not_available(path: KeyPath, feature: &str) -> Self {
        Self::new(Kind::NotAvailable, path, format!("{feature} is not available in this version"))
    }

    /// The error of a value that is missing; `what` says what to write there, and may be empty.
    pub(crate) fn missing(path: KeyPath, what: &str) -> Self {
        let message = if what.is_empty() { "missing".to_string() } else { format!("missing: {what}") };
        let mut error = Self::new(Kind::Missing, path, message);
        error.0.expected = Some(if what.is_empty() { "a value".to_string() } else { what.to_string() });
        error.0.found = Some("nothing".to_string());
        error
    }

    fn with_known(mut self, found: &str, known: &[&str], near: Option<&str>) -> Self {
        self.0.expected = Some(one_of(known));
        self.0.found = Some(found.to_string());
        self.0.known = known.iter().map(|word| word.to_string()).collect();
        self.0.nearest = near.map(str::to_string);
        self
    }

    pub fn details(&self) -> &Details {
        &self.0
    }

    pub(crate) fn details_mut(&mut self) -> &mut Details {
        &mut self.0
    }

    /// Whether the machine failed, and the input may be fine; else the input is wrong.
    pub fn is_machine(&self) -> bool {
        self.0.kind == Kind::Unreadable
    }

    /// Completes the path of an error that serde made.
    pub(crate) fn below(mut self, path: &Path) -> Self {
        if self.0.is_relative {
            let own = std::mem::take(&mut self.0.path);
            self.0.path = path.to_key_path().join(own);
            self.0.is_relative = false;
        }
        self
    }

    /// The error about another place.
    pub(crate) fn at(mut self, path: KeyPath) -> Self {
        self.0.path = path;
        self
    }

    /// Names the file that the experiment is in.
    pub(crate) fn named(mut self, file: &std::path::Path) -> Self {
        self.0.file = Some(file.display().to_string());
        self
    }

    fn relative(mut self) -> Self {
        self.0.is_relative = true;
        self
    }
}

impl std::error::Error for ExperimentError {}

impl fmt::Display for ExperimentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Details { axis, case, path, message, .. } = self.details();
        let place = self.details().place();
        if !place.is_empty() {
            write!(f, "{place}: ")?;
        }
        if !path.is_empty() {
            write!(f, "{}: ", in_one_line(&path.to_string()))?;
        }
        f.write_str(message)?;
        match (axis, case) {
            (Some(axis), _) => write!(f, " (from the axis {axis})"),
            (None, Some(case)) => write!(f, " (in the case {case})"),
            (None, None) => Ok(()),
        }
    }
}

impl serde::de::Error for ExperimentError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::new(Kind::Unexpected, KeyPath::default(), message.to_string()).relative()
    }

    fn missing_field(field: &'static str) -> Self {
        Self::missing(KeyPath::of_keys(&[field]), "").relative()
    }

    fn invalid_type(found: serde::de::Unexpected, expected: &dyn serde::de::Expected) -> Self {
        Self::unexpected(KeyPath::default(), &expected.to_string(), &found.to_string()).relative()
    }

    fn invalid_value(found: serde::de::Unexpected, expected: &dyn serde::de::Expected) -> Self {
        Self::invalid_type(found, expected)
    }

    fn invalid_length(len: usize, expected: &dyn serde::de::Expected) -> Self {
        Self::unexpected(KeyPath::default(), &expected.to_string(), &format!("a list of {len}")).relative()
    }
}

fn did_you_mean(near: Option<&str>) -> String {
    near.map(|near| format!("; did you mean `{near}`?")).unwrap_or_default()
}

fn one_of(known: &[&str]) -> String {
    match known {
        [] => "nothing".to_string(),
        [only] => format!("`{only}`"),
        _ => format!("one of {}", known.join(", ")),
    }
}

/// A value as it is named in a message.
pub(crate) fn describe(value: &Value) -> String {
    match value {
        Value::Null => "nothing".to_string(),
        Value::Bool(flag) => flag.to_string(),
        Value::Number(number) => number.to_string(),
        Value::String(text) => format!("the text `{}`", shortened(text)),
        Value::Sequence(items) => format!("a list of {}", items.len()),
        Value::Mapping(mapping) if mapping.is_empty() => "an empty mapping".to_string(),
        Value::Mapping(mapping) => {
            let keys: Vec<String> = mapping.keys().take(8).map(|key| format!("`{}`", key_text(key))).collect();
            format!("a mapping of {}", keys.join(", "))
        }
        Value::Tagged(tagged) => format!("the tag `{}`", tagged.tag),
    }
}

/// A mapping's key as it is named in a message.
pub(crate) fn key_text(key: &Value) -> String {
    match key {
        Value::String(text) => shortened(text),
        Value::Mapping(_) => "a mapping".to_string(),
        Value::Sequence(_) => "a list".to_string(),
        Value::Tagged(_) => "a tag".to_string(),
        other => describe(other),
    }
}

fn in_one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Text in one line and cut, so that messages stay short.
pub(crate) fn shortened(text: &str) -> String {
    const LONGEST: usize = 60;
    let flat = in_one_line(text);
    match flat.char_indices().nth(LONGEST) {
        None => flat,
        Some((end, _)) => format!("{}…", &flat[..end]),
    }
}

/// A number in a message: shortest decimal, whole numbers without `.0`.
pub(crate) fn number(x: f64) -> String {
    let text = format!("{x:?}");
    text.strip_suffix(".0").map(str::to_string).unwrap_or(text)
}
