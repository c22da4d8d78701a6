//! When the next gap closes, and the proof that none closes before.
//!
//! On its path a gap g obeys g(t + s) ≥ g + ġ s − M s²/2, M a bound of the acceleration of any point toward the plane
//! (`motion::Bounds`): up to the root of that parabola nothing can close. Going from root to root never steps over a
//! contact, and near one it is Newton's method from outside: the error is squared at every step. A ball's M is its
//! exact acceleration, and one step is enough. The contact is there when g ≤ δ while it closes; a gap that stays within
//! δ may go unseen, and none beyond it (conservative advancement, B. Mirtich 1996, with a bound of second order).
//!
//! Pairs of bodies: of balls likewise; of others by their distance and the largest speed of their points, and within a
//! thousandth of their size by their points of contact.

use super::caps::Cap;
use super::forces::{Held, NO_SLIP, speed_m_s};
use super::look::{Look, Paths, Window, march};
use super::motion::Bounds;
use super::pairs::with_each_other;
use crate::collide::closed::delta_m;
use crate::collide::faces;
use crate::model::container::Face;
use crate::model::{Body, Geometry};
use crate::shape::cylinder::FLAT;
use crate::shape::solid::Solid;
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::Vector3;

/// The earliest time in the window at which something that is not held touches; none: nothing does, or
/// it is too late to say.
pub fn first(paths: &Paths, held: &[Held], window: Window, work: &mut Work) -> Option<f64> {
    let mut window = window;
    let mut found = None;
    let mut note = |at: Option<f64>, window: &mut Window| {
        if let Some(t_s) = at {
            window.to_s = t_s;
            found = Some(t_s);
        }
    };
    let bodies = &paths.model.bodies;
    if let Some(container) = &paths.model.container {
        for (i, body) in bodies.iter().enumerate().filter(|(_, body)| body.feels_container()) {
            let bounds = paths.bounds(i, window.to_s);
            for (f, face) in container.faces.iter().enumerate() {
                note(with_face(paths, (i, body, &bounds), (f, face), held, window, work), &mut window);
            }
        }
    }
    if paths.model.touching_pairs {
        for b in 1..bodies.len() {
            for a in 0..b {
                let left_out = (bodies[a].driven && bodies[b].driven) || paths.model.are_pinned([a, b]);
                if !left_out && bodies[a].solid().is_some() && bodies[b].solid().is_some() {
                    note(with_each_other(paths, [a, b], held, window, work), &mut window);
                }
            }
        }
    }
    found
}

