//! Laws of powers, and whether points have one: too few, too scattered, bent, or off their own intervals is none.

use std::collections::BTreeSet;

/// Law y = a xᵇ through points, by least squares of the logarithms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    pub factor: f64,
    pub exponent: f64,
    /// Half the width of the exponent's interval with 95 % confidence; None of two points.
    pub margin: Option<f64>,
}

impl PowerLaw {
    /// The law of points that are all positive, whether they have one or not; None of fewer than two places.
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (libm::log(*x), libm::log(*y))).collect();
        let n = logs.len() as f64;
        let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
        let xx: f64 = logs.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum();
        let xy: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
        let exponent = Some(xy / xx).filter(|slope| slope.is_finite())?;
        let left: f64 = logs.iter().map(|p| p.1 - my - exponent * (p.0 - mx)).map(|d| d * d).sum();
        let margin = (logs.len() > 2).then(|| student(logs.len() - 2) * (left / (n - 2.0) / xx).sqrt());
        Some(PowerLaw { factor: libm::exp(my - exponent * mx), exponent, margin })
    }

    /// Exponent with its interval, as it is written; no minus before a zero.
    pub fn written(&self) -> String {
        let margin = self.margin.map(|margin| format!(" ± {margin:.2}")).unwrap_or_default();
        format!("{:.2}{margin}", self.exponent).replace("-0.00", "0.00")
    }

    pub fn at(&self, x: f64) -> f64 {
        self.factor * libm::exp(self.exponent * libm::log(x))
    }
}

/// Places of an axis without which a law is a guess: three leave one degree of freedom, and a factor 12.7 in the
/// interval.
const LEAST_PLACES: usize = 4;
/// Widest half of an interval of an exponent: beyond it a root cannot be told from a constant or from proportionality.
const WIDEST: f64 = 0.25;
/// Change of the local exponent over all places that is a bend, if it is none of chance.
const BEND: f64 = 0.2;

/// What points say of a law y = a xᵇ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PowerFit {
    Holds(PowerLaw),
    /// Number of places.
    TooFew(usize),
    /// The exponent is not known.
    Scattered(PowerLaw),
    /// The exponent may be 0: its interval holds it.
    Flat(PowerLaw),
    /// A parabola in the logarithms is better than chance would have it (t-test, 5 %): exponents at both ends.
    Bends(f64, f64),
    /// So many of the points have the law outside of their intervals, which chance leaves to one of twenty (binomial
    /// test, 5 %).
    OutsideOfIntervals(usize, usize),
}

impl PowerFit {
    /// The fit of positive points; `intervals` are those of each point with 95 %, where they are known.
    pub fn of(points: &[(f64, f64)], intervals: &[(f64, f64)]) -> Self {
        let places = points.iter().map(|(x, _)| x.to_bits()).collect::<BTreeSet<_>>().len();
        let law = PowerLaw::fit(points).filter(|_| places >= LEAST_PLACES);
        let Some((law, margin)) = law.and_then(|law| Some((law, law.margin?))) else {
            return PowerFit::TooFew(places);
        };
        if let Some((first, last)) = bend(points, &law) {
            return PowerFit::Bends(first, last);
        }
        let is_outside = |((x, _), (low, high)): &(&(f64, f64), &(f64, f64))| !(*low..=*high).contains(&law.at(*x));
        let outside = points.iter().zip(intervals).filter(is_outside).count();
        match outside {
            n if n > 0 && at_least(n, intervals.len().min(points.len())) < 0.05 => {
                PowerFit::OutsideOfIntervals(n, points.len())
            }
            _ if margin > WIDEST => PowerFit::Scattered(law),
            _ if law.exponent.abs() <= margin => PowerFit::Flat(law),
            _ => PowerFit::Holds(law),
        }
    }
}

/// Local exponents at the first and the last place, where a parabola says that they differ.
fn bend(points: &[(f64, f64)], law: &PowerLaw) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let mean = points.iter().map(|(x, _)| libm::log(*x)).sum::<f64>() / n;
    // Places from their mean, and what a straight line leaves.
    let left: Vec<(f64, f64)> =
        points.iter().map(|(x, y)| (libm::log(*x) - mean, libm::log(*y) - libm::log(law.at(*x)))).collect();
    let sum = |of: &dyn Fn(f64, f64) -> f64| left.iter().map(|(u, d)| of(*u, *d)).sum::<f64>();
    let (square, skew) = (sum(&|u, _| u * u), sum(&|u, _| u * u * u));
    // A parabola without mean and without slope.
    let parabola = |u: f64| u * u - skew / square * u - square / n;
    let size = sum(&|u, _| parabola(u) * parabola(u));
    let curved = Some(sum(&|u, d| parabola(u) * d) / size).filter(|curved| curved.is_finite())?;
    let rest = (sum(&|_, d| d * d) - curved * curved * size).max(0.0);
    let margin = student(points.len().checked_sub(3)?.max(1)) * (rest / (n - 3.0).max(1.0) / size).sqrt();
    let slope = |u: f64| law.exponent + curved * (2.0 * u - skew / square);
    let (low, high) = left.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (u, _)| (a.min(*u), b.max(*u)));
    let (first, last) = (slope(low), slope(high));
    (curved.abs() > margin && (last - first).abs() > BEND).then_some((first, last))
}

/// Chance that at least k of n intervals of 95 % miss.
fn at_least(k: usize, n: usize) -> f64 {
    let mut below = 0.0;
    let mut term = libm::exp(n as f64 * libm::log(0.95));
    for i in 0..k {
        below += term;
        term *= (n - i) as f64 / (i + 1) as f64 * (0.05 / 0.95);
    }
    1.0 - below
}

/// 97.5 % quantile of Student's t.
fn student(degrees: usize) -> f64 {
    const TABLE: [f64; 10] = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];
    let large = |n: f64| 1.96 + 2.4 / n + 3.0 / (n * n);
    TABLE.get(degrees.saturating_sub(1)).copied().unwrap_or_else(|| large(degrees as f64))
}
