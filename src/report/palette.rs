//! Colours and markers.

/// Red, green, blue.
pub type Shade = (u8, u8, u8);

/// Okabe & Ito's, which the colour-blind can tell apart, with a darker yellow; with 7 markers 56 combinations. The
/// fifth, theirs the black, is a grey that stands out on dark pages too.
pub const COLOURS: [Shade; 8] = [
    (0, 114, 178),
    (213, 94, 0),
    (0, 158, 115),
    (204, 121, 167),
    (110, 110, 110),
    (230, 159, 0),
    (86, 180, 233),
    (140, 120, 20),
];

/// Names of the markers in plotly, in the order of `MARKERS`.
pub const MARKER_NAMES: [&str; 7] = ["circle", "square", "triangle-up", "diamond", "triangle-down", "x", "cross"];

type Outlines = &'static [&'static [(f64, f64)]];

/// Outlines around the point, in units of the marker's size.
pub const MARKERS: [Outlines; 7] = [
    &[&[
        (1.0, 0.0),
        (0.92, 0.38),
        (0.71, 0.71),
        (0.38, 0.92),
        (0.0, 1.0),
        (-0.38, 0.92),
        (-0.71, 0.71),
        (-0.92, 0.38),
        (-1.0, 0.0),
        (-0.92, -0.38),
        (-0.71, -0.71),
        (-0.38, -0.92),
        (0.0, -1.0),
        (0.38, -0.92),
        (0.71, -0.71),
        (0.92, -0.38),
    ]],
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

/// Shades of a share, from none to all: lightness falls all the way, so that grey print tells them apart.
pub const SHARES: [Shade; 6] =
    [(250, 246, 238), (253, 224, 180), (253, 178, 110), (236, 110, 62), (190, 42, 40), (110, 8, 30)];

/// Shades of a number, from small to large, likewise.
pub const NUMBERS: [Shade; 6] =
    [(242, 247, 250), (197, 222, 236), (134, 188, 218), (72, 143, 192), (30, 92, 150), (10, 44, 92)];

/// Shade at a place from 0 to 1.
pub fn shade(of: &[Shade], at: f64) -> Shade {
    let at = at.clamp(0.0, 1.0) * (of.len() - 1) as f64;
    let i = (at.floor() as usize).min(of.len() - 2);
    let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * (at - i as f64)).round() as u8;
    let (a, b) = (of[i], of[i + 1]);
    (mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// Whether letters on this colour are to be light.
pub fn is_dark((r, g, b): Shade) -> bool {
    0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b) < 140.0
}

pub fn hex((r, g, b): Shade) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The nearest colour of a terminal's cube of 216, as its number.
pub fn ansi((r, g, b): Shade) -> u8 {
    let level = |x: u8| ((f64::from(x) / 255.0) * 5.0).round() as u8;
    16 + 36 * level(r) + 6 * level(g) + level(b)
}
