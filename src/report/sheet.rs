//! A figure laid out once, in strokes, areas and letters, for SVG and PNG alike. Lengths are pixels of the SVG.

use super::figure::{Dot, Drawn, Figure, FigureScale, Mark, Shading};
use super::number::{cut, log_ticks, short, wrapped};
use super::palette::{COLOURS, MARKERS, NUMBERS, SHARES, Shade, is_dark, shade};

pub const WIDTH: f64 = 960.0;
pub const HEIGHT: f64 = 600.0;

/// What something is drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ink {
    Letters,
    Muted,
    Grid,
    Paper,
    Fixed(Shade),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextAnchor {
    Start,
    Middle,
    End,
}

/// One thing that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Stroke {
    Area {
        points: Vec<(f64, f64)>,
        ink: Ink,
        opacity: f64,
        said: String,
    },
    Path {
        points: Vec<(f64, f64)>,
        ink: Ink,
        width: f64,
        opacity: f64,
    },
    /// Letters around a point: `y` is the middle of their height. `up`: turned to be read from the right.
    Letters {
        x: f64,
        y: f64,
        size: f64,
        anchor: TextAnchor,
        ink: Ink,
        bold: bool,
        up: bool,
        text: String,
    },
}

/// A figure laid out.
pub struct Sheet {
    pub strokes: Vec<Stroke>,
    frame: Rect,
    x: (f64, f64),
    y: (f64, f64),
}

#[derive(Clone, Copy)]
struct Rect {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

const MARGIN: f64 = 24.0;
const LEGEND: f64 = 236.0;
const SMALL: f64 = 12.0;
const RADIUS: f64 = 4.2;

/// Width of letters of this size, nearly.
fn width(text: &str, size: f64) -> f64 {
    0.6 * size * text.chars().count() as f64
}

impl Sheet {
    pub fn of(figure: &Figure) -> Self {
        let mut strokes = Vec::new();
        let mut top = 32.0;
        for line in wrapped(&figure.title, 78) {
            strokes.push(letters(MARGIN, top, 19.0, TextAnchor::Start, Ink::Letters, &line).bold());
            top += 24.0;
        }
        top += 2.0;
        for line in wrapped(&figure.finding, 122) {
            strokes.push(letters(MARGIN, top, 13.0, TextAnchor::Start, Ink::Muted, &line));
            top += 18.0;
        }
        let notes = wrapped(&figure.notes.join("; "), 150);
        let mut bottom = HEIGHT - 18.0;
        for line in notes.iter().rev() {
            strokes.push(letters(MARGIN, bottom, 11.0, TextAnchor::Start, Ink::Muted, line));
            bottom -= 15.0;
        }
        let [x, y] = figure.extent();
        let y_ticks = figure.y.ticks(y.0, y.1);
        let ticks_wide = y_ticks.iter().map(|(_, text)| width(&cut(text, 24), SMALL)).fold(0.0, f64::max);
        let has_legend = figure.field.is_some() || figure.marks.len() > 1;
        let frame = Rect {
            left: MARGIN + 26.0 + ticks_wide + 8.0,
            top: top + 8.0,
            right: WIDTH - if has_legend { LEGEND } else { MARGIN + 12.0 },
            bottom: bottom - 50.0,
        };
        let mut sheet = Sheet { strokes, frame, x: place(figure, x, true), y: place(figure, y, false) };
        sheet.axes(figure, x, &y_ticks);
        if let Some(field) = &figure.field {
            sheet.cells(figure, field);
        }
        for (mark, aside) in figure.marks.iter().zip(figure.asides()) {
            sheet.mark(figure, mark, aside);
        }
        if has_legend {
            sheet.legend(figure);
        }
        sheet
    }

    /// Pixel of a point of the figure.
    pub fn at(&self, figure: &Figure, x: f64, y: f64) -> (f64, f64) {
        let part = |place: f64, (low, high): (f64, f64)| (place - low) / (high - low);
        let (x, y) = (part(figure.x.place(x), self.x), part(figure.y.place(y), self.y));
        let Rect { left, top, right, bottom } = self.frame;
        (left + x * (right - left), bottom - y * (bottom - top))
    }

