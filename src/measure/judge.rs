//! The judge of a run, who watches it step by step.

use super::again::Again;
use super::dissipation::{Dissipation, Law, Taken};
use super::divergence::Divergence;
use super::energy::EnergyLedger;
use super::exchange::{Exchange, Over};
use super::geometry::GeometryLedger;
use super::momentum::MomentumLedger;
use super::more::Watched;
use super::pinned;
use super::residual::ResidualLedger;
use super::springs::Springs;
use super::squeezed::Squeezed;
use super::work::{self, Done};
use crate::collide::SolvedContact;
use crate::collide::approach::Approach;
use crate::collide::lasting::Lasting;
use crate::experiment::types::Diverge;
use crate::model::Model;
use crate::outcome::Criterion;
use crate::plan::Plan;
use crate::shown::{Acted, ContactForce, Moment, Shown};
use crate::state::State;

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
    /// Whether the last step was the one before over again.
    pub repeats: bool,
    divergence: Divergence,
    /// Impacts obey Newton's law of restitution.
    newton: bool,
    /// A driven body holds a pin.
    driven_pins: bool,
    /// In place of a law of contact.
    springs: Option<Springs>,
    /// A hundredth of a fall by the size of the largest body: what slips less than a force changes velocities in it,
    /// rests.
    moment_s: f64,
    exchange: Exchange,
    dissipation: Dissipation,
    impacts: Impacts,
    squeezed: Squeezed,
    /// None: loads, pins or springs make something of every step.
    again: Option<Again>,
    /// What contacts took in the last step.
    taken: Taken,
    repeated: Repeated,
    /// Between two steps.
    middle: State,
}

/// Steps that are the last one over again, and not yet in the sums.
#[derive(Clone, Copy, Debug, Default)]
struct Repeated {
    times: u64,
    since_s: f64,
}

/// Impacts at one instant, which the law of contact judges as one.
struct Impacts {
    /// None of them yet.
    is_empty: bool,
    before: State,
    contacts: Vec<SolvedContact>,
}

impl Impacts {
    fn add(&mut self, before: &State, contacts: &[SolvedContact]) {
        if std::mem::take(&mut self.is_empty) {
            self.before.copy_from(before);
            self.contacts.clear();
        }
        for more in contacts {
            match self.contacts.iter_mut().find(|known| known.contact.key() == more.contact.key()) {
                Some(known) => known.impulse_W += more.impulse_W,
                None => self.contacts.push(*more),
            }
        }
    }
}

impl Judge {
    pub fn new(model: &Model, start: &State, rules: &Diverge, plan: &Plan) -> Self {
        let mut springs = plan.stiffness_n_m.map(|stiffness_n_m| Springs::new(stiffness_n_m, plan.contacts));
        let bodies = model.bodies.len();
        let is_half_way = plan.approach == Approach::Middle;
        let lasting = is_half_way.then(|| Lasting::at_start(model, start));
        let stored_j = springs.as_mut().map_or(0.0, |springs| springs.stored_j(model, start));
        Judge {
            energy: EnergyLedger::new(model, start, stored_j),
            momentum: MomentumLedger::new(model, start),
            residual: ResidualLedger::new(plan.constraint, plan.newton, bodies, lasting),
            geometry: GeometryLedger::new(model, start, plan.contact),
            contacts_max: 0,
            pin_gap_max_m: model.pin_gap_m(&start.bodies),
            watched: Watched::default(),
            repeats: false,
            divergence: Divergence::new(rules),
            newton: plan.newton,
            driven_pins: model.has_driven_pins(),
            springs,
            moment_s: moment_s(model),
            exchange: Exchange::with_capacity(bodies, plan.contacts),
            dissipation: Dissipation::with_capacity(bodies),
            impacts: Impacts { is_empty: true, before: start.clone(), contacts: Vec::new() },
            squeezed: Squeezed::default(),
            again: (!model.has_loads() && model.pins.is_empty() && plan.stiffness_n_m.is_none())
                .then(|| Again::with_capacity(bodies, plan.contacts)),
            taken: Taken::default(),
            repeated: Repeated::default(),
            middle: start.clone(),
        }
    }

