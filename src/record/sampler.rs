//! Sampler of a run: from states to samples, at the rate asked for, into the recording thread's batches.
//!
//! A recorded run is the same run: the sampler only looks. What no stream asks for is not computed.

use super::RecordError;
use super::aside::Aside;
use super::effort::Effort;
use super::flight::{Flight, KeptContacts};
use super::ring::{KeptStep, Ring};
use super::sample::{Batch, ContactMode, ContactSample, Ending, EnergySample, Event, Severity, Streams};
use super::story::shortest;
use super::watch::Watch;
use super::writer::{FileSum, Writer};
use crate::clock::Clock;
use crate::collide::SolvedContact;
use crate::experiment::types::{Record, Stream};
use crate::measure::Judge;
use crate::measure::divergence::escaped;
use crate::measure::energy::Energy;
use crate::measure::geometry::GeometryLedger;
use crate::model::Model;
use crate::outcome::{Criterion, Outcome};
use crate::rows::doubts::doubt;
use crate::rows::{BodyRow, Measured, cells};
use crate::shown::{Acted, ContactForce, Shown};
use crate::state::{BodyState, State};
use crate::work::Work;

/// Largest amount of something so far, and its step where no sample shows it.
#[derive(Default)]
struct Maximum {
    amount: f64,
    step: Ring,
}

/// Steps before and after one that decides that are recorded whatever the rate of samples.
const AROUND: u64 = 4;

/// Samples of one run.
pub struct Sampler {
    writer: Writer,
    streams: Streams,
    /// Number of steps from one sample to the next, and the step that is due next.
    every: u64,
    next: u64,
    ending: Option<Ending>,
    /// For the deepest overlap in the stream of energies, where the recording thread does not see the bodies.
    geometry: Option<GeometryLedger>,
    watch: Option<Watch>,
    ring: Ring,
    /// Steps of the most contacts and of the deepest overlap, which the row tells; samples that beat them come first.
    maxima: [Maximum; 2],
    /// Time of the last sample in the file.
    last_s: f64,
    /// Step of the last sample, and steps that are still to be recorded after one that decides.
    last: u64,
    ahead: u64,
    effort: Effort,
    /// Whether every step is recorded, and the contacts of the step that gained most then.
    is_flight: bool,
    flight: Option<KeptContacts>,
}

impl Sampler {
    pub fn new(writer: Writer, record: &Record, clock: &Clock) -> Self {
        Sampler {
            writer,
            streams: streams(record),
            every: steps_between(record, clock),
            next: 0,
            ending: None,
            geometry: None,
            watch: None,
            ring: Ring::default(),
            maxima: Default::default(),
            last_s: f64::NAN,
            last: 0,
            ahead: 0,
            effort: Effort::default(),
            is_flight: record.every_s == 0.0,
            flight: None,
        }
    }

    /// Whether a step is due, which is none before the last one that was asked about but one.
    pub fn is_due(&mut self, step: u64) -> bool {
        while self.next < step {
            self.next += self.every;
        }
        self.next == step
    }

    /// Begins with the first state, of a method that claims to solve the law of contact or does not.
    pub fn start(&mut self, model: &Model, start: &State, solves_contacts: bool) {
        self.watch = Some(Watch::new(model, start, solves_contacts));
        self.writer.work_aside(Aside::new(model, start, self.streams));
        if self.streams.energy && !Aside::has_depths(self.streams) {
            self.geometry = Some(GeometryLedger::new(model, start, true));
        }
        self.sample(model, [start, start], std::iter::empty(), false, None);
        // How a run begins can be seen while it goes on.
        self.writer.flush();
    }

