//! Steps of Radau's method IIA with seven stages (Hairer & Wanner, Solving Ordinary Differential Eqs. II, IV.8)
//! for slips that are slow: of order 13, stable however stiff, and it asks nothing of the moment at which a slip
//! begins, where its direction is singular.
//!
//! What is stiff is the turn θ of each slip's direction, dθ = t·ds/|s|, and nothing else: Newton's method has the
//! stages' turns as its unknowns, and takes positions, and all other forces, by iteration. It starts from slips along
//! the directions of the beginning.

use super::field::Field;
use super::forces::{Mode, Slip, along};
use super::radau_tableau::{A, NESTED, NODES, STAGES};
use crate::integrate::phase::Phase;
use crate::solve::twist::Twist;
use nalgebra::{DMatrix, DVector, Quaternion, Vector3, Vector6};

/// Sweeps with directions as they were at the beginning, before Newton's method: velocities differ by the third power
/// of the step then.
const AS_BEFORE: u32 = 2;

/// Newton's steps; half as many is usual.
const MOST: u32 = 14;

/// Change of a stage that is left after the last of them, over the tolerance; and of a velocity over the largest, which
/// is rounding.
const SETTLED: f64 = 1e-3;
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Changes of the attitudes, which follow the velocities, in a row: each is smaller by a part of the angle of a step.
const TURNS_AT_ONCE: u32 = 3;

/// A turn that tells the derivative.
const TURN_RAD: f64 = 1e-6;

/// Of slips whose directions change: above, systems take too long.
const MOST_SLIPS: usize = 48;

/// How much less than its leading coefficient a polynomial of degree 7 differs from one of degree 6 (Chebyshev), twice.
const LEAST_DEVIATION: f64 = 1.0 / 4096.0;

/// What a turn of one slip's direction does, and what turns it.
pub struct Turn {
    /// Rates of velocities (world) and angular velocities (body axes), of each body, per radian.
    does: Vec<Vector6<f64>>,
    /// Radians per velocity, of the bodies at these places.
    from: Vec<(usize, Vector6<f64>)>,
}

impl Field<'_> {
    /// Slips whose directions change in a step are few enough.
    pub fn can_be_stiff(&self) -> bool {
        self.turning().count() <= MOST_SLIPS
    }

    fn turning(&self) -> impl Iterator<Item = usize> + '_ {
        let turns =
            |held: &super::forces::Held| held.slides().is_some() && matches!(held.slip, Slip::Fast | Slip::Young(_));
        self.held.iter().enumerate().filter(move |(_, held)| turns(held)).map(|(i, _)| i)
    }

    /// Rates, and all turns if asked for; `as_before`: with slips along these directions, turned as far as they have
    /// begun to.
    fn turned(
        &mut self,
        t_s: f64,
        (bodies, y): (&[usize], &[Phase]),
        (as_before, turns): (Option<&[Mode]>, bool),
        rates: &mut [Phase],
    ) -> Vec<Turn> {
        self.place(t_s, bodies, y);
        let mut modes: Vec<Mode> = self.gathered.modes(self.held).collect();
        for (i, before) in self.turning().zip(as_before.unwrap_or_default()) {
            if let Mode::Slide(d) = before {
                modes[i] = Mode::Slide(along(d, &self.gathered.here[i].contact.normal));
            }
        }
        let solved = self.gathered.hold_as(modes.iter().copied(), self.choice);
        self.rates(bodies, y, &solved, rates);
        if !turns {
            return Vec::new();
        }
        let mut turns = Vec::new();
        let told = self.gathered.told(&modes, &solved);
        for i in self.turning() {
            let (here, Mode::Slide(d)) = (&self.gathered.here[i], modes[i]) else { continue };
            let (slip, t_W) = (here.slip_W(), here.contact.normal.cross(&d));
            let speed = d.dot(&slip);
            // What has just begun keeps the direction in which it did.
            let keeps = matches!(self.held[i].slip, Slip::Young(until_m_s) if slip.norm() <= until_m_s);
            if speed <= 0.0 || keeps {
                continue;
            }
            let changes = told.as_ref().and_then(|told| told.turn(i, &t_W));
            let changes = changes.unwrap_or_else(|| {
                let mut now = modes.clone();
                now[i] = Mode::Slide(d * libm::cos(TURN_RAD) + t_W * libm::sin(TURN_RAD));
                let after = self.gathered.hold_as(now.into_iter(), self.choice);
                let rate = |(a, b): (&Twist, &Twist)| Twist { v: a.v - b.v, w: a.w - b.w }.times(1.0 / TURN_RAD);
                after.added.iter().zip(&solved.added).map(rate).collect()
            });
            let does = |b: &usize| {
                let (v, w) = (changes[*b].v, changes[*b].w);
                let w_B = self.state.bodies[*b].q_WB.inverse_transform_vector(&w);
                Vector6::new(v.x, v.y, v.z, w_B.x, w_B.y, w_B.z)
            };
            let mut from = Vec::new();
            for (b, r_W, sign) in here.contact.ends() {
                if let Some(place) = bodies.iter().position(|body| *body == b) {
                    let w_B = self.state.bodies[b].q_WB.inverse_transform_vector(&r_W.cross(&t_W));
                    from.push((place, Vector6::new(t_W.x, t_W.y, t_W.z, w_B.x, w_B.y, w_B.z) * (sign / speed)));
                }
            }
            let turn = Turn { does: bodies.iter().map(does).collect(), from };
            if as_before.is_some() {
                let angle = t_W.dot(&slip) / speed;
                rates.iter_mut().zip(&turn.does).for_each(|(rate, does)| add(rate, &(does * angle)));
            }
            turns.push(turn);
        }
        turns
    }
}