    /// Judges a step; says if the run has diverged, and by which criterion. A step that could not be made is none.
    pub fn observe(&mut self, model: &Model, shown: &Shown) -> Option<Criterion> {
        if shown.stalled.is_some() {
            return None;
        }
        let Shown { before, after, .. } = *shown;
        if !matches!(shown.acted, Acted::Blow { .. }) {
            self.end_instant(model, before);
        }
        self.repeats = self.again.as_ref().is_some_and(|again| again.is(shown, self.geometry.period()));
        if self.repeats {
            self.observe_again(shown);
            return None;
        }
        self.add_repeated(model, before);
        let done = match shown.acted {
            Acted::Kick { kicked, contacts, step_s, approach } => {
                self.observe_kick(model, [before, kicked, after], contacts, (approach, step_s))
            }
            Acted::Blow { contacts } => self.observe_blow(model, [before, after], contacts),
            Acted::Motion(way) => self.observe_motion(model, [before, after], &way.moments(model, [before, after])),
        };
        let stored_j = self.springs.as_mut().map_or(0.0, |springs| springs.stored_j(model, after));
        self.energy.observe(model, after, stored_j, &done);
        self.momentum.observe(model, after, &done, after.time_s - before.time_s);
        let gap_m = model.pin_gap_m(&after.bodies);
        self.pin_gap_max_m = self.pin_gap_max_m.zip(gap_m).map(|(max, gap)| max.max(gap));
        let depth_m = self.geometry.observe(model, shown);
        let diverged = self.divergence.judge(model, after, &self.energy, depth_m);
        if let Some(again) = &mut self.again {
            again.note(shown);
        }
        diverged
    }

    /// Whether steps that repeat the last one may be shown as one that is longer.
    pub fn knows_rest(&self) -> bool {
        self.again.as_ref().is_some_and(|again| again.is_enough(self.geometry.period()))
    }

    /// A step that is the one before over again, or several of them: sums grow by what it added, nothing else is new.
    fn observe_again(&mut self, shown: &Shown) {
        let Acted::Kick { kicked, contacts, step_s, .. } = shown.acted else { return };
        if self.repeated.times == 0 {
            self.repeated.since_s = shown.before.time_s;
        }
        self.repeated.times += shown.after.step.saturating_sub(shown.before.step).max(1);
        self.watched.observe(kicked, contacts);
        self.watched.observe_step(shown.before, shown.after, step_s);
    }

    /// What the steps that were one over and over again added to the sums, all at once: they ended at this state.
    fn add_repeated(&mut self, model: &Model, state: &State) {
        let Repeated { times, since_s } = std::mem::take(&mut self.repeated);
        if times > 0 {
            self.energy.add_taken(&self.taken, times as f64);
            self.momentum.observe_pushes(model, state, &self.exchange.pushes, times as f64);
            self.momentum.observe(model, state, &Done::NOTHING, state.time_s - since_s);
        }
    }

    /// Impulses at the state `kicked`; what loads and driven bodies did.
    fn observe_kick(
        &mut self,
        model: &Model,
        [before, kicked, after]: [&State; 3],
        contacts: &[SolvedContact],
        (approach, step_s): (Approach, f64),
    ) -> Done {
        let mut done =
            work::done(model, [before, after], &mut self.middle, |state| self.momentum.pivot_m(model, state), step_s);
        if !contacts.is_empty() || self.driven_pins {
            self.exchange.look(model, [kicked, after], contacts, Over::Step(step_s));
            self.add_driven(model, kicked, contacts, &mut done);
        }
        if !contacts.is_empty() {
            self.take(contacts, step_s);
            self.momentum.observe_pushes(model, kicked, &self.exchange.pushes, 1.0);
            self.watched.observe(kicked, contacts);
        }
        self.residual.observe(model, contacts, &self.exchange, (approach, step_s));
        if step_s > 0.0 {
            self.watched.observe_step(before, after, step_s);
        }
        self.count(contacts.len());
        done
    }

