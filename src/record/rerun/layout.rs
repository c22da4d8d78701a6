//! The layout that the viewer opens with: the scene beside what happened and its plots, the log below.
//!
//! It is written twice: at the head for a recording that is cut, and, since a story is known at its end, with the end.
//! The viewer takes the last.

use super::arrangement::{self, Piece, Several, Shows, View};
use super::camera::{Camera, rounded, scale, spacing_m};
use super::names::{
    CONFIG, CONTACT_COUNT, CONTACT_FORCE, ENERGY, FLIGHT, FRICTION_USE, HEADLINE, LOG, LOG_ENERGY, PENETRATION,
    SIM_TIME, application, followed_path,
};
use super::seen::{Between, Seen};
use crate::record::sample::{Ending, Header, norm};
use crate::record::schema;
use ::rerun::ApplicationId;
use ::rerun::components::{Color, Plane3D, Range1D};
use ::rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, ScalarAxis, TextLogColumns, TimeAxis, TimePanelBlueprint,
};
use ::rerun::external::re_sdk_types::blueprint::components::{
    BackgroundKind, Corner2D, LinkAxis, LoopMode, PanelState, PlayState, PlaybackSpeed, TimeRange as ShownRange,
    TimelineName,
};
use ::rerun::external::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};
use ::rerun::external::re_sdk_types::datatypes::{
    AbsoluteTimeRange, Bool, Float64, TimeInt, TimeRange, TimeRangeBoundary,
};
use ::rerun::log::LogMsg;
use std::error::Error;

/// What a layout is made for that comes with the end: the end, what was seen, the camera.
pub type Known<'a> = (&'a Ending, &'a Seen, Option<Camera>);

/// Growth of the energy from which its logarithm is plotted.
const GROWTH: f64 = 10.0;
/// Least heights of plots, so that rounding is no drama: of an energy at the start, of a body's size.
const ENERGY_FLOOR: f64 = 1e-3;
const LENGTH_FLOOR: f64 = 1e-6;
/// Part of a plot's height that is left for its legend.
const LEGEND: f64 = 0.55;
/// Part of a plot's height that is left below zero.
const BELOW: f64 = 0.06;
/// Powers of ten above the limit of divergence that are plotted: what comes after it is no more news. (With more than
/// seven in all, the viewer has no room to label each.)
const ABOVE: f64 = 1.0;
/// Parts of a run's length that plots show before its beginning and after its end, so that neither is cut.
const MARGINS: [f64; 2] = [0.015, 0.05];
/// Seconds in which the decisive stretch is played.
const PLAYED_S: f64 = 5.0;

const BACKGROUND: [u8; 3] = [26, 29, 34];
const GRID: [u8; 4] = [120, 125, 140, 60];

/// A plot, the range of its values, and the corner of its legend, if it has more than one line.
pub struct Plot {
    pub name: String,
    pub path: &'static str,
    pub range: Option<[f64; 2]>,
    pub legend: Option<Corner2D>,
}

/// What a recording opens with.
pub struct Opening {
    pub application: ApplicationId,
    pub eye: Option<EyeControls3D>,
    pub grid: LineGrid3D,
    pub energy: Option<Plot>,
    pub contacts: Vec<Plot>,
    /// Whether there is a page with the configuration.
    pub has_config: bool,
    /// Whether there is a page with the contacts of the largest gain.
    pub has_flight: bool,
    /// Part of the run that is played.
    pub stretch_s: Option<[f64; 2]>,
    /// End of the run, if it is known.
    pub end_s: Option<f64>,
}

/// The layout of a recording, before its end or with it, as messages of a blueprint store, complete with its
/// activation.
///
/// # Errors
/// Rerun's own.
pub fn messages(header: &Header, known: Option<Known<'_>>) -> Result<Vec<LogMsg>, Box<dyn Error>> {
    let camera = known.and_then(|(.., camera)| camera);
    let opening = Opening {
        application: application(&header.name.begun())?,
        eye: eye(header, camera),
        grid: grid(header, camera),
        energy: energy_plot(header, known),
        contacts: contact_plots(header, known),
        has_config: true,
        has_flight: known.is_some_and(|(ending, ..)| ending.flight.is_some()),
        stretch_s: known.map(|(ending, ..)| ending.story.stretch_s),
        end_s: known.map(|(ending, ..)| ending.end_time_s),
    };
    opening.messages()
}

