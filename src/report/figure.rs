//! A figure as one value: what it says, its axes, its marks, and what is left out of it. It is drawn in characters
//! (`text.rs`), for a page (`plotly.rs`), and as SVG and PNG (`sheet.rs` lays it out once for both).

use super::number::{linear_ticks, log_ticks};
use serde::Serialize;
use std::collections::BTreeSet;

/// Figure of a report.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Stem of its files.
    pub name: String,
    pub title: String,
    /// Sentence that says, with numbers, what is to be seen.
    pub finding: String,
    pub x: FigureAxis,
    pub y: FigureAxis,
    pub field: Option<Shading>,
    pub marks: Vec<Mark>,
    /// Number of rows, method, what is missing, failed or pooled.
    pub notes: Vec<String>,
}

/// Axis of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureAxis {
    pub label: String,
    /// Unit of the numbers; empty for ratios, counts and words.
    pub unit: String,
    pub scale: FigureScale,
}

#[derive(Clone, Debug, PartialEq)]
pub enum FigureScale {
    Linear,
    Logarithmic,
    /// Names at 0, 1, 2, …, from the left, or from below.
    Named(Vec<String>),
}

/// Cells of a grid of named values, shaded by a number each.
#[derive(Clone, Debug, PartialEq)]
pub struct Shading {
    pub label: String,
    pub unit: String,
    pub is_share: bool,
    /// Whether the shade follows the logarithm.
    pub is_logarithmic: bool,
    pub cells: Vec<GridCell>,
}

/// GridCell of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridCell {
    pub x: usize,
    pub y: usize,
    /// None where there is nothing to say: no row, or none that counts.
    pub value: Option<f64>,
    /// What stands in the cell.
    pub text: String,
    /// All that there is to say of it.
    pub said: String,
    /// Whether a case of it has failed or is missing.
    pub is_doubtful: bool,
    /// The row of it that tells most.
    pub row: Option<usize>,
    /// Columns, and what the rows of the cell have in them.
    pub pick: Vec<(String, Picked)>,
}

/// Values of a column that a cell stands for.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Picked {
    /// One of these.
    OneOf(Vec<String>),
    /// Numbers, from the first to the last.
    Between(f64, f64),
    /// None of these.
    NoneOf(Vec<String>),
}

/// Series of points, drawn in one way.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    pub label: String,
    pub drawn: Drawn,
    /// Number of its colour and marker.
    pub colour: usize,
    pub dots: Vec<Dot>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Points, joined.
    Line,
    /// Points alone.
    Points,
    /// A law, dashed and without points.
    Dashed,
    /// Area between `low` and `high`.
    Band,
    /// A broad line behind the others.
    Front,
    /// Outline of a triangle whose slope is named.
    Triangle,
    /// Boundary in a grid: across the line of every point, open where its cells have their letters.
    Boundary,
}

/// Point of a series.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dot {
    pub x: f64,
    pub y: f64,
    /// Ends of its error bar, or of the band.
    pub low: Option<f64>,
    pub high: Option<f64>,
    pub said: String,
    /// The row that it shows.
    pub row: Option<usize>,
}

impl FigureAxis {
    /// Label with its unit.
    pub fn titled(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{} [{}]", self.label, self.unit) }
    }

    pub fn names(&self) -> Option<&[String]> {
        match &self.scale {
            FigureScale::Named(names) => Some(names),
            _ => None,
        }
    }

    /// Whether a number has a place on it.
    pub fn shows(&self, x: f64) -> bool {
        x.is_finite() && (self.scale != FigureScale::Logarithmic || x > 0.0)
    }

    /// Place on a line on which the axis is even.
    pub fn place(&self, x: f64) -> f64 {
        if self.scale == FigureScale::Logarithmic { libm::log10(x) } else { x }
    }

    /// Ticks between two values.
    pub fn ticks(&self, low: f64, high: f64) -> Vec<(f64, String)> {
        match &self.scale {
            FigureScale::Linear => linear_ticks(low, high),
            FigureScale::Logarithmic => log_ticks(low, high),
            FigureScale::Named(names) => names.iter().enumerate().map(|(i, name)| (i as f64, name.clone())).collect(),
        }
    }
}

impl Dot {
    pub fn at(x: f64, y: f64) -> Self {
        Dot { x, y, ..Dot::default() }
    }

    pub fn with_bar(self, low: f64, high: f64) -> Self {
        Dot { low: Some(low), high: Some(high), ..self }
    }

    pub fn saying(self, said: String) -> Self {
        Dot { said, ..self }
    }
}

impl Figure {
    /// Whether there is nothing to see in it.
    pub fn is_empty(&self) -> bool {
        self.field.is_none() && self.marks.iter().all(|mark| mark.dots.is_empty())
    }

    /// Dots of a mark that the axes can show.
    pub fn shown<'a>(&'a self, mark: &'a Mark) -> impl Iterator<Item = &'a Dot> {
        mark.dots.iter().filter(|dot| self.x.shows(dot.x) && self.y.shows(dot.y))
    }

