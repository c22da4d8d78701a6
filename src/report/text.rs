//! A figure in characters, for a terminal.

use super::figure::{Drawn, Figure, GridCell, Shading};
use super::number::{cut, plain, short, wrapped};
use super::palette::{COLOURS, ansi, is_dark};

/// Letters that a line has.
pub const LINE: usize = 80;
/// Size of the area of a plot.
const ACROSS: usize = 60;
const DOWN: usize = 16;

/// What stands in a cell, with a sign of doubt.
fn in_cell(cell: &GridCell) -> String {
    format!("{}{}", cell.text, if cell.is_doubtful { "!" } else { "" })
}

/// The name of a column in so many letters: a range that is too long is where it begins.
fn headed(name: &str, most: usize) -> String {
    match name.split_once('…') {
        Some((first, _)) if name.chars().count() > most && first.chars().count() < most => format!("{first}…"),
        _ => cut(name, most),
    }
}

impl Figure {
    /// The figure in lines of at most 80 letters; `colour` shades cells and letters for a terminal.
    pub fn characters(&self, colour: bool) -> String {
        let mut lines =
            wrapped(&plain(&format!("{}. {}", self.title.trim_end_matches(['.', '?']), self.finding)), LINE);
        lines.push(String::new());
        match &self.field {
            Some(field) => lines.extend(self.grid(field, colour)),
            None => lines.extend(self.plot(colour)),
        }
        lines.extend(wrapped(&plain(&self.notes.join("; ")), LINE));
        lines.iter().map(|line| line.trim_end()).collect::<Vec<_>>().join("\n")
    }

    /// Whether a line has room for the numbers of all columns.
    pub fn has_room(&self) -> bool {
        let Some(field) = &self.field else { return true };
        let widest = field.cells.iter().map(|cell| in_cell(cell).chars().count()).max().unwrap_or(1);
        self.label_width() + self.x.names().map_or(0, <[String]>::len) * (widest + 1) < LINE
    }

    fn label_width(&self) -> usize {
        let names = self.y.names().unwrap_or_default().iter();
        names.map(|name| name.chars().count()).max().unwrap_or(0).clamp(3, 18)
    }

    fn grid(&self, field: &Shading, colour: bool) -> Vec<String> {
        let (columns, rows) = (self.x.names().unwrap_or_default(), self.y.names().unwrap_or_default());
        let heads: Vec<String> = columns.iter().map(|name| plain(name)).collect();
        let label = self.label_width();
        let widest = field.cells.iter().map(|cell| in_cell(cell).chars().count()).max().unwrap_or(1);
        let longest = heads.iter().map(|head| head.chars().count()).max().unwrap_or(1);
        let room = (LINE - label - 1) / columns.len().max(1);
        // Heads that have no room stand on two lines in turn, and are cut where that is not enough.
        let wide = longest.max(widest).saturating_add(1).min(room).max((widest + 1).min(room));
        let is_staggered = longest + 1 > wide;
        let mut lines = wrapped(
            &plain(&format!("{} by {} (across) and {} (down)", field.titled(), self.x.titled(), self.y.titled())),
            LINE,
        );
        if rows.len() == 1 {
            lines = wrapped(&plain(&format!("{} by {}", field.titled(), self.x.titled())), LINE);
        }
        let turns = if is_staggered { 2 } else { 1 };
        for turn in 0..turns {
            // The first one may reach over the names of the lines.
            let mut line = String::new();
            for (i, head) in heads.iter().enumerate().filter(|(i, _)| i % turns == turn) {
                let end = label + (i + 1) * wide;
                let head = headed(head, wide * turns - 1);
                let gap = end.saturating_sub(line.chars().count() + head.chars().count()).max(usize::from(i >= turns));
                line += &format!("{}{head}", " ".repeat(gap));
            }
            lines.push(line);
        }
        let scale = field.scale();
        for y in (0..rows.len()).rev() {
            let mut line = format!("{:<label$}", cut(&plain(&rows[y]), label));
            for x in 0..columns.len() {
                let cell = field.cells.iter().find(|cell| (cell.x, cell.y) == (x, y));
                let shown = format!("{:>wide$}", cut(&cell.map(in_cell).unwrap_or_default(), wide - 1));
                match cell.and_then(|cell| cell.value).filter(|_| colour) {
                    Some(value) => {
                        let shade = field.colour(scale, value);
                        let letters = if is_dark(shade) { 231 } else { 16 };
                        line += &format!("\x1b[38;5;{letters};48;5;{}m{shown}\x1b[0m", ansi(shade));
                    }
                    None => line += &shown,
                }
            }
            lines.push(line);
        }
        for mark in self.marks.iter().filter(|mark| mark.drawn == Drawn::Boundary) {
            let said: Vec<&str> = mark.dots.iter().map(|dot| dot.said.as_str()).collect();
            lines.extend(wrapped(&plain(&format!("{}: {}", mark.label, said.join("; "))), LINE));
        }
        if field.cells.iter().any(|cell| cell.is_doubtful) {
            lines.push("!: a case has failed or is missing".to_string());
        }
        lines
    }