impl Opening {
    /// The layout as messages of a blueprint store, complete with its activation.
    ///
    /// # Errors
    /// Rerun's own.
    pub fn messages(self) -> Result<Vec<LogMsg>, Box<dyn Error>> {
        let Opening { application, eye, grid, energy, contacts, has_config, has_flight, stretch_s, end_s } = self;
        let mut scene = View::new(Shows::Scene, "scene", "/").of("+ /world/**");
        let [r, g, b] = BACKGROUND;
        let background = Background::new(BackgroundKind::SolidColor).with_color(Color::from_rgb(r, g, b));
        scene.add("Background", background);
        if let Some(eye) = eye {
            scene.add("EyeControls3D", eye);
        }
        scene.add("LineGrid3D", grid);
        let energy = energy.map(plot_view);
        let contacts: Vec<Piece> = contacts.into_iter().map(plot_view).collect();
        let root = arranged(scene.into(), energy, contacts, [has_config, has_flight]);
        let time = TimePanelBlueprint::new().with_timeline(TimelineName(SIM_TIME.into()));
        let time = time.with_state(PanelState::Collapsed);
        let time = match stretch_s {
            Some(stretch_s) => played(time, stretch_s),
            None => time,
        };
        arrangement::messages(application, &root, &time, end_s.and_then(all_of_it).as_ref())
    }
}

/// The axis of time of all plots: the whole run, with margins. None of a run without a length.
fn all_of_it(end_s: f64) -> Option<TimeAxis> {
    let whole_ns = end_s * 1e9;
    let at = |part: f64| TimeRangeBoundary::Absolute(TimeInt((part * whole_ns) as i64));
    let [before, after] = MARGINS;
    let shown = TimeRange { start: at(-before), end: at(1.0 + after) };
    (whole_ns > 0.0 && whole_ns.is_finite()).then(|| TimeAxis::new().with_view_range(ShownRange(shown)))
}

fn plot_view(plot: Plot) -> Piece {
    let mut view = View::new(Shows::Series, plot.name, plot.path);
    let legend = PlotLegend::new().with_visible(plot.legend.is_some());
    view.add("PlotLegend", plot.legend.into_iter().fold(legend, PlotLegend::with_corner));
    view.add("TimeAxis", TimeAxis::new().with_link(LinkAxis::LinkToGlobal));
    if let Some([low, high]) = plot.range {
        view.add("ScalarAxis", ScalarAxis::new().with_range(Range1D::new(low, high)));
    }
    view.into()
}

fn arranged(scene: Piece, energy: Option<Piece>, contacts: Vec<Piece>, [has_config, has_flight]: [bool; 2]) -> Several {
    // Where in the recording an event stands says nothing.
    let column = |kind| TextLogColumn { visible: Bool(kind != TextLogColumnKind::EntityPath), kind };
    let columns = [TextLogColumnKind::EntityPath, TextLogColumnKind::LogLevel, TextLogColumnKind::Body].map(column);
    let mut events = View::new(Shows::Log, "events", LOG);
    events.add("TextLogColumns", TextLogColumns::new().with_text_log_columns(columns));
    let mut notes: Vec<Piece> = vec![events.into()];
    if has_flight {
        notes.push(View::new(Shows::Document, "largest gain", FLIGHT).into());
    }
    if has_config {
        notes.push(View::new(Shows::Document, "configuration", CONFIG).into());
    }
    let left = Several::above(vec![scene, Several::tabs(notes).into()], vec![3.2, 1.0]);
    let mut right: Vec<Piece> = vec![View::new(Shows::Document, schema::PAGE, HEADLINE).into()];
    let mut shares = vec![2.4];
    if let Some(energy) = energy {
        right.push(energy);
        shares.push(1.8);
    }
    if !contacts.is_empty() {
        right.push(Several::tabs(contacts).into());
        shares.push(1.2);
    }
    let right = Several::above(right, shares);
    Several::beside(vec![left.into(), right.into()], vec![1.05, 1.0])
}

