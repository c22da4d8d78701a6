//! The rim of a cap that is next to flat, and an edge that crosses it.
//!
//! Their normal is across both, n ∥ t × e with t the rim's tangent at the crossing and e the edge. Where the cap is
//! nearly along the edge, the normal hardly tells which point of the rim it is (`curved`), but the point tells the
//! normal: it is where the distance of the rim from the edge is stationary, t·w = 0 with w from the edge, across it, to
//! the rim.

use super::crossing::Disc;
use super::rates::{Rates, pair};
use crate::collide::Contact;
use crate::event::shown::{Line, within_m};
use crate::state::BodyState;
use nalgebra::Vector3;

/// The rim of one body, of the first or of the other, and an edge of the other one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RimOnEdge {
    first: bool,
    centre_B: Vector3<f64>,
    /// Out of the cap.
    out_B: Vector3<f64>,
    radius_m: f64,
    /// From the centre, where it was found.
    toward_B: Vector3<f64>,
    edge: Line,
}

/// Steps to the point of the rim, which is known nearly.
const STEPS: u32 = 20;

/// Sine of the angle between the two below which their crossing is taken to move no faster: they are as good as
/// tangent.
const TANGENT: f64 = 1e-6;

/// Both at one time.
struct Crosses {
    /// From the centre of the cap to the point (unit), and along the rim there.
    toward: Vector3<f64>,
    t: Vector3<f64>,
    /// Along the edge.
    e: Vector3<f64>,
    /// The point of the rim, and from the nearest of the edge to it.
    x: Vector3<f64>,
    w: Vector3<f64>,
    /// Out of the rim; its length before it is made one, with its sign.
    out: Vector3<f64>,
    length: f64,
    inside_m: f64,
}

impl Crosses {
    /// t across the edge.
    fn crossing(&self) -> Vector3<f64> {
        self.t - self.e * self.e.dot(&self.t)
    }
}

