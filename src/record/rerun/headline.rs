//! The page that a recording opens with: what happened, when, by what; and what was asked.

use crate::outcome::Outcome;
use crate::record::flight::{Flight, FlightContact};
use crate::record::sample::{ContactMode, Ending, Header, Severity};
use crate::record::schema;
use crate::record::story::{Decisive, Story, TurningPoint, brief, markdown, markdown_code, shortest};
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

/// Growth of the energy from which a run that ends is one that has exploded.
const GROWN: f64 = 10.0;
/// Rise of the energy, of the scale S of a row, from which a run without a gain in a single step is said to creep up.
const CREPT: f64 = 1e-3;

/// Contacts that are listed of a step, and rows of A that are shown.
const MOST_SHOWN: usize = 24;
const MOST_ROWS: usize = 12;

/// Page of a recording before its end: one that was cut, or one that is shown while its run goes on.
pub fn begun(header: &Header, is_live: bool) -> String {
    let (title, said) = if is_live {
        (format!("{} yet", schema::NOT_FINISHED), "The run goes on; this page says how it ended when it has.")
    } else {
        (schema::NOT_FINISHED.to_string(), "The run, or its recording, was cut: nothing is known about its end here.")
    };
    format!("# {title}\n\n{said}\n\n{}", asked(header, None))
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
            let rise = ending.row.get("energy_rise_max_rel").and_then(Value::as_f64).filter(|rise| *rise > CREPT);
            let gains = match (ending.story.gains_count, rise) {
                (0, Some(rise)) => format!("energy creeps up by {} S", brief(rise)),
                (0, None) => "no step gains energy".to_string(),
                (1, _) => "one step gains energy".to_string(),
                (n, _) => format!("{n} steps gain energy"),
            };
            match growth.filter(|growth| *growth > GROWN) {
                Some(growth) => format!("Finished at {at}: energy {} × the start, {gains}", brief(growth)),
                None => format!("Finished at {at}: {gains}"),
            }
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
    let onset = story.turn(Decisive::Onset).map(|turn| turn.step);
    for TurningPoint { what, step, time_s, text } in &story.turns {
        // The first gain is said once.
        if *what == Decisive::FirstGain && Some(*step) == onset {
            continue;
        }
        let text = match what {
            Decisive::End => markdown(text),
            what => format!("{}: {}", what.name(), markdown(text)),
        };
        let decides = *what == Decisive::Onset || *what == Decisive::End && outcome != Outcome::Finished;
        let bold = if decides { "**" } else { "" };
        let _ = writeln!(table, "| {bold}{}{bold} | {step} | {bold}{text}{bold} |", moment(*time_s));
    }
    table + "\n"
}

/// A time as the viewer's panel shows it and takes it.
pub fn moment(time_s: f64) -> String {
    if !(time_s > 0.0 && time_s.is_finite()) {
        return format!("{} s", shortest(time_s));
    }
    // Up: at a time a little before an instant the viewer shows what was before it.
    let digits = 5 - libm::floor(libm::log10(time_s)) as i32;
    let scale = libm::exp10(f64::from(digits.min(9)));
    let rounded = (time_s * scale * (1.0 - 4.0 * f64::EPSILON)).ceil() / scale;
    format!("{} s", shortest(rounded))
}

/// Page of the contacts of the step that gained most.
pub fn flight_page(flight: &Flight) -> String {
    let Flight { step, time_s, step_s, contacts, contacts_count, given_j, a_per_kg, eigenvalues_per_kg } = flight;
    let gained: Vec<&FlightContact> = contacts.iter().filter(|contact| contact.given_j > 0.0).collect();
    let mut page = format!(
        "# The step that gained most: step {step}, contacts at {}\n\n{contacts_count} contact{} gave {} J in {} s; {} \
         of them gave some. A contact gives p·½(b + u⁺), p = F Δt; what slides, sticks or comes to rest takes \
         energy.\n\n",
        moment(*time_s),
        if *contacts_count == 1 { "" } else { "s" },
        brief(*given_j),
        brief(*step_s),
        gained.len()
    );
    page += "| | between | gave, J | gap, m | F, N: n, t₁, t₂ | u⁻, m/s | b, m/s | u⁺ = A p + b, m/s |\n";
    page += "|---|---|---|---|---|---|---|---|\n";
    let vector = |v: &[f64; 3]| v.map(brief).join(", ");
    for (contact, number) in contacts.iter().zip(1..).take(MOST_SHOWN) {
        let bold = if contact.given_j > 0.0 { "**" } else { "" };
        let [body, other] = contact.bodies.each_ref().map(|name| markdown(name));
        let _ = writeln!(
            page,
            "| {number} | {body}, {other} | {bold}{}{bold} | {} | {} | {} | {} | {} |",
            brief(contact.given_j),
            brief(contact.gap_m),
            vector(&contact.force_n),
            vector(&contact.before_m_s),
            vector(&contact.b_m_s),
            vector(&contact.after_m_s),
        );
    }
    if contacts.len() > MOST_SHOWN {
        let _ = writeln!(page, "\nThe first {MOST_SHOWN} are listed; an .mcap holds {}.", contacts.len());
    }
    let largest = eigenvalues_per_kg.first().copied().unwrap_or(0.0);
    let rank = eigenvalues_per_kg.iter().filter(|value| **value > 1e-9 * largest).count();
    let shown: Vec<String> = eigenvalues_per_kg.iter().take(12).map(|x| brief(*x)).collect();
    let more = if eigenvalues_per_kg.len() > 12 { ", …" } else { "" };
    let _ = writeln!(
        page,
        "\n**A = J M⁻¹ Jᵀ**, {0} × {0}, rank {rank}; eigenvalues, 1/kg: {1}{more}\n",
        eigenvalues_per_kg.len(),
        shown.join(", ")
    );
    let first = a_per_kg.len().min(MOST_ROWS);
    if first > 0 {
        let _ = writeln!(page, "Rows and columns of the first {} contacts (n, t₁, t₂ of each), 1/kg:\n", first / 3);
        page += &format!("|{}\n|{}\n", " |".repeat(first), "---|".repeat(first));
        for row in &a_per_kg[..first] {
            let cells: Vec<String> = row[..first].iter().map(|x| brief(*x)).collect();
            let _ = writeln!(page, "| {} |", cells.join(" | "));
        }
    }
    page
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
                "Force arrows, on both bodies: {} N, a weight, are {} m; none is longer than {} m.",
                brief(weight_n),
                brief(weight_n * header.arrow_m_per_n),
                brief(header.arrow_longest_m)
            ),
            None => format!(
                "Force arrows, on both bodies: 1 N is {} m; none is longer than {} m.",
                brief(header.arrow_m_per_n),
                brief(header.arrow_longest_m)
            ),
        });
    }
    if header.streams.velocities {
        lines.push(format!(
            "Velocity arrows, white: 1 m/s is {} m; none is longer than {} m.",
            brief(header.arrow_m_per_m_s),
            brief(header.arrow_longest_m)
        ));
    }
    if ending.left_out > 0 {
        lines.push(format!(
            "**{} samples are left out, so that the file has at most {} MB (record.max\\_mb).**",
            ending.left_out,
            brief(header.most_bytes as f64 / 1e6)
        ));
    }
    let most = ending.row.get("contacts_max").and_then(Value::as_u64).unwrap_or(0);
    if most > schema::MOST_CONTACTS as u64 {
        lines.push(format!(
            "Of a sample's contacts the {} with the largest forces are drawn; an .mcap holds all.",
            schema::MOST_CONTACTS
        ));
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