    /// Looks at a step, judged already; says whether it is to be recorded whatever the rate of samples. Those just
    /// before one that decides are recorded now.
    pub fn look(&mut self, model: &Model, shown: &Shown, judge: &Judge) -> bool {
        let Some(watch) = &mut self.watch else { return false };
        let is_notable = watch.look(model, shown, judge);
        if self.is_flight
            && let Acted::Kick { kicked, contacts, step_s, .. } = shown.acted
            && watch.gains_most(shown.after)
        {
            let (step, contacts) = (shown.after.step, contacts.to_vec());
            self.flight = Some(KeptContacts { acted: kicked.clone(), step, step_s, contacts });
        }
        if is_notable {
            let since = shown.after.step.saturating_sub(AROUND).max(self.last + 1);
            self.take_since(model, since);
            self.ahead = AROUND;
        } else if self.ahead > 0 && !shown.is_part() {
            self.ahead -= 1;
            return true;
        }
        is_notable
    }

    /// Looks at the counters of work after a step; after much work, what is sampled is written.
    pub fn count(&mut self, work: &Work, state: &State) {
        if let Some(watch) = &mut self.watch {
            watch.count(work, (state.step, state.time_s));
        }
        if self.effort.add(work, state.bodies.len()) && self.writer.flush() {
            self.effort.restart();
        }
    }

    /// Keeps a step that is no sample, judged already, in case that it turns out to decide: its end, and the state at
    /// which its contacts act.
    pub fn keep(&mut self, states: [&State; 2], (contacts, step_s): (&[SolvedContact], f64), judge: &Judge) {
        let shown = if self.streams.any_contact() { contacts } else { &[] };
        let energy_j = judge.energy.parts_j();
        self.ring.keep(states, shown, step_s, energy_j);
        let amounts = [contacts.len() as f64, judge.geometry.penetration_max_m.unwrap_or(0.0)];
        for (maximum, amount) in self.maxima.iter_mut().zip(amounts) {
            if amount > maximum.amount {
                maximum.amount = amount;
                maximum.step.keep_one(states, shown, step_s, energy_j);
            }
        }
    }

    /// Notes the amounts of a step that is a sample.
    pub fn note(&mut self, contacts: usize, judge: &Judge) {
        let amounts = [contacts as f64, judge.geometry.penetration_max_m.unwrap_or(0.0)];
        for (maximum, amount) in self.maxima.iter_mut().zip(amounts) {
            if amount > maximum.amount {
                maximum.amount = amount;
                maximum.step.clear();
            }
        }
    }

    /// Adds a sample; `contacts` are those of the step that led to `state`, and act at `acted`. One that is there
    /// `by_rate` alone may be left out where a file becomes too large. `judge`: one whose last state it is.
    pub fn sample(
        &mut self,
        model: &Model,
        [state, acted]: [&State; 2],
        contacts: impl ExactSizeIterator<Item = ContactForce>,
        by_rate: bool,
        judge: Option<&Judge>,
    ) {
        let streams = self.streams;
        let energy_j = if streams.energy { parts_j(model, state, judge) } else { [0.0; 2] };
        let depth_m = self.geometry.as_mut().and_then(|geometry| geometry.penetration_m(model, state));
        let (watch, last_s) = (&mut self.watch, self.last_s);
        self.writer.fill(|batch| {
            if streams.any_contact() {
                let acts = contacts.len() > 0 && acted.time_s != state.time_s;
                let bodies = if acts { &acted.bodies[..] } else { &[] };
                push_acted(batch, streams, (acted.time_s, bodies, last_s), contacts.len());
                batch.contacts.extend(contacts.map(contact_sample));
            }
            push(batch, streams, (state.step, state.time_s, &state.bodies), (energy_j, depth_m));
            batch.by_rate.push(by_rate);
            if let Some(watch) = watch {
                batch.events.extend(watch.events());
            }
        });
        self.last_s = state.time_s;
        self.last = state.step;
    }

    /// Records what was kept from a step on.
    fn take_since(&mut self, model: &Model, step: u64) {
        let Sampler { writer, streams, geometry, ring, maxima, last_s, .. } = self;
        ring.take_since(step, |kept| {
            for maximum in maxima.iter_mut().filter(|maximum| maximum.step.holds(kept.step)) {
                maximum.step.clear();
            }
            add(writer, *streams, geometry, model, (kept, last_s));
        });
    }

