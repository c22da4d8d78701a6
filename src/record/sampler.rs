//! Sampler of a run: from states to samples, at the rate asked for, into the recording thread's batches.
//!
//! A recorded run is the same run: the sampler only looks. What no stream asks for is not computed.

use super::RecordError;
use super::sample::{ContactSample, Ending, EnergySample, Event, Severity, Streams};
use super::writer::Writer;
use crate::clock::Clock;
use crate::experiment::types::{Record, Stream};
use crate::measure::energy::Energy;
use crate::measure::geometry::GeometryLedger;
use crate::model::Model;
use crate::outcome::Outcome;
use crate::rows::doubts::doubt;
use crate::rows::{BodyRow, Measured, cells};
use crate::shown::ContactForce;
use crate::state::State;

/// Samples of one run.
pub struct Sampler {
    writer: Writer,
    streams: Streams,
    /// Number of steps from one sample to the next.
    every: u64,
    ending: Option<Ending>,
    /// Of the stream of energies, which shows the deepest overlap.
    geometry: Option<GeometryLedger>,
}

impl Sampler {
    pub fn new(writer: Writer, record: &Record, clock: &Clock) -> Self {
        let every = steps_between(record, clock);
        Sampler { writer, streams: streams(record), every, ending: None, geometry: None }
    }

    pub fn is_due(&self, step: u64) -> bool {
        step.is_multiple_of(self.every)
    }

    /// Adds a sample; `contacts` are those of the step that led to `state`.
    pub fn sample(&mut self, model: &Model, state: &State, contacts: impl ExactSizeIterator<Item = ContactForce>) {
        let batch = self.writer.batch();
        batch.step.push(state.step);
        batch.time_s.push(state.time_s);
        if self.streams.bodies {
            batch.bodies.extend(state.bodies.iter().map(BodyRow::from));
        }
        if self.streams.any_contact() {
            batch.contacts_len.push(contacts.len() as u32);
            batch.contacts.extend(contacts.map(contact_sample));
        }
        if self.streams.energy {
            let energy = Energy::of(model, state);
            let geometry = self.geometry.get_or_insert_with(|| GeometryLedger::new(model, state, true));
            batch.energy.push(EnergySample {
                kinetic_j: energy.kinetic_j,
                potential_j: energy.potential_j,
                total_j: energy.total_j(),
                penetration_m: geometry.penetration_m(model, state).unwrap_or(0.0),
            });
        }
        self.writer.sample_done();
    }

    /// Says how the run ended, and what is in doubt about it: a warning of a method that solves the law of contact, a
    /// note of another one.
    pub fn end(&mut self, state: &State, measured: &Measured, solves_contacts: bool) {
        let (severity, text) = match (&measured.outcome, &measured.criterion) {
            (Outcome::Finished, _) => (Severity::Info, "finished".to_string()),
            (outcome, Some(criterion)) => (Severity::Warning, format!("{}: {criterion}", outcome.name())),
            (_, None) => (Severity::Warning, "ended early".to_string()),
        };
        let text = format!("{text} at t = {} s, step {}", state.time_s, state.step);
        let mut say = |severity, text| {
            self.writer.event(Event { step: state.step, time_s: state.time_s, severity, text });
        };
        say(severity, text);
        let doubt = doubt(&[cells(measured)], 1).map(|doubt| doubt.said);
        if let Some(said) = &doubt {
            say(if solves_contacts { Severity::Warning } else { Severity::Info }, said.clone());
        }
        let (warnings, notes) = if solves_contacts { (doubt, None) } else { (None, doubt) };
        self.ending = Some(Ending {
            outcome: measured.outcome,
            criterion: measured.criterion.clone(),
            end_time_s: state.time_s,
            steps: measured.steps,
            warnings,
            notes,
        });
    }

    /// Writes the rest and closes the files; those of a run that has not ended stay incomplete.
    ///
    /// # Errors
    /// The machine failed, in this call or in a write before it.
    pub fn finish(self) -> Result<(), RecordError> {
        self.ending.map_or(Ok(()), |ending| self.writer.finish(ending))
    }
}

pub fn streams(record: &Record) -> Streams {
    let on = |stream| record.streams.contains(&stream);
    Streams {
        bodies: on(Stream::Bodies),
        contacts: on(Stream::Contacts),
        forces: on(Stream::Forces),
        energy: on(Stream::Energy),
    }
}

/// Number of steps from one sample to the next: the whole number nearest to what is asked for, at least one.
pub fn steps_between(record: &Record, clock: &Clock) -> u64 {
    ((record.every_s / clock.step_s).round() as u64).max(1)
}

fn contact_sample(ContactForce { contact, force_W }: ContactForce) -> ContactSample {
    ContactSample {
        body: contact.body as u32,
        other: contact.other.map(|other| other as u32),
        point_m: contact.p_WC.into(),
        normal: contact.normal.into(),
        force_n: force_W.into(),
        gap_m: contact.gap_m,
    }
}
