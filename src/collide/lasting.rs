//! Contacts that last: closed with an impulse in the last step, or closed and at rest at the start of a run.
//!
//! Steps whose kick is half-way hold them in the mean of the velocities before and after the kick (`approach`). Methods
//! and judges tell them alike, each from what it knows of the last step.

use super::closed::{MARGIN, is_closed_to_rounding};
use super::{Contact, Detector, Key, Reach};
use crate::model::Model;
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;

/// Of the greatest friction: what is below it sticks.
const STUCK: f64 = 1.0 - 1e-9;

/// Of the speed of the contact's points: what is below it does not open or close, or slip.
const NO_SPEED: f64 = 1e-9;

/// What friction did in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    Stuck,
    /// With this slip after the kick, in m/s, world axes.
    Slid(Vector3<f64>),
}

impl Hold {
    /// Of a normal impulse, the size of the tangential one, and the velocity of the body's point against the other's
    /// after them; none: it does not press.
    pub fn of(contact: &Contact, normal: f64, tangential: f64, after_W: &Vector3<f64>) -> Option<Hold> {
        let slid = contact.friction > 0.0 && tangential >= STUCK * contact.friction * normal;
        (normal > 0.0).then(|| if slid { Hold::Slid(along(contact, after_W)) } else { Hold::Stuck })
    }
}

/// The part of a vector along the surface.
fn along(contact: &Contact, v: &Vector3<f64>) -> Vector3<f64> {
    v - contact.normal * contact.normal.dot(v)
}

/// Contacts that last, by their names.
#[derive(Clone, Debug, Default)]
pub struct Lasting {
    /// In the order of contacts.
    known: Vec<(Key, Hold)>,
}

impl Lasting {
    /// What is closed at the start of a run and neither opens nor closes.
    pub fn at_start(model: &Model, start: &State) -> Self {
        let mut contacts = Vec::new();
        let reach = Reach { margin: MARGIN };
        Detector::default().detect(model, start, &reach, &mut contacts, &mut Work::default());
        let held = |contact: &Contact| {
            let of = |i: usize| [start.bodies[i].v_WB, start.bodies[i].w_WB];
            let u = contact.velocity(of);
            let speed = |(i, r_W, _): (usize, Vector3<f64>, f64)| of(i)[0].norm() + of(i)[1].norm() * r_W.norm();
            let small = NO_SPEED * contact.ends().map(speed).sum::<f64>();
            let normal = contact.normal.dot(&u);
            let slip_W = along(contact, &u);
            let hold = if slip_W.norm() > small { Hold::Slid(slip_W) } else { Hold::Stuck };
            let lasts = is_closed_to_rounding(model, contact) && normal.abs() <= small;
            lasts.then(|| (contact.key(), hold))
        };
        let mut lasting = Lasting { known: contacts.iter().filter_map(held).collect() };
        lasting.sort();
        lasting
    }

    /// What friction did where the contact lasts.
    pub fn of(&self, contact: &Contact) -> Option<Hold> {
        let key = contact.key();
        self.known.binary_search_by_key(&key, |(known, _)| *known).ok().map(|at| self.known[at].1)
    }

    /// Takes these in place of what was known.
    pub fn renew(&mut self, lasting: impl Iterator<Item = (Key, Hold)>) {
        self.known.clear();
        self.known.extend(lasting);
        self.sort();
    }

    fn sort(&mut self) {
        self.known.sort_unstable_by_key(|(key, _)| *key);
    }
}
