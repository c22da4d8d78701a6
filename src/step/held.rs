//! What holds a body that something strikes.
//!
//! The step's forces act in an impact's step as in any other (`Approach::least`): a ball that comes back from a floor
//! has fallen for that step. Of two bodies what counts is by how much forces move one against the other, and one that
//! others hold up they do not move: if a ball that comes back from it had not fallen for the step either, it would gain
//! m g Δt v. So a body that a pin holds, or a contact without an impact and with something else than what strikes it,
//! as it did in the last step, is moved as it was then. If that contact opens by the impact, nothing has held the body,
//! and the step is solved again. What strikes is decided by the forces alone.

use super::blow::normal_motion;
use super::scratch::Scratch;
use crate::collide::approach::Approach;
use crate::collide::{Contact, Partner, pinned_to};
use crate::model::Model;
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};

/// Of what forces do in a step: what they do to a body that is held, at most, as one that pivots does. More is an
/// impact of the last step.
const MOST: f64 = 3.0;

/// What moves a body that is held.
#[derive(Clone, Copy, Debug)]
struct Moves {
    moved: Twist,
    /// What holds it; none: several things do.
    by: Option<Partner>,
}

impl Moves {
    /// Whether something else than this holds the body.
    fn is_held_beside(&self, partner: Partner) -> bool {
        self.by != Some(partner)
    }
}

/// Bodies that are held, in a step as far as it is solved.
#[derive(Debug, Default)]
pub(super) struct Held {
    /// The bodies before the last step, and its length; 0: it was none of the clock's.
    earlier: Vec<BodyState>,
    made_s: f64,
    /// Of every body: what holds it has opened.
    is_let_go: Vec<bool>,
    /// Of every body that something holds: what the forces of the step and that do to it.
    moves: Vec<Option<Moves>>,
    /// Of every contact: it has an impact.
    strikes: Vec<bool>,
}

impl Held {
    /// With room for so many bodies and contacts, so that no step allocates.
    pub(super) fn with_capacity(bodies: usize, contacts: usize) -> Self {
        Held {
            earlier: Vec::with_capacity(bodies),
            made_s: 0.0,
            is_let_go: Vec::with_capacity(bodies),
            moves: Vec::with_capacity(bodies),
            strikes: Vec::with_capacity(contacts),
        }
    }

    /// Takes where the last step began, and its length.
    pub(super) fn begin(&mut self, earlier: &mut Vec<BodyState>, made_s: f64) {
        std::mem::swap(&mut self.earlier, earlier);
        self.made_s = made_s;
        self.is_let_go.clear();
        self.is_let_go.resize(self.earlier.len(), false);
    }

    /// Asks contacts that rebound for what the bodies do that others hold. `contacts`: as they are asked for; the
    /// impulses in `scratch` are those of the last step.
    pub(super) fn ask(
        &mut self,
        model: &Model,
        state: &State,
        scratch: &mut Scratch,
        contacts: Option<&[Contact]>,
        step_s: f64,
    ) {
        let Scratch { found, problem, free, impulses, .. } = scratch;
        let contacts = contacts.unwrap_or(found);
        let Held { earlier, made_s, is_let_go, moves, strikes } = self;
        moves.clear();
        strikes.clear();
        if *made_s != step_s || contacts.iter().all(|contact| contact.restitution == 0.0) {
            return;
        }
        strikes.extend(contacts.iter().map(|contact| {
            let motion = normal_motion(contact, state, free);
            contact.restitution > 0.0 && Approach::Start.strikes(model, contact, motion, step_s)
        }));
        if !strikes.contains(&true) {
            return;
        }
        moves.resize(model.bodies.len(), None);
        let change = |i: usize| {
            let (now, free) = (&state.bodies[i], &free[i]);
            Twist { v: free.v - now.v_WB, w: free.w - now.w_WB }
        };
        let speed = |i: usize, u: &Twist| u.v.norm() + u.w.norm() * model.bodies[i].bounding_radius_m;
        // Unless it was moved by more than forces do: by an impact of the last step.
        let mut hold = |i: usize, partner: Partner| {
            let (now, before, change) = (&state.bodies[i], &earlier[i], change(i));
            // What holds a body holds it against the forces; what has sent it aside may have been an impact.
            let along = change.v.try_normalize(0.0).unwrap_or_default();
            let moved = Twist { v: along * along.dot(&(now.v_WB - before.v_WB)), w: now.w_WB - before.w_WB };
            if speed(i, &moved) <= MOST * speed(i, &change) {
                let by = Some(partner).filter(|by| moves[i].is_none_or(|moves| moves.by == Some(*by)));
                moves[i] = Some(Moves { moved, by });
            }
        };
        if !model.pins.is_empty() {
            for i in 0..model.bodies.len() {
                pinned_to(model, i).for_each(|partner| hold(i, partner));
            }
        }
        let lasts = contacts.iter().zip(&*strikes).zip(&*impulses).filter(|((_, strikes), p)| !**strikes && p.x > 0.0);
        for ((contact, _), _) in lasts {
            let opens = normal_motion(contact, state, free).before;
            for (i, ..) in contact.ends().filter(|(i, ..)| !is_let_go[*i]) {
                let forced = speed(i, &change(i));
                // Bodies on each other fall alike: their gap need not close by the forces.
                if opens < forced && contact.gap_m < step_s * forced {
                    hold(i, contact.partner_of(i));
                }
            }
        }
        for ((contact, block), _) in contacts.iter().zip(&mut problem.blocks).zip(&*strikes).filter(|(_, is)| **is) {
            let held = |i: usize| moves[i].filter(|moves| moves.is_held_beside(contact.partner_of(i)));
            if contact.ends().all(|(i, ..)| held(i).is_none()) {
                continue;
            }
            let gained = contact.normal.dot(&contact.velocity(|i| {
                let at = &state.bodies[i];
                held(i).map_or([free[i].v - at.v_WB, free[i].w - at.w_WB], |Moves { moved, .. }| [moved.v, moved.w])
            }));
            // An impact is one by the forces that act; what they take of its rebound is what they move.
            block.hold_at(contact, model, gained, step_s);
        }
    }

    /// Whether something has opened that held a body: the impulses in `scratch` are to be found again.
    pub(super) fn revise(&mut self, model: &Model, scratch: &Scratch) -> bool {
        let Held { is_let_go, moves, strikes, .. } = self;
        let of = |i: usize, strike: bool| {
            let solved = scratch.found.iter().zip(&scratch.impulses).zip(&*strikes);
            let own = solved
                .filter(move |((contact, _), strikes)| **strikes == strike && contact.ends().any(|(end, ..)| end == i));
            own.map(|(solved, _)| solved)
        };
        let mut any = false;
        for (i, held) in moves.iter().enumerate().filter_map(|(i, moves)| Some((i, (*moves)?))) {
            let is_held_beside = |by: Partner| {
                of(i, false).any(|(contact, p)| p.x > 0.0 && contact.partner_of(i) != by)
                    || pinned_to(model, i).any(|partner| partner != by)
            };
            let mut struck_by = of(i, true).map(|(contact, _)| contact.partner_of(i));
            if !model.bodies[i].driven && struck_by.any(|by| held.is_held_beside(by) && !is_held_beside(by)) {
                is_let_go[i] = true;
                any = true;
            }
        }
        any
    }
}
