//! Each method against its own recurrence, the exact motion, and what it should conserve.

mod assemblies;
mod auto;
mod blocks;
mod cone;
mod contact;
mod cycles;
mod default;
mod divergence;
mod free;
mod impact;
mod impact_energy;
mod known_problems;
mod laws;
mod lecture;
mod lemke;
mod loads;
mod newton;
mod orders;
mod penalty;
mod piles;
mod pins_by_hand;
mod reference;
mod residual;
mod scenes;
mod seams;
mod shots;
mod skipping;
mod skips;
mod symmetries;
mod taylor;
mod turning;

/// The fitted order.
pub fn order(steps: &[f64], errors: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = steps.iter().copied().zip(errors.iter().copied()).collect();
    gotai::math::order::fit(&points).unwrap().slope
}
