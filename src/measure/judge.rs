//! The judge of a run, who watches it step by step.

use super::divergence::Divergence;
use super::energy::{Energy, EnergyLedger};
use super::geometry::GeometryLedger;
use super::loads;
use super::momentum::MomentumLedger;
use super::more::Watched;
use super::push::Push;
use super::residual::ResidualLedger;
use crate::collide::SolvedContact;
use crate::collide::approach::Approach;
use crate::experiment::types::Diverge;
use crate::model::Model;
use crate::outcome::Criterion;
use crate::plan::Plan;
use crate::shown::{Acted, ContactForce, Moment, Shown};
use crate::state::State;
use nalgebra::Vector3;

/// An impact, or a force: in no time.
const AT_ONCE: (Approach, f64) = (Approach::Inside, 0.0);

/// Watches a run, step by step.
pub struct Judge {
    pub energy: EnergyLedger,
    pub momentum: MomentumLedger,
    pub residual: ResidualLedger,
    pub geometry: GeometryLedger,
    pub contacts_max: u64,
    /// None: there is no pin.
    pub pin_gap_max_m: Option<f64>,
    pub watched: Watched,
    divergence: Divergence,
    /// A hundredth of a fall by the size of the largest body: what slips less than a force changes velocities in it,
    /// rests.
    moment_s: f64,
    /// Between two steps.
    middle: State,
    pushes: Vec<Push>,
}

impl Judge {
    pub fn new(model: &Model, start: &State, rules: &Diverge, plan: &Plan) -> Self {
        let energy = Energy::of(model, start);
        Judge {
            energy: EnergyLedger::new(energy),
            momentum: MomentumLedger::new(model, start),
            residual: ResidualLedger::new(plan.constraint, plan.newton, model),
            geometry: GeometryLedger::new(model, start, plan.contact),
            contacts_max: 0,
            pin_gap_max_m: model.pin_gap_m(&start.bodies),
            watched: Watched::default(),
            divergence: Divergence::new(rules, model, &energy),
            moment_s: moment_s(model),
            middle: start.clone(),
            pushes: vec![Push::NONE; model.bodies.len()],
        }
    }

    /// Judges a step; says if the run has diverged, and by which criterion. A step that could not be made is none.
    pub fn observe(&mut self, model: &Model, shown: &Shown) -> Option<Criterion> {
        if shown.stalled.is_some() {
            return None;
        }
        let Shown { before, after, .. } = *shown;
        let energy = Energy::of(model, after);
        match shown.acted {
            Acted::Kick { kicked, contacts, step_s, approach } => {
                self.observe_kick(model, [before, kicked, after], contacts, (approach, step_s), energy)
            }
            Acted::Blow { contacts } => self.observe_blow(model, [before, after], contacts, energy),
            Acted::Motion(way) => {
                self.observe_motion(model, [before, after], &way.moments(model, [before, after]), energy)
            }
        }
        let depth_m = self.geometry.observe(model, shown);
        self.divergence.judge(model, after, &energy, depth_m)
    }

    /// Impulses at the state `kicked`.
    fn observe_kick(
        &mut self,
        model: &Model,
        [before, kicked, after]: [&State; 3],
        contacts: &[SolvedContact],
        (approach, step_s): (Approach, f64),
        energy: Energy,
    ) {
        self.gather_pushes(contacts);
        if !contacts.is_empty() {
            self.energy.observe_contacts(model, kicked, &self.pushes, step_s);
            self.watched.observe(kicked, contacts);
        }
        if step_s > 0.0 {
            self.watched.observe_step(before, after, step_s);
        }
        self.residual.observe(model, [kicked, after], contacts, &self.pushes, (approach, step_s));
        let pivot = |state: &State| self.momentum.pivot_m(model, state);
        let done = loads::done(model, [before, after], &mut self.middle, pivot, step_s);
        self.energy.observe(energy, done.work_j);
        let pushes = (!contacts.is_empty()).then_some(&self.pushes[..]);
        self.momentum.observe(model, [before, kicked, after], pushes, &done, step_s);
        self.observe_pins(model, after);
        self.observe_contacts(contacts);
    }

