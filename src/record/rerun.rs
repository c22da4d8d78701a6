//! Rerun files (.rrd): the run in the Rerun Viewer, with a layout of its own.
//!
//! The head (layout, surfaces, configuration) goes through Rerun's stream into memory; the columns become chunks here
//! and now, and everything is encoded on the calling thread. Rerun's own file sink writes on a further thread and only
//! logs its errors; here a full disk is an error, and a recording needs no threads.
//!
//! 3-D data is f32 in this format; the plotted numbers are f64.

mod arrangement;
mod camera;
mod crowd;
pub mod ghosts;
mod head;
mod headline;
mod layout;
pub mod live;
pub mod mend;
mod names;
mod out;
pub mod rounded;
mod seen;
mod statics;

use self::crowd::{DrawnBodies, drawn_as};
use self::live::Live;
use self::names::{
    CONTACT_COUNT, CONTACT_FORCE, CONTACTS, DECISIVE, FORCES, FRICTION_USE, LOG_ENERGY_TOTAL, VELOCITIES, energy_path,
};
use self::out::{Appended, Out, Sink, Times, skip, times};
use self::seen::{Seen, log_part};
use super::ahead_file::AheadFile;
use super::pictures::{Pictured, Pictures};
use super::sample::{Arrows, Batch, ContactSample, Ending, Event, Header, Sample, Severity, norm};
use super::schema::{self, MOST_CONTACTS};
use super::story::{Decisive, Story, TurningPoint};
use super::{RecordError, Recorder};
use ::rerun::external::re_build_info::CrateVersion;
use ::rerun::external::re_log_encoding::{Encoder, EncodingOptions};
use ::rerun::{Arrows3D, Color, InstancePoses3D, Points3D, Transform3D};
use std::error::Error;
use std::path::{Path, PathBuf};

/// Number of the batch that the layout of a run that goes on is written with: the first may be all of a short run,
/// which ends with a layout of its own. Until then it stands ahead.
const LAID_OUT: usize = 2;

/// A recording as one .rrd file.
pub struct RerunRecorder {
    path: PathBuf,
    header: Header,
    arrows: Arrows,
    bodies: Vec<DrawnBodies>,
    seen: Seen,
    pictures: Pictures,
    /// The same with what stands ahead in the file; None where nothing does.
    ahead: Option<Pictures>,
    /// Number of batches that were written.
    written: usize,
    /// Number of samples and of events of the next batch that a viewer shows already.
    shown: [usize; 2],
    /// Energy of the first sample, if the energies of others can be held against it.
    start_j: Option<f64>,
    out: Out,
}

