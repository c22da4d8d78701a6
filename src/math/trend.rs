//! Tests for whether something rises along an axis, or does so by chance.
//!
//! Shares: Cochran–Armitage (P. Armitage, Biometrics 11 (1955) 375), scores 0, 1, 2, … by level, so that a logarithmic
//! axis and its exponent give the same answer. Numbers: Mann–Kendall, its statistic summed over the cells of the other
//! axes (R. M. Hirsch, J. R. Slack & R. A. Smith, Water Resour. Res. 18 (1982) 107), exact where nothing is tied and
//! the sample is small, else normal with continuity correction and the variance for ties (M. G. Kendall, Rank
//! Correlation Methods).

use std::cmp::Ordering;

/// Probability of a rise like this, or a stronger one, where there is no trend.
///
/// `levels` are (rows, rows of which it is true), in the order of the axis.
pub fn cochran_armitage(levels: &[(usize, usize)]) -> f64 {
    let rows: f64 = levels.iter().map(|(n, _)| *n as f64).sum();
    let share = levels.iter().map(|(_, k)| *k as f64).sum::<f64>() / rows;
    let scored = || levels.iter().enumerate().map(|(score, (n, k))| (score as f64, *n as f64, *k as f64));
    let t: f64 = scored().map(|(score, n, k)| score * (k - n * share)).sum();
    let (first, second): (f64, f64) =
        (scored().map(|(s, n, _)| n * s).sum(), scored().map(|(s, n, _)| n * s * s).sum());
    let variance = share * (1.0 - share) * (second - first * first / rows);
    if variance > 0.0 { upper_tail(t / variance.sqrt()) } else { 1.0 }
}

/// Probability of a rise like this of numbers, which are (level, value) pairs of every cell, where there is no trend.
pub fn mann_kendall(cells: &[Vec<(usize, f64)>]) -> f64 {
    let sums: Vec<Kendall> = cells.iter().map(|cell| Kendall::of(cell)).collect();
    let s: f64 = sums.iter().map(|cell| cell.s).sum();
    if let Some(p) = exact(&sums, s) {
        return p;
    }
    let variance: f64 = sums.iter().map(|cell| cell.variance).sum();
    if variance <= 0.0 {
        return 1.0;
    }
    let corrected = match s.total_cmp(&0.0) {
        Ordering::Greater => s - 1.0,
        Ordering::Less => s + 1.0,
        Ordering::Equal => 0.0,
    };
    upper_tail(corrected / variance.sqrt())
}

/// Kendall's S of one cell, and its variance without a trend.
struct Kendall {
    /// Number of pairs that rise less pairs that fall.
    s: f64,
    variance: f64,
    /// Size of the cell, if nothing is tied.
    untied: Option<usize>,
}

impl Kendall {
    fn of(pairs: &[(usize, f64)]) -> Self {
        let mut pairs = pairs.to_vec();
        pairs.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let mut values: Vec<f64> = pairs.iter().map(|pair| pair.1).collect();
        values.sort_by(f64::total_cmp);
        let x_ties = ties(&pairs, |a, b| a.0 == b.0);
        let y_ties = ties(&values, |a, b| a == b);
        values.dedup();
        let mut seen = Counts(vec![0; values.len() + 1]);
        let (mut s, mut before) = (0.0, 0);
        for level in pairs.chunk_by(|a, b| a.0 == b.0) {
            let rank = |y: f64| values.partition_point(|v| *v < y);
            for (_, y) in level {
                let (less, up_to) = (seen.below(rank(*y)), seen.below(rank(*y) + 1));
                s += less as f64 - (before - up_to) as f64;
            }
            level.iter().for_each(|(_, y)| seen.add(rank(*y)));
            before += level.len();
        }
        let is_untied = [&x_ties, &y_ties].into_iter().all(|ties| ties.iter().all(|t| *t == 1.0));
        Kendall {
            s,
            variance: variance(pairs.len() as f64, &x_ties, &y_ties),
            untied: is_untied.then_some(pairs.len()),
        }
    }
}

/// Variance of S, with groups of equal levels and of equal values.
fn variance(n: f64, x_ties: &[f64], y_ties: &[f64]) -> f64 {
    if n < 2.0 {
        return 0.0;
    }
    let sum = |ties: &[f64], of: fn(f64) -> f64| ties.iter().map(|t| of(*t)).sum::<f64>();
    let third = |t: f64| t * (t - 1.0) * (2.0 * t + 5.0);
    let pairs = |t: f64| t * (t - 1.0);
    let triples = |t: f64| t * (t - 1.0) * (t - 2.0);
    let main = (third(n) - sum(x_ties, third) - sum(y_ties, third)) / 18.0;
    let both = sum(x_ties, pairs) * sum(y_ties, pairs) / (2.0 * pairs(n));
    let three = if n > 2.0 { sum(x_ties, triples) * sum(y_ties, triples) / (9.0 * triples(n)) } else { 0.0 };
    main + both + three
}

/// Sizes of the groups of equal neighbours.
fn ties<T>(sorted: &[T], same: impl Fn(&T, &T) -> bool) -> Vec<f64> {
    sorted.chunk_by(same).map(|group| group.len() as f64).collect()
}

/// P(S ≥ s) over all orders of every cell's values: S is the number of pairs less twice the number of inversions, and
/// the inversions of n values in random order are a sum of independent uniform numbers 0 … i, i < n.
fn exact(cells: &[Kendall], s: f64) -> Option<f64> {
    /// Above it the normal distribution is as good.
    const MOST_PAIRS: usize = 2000;
    let sizes = cells.iter().map(|cell| cell.untied).collect::<Option<Vec<_>>>()?;
    let pairs: usize = sizes.iter().map(|n| n * n.saturating_sub(1) / 2).sum();
    if pairs > MOST_PAIRS {
        return None;
    }
    let mut chance = vec![1.0];
    for i in sizes.iter().flat_map(|n| 0..*n) {
        let mut next = vec![0.0; chance.len() + i];
        for (at, p) in chance.iter().enumerate() {
            next[at..=at + i].iter_mut().for_each(|q| *q += p / (i + 1) as f64);
        }
        chance = next;
    }
    let most = ((pairs as f64 - s) / 2.0) as usize;
    Some(chance[..=most.min(chance.len() - 1)].iter().sum::<f64>().min(1.0))
}

/// Counts of how often each rank has come (P. M. Fenwick, Softw. Pract. Exp. 24 (1994) 327).
struct Counts(Vec<usize>);

impl Counts {
    fn add(&mut self, rank: usize) {
        let mut i = rank + 1;
        while i < self.0.len() {
            self.0[i] += 1;
            i += i & i.wrapping_neg();
        }
    }

    /// Number of ranks less than this.
    fn below(&self, rank: usize) -> usize {
        let (mut i, mut count) = (rank, 0);
        while i > 0 {
            count += self.0[i];
            i &= i - 1;
        }
        count
    }
}

/// P(Z > z) of the standard normal distribution.
fn upper_tail(z: f64) -> f64 {
    0.5 * libm::erfc(z / std::f64::consts::SQRT_2)
}
