//! How far impulses are from the law of contact, of all contacts of a problem at once.

use super::Impulse;
use super::block::Block;
use super::end::End;
use super::law;
use super::problem::ContactProblem;
use super::speeds::{Acted, relative};
use super::twist::Twist;
use nalgebra::Vector3;

/// Of what a step does to a body: a velocity that is a slip. And sine of an angle between slips that are one.
const SLIP: f64 = 1e-9;
const ONE_WAY: f64 = 1e-6;

/// The largest residual of all contacts, by what every body gets alone, however much presses it. `u`: M⁻¹ Jᵀ p.
pub fn strict_residual(problem: &ContactProblem, p: &[Impulse], u: &[Twist]) -> f64 {
    let scale = |block: &Block| {
        let moved = block.ends().map(|end| (end, end.compliance())).filter(|(_, compliance)| *compliance > 0.0);
        let of = |(end, compliance): (&End, f64)| acted(problem, end, u) / compliance;
        moved.map(of).fold(f64::INFINITY, f64::min)
    };
    let missed = |(block, p): (&Block, &Impulse)| {
        let c = block.velocity(u) / block.A.trace();
        let missed = relative(law::missed(p, &c, block.law()), scale(block));
        if missed.is_nan() { f64::INFINITY } else { missed }
    };
    problem.blocks.iter().zip(p).map(missed).fold(0.0, f64::max)
}

/// Speed that the step gives the body of a contact there.
fn acted(problem: &ContactProblem, end: &End, u: &[Twist]) -> f64 {
    let changed = [u[end.body].v.norm(), u[end.body].w.norm()];
    Acted { speeds: problem.speeds[end.body], changed, pressed: 0.0 }.at(end.arm_m())
}

/// Whether some contacts slip different ways, and are so many that the law leaves open how they share what presses
/// them: then that decides how the slip turns.
pub fn shares_matter(
    problem: &ContactProblem,
    contacts: impl ExactSizeIterator<Item = usize>,
    p: &[Impulse],
    u: &[Twist],
) -> bool {
    let slip = |i: usize| {
        let (block, p) = (&problem.blocks[i], &p[i]);
        let c = block.velocity(u);
        let slip_W = block.along_W(&c);
        let least = SLIP * block.ends().map(|end| acted(problem, end, u)).fold(0.0, f64::max);
        (p.x > 0.0 && block.friction > 0.0 && block.pin.is_none() && slip_W.norm() > least).then(|| slip_W.normalize())
    };
    let are_many = contacts.len() > 3;
    let mut slips = contacts.filter_map(slip);
    are_many && slips.next().is_some_and(|first| slips.any(|slip_W: Vector3<f64>| (slip_W - first).norm() > ONE_WAY))
}
