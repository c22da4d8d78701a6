//! Diagrams: what is written in them, and that both files can be read.

use gotai::report::diagram::{Diagram, Series};

fn diagram() -> Diagram {
    let series = |label: &str, points: &[(f64, f64)]| Series { label: label.to_string(), points: points.to_vec() };
    Diagram {
        title: "Which method is worth its time?".to_string(),
        x_label: "orientation error [rad]".to_string(),
        y_label: "run time, best [s]".to_string(),
        series: vec![series("free rk4, order 4.00", &[(1e-3, 1e-4), (1e-7, 1e-3)]), series("exact", &[(0.0, 1e-6)])],
        band: Some(series("Pareto front", &[(1e-7, 1e-3), (1e-3, 1e-4)])),
    }
}

#[test]
fn the_svg_says_what_is_drawn() {
    let svg = diagram().svg().unwrap();
    for part in [
        "<svg",
        "Which method is worth its time?",
        "orientation error [rad]",
        "run time, best [s]",
        "free rk4, order 4.00",
        "Pareto front",
        "10⁻³",
        "</svg>",
    ] {
        assert!(svg.contains(part), "{part}");
    }
}

#[test]
fn the_png_has_letters_without_any_font_of_the_system() {
    let with = pixels(&diagram());
    let without = pixels(&Diagram { title: String::new(), ..diagram() });
    assert_eq!(with.len(), 3 * 1440 * 860);
    // The title is dark on white. measured: 2.2e3 of its 50000 pixels
    let dark = |pixels: &[u8]| pixels[..3 * 1440 * 50].chunks(3).filter(|rgb| rgb[0] < 128).count();
    assert!(dark(&with) > 1000 && dark(&without) == 0, "{} {}", dark(&with), dark(&without));
}

fn pixels(diagram: &Diagram) -> Vec<u8> {
    let file = diagram.png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    pixels
}

#[test]
fn nothing_to_show_is_still_a_diagram() {
    let empty = Diagram { series: Vec::new(), band: None, ..diagram() };
    assert!(empty.svg().unwrap().contains("10⁰") && !empty.png().unwrap().is_empty());
}
