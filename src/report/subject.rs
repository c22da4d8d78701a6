//! What a report is about: rows, the axes that they lie on, and what is known of them besides.

use super::frame::RowFrame;
use super::labels::Labels;
use super::number::{of_cell, plain, shown};
use crate::check::{Judged, Magnitudes};
use crate::heading::unit_of;
use crate::rows::plan_file::PlanAxis;
use crate::rows::trials::Trial;
use std::collections::HashMap;

/// Subject of a report.
#[derive(Clone, Debug, Default)]
pub struct Subject {
    pub name: String,
    pub question: Option<String>,
    pub frame: RowFrame,
    pub axes: Vec<PlanAxis>,
    /// Groups of axes that advance side by side.
    pub together: Vec<Vec<String>>,
    /// Key of which every row has the critical value.
    pub search: Option<String>,
    /// Number of rows that were planned.
    pub planned: usize,
    /// Words of the methods.
    pub methods: Vec<String>,
    /// Rows of a bench; those of other programs come after ours.
    pub trials: Vec<Trial>,
    /// Whether the frame's rows are the first of the trials.
    pub is_bench: bool,
    /// Whether a method among them claims to solve the law of contact.
    pub claims_to_solve: bool,
    pub verdicts: Vec<Judged>,
    /// Sizes that rounding is relative to.
    pub magnitudes: Magnitudes,
    /// What is in doubt, or has to be said before anything is believed.
    pub warnings: Vec<String>,
    /// What is known of how the rows were made, by name.
    pub conditions: Vec<(String, String)>,
    /// Text of the experiment file.
    pub configuration: Option<String>,
    /// Command that runs a row again; the row's id goes behind it.
    pub replay: Option<String>,
    /// Commands that make the rows again.
    pub commands: Vec<String>,
    /// Column that the map is of, where one is chosen.
    pub painted: Option<String>,
}

/// Values of an axis, numbers in their order, and the place of every row among them.
#[derive(Clone, Debug)]
pub struct Levels {
    pub path: String,
    pub unit: &'static str,
    /// The values as the table of rows has them.
    pub names: Vec<String>,
    /// The same as figures have them: short, each once.
    pub labels: Vec<String>,
    /// What is left out of the labels.
    pub shortened: Option<String>,
    /// The values as numbers, if all are.
    pub numbers: Option<Vec<f64>>,
    pub of_row: Vec<Option<u32>>,
    /// Number of values, where they are pooled.
    pub pooled_from: Option<usize>,
}

/// Rows of a subject on their axes.
#[derive(Clone)]
pub struct Ground<'a> {
    pub subject: &'a Subject,
    /// Axes with more than one value that vary independently.
    pub axes: Vec<Levels>,
}

impl Levels {
    fn of(axis: &PlanAxis, frame: &RowFrame) -> Self {
        let mut values: Vec<(Option<f64>, String)> = axis
            .values
            .iter()
            .map(|value| {
                let number = value.as_f64();
                (number, number.map_or_else(|| of_cell(value), shown))
            })
            .collect();
        let is_numeric = values.iter().all(|(number, _)| number.is_some());
        if is_numeric {
            values.sort_by(|a, b| a.0.unwrap_or_default().total_cmp(&b.0.unwrap_or_default()));
        }
        let places: HashMap<&str, u32> =
            values.iter().enumerate().map(|(i, (_, name))| (name.as_str(), i as u32)).collect();
        let mut of_row = vec![None; frame.rows()];
        if let Some(numbers) = frame.numbers(&axis.path) {
            // Every number is written once.
            let mut known: HashMap<u64, Option<u32>> = HashMap::new();
            for (place, x) in of_row.iter_mut().zip(numbers) {
                *place = *known.entry(x.to_bits()).or_insert_with(|| places.get(shown(*x).as_str()).copied());
            }
        } else if let Some((words, codes)) = frame.words(&axis.path) {
            let of_word: Vec<Option<u32>> = words.iter().map(|word| places.get(word.as_str()).copied()).collect();
            for (place, code) in of_row.iter_mut().zip(codes) {
                *place = of_word.get(*code as usize).copied().flatten();
            }
        }
        let names: Vec<String> = values.iter().map(|(_, name)| plain(name)).collect();
        let numbers: Option<Vec<f64>> = is_numeric.then(|| values.iter().filter_map(|(number, _)| *number).collect());
        let Labels { labels, note } = match &numbers {
            Some(numbers) => Labels::of_numbers(numbers, &names),
            None => Labels::of_words(&names),
        };
        Levels {
            path: axis.path.clone(),
            unit: unit_of(&axis.path),
            names,
            labels,
            shortened: note,
            numbers,
            of_row,
            pooled_from: None,
        }
    }

    pub fn len(&self) -> usize {
        self.names.len()
    }

    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// What a note says of labels that are not the values as they are.
    pub fn note(&self) -> Option<String> {
        Some(format!("{}: {}", self.path, self.shortened.as_ref()?))
    }

    /// Whether its values stand for draws of chance alone.
    pub fn is_of_seeds(&self) -> bool {
        self.path == "seed" || self.path.ends_with(".seed")
    }

    /// Whether it is the length of the steps.
    pub fn is_step(&self) -> bool {
        self.path == "time.step_s"
    }

    /// Whether it is a tolerance, which methods take in place of a step.
    pub fn is_tolerance(&self) -> bool {
        self.path.ends_with("tolerance")
    }

    /// Whether its values are methods, or settings of one.
    pub fn is_of_methods(&self) -> bool {
        self.path == "method" || self.path.starts_with("method.")
    }

