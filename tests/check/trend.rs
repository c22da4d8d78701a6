//! The two tests for a trend against published and exact values, and against chance.

use gotai::math::order;
use gotai::math::trend::{cochran_armitage, mann_kendall};

/// Alcohol of the mother and malformation of the child, five levels with equally spaced scores: M² = 1.83
/// (A. Agresti, An Introduction to Categorical Data Analysis, 2nd ed., sec. 2.5).
#[test]
fn cochran_armitage_is_that_of_the_textbook() {
    let levels = [(17114, 48), (14502, 38), (793, 5), (127, 1), (38, 1)];
    let p = cochran_armitage(&levels);
    // P(Z > √1.83); measured: 0.0882
    assert!((p - 0.0881).abs() < 5e-4, "{p}");
    let falling: Vec<_> = levels.iter().rev().copied().collect();
    assert!((p + cochran_armitage(&falling) - 1.0).abs() < 1e-12);
}

#[test]
fn nothing_or_everything_is_no_trend() {
    assert_eq!(cochran_armitage(&[(10, 0), (10, 0)]), 1.0);
    assert_eq!(cochran_armitage(&[(10, 10), (10, 10)]), 1.0);
    assert_eq!(mann_kendall(&[vec![(0, 2.0), (1, 2.0), (2, 2.0)]]), 1.0);
    assert_eq!(mann_kendall(&[vec![(0, 2.0)]]), 1.0);
}

fn cell(values: &[f64]) -> Vec<(usize, f64)> {
    values.iter().copied().enumerate().collect()
}

/// Small samples count orders: 1 of 5! rises throughout, 4 of 4! have at most one inversion.
#[test]
fn mann_kendall_is_exact_for_few_values() {
    let p = |cells: &[&[f64]]| mann_kendall(&cells.iter().map(|values| cell(values)).collect::<Vec<_>>());
    for (p, exact) in [
        (p(&[&[1.0, 2.0, 3.0, 4.0, 5.0]]), 1.0 / 120.0),
        (p(&[&[1.0, 2.0, 4.0, 3.0]]), 4.0 / 24.0),
        (p(&[&[1.0, 2.0, 3.0], &[7.0, 8.0, 9.0]]), 1.0 / 36.0),
        (p(&[&[3.0, 2.0, 1.0]]), 1.0),
    ] {
        assert!((p / exact - 1.0).abs() < 1e-12, "{p} {exact}");
    }
}

/// S = 8 with variance (5·4·15 − 2·(2·1·9))/18.
#[test]
fn mann_kendall_takes_ties_into_account() {
    let p = mann_kendall(&[cell(&[1.0, 1.0, 2.0, 3.0, 3.0])]);
    let z = 7.0 / (264.0_f64 / 18.0).sqrt();
    assert!((p / (0.5 * libm::erfc(z / 2.0_f64.sqrt())) - 1.0).abs() < 1e-12, "{p}");
}

/// Splitmix64, in [0, 1).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (x ^ (x >> 31)) as f64 / 2.0_f64.powi(64)
    }
}

/// Of 4000 samples without a trend, p ≤ 0.05 in one of twenty (σ = 0.0034), and a real trend is found.
#[test]
fn chance_is_called_a_trend_as_often_as_p_says() {
    const SAMPLES: usize = 4000;
    let mut noise = Noise(1);
    let mut called = [0; 3];
    for _ in 0..SAMPLES {
        let shares: Vec<_> = (0..6).map(|_| (40, (0..40).filter(|_| noise.next() < 0.3).count())).collect();
        let few: Vec<_> = (0..5).map(|_| cell(&[(); 6].map(|()| noise.next()))).collect();
        let many = vec![(0..80).map(|i| (i / 2, (noise.next() * 20.0).floor())).collect()];
        for (n, p) in called.iter_mut().zip([cochran_armitage(&shares), mann_kendall(&few), mann_kendall(&many)]) {
            *n += usize::from(p <= 0.05);
        }
    }
    // measured: 0.051, 0.047, 0.051
    for n in called {
        let share = n as f64 / SAMPLES as f64;
        assert!((0.038..0.062).contains(&share), "{called:?}");
    }
    let rising: Vec<_> =
        (0..6).map(|i| (40, (0..40).filter(|_| noise.next() < 0.1 + 0.1 * i as f64).count())).collect();
    assert!(cochran_armitage(&rising) < 1e-4);
}

#[test]
fn an_order_is_fitted_above_the_rounding_floor() {
    let steps: [f64; 8] = [0.1, 0.05, 0.02, 0.01, 1e-3, 1e-4, 1e-5, 1e-6];
    let floor = [0.0, 0.0, 0.0, 0.0, 0.0, 3e-14, 2e-14, 5e-14];
    let points: Vec<_> = steps.iter().zip(floor).map(|(h, floor)| (*h, 0.3 * h.powi(4) + floor)).collect();
    let order = order::fit(&points).unwrap();
    assert!((order.slope - 4.0).abs() < 1e-9 && order.left_out >= 2, "{order:?}");
    assert!(order.pairwise.iter().all(|slope| (slope - 4.0).abs() < 1e-9), "{order:?}");
    assert_eq!(order::fit(&points[..1]), None);
    assert_eq!(order::fit(&[(0.1, 0.0), (0.05, 0.0)]), None);
    // A method that gets worse has an order too.
    let worse = order::fit(&[(0.4, 1.0), (0.2, 2.0), (0.1, 4.0)]).unwrap();
    assert!((worse.slope + 1.0).abs() < 1e-12);
}
