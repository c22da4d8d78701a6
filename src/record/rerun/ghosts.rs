//! Several cases in one .rrd, on one timeline: the first as it is, the others as ghosts; one plot of all energies.

use super::camera::{Camera, camera_on, scale};
use super::crowd::EDGED_BODIES;
use super::head::{Looks, axes, color, details, ground, in_view, line, walls};
use super::headline::moment;
use super::layout::{self, Opening, Plot};
use super::names::{CONTACT_COUNT, ENERGY, HEADLINE, LOG, LOG_ENERGY, TRAILS, WORLD, application};
use super::out::{Appended, Out, Sink, times};
use super::seen::{Between, Room, Seen, log_part};
use super::statics::Statics;
use crate::record::RecordError;
use crate::record::ahead_file::AheadFile;
use crate::record::pictures::Pictures;
use crate::record::read::ReadBack;
use crate::record::sample::{Event, Header};
use crate::record::schema::{MOST_TOGETHER, Rgb};
use crate::record::story::{Decisive, brief, markdown};
use ::rerun::components::Radius;
use ::rerun::external::re_build_info::CrateVersion;
use ::rerun::external::re_log_encoding::{Encoder, EncodingOptions};
use ::rerun::external::re_sdk_types::blueprint::components::Corner2D;
use ::rerun::{Color, EntityPath, LineStrips3D, Points3D, StoreId, TextDocument, Transform3D, ViewCoordinates};
use std::fmt::Write;
use std::path::Path;

/// Opacity of a ghost, of 255.
const GHOST_ALPHA: u8 = 110;
/// Most cases whose instants are told: of more, the table is all that there is.
const MOST_TOLD: usize = 4;
const POINT_RADIUS: f32 = 3.5;
const LINE_RADIUS: f32 = 1.0;

/// Colours of the cases, apart from each other and from the ground.
const COLOURS: [Rgb; MOST_TOGETHER] = [
    [242, 142, 43],
    [89, 190, 110],
    [110, 160, 230],
    [237, 201, 72],
    [225, 87, 89],
    [176, 122, 161],
    [118, 200, 195],
    [255, 157, 167],
    [156, 117, 95],
    [200, 200, 210],
    [140, 120, 240],
    [170, 210, 70],
];
/// Words for the same.
const COLOUR_WORDS: [&str; MOST_TOGETHER] =
    ["orange", "green", "blue", "yellow", "red", "purple", "teal", "pink", "brown", "white", "violet", "lime"];

/// A case among others, read back from its own recording.
pub struct GhostCase {
    /// What tells it from the others, e.g. `lecture`.
    pub label: String,
    pub header: Header,
    pub recording: ReadBack,
}

/// What a case is drawn with.
struct Drawn<'a> {
    case: &'a GhostCase,
    colour: Rgb,
    alpha: u8,
    seen: Seen,
    start_j: Option<f64>,
    /// Unit in which energies are plotted, that of the first case.
    unit_j: f64,
}

/// Writes cases, at most as many as there are colours, into one .rrd.
///
/// # Errors
/// The file cannot be made or written.
pub fn write_ghosts(path: &Path, differing: &str, cases: &[GhostCase]) -> Result<(), RecordError> {
    write(path, differing, cases).map_err(|error| RecordError::caused(path, error.as_ref()))
}

fn write(path: &Path, differing: &str, cases: &[GhostCase]) -> Appended {
    let Some(first) = cases.first() else { return Ok(()) };
    let unit_j = first.header.energy_unit.1;
    let drawn = cases.iter().zip(COLOURS).enumerate().map(|(i, of)| Drawn::new(i, of, unit_j));
    let drawn: Vec<Drawn<'_>> = drawn.collect();
    let labels: Vec<&str> = cases.iter().map(|case| case.label.as_str()).collect();
    let application = application(&format!("{differing} {}", labels.join(" ")))?;
    let ids: Vec<&str> = cases.iter().map(|case| case.header.case.as_str()).collect();
    let store = StoreId::recording(application.clone(), format!("{} {}", ids.join(" "), first.header.build));
    let mut stream = Statics::new(store.clone());
    stream.begin(&format!("{differing}: {}", labels.join(", ")))?;
    let room = drawn.iter().filter_map(Drawn::room).reduce(Room::with);
    let camera = room.and_then(|room| camera_on(&first.header, room)).map(|camera| Camera {
        // One of several bodies cannot be gone along with.
        follows: false,
        ..camera
    });
    let contacts = layout::marked(drawn.iter().map(|case| case.seen.contacts.most).fold(1.0, f64::max));
    let opening = Opening {
        application,
        eye: layout::eye(&first.header, camera),
        grid: layout::grid(&first.header, camera),
        energy: energy_plot(&drawn, &first.header),
        contacts: vec![Plot {
            name: "contacts at once".to_string(),
            path: CONTACT_COUNT,
            range: Some([-0.06 * contacts, 1.08 * contacts]),
            legend: None,
        }],
        has_config: false,
        has_flight: false,
        stretch_s: stretch_s(cases),
        end_s: cases.iter().filter_map(|case| case.recording.until_s()).reduce(f64::max),
    };

    stream.log("/", &ViewCoordinates::RIGHT_HAND_Y_UP())?;
    stream.log(WORLD, &ViewCoordinates::RIGHT_HAND_Y_UP())?;
    let scale = scale(&first.header);
    if scale != 1.0 {
        stream.log(WORLD, &Transform3D::from_scale(scale as f32))?;
    }
    stream.log(HEADLINE, &TextDocument::from_markdown(page(differing, cases)))?;
    match camera {
        Some(camera) => {
            ground(&first.header, camera.middle, 1.6 * camera.half_m, &mut stream)?;
            axes(&first.header, camera, &mut stream)?;
        }
        None => ground(&first.header, first.header.ground.0, first.header.ground.1, &mut stream)?,
    }
    walls(&first.header, &mut stream)?;
    for case in &drawn {
        case.styles(camera, &mut stream)?;
    }

    let file = AheadFile::create(path)?;
    let encoder = Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file.clone())?;
    let mut out = Out { store, sink: Sink::File(encoder, file) };
    for message in opening.messages()?.iter().chain(&stream.messages()) {
        out.sink.append(message)?;
    }
    for case in &drawn {
        case.samples(&mut out)?;
    }
    out.sink.finish()
}

