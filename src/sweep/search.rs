//! Critical value of a key, by bisection (L3), in every cell of the axes.
//!
//! A value counts as reached when the condition holds in the stated share of the runs that are tried together (all
//! seeds, say; the same ones at every value). Between an end where it is reached and one where it is not, the bracket
//! is halved: in the logarithm where both ends are positive, in whole numbers where the key wants them. What remains
//! has one end of each kind. Over chaotic runs the share is noisy and need not be monotone: the result is one crossing.

use super::build::{build, columns};
use super::cell::Cell;
use super::planned::Planned;
use crate::case::Case;
use crate::experiment::search::Search;
use crate::experiment::{ExperimentError, ExperimentFile, Number};
use rayon::prelude::*;
use serde_json::Map;
use std::sync::Arc;

/// Rows of all cells in plan order, both ends of every bracket resolved and built.
///
/// # Errors
/// The first wrong case; a column that the condition names and no row has.
pub fn cases(file: &ExperimentFile, search: &Search, name: &str) -> Result<Vec<Planned>, ExperimentError> {
    let axes = file.axes();
    let shared = Arc::new(file.clone());
    let points = (0..axes.len()).map(|i| axes.point(i));
    let firsts: Vec<_> = points.filter(|point| search.over.is_none_or(|over| point[over] == 0)).collect();
    let whole = wants_whole(file, search, firsts.first().map_or(&[], Vec::as_slice));
    let cell = |first: &Vec<usize>| {
        let member = |value: usize| {
            let mut point = first.clone();
            if let Some(over) = search.over {
                point[over] = value;
            }
            point
        };
        let members = search.over.map_or(1, |over| axes.axes[over].values.len());
        let members = (0..members).map(member).collect();
        Cell { file: shared.clone(), search: search.clone(), members, whole }
    };
    firsts.par_iter().map(|first| case(cell(first), first, name)).collect::<Vec<_>>().into_iter().collect()
}

fn case(cell: Cell, first: &[usize], name: &str) -> Result<Planned, ExperimentError> {
    let (file, search) = (&cell.file, &cell.search);
    let mut ends = Vec::with_capacity(2 * cell.members.len());
    for end in &search.between {
        for point in &cell.members {
            let experiment = file.searched_case(point, end)?;
            build(file, point, &experiment)?;
            ends.push(experiment);
        }
    }
    let over = search.over.map(|over| file.axes().axes[over].path.clone());
    let axes: Map<_, _> = columns(file.axes(), first).filter(|(path, _)| Some(path) != over.as_ref()).collect();
    let planned = Planned::new(file, Case::of_search(cell.rule(), ends, axes), first.to_vec(), name);
    Ok(Planned { search: Some(Box::new(cell)), ..planned })
}

/// Both ends are whole, and between them nothing else is accepted.
fn wants_whole(file: &ExperimentFile, search: &Search, first: &[usize]) -> bool {
    let [low, high] = &search.between;
    let half = Number::from(low.as_f64().unwrap_or_default() + 0.5);
    !low.is_f64() && !high.is_f64() && file.searched_case(first, &half).is_err()
}