fn velocity(y: &Phase) -> Vector6<f64> {
    y.fixed_rows::<6>(3).into_owned()
}

fn add(y: &mut Phase, change: &Vector6<f64>) {
    let mut rows = y.fixed_rows_mut::<6>(3);
    rows += change;
}

/// One try of a step: its stages, and its error over the tolerance. None: no such step is found.
pub fn attempt(
    field: &mut Field,
    bodies: &[usize],
    [t_s, h]: [f64; 2],
    y: &[Phase],
    scale: impl Fn(f64) -> f64,
) -> Option<(Vec<Vec<Phase>>, f64)> {
    let n = y.len();
    field.place(t_s, bodies, y);
    let modes: Vec<Mode> = field.gathered.modes(field.held).collect();
    let before: Vec<Mode> = field.turning().map(|i| modes[i]).collect();
    let mut stages = vec![y.to_vec(); STAGES];
    let mut rates = vec![vec![Phase::zeros(); n]; STAGES];
    let mut last = f64::INFINITY;
    for tries in 0..MOST {
        follow(y, h, &mut stages, TURNS_AT_ONCE);
        let as_before = (tries <= AS_BEFORE).then_some(&before[..]);
        let mut turns = Vec::with_capacity(STAGES);
        for j in 0..STAGES {
            let at = t_s + NODES[j] * h;
            turns.push(field.turned(at, (bodies, &stages[j]), (as_before, tries >= AS_BEFORE), &mut rates[j]));
        }
        if field.gathered.deadline.is_over() {
            return None;
        }
        let changes = changes(y, h, &stages, &rates, &turns)?;
        let (mut size, mut largest, mut fastest) = (0.0, 0.0_f64, 0.0_f64);
        for (stage, changes) in stages.iter_mut().zip(&changes) {
            for (y, change) in stage.iter_mut().zip(changes) {
                add(y, change);
                let of = velocity(y).zip_map(change, |v, change| change / scale(v.abs()));
                size += of.norm_squared();
                largest = largest.max(change.amax());
                fastest = fastest.max(velocity(y).amax());
            }
        }
        let size = (size / (6 * n * STAGES) as f64).sqrt();
        if !size.is_finite() || (tries > AS_BEFORE + 3 && size > 2.0 * last) {
            return None;
        }
        // What is left falls as these changes do.
        let falls = size / last;
        let left = if tries > AS_BEFORE + 1 && falls < 1.0 { size * falls / (1.0 - falls) } else { size };
        last = size;
        if tries > AS_BEFORE && (left <= SETTLED || largest <= ROUNDING * fastest) {
            follow(y, h, &mut stages, 2 * TURNS_AT_ONCE);
            let error = error(y, &stages, scale);
            return Some((stages, error));
        }
    }
    None
}

