//! Which figures a subject has, by what its data are.

use super::figure::Figure;
use super::subject::{Ground, Subject};
use super::{convergence, critical, ensemble, map, pareto, share, tried, work};

/// Most values on an axis of a page's map.
const MOST: usize = 40;
/// Most places along a line, and most critical values.
const MOST_PLACES: usize = 200;
const MOST_CRITICAL: usize = 1000;
/// Most values on an axis of a terminal's map.
pub const MOST_IN_CHARACTERS: usize = 12;

/// Figures of a subject, the most telling first.
pub fn figures(subject: &Subject) -> Vec<Figure> {
    let ground = Ground::of(subject);
    let coarse = ground.pooled(MOST_PLACES);
    let tried = tried::trials(&coarse);
    let alone = tried::alone(&coarse);
    // What is not among the trials is said where their figures say what they find.
    let of_trials = |mut figure: Figure| {
        figure.finding += &alone;
        figure
    };
    let is_grid = ground.chosen().count() > 1 && !subject.is_bench;
    let title = "Run time against error";
    let all = [
        is_grid.then(|| map::map(&ground, MOST)).flatten(),
        Some(of_trials(pareto::figure(title, &tried, &subject.magnitudes)))
            .filter(|figure| figure.marks.iter().any(|mark| figure.shown(mark).next().is_some())),
        convergence::figure(&tried, &subject.magnitudes).map(of_trials),
        critical::figure(&ground.pooled(MOST_CRITICAL)),
        share::figure(&coarse),
        ensemble::figure(&coarse),
        work::figure(&coarse),
    ];
    let mut figures: Vec<Figure> = all.into_iter().flatten().filter(|figure| !figure.is_empty()).collect();
    // Work alone says nothing of how the runs went.
    if figures.iter().all(|figure| figure.name == "work") {
        figures.splice(0..0, map::map(&ground, MOST));
    }
    figures
}

/// The map of a subject as a terminal shows it. None without an axis.
pub fn map_in_characters(subject: &Subject) -> Option<Figure> {
    let ground = Ground::of(subject);
    // Fewer columns where their numbers have no room.
    let maps = (4..=MOST_IN_CHARACTERS).rev().map(|most| map::map(&ground, most));
    maps.flatten().find(Figure::has_room).or_else(|| map::map(&ground, 4))
}
