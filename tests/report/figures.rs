//! What figures find in rows: intervals, critical values, laws, pooling, what is missing or failed.

use super::{axis, of_rows, row, subject};
use gotai::check::{Failing, Judged};
use gotai::math::interval::of_share;
use gotai::report::choose::{figures, map_in_characters};
use gotai::report::figure::{Drawn, Picked};
use gotai::report::labels::{Labels, MOST};
use gotai::report::page::Page;
use gotai::report::power_law::{PowerFit, PowerLaw};
use gotai::report::stats::{crossing, explained, quantile};
use gotai::report::subject::{Ground, Subject};
use serde_json::json;

#[test]
fn intervals_of_shares_are_wilsons() {
    let share = |k, n| (of_share(k, n).low, of_share(k, n).high);
    // By hand from the formula, with z = 1.96.
    let near =
        |(a, b): (f64, f64), (c, d): (f64, f64)| assert!((a - c).abs() < 5e-4 && (b - d).abs() < 5e-4, "{a} {b}");
    near(share(0, 20), (0.0, 0.1611));
    near(share(10, 20), (0.2993, 0.7007));
    near(share(20, 20), (0.8389, 1.0));
    near(share(1, 1), (0.2065, 1.0));
    assert_eq!(share(0, 0), (0.0, 1.0));
}

#[test]
fn a_share_crosses_a_half_between_its_levels() {
    let (at, low, high) = crossing(&[(0.0, 0, 100), (1.0, 25, 100), (2.0, 75, 100), (3.0, 100, 100)]).unwrap();
    assert_eq!(at, 1.5);
    assert!(low.unwrap() < at && at < high.unwrap());
    assert_eq!(crossing(&[(0.0, 0, 10), (1.0, 4, 10)]), None);
    // One that falls by chance is taken for level.
    assert!(crossing(&[(0.0, 0, 10), (1.0, 6, 10), (2.0, 2, 10), (3.0, 10, 10)]).unwrap().0 > 2.0);
}

#[test]
fn laws_of_powers_are_found() {
    let points: Vec<(f64, f64)> = [1.0, 2.0, 4.0, 8.0].map(|x: f64| (x, 3.0 / (x * x))).to_vec();
    let law = PowerLaw::fit(&points).unwrap();
    assert!((law.exponent + 2.0).abs() < 1e-12 && (law.factor - 3.0).abs() < 1e-12 && law.margin.unwrap() < 1e-6);
    assert_eq!(PowerLaw::fit(&[(1.0, 2.0)]), None);
    assert_eq!(PowerLaw::fit(&[(1.0, 2.0), (1.0, 3.0)]), None);
}

#[test]
fn what_follows_no_law_of_a_power_has_none() {
    let fit = |points: &[(f64, f64)]| PowerFit::of(points, &[]);
    let places: [f64; 5] = [1.0, 2.0, 4.0, 8.0, 16.0];
    // Some noise of a fixed pattern: the law is still found, with an interval that holds it.
    let noisy: Vec<(f64, f64)> =
        places.iter().zip([1.03, 0.97, 1.02, 0.99, 1.01]).map(|(x, noise)| (*x, noise * 2.0 / x.sqrt())).collect();
    let PowerFit::Holds(law) = fit(&noisy) else { panic!("{:?}", fit(&noisy)) };
    // measured: -0.50 ± 0.03
    assert!((law.exponent + 0.5).abs() < law.margin.unwrap() && law.margin.unwrap() < 0.05, "{law:?}");
    // An exponential bends in logarithms: the local exponent of e^-x is -x.
    let bent: Vec<(f64, f64)> = places.map(|x| (x, (-0.2 * x).exp())).to_vec();
    assert!(matches!(fit(&bent), PowerFit::Bends(first, last) if first > -0.5 && last < -1.5), "{:?}", fit(&bent));
    // Levels off: no law, though a line through it has a narrow interval.
    let level: Vec<(f64, f64)> = places.map(|x| (x, 1.0 + 1.0 / x)).to_vec();
    assert!(matches!(fit(&level), PowerFit::Bends(..)), "{:?}", fit(&level));
    assert_eq!(fit(&noisy[..3]), PowerFit::TooFew(3));
    // Four points at two places are two places.
    assert_eq!(fit(&[(1.0, 1.0), (1.0, 1.1), (2.0, 0.5), (2.0, 0.6)]), PowerFit::TooFew(2));
    let scattered = [(1.0, 1.0), (2.0, 8.0), (4.0, 0.5), (8.0, 6.0), (16.0, 1.0)];
    assert!(matches!(fit(&scattered), PowerFit::Scattered(_)), "{:?}", fit(&scattered));
    // An exponent that may be 0 is no law.
    let flat: Vec<(f64, f64)> = places.iter().zip([1.0, 1.06, 0.95, 1.05, 1.0]).map(|(x, y)| (*x, y)).collect();
    assert!(matches!(fit(&flat), PowerFit::Flat(_)), "{:?}", fit(&flat));
    // Intervals that the law leaves: of five, two are more than chance.
    let narrow: Vec<(f64, f64)> = noisy.iter().map(|(_, y)| (0.999 * y, 1.001 * y)).collect();
    assert!(matches!(PowerFit::of(&noisy, &narrow), PowerFit::OutsideOfIntervals(n, 5) if n > 1));
    let wide: Vec<(f64, f64)> = noisy.iter().map(|(_, y)| (0.8 * y, 1.2 * y)).collect();
    assert!(matches!(PowerFit::of(&noisy, &wide), PowerFit::Holds(_)));
}