    /// `path = value unit`.
    pub fn says(&self, level: usize) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        format!("{} = {}{unit}", self.path, self.labels[level])
    }

    /// Whether steps from one value to the next are nearer to equal ratios than to equal differences.
    pub fn is_logarithmic(&self) -> bool {
        let Some(numbers) = &self.numbers else { return false };
        match numbers[..] {
            [first, last] => first > 0.0 && last / first >= 8.0,
            [first, .., last] if first > 0.0 && last / first >= 8.0 => {
                let uneven = |place: fn(f64) -> f64| {
                    let steps = numbers.windows(2).map(|pair| place(pair[1]) - place(pair[0]));
                    let (least, most) = steps.fold((f64::INFINITY, 0.0f64), |(a, b), step| (a.min(step), b.max(step)));
                    most / least
                };
                uneven(libm::log) <= uneven(|x| x)
            }
            _ => false,
        }
    }

    /// Value at a place between levels.
    pub fn value_at(&self, place: f64) -> Option<f64> {
        let numbers = self.numbers.as_ref()?;
        let i = (place.floor().max(0.0) as usize).min(numbers.len() - 1);
        let (a, b) = (numbers[i], numbers[(i + 1).min(numbers.len() - 1)]);
        let part = place - i as f64;
        Some(if self.is_logarithmic() {
            libm::exp((1.0 - part) * libm::log(a) + part * libm::log(b))
        } else {
            a + part * (b - a)
        })
    }

    /// Its values as families of numbers: all of a numeric axis, else labels like `cube 27` by their word.
    pub fn families(&self) -> Vec<(String, Vec<(usize, f64)>)> {
        if let Some(numbers) = &self.numbers {
            return vec![(String::new(), numbers.iter().copied().enumerate().collect())];
        }
        let mut families: Vec<(String, Vec<(usize, f64)>)> = Vec::new();
        for (level, name) in self.names.iter().enumerate() {
            let Some((word, number)) = name.rsplit_once(' ') else { continue };
            let Ok(number) = number.parse::<f64>() else { continue };
            match families.iter_mut().find(|(known, _)| known == word) {
                Some((_, members)) => members.push((level, number)),
                None => families.push((word.to_string(), vec![(level, number)])),
            }
        }
        families.retain(|(_, members)| members.len() > 1);
        families
    }
}

impl<'a> Ground<'a> {
    pub fn of(subject: &'a Subject) -> Self {
        let is_led = |path: &str| subject.together.iter().any(|group| group.iter().skip(1).any(|other| other == path));
        let varies = |axis: &&PlanAxis| axis.values.len() > 1 && !is_led(&axis.path) && subject.frame.has(&axis.path);
        let axes = subject.axes.iter().filter(varies).map(|axis| Levels::of(axis, &subject.frame)).collect();
        Ground { subject, axes }
    }

    pub fn frame(&self) -> &RowFrame {
        &self.subject.frame
    }

    /// Axes but those of seeds.
    pub fn chosen(&self) -> impl Iterator<Item = &Levels> {
        self.axes.iter().filter(|axis| !axis.is_of_seeds())
    }

    /// For each row whether it ended so.
    pub fn ended(&self, outcome: &str) -> Vec<bool> {
        match self.frame().words("outcome") {
            Some((words, codes)) => {
                let wanted = words.iter().position(|word| word == outcome).map_or(u32::MAX - 1, |at| at as u32);
                codes.iter().map(|code| *code == wanted).collect()
            }
            None => vec![false; self.frame().rows()],
        }
    }

    /// Notes that every figure of these rows has: their number, the methods, what is missing or failed.
    pub fn notes(&self) -> Vec<String> {
        use super::number::counted;
        let (rows, failed) = (self.frame().rows(), self.frame().count("failed"));
        let mut notes = vec![format!("n = {}", counted(rows, "row"))];
        if !self.subject.methods.is_empty() {
            notes[0] += &format!("; method: {}", self.subject.methods.join(", "));
        }
        if self.subject.planned > rows {
            notes.push(format!("{} planned is missing", counted(self.subject.planned - rows, "case")));
        }
        if failed > 0 {
            notes.push(format!("{} failed and is left out", counted(failed, "case")));
        }
        for axis in &self.axes {
            if let Some(all) = axis.pooled_from {
                notes.push(format!("{all} values of {} are pooled into {}", axis.path, axis.len()));
            }
        }
        for note in &mut notes[1..] {
            if !note.starts_with("1 ") {
                *note = note.replace(" is ", " are ");
            }
        }
        notes
    }

    /// What a figure pools that has these axes; None where it pools nothing.
    pub fn pooled_beside(&self, drawn: &[&Levels]) -> Option<String> {
        let beside = self.axes.iter().filter(|axis| drawn.iter().all(|drawn| axis.path != drawn.path));
        let beside: Vec<String> = beside.map(|axis| format!("{} ({} values)", axis.path, axis.len())).collect();
        (!beside.is_empty()).then(|| format!("pooled over {}", beside.join(", ")))
    }

    /// Numbers of a column, by the levels of an axis and of another; rows that failed are left out.
    pub fn grouped(&self, x: &Levels, series: Option<&Levels>, column: &str) -> Vec<Vec<Vec<f64>>> {
        let failed = self.ended("failed");
        let mut groups = vec![vec![Vec::new(); x.len()]; series.map_or(1, Levels::len)];
        let Some(numbers) = self.frame().numbers(column) else { return groups };
        for (row, y) in numbers.iter().enumerate().filter(|(row, y)| !y.is_nan() && !failed[*row]) {
            let at = series.map_or(Some(0), |series| series.of_row[row]);
            if let (Some(s), Some(x)) = (at, x.of_row[row]) {
                groups[s as usize][x as usize].push(*y);
            }
        }
        groups
    }
}
