//! Checks, before the first run, that what an expectation or a search names exists; errors have file, line and key.

use super::schema::Schema;
use crate::experiment::ExperimentError;
use crate::experiment::expect::{Expectation, What};
use crate::experiment::filter::{Condition, Filter, is_same, shown_cell};
use crate::experiment::key_path::{KeyPath, Path};
use crate::experiment::predicate::{Column, Predicate, Quantity};
use crate::experiment::search::{Search, search_path};
use crate::heading::CellKind;
use crate::outcome::Criterion;
use crate::rows::columns;

type Result = std::result::Result<(), ExperimentError>;

/// Checks every name of expectations and search against the columns and axes that rows will have.
///
/// # Errors
/// The first name or value that nothing has, or a column of texts where numbers are needed. The error has no file and
/// line yet.
pub fn refuse_unknown(schema: &Schema, expectations: &[Expectation], search: Option<&Search>) -> Result {
    let base = KeyPath::of_keys(&["expect"]);
    let at = Path::Base(&base);
    for (i, expectation) in expectations.iter().enumerate() {
        one(schema, expectation, at.item(i, None))?;
    }
    let base = search_path();
    search.map_or(Ok(()), |search| predicate(schema, &search.until, Path::Base(&base).key("until")))
}

fn one(schema: &Schema, expectation: &Expectation, at: Path) -> Result {
    filter(schema, &expectation.rows, at.key("where"))?;
    match &expectation.what {
        What::Column { column, .. } => numbers(schema, column, at.key("column")),
        What::Fraction { of, .. } => predicate(schema, of, at.key("fraction")),
        What::Trend { of, along, .. } => {
            quantity(schema, of, at.key("trend"))?;
            known(schema, along, at.key("along"))
        }
        What::Order { column, against, .. } => {
            numbers(schema, column, at.key("order"))?;
            numbers(schema, &Column::new(against), at.key("against"))
        }
        What::Equal { column, across, .. } => {
            if schema.vectors(column).is_empty() {
                known(schema, column, at.key("equal"))?;
            }
            axis(schema, across, at.key("across"))
        }
        What::Compare { how, quantity: compared, of, to, .. } => {
            quantity(schema, compared, at.key(how.name()))?;
            filter(schema, of, at.key("of"))?;
            filter(schema, to, at.key("to"))
        }
    }
}

fn quantity(schema: &Schema, quantity: &Quantity, at: Path) -> Result {
    match quantity {
        Quantity::Column(column) => numbers(schema, column, at),
        Quantity::Fraction(of) => predicate(schema, of, at),
    }
}

fn predicate(schema: &Schema, of: &Predicate, at: Path) -> Result {
    match of {
        Predicate::Outcome(_) => Ok(()),
        Predicate::Criterion(name) => one_of(Criterion::ALL.map(Criterion::name), name, at.key("criterion")),
        Predicate::Column { column, .. } => numbers(schema, column, at.key("column")),
    }
}

/// Checks that a column, or both of a quotient, are columns of numbers.
///
/// # Errors
/// A name that no column has, or a column of texts.
pub fn numbers(schema: &Schema, column: &Column, at: Path) -> Result {
    for name in column.names() {
        known(schema, name, at)?;
        let is_text = |values: &[serde_json::Value]| !values.iter().any(serde_json::Value::is_number);
        if columns::kind(name) == Some(CellKind::Text) || schema.axis(name).is_some_and(is_text) {
            let found = format!("`{name}`, which is text");
            return Err(ExperimentError::unexpected(at.to_key_path(), "a column of numbers", &found));
        }
    }
    Ok(())
}

fn known(schema: &Schema, name: &str, at: Path) -> Result {
    one_of(schema.columns.iter().map(String::as_str), name, at)
}

fn axis(schema: &Schema, name: &str, at: Path) -> Result {
    one_of(schema.axes.iter().map(|(path, _)| path.as_str()), name, at)
}

fn one_of<'a>(known: impl IntoIterator<Item = &'a str>, name: &str, at: Path) -> Result {
    let known: Vec<&str> = known.into_iter().collect();
    if known.contains(&name) { Ok(()) } else { Err(ExperimentError::unknown_word(at.to_key_path(), name, &known)) }
}

fn filter(schema: &Schema, filter: &Filter, at: Path) -> Result {
    for (name, condition) in &filter.0 {
        let here = at.key(name);
        known(schema, name, here)?;
        match (schema.axis(name), condition) {
            (Some(values), Condition::Is(wanted)) => {
                let missing = wanted.iter().find(|wanted| !values.iter().any(|value| is_same(value, wanted)));
                if let Some(missing) = missing {
                    let shown: Vec<String> = values.iter().map(shown_cell).collect();
                    let known: Vec<&str> = shown.iter().map(String::as_str).collect();
                    return Err(ExperimentError::unknown_word(here.to_key_path(), &shown_cell(missing), &known));
                }
            }
            (_, Condition::Bounds(_)) => numbers(schema, &Column { name: name.clone(), divided_by: None }, here)?,
            _ => {}
        }
    }
    Ok(())
}
