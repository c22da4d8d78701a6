//! The equations of motion ẏ = f(t, y) of all bodies that have no closed form, with the forces of what holds.

use super::forces::{Gathered, Held, Solved};
use super::law::hold;
use super::motion::{ClosedMotion, Motion};
use crate::integrate::phase::{Phase, state};
use crate::math::full_pivot::Selection;
use crate::model::Model;
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::Quaternion;

/// The right side ẏ = f(t, y), with what it needs.
pub struct Field<'a> {
    pub model: &'a Model,
    pub motions: &'a [Motion],
    pub held: &'a [Held],
    pub gathered: &'a mut Gathered,
    /// All bodies; those of the island are written over.
    pub state: &'a mut State,
    pub choice: Selection,
    pub work: &'a mut Work,
}

impl Field<'_> {
    /// Rates of these bodies.
    pub(super) fn at(&mut self, t_s: f64, bodies: &[usize], y: &[Phase], rates: &mut [Phase]) {
        self.place(t_s, bodies, y);
        let solved = hold(self.gathered, self.held, self.choice, self.work);
        self.rates(bodies, y, &solved, rates);
    }

    /// Puts all bodies there, and gathers what holds.
    pub(super) fn place(&mut self, t_s: f64, bodies: &[usize], y: &[Phase]) {
        self.state.time_s = t_s;
        for (i, motion) in self.motions.iter().enumerate() {
            if let Motion::Closed(course @ ClosedMotion::Driven(..)) = motion {
                self.state.bodies[i] = course.at(t_s);
            }
        }
        bodies.iter().zip(y).for_each(|(i, y)| self.state.bodies[*i] = state(y));
        self.gathered.gather(self.model, self.state, self.held.iter().map(|held| &held.touch));
    }

    /// By these forces.
    pub(super) fn rates(&mut self, bodies: &[usize], y: &[Phase], solved: &Solved, rates: &mut [Phase]) {
        self.work.gyroscopic += 1;
        for ((i, y), rate) in bodies.iter().zip(y).zip(rates) {
            *rate = rate_of(&self.state.bodies[*i], y, &solved.acceleration(self.gathered, *i));
        }
    }
}

/// ṗ = v, v̇ = a, ω̇ in body axes (d/dt ω_B = R⁻¹ ω̇_W), q̇ = ½ q ω.
fn rate_of(at: &BodyState, y: &Phase, acceleration: &Twist) -> Phase {
    let mut rate = Phase::zeros();
    rate.fixed_rows_mut::<3>(0).copy_from(&y.fixed_rows::<3>(3));
    rate.fixed_rows_mut::<3>(3).copy_from(&acceleration.v);
    rate.fixed_rows_mut::<3>(6).copy_from(&at.q_WB.inverse_transform_vector(&acceleration.w));
    let q = Quaternion::from(y.fixed_rows::<4>(9).into_owned());
    let turning = q * Quaternion::from_imag(y.fixed_rows::<3>(6).into_owned()) / 2.0;
    rate.fixed_rows_mut::<4>(9).copy_from(&turning.coords);
    rate
}
