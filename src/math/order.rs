//! The order of a method: the slope of log error against log step.
//!
//! Points in the rounding floor say nothing about the order and are left out: from coarse to fine, everything from
//! where an error far below the largest stops falling, or is below what is known to be rounding. What is fitted is the
//! slope of the least-squares line through the rest (L3).

/// A fitted order.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    pub slope: f64,
    /// Slopes between neighbours, from coarse to fine.
    pub pairwise: Vec<f64>,
    /// Number of points in the rounding floor.
    pub left_out: usize,
}

/// Order of (step, error) pairs, all positive; None with fewer than two points above the rounding floor.
pub fn fit(points: &[(f64, f64)]) -> Option<Order> {
    fit_above(points, 0.0)
}

/// The same where errors up to a size are known to be rounding, whether they fall or not.
pub fn fit_above(points: &[(f64, f64)], floor: f64) -> Option<Order> {
    let mut points: Vec<(f64, f64)> = points.iter().map(|(h, e)| (libm::log(*h), libm::log(*e))).collect();
    if points.iter().any(|(h, e)| !h.is_finite() || e.is_nan() || *e == f64::INFINITY) {
        return None;
    }
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    let all = points.len();
    let known = points.iter().take_while(|(_, e)| *e > libm::log(floor)).count();
    points.truncate(known.min(above_floor(&points)));
    if points.len() < 2 {
        return None;
    }
    let pairwise = points.windows(2).map(|pair| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).collect();
    Some(Order { slope: slope(&points)?, pairwise, left_out: all - points.len() })
}

/// Number of points, from the coarsest, that come before the error stops falling; an error of 0 is rounding too.
fn above_floor(points: &[(f64, f64)]) -> usize {
    /// Nearer to the largest error than this, an error that does not fall is the method's and no rounding.
    const FAR: f64 = 1e-2;
    let finite = points.iter().take_while(|(_, e)| e.is_finite()).count();
    let largest = points[..finite].iter().map(|p| p.1).fold(f64::NEG_INFINITY, f64::max);
    let stops = |pair: &[(f64, f64)]| pair[1].1 >= pair[0].1 && pair[0].1 < largest + libm::log(FAR);
    /// The floor still bends the line by a tenth at ten times its height.
    const ABOVE: f64 = 10.0;
    match points[..finite].windows(2).position(stops) {
        None => finite,
        Some(stop) => {
            let floor = points[stop].1 + libm::log(ABOVE);
            points[..stop].iter().take_while(|(_, e)| *e > floor).count()
        }
    }
}

fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let (mean_x, mean_y) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let xx: f64 = points.iter().map(|p| (p.0 - mean_x) * (p.0 - mean_x)).sum();
    let xy: f64 = points.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    Some(xy / xx).filter(|slope| slope.is_finite())
}
