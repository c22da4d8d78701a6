//! Motion with forces of contact that vary: Dormand and Prince's method of order 8 with its continuous extension of
//! order 7 (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.6), for all bodies that have no
//! closed form.
//!
//! What holds is kept by accelerations; what drifts in a step, some part of its error, is taken off at its end by the
//! smallest displacement and change of velocity (E. Eich 1993; `project`).

use super::field::Field;
use super::forces::{Gathered, Held, Solved};
use super::motion::Bounds;
use super::radau_tableau::STAGES;
use super::stiff;
use crate::integrate::dop853_tableau::{D, EXTRA};
use crate::integrate::dop853_try;
use crate::integrate::field::{advanced, sum};
use crate::integrate::phase::{Phase, phase, state};
use crate::integrate::rotation::exponential;
use crate::math::few::Few;
use crate::model::{Body, Model};
use crate::solve::Impulse;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

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
    /// Coefficients of the continuous extension, and the length that it is of: a step that ended earlier keeps it.
    spline: Vec<[Phase; 8]>,
    spline_s: f64,
}

/// A step shorter than this part of the time is none.
const SHORTEST: f64 = 1e-13;

/// The first step to try, in radians of the fastest body: control finds the right one from any of them; a body that
/// hardly moves counts as one of so many rad/s.
const FIRST_RAD: f64 = 0.1;
const SLOWEST_RAD_S: f64 = 1e-3;

/// What a point turns about, m, and what flight counts beside turning: by its own size it changes nothing.
const LEAST_SIZE_M: f64 = 1e-3;
const FLIGHT: f64 = 1e-3;

/// Part of the step that the estimate says, and the least and the greatest change from one step to the next (Hairer &
/// al., II.4; the program's are a third and six: here a step costs 16 looks at all contacts, and one that fails 11).
const SAFETY: f64 = 0.9;
const SHORTER: f64 = 1.0 / 5.0;
const LONGER: f64 = 4.0;

/// A slip that turns at so many radians in a step, toward where it is to go, is stiff: order 8 is stable up to 6.
const STIFF: f64 = 3.0;

/// So little more than a step is no reason for another one.
const LITTLE_MORE: f64 = 1.01;

