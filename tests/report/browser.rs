//! A report in a browser: it loads without a network and without a complaint, its plots are there, choosing works, it
//! fits a phone, and can be read in light and dark.

use super::figures::{HOSTILE, with_long_names};
use super::webdriver::Browser;
use super::{row, subject};
use crate::{scratch, tools};
use gotai::check::{Failing, Judged};
use gotai::report::choose::figures;
use gotai::report::page::Page;
use serde_json::json;
use std::path::PathBuf;

fn page(folder: &scratch::Folder) -> PathBuf {
    let mut subject = subject();
    subject.question = Some(HOSTILE.to_string());
    subject.replay = Some("gotai run out --case".to_string());
    subject.configuration = Some(format!("question: {HOSTILE}\n{}", "a_long_key_without_any_space: 1".repeat(20)));
    subject.conditions = vec![("program".to_string(), "a_name_that_nobody_can_break".repeat(8))];
    subject.warnings = vec![HOSTILE.to_string()];
    subject.verdicts = vec![Judged {
        expectation: HOSTILE.to_string(),
        bound: "≤ 1".into(),
        measured: "2".into(),
        met: false,
        why: None,
        rows: 120,
        failing: vec![Failing {
            case: format!("{:016x}", 5),
            axes: row(json!({ "scene.n": HOSTILE, "seed": 5 })),
            column: "energy_drift_rel".into(),
            value: json!(2.0),
        }],
    }];
    let path = folder.path().join("report.html");
    std::fs::write(&path, Page::of(&subject, &figures(&subject)).html).unwrap();
    path
}

#[test]
fn a_report_works_in_a_browser() {
    let Some(programs) = tools::browser() else { return };
    let folder = scratch::folder();
    let page = page(&folder);
    let browser = Browser::new(&programs);
    browser.open(&page);
    assert_eq!(browser.messages(), Vec::<serde_json::Value>::new());
    let fetched =
        "return performance.getEntriesByType('resource').map(e => e.name).filter(n => !/^(data|blob):/.test(n))";
    assert_eq!(browser.run(fetched), json!([]));
    assert_eq!(browser.run("return window.hacked ?? null"), json!(null));
    // Every figure is drawn, with its marks.
    assert_eq!(browser.run("return document.querySelectorAll('.js-plotly-plot').length"), json!(7));
    let drawn = browser.run("return [...document.querySelectorAll('.live')].map(d => d.querySelectorAll('.point, .hm image, .annotation').length)");
    assert!(drawn.as_array().unwrap().iter().all(|n| n.as_u64().unwrap() > 1), "{drawn}");
    assert_eq!(browser.run("return document.querySelectorAll('#body tr').length"), json!(100));

    // A cell of the map: its rows, and its most telling case.
    let at = browser.run(
        "const plot = document.querySelector('[data-figure=map]'); plot.scrollIntoView({ block: 'center' });
         const box = plot.querySelector('.nsewdrag').getBoundingClientRect();
         return [box.x + box.width * 5 / 6, box.y + box.height * 7 / 8]",
    );
    browser.click(at[0].as_f64().unwrap(), at[1].as_f64().unwrap());
    std::thread::sleep(std::time::Duration::from_millis(400));
    let count = browser.run("return document.getElementById('count').textContent");
    assert_eq!(count, json!("10 of 120 rows"));
    let chosen = browser.run("return document.getElementById('chosen').innerText");
    let chosen = chosen.as_str().unwrap();
    for part in ["gotai run out --case 0000", "It has no recording", "cube 125", "diverged"] {
        assert!(chosen.contains(part), "{part}: {chosen}");
    }

    // The step is 1e-3 on the map, and 0.001 in the table.
    let at = browser.run(
        "document.querySelectorAll('#picks button').forEach(b => b.click());
         const plot = document.querySelector('[data-figure=map]'); plot.scrollIntoView({ block: 'center' });
         const box = plot.querySelector('.nsewdrag').getBoundingClientRect();
         return [box.x + box.width * 1 / 6, box.y + box.height * 7 / 8]",
    );
    browser.click(at[0].as_f64().unwrap(), at[1].as_f64().unwrap());
    std::thread::sleep(std::time::Duration::from_millis(400));
    let count = browser.run("return document.getElementById('count').textContent");
    assert_eq!(count, json!("10 of 120 rows"));

    // A case that a verdict names.
    browser.run("document.querySelector('button.case').click()");
    let chosen = browser.run("return document.getElementById('chosen').innerText");
    assert!(chosen.as_str().unwrap().contains("gotai run out --case 00000000000"), "{chosen}");
    browser.run("document.getElementById('filter').value = ''");

    // A filter, then a column's head by the keyboard.
    browser.run(
        "document.querySelectorAll('#picks button').forEach(b => b.click()); document.getElementById('filter').focus()",
    );
    browser.keys("outcome=diverged time.step_s>0.05");
    assert_eq!(browser.run("return document.getElementById('count').textContent"), json!("22 of 120 rows"));
    browser.run("[...document.querySelectorAll('#head button')].find(b => b.textContent.startsWith('energy_drift_rel')).focus()");
    browser.keys("\u{e007}\u{e007}");
    let sort = browser.run("return [...document.querySelectorAll('#head th')].map(th => th.ariaSort ?? th.getAttribute('aria-sort')).filter(s => s !== 'none')");
    assert_eq!(sort, json!(["descending"]));
    let first = "return [...document.querySelectorAll('#body tr')].slice(0, 2).map(tr => Number([...tr.children].at(-4).textContent))";
    let _ = browser.run(first);
    browser.run("document.querySelector('#body tr').focus()");
    browser.keys("\u{e015}\u{e007}");
    let second = browser.run("return document.querySelectorAll('#body tr')[1].getAttribute('aria-selected')");
    assert_eq!(second, json!("true"));
    assert_eq!(browser.messages(), Vec::<serde_json::Value>::new());
}