impl RerunRecorder {
    /// A recording in a new file, with its head.
    ///
    /// # Errors
    /// The file cannot be made or written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, RecordError> {
        let file = AheadFile::create(path).map_err(|error| RecordError::caused(path, &error))?;
        Self::in_file(file, path, header)
    }

    /// The same in a file that is there.
    pub(super) fn in_file(file: AheadFile, path: &Path, header: &Header) -> Result<Self, RecordError> {
        Self::try_in_file(file, path, header).map_err(|error| RecordError::caused(path, error.as_ref()))
    }

    fn try_in_file(file: AheadFile, path: &Path, header: &Header) -> Result<Self, Box<dyn Error>> {
        let encoder = Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file.clone())?;
        Self::begin(path, header, Sink::File(encoder, file))
    }

    /// A recording that a viewer shows while it is made.
    ///
    /// # Errors
    /// Rerun's own.
    pub fn live(viewer: Live, header: &Header) -> Result<Self, RecordError> {
        let path = Path::new("viewer");
        Self::begin(path, header, Sink::Viewer(viewer)).map_err(|error| RecordError::caused(path, error.as_ref()))
    }

    fn begin(path: &Path, header: &Header, sink: Sink) -> Result<Self, Box<dyn Error>> {
        let bodies = drawn_as(header);
        let is_shown = matches!(sink, Sink::Viewer(_));
        let (store, messages) = head::messages(header, &bodies, is_shown)?;
        if let (Sink::File(_, file), Some(first)) = (&sink, messages.first()) {
            file.skip_by(skip(first)?);
        }
        let mut out = Out { store, sink };
        for message in &messages {
            out.sink.append(message)?;
        }
        let mut recorder = RerunRecorder {
            path: path.to_path_buf(),
            arrows: header.force_arrows(),
            bodies,
            seen: Seen::new(header),
            pictures: Pictures::default(),
            ahead: None,
            written: 0,
            shown: [0; 2],
            header: header.clone(),
            start_j: None,
            out,
        };
        if is_shown {
            recorder.lay_out()?;
        }
        recorder.out.sink.flush()?;
        Ok(recorder)
    }

    /// What a recording opens with as long as its run has not ended. A short one has its end before anyone looks.
    fn lay_out(&mut self) -> Appended {
        layout::messages(&self.header, None)?.iter().try_for_each(|message| self.out.sink.append(message))
    }

    /// Ends the file of a run of which no more is known.
    ///
    /// # Errors
    /// The machine failed.
    pub fn leave(mut self) -> Result<(), RecordError> {
        let end = self.pictures.end();
        let poses = if self.header.streams.bodies { self.poses(&end) } else { Ok(()) };
        let laid_out = if self.written < LAID_OUT { self.lay_out() } else { Ok(()) };
        poses
            .and(laid_out)
            .and_then(|()| self.out.sink.finish())
            .map_err(|error| RecordError::caused(&self.path, error.as_ref()))
    }

    /// Number of entities of bodies, each of which has a head in every batch.
    pub fn heads(&self) -> usize {
        self.bodies.len()
    }

    fn batch(&mut self, batch: &Batch) -> Appended {
        let streams = self.header.streams;
        batch.check(streams, self.header.bodies.len())?;
        self.look(batch);
        self.ahead = None;
        self.written += 1;
        if self.written == LAID_OUT && !matches!(self.out.sink, Sink::Viewer(_)) {
            self.lay_out()?;
        }
        self.chunks(batch)?;
        self.out.sink.flush()
    }

    /// A batch behind the chunks that are due.
    fn batch_ahead(&mut self, batch: &Batch) -> Appended {
        let Some(due) = self.out.begin_ahead()? else { return Ok(()) };
        let is_first = self.ahead.is_none();
        let until = self.ahead.take().unwrap_or_else(|| self.pictures.clone());
        let pictures = std::mem::replace(&mut self.pictures, until);
        let laid_out = if is_first && self.written < LAID_OUT { self.lay_out() } else { Ok(()) };
        let written = laid_out.and_then(|()| self.chunks(batch));
        self.ahead = Some(std::mem::replace(&mut self.pictures, pictures));
        self.out.end_ahead(due).and(written)
    }

    fn chunks(&mut self, batch: &Batch) -> Appended {
        let streams = self.header.streams;
        if !batch.step.is_empty() {
            let instants = self.pictures.of(batch);
            if streams.bodies {
                self.poses(&instants)?;
            }
            if streams.any_contact() {
                self.contacts(batch, &times(&instants.contacts_step, &instants.contacts_s))?;
            }
            let own = times(&batch.step, &batch.time_s);
            if streams.velocities {
                self.velocities(batch, &own)?;
            }
            if streams.energy {
                self.energies(batch, &own)?;
            }
        }
        self.out.events(&batch.events)
    }

    fn look(&mut self, batch: &Batch) {
        for sample in batch.samples() {
            let total_j = sample.energy.map(|energy| energy.total_j);
            if self.seen.samples == 0 {
                self.start_j = total_j.filter(|total_j| *total_j > 0.0);
            }
            self.seen.look(&sample, total_j.and_then(|total_j| log_part(total_j, self.start_j)));
        }
    }

    fn close(&mut self, ending: &Ending) -> Appended {
        let end = self.pictures.end();
        if self.header.streams.bodies {
            self.poses(&end)?;
        }
        let decisive = decisive(&ending.story);
        self.out.events_at(DECISIVE.into(), &decisive)?;
        for message in head::ending(&self.header, ending, &self.seen)? {
            self.out.sink.append(&message)?;
        }
        self.out.sink.finish()
    }

    fn poses(&mut self, instants: &Pictured) -> Appended {
        if instants.bodies.is_empty() {
            return Ok(());
        }
        let times = times(&instants.step, &instants.time_s);
        let count = self.header.bodies.len();
        for drawn in &self.bodies {
            match &drawn.bodies[..] {
                [i] => {
                    let states = || instants.bodies.iter().skip(*i).step_by(count);
                    let poses = Transform3D::update_fields()
                        .with_many_translation(states().map(|body| body.position_m))
                        .with_many_quaternion(states().map(|body| body.orientation_xyzw.map(|q| q as f32)));
                    self.out.columns(drawn.path.clone(), &times, poses.columns_of_unit_batches()?)?;
                }
                several => {
                    let states = || instants.bodies.chunks(count).flat_map(|all| several.iter().map(|&i| &all[i]));
                    let poses = InstancePoses3D::update_fields()
                        .with_translations(states().map(|body| body.position_m))
                        .with_quaternions(states().map(|body| body.orientation_xyzw.map(|q| q as f32)));
                    let lengths = std::iter::repeat_n(several.len(), instants.step.len());
                    self.out.columns(drawn.path.clone(), &times, poses.columns(lengths)?)?;
                }
            }
        }
        Ok(())
    }

    /// Contact points, coloured by what they do, and forces, at one instant; series of their number, sum and use of
    /// friction.
    fn contacts(&mut self, batch: &Batch, times: &Times) -> Appended {
        let streams = self.header.streams;
        let drawn: Vec<Vec<&ContactSample>> = batch.samples().map(|sample| drawn(&sample)).collect();
        let all = || drawn.iter().flatten();
        if streams.contacts {
            let points = Points3D::update_fields()
                .with_positions(all().map(|contact| contact.point_m))
                .with_colors(all().map(|contact| color(schema::mode_colour(contact.mode))));
            let lengths: Vec<usize> = drawn.iter().map(Vec::len).collect();
            self.out.columns(CONTACTS.into(), times, points.columns(lengths)?)?;
            self.out.scalars(CONTACT_COUNT.into(), times, batch.contacts_len.iter().map(|&len| f64::from(len)))?;
        }
        if streams.forces {
            let arrow = |contact: &&ContactSample| self.arrows.vector_m(contact.force_n);
            let arrows = Arrows3D::update_fields()
                .with_vectors(all().map(arrow).flat_map(|v| [v, v.map(|x| -x)]))
                .with_origins(all().flat_map(|contact| [contact.point_m; 2]));
            let lengths: Vec<usize> = drawn.iter().map(|contacts| 2 * contacts.len()).collect();
            self.out.columns(FORCES.into(), times, arrows.columns(lengths)?)?;
            let sums = batch.samples().map(|sample| sample.contacts.iter().map(|contact| norm(contact.force_n)).sum());
            self.out.scalars(CONTACT_FORCE.into(), times, sums)?;
            let used = batch.samples().map(|sample| {
                let finite = sample.contacts.iter().map(|contact| contact.friction_use).filter(|x| x.is_finite());
                finite.fold(0.0, f64::max)
            });
            self.out.scalars(FRICTION_USE.into(), times, used)?;
        }
        Ok(())
    }

    fn velocities(&mut self, batch: &Batch, times: &Times) -> Appended {
        let scale = self.header.velocity_arrows();
        let arrows = Arrows3D::update_fields()
            .with_vectors(batch.bodies.iter().map(|body| scale.vector_m(body.velocity_m_s)))
            .with_origins(batch.bodies.iter().map(|body| body.position_m));
        let lengths = std::iter::repeat_n(self.header.bodies.len(), batch.len());
        self.out.columns(VELOCITIES.into(), times, arrows.columns(lengths)?)
    }

    fn energies(&mut self, batch: &Batch, times: &Times) -> Appended {
        for series in &schema::ENERGY_SERIES {
            let unit = if series.is_length() { 1.0 } else { self.header.energy_unit.1 };
            let values = batch.energy.iter().map(|energy| (series.value)(energy) / unit);
            self.out.scalars(energy_path(series), times, values)?;
        }
        if self.start_j.is_some() {
            let parts = batch.energy.iter().map(|energy| log_part(energy.total_j, self.start_j).unwrap_or(f64::NAN));
            self.out.scalars(LOG_ENERGY_TOTAL.into(), times, parts)?;
        }
        Ok(())
    }
}

