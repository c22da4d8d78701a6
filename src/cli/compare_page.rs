//! A comparison as one page of HTML that needs nothing else.

use super::compared::{
    FACTOR, at, brief, cell, changed, described, factor, finding, interval, joined, others, outcomes,
};
use crate::check::{Change, Compared, Regression, Side};
use crate::report::plain;
use crate::report::svg;
use std::fmt::Write;

const STYLE: &str = "
:root { color-scheme: light dark; }
body { font: 16px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 70rem; padding: 1rem; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { border-bottom: 1px solid color-mix(in srgb, currentColor 25%, transparent); padding: .25rem .6rem; }
th, td { text-align: right; overflow-wrap: normal; }
th:first-child, td:first-child, td.text { text-align: left; }
.worse { font-weight: bold; }
";

/// A text on a page: names are data, and hold no control and no markup.
fn escaped(text: &str) -> String {
    svg::escaped(&plain(text))
}

/// The page; all names are escaped.
pub(super) fn page(a: &Side, b: &Side, compared: &Compared) -> String {
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width\">\n<title>{} against {}</title>\n<style>{STYLE}</style>\n<h1>What changed</h1>\n\
         <p class=\"worse\">{}</p>\n<p>A: {}<br>B: {}</p>\n",
        escaped(&b.name),
        escaped(&a.name),
        escaped(&finding(compared)),
        escaped(&described(a)),
        escaped(&described(b))
    );
    let mut paragraph = |said: &[String]| {
        let said: Vec<String> = said.iter().map(|line| escaped(line)).collect();
        if !said.is_empty() {
            // Writing to a string does not fail.
            let _ = writeln!(html, "<p>{}</p>", said.join("<br>"));
        }
    };
    paragraph(&joined(compared));
    paragraph(&outcomes(compared));
    let row = |c: &&Change| {
        let numbers = [c.cells, c.better, c.worse].map(|count| count.to_string());
        let sizes = [c.median_a, c.median_b].map(brief);
        [vec![c.column.clone(), c.unit.to_string()], numbers.to_vec(), sizes.to_vec(), vec![factor(c), interval(c)]]
            .concat()
    };
    let rows: Vec<Vec<String>> = changed(compared).iter().map(row).collect();
    if !rows.is_empty() {
        let header = ["column", "unit", "cases", "better", "worse", "A", "B", "B / A", "95 %"];
        let caption = format!("Columns in {} cases that finished in both; A, B: medians of sizes", compared.finished);
        table(&mut html, &caption, &header, &rows);
        let _ = writeln!(html, "<p>{}</p>", escaped(FACTOR));
    }
    for line in others(compared) {
        let _ = writeln!(html, "<p>{}</p>", escaped(&line));
    }
    if !compared.regressions.is_empty() {
        let row = |r: &Regression| {
            let case = |case: &Option<String>| case.clone().unwrap_or_default();
            vec![r.column.clone(), at(&r.axes), cell(&r.a), cell(&r.b), case(&r.case_a), case(&r.case_b)]
        };
        let rows: Vec<Vec<String>> = compared.regressions.iter().map(row).collect();
        let caption = format!("Worse in B: {} of {}", rows.len(), compared.regression_count);
        table(&mut html, &caption, &["column", "at", "A", "B", "case of A", "case of B"], &rows);
        let _ = writeln!(html, "<p>A case again: <code>gotai run FOLDER --case CASE</code></p>");
    }
    html + "</html>\n"
}

fn table(html: &mut String, caption: &str, header: &[&str], rows: &[Vec<String>]) {
    let heads: String = header.iter().map(|cell| format!("<th scope=\"col\">{}</th>", escaped(cell))).collect();
    let _ = writeln!(html, "<div class=\"scroll\"><table><caption>{}</caption>", escaped(caption));
    let _ = writeln!(html, "<tr>{heads}</tr>");
    for row in rows {
        let cell = |cell: &String| {
            // A place on the axes is words.
            let class = if cell.contains(" = ") { " class=\"text\"" } else { "" };
            format!("<td{class}>{}</td>", escaped(cell))
        };
        let cells: String = row.iter().map(cell).collect();
        let _ = writeln!(html, "<tr>{cells}</tr>");
    }
    html.push_str("</table></div>\n");
}
