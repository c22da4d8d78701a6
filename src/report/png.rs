//! A figure as PNG: the strokes of its SVG, drawn four times as large and halved, so that edges are smooth. A text
//! chunk has its numbers.

use super::figure::Figure;
use super::said::numbers;
use super::sheet::{HEIGHT, Ink, Sheet, Stroke, TextAnchor, WIDTH};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, FontTransform, register_font};
use std::error::Error;

/// Reason why nothing could be drawn.
type Failure = Box<dyn Error>;

/// Pixels of the file for one of the SVG.
pub const ZOOM: u32 = 2;
/// Pixels that are drawn for one of the file.
const FINER: u32 = 2;
const FONT: &str = "sans-serif";

impl Figure {
    /// The figure as PNG, on white.
    ///
    /// # Errors
    /// None that data can cause; the library's own.
    pub fn png(&self) -> Result<Vec<u8>, Failure> {
        let (width, height) = (WIDTH as u32 * ZOOM, HEIGHT as u32 * ZOOM);
        let (fine_width, fine_height) = (width * FINER, height * FINER);
        let mut pixels = vec![255; (3 * fine_width * fine_height) as usize];
        {
            let area = BitMapBackend::with_buffer(&mut pixels, (fine_width, fine_height)).into_drawing_area();
            for (style, font) in [(FontStyle::Normal, dejavu::sans::regular()), (FontStyle::Bold, dejavu::sans::bold())]
            {
                register_font(FONT, style, font).map_err(|_| "the font cannot be read")?;
            }
            for stroke in &Sheet::of(self).strokes {
                draw(&area, stroke)?;
            }
            area.present()?;
        }
        let pixels = halved(&pixels, width as usize, height as usize);
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.add_itxt_chunk("Title".to_string(), self.finding.clone())?;
        encoder.add_itxt_chunk("Description".to_string(), numbers(self))?;
        encoder.write_header()?.write_image_data(&pixels)?;
        Ok(file)
    }
}

type Area<'a> = DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>;

fn draw(area: &Area, stroke: &Stroke) -> Result<(), Failure> {
    let scale = f64::from(ZOOM * FINER);
    let pixel = |(x, y): &(f64, f64)| ((x * scale).round() as i32, (y * scale).round() as i32);
    match stroke {
        Stroke::Area { points, ink, opacity, .. } => {
            let points: Vec<_> = points.iter().map(pixel).collect();
            if points.len() > 2 {
                area.draw(&Polygon::new(points, colour(*ink).mix(*opacity).filled()))?;
            }
        }
        Stroke::Path { points, ink, width, opacity } => {
            let mut points: Vec<_> = points.iter().map(pixel).collect();
            points.dedup();
            if points.len() > 1 {
                let style = colour(*ink).mix(*opacity).stroke_width((width * scale).round().max(1.0) as u32);
                area.draw(&PathElement::new(points, style))?;
            }
        }
        Stroke::Letters { x, y, size, anchor, ink, bold, up, text } => {
            let across = match anchor {
                TextAnchor::Start => HPos::Left,
                TextAnchor::Middle => HPos::Center,
                TextAnchor::End => HPos::Right,
            };
            let style = if *bold { FontStyle::Bold } else { FontStyle::Normal };
            let turned = if *up { FontTransform::Rotate270 } else { FontTransform::None };
            // The library's sizes are of the whole line, an SVG's of the letters: 1.164, this font's own ratio.
            let font = FontDesc::new(FontFamily::Name(FONT), 1.164 * size * scale, style).transform(turned);
            let ink = colour(*ink);
            let style = TextStyle::from(font).color(&ink).pos(Pos::new(across, VPos::Center));
            area.draw(&Text::new(text.clone(), pixel(&(*x, *y)), style))?;
        }
    }
    Ok(())
}

fn colour(ink: Ink) -> RGBColor {
    match ink {
        Ink::Letters => RGBColor(28, 28, 30),
        Ink::Muted => RGBColor(93, 93, 99),
        Ink::Grid => RGBColor(228, 228, 232),
        Ink::Paper => WHITE,
        Ink::Fixed((r, g, b)) => RGBColor(r, g, b),
    }
}

/// Means of the squares of pixels that one of the file has.
fn halved(fine: &[u8], width: usize, height: usize) -> Vec<u8> {
    let finer = FINER as usize;
    let stride = 3 * width * finer;
    let mut pixels = Vec::with_capacity(3 * width * height);
    for y in 0..height {
        for x in 0..width {
            for channel in 0..3 {
                let of = |i: usize| {
                    u32::from(fine[(y * finer + i / finer) * stride + 3 * (x * finer + i % finer) + channel])
                };
                let sum: u32 = (0..finer * finer).map(of).sum();
                pixels.push(((sum + FINER * FINER / 2) / (FINER * FINER)) as u8);
            }
        }
    }
    pixels
}