#[test]
fn long_values_have_short_names_that_differ() {
    let method = |sweeps: u32| {
        format!(r#"{{"time-stepping":{{"solver":"pgs","sweeps":{sweeps},"tolerance":1e-8,"scheme":"moreau"}}}}"#)
    };
    let Labels { labels, note } = Labels::of_words(&[method(400), method(500), method(600)]);
    assert_eq!(labels, ["sweeps=400", "sweeps=500", "sweeps=600"]);
    assert!(note.unwrap().contains("in common: time-stepping solver=pgs tolerance=1e-8 scheme=moreau"));
    let texts =
        ["a long text whose end alone is another one: this", "a long text whose end alone is another one: that"];
    assert_eq!(Labels::of_words(&texts.map(String::from)).labels, ["this", "that"]);
    // Where nothing short tells them apart, a number does.
    let unbroken = ["x".repeat(60) + "1", "x".repeat(60) + "2"];
    let Labels { labels, .. } = Labels::of_words(&unbroken);
    assert!(labels[0].starts_with("1: xxx") && labels[1].starts_with("2: xxx"), "{labels:?}");
    assert!(labels.iter().all(|label| label.chars().count() <= MOST));
    assert_eq!(Labels::of_words(&["rk4".to_string(), "dop853".to_string()]).note, None);
    // Of numbers as few digits as tell them apart.
    let steps: Vec<f64> = (0..5).map(|i| 10f64.powf(-3.0 + 0.5 * f64::from(i))).collect();
    let names: Vec<String> = steps.iter().map(f64::to_string).collect();
    assert_eq!(Labels::of_numbers(&steps, &names).labels, ["1e-3", "0.00316", "0.01", "0.0316", "0.1"]);
    let near = [1.23456789, 1.23456];
    assert_eq!(Labels::of_numbers(&near, &near.map(|x| x.to_string())).labels, ["1.23457", "1.23456"]);
}

/// A map over methods that are written in full, and over 41 numbers of many digits, whose name looks like a formula.
pub fn with_long_names() -> Subject {
    let methods: Vec<String> = (0..3)
        .map(|i| format!(r#"{{"time-stepping":{{"solver":"pgs","sweeps":{}00,"scheme":"moreau"}}}}"#, i + 1))
        .collect();
    let numbers: Vec<f64> = (0..41).map(|i| 0.01 + 0.02225 * f64::from(i)).collect();
    let mut rows = Vec::new();
    for (i, method) in methods.iter().enumerate() {
        for (j, x) in numbers.iter().enumerate() {
            let outcome = if i + j > 20 { "diverged" } else { "finished" };
            rows.push(row(json!({ "case": format!("{i}-{j}"), "method": method, "$x$": x, "outcome": outcome })));
        }
    }
    of_rows(rows, vec![axis("method", json!(methods)), axis("$x$", json!(numbers))])
}

#[test]
fn a_map_with_long_values_has_room_for_its_cells() {
    let subject = with_long_names();
    let map = figures(&subject).remove(0);
    assert_eq!(map.y.names().unwrap(), ["sweeps=300", "sweeps=200", "sweeps=100"]);
    assert!(map.notes.iter().any(|note| note.starts_with("method: without what all have in common")));
    assert!(map.x.names().unwrap().iter().all(|name| name.chars().count() <= 13), "{:?}", map.x.names());
    assert!(!map.finding.contains('{'), "{}", map.finding);
    // Choosing a cell asks the table for the values as it has them.
    let cells = &map.field.as_ref().unwrap().cells;
    let Picked::OneOf(values) = &cells[0].pick[1].1 else { panic!("{:?}", cells[0].pick) };
    assert!(values[0].starts_with("{\"time-stepping\""), "{values:?}");
    // Of 41 values in 40 columns one column stands for two.
    let pooled = cells.iter().find_map(|cell| match cell.pick[0].1 {
        Picked::Between(low, high) => Some((low, high)),
        _ => None,
    });
    assert_eq!(pooled, Some((0.01, 0.01 + 0.02225)));
    let text = map_in_characters(&subject).unwrap().characters(false);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    // Heads of columns stand apart.
    for head in ["0.01…", "0.166…"] {
        assert!(text.split_whitespace().any(|word| word == head), "{head}: {text}");
    }
}

#[test]
fn an_axis_is_logarithmic_where_its_steps_are_ratios() {
    let of = |values: Vec<f64>| {
        let rows = values.iter().map(|x| row(json!({ "case": x.to_string(), "x": x, "outcome": "finished" })));
        let subject = of_rows(rows.collect(), vec![axis("x", json!(values))]);
        Ground::of(&subject).axes[0].is_logarithmic()
    };
    assert!(of(vec![1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2]));
    assert!(of(vec![1e-3, 1.0]));
    assert!(!of((0..41).map(|i| 0.01 + 0.02225 * f64::from(i)).collect()));
    assert!(!of(vec![1.0, 2.0, 3.0]));
}

/// Ten thousand places are a line of two hundred: it says so, and all rows are in it.
#[test]
fn lines_along_very_many_values_are_pooled() {
    let n = 10_000;
    let values: Vec<f64> = (0..n).map(|i| 0.5 + 0.1 * f64::from(i)).collect();
    let rows = values.iter().enumerate().map(|(i, x)| {
        let outcome = if i > 5_000 { "diverged" } else { "finished" };
        row(json!({ "case": i.to_string(), "x": x, "outcome": outcome, "work_sweeps": i + 1 }))
    });
    let subject = of_rows(rows.collect(), vec![axis("x", json!(values))]);
    let figures = figures(&subject);
    let names: Vec<&str> = figures.iter().map(|figure| figure.name.as_str()).collect();
    assert_eq!(names, ["share", "work"]);
    for figure in &figures {
        assert!(figure.marks.iter().all(|mark| mark.dots.len() == 200), "{}", figure.name);
        let said = "10000 values of x are pooled into 200";
        assert!(figure.notes.iter().any(|note| note == said), "{:?}", figure.notes);
        // Where they are: the middle of fifty neighbours.
        assert!((figure.marks[0].dots[0].x - (0.5 + 0.1 * 24.5)).abs() < 1e-9);
    }
    let shares: f64 = figures[0].marks[0].dots.iter().map(|dot| 50.0 * dot.y).sum();
    assert_eq!(shares.round() as usize, n as usize - 5_001);
    assert!(Page::of(&subject, &figures).html.len() < 3_000_000);
}

#[test]
fn an_axis_explains_what_follows_it_and_no_chance() {
    let follows = (0..100).map(|i| (i % 4, (i % 4) as f64 + 0.01 * ((i * 7) % 10) as f64));
    assert!(explained(4, follows) > 0.98);
    let chance = (0..100).map(|i| (i % 4, ((i * 37) % 101) as f64));
    assert!(explained(4, chance) < 0.1);
    assert_eq!(explained(3, (0..3).map(|i| (i, i as f64))), 0.0);
    assert_eq!(quantile(&[1.0, 2.0, 4.0], 0.75), 3.0);
}

#[test]
fn the_figures_say_what_they_find_with_numbers() {
    let figures = figures(&subject());
    let of = |name: &str| figures.iter().find(|figure| figure.name == name).unwrap();
    let map = of("map");
    assert!(
        map.finding.starts_with("34 of 120 runs diverge (28.3 %, 95 % interval 21.0 to 37.0 %)"),
        "{}",
        map.finding
    );
    assert!(map.finding.contains("scene.n = cube 125: 10 of 10"), "{}", map.finding);
    let cell = &map.field.as_ref().unwrap().cells.iter().find(|cell| cell.text == "100%").unwrap();
    assert!(cell.said.contains("10 of 10 diverged (95 % interval 72% to 100%)"), "{}", cell.said);
    assert_eq!(cell.pick[0], ("time.step_s".to_string(), Picked::OneOf(vec!["0.1".to_string()])));
    assert!(map.notes.iter().any(|note| note == "pooled over seed (10 values)"), "{:?}", map.notes);
    assert!(map.notes[0].contains("n = 120 rows; method: lecture"), "{:?}", map.notes);
    // The error is the square of the step, and the time one over it.
    assert!(of("convergence").finding.contains("cube 8 2.00"), "{}", of("convergence").finding);
    assert!(of("convergence").marks.iter().any(|mark| mark.drawn == Drawn::Triangle && mark.label == "order 2"));
    assert!(of("critical").finding.contains("time.step_s"), "{}", of("critical").finding);
    assert!(of("ensemble").marks.iter().any(|mark| mark.drawn == Drawn::Band));
    assert!(of("work").finding.contains("work_sweeps"), "{}", of("work").finding);
}

#[test]
fn a_share_that_one_series_alone_has_is_said_once() {
    let of =
        |a: i32, b: &str, outcome: &str| row(json!({ "case": format!("{a}{b}"), "a": a, "b": b, "outcome": outcome }));
    let rows = vec![of(1, "x", "finished"), of(2, "x", "diverged"), of(1, "y", "finished"), of(2, "y", "failed")];
    let all = figures(&of_rows(rows, vec![axis("a", json!([1, 2])), axis("b", json!(["x", "y"]))]));
    let share = all.iter().find(|figure| figure.name == "share").unwrap();
    assert_eq!(share.finding, "At a = 2 100% of the runs diverge (b = x).");
    // One run is one.
    let one = figures(&of_rows(vec![of(1, "x", "finished")], vec![axis("a", json!([1, 2]))]));
    assert!(
        one[0].finding.starts_with("The one run does not diverge (95 % interval up to 79.35 %)."),
        "{}",
        one[0].finding
    );
}

/// Of a search the map has the critical values, and not how the runs at the lower ends of the brackets ended.
#[test]
fn the_map_of_a_search_is_of_what_was_searched() {
    let mut rows = Vec::new();
    for body in ["cube", "bar"] {
        for n in [1.0, 2.0, 4.0, 8.0, 16.0] {
            let low = if body == "cube" { 0.1 / n } else { 0.2 * (1.0 + 1.0 / n) };
            rows.push(row(json!({
                "case": format!("{body}{n}"), "body": body, "n": n, "outcome": if n > 2.0 { "diverged" } else { "finished" },
                "search_low": low, "search_high": 1.01 * low, "search_verdict": "found",
            })));
        }
    }
    let axes = vec![axis("body", json!(["cube", "bar"])), axis("n", json!([1, 2, 4, 8, 16]))];
    let subject = Subject { search: Some("time.step_s".to_string()), ..of_rows(rows, axes) };
    let all = figures(&subject);
    assert!(all.iter().all(|figure| figure.name != "share"));
    assert!(all[0].finding.starts_with("The median critical time.step_s of a cell goes from 0.00625 s to 0.4 s"));
    assert!(all[0].notes.iter().any(|note| note == "the lower end of every bracket"));
    let critical = all.iter().find(|figure| figure.name == "critical").unwrap();
    // One has a law, the other levels off.
    assert!(critical.finding.contains("cube: exponent -1.00 ± 0.00 (5 places)"), "{}", critical.finding);
    assert!(critical.finding.contains("bar: no law: the exponent goes from -0.45 to 0.00"), "{}", critical.finding);
    let dashed = critical.marks.iter().filter(|mark| mark.drawn == Drawn::Dashed).count();
    assert_eq!(dashed, 1);
}

#[test]
fn what_is_missing_or_failed_is_seen() {
    let rows = (0..6).map(|i| {
        let outcome = if i == 5 { "failed" } else { "finished" };
        row(json!({ "case": format!("c{i}"), "a": i % 3, "b": i / 3, "outcome": outcome, "energy_drift_rel": 1e-3 * i as f64 }))
    });
    let mut all = of_rows(rows.take(6).collect(), vec![axis("a", json!([0, 1, 2, 3])), axis("b", json!([0, 1]))]);
    all.planned = 8;
    let map = map_in_characters(&all).unwrap();
    let text = map.characters(false).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("failed!") && text.contains("–!") && text.contains("2 cases planned are missing"), "{text}");
    assert!(text.contains("1 case failed and is left out"), "{text}");
    let doubtful = map.field.unwrap().cells.iter().filter(|cell| cell.is_doubtful).count();
    assert_eq!(doubtful, 3);
}

#[test]
fn a_map_of_many_values_is_pooled_and_says_so() {
    let n = 40;
    let rows = (0..n * n).map(|i| {
        let outcome = if i % n + i / n > 50 { "diverged" } else { "finished" };
        row(json!({ "case": format!("c{i}"), "x": i % n, "y": i / n, "outcome": outcome }))
    });
    let values = || json!((0..n).collect::<Vec<_>>());
    let all = of_rows(rows.collect(), vec![axis("x", values()), axis("y", values())]);
    let map = map_in_characters(&all).unwrap();
    assert_eq!((map.x.names().unwrap().len(), map.y.names().unwrap().len()), (12, 12));
    assert!(map.notes.iter().any(|note| note == "40 values of x are pooled into 12"), "{:?}", map.notes);
    let text = map.characters(false);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    // All rows are in some cell.
    let of = |said: &str| said.split(" of ").nth(1).unwrap().split(' ').next().unwrap().parse::<usize>().unwrap();
    assert_eq!(map.field.unwrap().cells.iter().map(|cell| of(&cell.said)).sum::<usize>(), n * n);
}

#[test]
fn one_case_all_failed_infinities_and_no_axis_are_reports() {
    let one = |cells| of_rows(vec![row(cells)], Vec::new());
    let infinite = of_rows(vec![row(json!({ "case": "c", "outcome": "finished" }))], vec![axis("a", json!([1, 2]))]);
    for subject in [
        Subject::default(),
        one(json!({ "case": "c", "outcome": "finished", "energy_drift_rel": 1e-3 })),
        one(json!({ "case": "c", "outcome": "failed", "criterion": "a panic" })),
        infinite,
    ] {
        let figures = figures(&subject);
        for figure in &figures {
            assert!(figure.svg().contains("</svg>") && !figure.finding.contains("NaN"), "{}", figure.finding);
        }
        assert!(Page::of(&subject, &figures).html.ends_with("</html>\n"));
    }
    let csv =
        "case,a,outcome,error_position_m,wall_s\n1,1,finished,inf,1\n2,2,finished,1e-3,2\n3,3,diverged,-inf,nan\n";
    let frame = gotai::report::frame::RowFrame::of_csv(csv.as_bytes()).unwrap();
    assert_eq!((frame.text("error_position_m", 0), frame.text("wall_s", 2)), ("∞".to_string(), String::new()));
    let subject = Subject { frame, axes: vec![axis("a", json!([1, 2, 3]))], planned: 3, ..Subject::default() };
    let page = Page::of(&subject, &figures(&subject));
    assert!(!page.html.split("<script").next().unwrap().contains("NaN"));
}

#[test]
fn pages_stay_small() {
    let many = |rows: usize, columns: usize| {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let rows = (0..rows).map(|i| {
            let mut cells = row(json!({
                "case": format!("{:016x}", (i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)), "time.step_s": 1e-3 * (1 + i % 10) as f64, "seed": i / 10,
                "outcome": if i % 7 == 0 { "diverged" } else { "finished" },
            }));
            cells.extend((0..columns).map(|column| (format!("column_{column}"), json!(random()))));
            cells
        });
        let rows: Vec<_> = rows.collect();
        let seeds = rows.len() / 10;
        let steps = (1..=10).map(|i| 1e-3 * f64::from(i)).collect::<Vec<_>>();
        of_rows(rows, vec![axis("time.step_s", json!(steps)), axis("seed", json!((0..seeds).collect::<Vec<_>>()))])
    };
    // measured: 2.7e6 of 10,000 rows of 40 random columns
    let page = Page::of(&many(10_000, 40), &[]);
    assert!(page.html.len() <= 3_000_000 && page.left_out.is_none(), "{} {:?}", page.html.len(), page.left_out);
    let wide = Page::of(&many(3_000, 300), &[]);
    assert!(wide.html.len() <= 3_000_000 && wide.left_out.unwrap().contains("columns"), "{}", wide.html.len());
    let page = Page::of(&many(20_010, 3), &[]);
    let said = "The table holds the 2,000 most telling of 20,010 rows";
    assert!(page.html.len() <= 8_000_000 && page.left_out.as_ref().unwrap().contains(said), "{:?}", page.left_out);
    assert!(page.html.contains(said));
}

#[test]
fn verdicts_on_a_page_name_their_cases() {
    let mut subject = subject();
    subject.replay = Some("gotai run out --case".to_string());
    let failing = |n: usize| -> Vec<Failing> {
        let of = |i: usize| Failing {
            case: format!("{i:016x}"),
            axes: row(json!({ "scene.n": "cube 8", "time.step_s": 1e-3, "seed": i })),
            column: "energy_drift_rel".to_string(),
            value: json!(1.5 - 0.01 * i as f64),
        };
        (0..n).map(of).collect()
    };
    let judged = |met: bool, n: usize| Judged {
        expectation: "energy_drift_rel".into(),
        bound: "≤ 1".into(),
        measured: "1.5".into(),
        met,
        why: None,
        rows: 120,
        failing: failing(n),
    };
    subject.verdicts = vec![judged(true, 0), judged(false, 3), judged(false, 40)];
    let html = Page::of(&subject, &[]).html;
    for part in [
        "What was expected: 1 of 3 met",
        "its 3 cases, the worst first",
        "the 24 worst of its 40 cases",
        "… and 16 more",
        "energy_drift_rel = 1.5, at scene.n = cube 8, time.step_s = 0.001, seed = 0",
        "gotai run out --case 00000000</code>",
    ] {
        assert!(html.contains(part), "{part}");
    }
    assert_eq!(html.matches("data-case=").count(), 3 + 24);
}

/// Letters that mean something to a page or a terminal.
pub const HOSTILE: &str =
    "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=1>'\"\u{1b}[31m\u{202e}";

#[test]
fn names_are_letters_and_nothing_else() {
    let mut subject = subject();
    subject.question = Some(HOSTILE.to_string());
    subject.methods = vec![HOSTILE.to_string()];
    subject.axes.push(axis(HOSTILE, json!([HOSTILE, "b"])));
    subject.conditions = vec![(HOSTILE.to_string(), HOSTILE.to_string())];
    subject.configuration = Some(HOSTILE.to_string());
    subject.warnings = vec![HOSTILE.to_string()];
    let figures = figures(&subject);
    let page = Page::of(&subject, &figures).html;
    assert!(
        !page.contains("<img")
            && !page.contains("<script>window")
            && !page.contains('\u{1b}')
            && !page.contains('\u{202e}')
    );
    for figure in figures {
        assert!(!figure.svg().contains("<img") && !figure.svg().contains("<script"));
        assert!(!figure.characters(false).contains('\u{1b}'));
        assert!(!figure.plotly().to_string().contains("<img"), "{}", figure.name);
    }
}

/// Twelve series have no room: one problem is drawn, never the mean of two.
#[test]
fn trials_are_not_pooled_over_problems() {
    let (methods, steps, problems) = (["a", "b", "c", "d", "e", "f"], [0.1, 0.05], [1.0, 1000.0]);
    let mut rows = Vec::new();
    for method in methods {
        for step_s in steps {
            for problem in problems {
                rows.push(row(json!({
                    "case": format!("{}", rows.len()), "method.free": method, "time.step_s": step_s, "v": problem,
                    "outcome": "finished", "error_position_m": 1e-3 * problem * step_s * step_s, "wall_s": 1e-3 / step_s,
                })));
            }
        }
    }
    let axes = vec![axis("method.free", json!(methods)), axis("time.step_s", json!(steps)), axis("v", json!(problems))];
    let all = figures(&of_rows(rows, axes));
    for name in ["pareto", "convergence"] {
        let figure = all.iter().find(|figure| figure.name == name).unwrap();
        assert!(figure.finding.ends_with(" Of v = 1 alone, of 2 values."), "{}", figure.finding);
        let dots = figure.marks.iter().filter(|mark| mark.drawn == Drawn::Line).flat_map(|mark| &mark.dots);
        for dot in dots {
            assert!(dot.row.is_some(), "{name}: {}", dot.said);
            let error = if name == "pareto" { dot.x } else { dot.y };
            assert!(error < 2e-5, "{name}: {error}");
        }
    }
}

/// Errors of 1e-16 m on positions of 1 m fall as chance has it: no order, and no rank.
#[test]
fn what_is_rounding_has_neither_an_order_nor_a_rank() {
    let errors = |method: &str| match method {
        "exact" => [1.6e-14, 8.9e-16, 4.4e-16, 0.0],
        _ => [1e-2, 2.5e-3, 6.25e-4, 1.5625e-4],
    };
    let mut rows = Vec::new();
    for (rank, method) in ["exact", "plain"].into_iter().enumerate() {
        for (i, error) in errors(method).into_iter().enumerate() {
            let step_s = 0.1 / f64::from(1 << i);
            rows.push(row(json!({
                "case": format!("{}", rows.len()), "method.free": method, "time.step_s": step_s, "outcome": "finished",
                "error_position_m": error, "wall_s": (rank + 1) as f64 * 1e-3 / step_s,
            })));
        }
    }
    let steps: Vec<f64> = (0..4).map(|i| 0.1 / f64::from(1 << i)).collect();
    let axes = vec![axis("method.free", json!(["exact", "plain"])), axis("time.step_s", json!(steps))];
    let all = figures(&of_rows(rows, axes));
    let finding = |name: &str| all.iter().find(|figure| figure.name == name).unwrap().finding.clone();
    assert!(
        !finding("convergence").contains("exact") && finding("convergence").contains("plain 2.00"),
        "{}",
        finding("convergence")
    );
    let said = "the first with no error but rounding (up to 1.42e-14 m) is exact in 0.02 s";
    assert!(finding("pareto").contains(said), "{}", finding("pareto"));
}

/// Where the median is 0 a line has a gap and no area is drawn straight across; a lower end of 0 is 0 and lies at the
/// end of the axis.
#[test]
fn an_ensemble_has_zeros_and_gaps() {
    let (places, seeds) = ([1.0, 2.0, 3.0, 4.0], 0..20);
    let mut rows = Vec::new();
    for place in places {
        for seed in seeds.clone() {
            let size = match place as u32 {
                2 => 0.0,
                // A tenth is 0: so is the 5 % quantile.
                4 if seed < 2 => 0.0,
                _ => 1e-3 * place * (1.0 + f64::from(seed)),
            };
            rows.push(row(json!({
                "case": format!("{}", rows.len()), "x": place, "seed": seed, "outcome": "finished",
                "energy_drift_rel": size,
            })));
        }
    }
    let axes = || vec![axis("x", json!(places)), axis("seed", json!((0..20).collect::<Vec<_>>()))];
    let all = figures(&of_rows(rows.clone(), axes()));
    let figure = all.iter().find(|figure| figure.name == "ensemble").unwrap();
    let mark = |drawn: Drawn| figure.marks.iter().find(|mark| mark.drawn == drawn).unwrap();
    let runs: Vec<usize> = figure.unbroken(mark(Drawn::Line), |dot| Some(dot.y)).iter().map(|run| run.len()).collect();
    assert_eq!(runs, [1, 2]);
    let band = mark(Drawn::Band);
    assert_eq!(band.dots[3].low, Some(0.0));
    let outlines = figure.outlines(band);
    assert_eq!(outlines.iter().map(Vec::len).collect::<Vec<_>>(), [2, 4]);
    // Last of the outline that goes back: the lower end at 4, then that at 3.
    assert_eq!(outlines[1][2], (4.0, figure.extent()[1].0));
    for note in ["1 lower end of areas at 0, drawn to the axis", "1 point with a median of 0 not shown"] {
        assert!(figure.notes.iter().any(|said| said == note), "{:?}", figure.notes);
    }
    assert_eq!(figure.title, "Size of energy_drift_rel over seeds");
    // An axis that is pooled besides makes them runs.
    for (i, row) in rows.iter_mut().enumerate() {
        row.insert("e".to_string(), json!(i % 2));
        row.insert("f".to_string(), json!(i / 2 % 2));
    }
    let mut more = axes();
    more.extend([axis("e", json!([0, 1])), axis("f", json!([0, 1]))]);
    let all = figures(&of_rows(rows, more));
    let figure = all.iter().find(|figure| figure.name == "ensemble").unwrap();
    assert_eq!(figure.title, "Size of energy_drift_rel over runs");
    let pooled = figure.notes.iter().find(|note| note.starts_with("pooled over ")).unwrap();
    assert!(pooled.contains("(2 values)") && figure.notes.iter().any(|note| note.contains("5 to 95 % of the runs")));
}

#[test]
fn shares_are_said_in_digits_that_tell() {
    let of = |k: usize, n: usize| {
        let rows = (0..n).map(|i| {
            let outcome = if i < k { "stalled" } else { "finished" };
            row(json!({ "case": i.to_string(), "a": i % 2, "seed": i / 2, "outcome": outcome }))
        });
        let seeds = (0..n / 2).collect::<Vec<_>>();
        figures(&of_rows(rows.collect(), vec![axis("a", json!([0, 1])), axis("seed", json!(seeds))]))
    };
    let all = of(34, 6400);
    let share = all.iter().find(|figure| figure.name == "share").unwrap();
    assert_eq!(share.finding, "Everywhere 0.53% of the runs stall.");
    let all = of(10, 10_000);
    let map = gotai::report::choose::map_in_characters(&of_rows(
        (0..10_000)
            .map(|i| row(json!({ "case": i.to_string(), "a": i % 2, "outcome": if i < 10 { "stalled" } else { "finished" } })))
            .collect(),
        vec![axis("a", json!([0, 1]))],
    ))
    .unwrap();
    assert!(map.finding.contains("(0.10 %, 95 % interval 0.05 to 0.18 %)"), "{}", map.finding);
    assert!(!all.is_empty());
}

/// A single line has no other that it could differ from: its highest place is named, and its axis.
#[test]
fn a_share_names_the_highest_place_and_the_axis() {
    let of =
        |a: i32, b: f64, outcome: &str| row(json!({ "case": format!("{a}{b}"), "a": a, "b": b, "outcome": outcome }));
    let rows = vec![of(1, 0.1, "stalled"), of(2, 0.2, "finished"), of(3, 0.1, "finished")];
    let all = figures(&of_rows(rows, vec![axis("a", json!([1, 2, 3])), axis("b", json!([0.1, 0.2]))]));
    let share = all.iter().find(|figure| figure.name == "share").unwrap();
    assert_eq!(share.finding, "At a = 1 100% of the runs stall (b = 0.1).");
}

#[test]
fn work_has_numbers_and_names() {
    let rows = |of: fn(usize) -> u64| {
        (0..4)
            .map(|i| row(json!({ "case": i.to_string(), "a": i, "outcome": "finished", "work_sweeps": of(i) })))
            .collect()
    };
    let axes = || vec![axis("a", json!([0, 1, 2, 3]))];
    let all = figures(&of_rows(rows(|i| [0, 7, 30, 0][i]), axes()));
    let work = all.iter().find(|figure| figure.name == "work").unwrap();
    assert_eq!(work.finding, "Medians along a, smallest to largest: work_sweeps 7 to 30.");
    assert_eq!(work.y.label, "work_sweeps in a run, median");
}

#[test]
fn a_sweep_without_rows_says_how_many_it_has_planned() {
    let subject = Subject { planned: 5, ..Subject::default() };
    let said = gotai::report::page::nothing_drawn(&subject);
    assert_eq!(said, "0 of 5 cases done: there is nothing to draw yet.");
    assert!(Page::of(&subject, &[]).html.contains(&said));
}
