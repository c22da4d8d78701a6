//! `gotai list`: what can be written, from the vocabulary itself; as text, JSON, or a page of Markdown.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{print, print_json};
use super::table::table;
use crate::exact::{ClosedForm, form};
use crate::experiment::types::{About, Accuracy, Exact, Integrator, Measure, Method, Shape};
use crate::experiment::vocabulary::{Initial, SettingKey, Takes, Word, shown, words};
use crate::heading::Heading;
use crate::integrate::claims::{Kept, claim};
use crate::measure::more;
use crate::rows::columns;
use clap::{Args, ValueEnum};
use comfy_table::TableComponent;
use serde_json::{Map, Value, json};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// What to list
    #[arg(value_enum, required = true)]
    what: Vec<What>,
    /// A page of Markdown on stdout
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum What {
    Methods,
    /// Closed forms that errors can be measured against (`exact:`)
    Exact,
    Shapes,
    /// Columns of the table of results, with unit and meaning
    Columns,
    /// What `measure:` can ask for
    Measures,
}

/// A list under a title; texts are Markdown.
struct Section {
    /// Title of its own; empty where the list's serves.
    title: String,
    lead: String,
    head: &'static [&'static str],
    rows: Vec<Vec<String>>,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        if self.markdown {
            print(page(&self.what).trim_end());
        } else if self.output.json {
            match self.what[..] {
                [what] => print_json(&what.json()),
                _ => print_json(&self.what.iter().map(|what| (what.word(), what.json())).collect::<Map<_, _>>()),
            }
        } else {
            for section in self.what.iter().flat_map(|what| what.sections()) {
                print(plain(&section));
            }
        }
        Ok(ExitCode::SUCCESS)
    }
}

impl What {
    fn word(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_string())
    }

    fn title(self) -> &'static str {
        match self {
            What::Methods => "Methods",
            What::Exact => "Closed forms",
            What::Shapes => "Shapes",
            What::Columns => "Columns",
            What::Measures => "Measures",
        }
    }

    fn sections(self) -> Vec<Section> {
        match self {
            What::Methods => methods(),
            What::Exact => closed_forms(),
            What::Shapes => vec![shapes()],
            What::Columns => all_columns(),
            What::Measures => vec![measures()],
        }
    }

    fn json(self) -> Value {
        match self {
            What::Methods => words::<Method>().iter().map(method_json).collect(),
            What::Exact => words::<Exact>().iter().map(exact_json).collect(),
            What::Shapes => words::<Shape>().iter().map(|shape| word_json(shape, &shape.value.about())).collect(),
            What::Columns => columns_json(),
            What::Measures => words::<Measure>().iter().map(measure_json).collect(),
        }
    }
}

