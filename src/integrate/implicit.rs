//! Common part of the implicit methods: their step depends on a drive that the step itself leads to. That drive is the
//! unknown; where it never changes (nothing but gravity) there is nothing to solve.

use super::chain::Chain;
use super::drive::Drive;
use crate::math::broyden::Broyden;
use crate::model::{Body, Model};
use crate::state::BodyState;
use crate::work::Work;

/// End of a body's step, and the state at which the unknown drive is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Reached {
    pub end: BodyState,
    pub seen: BodyState,
}

/// Step of a body from its start, the drive there and the unknown one; None where it has no solution.
pub type Kernel = fn(&Body, &BodyState, &[Drive; 2], f64, &mut Work) -> Option<Reached>;

/// Memory of an island's steps.
#[derive(Debug, Default)]
pub struct Scratch {
    start: Vec<BodyState>,
    ends: Vec<BodyState>,
    first: Vec<Drive>,
    z: Vec<f64>,
    step: Vec<f64>,
    broyden: Broyden,
}

impl Scratch {
    pub fn new(island: &Chain) -> Self {
        let unknowns = 6 * island.at.len();
        Scratch {
            start: island.at.clone(),
            ends: island.at.clone(),
            first: island.drives.clone(),
            z: vec![0.0; unknowns],
            step: vec![0.0; unknowns],
            broyden: Broyden::with_unknowns(unknowns),
        }
    }
}

/// Takes an island over a step of `h` from `t_s`; the unknown drive is that at `part` of the step. False where the step
/// has no solution.
pub fn step(
    kernel: Kernel,
    part: f64,
    island: &mut Chain,
    model: &Model,
    [t_s, h]: [f64; 2],
    scratch: &mut Scratch,
    work: &mut Work,
) -> bool {
    let Scratch { start, ends, first, z, step, broyden } = scratch;
    island.drive(model, t_s, work);
    start.copy_from_slice(&island.at);
    first.copy_from_slice(&island.drives);
    write(first, z);
    let solved = broyden.solve(z, step, |z, residual| {
        for i in 0..start.len() {
            let drives = [first[i], drive(&z[6 * i..])];
            let reached = kernel(island.body(i, model), &start[i], &drives, h, work)?;
            (ends[i], island.at[i]) = (reached.end, reached.seen);
        }
        if island.is_free() {
            return Some(true);
        }
        island.drive(model, t_s + part * h, work);
        write(&island.drives, residual);
        let scale = scale(residual);
        residual.iter_mut().zip(z).for_each(|(x, z)| *x -= z);
        Some(is_small(residual, scale))
    });
    island.at.copy_from_slice(ends);
    solved
}

/// Residual that is small, of the largest acceleration, and torque: what is left is made smaller still by the step that
/// it is a part of.
const SMALL: f64 = 1e-13;

/// Least scale. Below it a number has fewer digits: what decays for ever ends there.
const NOTHING: f64 = f64::MIN_POSITIVE / f64::EPSILON;

/// Largest acceleration and torque.
fn scale(drives: &[f64]) -> [f64; 2] {
    let largest =
        |from: usize| drives.chunks_exact(3).skip(from).step_by(2).flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    [largest(0), largest(1)]
}

fn is_small(residual: &[f64], [acceleration, torque]: [f64; 2]) -> bool {
    let [a, t] = scale(residual);
    a <= SMALL * acceleration + NOTHING && t <= SMALL * torque + NOTHING
}

fn write(drives: &[Drive], out: &mut [f64]) {
    for (drive, out) in drives.iter().zip(out.chunks_exact_mut(6)) {
        out[..3].copy_from_slice(drive.acceleration.as_slice());
        out[3..].copy_from_slice(drive.torque_B.as_slice());
    }
}

fn drive(z: &[f64]) -> Drive {
    Drive {
        acceleration: nalgebra::Vector3::from_column_slice(&z[..3]),
        torque_B: nalgebra::Vector3::from_column_slice(&z[3..6]),
    }
}
