//! What figures find in rows: intervals, critical values, laws, pooling, what is missing or failed.

use super::{axis, of_rows, row, subject};
use gotai::math::interval::of_share;
use gotai::report::choose::{figures, map_in_characters};
use gotai::report::figure::Drawn;
use gotai::report::page::Page;
use gotai::report::stats::{PowerLaw, crossing, explained, quantile};
use gotai::report::subject::Subject;
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
    assert_eq!(cell.pick[0], ("time.step_s".to_string(), vec!["0.1".to_string()]));
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
