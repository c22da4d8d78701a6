//! Statistics of figures: intervals of shares, quantiles, how much an axis says, where a share crosses a half.

use crate::math::interval::of_share;

/// The value that this share of sorted numbers does not exceed, interpolated between neighbours.
pub fn quantile(sorted: &[f64], q: f64) -> f64 {
    let at = q * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    if low == high { low } else { low + (high - low) * at.fract() }
}

/// Median of numbers; None without one.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    (!sorted.is_empty()).then(|| quantile(&sorted, 0.5))
}

/// Part of the variance of numbers that their levels explain, less what chance explains: ω² (W. L. Hays, Statistics for
/// Psychologists, 1963). Numbers come with their level.
pub fn explained(levels: usize, of: impl Iterator<Item = (usize, f64)>) -> f64 {
    let mut sums = vec![(0.0, 0.0); levels];
    let (mut n, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for (level, y) in of {
        sums[level].0 += 1.0;
        sums[level].1 += y;
        n += 1.0;
        sum += y;
        squares += y * y;
    }
    let used = sums.iter().filter(|(n, _)| *n > 0.0).count() as f64;
    let total = squares - sum * sum / n;
    if n <= used || used < 2.0 || total <= 0.0 {
        // A row a level: all is explained, and nothing said.
        return 0.0;
    }
    let between: f64 = sums.iter().filter(|(n, _)| *n > 0.0).map(|(n, s)| s * s / n).sum::<f64>() - sum * sum / n;
    let within = (total - between).max(0.0) / (n - used);
    (between - (used - 1.0) * within) / (total + within)
}

/// Means that never fall, nearest to given ones in weighted squares (pool adjacent violators).
fn rising(means: &[f64], weights: &[f64]) -> Vec<f64> {
    let mut blocks: Vec<(f64, f64, usize)> = Vec::new();
    for (mean, weight) in means.iter().zip(weights) {
        blocks.push((*mean, *weight, 1));
        while let [.., a, b] = blocks[..] {
            if a.0 <= b.0 {
                break;
            }
            blocks.truncate(blocks.len() - 2);
            let weight = a.1 + b.1;
            blocks.push(((a.0 * a.1 + b.0 * b.1) / weight, weight, a.2 + b.2));
        }
    }
    blocks.into_iter().flat_map(|(mean, _, n)| std::iter::repeat_n(mean, n)).collect()
}

/// Where a share that rises along x crosses a half, interpolated in the places `x` between levels, and the same of the
/// ends of its intervals. Levels are (x, k, n) in the order of x. None where it does not cross.
pub fn crossing(levels: &[(f64, usize, usize)]) -> Option<(f64, Option<f64>, Option<f64>)> {
    let levels: Vec<_> = levels.iter().filter(|(_, _, n)| *n > 0).copied().collect();
    let weights: Vec<f64> = levels.iter().map(|(_, _, n)| *n as f64).collect();
    let of = |share: &dyn Fn(usize, usize) -> f64| {
        let shares: Vec<f64> = levels.iter().map(|(_, k, n)| share(*k, *n)).collect();
        let shares = rising(&shares, &weights);
        let up = shares.windows(2).position(|pair| pair[0] < 0.5 && pair[1] >= 0.5)?;
        let (a, b) = (levels[up].0, levels[up + 1].0);
        Some(a + (b - a) * (0.5 - shares[up]) / (shares[up + 1] - shares[up]))
    };
    let middle = of(&|k, n| k as f64 / n as f64)?;
    Some((middle, of(&|k, n| of_share(k, n).high), of(&|k, n| of_share(k, n).low)))
}
