//! The contact test of a whole state, with its memory.

use super::ahead::Ahead;
use super::broad::{Bounds, Broad};
use super::doubt::Doubts;
use super::limits::{Limits, Reach};
use super::two::of_pair;
use super::{Contact, faces};
use crate::experiment::types::Skip;
use crate::model::surface::Surface;
use crate::model::{Body, Model, pose_of_solid};
use crate::shape::pair::{Apart, touches};
use crate::shape::solid::Meeting;
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;

/// A reach, of the bodies as they stand.
struct Here<'a> {
    reach: &'a Reach,
    model: &'a Model,
    state: &'a State,
}

impl Limits for Here<'_> {
    fn face_m(&self, body: usize, _: &Vector3<f64>) -> f64 {
        self.around_m(body)
    }

    fn pair_m(&self, pair: [usize; 2]) -> f64 {
        let [a, b] = pair.map(|i| self.around_m(i));
        a.max(b)
    }

    fn around_m(&self, body: usize) -> f64 {
        self.reach.margin_m(&self.model.bodies[body], &self.state.bodies[body])
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
        let limits = Here { reach, model, state };
        with_container(model, state, &limits, contacts, work);
        let found = contacts.len();
        self.each_pair(model, state, &limits, work, |pair, touches, _, _| {
            contacts.extend(touches.iter().map(|touch| of_pair(model, state, pair, touch)));
        });
        if contacts.len() > found {
            contacts.sort_unstable_by_key(Contact::key);
        }
    }

    /// Fills `contacts` with all points that the bodies may reach in a step, but for those of pairs in doubt
    /// (`doubt.rs`), which go to `doubts`.
    pub fn look_ahead(
        &mut self,
        model: &Model,
        state: &State,
        ahead: &Ahead,
        (contacts, doubts): (&mut Vec<Contact>, &mut Doubts),
        work: &mut Work,
    ) {
        contacts.clear();
        doubts.clear();
        with_container(model, state, ahead, contacts, work);
        let found = contacts.len();
        self.each_pair(model, state, ahead, work, |pair, touches, apart, limit_m| {
            if let Some(apart) = apart.filter(|apart| apart.gap_m < limit_m) {
                let points = || touches.iter().map(|touch| of_pair(model, state, pair, touch));
                if !doubts.take(model, (pair, &state.bodies[pair[0]], &apart), limit_m, points()) {
                    contacts.extend(points());
                }
            }
        });
        if contacts.len() > found {
            contacts.sort_unstable_by_key(Contact::key);
        }
    }

    /// Calls `visit` with the bodies, their points within the limit, how far apart they are, and the limit.
    fn each_pair(
        &mut self,
        model: &Model,
        state: &State,
        limits: &impl Limits,
        work: &mut Work,
        mut visit: impl FnMut([usize; 2], &[Meeting], Option<Apart>, f64),
    ) {
        if !model.touching_pairs {
            return;
        }
        self.find_pairs(model, state, limits);
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
            let limit_m = limits.pair_m(pair);
            let (pose_a, pose_b) = (pose_of_solid(centre_a, at[0]), pose_of_solid(centre_b, at[1]));
            let apart = touches(solid_a, &pose_a, solid_b, &pose_b, limit_m, &mut self.touches);
            visit(pair, &self.touches, apart, limit_m);
        }
    }

    fn find_pairs(&mut self, model: &Model, state: &State, limits: &impl Limits) {
        self.solids.clear();
        self.bounds.clear();
        for (i, (body, at)) in model.bodies.iter().zip(&state.bodies).enumerate() {
            if body.solid().is_some() {
                self.solids.push(i);
                self.bounds.push(Bounds::around(&at.p_WB, body.bounding_radius_m + limits.around_m(i)));
            }
        }
        if model.skips.has(Skip::Bounds) {
            return self.broad.pairs(&self.bounds, &mut self.pairs);
        }
        let count = self.solids.len() as u32;
        self.pairs.clear();
        self.pairs.extend((0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j))));
    }
}

fn with_container(model: &Model, state: &State, limits: &impl Limits, contacts: &mut Vec<Contact>, work: &mut Work) {
    let Some(container) = &model.container else { return };
    for (index, (body, at)) in model.bodies.iter().zip(&state.bodies).enumerate() {
        if !body.feels_container() {
            continue;
        }
        let Surface { friction, restitution, tangential_restitution } = model.pair(index, None);
        for (f, face) in container.faces.iter().enumerate() {
            let limit_m = limits.face_m(index, &face.normal);
            let visit = |node, r_BC_W: Vector3<f64>, gap_m| {
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
            };
            work.contact_tests += match model.skips.has(Skip::Bounds) {
                true => faces::each_near(body, at, face, limit_m, visit),
                false => faces::each_of_all(body, at, face, limit_m, visit),
            };
        }
    }
}

/// The contact whose point is deepest, the first of equals; none if nothing is inside anything.
pub fn deepest(model: &Model, state: &State) -> Option<Contact> {
    let mut contacts = Vec::new();
    Detector::default().detect(model, state, &Reach::INSIDE, &mut contacts, &mut Work::default());
    let deeper = |a: Contact, b: Contact| if b.gap_m < a.gap_m { b } else { a };
    contacts.into_iter().reduce(deeper)
}