    fn axes(&mut self, figure: &Figure, x: (f64, f64), y_ticks: &[(f64, String)]) {
        let Rect { left, top, right, bottom } = self.frame;
        let x_ticks = figure.x.ticks(x.0, x.1);
        let is_named = |scale: &FigureScale| matches!(scale, FigureScale::Named(_));
        // Names that would run into each other are turned over two lines, or every so many left out.
        let room = (right - left) / x_ticks.len().max(1) as f64;
        let longest = x_ticks.iter().map(|(_, text)| width(text, SMALL) + 8.0).fold(0.0, f64::max);
        let every = if longest > 2.0 * room { (longest / (2.0 * room)).ceil() as usize } else { 1 };
        for (i, (value, text)) in x_ticks.iter().enumerate() {
            let at = self.at(figure, *value, 1.0).0;
            if !is_named(&figure.x.scale) {
                self.path(&[(at, top), (at, bottom)], Ink::Grid, 1.0);
            }
            if i % every == 0 {
                let lower = if longest > room && (i / every) % 2 == 1 { 14.0 } else { 0.0 };
                self.strokes.push(letters(
                    at,
                    bottom + 14.0 + lower,
                    SMALL,
                    TextAnchor::Middle,
                    Ink::Letters,
                    &cut(text, 24),
                ));
            }
        }
        for (value, text) in y_ticks {
            let at = self.at(figure, 1.0, *value).1;
            if !is_named(&figure.y.scale) {
                self.path(&[(left, at), (right, at)], Ink::Grid, 1.0);
            }
            self.strokes.push(letters(left - 8.0, at, SMALL, TextAnchor::End, Ink::Letters, &cut(text, 24)));
        }
        if figure.field.is_none() {
            self.path(&[(left, top), (left, bottom), (right, bottom)], Ink::Muted, 1.2);
        }
        let middle = 0.5 * (left + right);
        let left_out = if every > 1 { format!(" (one of {every} is named)") } else { String::new() };
        let title = figure.x.titled() + &left_out;
        self.strokes.push(letters(middle, bottom + 42.0, 13.0, TextAnchor::Middle, Ink::Letters, &cut(&title, 80)));
        let mut up = letters(
            MARGIN + 6.0,
            0.5 * (top + bottom),
            13.0,
            TextAnchor::Middle,
            Ink::Letters,
            &cut(&figure.y.titled(), 52),
        );
        if let Stroke::Letters { up, .. } = &mut up {
            *up = true;
        }
        self.strokes.push(up);
    }

    fn cells(&mut self, figure: &Figure, field: &Shading) {
        let scale = field.scale();
        for cell in &field.cells {
            let (x, y) = (cell.x as f64, cell.y as f64);
            let ((left, bottom), (right, top)) = (self.at(figure, x - 0.5, y - 0.5), self.at(figure, x + 0.5, y + 0.5));
            let (left, right, top, bottom) = (left + 1.0, right - 1.0, top + 1.0, bottom - 1.0);
            let corners = vec![(left, top), (right, top), (right, bottom), (left, bottom)];
            let middle = (0.5 * (left + right), 0.5 * (top + bottom));
            let ink = match cell.value {
                Some(value) => {
                    let colour = field.colour(scale, value);
                    self.strokes.push(Stroke::Area {
                        points: corners,
                        ink: Ink::Fixed(colour),
                        opacity: 1.0,
                        said: cell.said.clone(),
                    });
                    Ink::Fixed(if is_dark(colour) { (255, 255, 255) } else { (30, 30, 30) })
                }
                None => {
                    // Nothing is known: an empty frame, crossed.
                    self.strokes.push(Stroke::Area {
                        points: corners,
                        ink: Ink::Paper,
                        opacity: 1.0,
                        said: cell.said.clone(),
                    });
                    self.path(&[(left, bottom), (right, top)], Ink::Grid, 1.0);
                    Ink::Muted
                }
            };
            if cell.is_doubtful {
                let corner = vec![(right, top), (right - 9.0, top), (right, top + 9.0)];
                self.strokes.push(Stroke::Area {
                    points: corner,
                    ink: Ink::Fixed((0, 114, 178)),
                    opacity: 1.0,
                    said: cell.said.clone(),
                });
            }
            let size = SMALL.min((right - left) / (0.62 * cell.text.chars().count().max(3) as f64));
            if size > 6.0 && bottom - top > size {
                self.strokes.push(letters(middle.0, middle.1, size, TextAnchor::Middle, ink, &cell.text));
            }
        }
    }

