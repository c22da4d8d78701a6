//! When a gap is none: two bounds, for two ways to come to a contact.
//!
//! Steps of equal length never look for the moment at which a gap closes, and find a contact wherever rounding has put
//! it: 1e-12 of the smaller body is closed to them. From event to event a gap is followed down to δ, 1e-13 of the body:
//! the search ends within δ, and the projection of what is held likewise, so that what is within some δ is closed, and
//! what is farther is yet to come.

use super::Contact;
use crate::model::Model;

/// Gaps that are closed for steps of equal length, of the smaller body's bounding radius.
const CLOSED: f64 = 1e-12;

/// δ, of the body's bounding radius; and how many δ what was searched for, or put in place, is away at most.
const DELTA: f64 = 1e-13;
pub const SOME: f64 = 20.0;

/// Of a coordinate: what a gap that is its difference from another cannot tell from zero.
const ULPS: f64 = 8.0 * f64::EPSILON;

/// Margin of the contact test, of the bounding radius: a body that rests at gap zero is seen whatever its last bit
/// says.
pub const MARGIN: f64 = 1e-9;

/// What the coordinates of a point cannot resolve.
pub fn unresolved_m(coordinate_m: f64) -> f64 {
    ULPS * coordinate_m
}

/// Bounding radius of the smaller body.
pub fn size_m(model: &Model, contact: &Contact) -> f64 {
    contact.ends().map(|(i, ..)| model.bodies[i].bounding_radius_m).fold(f64::INFINITY, f64::min)
}

/// A gap that is none for steps of equal length.
pub fn rounding_m(model: &Model, contact: &Contact) -> f64 {
    closed_m(size_m(model, contact), contact.p_WC.amax())
}

/// The same of a body of this size, at such a coordinate.
pub fn closed_m(radius_m: f64, coordinate_m: f64) -> f64 {
    CLOSED * radius_m + unresolved_m(coordinate_m)
}

/// As steps of equal length have it.
pub fn is_closed_to_rounding(model: &Model, contact: &Contact) -> bool {
    contact.gap_m <= rounding_m(model, contact)
}

/// δ of a body of this size, at such a coordinate: a gap beyond it is never stepped over.
pub fn delta_m(radius_m: f64, coordinate_m: f64) -> f64 {
    DELTA * radius_m + unresolved_m(coordinate_m)
}

/// δ of a contact: of the smaller body.
pub fn delta_at_m(model: &Model, contact: &Contact) -> f64 {
    let radius_m = size_m(model, contact);
    delta_m(radius_m, contact.p_WC.amax() + radius_m)
}

/// As from event to event.
pub fn is_closed_to_delta(model: &Model, contact: &Contact) -> bool {
    contact.gap_m <= SOME * delta_at_m(model, contact)
}
