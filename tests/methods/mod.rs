//! Each method against its own recurrence, the exact motion, and what it should conserve.

mod cone;
mod contact;
mod cycles;
mod divergence;
mod free;
mod lecture;
mod orders;
mod penalty;
mod residual;
mod skipping;

/// Slope of log error against log step (least squares).
pub fn order(steps: &[f64], errors: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = steps.iter().zip(errors).map(|(h, e)| (h.ln(), e.ln())).collect();
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    covariance / points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>()
}
