//! Where the outline of what lies flat on a cap crosses its rim: an edge or a round side, or the rim of another cap.
//!
//! The point moves along both outlines, however the bodies slide: what a cap bears ends there, and a can that slides
//! over an edge tips when its centre of mass has passed the line between two of them.

use super::rates::{Rates, pair};
use super::two_rims::{Circle, TwoRims};
use crate::collide::Contact;
use crate::event::shown::{Border, Face, Line};
use crate::state::BodyState;
use nalgebra::Vector3;

/// Sine of the angle between two outlines below which their crossing is taken to move no faster: they are as good as
/// tangent, and bear next to each other.
const TANGENT: f64 = 1e-6;

/// Sine of the angle between an edge and a cap's plane up to which it lies there: what turns up over the rim has
/// another normal (`rim_on_edge`, `two_rims`).
pub(super) const LIES: f64 = 1e-8;
/// The same of a round side, to which the contact test gives the rim's normal from so much on (`pair::NEARLY_ROUND`).
const LIES_ROUND: f64 = 2e-6;

/// A cap of a cylinder, from the centre of mass, body axes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Disc {
    pub(super) centre_B: Vector3<f64>,
    pub(super) out_B: Vector3<f64>,
    pub(super) radius_m: f64,
}

impl Disc {
    /// None: the face is not round.
    pub(super) fn of(face: &Face) -> Option<Self> {
        let Border::Round { centre_B, radius_m } = &face.border else { return None };
        let (out_B, radius_m) = (face.normal_B, *radius_m);
        Some(Disc { centre_B: centre_B + out_B * (face.offset_m - out_B.dot(centre_B)), out_B, radius_m })
    }
}

/// What crosses a rim.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Outline {
    Line(Line),
    Rim(Disc),
}

/// A cap of one body, of the first or of the other, and what of the other one crosses its rim.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OnRim {
    pub(super) first: bool,
    cap: Disc,
    outline: Outline,
    /// Which of the two points.
    sign: f64,
}

/// Both outlines at one time.
struct Place {
    /// The point, and the cap's centre.
    p: Vector3<f64>,
    centre: Vector3<f64>,
    /// Outward, of the cap.
    n: Vector3<f64>,
    /// Along the other outline.
    along: Vector3<f64>,
    /// How far the outline goes into the cap, and is from its own end.
    inside_m: f64,
}

