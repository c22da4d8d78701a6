//! The equations of motion of an island as ẏ = f(t, y), for the methods that know nothing of rotations.

use super::chain::Chain;
use super::drive::Drive;
use super::phase::{Phase, rate, state};
use crate::model::Model;
use crate::work::Work;

/// The function f, with what it needs.
pub struct Field<'a> {
    pub island: &'a mut Chain,
    pub model: &'a Model,
    pub work: &'a mut Work,
}

impl Field<'_> {
    /// Rates ẏ of every body at a time.
    pub fn at(&mut self, t_s: f64, y: &[Phase], rates: &mut [Phase]) {
        let Field { island, model, work } = self;
        if !island.is_free() {
            island.at.iter_mut().zip(y).for_each(|(at, y)| *at = state(y));
            island.drive(model, t_s, work);
        }
        let drives: &[Drive] = &island.drives;
        for (((body, drive), y), rate_of) in island.bodies(model).zip(drives).zip(y).zip(rates) {
            *rate_of = rate(body, drive, y, work);
        }
    }
}

/// State y + h Σ aⱼ kⱼ of a body.
pub fn advanced(y: &[Phase], weights: &[f64], k: &[Vec<Phase>], h: f64, out: &mut [Phase]) {
    for (i, (y, out)) in y.iter().zip(out).enumerate() {
        *out = y + sum(weights, k, i) * h;
    }
}

/// Sum Σ aⱼ kⱼ of one body.
pub fn sum(weights: &[f64], k: &[Vec<Phase>], body: usize) -> Phase {
    let terms = weights.iter().zip(k).filter(|(a, _)| **a != 0.0);
    terms.fold(Phase::zeros(), |sum, (a, k)| sum + k[body] * *a)
}
