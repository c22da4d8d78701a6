//! Log–log diagrams as SVG and PNG, both by the same code. Sizes are pixels.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::error::Error;
use std::ops::Range;

/// Points must be positive to be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub label: String,
    pub points: Vec<(f64, f64)>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub series: Vec<Series>,
    /// A broad line behind the others.
    pub band: Option<Series>,
}

/// Reason why nothing could be drawn.
type Failure = Box<dyn Error>;

const SIZE: (u32, u32) = (1440, 860);
const LEGEND_WIDTH: i32 = 460;
const FONT: &str = "sans-serif";
/// Letters in a line of the title.
const TITLE_LINE: usize = 84;
const BAND: RGBColor = RGBColor(205, 205, 205);

/// Okabe & Ito's, which the colour-blind can tell apart, with a darker yellow; with 7 markers 56 combinations.
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(0, 0, 0),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(140, 120, 20),
];

type Polygons = &'static [&'static [(f64, f64)]];

/// Outlines around the point, in units of the marker's size.
const MARKERS: [Polygons; 7] = [
    &[&[(1.0, 0.0), (0.71, 0.71), (0.0, 1.0), (-0.71, 0.71), (-1.0, 0.0), (-0.71, -0.71), (0.0, -1.0), (0.71, -0.71)]],
    &[&[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)]],
    &[&[(0.0, -1.15), (1.05, 0.75), (-1.05, 0.75)]],
    &[&[(0.0, -1.3), (1.0, 0.0), (0.0, 1.3), (-1.0, 0.0)]],
    &[&[(0.0, 1.15), (1.05, -0.75), (-1.05, -0.75)]],
    &[
        &[(-1.1, -0.75), (-0.75, -1.1), (1.1, 0.75), (0.75, 1.1)],
        &[(-1.1, 0.75), (-0.75, 1.1), (1.1, -0.75), (0.75, -1.1)],
    ],
    &[
        &[(-1.25, -0.28), (1.25, -0.28), (1.25, 0.28), (-1.25, 0.28)],
        &[(-0.28, -1.25), (0.28, -1.25), (0.28, 1.25), (-0.28, 1.25)],
    ],
];

impl Diagram {
    /// The diagram as SVG.
    ///
    /// # Errors
    /// None that data can cause; the library's own.
    pub fn svg(&self) -> Result<String, Failure> {
        let mut text = String::new();
        self.draw(&SVGBackend::with_string(&mut text, SIZE).into_drawing_area())?;
        Ok(text)
    }