/// The lists as one document of Markdown.
fn page(whats: &[What]) -> String {
    let named: Vec<String> = whats.iter().map(|what| what.word()).collect();
    let titles: Vec<String> = whats.iter().map(|what| what.title().to_lowercase()).collect();
    let mut text = format!(
        "# {}\n\nMade by `gotai list {} --markdown`, not by hand.\n",
        capital(&titles.join(", ")),
        named.join(" ")
    );
    for what in whats {
        let (list, part) = if whats.len() > 1 { ("##", "###") } else { ("#", "##") };
        if whats.len() > 1 {
            text += &format!("\n{list} {}\n", what.title());
        }
        for Section { title, lead, head, rows } in what.sections() {
            if !title.is_empty() {
                text += &format!("\n{part} {title}\n");
            }
            if !lead.is_empty() {
                text += &format!("\n{lead}\n");
            }
            if !rows.is_empty() {
                let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
                text += &format!(
                    "\n{}|{}\n",
                    line(head.iter().map(ToString::to_string).collect()),
                    "---|".repeat(head.len())
                );
                text.extend(
                    rows.into_iter().map(|cells| line(cells.iter().map(|cell| cell.replace('|', "\\|")).collect())),
                );
            }
        }
    }
    text
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A list as text for a terminal.
fn plain(Section { title, lead, head, rows }: &Section) -> String {
    let without_marks = |text: &str| text.replace('`', "");
    let mut parts: Vec<String> =
        [title, lead].into_iter().filter(|text| !text.is_empty()).map(|text| without_marks(text)).collect();
    if !rows.is_empty() {
        let mut table = table(head);
        for lines in [TableComponent::HorizontalLines, TableComponent::MiddleIntersections] {
            table.remove_style(lines);
        }
        table.add_rows(rows.iter().map(|cells| cells.iter().map(|cell| without_marks(cell)).collect::<Vec<_>>()));
        parts.push(table.to_string());
    }
    parts.join("\n") + "\n"
}

fn code(text: &str) -> String {
    format!("`{text}`")
}

fn codes<T: AsRef<str>>(texts: &[T]) -> String {
    texts.iter().map(|text| code(text.as_ref())).collect::<Vec<_>>().join(", ")
}

/// A sentence, and where it is from.
fn sourced(About { what, source }: &About) -> String {
    if source.is_empty() { what.clone() } else { format!("{what} Source: {source}.") }
}

fn methods() -> Vec<Section> {
    let lead = format!(
        "`method:` is one of these words, or one key with settings: `method: {{ lecture: {{ sweeps: 50 }} }}`. The \
         default is `{}`. What the settings mean: `docs/experiment-file.md`.",
        Method::default().word()
    );
    let mut sections = vec![Section { title: String::new(), lead, head: &[], rows: Vec::new() }];
    for Word { name, value, settings } in words::<Method>() {
        let facts = value.facts();
        let by = match (facts.integrator, facts.accuracy) {
            (Some(_), _) => "What makes it more accurate is the integrator's affair, as listed below.",
            (_, Accuracy::Step) => "A shorter `time.step_s` makes it more accurate.",
            (_, Accuracy::Tolerance(_)) => "A smaller `tolerance` makes it more accurate; it needs no `time.step_s`.",
            (_, Accuracy::Closed) => "It is a closed form.",
        };
        let rows = settings.iter().map(|setting| setting_row(&value, setting)).collect();
        let lead = format!("{} {by}", sourced(&value.settings().about()));
        sections.push(Section { title: code(name), lead, head: &["setting", "takes", "default"], rows });
        if facts.integrator.is_some() {
            sections.push(integrators(name));
        }
    }
    sections
}

fn setting_row(method: &Method, SettingKey { name, takes, initial }: &SettingKey) -> Vec<String> {
    let takes = match takes {
        Takes::Words(words) => codes(words),
        other => other.to_string(),
    };
    let initial = match initial {
        Initial::Needed => "(needed)".to_string(),
        Initial::Is(value) => code(&shown(value)),
        Initial::Absent => method.settings().unless_set(name),
    };
    vec![code(name), takes, initial]
}

fn integrators(method: &str) -> Section {
    let row = |word: Word<Integrator>| {
        let claim = claim(word.value);
        let (order, by) = match (word.value.accuracy(), claim.order) {
            (Accuracy::Step, order) => (order, "a shorter `time.step_s`"),
            (Accuracy::Tolerance(_), order) => (order, "a smaller `tolerance`"),
            (Accuracy::Closed, order) => (order, "nothing: it has no error"),
        };
        let order = order.map_or_else(|| "–".to_string(), |order| order.to_string());
        vec![code(word.name), order, by.to_string(), kept(word.value), claim.source.to_string()]
    };
    Section {
        title: format!("Integrators of `{method}`"),
        lead: "The order is of attitude and angular velocity, of the position too where the parabola is not kept; a \
               dash: none of its own. What is kept is so to rounding, of a body without torque, at any step. Tests \
               hold every line."
            .to_string(),
        head: &["integrator", "order", "more accurate by", "keeps", "source"],
        rows: words::<Integrator>().into_iter().map(row).collect(),
    }
}

fn kept(integrator: Integrator) -> String {
    let claim = claim(integrator);
    let kept = [(claim.energy, "energy"), (claim.angular_momentum, "angular momentum"), (claim.parabola, "parabola")];
    let kept: Vec<&str> = kept.iter().filter(|(kept, _)| *kept == Kept::ToRounding).map(|(_, what)| *what).collect();
    if kept.is_empty() { "nothing".to_string() } else { kept.join(", ") }
}

fn closed_forms() -> Vec<Section> {
    let section = |touches: bool, title: &str| {
        let row = |Word { name, value, .. }: Word<Exact>| {
            let ClosedForm { what, source, scenes, .. } = form(value);
            vec![code(name), scenes.to_string(), what.to_string(), source.to_string()]
        };
        let rows = words::<Exact>().into_iter().filter(|word| word.value.touches() == touches).map(row).collect();
        Section {
            title: title.to_string(),
            lead: String::new(),
            head: &["`exact:`", "of which scenes", "motion", "source"],
            rows,
        }
    };
    let lead = "The closed form that `exact:` names is what errors are measured against. A scene that it is not the \
                motion of is refused.";
    let before = Section { title: String::new(), lead: lead.to_string(), head: &[], rows: Vec::new() };
    vec![before, section(false, "Without contact"), section(true, "With contact")]
}

fn shapes() -> Section {
    let row = |Word { name, value, settings }: Word<Shape>| {
        let settings: Vec<String> = settings.iter().map(|s| format!("{} ({})", code(s.name), s.takes)).collect();
        vec![code(name), settings.join(", "), value.about().what]
    };
    Section {
        title: String::new(),
        lead: "`shape:` of a body; all keys are needed. The body frame's origin is the centre of the shape, of a \
               `convex` that of its vertices."
            .to_string(),
        head: &["shape", "keys", "what touches"],
        rows: words::<Shape>().into_iter().map(row).collect(),
    }
}

fn all_columns() -> Vec<Section> {
    let section = |title: String, lead: &str, headings: &[Heading]| Section {
        title,
        lead: lead.to_string(),
        head: &["column", "kind", "unit", "meaning"],
        rows: headings.iter().map(column_row).collect(),
    };
    let mut sections = vec![
        section(
            "Every row".to_string(),
            "In this order; after `case` comes every axis by its path, before `build` what only some experiments \
             have. A number that means nothing in a run is null: an empty cell. What the relative ones mean, with \
             examples: `docs/numbers.md`.",
            &columns::of_every_row(),
        ),
        section("Rows of a search".to_string(), "The other columns are of the run at `search_low`.", &columns::SEARCH),
    ];
    for Word { name, value, .. } in words::<Measure>() {
        let headings = more::headings(value);
        if !headings.is_empty() {
            sections.push(section(format!("`measure: [{name}]`"), &value.about().what, headings));
        }
    }
    sections
}

fn column_row(heading: &Heading) -> Vec<String> {
    let mut names = vec![code(&heading.names()[0])];
    names.extend(heading.parts.iter().skip(1).map(|part| code(&format!(".{part}"))));
    let kind = format!("{}{}", if heading.signed { "signed " } else { "" }, heading.kind.word());
    vec![names.join(" "), kind, heading.unit().to_string(), heading.meaning.to_string()]
}

fn measures() -> Section {
    let row = |Word { name, value, .. }: Word<Measure>| {
        let About { what, source } = value.about();
        let names: Vec<&str> = more::headings(value).iter().map(|heading| heading.name).collect();
        let columns = if names.is_empty() { "one of every row".to_string() } else { codes(&names) };
        vec![code(name), what, columns, source.to_string()]
    };
    Section {
        title: String::new(),
        lead: "`measure:` is a list of these words. `gotai list columns` says what their columns are.".to_string(),
        head: &["word", "what is measured", "columns", "source"],
        rows: words::<Measure>().into_iter().map(row).collect(),
    }
}

fn word_json<T>(Word { name, settings, .. }: &Word<T>, About { what, source }: &About) -> Value {
    json!({ "name": name, "settings": settings, "what": what, "source": source })
}

fn method_json(method: &Word<Method>) -> Value {
    let mut line = word_json(method, &method.value.settings().about());
    for (i, setting) in method.settings.iter().enumerate().filter(|(_, setting)| setting.initial == Initial::Absent) {
        line["settings"][i]["default"] = json!({ "is": method.value.settings().unless_set(setting.name) });
    }
    if method.value.facts().integrator.is_some() {
        let named = |word: Word<Integrator>| json!({ "name": word.name, "claim": claim(word.value) });
        line["integrators"] = words::<Integrator>().into_iter().map(named).collect();
    }
    line
}

fn exact_json(exact: &Word<Exact>) -> Value {
    let ClosedForm { what, source, scenes, .. } = form(exact.value);
    let mut line = word_json(exact, &About { what: what.to_string(), source });
    line["scenes"] = json!(scenes);
    line["touches"] = json!(exact.value.touches());
    line
}

fn measure_json(measure: &Word<Measure>) -> Value {
    let mut line = word_json(measure, &measure.value.about());
    line["columns"] = json!(more::headings(measure.value));
    line
}

/// Each says by which word of `measure:` it comes, null: in every row, or `search`.
fn columns_json() -> Value {
    let from = |of: Value, headings: &[Heading]| -> Vec<Value> {
        let line = |heading: &Heading| {
            let mut line = json!(heading);
            line["of"] = of.clone();
            line
        };
        headings.iter().map(line).collect()
    };
    let mut lines = from(Value::Null, &columns::of_every_row());
    lines.extend(from(json!("search"), &columns::SEARCH));
    for word in words::<Measure>() {
        lines.extend(from(json!(word.name), more::headings(word.value)));
    }
    Value::Array(lines)
}