#[test]
fn a_report_fits_a_phone_and_can_be_read_in_light_and_dark() {
    let Some(programs) = tools::browser() else { return };
    let folder = scratch::folder();
    let page = page(&folder);
    let browser = Browser::new(&programs);
    for (width, scheme) in [(360, "light"), (390, "dark"), (1100, "light"), (1100, "dark")] {
        let size = json!({ "width": width, "height": 800, "deviceScaleFactor": 2, "mobile": width < 500 });
        browser.command("Emulation.setDeviceMetricsOverride", size);
        let media = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        browser.command("Emulation.setEmulatedMedia", media);
        browser.open(&page);
        let wide = browser.run("return [document.documentElement.scrollWidth, window.innerWidth]");
        assert!(wide[0].as_f64() <= wide[1].as_f64(), "{width}: {wide}");
        // No legend lies on the title of its axis, or on the points.
        let least = browser.run(
            "return Math.min(...[...document.querySelectorAll('.js-plotly-plot')].filter((p) => p.querySelector('.legend'))
               .map((p) => p.querySelector('.legend').getBoundingClientRect().top - p.querySelector('.xtitle').getBoundingClientRect().bottom))",
        );
        // measured: 33 on a phone, 3.8 on a desk
        assert!(least.as_f64().unwrap() >= 0.0, "{width}: {least}");
        // WCAG's contrast of letters with what is behind them: 4.5 at least.
        let contrast = browser.run(
            "const rgb = (text) => text.match(/[\\d.]+/g).map(Number);
             const light = (c) => { const l = c.slice(0, 3).map((x) => { x /= 255; return x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4; });
               return 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]; };
             const behind = (e) => { for (; e; e = e.parentElement) { const c = rgb(getComputedStyle(e).backgroundColor); if (c.length < 4 || c[3] > 0) return c; } return [255, 255, 255]; };
             return [...document.querySelectorAll('h1, h2, h3, p, li, .met, .unmet, dt, dd, td, th button, summary, button, input, pre')]
               .filter((e) => e.offsetParent && e.textContent.trim() !== '')
               .map((e) => { const [a, b] = [light(rgb(getComputedStyle(e).color)), light(behind(e))].sort((x, y) => y - x);
                 return [(a + 0.05) / (b + 0.05), e.tagName + ' ' + e.className]; })
               .sort((a, b) => a[0] - b[0])[0]",
        );
        // measured: 6.7 in light, 8.3 in dark
        assert!(contrast[0].as_f64().unwrap() >= 4.5, "{scheme}: {contrast}");
        // The plots have the colours of the page.
        let paper = browser.run("return [getComputedStyle(document.querySelector('.main-svg')).backgroundColor, getComputedStyle(document.documentElement).backgroundColor]");
        assert_eq!(paper[0], paper[1]);
    }
    // On paper the drawings stand in their place, black on white.
    browser.command("Emulation.setEmulatedMedia", json!({ "media": "print", "features": [] }));
    let shown = browser
        .run("return ['.static', '.live', '.tools'].map(s => getComputedStyle(document.querySelector(s)).display)");
    assert_eq!(shown, json!(["block", "none", "none"]));
}

/// Forty columns, and methods that are written in full: names do not run into each other, and the cells have most of
/// the room, on a desk and on a phone that is turned.
#[test]
fn a_map_of_many_columns_can_be_read() {
    let Some(programs) = tools::browser() else { return };
    let folder = scratch::folder();
    let subject = with_long_names();
    let path = folder.path().join("report.html");
    std::fs::write(&path, Page::of(&subject, &figures(&subject)).html).unwrap();
    let browser = Browser::new(&programs);
    let narrow = |width: u32| json!({ "width": width, "height": 800, "deviceScaleFactor": 2, "mobile": width < 500 });
    for width in [1100, 360] {
        browser.command("Emulation.setDeviceMetricsOverride", narrow(width));
        browser.open(&path);
        let found = browser.run(MAP);
        let (share, apart, ticks) = (&found[0], &found[1], found[2].as_u64().unwrap());
        // measured: 0.86 of 1100, 0.65 of 360
        assert!(share.as_f64().unwrap() > 0.55, "{width}: {found}");
        assert!(apart.as_f64().unwrap() >= 0.0 && ticks > 4, "{width}: {found}");
    }
    // A wide screen again: it is drawn anew.
    browser.command("Emulation.setDeviceMetricsOverride", narrow(800));
    std::thread::sleep(std::time::Duration::from_millis(900));
    let found = browser.run(MAP);
    assert!(found[0].as_f64().unwrap() > 0.55 && found[1].as_f64().unwrap() >= 0.0, "{found}");
    // No formula is looked for in a name with two dollars.
    assert_eq!(browser.messages(), Vec::<serde_json::Value>::new());
}

/// Width of the map's cells in that of the plot, the least distance of two names along x, and their number.
const MAP: &str = "
    const plot = document.querySelector('[data-figure=map]');
    const cells = plot.querySelector('.nsewdrag').getBoundingClientRect();
    const boxes = [...plot.querySelectorAll('.xtick text')].map((e) => e.getBoundingClientRect()).sort((a, b) => a.x - b.x);
    const apart = boxes.slice(1).map((b, i) => b.left - boxes[i].right);
    return [cells.width / plot.getBoundingClientRect().width, Math.min(...apart), boxes.length];";
