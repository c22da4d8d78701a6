//! Choice of the cases of a sweep that are recorded.
//!
//! Rules that ask for an outcome are answered after the rows are there: the chosen cases run once more with their
//! recorders on, which gives the same bits.

use crate::experiment::types::RecordCases;
use crate::outcome::Outcome;
use crate::rows::Measured;

/// Number of cases of `few`: what a person can look at, and 24 files of some MB each.
pub const FEW: usize = 24;

/// Indices of the cases to record, known before anything has run.
pub fn known_before(rule: RecordCases, cases: usize) -> Option<Vec<usize>> {
    match rule {
        // What fails is chosen by verdicts, of which rows know nothing.
        RecordCases::None | RecordCases::Failing => Some(Vec::new()),
        RecordCases::All => Some((0..cases).collect()),
        RecordCases::First => Some((0..cases.min(1)).collect()),
        RecordCases::Sample(count) => Some(evenly(&(0..cases).collect::<Vec<_>>(), count as usize)),
        RecordCases::Few if cases <= FEW => Some((0..cases).collect()),
        RecordCases::Few | RecordCases::Diverged => None,
    }
}

/// Indices of the cases to record, from what all cases measured (in plan order; None where there is no row).
pub fn known_after(rule: RecordCases, measured: &[Option<&Measured>]) -> Vec<usize> {
    if let Some(known) = known_before(rule, measured.len()) {
        return known;
    }
    let with = |is: fn(Outcome) -> bool| -> Vec<usize> {
        let outcome = |i: &usize| measured[*i].map(|m| m.outcome);
        (0..measured.len()).filter(|i| outcome(i).is_some_and(is)).collect()
    };
    let diverged = with(|outcome| outcome == Outcome::Diverged);
    if rule == RecordCases::Diverged {
        return diverged;
    }
    let others = with(|outcome| matches!(outcome, Outcome::Finished | Outcome::Stalled));
    let half = FEW / 2;
    let from_diverged = diverged.len().min(half.max(FEW.saturating_sub(others.len())));
    let mut chosen = evenly(&diverged, from_diverged);
    chosen.extend(evenly(&others, FEW - from_diverged));
    chosen.sort_unstable();
    chosen
}

/// `count` of the items, evenly through their order.
fn evenly(items: &[usize], count: usize) -> Vec<usize> {
    let count = count.min(items.len());
    (0..count).map(|i| items[i * items.len() / count]).collect()
}