    fn mark(&mut self, figure: &Figure, mark: &Mark, aside: f64) {
        let ink = Ink::Fixed(COLOURS[mark.colour % COLOURS.len()]);
        let dots: Vec<&Dot> = figure.shown(mark).collect();
        let points: Vec<(f64, f64)> =
            dots.iter().map(|dot| self.at(figure, figure.shifted(dot.x, aside), dot.y)).collect();
        match mark.drawn {
            Drawn::Front => self.strokes.push(Stroke::Path { points, ink: Ink::Muted, width: 11.0, opacity: 0.22 }),
            Drawn::Dashed => self.dashed(&points, ink),
            Drawn::Boundary => {
                for (ink, width) in [(Ink::Paper, 6.0), (ink, 2.6)] {
                    for piece in Figure::pieces(mark) {
                        self.path(&piece.map(|(x, y)| self.at(figure, x, y)), ink, width);
                    }
                }
            }
            Drawn::Triangle => {
                self.path(&points, Ink::Muted, 1.4);
                if let [_, low, high, ..] = points[..] {
                    let order = mark.label.trim_start_matches("order ");
                    let (x, y) = (high.0 + 5.0, 0.5 * (low.1 + high.1));
                    self.strokes.push(letters(x, y, SMALL, TextAnchor::Start, Ink::Muted, order));
                }
            }
            Drawn::Band => {
                for outline in figure.outlines(mark) {
                    let points = outline.into_iter().map(|(x, y)| self.at(figure, x, y)).collect();
                    self.strokes.push(Stroke::Area { points, ink, opacity: 0.16, said: mark.label.clone() });
                }
            }
            Drawn::Line | Drawn::Points => {
                if mark.drawn == Drawn::Line {
                    for run in figure.unbroken(mark, |dot| Some(dot.y)) {
                        let at = |dot: &Dot| self.at(figure, figure.shifted(dot.x, aside), dot.y);
                        self.path(&run.iter().map(at).collect::<Vec<_>>(), ink, 2.0);
                    }
                }
                for (dot, at) in dots.iter().zip(&points) {
                    if let (Some(low), Some(high)) = (dot.low, dot.high) {
                        let x = figure.shifted(dot.x, aside);
                        self.bar(figure, (x, low), (x, high), ink);
                    }
                    self.marker(mark.colour, *at, &dot.said);
                }
            }
        }
    }

    /// An error bar, with its caps.
    fn bar(&mut self, figure: &Figure, low: (f64, f64), high: (f64, f64), ink: Ink) {
        if !(figure.y.shows(low.1) && figure.y.shows(high.1)) || low == high {
            return;
        }
        let (a, b) = (self.at(figure, low.0, low.1), self.at(figure, high.0, high.1));
        let caps = [a, b].map(|(x, y)| [(x - 3.5, y), (x + 3.5, y)]);
        for points in [[a, b], caps[0], caps[1]] {
            self.strokes.push(Stroke::Path { points: points.to_vec(), ink, width: 1.2, opacity: 0.6 });
        }
    }

    fn marker(&mut self, colour: usize, at: (f64, f64), said: &str) {
        let ink = Ink::Fixed(COLOURS[colour % COLOURS.len()]);
        for outline in MARKERS[colour % MARKERS.len()] {
            let points = outline.iter().map(|(x, y)| (at.0 + RADIUS * x, at.1 + RADIUS * y)).collect();
            self.strokes.push(Stroke::Area { points, ink, opacity: 1.0, said: said.to_string() });
        }
    }

    fn path(&mut self, points: &[(f64, f64)], ink: Ink, width: f64) {
        self.strokes.push(Stroke::Path { points: points.to_vec(), ink, width, opacity: 1.0 });
    }

    fn dashed(&mut self, points: &[(f64, f64)], ink: Ink) {
        const DASH: f64 = 7.0;
        for pair in points.windows(2) {
            let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            let length = (dx * dx + dy * dy).sqrt();
            let at = |along: f64| (pair[0].0 + dx * along / length, pair[0].1 + dy * along / length);
            for i in 0..(length / (2.0 * DASH)).ceil() as usize {
                let from = 2.0 * DASH * i as f64;
                self.path(&[at(from), at((from + DASH).min(length))], ink, 1.5);
            }
        }
    }

    fn legend(&mut self, figure: &Figure) {
        let (left, mut y) = (self.frame.right + 20.0, self.frame.top + 8.0);
        if let Some(field) = &figure.field {
            y = self.bar_of_colours(field, left, y) + 26.0;
        }
        for mark in &figure.marks {
            let is_beside = matches!(mark.drawn, Drawn::Triangle | Drawn::Band | Drawn::Dashed);
            if is_beside || mark.dots.is_empty() || y > self.frame.bottom {
                continue;
            }
            let ink = Ink::Fixed(COLOURS[mark.colour % COLOURS.len()]);
            let line = [(left, y), (left + 24.0, y)];
            match mark.drawn {
                Drawn::Front => self.strokes.push(Stroke::Path {
                    points: line.to_vec(),
                    ink: Ink::Muted,
                    width: 9.0,
                    opacity: 0.22,
                }),
                Drawn::Line | Drawn::Points => {
                    if mark.drawn == Drawn::Line {
                        self.path(&line, ink, 2.0);
                    }
                    self.marker(mark.colour, (left + 12.0, y), "");
                }
                Drawn::Boundary => self.path(&line, ink, 2.6),
                Drawn::Triangle | Drawn::Band | Drawn::Dashed => {}
            }
            for line in wrapped(&mark.label, 26).into_iter().take(3) {
                self.strokes.push(letters(left + 32.0, y, 11.0, TextAnchor::Start, Ink::Letters, &line));
                y += 14.0;
            }
            y += 7.0;
        }
    }

