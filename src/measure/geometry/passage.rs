//! Whether two bodies pass through each other between two states, by conservative advancement (B. Mirtich,
//! Impulse-based Dynamic Simulation of Rigid Body Systems, Berkeley 1996, 2.3): a gap cannot close faster than the
//! bodies move, so that none of the way is left unseen.

use super::expand::Expansion;
use super::figure::{Figure, Stand, posed};
use super::near::NearPair;
use super::overlap::part;
use super::posed::gap_along_m;
use super::track::{Track, bend_m, closing_m, most_m};
use crate::model::Model;
use nalgebra::Vector3;

/// Of the width of the thinner body: an overlap on the way that counts.
const DEEP: f64 = 0.01;
/// Of that overlap: the shortest advance. And most of them.
const LEAST: f64 = 0.1;
const MOST: usize = 20_000;

/// The gap of a pair where it stands: the last axis shows enough of it, or all axes are asked.
pub fn gap_m(model: &Model, pair: &mut NearPair, stands: [Stand; 2], enough_m: f64, memory: &mut Expansion) -> f64 {
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

/// Whether they overlap on the way, by a hundredth of the thinner one's width, deeper than at either end; looked at in
/// the part of it in which they may.
pub fn passes(
    model: &Model,
    figures: &[Figure],
    pair: &mut NearPair,
    (mut tracks, [from, to]): ([Track; 2], [f64; 2]),
    memory: &mut Expansion,
) -> bool {
    let of = pair.bodies.map(|i| &figures[i]);
    let most_m = most_m(&tracks);
    let deep_m = DEEP * of[0].width_m.min(of[1].width_m);
    // Half-way from both ends they cannot be deeper by more than half of it.
    if 0.5 * most_m <= deep_m {
        return false;
    }
    let mut gap_at = |pair: &mut NearPair, tracks: &mut [Track; 2], way: f64, enough_m: f64| {
        let stands = tracks.each_mut().map(|track| track.at(way));
        gap_m(model, pair, stands, enough_m, memory)
    };
    let ends_m = [0.0, 1.0].map(|way| gap_at(pair, &mut tracks, way, most_m));
    let limit_m = deep_m + (-ends_m[0]).max(-ends_m[1]).max(0.0);
    let last = to.min(1.0 - (ends_m[1] + limit_m) / most_m);
    let mut way = from.max((ends_m[0] + limit_m) / most_m);
    for _ in 0..MOST {
        if way >= last {
            break;
        }
        let gap_m = gap_at(pair, &mut tracks, way, 0.2 * most_m);
        if gap_m < -limit_m {
            return true;
        }
        // Along the axis that parts them the gap closes no faster than points of the bodies move along it, and not by
        // more on the way to where it is seen again than the bend of what turns.
        let closing_m = closing_m(&tracks, &pair.axis);
        if closing_m <= 0.0 {
            break;
        }
        let spare_m = (gap_m + limit_m).max(LEAST * deep_m);
        let by_speed = spare_m / closing_m;
        let bend_m = bend_m(&tracks);
        let ahead = (last - way).min((4.0 * spare_m / bend_m).sqrt());
        let is_parted = ahead > by_speed && {
            let stands = tracks.each_mut().map(|track| track.at(way + ahead));
            let seen_m = along_m(model, pair, stands);
            seen_m.min(gap_m) - bend_m * ahead * ahead / 8.0 >= gap_m - spare_m
        };
        way += if is_parted { ahead } else { by_speed };
    }
    false
}

/// The gap of a pair where it stands along its axis.
fn along_m(model: &Model, pair: &NearPair, stands: [Stand; 2]) -> f64 {
    let origin_W = stands[1].p_WB;
    let [a, b] = [0, 1].map(|i| posed(model, pair.bodies[i], &stands[i], &origin_W));
    a.zip(b).map_or(f64::INFINITY, |(a, b)| gap_along_m(&a, &b, &pair.axis))
}

/// The part of straight ways, given by where the second body sees the first at both ends, on which the balls around
/// two bodies meet.
pub fn together([from, to]: [Vector3<f64>; 2], reach_m: f64) -> Option<[f64; 2]> {
    let moved = to - from;
    let square = moved.norm_squared();
    let nearest = if square > 0.0 { -from.dot(&moved) / square } else { 0.0 };
    let left = reach_m * reach_m - (from + moved * nearest).norm_squared();
    if left <= 0.0 {
        return None;
    }
    let half = if square > 0.0 { (left / square).sqrt() } else { f64::INFINITY };
    let [first, last] = [(nearest - half).max(0.0), (nearest + half).min(1.0)];
    (first < last).then_some([first, last])
}
