//! The contact test of a whole state, with its memory.

use super::broad::{Bounds, Broad};
use super::closed::unresolved_m;
use super::{Contact, faces};
use crate::model::surface::Surface;
use crate::model::{Body, Model};
use crate::shape::pair::touches;
use crate::shape::solid::{Meeting, Pose};
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::Vector3;

/// Largest gap of what still is a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Gap that always counts as a contact, of the body's bounding radius: what touches with gap zero is one whatever
    /// its last bit says.
    pub margin: f64,
    /// Time ahead, in seconds: gaps that may close in it are contacts as well.
    pub ahead_s: f64,
}

/// Largest gap that is looked at ahead, of the smaller body's bounding radius. The plane between two bodies stands for
/// their surfaces only nearby; a container's faces are planes.
const NEARBY: f64 = 0.3;

impl Reach {
    /// Reach of what is inside.
    pub const INSIDE: Reach = Reach { margin: 0.0, ahead_s: 0.0 };

    fn margin_m(&self, body: &Body, at: &BodyState) -> f64 {
        if self.margin == 0.0 { 0.0 } else { self.margin * body.bounding_radius_m + unresolved_m(at.p_WB.amax()) }
    }

    /// Length that gravity alone may close in the time, in metres.
    fn fall_m(&self, model: &Model) -> f64 {
        model.gravity_m_s2.norm() * self.ahead_s * self.ahead_s
    }

    fn turning_m(&self, body: &Body, at: &BodyState) -> f64 {
        at.w_WB.norm() * body.bounding_radius_m * self.ahead_s
    }

    fn face_reach_m(&self, model: &Model, body: &Body, at: &BodyState, normal: &Vector3<f64>) -> f64 {
        let margin_m = self.margin_m(body, at);
        if self.ahead_s == 0.0 {
            return margin_m;
        }
        let closing_m = -normal.dot(&at.v_WB) * self.ahead_s;
        margin_m + (closing_m + self.turning_m(body, at) + self.fall_m(model)).max(0.0)
    }

    fn body_reach_m(&self, model: &Model, bodies: [&Body; 2], at: [&BodyState; 2]) -> f64 {
        let [a, b] = [0, 1].map(|i| self.margin_m(bodies[i], at[i]));
        if self.ahead_s == 0.0 {
            return a.max(b);
        }
        let turning_m: f64 = [0, 1].iter().map(|&i| self.turning_m(bodies[i], at[i])).sum();
        let ahead_m = (at[0].v_WB - at[1].v_WB).norm() * self.ahead_s + turning_m + self.fall_m(model);
        a.max(b) + ahead_m.min(NEARBY * bodies[0].bounding_radius_m.min(bodies[1].bounding_radius_m))
    }

    /// Reach around a body, for the search of pairs, in metres; two of them cover `body_reach_m`.
    fn around_m(&self, model: &Model, body: &Body, at: &BodyState) -> f64 {
        let margin_m = self.margin_m(body, at);
        if self.ahead_s == 0.0 {
            return margin_m;
        }
        let ahead_m = at.v_WB.norm() * self.ahead_s + self.turning_m(body, at) + self.fall_m(model);
        margin_m + ahead_m.min(NEARBY * body.bounding_radius_m)
    }
}

/// The memory of a contact test between steps, to spare the allocator.
#[derive(Debug, Default)]
pub struct Detector {
    broad: Broad,
    /// Indices of the bodies with a solid, and their bounds.
    solids: Vec<usize>,
    bounds: Vec<Bounds>,
    pairs: Vec<(u32, u32)>,
    touches: Vec<Meeting>,
}

impl Detector {
    /// Fills `contacts` with all points within reach.
    pub fn detect(
        &mut self,
        model: &Model,
        state: &State,
        reach: &Reach,
        contacts: &mut Vec<Contact>,
        work: &mut Work,
    ) {
        contacts.clear();
        with_container(model, state, reach, contacts, work);
        if model.touching_pairs {
            let found = contacts.len();
            self.with_each_other(model, state, reach, contacts, work);
            if contacts.len() > found {
                contacts.sort_unstable_by_key(Contact::key);
            }
        }
    }

