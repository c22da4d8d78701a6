//! One figure in four drawings: each has its numbers, at their places.

use super::subject;
use gotai::report::choose::{figures, map_in_characters};
use gotai::report::figure::{Drawn, Figure, Mark};
use gotai::report::said::{numbers, table};
use gotai::report::sheet::Sheet;
use gotai::report::{palette, png};
use serde_json::{Value, json};

fn all() -> Vec<Figure> {
    let figures = figures(&subject());
    let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(names, ["map", "pareto", "convergence", "critical", "share", "ensemble", "work"]);
    figures
}

fn decoded(file: &[u8]) -> (Vec<u8>, usize, Vec<(String, String)>) {
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let info = reader.info();
    let texts = info.utf8_text.iter().map(|chunk| (chunk.keyword.clone(), chunk.get_text().unwrap())).collect();
    (pixels, info.width as usize, texts)
}

/// Text of an element, its entities undone.
fn text_of<'a>(svg: &'a str, element: &str) -> String {
    let inside: &'a str =
        svg.split(&format!("<{element}>")).nth(1).unwrap().split(&format!("</{element}>")).next().unwrap();
    let entities = [("&quot;", "\""), ("&lt;", "<"), ("&gt;", ">"), ("&#39;", "'"), ("&amp;", "&")];
    entities.iter().fold(inside.to_string(), |text, (entity, letter)| text.replace(entity, letter))
}

#[test]
fn svg_and_png_carry_the_numbers_and_the_finding() {
    for figure in all() {
        let svg = figure.svg();
        assert_eq!(text_of(&svg, "desc"), numbers(&figure), "{}", figure.name);
        assert_eq!(text_of(&svg, "title"), figure.finding);
        assert!(svg.contains(&format!("aria-label=\"{}", &figure.finding[..9])));
        let (_, _, texts) = decoded(&figure.png().unwrap());
        assert_eq!(texts, [("Title".into(), figure.finding.clone()), ("Description".into(), numbers(&figure))]);
    }
}

#[test]
fn the_page_has_the_numbers_of_every_mark() {
    for figure in all() {
        let plotly = figure.plotly();
        let traces = plotly["data"].as_array().unwrap();
        let mut traces = traces.iter();
        if let Some(field) = &figure.field {
            let heat = traces.next().unwrap();
            for cell in &field.cells {
                assert_eq!(heat["customdata"][cell.y][cell.x]["value"], json!(cell.value), "{}", cell.said);
                let part = heat["z"][cell.y][cell.x].as_f64();
                assert_eq!(part, cell.value.map(|value| field.part(field.scale(), value)));
                assert_eq!(heat["text"][cell.y][cell.x].as_str().unwrap(), cell.said);
            }
        }
        for (mark, aside) in figure.marks.iter().zip(figure.asides()).filter(|(mark, _)| !mark.dots.is_empty()) {
            let trace = traces.next().unwrap();
            type Number<'a> = &'a dyn Fn(&gotai::report::figure::Dot) -> f64;
            let of = |of: Number| json!(mark.dots.iter().map(of).collect::<Vec<_>>());
            match mark.drawn {
                Drawn::Band => assert_eq!(trace["x"].as_array().unwrap().len(), 2 * mark.dots.len()),
                Drawn::Boundary => {
                    assert_eq!((&trace["meta"]["x"], &trace["meta"]["y"]), (&of(&|d| d.x), &of(&|d| d.y)))
                }
                _ => assert_eq!(
                    (&trace["x"], &trace["y"]),
                    (&of(&|d| figure.shifted(d.x, aside)), &of(&|d| d.y)),
                    "{}",
                    mark.label
                ),
            }
        }
    }
}

#[test]
fn the_table_has_the_numbers_as_they_are() {
    for figure in all() {
        let (headings, rows) = table(&figure);
        assert!(rows.iter().all(|row| row.len() == headings.len()));
        let told = |mark: &&gotai::report::figure::Mark| !matches!(mark.drawn, Drawn::Front | Drawn::Triangle);
        match &figure.field {
            Some(field) => {
                for (cell, row) in field.cells.iter().zip(&rows) {
                    assert_eq!(row[2].parse::<f64>().ok(), cell.value);
                }
            }
            None => {
                let dots: Vec<f64> =
                    figure.marks.iter().filter(told).flat_map(|mark| &mark.dots).map(|dot| dot.y).collect();
                let written: Vec<f64> = rows.iter().map(|row| row[2].parse().unwrap()).collect();
                assert_eq!(written, dots);
            }
        }
    }
}