    /// Records the steps of the maxima that no sample shows, each once.
    fn take_maxima(&mut self, model: &Model) {
        let Sampler { writer, streams, geometry, maxima, last_s, .. } = self;
        let mut taken = None;
        for maximum in maxima {
            maximum.step.take_since(0, |kept| {
                if taken != Some(kept.step) {
                    taken = Some(kept.step);
                    add(writer, *streams, geometry, model, (kept, last_s));
                }
            });
        }
    }

    /// Says how the run ended, and what is in doubt about it: a warning of a method that solves the law of contact, a
    /// note of another one. The last steps of a run that came to no good end are recorded, all of them.
    pub fn end(&mut self, model: &Model, state: &State, measured: &Measured, solves_contacts: bool) {
        if measured.outcome != Outcome::Finished {
            self.take_since(model, 0);
        }
        self.take_maxima(model);
        let (severity, text) = match (&measured.outcome, &measured.criterion) {
            (Outcome::Finished, _) => (Severity::Info, "finished".to_string()),
            (Outcome::Diverged, Some(criterion)) => {
                let who =
                    if criterion.as_str() == Criterion::Escape.name() { escaping(model, state) } else { String::new() };
                (Severity::Error, format!("diverged: {criterion}{who}"))
            }
            (outcome, Some(criterion)) => (Severity::Warning, format!("{}: {criterion}", outcome.name())),
            (_, None) => (Severity::Warning, "ended early".to_string()),
        };
        let said = text.clone();
        let text = format!("{text} at t = {} s, step {}", shortest(state.time_s), state.step);
        let (rest, unlogged) = self.watch.as_mut().map_or((Vec::new(), None), |watch| {
            let rest: Vec<_> = watch.events().collect();
            (rest, watch.unlogged())
        });
        for event in rest {
            self.writer.event(event);
        }
        let mut say = |severity, text| {
            self.writer.event(Event { step: state.step, time_s: state.time_s, severity, text });
        };
        if let Some(unlogged) = unlogged {
            say(Severity::Info, unlogged);
        }
        say(severity, text);
        let row = cells(measured);
        let doubt = doubt(std::slice::from_ref(&row), 1).map(|doubt| doubt.said);
        if let Some(said) = &doubt {
            say(if solves_contacts { Severity::Warning } else { Severity::Info }, said.clone());
        }
        let (warnings, notes) = if solves_contacts { (doubt, None) } else { (None, doubt) };
        let story = self.watch.as_mut().map(|watch| watch.story(state, measured.outcome, said)).unwrap_or_default();
        self.ending = Some(Ending {
            outcome: measured.outcome,
            criterion: measured.criterion.clone(),
            end_time_s: state.time_s,
            steps: measured.steps,
            warnings,
            notes,
            row: row.into_iter().filter(|(name, cell)| !cell.is_null() && !name.starts_with("wall_")).collect(),
            story,
            flight: self.flight.take().filter(|kept| !kept.contacts.is_empty()).map(|kept| Flight::of(model, &kept)),
            left_out: 0,
        });
    }

    /// Writes the rest and closes the files; those of a run that has not ended stay incomplete. Sums of those that are.
    ///
    /// # Errors
    /// The machine failed, in this call or in a write before it.
    pub fn finish(self) -> Result<Vec<FileSum>, RecordError> {
        self.ending.map_or(Ok(Vec::new()), |ending| self.writer.finish(ending))
    }
}