impl RimOnEdge {
    /// None: the point is at the centre of the cap.
    pub(super) fn new<'a>(
        found: &Contact,
        bodies: &impl Fn(usize) -> &'a BodyState,
        first: bool,
        Disc { centre_B, out_B, radius_m }: Disc,
        edge: Line,
    ) -> Option<Self> {
        let [a, b] = pair(found, bodies);
        let of_rim = if first { a } else { b };
        let from_B = of_rim.q_WB.inverse_transform_vector(&(found.p_WC - of_rim.p_WB)) - centre_B;
        let toward_B = (from_B - out_B * out_B.dot(&from_B)).try_normalize(0.0)?;
        Some(RimOnEdge { first, centre_B, out_B, radius_m, toward_B, edge })
    }

    /// The same at the other point where they cross.
    pub(super) fn other(&self, at: [&BodyState; 2]) -> Self {
        let [of_rim, of_edge] = self.sides(at);
        let Crosses { toward, .. } = self.place(at);
        let e_B = of_rim.q_WB.inverse_transform_vector(&(of_edge.q_WB * self.edge.direction_B));
        let along_B = (e_B - self.out_B * self.out_B.dot(&e_B)).normalize();
        let toward_B = of_rim.q_WB.inverse_transform_vector(&toward);
        RimOnEdge { toward_B: toward_B - along_B * (2.0 * along_B.dot(&toward_B)), ..self.clone() }
    }

    /// Whether the edge crosses the rim twice: it is nearer to the cap than to its axis.
    pub(super) fn lies(&self, at: [&BodyState; 2]) -> bool {
        let [of_rim, of_edge] = self.sides(at);
        let along = (of_rim.q_WB * self.out_B).dot(&(of_edge.q_WB * self.edge.direction_B));
        along.abs() < std::f64::consts::FRAC_1_SQRT_2
    }

    /// Of the rim and of the edge.
    fn sides<'a>(&self, [a, b]: [&'a BodyState; 2]) -> [&'a BodyState; 2] {
        if self.first { [a, b] } else { [b, a] }
    }

    fn place(&self, at: [&BodyState; 2]) -> Crosses {
        let [of_rim, of_edge] = self.sides(at);
        let (axis, radius_m) = (of_rim.q_WB * self.out_B, self.radius_m);
        let centre = of_rim.p_WB + of_rim.q_WB * self.centre_B;
        let (e, q) = (of_edge.q_WB * self.edge.direction_B, of_edge.p_WB + of_edge.q_WB * self.edge.point_B);
        let off = |toward: &Vector3<f64>| {
            let from = centre - q + toward * radius_m;
            (axis.cross(toward), from - e * e.dot(&from))
        };
        let mut toward = of_rim.q_WB * self.toward_B;
        for _ in 0..STEPS {
            let (t, w) = off(&toward);
            let crossing = t - e * e.dot(&t);
            let angle = -t.dot(&w) / (radius_m * (crossing.norm_squared() + TANGENT * TANGENT));
            let (sin, cos) = libm::sincos(angle.clamp(-0.5, 0.5));
            toward = (toward * cos + t * sin).normalize();
            if angle.abs() <= f64::EPSILON {
                break;
            }
        }
        let (t, w) = off(&toward);
        let across = t.cross(&e);
        // Out of a rim is what is between its cap's normal and outward.
        let length = across.norm().copysign(across.dot(&(axis + toward)));
        let out = across / length;
        let x = centre + toward * radius_m;
        let s = e.dot(&(x - q));
        let out_of_edge_B = of_edge.q_WB.inverse_transform_vector(&-out);
        let inside_m = (s - self.edge.ends_m[0])
            .min(self.edge.ends_m[1] - s)
            .min(within_m(&self.edge.cone, &(out_of_edge_B * radius_m)))
            .min(out.dot(&axis).min(out.dot(&toward)) * radius_m);
        Crosses { toward, t, e, x, w, out, length, inside_m }
    }

    /// Of the angle between the two.
    pub(super) fn sine(&self, at: [&BodyState; 2]) -> f64 {
        self.place(at).crossing().norm()
    }

    pub(super) fn inside_m(&self, at: [&BodyState; 2]) -> f64 {
        self.place(at).inside_m
    }

    pub(super) fn here<'a>(&self, found: &Contact, bodies: &impl Fn(usize) -> &'a BodyState) -> (Contact, Rates) {
        let at = pair(found, bodies);
        let [of_rim, of_edge] = self.sides(at);
        let place = self.place(at);
        let Crosses { toward, t, e, x, w, out, length, .. } = &place;
        let velocity = |of: &BodyState, p: Vector3<f64>| of.v_WB + of.w_WB.cross(&(p - of.p_WB));
        let u = velocity(of_rim, *x) - velocity(of_edge, x - w);
        let (t_turns, e_rate, crossing) = (of_rim.w_WB.cross(t), of_edge.w_WB.cross(e), place.crossing());
        // d/dt t·w = 0, w staying across the edge.
        let leaves = t_turns.dot(w) + crossing.dot(&u) - t.dot(e) * e_rate.dot(w);
        let holds_m = self.radius_m * (crossing.norm_squared() + TANGENT * TANGENT) - toward.dot(w);
        let along_rad_s = -leaves / holds_m;
        let x_rate = velocity(of_rim, *x) + t * (along_rad_s * self.radius_m);
        let apart = x_rate - velocity(of_edge, x - w);
        let w_rate = apart - e * (e.dot(&apart) + e_rate.dot(w));
        let across_rate = (t_turns - toward * along_rad_s).cross(e) + t.cross(&e_rate);
        let out_rate = (across_rate - out * out.dot(&across_rate)) / *length;
        let sign = if self.first { -1.0 } else { 1.0 };
        let contact = Contact { p_WC: x - w * 0.5, normal: out * sign, gap_m: -out.dot(w), ..*found };
        let rates = if self.first { [x_rate, x_rate - w_rate] } else { [x_rate - w_rate, x_rate] };
        let [r_A, r_B] = [rates[0] - at[0].v_WB, rates[1] - at[1].v_WB];
        (contact, Rates { r_A, r_B, normal: out_rate * sign })
    }
}
