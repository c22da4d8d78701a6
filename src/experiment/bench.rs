//! The vocabulary of `bench:`: the methods that are compared, their steps and tolerances, the error. How it is done is
//! in `bench/`.

use super::axes::read_list;
use super::checks::{Result, positive, unexpected};
use super::error::number;
use super::key_path::{KeyPath, Path};
use super::tree::Value;
use super::types::Method;
use super::value_de::from_value;

/// Repeats where none are given. Best and median of five are enough to see a disturbed run.
const REPEATS: u32 = 5;

#[derive(Clone, Debug, PartialEq)]
pub struct Bench {
    /// Methods to compare: at least one, each with a label of its own.
    pub methods: Vec<Listed>,
    /// Steps of methods that advance by a given one, in seconds; where it is empty, `time.step_s`.
    pub steps_s: Vec<f64>,
    /// Tolerances of methods that control their error; where it is empty, each method's own.
    pub tolerances: Vec<f64>,
    /// Name of the column of numbers that is the error.
    pub error: String,
    /// Number of timed runs of a trial, at least 1.
    pub repeats: u32,
}

/// A method to compare.
#[derive(Clone, Debug, PartialEq)]
pub struct Listed {
    pub label: String,
    pub method: Method,
    /// The method as it is written, and where; None for the file's own.
    pub written: Option<(Value, KeyPath)>,
}

/// The keys of `bench:` as they are written.
#[derive(serde::Deserialize)]
#[serde(rename = "Bench", deny_unknown_fields)]
pub(super) struct BenchText {
    methods: Option<Vec<Value>>,
    #[serde(default)]
    steps_s: Vec<f64>,
    #[serde(default)]
    tolerances: Vec<f64>,
    error: Option<String>,
    repeats: Option<u32>,
}

/// Place of a key of `bench:` in the file.
pub fn bench_path(key: &str) -> KeyPath {
    KeyPath::of_keys(&["bench", key])
}

/// The bench that stands below `bench:`; `own` is the file's `method:`.
///
/// # Errors
/// A key, step, tolerance or method that is wrong, or two methods with one label.
pub fn read(value: &Value, own: Option<&Value>) -> Result<Bench> {
    let base = KeyPath::of_keys(&["bench"]);
    let at = Path::Base(&base);
    let text: BenchText = from_value(value, &base)?;
    all_positive_and_once(&text.steps_s, at.key("steps_s"))?;
    all_positive_and_once(&text.tolerances, at.key("tolerances"))?;
    let methods = match &text.methods {
        None => vec![own_method(own)?],
        Some(items) => listed(items, at.key("methods"))?,
    };
    let repeats = text.repeats.unwrap_or(REPEATS);
    if repeats == 0 {
        return Err(unexpected(at.key("repeats"), "a whole number of at least 1", "0"));
    }
    let error = text.error.unwrap_or_else(|| "error_position_m".to_string());
    Ok(Bench { methods, steps_s: text.steps_s, tolerances: text.tolerances, error, repeats })
}

fn own_method(own: Option<&Value>) -> Result<Listed> {
    let base = KeyPath::of_keys(&["method"]);
    let method = own.map_or(Ok(Method::default()), |value| from_value(value, &base))?;
    Ok(Listed { label: label(&method, own), method, written: None })
}

fn listed(items: &[Value], at: Path) -> Result<Vec<Listed>> {
    if items.is_empty() {
        return Err(unexpected(at, "at least one method", "an empty list"));
    }
    let mut methods: Vec<Listed> = Vec::with_capacity(items.len());
    for (i, value) in read_list(items, &at.to_key_path())?.into_iter().enumerate() {
        let item = at.item(i, None);
        let place = if value.label.is_some() { item.key("value") } else { item }.to_key_path();
        let method: Method = from_value(&value.value, &place)?;
        let label = value.label.unwrap_or_else(|| label(&method, Some(&value.value)));
        if let Some(first) = methods.iter().position(|other| other.label == label) {
            let found = format!("`{label}`, which item {first} of the list has; write {{ label: …, value: … }}");
            return Err(unexpected(item, "a label of its own", &found));
        }
        methods.push(Listed { label, method, written: Some((value.value, place)) });
    }
    Ok(methods)
}

/// Label of a method: its word and the settings that are written; an integrator says all by its name.
fn label(method: &Method, written: Option<&Value>) -> String {
    if let Some(integrator) = method.facts().integrator {
        return format!("{} {}", method.word(), integrator.word());
    }
    let settings = written.and_then(|value| value.get(method.word())).and_then(Value::as_mapping);
    let shown = settings.into_iter().flatten().map(|(key, value)| match (key.as_str().unwrap_or_default(), value) {
        (_, Value::String(word)) => word.clone(),
        (key, Value::Number(x)) => format!("{key} {x}"),
        (key, _) => key.to_string(),
    });
    std::iter::once(method.word().to_string()).chain(shown).collect::<Vec<_>>().join(" ")
}

fn all_positive_and_once(values: &[f64], at: Path) -> Result<()> {
    for (i, x) in values.iter().enumerate() {
        positive(*x, at.item(i, None))?;
        if values[..i].contains(x) {
            return Err(unexpected(at.item(i, None), "every number once", &number(*x)));
        }
    }
    Ok(())
}
