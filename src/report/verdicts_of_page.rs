//! Verdicts as a page has them: what was expected, what was measured, and the cases that an unmet one names.

use super::number::{counted, plain, short, thousands};
use super::subject::Subject;
use super::svg::escaped;
use crate::check::{Failing, Judged, MOST};
use serde_json::Value;
use std::collections::HashMap;
use std::fmt::Write;

/// Cases of an expectation that are seen at once.
const FEW: usize = 6;
/// Digits of an id that a person reads.
const DIGITS: usize = 8;

/// Writes the section of the verdicts, if there are some.
pub(super) fn verdicts(out: &mut String, subject: &Subject) {
    if subject.verdicts.is_empty() {
        return;
    }
    let met = subject.verdicts.iter().filter(|judged| judged.met).count();
    // Writing into memory cannot fail.
    let _ = write!(
        out,
        "<section aria-labelledby=\"verdicts\">\n<h2 id=\"verdicts\">What was expected: {met} of {} met</h2>\n\
         <details{}><summary>the verdicts</summary>\n<ul class=\"verdicts\">\n",
        subject.verdicts.len(),
        if met < subject.verdicts.len() { " open" } else { "" }
    );
    for judged in &subject.verdicts {
        let (class, word) = if judged.met { ("met", "met") } else { ("unmet", "NOT MET") };
        let why = judged.why.as_deref().map_or(String::new(), |why| format!(" ({})", plain(why)));
        let _ = writeln!(
            out,
            "<li><span class=\"{class}\">{word}</span> {}<br><span class=\"notes\">{}</span>{}</li>",
            escaped(&plain(&format!("{}: {}{why}", judged.expectation, judged.bound))),
            escaped(&plain(&format!("measured: {}; {}", judged.measured, counted(judged.rows, "row")))),
            if judged.met { String::new() } else { cases(subject, judged) }
        );
    }
    *out += "</ul>\n</details>\n</section>\n";
}

/// Rows of the cases that unmet expectations name, as far as a page lists them.
pub(super) fn named(subject: &Subject) -> Vec<usize> {
    let unmet = subject.verdicts.iter().filter(|judged| !judged.met);
    let listed: Vec<&str> =
        unmet.flat_map(|judged| judged.failing.iter().take(MOST)).map(|case| case.case.as_str()).collect();
    if listed.is_empty() {
        return Vec::new();
    }
    let frame = &subject.frame;
    let rows: HashMap<&str, usize> =
        (0..frame.rows()).filter_map(|row| Some((frame.word("case", row)?, row))).collect();
    listed.iter().filter_map(|case| rows.get(case).copied()).collect()
}

/// The cases of an unmet expectation, the worst first.
fn cases(subject: &Subject, judged: &Judged) -> String {
    let all = judged.failing.len();
    let listed = all.min(MOST);
    let said = match listed == all {
        true => format!("its {}, the worst first", if all == 1 { "case".to_string() } else { counted(all, "case") }),
        false => format!("the {listed} worst of its {}", counted(all, "case")),
    };
    if all == 0 {
        return String::new();
    }
    let mut out = format!(
        "\n<details{}><summary>{said}</summary>\n<ol class=\"cases\">\n",
        if listed <= FEW { " open" } else { "" }
    );
    for failing in judged.failing.iter().take(MOST) {
        out += &case(subject, failing);
    }
    if listed < all {
        let _ = writeln!(out, "</ol>\n<p class=\"notes\">… and {} more</p></details>", thousands(all - listed));
        return out;
    }
    out + "</ol></details>"
}

fn case(subject: &Subject, failing: &Failing) -> String {
    let varies = |path: &&String| subject.axes.iter().any(|axis| axis.path == **path && axis.values.len() > 1);
    let at: Vec<String> = failing
        .axes
        .keys()
        .filter(varies)
        .filter_map(|path| Some(format!("{path} = {}", shown(failing.axes.get(path)?))))
        .collect();
    let at = if at.is_empty() { String::new() } else { format!(", at {}", at.join(", ")) };
    let id = failing.case.get(..DIGITS).unwrap_or(&failing.case);
    let measured = plain(&format!("{} = {}{at}", failing.column, shown(&failing.value)));
    let command = subject.replay.as_ref().map_or(String::new(), |replay| {
        format!("<br><code class=\"notes\">{}</code>", escaped(&plain(&format!("{replay} {id}"))))
    });
    format!(
        "<li><code class=\"case\" data-case=\"{}\">{}</code> {}{command}</li>\n",
        escaped(&plain(&failing.case)),
        escaped(&plain(id)),
        escaped(&measured)
    )
}

fn shown(cell: &Value) -> String {
    match (cell, cell.as_f64()) {
        (_, Some(x)) => short(x),
        (Value::String(text), _) => text.clone(),
        (other, _) => other.to_string(),
    }
}
