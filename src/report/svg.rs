//! A figure as SVG. Its title is the finding, its description has all numbers, for whoever reads it without eyes, or
//! with a program.

use super::figure::Figure;
use super::number::is_shown;
use super::palette::hex;
use super::said::numbers;
use super::sheet::{HEIGHT, Ink, Sheet, Stroke, TextAnchor, WIDTH};
use std::fmt::Write;

/// Text with what means something to a browser taken for letters.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if is_shown(c) || c == '\n' || c == '\t' => out.push(c),
            _ => {}
        }
    }
    out
}

const NAMESPACE: &str = r#"xmlns="http://www.w3.org/2000/svg""#;
const FONT: &str = r#"font-family="'DejaVu Sans', Verdana, sans-serif""#;

impl Figure {
    /// The figure as a file of its own, on white.
    pub fn svg(&self) -> String {
        let fixed = |ink: Ink| match ink {
            Ink::Letters => "#1c1c1e".to_string(),
            Ink::Muted => "#5d5d63".to_string(),
            Ink::Grid => "#e4e4e8".to_string(),
            Ink::Paper => "#ffffff".to_string(),
            Ink::Fixed(colour) => hex(colour),
        };
        let paper = format!(r##"<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>"##);
        self.written(&paper, fixed, true)
    }

    /// The figure as a part of a page, in its colours.
    pub fn svg_of_page(&self) -> String {
        let named = |ink: Ink| match ink {
            Ink::Letters => "var(--ink)".to_string(),
            Ink::Muted => "var(--muted)".to_string(),
            Ink::Grid => "var(--grid)".to_string(),
            Ink::Paper => "var(--paper)".to_string(),
            Ink::Fixed(colour) => hex(colour),
        };
        self.written("", named, false)
    }

    fn written(&self, paper: &str, ink: impl Fn(Ink) -> String, has_numbers: bool) -> String {
        let mut out = format!(
            r#"<svg {NAMESPACE} viewBox="0 0 {WIDTH} {HEIGHT}" role="img" {FONT} aria-label="{}">"#,
            escaped(&self.finding)
        );
        if has_numbers {
            let _ = write!(out, "<title>{}</title><desc>{}</desc>", escaped(&self.finding), escaped(&numbers(self)));
        }
        out += paper;
        for stroke in &Sheet::of(self).strokes {
            // Writing into memory cannot fail.
            let _ = match stroke {
                Stroke::Area { points, ink: of, opacity, said } => {
                    let (of, opacity) = (ink(*of), see_through("fill-opacity", *opacity));
                    let points = listed(points);
                    match said.is_empty() || !has_numbers {
                        true => write!(out, r#"<polygon points="{points}" fill="{of}"{opacity}/>"#),
                        false => write!(
                            out,
                            r#"<polygon points="{points}" fill="{of}"{opacity}><title>{}</title></polygon>"#,
                            escaped(said)
                        ),
                    }
                }
                Stroke::Path { points, ink: of, width, opacity } => write!(
                    out,
                    r#"<polyline points="{}" fill="none" stroke="{}" stroke-width="{width}"{}/>"#,
                    listed(points),
                    ink(*of),
                    see_through("stroke-opacity", *opacity)
                ),
                Stroke::Letters { x, y, size, anchor, ink: of, bold, up, text } => {
                    let anchor = match anchor {
                        TextAnchor::Start => "start",
                        TextAnchor::Middle => "middle",
                        TextAnchor::End => "end",
                    };
                    let weight = if *bold { r#" font-weight="bold""# } else { "" };
                    let turned = if *up { format!(r#" transform="rotate(-90 {x:.2} {y:.2})""#) } else { String::new() };
                    let (y, of) = (y + 0.35 * size, ink(*of));
                    let place = format!(r#"x="{x:.2}" y="{y:.2}" font-size="{size:.1}" text-anchor="{anchor}""#);
                    write!(out, r#"<text {place} fill="{of}"{weight}{turned}>{}</text>"#, escaped(text))
                }
            };
        }
        out + "</svg>\n"
    }
}

fn see_through(of: &str, opacity: f64) -> String {
    if opacity < 1.0 { format!(r#" {of}="{opacity}""#) } else { String::new() }
}

fn listed(points: &[(f64, f64)]) -> String {
    let points: Vec<String> = points.iter().map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
    points.join(" ")
}
