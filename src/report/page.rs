//! A report as one page of HTML that needs nothing else: no network, no other file. Rows and plots are data,
//! compressed; without scripts the figures stand as drawings, and their numbers as tables.

use super::figure::Figure;
use super::number::{counted, plain, thousands};
use super::rows_of_page::{Extent, Listing};
use super::said::table;
use super::subject::Subject;
use super::svg::escaped;
use super::verdicts_of_page::{named, verdicts};
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::json;
use std::fmt::Write;
use std::io::Write as _;

/// Page of a report.
pub struct Page {
    pub html: String,
    /// What the page does not hold, if it does not hold all.
    pub left_out: Option<String>,
}

/// What stands where there is no figure.
pub fn nothing_drawn(subject: &Subject) -> String {
    if subject.frame.rows() == 0 && subject.planned > 0 {
        return format!("0 of {} done: there is nothing to draw yet.", counted(subject.planned, "case"));
    }
    "No axis has several values: there is nothing to compare in a figure, and the table has all that there is.".into()
}

const STYLE: &str = include_str!("../../assets/report.css");
const SCRIPT: &str = include_str!("../../assets/report.js");
const ROWS: &str = include_str!("../../assets/rows.html");
/// The library of the plots, gzipped: assets/README.md.
const PLOTLY: &[u8] = include_bytes!("../../assets/plotly-cartesian.min.js.gz");

/// Most bytes of a page of up to `FEW` rows, and of any.
const SMALL: usize = 3_000_000;
const LARGE: usize = 8_000_000;
const FEW: usize = 10_000;
/// Rows above which the table holds the most telling ones alone, and how many.
const MANY: usize = 20_000;
const TELLING: usize = 2_000;
/// Most rows of the table of a figure's numbers.
const NUMBERS: usize = 400;

impl Page {
    /// The page of a subject and its figures.
    pub fn of(subject: &Subject, figures: &[Figure]) -> Self {
        let rows = subject.frame.rows();
        let most_bytes = if rows <= FEW { SMALL } else { LARGE };
        let mut chosen = Extent { rows: if rows > MANY { TELLING } else { rows }, columns: usize::MAX };
        let named: Vec<usize> = named(subject).into_iter().chain(figures.iter().flat_map(Figure::rows)).collect();
        loop {
            let listing = Listing::of(subject, &named, chosen);
            let html = html(subject, figures, &listing);
            let is_least = chosen.rows <= 100 && chosen.columns <= 40;
            if html.len() <= most_bytes || is_least {
                return Page { html, left_out: listing.left_out() };
            }
            // Columns that few ask for go before rows do.
            chosen = match listing.columns() {
                columns if columns > 80 => Extent { columns: (columns / 2).max(80), ..chosen },
                columns => Extent { rows: (chosen.rows / 2).max(100), columns: columns.min(chosen.columns) },
            };
        }
    }
}

/// Base64 (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let n = (0..3).fold(0u32, |n, i| n << 8 | u32::from(group.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let letter = LETTERS[(n >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= group.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

fn packed(text: &str) -> String {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    // Writing into memory cannot fail.
    let _ = encoder.write_all(text.as_bytes());
    base64(&encoder.finish().unwrap_or_default())
}

fn html(subject: &Subject, figures: &[Figure], listing: &Listing) -> String {
    let question = subject.question.as_deref().map_or(subject.name.clone(), |question| plain(question.trim()));
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<meta http-equiv=\"Content-Security-Policy\" \
         content=\"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:\">\n\
         <link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
         <h1>{}</h1>\n",
        escaped(&question),
        escaped(&question)
    );
    // Writing into memory cannot fail.
    let _ = writeln!(out, "<p class=\"lead\">{}</p>", escaped(&lead(subject)));
    let warnings = subject.warnings.iter().map(|warning| ("warning", warning.clone()));
    // What a method that does not claim to solve the law has missed is no surprise.
    let doubt = listing.doubt().map(|doubt| (if subject.claims_to_solve { "warning" } else { "remark" }, doubt));
    for (class, said) in warnings.chain(doubt) {
        let _ = writeln!(out, "<p class=\"{class}\" role=\"note\">{}</p>", escaped(&plain(&said)));
    }
    verdicts(&mut out, subject);
    if figures.is_empty() {
        let _ = writeln!(out, "<p class=\"notes\">{}</p>", escaped(&nothing_drawn(subject)));
    }
    for figure in figures {
        shown(&mut out, figure);
    }
    out += "<section aria-labelledby=\"rows\">\n<h2 id=\"rows\">Rows</h2>\n";
    if listing.columns() == 0 {
        out += "<p>There is no row.</p>\n";
    }
    let off = if listing.columns() == 0 { " class=\"off\"" } else { "" };
    let _ = writeln!(out, "<div{off}>\n{ROWS}");
    let mut about = "Numbers are rounded to six digits here; the tables beside this page have all digits.".to_string();
    if let Some(left_out) = listing.left_out() {
        about += &format!(" {left_out}");
    }
    let _ = writeln!(out, "<p class=\"notes\">{}</p></div>\n</section>", escaped(&about));
    conditions(&mut out, subject);
    out += "</main>\n";
    let plots: Vec<_> = figures.iter().map(Figure::plotly).collect();
    let data = format!("{{\"figures\":{},\"table\":{}}}", json!(plots), listing.json(subject));
    let _ = write!(
        out,
        "<script type=\"application/octet-stream\" id=\"data\">{}</script>\n<script type=\"application/octet-stream\" \
         id=\"plotly\">{}</script>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        packed(&data),
        base64(PLOTLY)
    );
    out
}

