//! One try of Dormand and Prince's step of order 8, for whoever makes such steps: the stages, the end, and the
//! estimate of its error (Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, II.5 and II.10).

use super::dop853_tableau::{A, B, B3, E5, NODES};
use super::field::{advanced, sum};
use super::phase::Phase;

/// From `y` at a time, h long, puts the end into `end` and the slopes on the way into `k`, whose first is that of
/// `y`. `f`: ẏ. `scale`: the error that is as large as it may be, of a component of this size. The error, over that.
pub fn attempt(
    f: &mut impl FnMut(f64, &[Phase], &mut [Phase]),
    [t_s, h]: [f64; 2],
    scale: impl Fn(f64) -> f64,
    y: &[Phase],
    end: &mut [Phase],
    k: &mut [Vec<Phase>],
) -> f64 {
    for (i, row) in A.iter().enumerate() {
        advanced(y, row, k, h, end);
        f(t_s + NODES[i + 1] * h, end, &mut k[i + 1]);
    }
    let (mut error5, mut error3) = (0.0, 0.0);
    for (i, (y, end)) in y.iter().zip(end).enumerate() {
        let slope = sum(&B, k, i);
        *end = y + slope * h;
        let scale = y.zip_map(end, |a, b| scale(a.abs().max(b.abs())));
        error5 += sum(&E5, k, i).component_div(&scale).norm_squared();
        error3 += (slope - sum(&B3, k, i)).component_div(&scale).norm_squared();
    }
    combined(error5, error3, h, y.len() * Phase::zeros().len())
}

/// The estimate of order 5, made smaller where that of order 3 is much larger (II.10): of order 7 in h.
fn combined(error5: f64, error3: f64, h: f64, components: usize) -> f64 {
    let both = error5 + 0.01 * error3;
    if both == 0.0 { 0.0 } else { h * error5 / (both * components as f64).sqrt() }
}
