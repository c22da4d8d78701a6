//! A part of one body on a plane of the other, or of the container: the point of it that is farthest down.

use super::rates::Rates;
use crate::collide::Contact;
use crate::event::shown::{Ball, Border, Part};
use crate::state::BodyState;
use nalgebra::Vector3;

/// n·x ≥ offset is free: of the world, or in a body's axes about its centre of mass.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) of: Option<usize>,
    pub(super) normal: Vector3<f64>,
    pub(super) offset_m: f64,
    pub(super) border: Border,
}

pub(super) fn here<'a>(
    found: &Contact,
    bodies: &impl Fn(usize) -> &'a BodyState,
    of: usize,
    part: &Part,
    plane: &Plane,
) -> (Contact, Rates) {
    let at = bodies(of);
    let base = plane.of.map(bodies);
    let zero = Vector3::zeros();
    let w_plane = base.map_or(zero, |base| base.w_WB);
    let normal = base.map_or(plane.normal, |base| base.q_WB * plane.normal);
    let normal_rate = w_plane.cross(&normal);
    let (r, r_rate) = part.farthest(at, &-normal, &-normal_rate);
    let point = at.p_WB + r;
    let gap_m = normal.dot(&(point - base.map_or(zero, |base| base.p_WB))) - plane.offset_m;
    let base_rate = at.v_WB + r_rate - base.map_or(zero, |base| base.v_WB);
    let own = of == found.body;
    let (sign, r_A, r_B) = if own { (1.0, r_rate, base_rate) } else { (-1.0, base_rate, r_rate) };
    let contact = Contact { p_WC: point, normal: normal * sign, gap_m, ..*found };
    (contact, Rates { r_A, r_B, normal: normal_rate * sign })
}

impl Part {
    /// The point farthest along d (unit), from the centre of mass, world axes; and its rate.
    fn farthest(&self, at: &BodyState, d: &Vector3<f64>, d_rate: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let with_body = |r: Vector3<f64>| at.w_WB.cross(&r);
        match self {
            Part::Ball(Ball { centre_B, radius_m, .. }) => {
                let arm = at.q_WB * centre_B;
                (arm + d * *radius_m, with_body(arm) + d_rate * *radius_m)
            }
            Part::Rim { centre_B, axis_B, radius_m } => {
                let (arm, axis) = (at.q_WB * centre_B, at.q_WB * axis_B);
                let axis_rate = with_body(axis);
                let along = axis.dot(d);
                let radial = d - axis * along;
                let length = radial.norm();
                let radial_rate = d_rate - axis_rate * along - axis * (axis_rate.dot(d) + axis.dot(d_rate));
                // Across the axis to rounding, however little of d is.
                let across = radial - axis * axis.dot(&radial);
                // All of a rim that is flat is as far: its middle stands for it.
                let Some(u) = across.try_normalize(0.0) else { return (arm, with_body(arm)) };
                let aside = axis.cross(&u);
                let u_rate = aside * (aside.dot(&radial_rate) / length) - axis * u.dot(&axis_rate);
                (arm + u * *radius_m, with_body(arm) + u_rate * *radius_m)
            }
            Part::Ellipsoid { centre_B, semi_axes_m } => {
                let d_B = at.q_WB.inverse_transform_vector(d);
                let d_rate_B = at.q_WB.inverse_transform_vector(&(d_rate - with_body(*d)));
                let squares = semi_axes_m.component_mul(semi_axes_m);
                let (s, s_rate) = (squares.component_mul(&d_B), squares.component_mul(&d_rate_B));
                let h = semi_axes_m.component_mul(&d_B).norm();
                let u_B = s / h;
                let u_rate_B = s_rate / h - s * (s.dot(&d_rate_B) / (h * h * h));
                let r = at.q_WB * (centre_B + u_B);
                (r, with_body(r) + at.q_WB * u_rate_B)
            }
        }
    }
}
