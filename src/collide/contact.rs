//! One point of contact.

use crate::model::pins::Anchor;
use crate::model::{Body, Model};
use crate::shape::solid::Meeting;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// What a body touches or is pinned to: a face of the container by its place, a body by its index, or a point of the
/// world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partner {
    Face(u32),
    Body(usize),
    World,
}

/// What pins hold a body to.
pub fn pinned_to(model: &Model, body: usize) -> impl Iterator<Item = Partner> {
    model.pins.iter().filter_map(move |pin| match pin.anchor {
        Anchor::World(_) => (pin.body == body).then_some(Partner::World),
        Anchor::Body(other, _) if pin.body == body => Some(Partner::Body(other)),
        Anchor::Body(other, _) => (other == body).then_some(Partner::Body(pin.body)),
    })
}

/// One point of contact of a body with the container or with another body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    pub body: usize,
    /// Index of the other body, higher than `body`; None for the container.
    pub other: Option<usize>,
    /// Face and node, or the features of the two bodies that meet: the same from step to step, to find last step's
    /// impulse by.
    pub feature: (u32, u32),
    /// Lever arm from the body's centre of mass to the point, in metres, world axes (the lecture's ᴳu_c).
    pub r_BC_W: Vector3<f64>,
    /// Lever arm from the other body's centre of mass to the same point; zero for the container.
    pub r_OC_W: Vector3<f64>,
    pub p_WC: Vector3<f64>,
    /// Unit normal from the container or the other body to the body, world axes.
    pub normal: Vector3<f64>,
    pub gap_m: f64,
    pub friction: f64,
    pub restitution: f64,
    pub tangential_restitution: f64,
}

impl Contact {
    /// Contact of the same bodies and surfaces at another point where the bodies meet, in these states.
    pub fn meeting(&self, point: &Meeting, at: [&BodyState; 2]) -> Self {
        Contact {
            feature: point.feature,
            r_BC_W: point.p_W - at[0].p_WB,
            r_OC_W: point.p_W - at[1].p_WB,
            p_WC: point.p_W,
            normal: point.normal,
            gap_m: point.gap_m,
            ..*self
        }
    }

    /// Where the two meet.
    pub fn point(&self) -> Meeting {
        Meeting { p_W: self.p_WC, normal: self.normal, gap_m: self.gap_m, feature: self.feature }
    }

    /// Place of the contact in the order of contacts, and its name from step to step.
    pub fn key(&self) -> Key {
        (self.body, self.other, self.feature)
    }

    /// Bodies that the contact pushes: index, lever arm in world axes, and sign of the impulse.
    pub fn ends(&self) -> impl Iterator<Item = (usize, Vector3<f64>, f64)> {
        let other = self.other.map(|other| (other, self.r_OC_W, -1.0));
        std::iter::once((self.body, self.r_BC_W, 1.0)).chain(other)
    }

    /// Its two bodies, where they are; None: it is of one and the container.
    pub fn both<'a>(&self, model: &'a Model, state: &'a State) -> Option<[(&'a Body, &'a BodyState); 2]> {
        Some([self.body, self.other?].map(|i| (&model.bodies[i], &state.bodies[i])))
    }

    /// Whether it and another contact push a body that they share, and that forces move, against each other.
    pub fn pushes_against(&self, other: &Contact, model: &Model) -> bool {
        self.ends().filter(|(i, ..)| !model.bodies[*i].driven).any(|(i, _, sign)| {
            let facing = |other_sign: f64| sign * other_sign * self.normal.dot(&other.normal) < 0.0;
            other.ends().any(|(j, _, other_sign)| i == j && facing(other_sign))
        })
    }

    /// What a body that the contact pushes touches there.
    pub fn partner_of(&self, body: usize) -> Partner {
        match self.other {
            None => Partner::Face(self.feature.0),
            Some(other) => Partner::Body(if body == self.body { other } else { self.body }),
        }
    }

    /// Whether it is held against what nothing moves.
    pub fn is_fixed(&self, model: &Model) -> bool {
        self.other.is_none_or(|other| model.bodies[other].driven) || model.bodies[self.body].driven
    }

    /// Velocity of the body's point against the other's, in m/s, world axes, from the bodies' velocities and angular
    /// velocities by their index.
    pub fn velocity(&self, of: impl Fn(usize) -> [Vector3<f64>; 2]) -> Vector3<f64> {
        let of_point = |i: usize, r_W: &Vector3<f64>| {
            let [v, w] = of(i);
            v + w.cross(r_W)
        };
        let own = of_point(self.body, &self.r_BC_W);
        self.other.map_or(own, |other| own - of_point(other, &self.r_OC_W))
    }

    /// Axes of the contact: e₁ = n and two tangents; for the faces of a box the tangents are the other coordinate axes.
    pub fn frame(&self) -> [Vector3<f64>; 3] {
        let normal = self.normal;
        let least = normal.iamin();
        let along = Vector3::ith(least, 1.0);
        let t1 = (along - normal * normal[least]).normalize();
        [normal, t1, normal.cross(&t1)]
    }
}

/// Key of a contact: body, other body, feature.
pub type Key = (usize, Option<usize>, (u32, u32));

/// A contact of the last step and the impulse that it put on its body, in N s, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolvedContact {
    pub contact: Contact,
    pub impulse_W: Vector3<f64>,
}