    /// Runs of neighbouring dots that have a place, and those that do not between them: a line ends where nothing is to
    /// be seen.
    pub fn unbroken<'a>(&self, mark: &'a Mark, y: impl Fn(&Dot) -> Option<f64>) -> Vec<&'a [Dot]> {
        let is_seen = |dot: &Dot| self.x.shows(dot.x) && y(dot).is_some_and(|y| self.y.shows(y));
        mark.dots.split(|dot| !is_seen(dot)).filter(|run| !run.is_empty()).collect()
    }

    /// Outlines of a band, one for every run of it; what is 0 on a logarithmic axis lies at its end.
    pub fn outlines(&self, mark: &Mark) -> Vec<Vec<(f64, f64)>> {
        let floor = self.extent()[1].0;
        let low = |dot: &Dot| (dot.x, dot.low.filter(|y| self.y.shows(*y)).unwrap_or(floor));
        let outline = |run: &[Dot]| {
            let high = run.iter().filter_map(|dot| Some((dot.x, dot.high?)));
            high.chain(run.iter().rev().map(low)).collect()
        };
        self.unbroken(mark, |dot| dot.high).into_iter().map(outline).collect()
    }

    /// Shift of every mark to the right, as a part of the axis: error bars of several series at one place stand side by
    /// side.
    pub fn asides(&self) -> Vec<f64> {
        /// Between two neighbours, and between the first and the last one at most.
        const APART: f64 = 0.008;
        const ALL: f64 = 0.04;
        let has_bars = |mark: &Mark| {
            matches!(mark.drawn, Drawn::Line | Drawn::Points) && mark.dots.iter().any(|dot| dot.high.is_some())
        };
        let barred: Vec<usize> = (0..self.marks.len()).filter(|i| has_bars(&self.marks[*i])).collect();
        let mut places = BTreeSet::new();
        let shares_a_place = |mark: &Mark| {
            let own: BTreeSet<u64> = mark.dots.iter().map(|dot| dot.x.to_bits()).collect();
            let shares = !places.is_disjoint(&own);
            places.extend(own);
            shares
        };
        let mut asides = vec![0.0; self.marks.len()];
        if self.x.names().is_none() && barred.iter().map(|i| &self.marks[*i]).any(shares_a_place) {
            let last = barred.len() as f64 - 1.0;
            let apart = APART.min(ALL / last);
            barred.iter().enumerate().for_each(|(k, i)| asides[*i] = apart * (k as f64 - 0.5 * last));
        }
        asides
    }

    /// Where a number on the x axis is drawn that is shifted by a part of the axis.
    pub fn shifted(&self, x: f64, aside: f64) -> f64 {
        if aside == 0.0 {
            return x;
        }
        let (low, high) = self.extent()[0];
        let place = self.x.place(x) + aside * (self.x.place(high) - self.x.place(low));
        if self.x.scale == FigureScale::Logarithmic { libm::exp10(place) } else { place }
    }

    /// Ends of both axes: all that is shown, with room for it.
    pub fn extent(&self) -> [(f64, f64); 2] {
        let dots = || self.marks.iter().flat_map(|mark| self.shown(mark));
        let bars = dots().flat_map(|dot| [dot.low, dot.high]).flatten().filter(|y| self.y.shows(*y));
        let x = ends(&self.x, dots().map(|dot| dot.x));
        [x, ends(&self.y, dots().map(|dot| dot.y).chain(bars))]
    }

    /// Pieces of a boundary: from half a line below each point to half a line above it, but for the middle, and along
    /// the border to the next line where that has a point too.
    pub fn pieces(mark: &Mark) -> Vec<[(f64, f64); 2]> {
        /// Half of what is left open.
        const OPEN: f64 = 0.24;
        let mut pieces = Vec::new();
        for dot in &mark.dots {
            pieces.push([(dot.x, dot.y - 0.5), (dot.x, dot.y - OPEN)]);
            pieces.push([(dot.x, dot.y + OPEN), (dot.x, dot.y + 0.5)]);
            if let Some(next) = mark.dots.iter().find(|next| next.y == dot.y + 1.0) {
                pieces.push([(dot.x, dot.y + 0.5), (next.x, dot.y + 0.5)]);
            }
        }
        pieces
    }

    /// Rows that its cells and dots show.
    pub fn rows(&self) -> impl Iterator<Item = usize> {
        let cells = self.field.iter().flat_map(|field| field.cells.iter().filter_map(|cell| cell.row));
        cells.chain(self.marks.iter().flat_map(|mark| mark.dots.iter().filter_map(|dot| dot.row)))
    }
}

fn ends(axis: &FigureAxis, values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    match &axis.scale {
        FigureScale::Named(names) => (-0.5, names.len().max(1) as f64 - 0.5),
        FigureScale::Logarithmic if low <= high => {
            let (low, high) = (libm::log10(low), libm::log10(high));
            let room = (0.06 * (high - low)).max(0.08);
            (libm::exp10(low - room), libm::exp10(high + room))
        }
        FigureScale::Logarithmic => (0.1, 10.0),
        FigureScale::Linear if low <= high => {
            let room = 0.06 * (high - low).max(1e-3 * low.abs().max(high.abs()));
            if room > 0.0 { (low - room, high + room) } else { (-1.0, 1.0) }
        }
        FigureScale::Linear => (0.0, 1.0),
    }
}