fn with_face(
    paths: &Paths,
    (i, body, bounds): (usize, &Body, &Bounds),
    (f, face): (usize, &Face),
    held: &[Held],
    window: Window,
    work: &mut Work,
) -> Option<f64> {
    let radius_m = body.bounding_radius_m;
    let is_held = |node: u32| held.iter().any(|h| is_same_feature(body, h, i, f, node));
    let rest = held.iter().any(|h| h.touch.key().0 == i && h.touch.key().1.is_none() && h.touch.key().2.0 == f as u32);
    if rest && body.geometry.points() == 1 {
        return None;
    }
    let arm_m = arm_m(body);
    let delta = |at: &BodyState| delta_m(radius_m, at.p_WB.amax() + radius_m);
    march(window, paths.deadline, |t_s| {
        let at = paths.at(i, t_s);
        work.contact_tests += 1;
        let delta_m = delta(&at);
        let centre = Look {
            gap_m: face.gap_m(&at.p_WB) - radius_m,
            rate_m_s: face.normal.dot(&at.v_WB),
            toward_m_s2: bounds.toward(&face.normal, 0.0),
            ..Look::EMPTY
        };
        if centre.gap_m > delta_m && arm_m > 0.0 {
            return Some((centre.safe_s(delta_m, 0.0), false));
        }
        let slow = NO_SLIP * speed_m_s(paths.model, body, &at);
        let (curvature_m, known_s) = roundness(body, &at, &face.normal, bounds);
        let toward_m_s2 = bounds.toward(&face.normal, arm_m) + bounds.w * bounds.w * curvature_m;
        let flattest = Cap::facing(body, &at, &face.normal).filter(|cap| !is_held(cap.first()));
        // Of all points of the rim, wherever the lowest will be.
        let flat = flattest.map(|cap| {
            let (arm_W, sagitta_m) = cap.reach(&at, &face.normal);
            let (rate_m_s, more_m_s) = cap.rates(&at, &face.normal);
            let (gap_m, rate_m_s) = (face.gap_m(&(at.p_WB + arm_W)) - sagitta_m, rate_m_s - more_m_s);
            let toward_m_s2 = bounds.toward(&face.normal, arm_m);
            let down = cap.descent_on_plane(&at, &face.normal);
            (Look { gap_m, rate_m_s, toward_m_s2, ..Look::EMPTY }, cap, down)
        });
        let (mut safe_s, mut touching) = (f64::INFINITY, false);
        let mut of_flattest_s = f64::INFINITY;
        faces::each_near(body, &at, face, f64::INFINITY, |node, r_W, gap_m| {
            if is_held(node) {
                return;
            }
            let rate_m_s = face.normal.dot(&(at.v_WB + at.w_WB.cross(&r_W)));
            let look = Look { gap_m, rate_m_s, toward_m_s2, known_s, is_exact: arm_m == 0.0 && bounds.beside == 0.0 };
            let of =
                if flat.as_ref().is_some_and(|(_, cap, _)| cap.has(node)) { &mut of_flattest_s } else { &mut safe_s };
            if !look.is_safe_for(*of, delta_m) {
                *of = of.min(look.safe_s(delta_m, slow));
            }
            touching |= look.is_touching(delta_m, slow);
        });
        if let Some((look, cap, down)) = &flat {
            let of_rim_s = down.safe_s(look.height_m(delta_m), look.toward_m_s2).max(look.safe_s(delta_m, slow));
            if cap.is_flat(&at, &face.normal) {
                of_flattest_s = of_rim_s;
                touching |= look.is_touching(delta_m, slow);
            }
            safe_s = safe_s.min(of_flattest_s.max(of_rim_s));
        }
        Some((safe_s, touching))
    })
}

/// A rim's or a smooth body's one lowest point is held, wherever it is; the others by their numbers.
fn is_same_feature(body: &Body, held: &Held, i: usize, f: usize, node: u32) -> bool {
    let (of, other, feature) = held.touch.key();
    let is_cylinder = matches!(&body.geometry, Geometry::Solid { solid: Solid::Cylinder { .. }, .. });
    let same = if is_cylinder { feature.1 % 8 / 4 == node / 4 } else { feature.1 == node };
    of == i && other.is_none() && feature.0 == f as u32 && same
}

/// How far a point of the core is from the centre of mass at most.
fn arm_m(body: &Body) -> f64 {
    match &body.geometry {
        Geometry::Solid { solid: Solid::Sphere { .. }, centre } => centre.norm(),
        Geometry::Solid { solid: Solid::Capsule { half_height_m, .. }, centre } => centre.norm() + half_height_m,
        _ => body.bounding_radius_m,
    }
}

/// Part of a tilt that is sure to be left until the next look: the bound of the curvature is for that.
const KEPT: f64 = 0.5;

/// The largest radius of curvature of what is round, and how long that is sure.
fn roundness(body: &Body, at: &BodyState, normal: &Vector3<f64>, bounds: &Bounds) -> (f64, f64) {
    match &body.geometry {
        Geometry::Solid { solid: Solid::Ellipsoid { semi_axes_m }, .. } => {
            (semi_axes_m.max() * semi_axes_m.max() / semi_axes_m.min(), f64::INFINITY)
        }
        Geometry::Solid { solid: Solid::Cylinder { radius_m, .. }, .. } => {
            let tilt = at.q_WB.inverse_transform_vector(normal).cross(&Vector3::y()).norm();
            let flat = tilt < FLAT;
            if flat {
                (0.0, f64::INFINITY)
            } else {
                (radius_m / (KEPT * tilt), KEPT * tilt / bounds.w.max(f64::MIN_POSITIVE))
            }
        }
        _ => (0.0, f64::INFINITY),
    }
}