    /// An impact, which takes no time: `contacts` changed only the velocities.
    fn observe_blow(&mut self, model: &Model, [before, after]: [&State; 2], contacts: &[SolvedContact]) -> Done {
        self.exchange.look(model, [before, after], contacts, Over::Step(0.0));
        self.take(contacts, 0.0);
        let mut done = Done::NOTHING;
        self.add_driven(model, before, contacts, &mut done);
        self.momentum.observe_pushes(model, before, &self.exchange.pushes, 1.0);
        self.watched.observe(before, contacts);
        self.impacts.add(before, contacts);
        self.count(contacts.len());
        done
    }

    /// The impacts of an instant that is over.
    fn end_instant(&mut self, model: &Model, after: &State) {
        if !std::mem::replace(&mut self.impacts.is_empty, true) {
            let Impacts { before, contacts, .. } = &mut self.impacts;
            self.exchange.look(model, [before, after], contacts, Over::Step(0.0));
            for k in self.squeezed.look(model, before.time_s, contacts, &self.exchange.met) {
                contacts[k].contact.restitution = 0.0;
            }
            self.residual.observe(model, contacts, &self.exchange, AT_ONCE);
        }
    }

    /// A smooth motion, of which `moments` show the forces of contact: their weights are those of a quadrature.
    fn observe_motion(&mut self, model: &Model, [before, after]: [&State; 2], moments: &[Moment]) -> Done {
        let mut done = Done::NOTHING;
        for Moment { state, contacts, weight_s } in moments {
            if model.has_loads() {
                done.add_node(model, state, *weight_s, self.momentum.pivot_m(model, state));
            }
            if self.driven_pins {
                done.add_work(pinned::power_w(model, state, contacts) * weight_s);
            }
            if contacts.is_empty() {
                continue;
            }
            // Forces, as impulses that velocities can be held against.
            let over_s = self.moment_s.max(*weight_s);
            let impulse = |force: &ContactForce, over_s: f64| SolvedContact {
                contact: force.contact,
                impulse_W: force.force_W * over_s,
            };
            let longer: Vec<_> = contacts.iter().map(|force| impulse(force, over_s)).collect();
            self.exchange.look(model, [state, state], &longer, Over::Moment(over_s));
            let times = weight_s / over_s;
            self.energy.add_taken(&self.dissipation.of(&self.exchange, &longer, &self.law(0.0)), times);
            self.momentum.observe_pushes(model, state, &self.exchange.pushes, times);
            self.residual.observe(model, &longer, &self.exchange, AT_ONCE);
            let contacts: Vec<_> = contacts.iter().map(|force| impulse(force, *weight_s)).collect();
            done.add_driven(model, state, &contacts);
            self.watched.observe(state, &contacts);
            self.count(contacts.len());
        }
        done.add_constant(model, [before, after]);
        let span_s = after.time_s - before.time_s;
        if span_s > 0.0 {
            self.watched.observe_step(before, after, span_s);
        }
        done
    }

    /// The work of driven bodies in the exchange looked at.
    fn add_driven(&self, model: &Model, state: &State, contacts: &[SolvedContact], done: &mut Done) {
        done.add_driven(model, state, contacts);
        if self.driven_pins {
            done.add_work(pinned::work_of_impulses_j(model, state, &self.exchange));
        }
    }

    fn law(&self, step_s: f64) -> Law {
        let stiffness_n_m = self.springs.as_ref().map_or(0.0, |springs| springs.stiffness_n_m);
        Law { newton: self.newton, spring_n_s_m: stiffness_n_m * step_s }
    }

    /// The energy that the contacts looked at took.
    fn take(&mut self, contacts: &[SolvedContact], step_s: f64) {
        let taken = self.dissipation.of(&self.exchange, contacts, &self.law(step_s));
        self.energy.observe_contacts(&taken, &self.exchange.moved);
        self.taken = taken;
    }

    /// Judges what is left to judge when the run has come to its end: impacts at its last instant.
    pub fn end(&mut self, model: &Model, end: &State) {
        self.add_repeated(model, end);
        self.end_instant(model, end);
    }

    fn count(&mut self, contacts: usize) {
        self.contacts_max = self.contacts_max.max(contacts as u64);
    }
}

fn moment_s(model: &Model) -> f64 {
    let size_m = model.largest_radius_m();
    let g = model.gravity_m_s2.norm();
    if g > 0.0 { 0.01 * (size_m / g).sqrt() } else { 0.0 }
}