/// The decisive instants as the log has them. The end stands there already, and the first gain is said once.
fn decisive(story: &Story) -> Vec<Event> {
    let onset = story.turn(Decisive::Onset).map(|turn| turn.step);
    let is_said = |turn: &&TurningPoint| match turn.what {
        Decisive::End => false,
        Decisive::FirstGain => Some(turn.step) != onset,
        _ => true,
    };
    let event = |TurningPoint { what, step, time_s, text }: &TurningPoint| Event {
        step: *step,
        time_s: *time_s,
        severity: match what {
            Decisive::FirstContact | Decisive::MostContacts | Decisive::End => Severity::Info,
            Decisive::FirstGain | Decisive::LargestGain | Decisive::Onset => Severity::Warning,
        },
        text: format!("{}: {text}", what.name()),
    };
    story.turns.iter().filter(is_said).map(event).collect()
}

/// Contacts of a sample that are drawn, in their order.
fn drawn<'a>(sample: &Sample<'a>) -> Vec<&'a ContactSample> {
    let mut contacts: Vec<_> = sample.contacts.iter().enumerate().collect();
    if contacts.len() > MOST_CONTACTS {
        contacts.sort_by(|(_, a), (_, b)| norm(b.force_n).total_cmp(&norm(a.force_n)));
        contacts.truncate(MOST_CONTACTS);
        contacts.sort_by_key(|(i, _)| *i);
    }
    contacts.into_iter().map(|(_, contact)| contact).collect()
}