    /// The diagram as PNG.
    ///
    /// # Errors
    /// As `svg`.
    pub fn png(&self) -> Result<Vec<u8>, Failure> {
        let (width, height) = SIZE;
        let mut pixels = vec![0; (3 * width * height) as usize];
        self.draw(&BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area())?;
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header()?.write_image_data(&pixels)?;
        Ok(file)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Result<(), Failure>
    where
        B::ErrorType: 'static,
    {
        register_font(FONT, FontStyle::Normal, dejavu::sans::regular()).map_err(|_| "the font cannot be read")?;
        area.fill(&WHITE)?;
        let rest = self.draw_title(area)?;
        let (plot, legend) = rest.split_horizontally(SIZE.0 as i32 - LEGEND_WIDTH);
        self.draw_plot(&plot)?;
        self.draw_legend(&legend)?;
        area.present()?;
        Ok(())
    }

    fn draw_title<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Result<DrawingArea<B, Shift>, Failure>
    where
        B::ErrorType: 'static,
    {
        const LINE: i32 = 36;
        let lines = wrapped(&self.title, TITLE_LINE);
        for (i, line) in lines.iter().enumerate() {
            area.draw(&Text::new(line.clone(), (24, 18 + i as i32 * LINE), (FONT, 28)))?;
        }
        Ok(area.split_vertically(28 + lines.len() as i32 * LINE).1)
    }

    fn draw_plot<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Result<(), Failure>
    where
        B::ErrorType: 'static,
    {
        let all = || self.series.iter().flat_map(|series| shown(&series.points));
        let (x, y) = (decades(all().map(|p| p.0)), decades(all().map(|p| p.1)));
        let mut chart =
            ChartBuilder::on(area).margin(16).x_label_area_size(70).y_label_area_size(100).build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc(self.x_label.as_str())
            .y_desc(self.y_label.as_str())
            .axis_desc_style((FONT, 24))
            .label_style((FONT, 22))
            .x_label_formatter(&power_of_ten)
            .y_label_formatter(&power_of_ten)
            .bold_line_style(BLACK.mix(0.18))
            .light_line_style(BLACK.mix(0.06))
            .draw()?;
        if let Some(band) = &self.band {
            chart.draw_series(LineSeries::new(shown(&band.points), BAND.stroke_width(14)))?;
        }
        for (i, series) in self.series.iter().enumerate() {
            let colour = COLOURS[i % COLOURS.len()];
            chart.draw_series(LineSeries::new(shown(&series.points), colour.stroke_width(2)))?;
            let at = |point| chart.backend_coord(&point);
            let marked: Vec<_> = shown(&series.points).map(at).collect();
            for at in marked {
                let (x, y) = area.get_pixel_range();
                draw_marker(area, i, (at.0 - x.start, at.1 - y.start))?;
            }
        }
        Ok(())
    }

    fn draw_legend<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Result<(), Failure>
    where
        B::ErrorType: 'static,
    {
        const LINE: i32 = 40;
        let mut y = 36;
        let labels = self.series.iter().chain(&self.band).map(|series| &series.label);
        for (i, label) in labels.enumerate() {
            if i < self.series.len() {
                let style = COLOURS[i % COLOURS.len()].stroke_width(2);
                area.draw(&PathElement::new(vec![(8, y), (52, y)], style))?;
                draw_marker(area, i, (30, y))?;
            } else {
                area.draw(&Rectangle::new([(8, y - 7), (52, y + 7)], BAND.filled()))?;
            }
            for (n, line) in wrapped(label, 36).into_iter().enumerate() {
                y += if n > 0 { 26 } else { 0 };
                area.draw(&Text::new(line, (66, y - 9), (FONT, 21)))?;
            }
            y += LINE;
        }
        Ok(())
    }
}

/// Draws the marker of series `i`.
fn draw_marker<B: DrawingBackend>(area: &DrawingArea<B, Shift>, i: usize, at: (i32, i32)) -> Result<(), Failure>
where
    B::ErrorType: 'static,
{
    const RADIUS: f64 = 8.0;
    let corner = |(x, y): &(f64, f64)| (at.0 + (RADIUS * x).round() as i32, at.1 + (RADIUS * y).round() as i32);
    for outline in MARKERS[i % MARKERS.len()] {
        let corners: Vec<(i32, i32)> = outline.iter().map(corner).collect();
        area.draw(&Polygon::new(corners, COLOURS[i % COLOURS.len()].filled()))?;
    }
    Ok(())
}

/// Decimal logarithms of what can be shown.
fn shown(points: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> {
    let is_shown = |x: f64| x > 0.0 && x.is_finite();
    let positive = points.iter().filter(move |(x, y)| is_shown(*x) && is_shown(*y));
    positive.map(|(x, y)| (libm::log10(*x), libm::log10(*y)))
}

/// Whole powers of ten around the logarithms; a decade of nothing.
fn decades(logs: impl Iterator<Item = f64>) -> Decades {
    let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        return Decades(0..1);
    }
    // Room for the markers.
    let (low, high) = ((low - 0.05).floor() as i32, (high + 0.05).ceil() as i32);
    Decades(low..high.max(low + 1))
}

/// An axis of decimal logarithms. (The library's own logarithmic one has no room below 1e-16.)
struct Decades(Range<i32>);

impl Ranged for Decades {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, log: &f64, (from, to): (i32, i32)) -> i32 {
        let Range { start, end } = self.range();
        from + (f64::from(to - from) * (log - start) / (end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        /// More labels than this run into each other.
        const MOST: usize = 9;
        let every = self.0.len().div_ceil(MOST);
        if !hint.weight().allow_light_points() {
            return self
                .0
                .clone()
                .chain([self.0.end])
                .filter(|decade| decade % every as i32 == 0)
                .map(f64::from)
                .collect();
        }
        let within = |decade: i32| match every {
            // 2, 3, … 9 of every decade, or where they have no room the decades.
            1 => (2..10).map(|n| f64::from(decade) + libm::log10(f64::from(n))).collect(),
            _ => vec![f64::from(decade)],
        };
        self.0.clone().flat_map(within).collect()
    }

    fn range(&self) -> Range<f64> {
        f64::from(self.0.start)..f64::from(self.0.end)
    }
}

fn power_of_ten(log: &f64) -> String {
    let superscript = |digit: char| match digit {
        '-' => '⁻',
        _ => digit.to_digit(10).map_or(digit, |n| ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][n as usize]),
    };
    format!("10{}", format!("{log:.0}").chars().map(superscript).collect::<String>())
}

/// Lines of at most so many letters, broken at spaces where there are any.
fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last().map_or(0, |line| line.chars().count());
        if line > 0 && line + 1 + word.chars().count() > most {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}
