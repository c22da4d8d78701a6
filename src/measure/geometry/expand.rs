//! How deep any two convex solids overlap: their Minkowski difference D is approached from inside by a polytope that
//! grows where it is nearest to the origin (G. van den Bergen, Proximity Queries and Penetration Depth Computation on
//! 3D Game Objects, GDC 2001; here from any first tetrahedron, with planes that may have the origin outside).
//!
//! Every direction asked is an upper bound of the depth, h(d); the nearest plane of the polytope is a lower one. They
//! meet exactly at flat faces of D, and as the square of the size of the polytope's faces where D is curved. Where the
//! solids are apart what is found is a direction that parts them.

use super::parting::Parting;
use super::posed::Posed;
use nalgebra::Vector3;

/// Of the smaller solid, and of the sum of both (what rounding leaves): the bounds have met.
const MET: f64 = 1e-12;
const ROUNDING: f64 = 32.0 * f64::EPSILON;
/// Of that: a point is in a plane.
const IN_PLANE: f64 = 0.1;
/// Points of the polytope.
const MOST: usize = 400;
/// Of what the farthest plane shows as the gap of two solids that are apart: enough.
const APART: f64 = 0.7;

#[derive(Clone, Copy, Debug)]
struct Facet {
    corners: [u32; 3],
    /// Outward, unit, and how far from the origin it is along it.
    normal: Vector3<f64>,
    offset_m: f64,
    /// Nothing of D is beyond it, or it is too narrow to say where.
    closed: bool,
}

/// The polytope, kept for its memory.
#[derive(Clone, Debug, Default)]
pub struct Expansion {
    points: Vec<Vector3<f64>>,
    facets: Vec<Facet>,
    /// Edges of what is taken away, to be looked across; and those beyond which the polytope stays.
    across: Vec<[u32; 2]>,
    rim: Vec<[u32; 2]>,
}

/// The two cores, and the least h(d) that has been seen.
struct Asked<'a> {
    of: [&'a Posed<'a>; 2],
    reach_m: f64,
    direction: Vector3<f64>,
}

impl Asked<'_> {
    /// The point of D farthest along a unit vector.
    fn ask(&mut self, d: &Vector3<f64>) -> (Vector3<f64>, f64) {
        let point = self.of[0].farthest(d) - self.of[1].farthest(&-d);
        let reach_m = d.dot(&point);
        if reach_m < self.reach_m {
            (self.reach_m, self.direction) = (reach_m, *d);
        }
        (point, reach_m)
    }
}

impl Expansion {
    /// Of the cores of a and b. `size_m`: of the smaller one, and of both.
    pub fn part(&mut self, a: &Posed, b: &Posed, size_m: [f64; 2]) -> Parting {
        let met_m = MET * size_m[0] + ROUNDING * size_m[1];
        let mut asked = Asked { of: [a, b], reach_m: f64::INFINITY, direction: Vector3::y() };
        self.begin(&mut asked);
        while let Some(nearest) = self.nearest() {
            let Facet { normal, offset_m, .. } = self.facets[nearest];
            let (point, reach_m) = asked.ask(&normal);
            let least_m = asked.reach_m;
            let has_met = reach_m - offset_m <= met_m || offset_m >= least_m - met_m;
            if has_met || least_m < APART * offset_m || self.points.len() >= MOST {
                break;
            }
            if self.points.iter().any(|known| (known - point).amax() <= IN_PLANE * met_m) {
                self.facets[nearest].closed = true;
            } else {
                self.take(nearest, point, IN_PLANE * met_m);
            }
        }
        Parting { gap_m: -asked.reach_m, normal: -asked.direction }
    }

    /// A tetrahedron, as thick as a few questions find one.
    fn begin(&mut self, asked: &mut Asked) {
        self.points.clear();
        self.facets.clear();
        let toward = (asked.of[1].p - asked.of[0].p).try_normalize(0.0).unwrap_or_else(Vector3::y);
        let (p0, p1) = (asked.ask(&toward).0, asked.ask(&-toward).0);
        let along = (p1 - p0).try_normalize(0.0).unwrap_or(toward);
        let side = Vector3::ith(along.iamin(), 1.0).cross(&along).normalize();
        let other = along.cross(&side);
        let off = |p: &Vector3<f64>| (p - p0).cross(&along).norm_squared();
        let sides = [side, -side, other, -other].map(|d| asked.ask(&d).0);
        let p2 = sides.into_iter().reduce(|best, p| if off(&p) > off(&best) { p } else { best }).unwrap_or(p0);
        let across = (p1 - p0).cross(&(p2 - p0)).try_normalize(0.0).unwrap_or(side);
        let height = |p: &Vector3<f64>| across.dot(&(p - p0));
        let (up, down) = (asked.ask(&across).0, asked.ask(&-across).0);
        let is_up = height(&up) >= -height(&down);
        self.points.extend([p0, p1, p2, if is_up { up } else { down }]);
        let faces = if is_up {
            [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
        } else {
            [[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]]
        };
        faces.into_iter().for_each(|corners| self.face(corners));
    }

    fn face(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|i| self.points[i as usize]);
        let area = (b - a).cross(&(c - a));
        let length = area.norm();
        let is_flat = length > 0.0;
        let normal = if is_flat { area / length } else { Vector3::zeros() };
        self.facets.push(Facet { corners, normal, offset_m: normal.dot(&a), closed: !is_flat });
    }

    fn nearest(&self) -> Option<usize> {
        let mut nearest = None;
        let mut least_m = f64::INFINITY;
        for (k, facet) in self.facets.iter().enumerate() {
            if facet.offset_m < least_m && !facet.closed {
                (nearest, least_m) = (Some(k), facet.offset_m);
            }
        }
        nearest
    }

    /// The hull of the polytope and a point above one of its facets: what sees the point goes, or has it in its plane,
    /// and its rim is joined to it.
    fn take(&mut self, above: usize, point: Vector3<f64>, in_plane_m: f64) {
        let number = self.points.len() as u32;
        self.points.push(point);
        self.rim.clear();
        self.across.clear();
        self.remove(above);
        while let Some([a, b]) = self.across.pop() {
            let has_edge = |&[x, y, z]: &[u32; 3]| [[x, y], [y, z], [z, x]].contains(&[b, a]);
            match self.facets.iter().position(|facet| has_edge(&facet.corners)) {
                Some(k) if self.facets[k].normal.dot(&point) - self.facets[k].offset_m > -in_plane_m => {
                    // For the neighbour's side of it to find.
                    self.across.push([a, b]);
                    self.remove(k);
                }
                _ => self.rim.push([a, b]),
            }
        }
        for i in 0..self.rim.len() {
            let [a, b] = self.rim[i];
            self.face([a, b, number]);
        }
    }

    fn remove(&mut self, facet: usize) {
        let [a, b, c] = self.facets.swap_remove(facet).corners;
        for edge in [[a, b], [b, c], [c, a]] {
            // An edge of two that go is none of the rim.
            match self.across.iter().position(|known| *known == [edge[1], edge[0]]) {
                Some(twice) => drop(self.across.swap_remove(twice)),
                None => self.across.push(edge),
            }
        }
    }
}