/// Adds a step that was kept.
fn add(
    writer: &mut Writer,
    streams: Streams,
    geometry: &mut Option<GeometryLedger>,
    model: &Model,
    (kept, last_s): (&KeptStep, &mut f64),
) {
    let KeptStep { step, time_s, energy_j, bodies, contacts, step_s, acted_s, acted } = kept;
    let depth_m = geometry.as_mut().and_then(|geometry| {
        geometry.penetration_m(model, &State { step: *step, time_s: *time_s, bodies: bodies.clone() })
    });
    writer.fill(|batch| {
        if streams.any_contact() {
            push_acted(batch, streams, (*acted_s, acted, *last_s), contacts.len());
            batch.contacts.extend(contacts.iter().map(|solved| contact_sample(ContactForce::mean(solved, *step_s))));
        }
        push(batch, streams, (*step, *time_s, bodies), (*energy_j, depth_m));
        batch.by_rate.push(false);
    });
    *last_s = *time_s;
}

/// Adds the number of contacts, when they act, and the bodies then, unless the sample before shows them, which was at
/// `last_s`.
fn push_acted(
    batch: &mut Batch,
    streams: Streams,
    (acted_s, acted, last_s): (f64, &[BodyState], f64),
    contacts: usize,
) {
    let bodies = if acted_s == last_s || !streams.bodies { &[] } else { acted };
    batch.contacts_len.push(contacts as u32);
    batch.acted_s.push(acted_s);
    batch.acted_len.push(bodies.len() as u32);
    batch.acted.extend(bodies.iter().map(BodyRow::from));
}

/// Adds a state to a batch: what does not depend on its contacts. Its depth is worked out later if it is not known.
fn push(
    batch: &mut Batch,
    streams: Streams,
    (step, time_s, bodies): (u64, f64, &[BodyState]),
    ([kinetic_j, potential_j], depth_m): ([f64; 2], Option<f64>),
) {
    batch.is_raw = true;
    batch.step.push(step);
    batch.time_s.push(time_s);
    if streams.bodies {
        batch.bodies.extend(bodies.iter().map(BodyRow::from));
    }
    if streams.energy {
        let total_j = Energy { kinetic_j, potential_j, stored_j: 0.0 }.total_j();
        let penetration_m = depth_m.unwrap_or(0.0);
        batch.energy.push(EnergySample { kinetic_j, potential_j, total_j, penetration_m });
    }
}

/// Kinetic and potential energy of a state; a judge whose last state it is has worked them out.
fn parts_j(model: &Model, state: &State, judge: Option<&Judge>) -> [f64; 2] {
    match judge {
        Some(judge) => judge.energy.parts_j(),
        None => {
            let energy = Energy::of(model, state);
            [energy.kinetic_j, energy.potential_j]
        }
    }
}

pub fn streams(record: &Record) -> Streams {
    let on = |stream| record.streams.contains(&stream);
    Streams {
        bodies: on(Stream::Bodies),
        contacts: on(Stream::Contacts),
        forces: on(Stream::Forces),
        energy: on(Stream::Energy),
        velocities: on(Stream::Velocities) && on(Stream::Bodies),
    }
}

/// Number of steps from one sample to the next: the whole number nearest to what is asked for, at least one.
pub fn steps_between(record: &Record, clock: &Clock) -> u64 {
    ((record.every_s / clock.step_s).round() as u64).max(1)
}

/// The bodies outside of the container, in words.
fn escaping(model: &Model, state: &State) -> String {
    let outside = model.bodies.iter().zip(&state.bodies).filter(|(body, at)| escaped(model, body, at));
    let names: Vec<&str> = outside.map(|(body, _)| body.name.as_str()).collect();
    match names.as_slice() {
        [] => String::new(),
        [only] => format!(" of {only}"),
        [first, others @ ..] => format!(" of {first} and {} more", others.len()),
    }
}

/// A contact whose mode and use of friction are still to be worked out.
fn contact_sample(ContactForce { contact, force_W }: ContactForce) -> ContactSample {
    ContactSample {
        friction_use: contact.friction,
        mode: ContactMode::Open,
        body: contact.body as u32,
        other: contact.other.map(|other| other as u32),
        point_m: contact.p_WC.into(),
        normal: contact.normal.into(),
        force_n: force_W.into(),
        gap_m: contact.gap_m,
    }
}
