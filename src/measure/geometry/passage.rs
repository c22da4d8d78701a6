//! Whether two bodies pass through each other between two states, by conservative advancement (B. Mirtich,
//! Impulse-based Dynamic Simulation of Rigid Body Systems, Berkeley 1996, 2.3): a gap cannot close faster than the
//! bodies move, so that none of the way is left unseen.

use super::expand::Expansion;
use super::figure::{Figure, posed};
use super::leg::{Leg, most_m};
use super::near::NearPair;
use super::overlap::part;
use super::posed::gap_along_m;
use crate::model::Model;

/// Of the width of the thinner body: an overlap on the way that counts.
const DEEP: f64 = 0.01;
/// Of that overlap: the shortest advance. And most of them.
const LEAST: f64 = 0.1;
const MOST: usize = 2_000;

/// The gap of a pair at a part of its way: the last axis shows enough of it, or all axes are asked.
pub fn gap_m(
    model: &Model,
    pair: &mut NearPair,
    legs: [&Leg; 2],
    (way, enough_m): (f64, f64),
    memory: &mut Expansion,
) -> f64 {
    let stands = legs.map(|leg| leg.at(way));
    let origin_W = stands[1].p_WB;
    let [a, b] = [0, 1].map(|i| posed(model, pair.bodies[i], &stands[i], &origin_W));
    let (Some(a), Some(b)) = (a, b) else { return f64::INFINITY };
    if pair.has_axis() {
        let gap_m = gap_along_m(&a, &b, &pair.axis);
        if gap_m >= enough_m {
            return gap_m;
        }
    }
    let parting = part(&a, &b, memory);
    pair.axis = parting.normal;
    parting.gap_m
}

/// Whether they overlap on the way, by a hundredth of the thinner one's width, deeper than at either end.
pub fn passes(model: &Model, figures: &[Figure], pair: &mut NearPair, legs: [&Leg; 2], memory: &mut Expansion) -> bool {
    let of = pair.bodies.map(|i| &figures[i]);
    let radii_m = of.map(|figure| figure.radius_m);
    let most_m = most_m(legs, radii_m);
    let deep_m = DEEP * of[0].width_m.min(of[1].width_m);
    // Half-way from both ends they cannot be deeper by more than half of it.
    if 0.5 * most_m <= deep_m || !spheres_meet(legs, radii_m[0] + radii_m[1]) {
        return false;
    }
    let ends_m = [0.0, 1.0].map(|way| gap_m(model, pair, legs, (way, most_m), memory));
    let limit_m = deep_m + (-ends_m[0]).max(-ends_m[1]).max(0.0);
    let last = 1.0 - (ends_m[1] + limit_m) / most_m;
    let mut way = (ends_m[0] + limit_m) / most_m;
    for _ in 0..MOST {
        if way >= last {
            break;
        }
        let gap_m = gap_m(model, pair, legs, (way, 0.2 * most_m), memory);
        if gap_m < -limit_m {
            return true;
        }
        way += (gap_m + limit_m).max(LEAST * deep_m) / most_m;
    }
    false
}

/// Whether the balls around two bodies come together on straight ways.
fn spheres_meet([a, b]: [&Leg; 2], reach_m: f64) -> bool {
    let (r, moved) = (a.from.p_WB - b.from.p_WB, a.moved - b.moved);
    let square = moved.norm_squared();
    let way = if square > 0.0 { (-r.dot(&moved) / square).clamp(0.0, 1.0) } else { 0.0 };
    (r + moved * way).norm_squared() < reach_m * reach_m
}