    fn with_each_other(
        &mut self,
        model: &Model,
        state: &State,
        reach: &Reach,
        contacts: &mut Vec<Contact>,
        work: &mut Work,
    ) {
        self.find_pairs(model, state, reach);
        for &(a, b) in &self.pairs {
            let pair = [self.solids[a as usize], self.solids[b as usize]];
            let bodies = pair.map(|i| &model.bodies[i]);
            let at = pair.map(|i| &state.bodies[i]);
            let left_out = (bodies[0].driven && bodies[1].driven) || model.are_pinned(pair);
            let ([Some((solid_a, centre_a)), Some((solid_b, centre_b))], false) = (bodies.map(Body::solid), left_out)
            else {
                continue;
            };
            work.contact_tests += 1;
            self.touches.clear();
            let limit_m = reach.body_reach_m(model, bodies, at);
            touches(solid_a, &pose(centre_a, at[0]), solid_b, &pose(centre_b, at[1]), limit_m, &mut self.touches);
            let Surface { friction, restitution, tangential_restitution } = model.pair(pair[0], Some(pair[1]));
            contacts.extend(self.touches.iter().map(|touch| Contact {
                body: pair[0],
                other: Some(pair[1]),
                feature: touch.feature,
                r_BC_W: touch.p_W - at[0].p_WB,
                r_OC_W: touch.p_W - at[1].p_WB,
                p_WC: touch.p_W,
                normal: touch.normal,
                gap_m: touch.gap_m,
                friction,
                restitution,
                tangential_restitution,
            }));
        }
    }

    fn find_pairs(&mut self, model: &Model, state: &State, reach: &Reach) {
        self.solids.clear();
        self.bounds.clear();
        for (i, (body, at)) in model.bodies.iter().zip(&state.bodies).enumerate() {
            if body.solid().is_some() {
                self.solids.push(i);
                self.bounds.push(Bounds::around(&at.p_WB, body.bounding_radius_m + reach.around_m(model, body, at)));
            }
        }
        self.broad.pairs(&self.bounds, &mut self.pairs);
    }
}

fn with_container(model: &Model, state: &State, reach: &Reach, contacts: &mut Vec<Contact>, work: &mut Work) {
    let Some(container) = &model.container else { return };
    for (index, (body, at)) in model.bodies.iter().zip(&state.bodies).enumerate() {
        if !body.feels_container() {
            continue;
        }
        let Surface { friction, restitution, tangential_restitution } = model.pair(index, None);
        for (f, face) in container.faces.iter().enumerate() {
            let limit_m = reach.face_reach_m(model, body, at, &face.normal);
            work.contact_tests += faces::each_near(body, at, face, limit_m, |node, r_BC_W, gap_m| {
                contacts.push(Contact {
                    body: index,
                    other: None,
                    feature: (f as u32, node),
                    r_BC_W,
                    r_OC_W: Vector3::zeros(),
                    p_WC: at.p_WB + r_BC_W,
                    normal: face.normal,
                    gap_m,
                    friction,
                    restitution,
                    tangential_restitution,
                });
            });
        }
    }
}

fn pose(centre: &Vector3<f64>, at: &BodyState) -> Pose {
    Pose { p_W: at.p_WB + at.q_WB * centre, q_W: at.q_WB }
}

/// The contact whose point is deepest, the first of equals; none if nothing is inside anything.
pub fn deepest(model: &Model, state: &State) -> Option<Contact> {
    let mut contacts = Vec::new();
    Detector::default().detect(model, state, &Reach::INSIDE, &mut contacts, &mut Work::default());
    let deeper = |a: Contact, b: Contact| if b.gap_m < a.gap_m { b } else { a };
    contacts.into_iter().reduce(deeper)
}
