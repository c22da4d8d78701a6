//! What holds from an event on, from event to event: decided, put in place and to rest.

use super::event_driven::{Event, EventDriven, LOCAL, POINTS};
use crate::collide::Contact;
use crate::event::caps::{self, Sinking};
use crate::event::decide::{Change, Decision, Margin, decide, margin};
use crate::event::dense::{Dense, project};
use crate::event::ending::{self, steady};
use crate::event::forces::Solved;
use crate::event::motion::Motion;
use crate::event::settle::{Forces, settle};
use crate::event::touch::Touch;
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector3;

impl EventDriven {
    /// What holds from now on, and how everything moves.
    pub(super) fn regroup(&mut self, model: &Model, state: &mut State, change: &Change) {
        let slow_m_s = if change.slips_on { 0.0 } else { self.slow.fading_m_s() };
        let change = &Change { slow_m_s, ..change.clone() };
        let (mut solved, mut sinking) = (Solved::default(), Sinking::default());
        for _ in 0..POINTS {
            let Some(touches) = self.resting(model, state) else {
                self.trouble = true;
                return;
            };
            if touches.is_empty() && model.pins.is_empty() {
                self.held.clear();
                self.settle(model, state, &Solved::default());
                return;
            }
            match decide(model, state, touches, change, self.gathered.get_mut(), &mut self.work) {
                Decision::Holds(held, forces) => (self.held, solved) = (held, *forces),
                Decision::Jams => {
                    self.next = Event::Jam;
                    return;
                }
                Decision::Unsolved => {
                    self.trouble = true;
                    return;
                }
            }
            if !self.add_sinking(model, state, &solved, &mut sinking) {
                break;
            }
        }
        self.last.begin(self.gathered.get_mut(), self.held.len(), &solved);
        self.kicked.copy_from(state);
        let placed = project(model, state, &self.held, &mut self.placing);
        let gathered = self.gathered.get_mut();
        if placed.moved || self.held.len() != gathered.here.len() {
            // Those of the law, where redundant contacts could share them otherwise.
            Margin { solved, .. } = margin(model, state, &self.held, (gathered, &mut self.last), &mut self.work);
        }
        // However slowly: else that would strike at once, and open again what has been put to rest.
        let is_pushed = ending::pushes(model, [&self.kicked, state], &self.found);
        if is_pushed || ending::changes(model, [&self.kicked, state], ending::NOTHING) {
            self.ending_s = Some(ending::lasts_s(model, (&self.placing, &placed.p), (gathered, &solved)));
        }
        self.steady_W = steady(gathered, &solved, self.held.len());
        self.settle(model, state, &solved);
    }

    /// Adds the point of a cap at rest that would sink, if one would, to what touches.
    fn add_sinking(&mut self, model: &Model, state: &State, solved: &Solved, sinking: &mut Sinking) -> bool {
        let gathered = self.gathered.get_mut();
        if solved.added.is_empty() || gathered.free.is_empty() {
            return false;
        }
        let least = caps::TIPS_AT_LEAST * gathered.free.iter().map(|free| free.v.norm()).fold(0.0, f64::max);
        let rates = |i: usize, arm_W: &Vector3<f64>| {
            let (of, w) = (solved.acceleration(gathered, i), state.bodies[i].w_WB);
            [of.v + of.w.cross(arm_W) + w.cross(&w.cross(arm_W)), of.w]
        };
        let zeno = &self.zeno;
        let rests = |contact: &Contact| !zeno.leaves(model, state, contact);
        sinking.add(model, state, &mut self.found, (3, rests), (rates, |_: &Contact| least))
    }

    /// Of what touches, what does not leave. None: a contact of parts whose motion is not known.
    fn resting(&self, model: &Model, state: &State) -> Option<Vec<Touch>> {
        let mut resting = Vec::new();
        for contact in &self.found {
            if self.zeno.leaves(model, state, contact) {
                continue;
            }
            resting.push(Touch::new(model, state, contact)?);
        }
        Some(resting)
    }

    /// How everything moves from now on.
    fn settle(&mut self, model: &Model, state: &mut State, solved: &Solved) {
        let forces = Forces { gathered: self.gathered.get_mut(), solved };
        self.ends_s = settle(model, state, &self.held, forces, &mut self.motions);
        let is_dense = |i: &usize| matches!(self.motions[*i], Motion::Dense(_));
        let dense: Vec<usize> = (0..model.bodies.len()).filter(is_dense).collect();
        if self.dense.bodies != dense {
            self.dense = Dense::new(model, dense, state, LOCAL * self.tolerance);
        }
    }
}
