//! The page that a recording opens with: what happened, when, by what; and what was asked.

use crate::outcome::Outcome;
use crate::record::sample::{ContactMode, Ending, Header, Severity};
use crate::record::schema;
use crate::record::story::{Decisive, Story, TurningPoint, brief, markdown, markdown_code};
use serde_json::Value;
use std::fmt::Write;

/// Columns that tell most about a run, and what they are called here.
const MEASURES: [(&str, &str); 10] = [
    ("energy_drift_rel", "energy, drift of S"),
    ("energy_rise_max_rel", "energy, largest rise of S"),
    ("energy_growth_max", "energy, largest of the start's"),
    ("contact_gain_max", "largest gain of a contact solve, ×"),
    ("residual_max", "residual of the law of contact"),
    ("penetration_max_m", "penetration, m"),
    ("ghost_impulse_max_rel", "ghost impulse, of m v"),
    ("passed_through", "passages through bodies"),
    ("error_position_m", "error of positions, m"),
    ("contacts_max", "contacts at once"),
];

/// Page of a recording that was cut before its end.
pub fn begun(header: &Header) -> String {
    format!(
        "# Not finished\n\nThe run, or its recording, was cut: nothing is known about its end here.\n\n{}",
        asked(header, None)
    )
}

/// Page of a run that has ended.
pub fn page(header: &Header, ending: &Ending) -> String {
    let mut page = format!("# {}\n\n{}\n\n", title(ending), asked(header, Some(ending)));
    if let Some(doubt) = ending.warnings.as_ref().or(ending.notes.as_ref()) {
        let _ = writeln!(page, "**{}{}.**\n", if ending.warnings.is_some() { "⚠ " } else { "" }, markdown(doubt));
    }
    page += &table(&ending.story, ending.outcome);
    page += &measures(ending);
    page += &legend(header, ending);
    page
}

/// One line: outcome, time, reason.
fn title(ending: &Ending) -> String {
    let at = format!("t = {} s", brief(ending.end_time_s));
    let growth = ending.row.get("energy_growth_max").and_then(Value::as_f64);
    match (ending.outcome, ending.criterion.as_deref()) {
        (Outcome::Finished, _) => {
            let gains = match ending.story.gains_count {
                0 => "no step gains energy".to_string(),
                1 => "one step gains energy".to_string(),
                n => format!("{n} steps gain energy"),
            };
            format!("Finished at {at}: {gains}")
        }
        (Outcome::Diverged, Some("energy")) => match growth {
            Some(growth) => format!("Diverged at {at}: energy {} × the start", brief(growth)),
            None => format!("Diverged at {at}: energy"),
        },
        (outcome, reason) => {
            let mut word = outcome.name().to_string();
            word[..1].make_ascii_uppercase();
            format!("{word} at {at}: {}", markdown(reason.unwrap_or("no reason given")))
        }
    }
}

fn asked(header: &Header, ending: Option<&Ending>) -> String {
    let question = markdown(&header.question);
    let mut line = if question.is_empty() { String::new() } else { format!("**{question}** ") };
    let axes = header.axes.iter().map(|(path, value)| {
        let name = path.rsplit('.').next().unwrap_or(path);
        markdown_code(&format!("{name} = {}", schema::label(value)))
    });
    let method = (!header.axes.iter().any(|(path, _)| path == "method")).then(|| markdown_code(&header.method));
    let step = match (header.step_s, ending) {
        (Some(step_s), _) => Some(format!("Δt = {} s", brief(step_s))),
        // A method that makes its own steps has no other one than their mean.
        (None, Some(ending)) => {
            let mean_s = ending.row.get("step_used_s").and_then(Value::as_f64);
            mean_s.map(|mean_s| format!("steps of its own, {} s on the mean", brief(mean_s)))
        }
        (None, None) => None,
    };
    let parts: Vec<String> = axes.chain(method).chain(step).collect();
    line += &parts.join(" · ");
    line
}

fn table(story: &Story, outcome: Outcome) -> String {
    let mut table = String::from("| when | step | what |\n|---|---|---|\n");
    for TurningPoint { what, step, time_s, text } in &story.turns {
        // Of a sound run its gains are no news, and nothing is decided by the most contacts of one.
        let text = match what {
            Decisive::End => markdown(text),
            what => format!("{}: {}", what.name(), markdown(text)),
        };
        let decides = *what == Decisive::Onset && outcome == Outcome::Diverged;
        let bold = if decides { "**" } else { "" };
        let _ = writeln!(table, "| {bold}{} s{bold} | {step} | {bold}{text}{bold} |", brief(*time_s));
    }
    table + "\n"
}

fn measures(ending: &Ending) -> String {
    let shown = MEASURES.iter().filter_map(|(column, name)| {
        let cell = ending.row.get(*column)?;
        let text = cell.as_f64().map_or_else(|| markdown(&schema::text(cell)), brief);
        Some(format!("| {name} | {text} |\n"))
    });
    let rows: String = shown.collect();
    if rows.is_empty() { rows } else { format!("| measure | value |\n|---|---|\n{rows}\n") }
}

fn legend(header: &Header, ending: &Ending) -> String {
    let mut lines = Vec::new();
    let touched = ending.row.get("contacts_max").and_then(Value::as_u64).is_none_or(|most| most > 0);
    if header.streams.contacts && touched {
        let modes = ContactMode::ALL.map(|mode| format!("{} {}", schema::mode_word(mode), mode.name()));
        lines.push(format!("Contact points: {}.", modes.join(", ")));
    }
    if header.streams.forces && touched {
        lines.push(match header.arrow_weight_n {
            Some(weight_n) => format!(
                "Force arrows, on both bodies: {} N, a weight, are {} m; none is longer than the scene.",
                brief(weight_n),
                brief(weight_n * header.arrow_m_per_n)
            ),
            None => format!("Force arrows, on both bodies: 1 N is {} m.", brief(header.arrow_m_per_n)),
        });
    }
    lines.push(format!(
        "A sample every {} s, and every step about what is in the log as an impact or worse ({}, {}).",
        brief(header.sample_every_s),
        header.program,
        header.build
    ));
    lines.join(" ") + "\n"
}

/// Level of an event in a log, for filters.
pub fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Info => "INFO",
        Severity::Warning => "WARN",
        Severity::Error => "ERROR",
    }
}