fn color([r, g, b]: schema::Rgb) -> Color {
    Color::from_rgb(r, g, b)
}

impl Recorder for RerunRecorder {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError> {
        let shown = std::mem::take(&mut self.shown);
        if shown != [0; 2] {
            let mut rest = Batch::default();
            rest.append_since(batch, shown);
            return self.batch(&rest).map_err(|error| RecordError::caused(&self.path, error.as_ref()));
        }
        self.batch(batch).map_err(|error| RecordError::caused(&self.path, error.as_ref()))
    }

    fn ahead(&mut self, batch: &Batch) -> Result<(), RecordError> {
        if matches!(self.out.sink, Sink::Viewer(_)) {
            // It forgets nothing: what it shows is not sent again.
            if !batch.is_empty() {
                self.shown = [self.shown[0] + batch.len(), self.shown[1] + batch.events.len()];
                self.batch(batch).map_err(|error| RecordError::caused(&self.path, error.as_ref()))?;
            }
            return Ok(());
        }
        // Without anything new, that a layout stands there: nothing is worth to be looked at without one.
        if !batch.is_empty() || (self.written < LAID_OUT && self.ahead.is_none()) {
            // What finds no room is written later, or fails then.
            let _ = self.batch_ahead(batch);
        }
        Ok(())
    }

    fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.ahead = None;
        let logged = self.out.events(std::slice::from_ref(event)).and_then(|()| self.out.sink.flush());
        logged.map_err(|error| RecordError::caused(&self.path, error.as_ref()))
    }

    fn bytes(&self) -> u64 {
        self.out.sink.whole()
    }

    fn finish(mut self: Box<Self>, ending: &Ending) -> Result<(), RecordError> {
        self.close(ending).map_err(|error| RecordError::caused(&self.path, error.as_ref()))
    }
}