impl OnRim {
    /// Of the two points where they cross, the one that was found.
    pub(super) fn new<'a>(
        found: &Contact,
        bodies: &impl Fn(usize) -> &'a BodyState,
        first: bool,
        cap: Disc,
        outline: Outline,
    ) -> Self {
        let mut crossing = OnRim { first, cap, outline, sign: 1.0 };
        let off_m = |crossing: &OnRim| (crossing.place(pair(found, bodies)).p - found.p_WC).norm();
        let there_m = off_m(&crossing);
        crossing.sign = -1.0;
        if there_m <= off_m(&crossing) {
            crossing.sign = 1.0;
        }
        crossing
    }

    /// Of the cap and of the outline.
    fn sides<'a>(&self, [a, b]: [&'a BodyState; 2]) -> [&'a BodyState; 2] {
        if self.first { [a, b] } else { [b, a] }
    }

    fn place(&self, at: [&BodyState; 2]) -> Place {
        let [of_cap, of_other] = self.sides(at);
        let (n, radius_m) = (of_cap.q_WB * self.cap.out_B, self.cap.radius_m);
        let centre = of_cap.p_WB + of_cap.q_WB * self.cap.centre_B;
        let flat = |v: Vector3<f64>| v - n * n.dot(&v);
        match &self.outline {
            Outline::Line(line) => {
                let d = of_other.q_WB * line.direction_B;
                let from = of_other.p_WB + of_other.q_WB * line.point_B - n * line.radius_m;
                let (r, e) = (flat(from - centre), flat(d));
                let middle = -r.dot(&e) / e.norm_squared();
                let foot_m = (r + e * middle).norm();
                let half = ((radius_m - foot_m).max(0.0) * (radius_m + foot_m) / e.norm_squared()).sqrt();
                let s = middle + self.sign * half;
                let inside_m = (radius_m - foot_m).min(s - line.ends_m[0]).min(line.ends_m[1] - s);
                Place { p: from + d * s, centre, n, along: d, inside_m }
            }
            Outline::Rim(cap) => {
                let n_other = of_other.q_WB * cap.out_B;
                let centre_other = of_other.p_WB + of_other.q_WB * cap.centre_B;
                let apart = flat(centre_other - centre);
                let d = apart.norm();
                let toward = if d > 0.0 { apart / d } else { flat(of_cap.q_WB * Vector3::x()).normalize() };
                let x =
                    if d > 0.0 { (d + (radius_m - cap.radius_m) * (radius_m + cap.radius_m) / d) / 2.0 } else { 0.0 };
                let y = ((radius_m - x) * (radius_m + x)).max(0.0).sqrt();
                let on_cap = centre + toward * x.clamp(-radius_m, radius_m) + n.cross(&toward) * (self.sign * y);
                let p = on_cap + n * (n_other.dot(&(centre_other - on_cap)) / n_other.dot(&n));
                let along = n_other.cross(&((p - centre_other) / cap.radius_m));
                let inside_m = (radius_m + cap.radius_m - d).min(d - (radius_m - cap.radius_m).abs());
                Place { p, centre, n, along, inside_m }
            }
        }
    }

    /// Of two rims whose caps are tilted against each other. None: they are not, or the rims are next to tangent.
    fn two_rims(&self, at: [&BodyState; 2], p: &Vector3<f64>) -> Option<TwoRims> {
        let Outline::Rim(other) = &self.outline else { return None };
        let circle = |of: &BodyState, disc: &Disc| Circle {
            centre: of.p_WB + of.q_WB * disc.centre_B,
            axis: of.q_WB * disc.out_B,
            radius_m: disc.radius_m,
        };
        let [of_cap, of_other] = self.sides(at);
        let circles = [circle(of_cap, &self.cap), circle(of_other, other)];
        let tilt = circles[0].axis.cross(&circles[1].axis).norm();
        if tilt <= LIES { None } else { TwoRims::near(circles.each_ref(), p) }
    }

    pub(super) fn inside_m(&self, at: [&BodyState; 2]) -> f64 {
        let Place { p, n, along, inside_m, .. } = self.place(at);
        if let Some(rims) = self.two_rims(at, &p) {
            return rims.inside_m.min(inside_m);
        }
        let Outline::Line(line) = &self.outline else { return inside_m };
        let lies = if line.radius_m > 0.0 { LIES_ROUND } else { LIES };
        inside_m.min((lies - n.dot(&along).abs()) * self.cap.radius_m)
    }

    pub(super) fn here<'a>(&self, found: &Contact, bodies: &impl Fn(usize) -> &'a BodyState) -> (Contact, Rates) {
        let at = pair(found, bodies);
        let [of_cap, of_other] = self.sides(at);
        let Place { p, centre, n, along, .. } = self.place(at);
        if let Some(rims) = self.two_rims(at, &p) {
            return rims.here(found, [of_cap, of_other], self.first);
        }
        let n_rate = of_cap.w_WB.cross(&n);
        let point = |of: &BodyState, p: &Vector3<f64>| of.v_WB + of.w_WB.cross(&(p - of.p_WB));
        let with_other = match &self.outline {
            Outline::Line(line) => point(of_other, &(p + n * line.radius_m)) - n_rate * line.radius_m,
            Outline::Rim(_) => point(of_other, &p),
        };
        let out = (p - centre - n * n.dot(&(p - centre))) / self.cap.radius_m;
        // It stays on the rim.
        let crosses = out.dot(&along);
        let faster = out.dot(&(point(of_cap, &p) - with_other));
        let p_rate = with_other + along * (faster * crosses / (crosses * crosses + TANGENT * TANGENT));
        let sign = if self.first { -1.0 } else { 1.0 };
        let contact = Contact { p_WC: p, normal: n * sign, gap_m: n.dot(&(p - centre)), ..*found };
        (contact, Rates { r_A: p_rate - at[0].v_WB, r_B: p_rate - at[1].v_WB, normal: n_rate * sign })
    }
}