/// The middle of a marker is the place of its point, in the SVG by its corners, in the PNG by its colour.
#[test]
fn points_are_drawn_where_their_numbers_are() {
    let mut seen = 0;
    for figure in all() {
        let (svg, sheet) = (figure.svg(), Sheet::of(&figure));
        let (pixels, width, _) = decoded(&figure.png().unwrap());
        let points = |mark: &Mark| matches!(mark.drawn, Drawn::Line | Drawn::Points);
        for (mark, aside) in figure.marks.iter().zip(figure.asides()).filter(|(mark, _)| points(mark)) {
            for dot in figure.shown(mark).filter(|dot| !dot.said.is_empty()) {
                let (x, y) = sheet.at(&figure, figure.shifted(dot.x, aside), dot.y);
                let marker = svg.split("<polygon").find(|part| part.contains(&format!("<title>{}</title>", dot.said)));
                let marker = marker.unwrap_or_else(|| panic!("{}: {}", figure.name, dot.said));
                let corners =
                    marker.split('"').nth(1).unwrap().split(' ').map(|corner| corner.split_once(',').unwrap());
                let corners: Vec<(f64, f64)> = corners.map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap())).collect();
                let near = |(a, b): &(f64, f64)| (a - x).abs() < 6.0 && (b - y).abs() < 6.0;
                assert!(corners.iter().all(near), "{}: {corners:?} of ({x}, {y})", dot.said);
                // Another marker may lie on it: some colour of the palette is there.
                let zoom = f64::from(png::ZOOM);
                let at = 3 * ((y * zoom).round() as usize * width + (x * zoom).round() as usize);
                let is_of = |c: &palette::Shade| {
                    [c.0, c.1, c.2].iter().zip(&pixels[at..at + 3]).all(|(a, b)| a.abs_diff(*b) < 60)
                };
                assert!(palette::COLOURS.iter().any(is_of), "{}: {:?}", dot.said, &pixels[at..at + 3]);
                seen += 1;
            }
        }
        if let Some(field) = &figure.field {
            for cell in &field.cells {
                // Off its letters.
                let (x, y) = sheet.at(&figure, cell.x as f64 - 0.3, cell.y as f64 + 0.35);
                let zoom = f64::from(png::ZOOM);
                let at = 3 * ((y * zoom).round() as usize * width + (x * zoom).round() as usize);
                let (r, g, b) = field.colour(field.scale(), cell.value.unwrap());
                assert_eq!(&pixels[at..at + 3], [r, g, b], "{}", cell.said);
            }
        }
    }
    // measured: 51
    assert!(seen > 40, "{seen}");
}

#[test]
fn the_same_figure_has_the_same_bytes() {
    for (a, b) in all().iter().zip(all()) {
        assert_eq!(a.svg(), b.svg());
        assert!(a.png().unwrap() == b.png().unwrap(), "{}", a.name);
        assert_eq!(a.plotly(), b.plotly());
    }
}

#[test]
fn a_terminal_has_the_numbers_in_80_letters() {
    for figure in all() {
        for line in figure.characters(false).lines() {
            assert!(line.chars().count() <= 80, "{}: {line}", figure.name);
        }
        let plain: String = stripped(&figure.characters(true));
        assert_eq!(plain, figure.characters(false));
    }
    let map = map_in_characters(&subject()).unwrap();
    let text = map.characters(false);
    let lines: Vec<&str> = text.lines().skip_while(|line| !line.contains("1e-3")).collect();
    // i × j × 2 of 10: from above in the order of the plan.
    for (line, shown) in
        lines[1..].iter().zip(["cube 8 0% 0% 0%", "cube 27 0% 20% 40%", "cube 64 0% 40% 80%", "cube 125 0% 60% 100%"])
    {
        assert_eq!(line.split_whitespace().collect::<Vec<_>>().join(" "), shown);
    }
    // In a plot the letter of every series is where its numbers are: the larger the step, the farther right and up.
    let share = all().into_iter().find(|figure| figure.name == "share").unwrap().characters(false);
    let at =
        |letter: char| share.lines().filter(|line| line.contains('|')).position(|line| line.contains(letter)).unwrap();
    assert!(at('d') < at('c') && at('c') < at('b'), "{share}");
}

fn stripped(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('\u{1b}') {
        out += before;
        rest = after.split_once('m').unwrap().1;
    }
    (out + rest).lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
}

#[test]
fn nothing_to_show_is_still_a_figure() {
    let figure = Figure { marks: Vec::new(), ..all().remove(1) };
    assert!(
        figure.svg().contains("</svg>") && !figure.png().unwrap().is_empty() && !figure.characters(true).is_empty()
    );
    assert_eq!(figure.plotly()["data"], Value::Array(Vec::new()));
}

/// Only error bars at one place stand side by side, and no farther than a fiftieth of the axis from it.
#[test]
fn error_bars_do_not_hide_each_other() {
    for figure in all() {
        let asides = figure.asides();
        let shifted = asides.iter().filter(|aside| **aside != 0.0).count();
        assert_eq!(shifted > 0, figure.name == "share", "{}: {asides:?}", figure.name);
        assert!(asides.iter().all(|aside| aside.abs() <= 0.02) && asides.iter().sum::<f64>().abs() < 1e-12);
    }
    let share = all().into_iter().find(|figure| figure.name == "share").unwrap();
    let asides = share.asides();
    let mut at: Vec<f64> =
        share.marks.iter().zip(asides).map(|(mark, aside)| share.shifted(mark.dots[1].x, aside)).collect();
    at.dedup();
    assert_eq!(at.len(), 4);
}