    fn plot(&self, colour: bool) -> Vec<String> {
        let [x, y] = self.extent();
        let (x_low, x_high) = (self.x.place(x.0), self.x.place(x.1));
        let (y_low, y_high) = (self.y.place(y.0), self.y.place(y.1));
        let mut area = vec![vec![(' ', 0); ACROSS]; DOWN];
        let mut legend = Vec::new();
        for mark in self.marks.iter().filter(|mark| matches!(mark.drawn, Drawn::Line | Drawn::Points)) {
            let letter = char::from(b'a' + (legend.len() % 26) as u8);
            legend.push(format!("{letter}  {}", plain(&mark.label)));
            for dot in self.shown(mark) {
                let (column, line) = self.character(dot.x, dot.y, (x_low, x_high), (y_low, y_high));
                let at = &mut area[line][column];
                *at = (if at.0 == ' ' || at.0 == letter { letter } else { '*' }, mark.colour);
            }
        }
        let painted = |(letter, of): &(char, usize)| match colour && *letter != ' ' {
            true => format!("\x1b[38;5;{}m{letter}\x1b[0m", ansi(COLOURS[of % COLOURS.len()])),
            false => letter.to_string(),
        };
        let ends = |line: usize| match line {
            0 => short(y.1),
            l if l == DOWN - 1 => short(y.0),
            _ => String::new(),
        };
        let mut lines = vec![cut(&plain(&self.y.titled()), LINE)];
        for (i, line) in area.iter().enumerate() {
            lines.push(format!("{:>10} |{}", ends(i), line.iter().map(painted).collect::<String>()));
        }
        lines.push(format!("{:>10} +{}", "", "-".repeat(ACROSS)));
        match self.x.names() {
            Some(names) => lines.extend(wrapped(&plain(&format!("{}: {}", self.x.titled(), names.join(" | "))), LINE)),
            None => {
                let (low, high) = (short(x.0), short(x.1));
                let room = ACROSS - low.chars().count() - high.chars().count();
                lines.push(format!("{:12}{low}{:^room$}{high}", "", cut(&plain(&self.x.titled()), room)));
            }
        }
        lines.extend(legend.iter().map(|line| cut(line, LINE)));
        if area.iter().flatten().any(|(letter, _)| *letter == '*') {
            lines.push("*  several".to_string());
        }
        lines
    }

    /// Column and line of a point, from the left and from above.
    fn character(&self, x: f64, y: f64, (x_low, x_high): (f64, f64), (y_low, y_high): (f64, f64)) -> (usize, usize) {
        let part = |place: f64, low: f64, high: f64| ((place - low) / (high - low)).clamp(0.0, 1.0);
        let column = part(self.x.place(x), x_low, x_high) * (ACROSS - 1) as f64;
        let line = (1.0 - part(self.y.place(y), y_low, y_high)) * (DOWN - 1) as f64;
        (column.round() as usize, line.round() as usize)
    }
}