    /// An impact, which takes no time: `contacts` changed only the velocities.
    fn observe_blow(
        &mut self,
        model: &Model,
        [before, after]: [&State; 2],
        contacts: &[SolvedContact],
        energy: Energy,
    ) {
        self.gather_pushes(contacts);
        self.energy.observe_blow(model, [before, after], &self.pushes);
        self.watched.observe(before, contacts);
        self.residual.observe(model, [before, after], contacts, &self.pushes, AT_ONCE);
        self.energy.observe(energy, 0.0);
        let done = loads::done(model, [before, after], &mut self.middle, |_| Vector3::zeros(), 0.0);
        self.momentum.observe(model, [before, before, after], Some(&self.pushes), &done, 0.0);
        self.observe_contacts(contacts);
    }

    /// A smooth motion, of which `moments` show the forces of contact: their weights are those of a quadrature.
    fn observe_motion(&mut self, model: &Model, [before, after]: [&State; 2], moments: &[Moment], energy: Energy) {
        let span_s = after.time_s - before.time_s;
        for Moment { state, contacts, weight_s } in moments.iter().filter(|moment| !moment.contacts.is_empty()) {
            let impulse =
                |force: &ContactForce| SolvedContact { contact: force.contact, impulse_W: force.force_W * *weight_s };
            let contacts: Vec<SolvedContact> = contacts.iter().map(impulse).collect();
            self.gather_pushes(&contacts);
            self.energy.observe_forces(model, state, &self.pushes);
            self.momentum.observe_pushes(model, state, &self.pushes);
            self.pushes.fill(Push::NONE);
            // Forces, as impulses that velocities can be held against.
            let longer = self.moment_s.max(*weight_s) / weight_s;
            let forces = contacts.iter().map(|s| SolvedContact { impulse_W: s.impulse_W * longer, ..*s });
            self.residual.observe(model, [state, state], &forces.collect::<Vec<_>>(), &self.pushes, AT_ONCE);
            self.watched.observe(state, &contacts);
            self.observe_contacts(&contacts);
        }
        if span_s > 0.0 {
            self.watched.observe_step(before, after, span_s);
        }
        let pivot = |state: &State| self.momentum.pivot_m(model, state);
        // A long stretch in parts: what acts on bodies may swing in it.
        let mut done = loads::Done::NOTHING;
        let mut from = before;
        for to in moments.iter().map(|moment| &moment.state).chain([after]) {
            done += loads::done(model, [from, to], &mut self.middle, pivot, to.time_s - from.time_s);
            from = to;
        }
        self.energy.observe(energy, done.work_j);
        self.momentum.observe(model, [before, before, after], None, &done, span_s);
        self.observe_pins(model, after);
    }

    fn observe_pins(&mut self, model: &Model, after: &State) {
        let gap_m = model.pin_gap_m(&after.bodies);
        self.pin_gap_max_m = self.pin_gap_max_m.zip(gap_m).map(|(max, gap)| max.max(gap));
    }

    fn observe_contacts(&mut self, contacts: &[SolvedContact]) {
        self.contacts_max = self.contacts_max.max(contacts.len() as u64);
    }

    fn gather_pushes(&mut self, contacts: &[SolvedContact]) {
        if !contacts.is_empty() {
            self.pushes.fill(Push::NONE);
        }
        for SolvedContact { contact, impulse_W } in contacts {
            for (i, r_W, sign) in contact.ends() {
                self.pushes[i].linear += impulse_W * sign;
                self.pushes[i].angular += r_W.cross(impulse_W) * sign;
            }
        }
    }
}

fn moment_s(model: &Model) -> f64 {
    let size_m = model.largest_radius_m();
    let g = model.gravity_m_s2.norm();
    if g > 0.0 { 0.01 * (size_m / g).sqrt() } else { 0.0 }
}