/// Positions and attitudes of the stages by their velocities.
fn follow(y: &[Phase], h: f64, stages: &mut [Vec<Phase>], turns: u32) {
    for i in 0..y.len() {
        for turn in 0..turns {
            let rate = |stage: &Vec<Phase>| {
                let y = &stage[i];
                let q = Quaternion::from(y.fixed_rows::<4>(9).into_owned());
                (q * Quaternion::from_imag(y.fixed_rows::<3>(6).into_owned()) / 2.0).coords
            };
            let rates: Vec<_> = stages.iter().map(rate).collect();
            let speeds: Vec<Vector3<f64>> =
                stages.iter().map(|stage| stage[i].fixed_rows::<3>(3).into_owned()).collect();
            for (stage, row) in stages.iter_mut().zip(&A) {
                let (mut q, mut p) = (y[i].fixed_rows::<4>(9).into_owned(), y[i].fixed_rows::<3>(0).into_owned());
                for ((a, rate), v) in row.iter().zip(&rates).zip(&speeds) {
                    q += rate * (a * h);
                    p += v * (a * h);
                }
                stage[i].fixed_rows_mut::<4>(9).copy_from(&q);
                if turn == 0 {
                    stage[i].fixed_rows_mut::<3>(0).copy_from(&p);
                }
            }
        }
    }
}

/// Changes of the stages' velocities by one step of Newton's method.
fn changes(
    y: &[Phase],
    h: f64,
    stages: &[Vec<Phase>],
    rates: &[Vec<Phase>],
    turns: &[Vec<Turn>],
) -> Option<Vec<Vec<Vector6<f64>>>> {
    let n = y.len();
    let mut changes: Vec<Vec<Vector6<f64>>> = Vec::with_capacity(STAGES);
    for (stage, row) in stages.iter().zip(&A) {
        let missed = |b: usize| {
            let gained = row.iter().zip(rates).fold(Vector6::zeros(), |sum, (a, k)| sum + velocity(&k[b]) * (a * h));
            gained - (velocity(&stage[b]) - velocity(&y[b]))
        };
        changes.push((0..n).map(missed).collect());
    }
    let places: Vec<(usize, &Turn)> =
        turns.iter().enumerate().flat_map(|(j, turns)| turns.iter().map(move |turn| (j, turn))).collect();
    let m = places.len();
    if m == 0 {
        return Some(changes);
    }
    let seen = |turn: &Turn, of: &[Vector6<f64>]| turn.from.iter().map(|(b, from)| from.dot(&of[*b])).sum::<f64>();
    let mut M = DMatrix::identity(m, m);
    for (r, (j, turn)) in places.iter().enumerate() {
        for (c, (k, other)) in places.iter().enumerate() {
            M[(r, c)] -= h * A[*j][*k] * seen(turn, &other.does);
        }
    }
    let rhs = DVector::from_iterator(m, places.iter().map(|(j, turn)| seen(turn, &changes[*j])));
    let angles = M.lu().solve(&rhs)?;
    for ((k, turn), angle) in places.iter().zip(angles.iter()) {
        for (changes, row) in changes.iter_mut().zip(&A) {
            let part = h * row[*k] * angle;
            changes.iter_mut().zip(&turn.does).for_each(|(change, does)| *change += does * part);
        }
    }
    Some(changes)
}

/// By how much the polynomial of the stages differs from one of a degree less, over the tolerance.
fn error(y: &[Phase], stages: &[Vec<Phase>], scale: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for (i, y) in y.iter().enumerate() {
        let mut leading = Phase::zeros();
        stages.iter().zip(&NESTED[STAGES - 1]).for_each(|(stage, weight)| leading += (stage[i] - y) * *weight);
        let scale = y.zip_map(&stages[STAGES - 1][i], |a, b| scale(a.abs().max(b.abs())));
        sum += (leading * LEAST_DEVIATION).component_div(&scale).norm_squared();
    }
    (sum / (y.len() * Phase::zeros().len()) as f64).sqrt()
}

/// The polynomial of the stages, in the form of the continuous extension.
pub fn polynomial(y: &[Phase], stages: &[Vec<Phase>], spline: &mut [[Phase; STAGES + 1]]) {
    for (i, (y, spline)) in y.iter().zip(spline).enumerate() {
        spline[0] = *y;
        for (coefficient, row) in spline[1..].iter_mut().zip(&NESTED) {
            *coefficient = Phase::zeros();
            stages.iter().zip(row).for_each(|(stage, weight)| *coefficient += (stage[i] - y) * *weight);
        }
    }
}
