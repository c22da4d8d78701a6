//! The classical Runge–Kutta method, order 4 (Kutta 1901), on position, velocity, angular velocity in body axes and
//! quaternion; the quaternion is made a unit one after the step. A parabola is exact.

use super::chain::Chain;
use super::field::{Field, advanced};
use super::phase::{Phase, phase, state};
use crate::model::Model;
use crate::work::Work;

/// Phases of every body of an island: the start of a step, a place on the way, and the four slopes.
#[derive(Debug)]
pub struct Scratch {
    y: Vec<Phase>,
    place: Vec<Phase>,
    k: [Vec<Phase>; 4],
}

impl Scratch {
    pub fn new(island: &Chain) -> Self {
        let room = || vec![Phase::zeros(); island.at.len()];
        Scratch { y: room(), place: room(), k: std::array::from_fn(|_| room()) }
    }
}

/// Takes an island over a step of `h` from `t_s`.
pub fn step(island: &mut Chain, model: &Model, [t_s, h]: [f64; 2], scratch: &mut Scratch, work: &mut Work) {
    let Scratch { y, place, k } = scratch;
    y.iter_mut().zip(&island.at).for_each(|(y, at)| *y = phase(at));
    let mut f = Field { island, model, work };
    f.at(t_s, y, &mut k[0]);
    advanced(y, &[0.5], &k[0..1], h, place);
    f.at(t_s + h / 2.0, place, &mut k[1]);
    advanced(y, &[0.5], &k[1..2], h, place);
    f.at(t_s + h / 2.0, place, &mut k[2]);
    advanced(y, &[1.0], &k[2..3], h, place);
    f.at(t_s + h, place, &mut k[3]);
    advanced(y, &[1.0, 2.0, 2.0, 1.0], k, h / 6.0, place);
    island.at.iter_mut().zip(place).for_each(|(at, y)| *at = state(y));
}