impl Dense {
    pub fn new(model: &Model, bodies: Vec<usize>, at: &State, tolerance: f64) -> Self {
        let n = bodies.len();
        let y = bodies.iter().map(|i| phase(&at.bodies[*i])).collect();
        let rate = |i: &usize| {
            let (body, at) = (&model.bodies[*i], &at.bodies[*i]);
            let size_m = body.bounding_radius_m.max(LEAST_SIZE_M);
            at.w_WB.norm() + (model.gravity_m_s2.norm() / size_m).sqrt() + FLIGHT * at.v_WB.norm() / size_m
        };
        let fastest = bodies.iter().map(rate).fold(0.0, f64::max);
        Dense {
            bodies,
            tolerance,
            t_s: at.time_s,
            h: 0.0,
            wanted_s: FIRST_RAD / fastest.max(SLOWEST_RAD_S),
            y,
            end: vec![Phase::zeros(); n],
            k: vec![vec![Phase::zeros(); n]; 16],
            spline: vec![[Phase::zeros(); 8]; n],
            spline_s: 0.0,
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

    /// One step that meets the tolerance, not beyond `end_s` and no longer than so; `stiff_hz`: the fastest rate at
    /// which a slip turns. False: there is none.
    pub fn step(&mut self, field: &mut Field, end_s: f64, (most_s, stiff_hz): (f64, f64)) -> bool {
        let left_s = end_s - self.t_s;
        let is_stiff = stiff_hz * self.wanted_s.min(most_s).min(left_s) > STIFF && field.can_be_stiff();
        if !is_stiff {
            field.at(self.t_s, &self.bodies, &self.y, &mut self.k[0]);
        }
        let mut failed = false;
        loop {
            let wanted_s = self.wanted_s.min(most_s);
            let tried_s = if left_s <= LITTLE_MORE * wanted_s { left_s } else { wanted_s };
            let error = if is_stiff { self.attempt_stiff(field, tried_s) } else { self.attempt(field, tried_s) };
            let root = if is_stiff { libm::pow(error, 1.0 / STAGES as f64) } else { error.sqrt().sqrt().sqrt() };
            let factor = (SAFETY / root).clamp(SHORTER, if failed { 1.0 } else { LONGER });
            if error <= 1.0 {
                field.work.inner_steps += 1;
                if tried_s == wanted_s || factor < 1.0 {
                    self.wanted_s = tried_s * factor;
                }
                (self.h, self.spline_s) = (tried_s, tried_s);
                if !is_stiff {
                    self.finish(field, tried_s);
                }
                return true;
            }
            if field.gathered.deadline.is_over() {
                return false;
            }
            failed = true;
            self.wanted_s = if error.is_finite() { tried_s * factor } else { tried_s / 5.0 };
            if self.wanted_s <= SHORTEST * self.t_s.abs().max(left_s) {
                return false;
            }
        }
    }

    /// The same step, ended earlier: where its continuous extension is then, as what ends it was found there.
    pub fn shorten(&mut self, end_s: f64) {
        self.h = end_s - self.t_s;
        for place in 0..self.y.len() {
            self.end[place] = self.phase(place, self.h / self.spline_s);
        }
    }

    /// The same of a step that is stiff. Infinite: there is none so long.
    fn attempt_stiff(&mut self, field: &mut Field, h: f64) -> f64 {
        let tolerance = self.tolerance;
        let scale = |size: f64| tolerance * (1.0 + size);
        let tried = stiff::attempt(field, &self.bodies, [self.t_s, h], &self.y, scale);
        let Some((stages, error)) = tried else { return f64::INFINITY };
        self.end.clone_from(&stages[STAGES - 1]);
        stiff::polynomial(&self.y, &stages, &mut self.spline);
        error
    }

    /// Puts the end of a try into `end`; its error over the tolerance.
    fn attempt(&mut self, field: &mut Field, h: f64) -> f64 {
        let Dense { bodies, tolerance, y, end, k, .. } = self;
        let mut rates = |t_s: f64, y: &[Phase], rates: &mut [Phase]| field.at(t_s, bodies, y, rates);
        dop853_try::attempt(&mut rates, [self.t_s, h], |size| *tolerance * (1.0 + size), y, end, k)
    }

    /// The continuous extension.
    fn finish(&mut self, field: &mut Field, h: f64) {
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
        let into_s = t_s - self.t_s;
        if self.h > 0.0 && into_s >= self.h {
            return state(&self.end[place]);
        }
        let x = if self.h > 0.0 { (into_s / self.spline_s).max(0.0) } else { 0.0 };
        state(&self.phase(place, x))
    }

    /// By the continuous extension.
    fn phase(&self, place: usize, x: f64) -> Phase {
        let c = &self.spline[place];
        let mut y = c[7];
        for (j, c) in c[..7].iter().enumerate().rev() {
            y = y * if j % 2 == 0 { x } else { 1.0 - x } + c;
        }
        y
    }

    /// Of the body at a place in this step: its polynomial about the middle, coefficient by coefficient.
    pub fn bounds(&self, place: usize) -> Bounds {
        let series = self.series(place);
        let part = |k: usize, row: usize| series[k].fixed_rows::<3>(row).norm();
        let half = |k: usize| 0.5_f64.powi(k as i32);
        let h2 = self.spline_s * self.spline_s;
        let acceleration: Vector3<f64> = series[2].fixed_rows::<3>(0) * (2.0 / h2);
        let beside = (3..8).map(|k| (k * (k - 1)) as f64 * part(k, 0) * half(k - 2)).sum::<f64>() / h2;
        let w = (0..8).map(|k| part(k, 6) * half(k)).sum();
        let alpha = (1..8).map(|k| k as f64 * part(k, 6) * half(k - 1)).sum::<f64>() / self.spline_s;
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

/// What `project` did.
#[derive(Clone, Debug, Default)]
pub struct Projected {
    /// Something had to be moved.
    pub moved: bool,
    /// Impulses of the contacts and pins gathered; none: no velocity had to change.
    pub p: Few<Impulse>,
}

/// Puts what is held back in place: gaps closed by the smallest change in the metric of the masses, and no velocity
/// left along the rows that hold, by impulses that contacts can have: what is left of a rocking that is cut off is
/// ended with the friction that would have come with it, so that the momentum is wrong by the square of it only.
pub fn project(model: &Model, state: &mut State, held: &[Held], gathered: &mut Gathered) -> Projected {
    if held.is_empty() && model.pins.is_empty() {
        return Projected::default();
    }
    let moved = close_gaps(model, state, held, gathered);
    match stop(model, state, held, gathered) {
        Some(solved) => Projected { moved: true, p: solved.p },
        None => Projected { moved, p: Few::new() },
    }
}

/// Leaves no velocity along the rows that hold, places as they are.
pub fn project_velocities(model: &Model, state: &mut State, held: &[Held], gathered: &mut Gathered) {
    gathered.gather_velocities(model, state, held.iter().map(|held| &held.touch));
    stop(model, state, held, gathered);
}

/// The same of velocities that have been gathered. None: there are not any.
fn stop(model: &Model, state: &mut State, held: &[Held], gathered: &Gathered) -> Option<Solved> {
    let speed = state.bodies.iter().map(|at| at.v_WB.amax()).fold(0.0, f64::max);
    let solved = gathered.stop(held, ROUNDING_OF_SPEED * speed)?;
    for (i, at) in state.bodies.iter_mut().enumerate().filter(|(i, _)| !model.bodies[*i].driven) {
        at.v_WB += solved.added[i].v;
        at.w_WB += solved.added[i].w;
    }
    Some(solved)
}

/// What is no velocity beside the fastest body's, and no gap beside the farthest coordinate: their own rounding.
const ROUNDING_OF_SPEED: f64 = 2.0 * f64::EPSILON;
const ROUNDING_OF_PLACE: f64 = 4.0 * f64::EPSILON;

/// Displacements that follow each other, as turns are not displacements: what the second leaves is rounding.
const TRIES: u32 = 3;

/// Of the gaps before a displacement: larger ones after it are no rounding. (Where a rim and an edge lie almost along
/// each other, a displacement of nanometres moves the point in which they meet by centimetres.)
const WORSE: f64 = 2.0;

/// Whether there was any gap. Velocities are gathered where the bodies are then.
fn close_gaps(model: &Model, state: &mut State, held: &[Held], gathered: &mut Gathered) -> bool {
    let mut before: Option<(f64, Vec<BodyState>)> = None;
    for tries in 0..=TRIES {
        gathered.gather_velocities(model, state, held.iter().map(|held| &held.touch));
        let gaps_m = gathered.here.iter().map(|here| here.contact.gap_m.abs()).fold(0.0, f64::max);
        let apart_m = model.pins.iter().map(|pin| pin.apart_W(&state.bodies).norm()).fold(0.0, f64::max);
        let most_m = gaps_m.max(apart_m);
        if let Some((_, bodies)) = before.take_if(|(before_m, _)| most_m > WORSE * *before_m) {
            state.bodies = bodies;
            gathered.gather_velocities(model, state, held.iter().map(|held| &held.touch));
            return tries > 1;
        }
        let extent = |(at, body): (&BodyState, &Body)| at.p_WB.amax() + body.bounding_radius_m;
        let extent_m = state.bodies.iter().zip(&model.bodies).map(extent).fold(0.0, f64::max);
        let least_m = ROUNDING_OF_PLACE * extent_m;
        if most_m <= least_m || tries == TRIES {
            return tries > 0;
        }
        before = Some((most_m, state.bodies.clone()));
        for (block, here) in gathered.problem.blocks.iter_mut().zip(&gathered.here) {
            block.b = Vector3::new(here.contact.gap_m, 0.0, 0.0);
        }
        for (block, pin) in gathered.problem.blocks.iter_mut().skip(held.len()).zip(&model.pins) {
            block.b = pin.apart_W(&state.bodies);
        }
        let closed = gathered.close(held.len(), least_m);
        for (i, at) in state.bodies.iter_mut().enumerate().filter(|(i, _)| !model.bodies[*i].driven) {
            at.p_WB += closed.added[i].v;
            let turn = closed.added[i].w;
            if turn != Vector3::zeros() {
                // The angular velocity stays in the world, as the momentum of so small a turn does.
                at.q_WB = exponential(&turn) * at.q_WB;
                at.q_WB.renormalize();
            }
        }
        if !closed.holds {
            break;
        }
    }
    gathered.gather_velocities(model, state, held.iter().map(|held| &held.touch));
    true
}