/// Plays the decisive stretch again and again, in a few seconds.
fn played(time: TimePanelBlueprint, [from_s, to_s]: [f64; 2]) -> TimePanelBlueprint {
    let length_s = to_s - from_s;
    if length_s.is_nan() || length_s <= 0.0 {
        return time;
    }
    let at = |time_s: f64| i64::try_from(schema::time_ns(time_s)).unwrap_or(i64::MAX).into();
    let speed = round_speed(length_s / PLAYED_S);
    time.with_time_selection(AbsoluteTimeRange { min: at(from_s), max: at(to_s) })
        .with_loop_mode(LoopMode::Selection)
        .with_playback_speed(PlaybackSpeed(Float64(speed)))
        .with_play_state(PlayState::Playing)
}

/// A speed that can be read off: 1, 2 or 5 of a power of ten; real time where it is near.
fn round_speed(exact: f64) -> f64 {
    if (0.4..2.5).contains(&exact) {
        return 1.0;
    }
    rounded(exact)
}

/// Energy on the scale that shows the story; no plot without data.
fn energy_plot(header: &Header, known: Option<Known<'_>>) -> Option<Plot> {
    if !header.streams.energy {
        return None;
    }
    // Where the plot is low: energies mostly fall, and what explodes does so at the end.
    let falls = known.is_none_or(|(_, seen, _)| seen.falls());
    let corner = if falls { Corner2D::RightTop } else { Corner2D::LeftTop };
    let (unit, unit_j) = header.energy_unit;
    let linear = Plot { name: format!("energy [{unit}]"), path: ENERGY, range: None, legend: Some(corner) };
    let Some((ending, seen, _)) = known else { return Some(linear) };
    if seen.energy_j.is_empty() {
        return None;
    }
    // A start that is rounding is no scale; the row knows.
    let has_scale = ending.row.contains_key("energy_growth_max");
    if let Some(range) = log_range(seen.log_energy, header.energy_factor).filter(|_| has_scale) {
        return Some(Plot { range: Some(range), ..log_energy_plot() });
    }
    let floor_j = ENERGY_FLOOR * ending.story.start_j.abs();
    let range = with_legend(widened(seen.energy_j, floor_j)).map(|end_j| end_j / unit_j);
    Some(Plot { range: Some(range), ..linear })
}

/// The plot of energies' logarithms.
pub fn log_energy_plot() -> Plot {
    Plot {
        name: "energy: log₁₀ E / E₀".to_string(), path: LOG_ENERGY, range: None, legend: Some(Corner2D::LeftTop)
    }
}

/// Range of the logarithms, with the limit of divergence in it; None where they say less than the energies themselves.
/// A run that ends when it diverges is low where its legend stands.
pub fn log_range(log: Between, factor: Option<f64>) -> Option<[f64; 2]> {
    let limit = factor.map_or(log.most, |factor| libm::log10(factor).max(log.most.min(libm::log10(factor) + ABOVE)));
    let range = [log.least.min(0.0) - 0.15, limit + 0.15];
    let ends_there = factor.is_some_and(|factor| log.most >= libm::log10(factor));
    (log.most > libm::log10(GROWTH)).then(|| if ends_there { range } else { with_legend(range) })
}

