//! Intervals with 95 % confidence, the same in every run.

use serde::Serialize;

/// Interval that an estimate is in with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

/// 97.5 % quantile of the normal distribution.
const Z: f64 = 1.959963984540054;

/// Numbers up to which an interval is drawn from them, above which their mean is taken for normal.
const FEW: usize = 1000;
const DRAWS: usize = 1000;

/// Interval of the share of `k` in `n` (E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209).
pub fn of_share(k: usize, n: usize) -> Interval {
    if n == 0 {
        return Interval { low: 0.0, high: 1.0 };
    }
    let (k, n) = (k as f64, n as f64);
    let (p, z2) = (k / n, Z * Z);
    let middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let half = Z / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    // Exact at the ends, where rounding would leave 1e-17.
    Interval { low: if k == 0.0 { 0.0 } else { middle - half }, high: if k == n { 1.0 } else { middle + half } }
}

/// Interval of the mean of numbers: of few the percentiles of means of draws with replacement (B. Efron, Ann. Stat. 7
/// (1979) 1), of many the normal one. None of fewer than two.
pub fn of_mean(values: &[f64]) -> Option<Interval> {
    let n = values.len();
    if n < 2 {
        return None;
    }
    let mean = values.iter().sum::<f64>() / n as f64;
    if n > FEW {
        let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1) as f64;
        let half = Z * (variance / n as f64).sqrt();
        return Some(Interval { low: mean - half, high: mean + half });
    }
    let mut state = 0;
    let mut drawn = || values[(next(&mut state) % n as u64) as usize];
    let mut means: Vec<f64> = (0..DRAWS).map(|_| (0..n).map(|_| drawn()).sum::<f64>() / n as f64).collect();
    means.sort_by(f64::total_cmp);
    let at = |share: f64| means[(share * (DRAWS - 1) as f64).round() as usize];
    Some(Interval { low: at(0.025), high: at(0.975) })
}

/// SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014).
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