    /// The shades and what they mean; returns where it ends.
    fn bar_of_colours(&mut self, field: &Shading, left: f64, top: f64) -> f64 {
        const STEPS: usize = 60;
        const HIGH: f64 = 190.0;
        let scale = field.scale();
        let mut y = top;
        for line in wrapped(&field.titled(), 26) {
            self.strokes.push(letters(left, y, SMALL, TextAnchor::Start, Ink::Letters, &line));
            y += 15.0;
        }
        let top = y;
        for i in 0..STEPS {
            let part = (i as f64 + 0.5) / STEPS as f64;
            let colour = shade(field.shades(), part);
            let (high, low) =
                (top + HIGH * (1.0 - (i + 1) as f64 / STEPS as f64), top + HIGH * (1.0 - i as f64 / STEPS as f64));
            let points = vec![(left, high), (left + 18.0, high), (left + 18.0, low + 0.4), (left, low + 0.4)];
            self.strokes.push(Stroke::Area { points, ink: Ink::Fixed(colour), opacity: 1.0, said: String::new() });
        }
        for (part, text) in field.ticks(scale) {
            self.strokes.push(letters(
                left + 24.0,
                top + HIGH * (1.0 - part),
                11.0,
                TextAnchor::Start,
                Ink::Letters,
                &text,
            ));
        }
        top + HIGH
    }
}

fn place(figure: &Figure, (low, high): (f64, f64), is_x: bool) -> (f64, f64) {
    let axis = if is_x { &figure.x } else { &figure.y };
    (axis.place(low), axis.place(high))
}

fn letters(x: f64, y: f64, size: f64, anchor: TextAnchor, ink: Ink, text: &str) -> Stroke {
    Stroke::Letters { x, y, size, anchor, ink, bold: false, up: false, text: text.to_string() }
}

impl Stroke {
    fn bold(mut self) -> Self {
        if let Stroke::Letters { bold, .. } = &mut self {
            *bold = true;
        }
        self
    }
}

impl Shading {
    pub fn titled(&self) -> String {
        if self.unit.is_empty() { self.label.clone() } else { format!("{} [{}]", self.label, self.unit) }
    }

    pub fn shades(&self) -> &'static [Shade] {
        if self.is_share { &SHARES } else { &NUMBERS }
    }

    /// Values of the palest and the darkest shade; of shares always none and all.
    pub fn scale(&self) -> (f64, f64) {
        if self.is_share {
            return (0.0, 1.0);
        }
        let values = self.cells.iter().filter_map(|cell| cell.value).filter(|x| !self.is_logarithmic || *x > 0.0);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let alone = low.clamp(1e-300, 1e300);
        if low < high { (low, high) } else { (0.5 * alone, alone) }
    }

    /// Place of a value among the shades, from 0 to 1.
    pub fn part(&self, (low, high): (f64, f64), value: f64) -> f64 {
        let place = |x: f64| if self.is_logarithmic { libm::log10(x.max(1e-300)) } else { x };
        ((place(value) - place(low)) / (place(high) - place(low))).clamp(0.0, 1.0)
    }

    pub fn colour(&self, scale: (f64, f64), value: f64) -> Shade {
        shade(self.shades(), self.part(scale, value))
    }

    /// Places among the shades, from 0 to 1, with what stands at them.
    pub fn ticks(&self, scale: (f64, f64)) -> Vec<(f64, String)> {
        if self.is_share {
            return [(0.0, "0%"), (0.25, "25%"), (0.5, "50%"), (0.75, "75%"), (1.0, "100%")]
                .map(|(at, t)| (at, t.into()))
                .to_vec();
        }
        let values = match self.is_logarithmic {
            true => log_ticks(scale.0, scale.1),
            false => [0.0, 0.5, 1.0].map(|part| scale.0 + part * (scale.1 - scale.0)).map(|x| (x, short(x))).to_vec(),
        };
        values.into_iter().map(|(x, text)| (self.part(scale, x), text)).collect()
    }
}
