//! A look at a gap at one time, on the paths of its bodies, and the way from look to look (`watch`).

use super::dense::Dense;
use super::motion::{Bounds, Motion};
use crate::deadline::Deadline;
use crate::model::Model;
use crate::state::BodyState;
use nalgebra::Vector3;

/// All bodies between two events.
#[derive(Clone, Copy)]
pub struct Paths<'a> {
    pub model: &'a Model,
    pub motions: &'a [Motion],
    pub dense: &'a Dense,
    pub deadline: Deadline,
}

impl Paths<'_> {
    pub fn at(&self, body: usize, t_s: f64) -> BodyState {
        match &self.motions[body] {
            Motion::Closed(course) => course.at(t_s),
            Motion::Dense(place) => self.dense.at(*place, t_s),
        }
    }

    pub(super) fn bounds(&self, body: usize, end_s: f64) -> Bounds {
        match &self.motions[body] {
            Motion::Closed(course) => course.bounds(&self.model.bodies[body], end_s),
            Motion::Dense(place) => self.dense.bounds(*place),
        }
    }
}

/// Looks taken before a search is given up; they get shorter only where a gap stays within some δ.
const MOST: u32 = 10_000;

/// One look at a gap.
pub(super) struct Look {
    pub(super) gap_m: f64,
    pub(super) rate_m_s: f64,
    /// M.
    pub(super) toward_m_s2: f64,
    /// Nothing is known beyond this time.
    pub(super) known_s: f64,
    /// M is the acceleration itself.
    pub(super) is_exact: bool,
}

impl Look {
    pub(super) const EMPTY: Look =
        Look { gap_m: 0.0, rate_m_s: 0.0, toward_m_s2: 0.0, known_s: f64::INFINITY, is_exact: false };

    /// Of two points that touch at a distance.
    pub(super) fn of_points(apart: Vector3<f64>, rate: Vector3<f64>, reach_m: f64, toward_m_s2: f64) -> Self {
        let distance = apart.norm();
        let rate_m_s = if distance > 0.0 { apart.dot(&rate) / distance } else { 0.0 };
        Look { gap_m: distance - reach_m, rate_m_s, toward_m_s2, ..Look::EMPTY }
    }

    /// The gap that is left to close. A bounce comes back to where it began; what lingers within δ is let through it.
    pub(super) fn height_m(&self, delta_m: f64) -> f64 {
        if self.gap_m > delta_m { self.gap_m } else { self.gap_m.max(0.0) + delta_m }
    }

    /// The time in which the gap cannot close.
    pub(super) fn safe_s(&self, delta_m: f64, slow_m_s: f64) -> f64 {
        let g = self.height_m(delta_m);
        let (rate, m) = (self.rate_m_s, self.toward_m_s2);
        let square = rate * rate + 2.0 * m * g;
        let s = if square < 0.0 || (m <= 0.0 && rate >= 0.0) {
            f64::INFINITY
        } else if rate <= 0.0 {
            2.0 * g / (square.sqrt() - rate)
        } else {
            (rate + square.sqrt()) / m
        };
        let s = if self.gap_m <= delta_m && rate > slow_m_s && m > 0.0 {
            // A bounce comes back to where it began, but for what M is too much.
            let back_s = 2.0 * rate / m;
            if self.is_exact { back_s } else { back_s.max((2.0 * delta_m / m).sqrt()) }
        } else {
            s
        };
        s.min(self.known_s)
    }

    /// The gap cannot close in so short a time, which is all that the least of many asks: without a root.
    pub(super) fn is_safe_for(&self, s: f64, delta_m: f64) -> bool {
        let left_m = self.gap_m + (self.rate_m_s - 0.5 * self.toward_m_s2 * s) * s;
        self.gap_m > delta_m && self.toward_m_s2 >= 0.0 && left_m > 0.0 && s <= self.known_s
    }

    /// What comes nearer by rounding alone, the impact would not see either, however deep it is.
    pub(super) fn is_touching(&self, delta_m: f64, slow_m_s: f64) -> bool {
        self.gap_m <= delta_m && self.rate_m_s < -slow_m_s
    }
}

/// What has to be known of a search.
#[derive(Clone, Copy)]
pub struct Window {
    pub from_s: f64,
    pub to_s: f64,
}

/// Goes from look to look, up to the deadline. `look`: None, nothing is to be seen any more.
pub(super) fn march(
    window: Window,
    deadline: Deadline,
    mut look: impl FnMut(f64) -> Option<(f64, bool)>,
) -> Option<f64> {
    let mut t_s = window.from_s;
    for _ in 0..MOST {
        if deadline.is_over() {
            return None;
        }
        let (safe_s, touching) = look(t_s)?;
        if touching {
            return Some(t_s);
        }
        let next_s = t_s + safe_s;
        if next_s >= window.to_s {
            return None;
        }
        // A safe time below the clock's own rounding.
        t_s = if next_s > t_s { next_s } else { t_s.next_up() };
    }
    Some(t_s)
}