fn lead(subject: &Subject) -> String {
    let frame = &subject.frame;
    let rows = frame.rows();
    let mut said = counted(rows, "row");
    if subject.planned > rows {
        said += &format!(" of {} planned, {} missing", thousands(subject.planned), thousands(subject.planned - rows));
    }
    for outcome in ["finished", "diverged", "stalled", "failed"] {
        match frame.count(outcome) {
            0 => {}
            n => said += &format!(" · {} {outcome}", thousands(n)),
        }
    }
    if !subject.methods.is_empty() {
        said += &format!(" · by {}", subject.methods.join(", "));
    }
    plain(&said)
}

fn shown(out: &mut String, figure: &Figure) {
    let (headings, rows) = table(figure);
    let lines = figure.y.names().map_or(0, <[String]>::len);
    let high = if figure.field.is_some() { (28 * lines + 130).clamp(220, 900) } else { 440 };
    let _ = write!(
        out,
        "<section aria-labelledby=\"{0}\">\n<figure>\n<h2 id=\"{0}\">{1}</h2>\n<p>{2}</p>\n<div class=\"live\" \
         data-figure=\"{0}\" data-height=\"{high}\" role=\"img\" aria-label=\"{2}\" hidden></div>\n<div \
         class=\"static\">{3}</div>\n<figcaption><p class=\"notes\">{4}</p>\n<details><summary>the numbers</summary>\
         <div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Numbers of this figure\"><table \
         class=\"numbers\"><thead><tr>",
        figure.name,
        escaped(&figure.title),
        escaped(&figure.finding),
        figure.svg_of_page().trim_end(),
        escaped(&plain(&figure.notes.join("; ")))
    );
    for heading in headings {
        let _ = write!(out, "<th scope=\"col\">{}</th>", escaped(&plain(&heading)));
    }
    *out += "</tr></thead><tbody>\n";
    for row in rows.iter().take(NUMBERS) {
        let cells: String = row.iter().map(|cell| format!("<td>{}</td>", escaped(&plain(cell)))).collect();
        let _ = writeln!(out, "<tr>{cells}</tr>");
    }
    *out += "</tbody></table></div>";
    if rows.len() > NUMBERS {
        let _ = write!(out, "<p class=\"notes\">the first {NUMBERS} of {}</p>", thousands(rows.len()));
    }
    *out += "</details></figcaption>\n</figure>\n</section>\n";
}

fn conditions(out: &mut String, subject: &Subject) {
    *out +=
        "<section aria-labelledby=\"conditions\">\n<h2 id=\"conditions\">Conditions</h2>\n<dl class=\"conditions\">\n";
    for (name, value) in &subject.conditions {
        let _ = writeln!(out, "<dt>{}</dt><dd>{}</dd>", escaped(&plain(name)), escaped(&plain(value)));
    }
    *out += "</dl>\n";
    if !subject.commands.is_empty() {
        let _ = writeln!(
            out,
            "<h3>The same again, in this folder or where it was made</h3>\n<pre>{}</pre>",
            escaped(&subject.commands.join("\n"))
        );
    }
    if let Some(configuration) = &subject.configuration {
        let _ = writeln!(
            out,
            "<details><summary>the configuration (experiment.yaml)</summary><pre>{}</pre></details>",
            escaped(configuration)
        );
    }
    *out += "</section>\n";
}