fn contact_plots(header: &Header, known: Option<Known<'_>>) -> Vec<Plot> {
    let streams = header.streams;
    let size_m = header.bodies.iter().map(|body| body.bounding_radius_m).fold(0.0, f64::max);
    let of = |pick: fn(&Seen) -> Between| known.map(|(_, seen, _)| pick(seen));
    let plots = [
        (streams.contacts, "contacts at once", CONTACT_COUNT, of(|seen| seen.contacts), 1.0),
        (streams.forces, "friction used, of μ fₙ", FRICTION_USE, of(|seen| seen.friction_use), 1.1),
        (streams.forces, "sum of |contact force| [N]", CONTACT_FORCE, of(|seen| seen.force_n), 0.0),
        (streams.energy, "penetration [m]", PENETRATION, of(|seen| seen.penetration_m), LENGTH_FLOOR * size_m),
    ];
    let is_there = |seen: &Option<Between>| seen.is_none_or(|seen| seen.most > 0.0);
    plots
        .into_iter()
        .filter(|(on, _, _, seen, _)| *on && is_there(seen))
        .map(|(_, name, path, seen, floor)| {
            // From nothing up; the friction that one wrong contact uses has no end.
            let most = |seen: Between| if path == FRICTION_USE { seen.most.min(2.0) } else { seen.most };
            // A little below nothing: the mark of zero is clear of the time below it.
            let range = seen.map(|seen| [-BELOW, 1.08].map(|part| part * marked(most(seen).max(floor))));
            Plot { name: name.to_string(), path, range, legend: None }
        })
        .collect()
}

/// The end of an axis from nothing to here, with a mark on it: a low plot has marks at powers of ten, and between them
/// where there is room.
pub fn marked(end: f64) -> f64 {
    const ROOM: f64 = 4.5;
    if !(end.is_finite() && end > 0.0) {
        return end;
    }
    let power = libm::exp10(libm::floor(libm::log10(end)));
    if end > ROOM * power { 10.0 * power } else { end }
}

/// A range of at least this height.
pub fn widened(seen: Between, floor: f64) -> [f64; 2] {
    let height = seen.most - seen.least;
    let more = if height < floor { 0.5 * (floor - height) } else { 0.05 * height };
    [seen.least - more, seen.most + more]
}

/// A range with room for a legend above what is plotted.
pub fn with_legend([low, high]: [f64; 2]) -> [f64; 2] {
    [low, high + LEGEND * (high - low)]
}

/// What the bodies sweep in view; before that is known, the container.
pub fn eye(header: &Header, camera: Option<Camera>) -> Option<EyeControls3D> {
    let scale = scale(header);
    let drawn = |p: [f64; 3]| p.map(|x| x * scale);
    if let Some(camera) = camera {
        let eye = EyeControls3D::new().with_position(drawn(camera.position)).with_look_target(drawn(camera.target));
        let eye = eye.with_eye_up([0.0, 1.0, 0.0]);
        return Some(match header.bodies.first().filter(|_| camera.follows) {
            Some(body) => eye.with_tracking_entity(followed_path(&body.name).to_string()),
            None => eye,
        });
    }
    /// Place of the camera, seen from the container's centre, in diagonals of the container.
    const EYE: [f64; 3] = [0.48, 0.36, 0.90];
    let (low, high) = header.container_box_m()?;
    let size_m = norm(std::array::from_fn(|i| high[i] - low[i]));
    let centre: [f64; 3] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
    let position: [f64; 3] = std::array::from_fn(|i| centre[i] + size_m * EYE[i]);
    let eye = EyeControls3D::new().with_position(drawn(position)).with_look_target(drawn(centre));
    Some(eye.with_eye_up([0.0, 1.0, 0.0]))
}

/// A grid on the ground, to the scale of the motion; without ground it lies below all that is seen.
pub fn grid(header: &Header, camera: Option<Camera>) -> LineGrid3D {
    let scale = scale(header);
    let below = camera.map(|camera| ([0.0, 1.0, 0.0], camera.low[1]));
    let Some((normal, offset_m)) = header.planes.first().copied().or(below) else {
        return LineGrid3D::new().with_visible(false);
    };
    let [r, g, b, a] = GRID;
    let size_m = camera.map_or(header.scene_size_m(), |camera| camera.size_m);
    let normal = normal.map(|x| x as f32);
    LineGrid3D::new()
        .with_visible(true)
        .with_plane(Plane3D::new(normal, (offset_m * scale) as f32))
        .with_spacing((spacing_m(size_m) * scale) as f32)
        .with_color(Color::from_unmultiplied_rgba(r, g, b, a))
}
