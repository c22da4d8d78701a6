//! Motion with forces of contact that vary: Dormand and Prince's method of order 8 with its continuous extension of
//! order 7 (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.6), for all bodies that have no
//! closed form.
//!
//! What holds is kept by accelerations; what drifts in a step, some part of its error, is taken off at its end by the
//! smallest displacement and change of velocity (E. Eich 1993; `project`).

use super::forces::{Forces, Held, Rows};
use super::motion::{Bounds, Course, Motion};
use crate::integrate::dop853_tableau::{A, B, B3, D, E5, EXTRA};
use crate::integrate::field::{advanced, sum};
use crate::integrate::phase::{Phase, phase, state};
use crate::integrate::rotation::exponential;
use crate::math::full_pivot::Selection;
use crate::model::{Body, Model};
use crate::solve::block::Block;
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::{Quaternion, Vector3};

/// The right side ẏ = f(t, y), with what it needs.
pub struct Field<'a> {
    pub model: &'a Model,
    pub motions: &'a [Motion],
    pub held: &'a [Held],
    pub forces: &'a mut Forces,
    /// All bodies; those of the island are written over.
    pub state: &'a mut State,
    pub choice: Selection,
    pub work: &'a mut Work,
}

impl Field<'_> {
    fn at(&mut self, t_s: f64, bodies: &[usize], y: &[Phase], rates: &mut [Phase]) {
        self.state.time_s = t_s;
        for (i, motion) in self.motions.iter().enumerate() {
            if let Motion::Closed(course @ Course::Driven(..)) = motion {
                self.state.bodies[i] = course.at(t_s);
            }
        }
        bodies.iter().zip(y).for_each(|(i, y)| self.state.bodies[*i] = state(y));
        self.forces.gather(self.model, self.state, self.held.iter().map(|held| &held.touch));
        self.forces.hold(self.held, self.choice);
        self.work.gyroscopic += 1;
        for ((i, y), rate) in bodies.iter().zip(y).zip(rates) {
            *rate = rate_of(&self.state.bodies[*i], y, &self.forces.acceleration(*i));
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

/// The bodies of an integrator, and its last step; most often there is none.
#[derive(Clone, Debug, Default)]
pub struct Dense {
    /// Of the model, in the order of their places here.
    pub bodies: Vec<usize>,
    tolerance: f64,
    pub t_s: f64,
    pub h: f64,
    /// The next step to try.
    wanted_s: f64,
    y: Vec<Phase>,
    end: Vec<Phase>,
    k: Vec<Vec<Phase>>,
    /// Coefficients of the continuous extension.
    spline: Vec<[Phase; 8]>,
}

/// A step shorter than this part of the time is none.
const SHORTEST: f64 = 1e-13;

impl Dense {
    pub fn new(model: &Model, bodies: Vec<usize>, at: &State, tolerance: f64) -> Self {
        let n = bodies.len();
        let y = bodies.iter().map(|i| phase(&at.bodies[*i])).collect();
        let rate = |i: &usize| {
            let (body, at) = (&model.bodies[*i], &at.bodies[*i]);
            let size_m = body.bounding_radius_m.max(1e-3);
            at.w_WB.norm() + (model.gravity_m_s2.norm() / size_m).sqrt() + 1e-3 * at.v_WB.norm() / size_m
        };
        let fastest = bodies.iter().map(rate).fold(0.0, f64::max);
        Dense {
            bodies,
            tolerance,
            t_s: at.time_s,
            h: 0.0,
            wanted_s: 0.1 / fastest.max(1e-3),
            y,
            end: vec![Phase::zeros(); n],
            k: vec![vec![Phase::zeros(); n]; 16],
            spline: vec![[Phase::zeros(); 8]; n],
        }
    }

    /// No body needs it.
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Goes on from here, with the steps that were right until now.
    pub fn restart(&mut self, at: &State) {
        self.t_s = at.time_s;
        self.h = 0.0;
        for (y, i) in self.y.iter_mut().zip(&self.bodies) {
            *y = phase(&at.bodies[*i]);
        }
    }

    /// One step that meets the tolerance, not beyond `end_s` and no longer than `most_s`. False: there is none.
    pub fn step(&mut self, field: &mut Field, end_s: f64, most_s: f64) -> bool {
        field.at(self.t_s, &self.bodies, &self.y, &mut self.k[0]);
        let left_s = end_s - self.t_s;
        let mut failed = false;
        loop {
            let wanted_s = self.wanted_s.min(most_s);
            let tried_s = if left_s <= 1.01 * wanted_s { left_s } else { wanted_s };
            let error = self.attempt(field, tried_s);
            let eighth_root = error.sqrt().sqrt().sqrt();
            let factor = (0.9 / eighth_root).clamp(1.0 / 5.0, if failed { 1.0 } else { 4.0 });
            if error <= 1.0 {
                field.work.inner_steps += 1;
                if tried_s == wanted_s || factor < 1.0 {
                    self.wanted_s = tried_s * factor;
                }
                self.finish(field, tried_s);
                return true;
            }
            if field.forces.deadline.is_over() {
                return false;
            }
            failed = true;
            self.wanted_s = if error.is_finite() { tried_s * factor } else { tried_s / 5.0 };
            if self.wanted_s <= SHORTEST * self.t_s.abs().max(left_s) {
                return false;
            }
        }
    }

    /// The same step, ended earlier.
    pub fn shorten(&mut self, field: &mut Field, end_s: f64) {
        let h = end_s - self.t_s;
        self.attempt(field, h);
        self.finish(field, h);
    }

    /// Puts the end of a try into `end`; its error over the tolerance.
    fn attempt(&mut self, field: &mut Field, h: f64) -> f64 {
        for (i, row) in A.iter().enumerate() {
            advanced(&self.y, row, &self.k, h, &mut self.end);
            let t_s = self.t_s + h * row.iter().sum::<f64>();
            field.at(t_s, &self.bodies, &self.end, &mut self.k[i + 1]);
        }
        let (mut error5, mut error3) = (0.0, 0.0);
        for (i, (y, end)) in self.y.iter().zip(&mut self.end).enumerate() {
            let slope = sum(&B, &self.k, i);
            *end = y + slope * h;
            let scale = y.zip_map(end, |a, b| self.tolerance * (1.0 + a.abs().max(b.abs())));
            error5 += sum(&E5, &self.k, i).component_div(&scale).norm_squared();
            error3 += (slope - sum(&B3, &self.k, i)).component_div(&scale).norm_squared();
        }
        let both = error5 + 0.01 * error3;
        if both == 0.0 { 0.0 } else { h * error5 / (both * (13 * self.y.len()) as f64).sqrt() }
    }

    /// The continuous extension.
    fn finish(&mut self, field: &mut Field, h: f64) {
        self.h = h;
        field.at(self.t_s + h, &self.bodies, &self.end, &mut self.k[12]);
        let mut place = vec![Phase::zeros(); self.y.len()];
        for (i, row) in EXTRA.iter().enumerate() {
            advanced(&self.y, row, &self.k, h, &mut place);
            let t_s = self.t_s + h * row.iter().sum::<f64>();
            field.at(t_s, &self.bodies, &place, &mut self.k[13 + i]);
        }
        for i in 0..self.y.len() {
            let (y, difference) = (self.y[i], self.end[i] - self.y[i]);
            let slope = self.k[0][i] * h - difference;
            let bend = difference - self.k[12][i] * h - slope;
            let [d4, d5, d6, d7] = [0, 1, 2, 3].map(|j| sum(D[j], &self.k, i) * h);
            self.spline[i] = [y, difference, slope, bend, d4, d5, d6, d7];
        }
    }

    /// The body at a place of this integrator, within the last step.
    pub fn at(&self, place: usize, t_s: f64) -> BodyState {
        let x = if self.h > 0.0 { ((t_s - self.t_s) / self.h).clamp(0.0, 1.0) } else { 0.0 };
        if x == 1.0 {
            return state(&self.end[place]);
        }
        let c = &self.spline[place];
        let mut y = c[7];
        for (j, c) in c[..7].iter().enumerate().rev() {
            y = y * if j % 2 == 0 { x } else { 1.0 - x } + c;
        }
        state(&y)
    }

    /// Of the body at a place in this step: its polynomial about the middle, coefficient by coefficient.
    pub fn bounds(&self, place: usize) -> Bounds {
        let series = self.series(place);
        let part = |k: usize, row: usize| series[k].fixed_rows::<3>(row).norm();
        let half = |k: usize| 0.5_f64.powi(k as i32);
        let h2 = self.h * self.h;
        let acceleration: Vector3<f64> = series[2].fixed_rows::<3>(0) * (2.0 / h2);
        let beside = (3..8).map(|k| (k * (k - 1)) as f64 * part(k, 0) * half(k - 2)).sum::<f64>() / h2;
        let w = (0..8).map(|k| part(k, 6) * half(k)).sum();
        let alpha = (1..8).map(|k| k as f64 * part(k, 6) * half(k - 1)).sum::<f64>() / self.h;
        Bounds { acceleration, beside, w, alpha }
    }

    /// Coefficients of powers of x − ½.
    fn series(&self, place: usize) -> [Phase; 8] {
        let c = &self.spline[place];
        let mut series = [Phase::zeros(); 8];
        series[0] = c[7];
        for (j, c) in c[..7].iter().enumerate().rev() {
            // Times x = ½ + u, or 1 − x = ½ − u.
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            for k in (1..8).rev() {
                series[k] = series[k] * 0.5 + series[k - 1] * sign;
            }
            series[0] = series[0] * 0.5 + c;
        }
        series
    }
}

/// Puts what is held back in place: gaps closed by the smallest change in the metric of the masses, and no velocity
/// left along the rows that hold, by impulses that contacts can have: what is left of a rocking that is cut off is
/// ended with the friction that would have come with it, so that the momentum is wrong by the square of it only. True:
/// something had to be moved. The impulses are left in `forces`.
pub fn project(model: &Model, state: &mut State, held: &[Held], forces: &mut Forces) -> bool {
    if held.is_empty() && model.pins.is_empty() {
        return false;
    }
    let moved = close_gaps(model, state, held, forces);
    forces.gather_velocities(model, state, held.iter().map(|held| &held.touch));
    forces.set_rows(held);
    let off = |(block, rows): (&Block, &Rows)| match rows {
        Rows::None => 0.0,
        Rows::Normal(_) => block.b.x.abs(),
        Rows::All => block.b.amax(),
    };
    let largest = forces.problem.blocks.iter().zip(&forces.rows).map(off).fold(0.0, f64::max);
    let speed = state.bodies.iter().map(|at| at.v_WB.amax()).fold(0.0, f64::max);
    forces.p.clear();
    if largest <= 2.0 * f64::EPSILON * speed {
        return moved;
    }
    if forces.solve(Selection::Any) {
        for (i, at) in state.bodies.iter_mut().enumerate().filter(|(i, _)| !model.bodies[*i].driven) {
            at.v_WB += forces.added[i].v;
            at.w_WB += forces.added[i].w;
        }
    }
    true
}

fn close_gaps(model: &Model, state: &mut State, held: &[Held], forces: &mut Forces) -> bool {
    for tries in 0..3 {
        forces.gather_velocities(model, state, held.iter().map(|held| &held.touch));
        let mut largest = 0.0_f64;
        for (block, here) in forces.problem.blocks.iter_mut().zip(&forces.here) {
            block.b = Vector3::new(here.contact.gap_m, 0.0, 0.0);
            largest = largest.max(here.contact.gap_m.abs());
        }
        for (block, pin) in forces.problem.blocks.iter_mut().skip(held.len()).zip(&model.pins) {
            block.b = pin.apart_W(&state.bodies);
            largest = largest.max(block.b.norm());
        }
        let extent = |(at, body): (&BodyState, &Body)| at.p_WB.amax() + body.bounding_radius_m;
        let extent_m = state.bodies.iter().zip(&model.bodies).map(extent).fold(0.0, f64::max);
        if largest <= 4.0 * f64::EPSILON * extent_m {
            return tries > 0;
        }
        forces.rows.clear();
        forces.rows.resize(held.len(), Rows::Normal(Vector3::x()));
        forces.rows.resize(forces.problem.blocks.len(), Rows::All);
        if !forces.solve(Selection::Any) {
            return true;
        }
        for (i, at) in state.bodies.iter_mut().enumerate().filter(|(i, _)| !model.bodies[*i].driven) {
            at.p_WB += forces.added[i].v;
            let turn = forces.added[i].w;
            if turn != Vector3::zeros() {
                // The angular velocity stays in the world, as the momentum of so small a turn does.
                at.q_WB = exponential(&turn) * at.q_WB;
                at.q_WB.renormalize();
            }
        }
    }
    true
}