impl<'a> Drawn<'a> {
    fn new(i: usize, (case, colour): (&'a GhostCase, Rgb), unit_j: f64) -> Self {
        let mut seen = Seen::new(&case.header);
        let start_j =
            case.recording.samples.energy.first().map(|energy| energy.total_j).filter(|start_j| *start_j > 0.0);
        for sample in case.recording.samples.samples() {
            seen.look(&sample, sample.energy.and_then(|energy| log_part(energy.total_j, start_j)));
        }
        Drawn { case, colour, alpha: if i == 0 { u8::MAX } else { GHOST_ALPHA }, seen, start_j, unit_j }
    }

    fn room(&self) -> Option<Room> {
        let calm_until_s = self.case.recording.said.get("calm_until_s").and_then(|text| text.parse().ok());
        self.seen.room_until(calm_until_s.unwrap_or(f64::INFINITY))
    }

    /// Entity of one of its bodies.
    fn body(&self, name: &str) -> EntityPath {
        self.below("/world/cases").join(&EntityPath::from_single_string(name))
    }

    fn below(&self, of: &str) -> EntityPath {
        EntityPath::from(of).join(&EntityPath::from_single_string(self.case.label.as_str()))
    }

    fn styles(&self, camera: Option<Camera>, stream: &mut Statics) -> Appended {
        let GhostCase { header, label, recording } = self.case;
        if !recording.samples.bodies.is_empty() {
            let mut looks = Looks::default();
            for body in &header.bodies {
                let (path, look) = (self.body(&body.name), looks.of(body));
                stream.log(path.clone(), &look.surface(self.colour, self.alpha))?;
                if header.bodies.len() <= EDGED_BODIES {
                    details(body, look, &path, stream)?;
                }
            }
        }
        let [r, g, b] = self.colour;
        let ways: Vec<_> = self.seen.ways().map(|(_, way)| in_view(way, camera)).collect();
        if !ways.is_empty() {
            let lines = LineStrips3D::new(ways).with_colors([Color::from_unmultiplied_rgba(r, g, b, 150)]);
            stream.log(self.below(TRAILS), &lines.with_radii([Radius::new_ui_points(LINE_RADIUS)]))?;
        }
        let points = Points3D::update_fields().with_colors([color(self.colour)]);
        let points = points.with_radii([Radius::new_ui_points(POINT_RADIUS)]);
        stream.log(self.below("/world/contacts"), &points)?;
        for plot in [ENERGY, LOG_ENERGY, CONTACT_COUNT] {
            stream.log(self.below(plot), &line(label, self.colour))?;
        }
        Ok(())
    }

    fn samples(&self, out: &mut Out) -> Appended {
        let GhostCase { header, recording, .. } = self.case;
        let batch = &recording.samples;
        let clock = times(&batch.step, &batch.time_s);
        let bodies = header.bodies.len();
        let mut pictures = Pictures::default();
        let instants = pictures.of(batch);
        let end = pictures.end();
        for instants in [&instants, &end].into_iter().filter(|instants| !instants.bodies.is_empty()) {
            let clock = times(&instants.step, &instants.time_s);
            for (i, body) in header.bodies.iter().enumerate() {
                let states = || instants.bodies.iter().skip(i).step_by(bodies);
                let poses = Transform3D::update_fields()
                    .with_many_translation(states().map(|body| body.position_m))
                    .with_many_quaternion(states().map(|body| body.orientation_xyzw.map(|q| q as f32)));
                out.columns(self.body(&body.name), &clock, poses.columns_of_unit_batches()?)?;
            }
        }
        if !batch.contacts_len.is_empty() {
            let clock = times(&instants.contacts_step, &instants.contacts_s);
            let lengths: Vec<usize> = batch.contacts_len.iter().map(|&len| len as usize).collect();
            let points = Points3D::update_fields().with_positions(batch.contacts.iter().map(|contact| contact.point_m));
            out.columns(self.below("/world/contacts"), &clock, points.columns(lengths)?)?;
            let counts = batch.contacts_len.iter().map(|&len| f64::from(len));
            out.scalars(self.below(CONTACT_COUNT), &clock, counts)?;
        }
        if !batch.energy.is_empty() {
            let totals = batch.energy.iter().map(|energy| energy.total_j / self.unit_j);
            out.scalars(self.below(ENERGY), &clock, totals)?;
            if self.start_j.is_some() {
                let part = |total_j: f64| log_part(total_j, self.start_j).unwrap_or(f64::NAN);
                out.scalars(self.below(LOG_ENERGY), &clock, batch.energy.iter().map(|energy| part(energy.total_j)))?;
            }
        }
        // Whose event it is stands in it: a log shows no colours.
        let label = &self.case.label;
        let named =
            batch.events.iter().map(|event| Event { text: format!("{label}: {}", event.text), ..event.clone() });
        out.events_at(self.below(LOG), &named.collect::<Vec<_>>())
    }
}

/// The stretch to look at first: that of all that have one.
fn stretch_s(cases: &[GhostCase]) -> Option<[f64; 2]> {
    let of = |case: &GhostCase| -> Option<[f64; 2]> {
        let (from, to) = case.recording.said.get("stretch_s")?.split_once(' ')?;
        Some([from.parse().ok()?, to.parse().ok()?])
    };
    let all = cases.iter().filter_map(of);
    all.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

fn energy_plot(drawn: &[Drawn<'_>], header: &Header) -> Option<Plot> {
    let all = |pick: fn(&Seen) -> Between| {
        drawn
            .iter()
            .map(|case| pick(&case.seen))
            .filter(|seen| !seen.is_empty())
            .reduce(|a, b| Between { least: a.least.min(b.least), most: a.most.max(b.most) })
    };
    if let Some(range) = all(|seen| seen.log_energy).and_then(|log| layout::log_range(log, header.energy_factor)) {
        return Some(Plot { range: Some(range), ..layout::log_energy_plot() });
    }
    let totals_j = all(|seen| seen.total_j)?;
    let (unit, unit_j) = header.energy_unit;
    let range = layout::with_legend(layout::widened(totals_j, 1e-3 * totals_j.most.abs()));
    let range = range.map(|end_j| end_j / unit_j);
    Some(Plot { name: format!("energy [{unit}]"), path: ENERGY, range: Some(range), legend: Some(Corner2D::RightTop) })
}

/// A table of the instants that decide, of all cases, in the order of time.
fn instants(cases: &[GhostCase]) -> String {
    let of = |case: &'_ GhostCase| {
        let turns = case.recording.ending.iter().flat_map(|ending| ending.story.turns.clone()).collect::<Vec<_>>();
        turns.into_iter().map(|turn| (turn, case.label.clone())).collect::<Vec<_>>()
    };
    let mut all: Vec<_> = cases.iter().flat_map(of).collect();
    if all.is_empty() || cases.len() > MOST_TOLD {
        return String::new();
    }
    all.sort_by(|(a, _), (b, _)| a.time_s.total_cmp(&b.time_s));
    let mut table = String::from("\n| when | case | what |\n|---|---|---|\n");
    for (turn, label) in all {
        let text = match turn.what {
            Decisive::End => markdown(&turn.text),
            what => format!("{}: {}", what.name(), markdown(&turn.text)),
        };
        let _ = writeln!(table, "| {} | {} | {text} |", moment(turn.time_s), markdown(&label));
    }
    table
}

/// A table of the cases, with the colours that they are drawn in.
fn page(differing: &str, cases: &[GhostCase]) -> String {
    let mut page = match cases {
        [only] => format!("# {}\n\n", markdown(&only.label)),
        _ => format!("# {} cases of {}\n\n", cases.len(), markdown(differing)),
    };
    if let Some(question) = cases.first().map(|case| markdown(&case.header.question)).filter(|text| !text.is_empty()) {
        page += &format!("**{question}**\n\n");
    }
    page += "| case | colour | outcome | at | max E / E₀ | max gain | max residual |\n";
    page += "|---|---|---|---|---|---|---|\n";
    for ((case, word), i) in cases.iter().zip(COLOUR_WORDS).zip(0..) {
        let said = |key: &str| case.recording.said.get(key).cloned();
        let number = |key: &str| said(key).and_then(|text| text.parse().ok()).map_or("–".to_string(), brief);
        let outcome = said("outcome").unwrap_or_else(|| "cut".to_string());
        let reason = said("criterion").map(|criterion| format!(" ({})", markdown(&criterion))).unwrap_or_default();
        let _ = writeln!(
            page,
            "| **{}** | {word}{} | {outcome}{reason} | {} s | {} | {} | {} |",
            markdown(&case.label),
            if i == 0 { "" } else { ", ghost" },
            number("end_time_s"),
            number("energy_growth_max"),
            number("contact_gain_max"),
            number("residual_max"),
        );
    }
    page += &instants(cases);
    page += "\nE / E₀: the largest energy, of the start's; gain: the largest of a contact solve. ";
    page + "A case that has ended stays where it was.\n"
}
