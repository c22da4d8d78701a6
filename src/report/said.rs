//! The numbers of a figure as text and as a table: what every drawing of it has with it.

use super::figure::{Drawn, Figure};
use serde_json::{Value, json};

/// Number of JSON; null where it is not finite.
fn number(x: f64) -> Value {
    json!(x)
}

/// All numbers of a figure as JSON.
pub fn numbers(figure: &Figure) -> String {
    let cells: Vec<Value> =
        figure.field.iter().flat_map(|field| &field.cells).map(|cell| json!([cell.x, cell.y, cell.value])).collect();
    let marks: Vec<Value> = figure
        .marks
        .iter()
        .map(|mark| {
            let dots: Vec<Value> =
                mark.dots.iter().map(|dot| json!([number(dot.x), number(dot.y), dot.low, dot.high])).collect();
            json!({ "label": mark.label, "dots": dots })
        })
        .collect();
    let axis = |axis: &super::figure::FigureAxis| json!({ "label": axis.titled(), "names": axis.names() });
    json!({ "x": axis(&figure.x), "y": axis(&figure.y), "cells": cells, "marks": marks }).to_string()
}

/// The numbers as a table: headings, and rows of words.
pub fn table(figure: &Figure) -> (Vec<String>, Vec<Vec<String>>) {
    let name = |names: Option<&[String]>, i: usize| names.and_then(|names| names.get(i).cloned()).unwrap_or_default();
    if let Some(field) = &figure.field {
        let headings = vec![figure.x.titled(), figure.y.titled(), field.titled(), "what it is".to_string()];
        let row = |cell: &super::figure::GridCell| {
            let value = cell.value.map_or("–".to_string(), |value| value.to_string());
            vec![name(figure.x.names(), cell.x), name(figure.y.names(), cell.y), value, cell.said.clone()]
        };
        return (headings, field.cells.iter().map(row).collect());
    }
    let headings = ["series", &figure.x.titled(), &figure.y.titled(), "from", "to"].map(str::to_string).to_vec();
    let is_told = |mark: &&super::figure::Mark| !matches!(mark.drawn, Drawn::Front | Drawn::Triangle);
    let rows = figure.marks.iter().filter(is_told).flat_map(|mark| {
        mark.dots.iter().filter(|dot| !dot.y.is_nan()).map(move |dot| {
            let x = figure.x.names().map_or(dot.x.to_string(), |names| name(Some(names), dot.x as usize));
            let end = |end: Option<f64>| end.map_or(String::new(), |end| end.to_string());
            vec![mark.label.clone(), x, dot.y.to_string(), end(dot.low), end(dot.high)]
        })
    });
    (headings, rows.collect())
}
