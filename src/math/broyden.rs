//! Broyden's method for a fixed point z = G(z) of a few unknowns: like the plain iteration where that contracts, and
//! beyond (C. G. Broyden, Math. Comp. 19 (1965) 577; the form with the steps alone: C. T. Kelley, Solving Nonlinear
//! Equations with Newton's Method, SIAM 2003, 4.3).

/// Memory of the method, kept from one solve to the next, so that none allocates.
#[derive(Debug, Default)]
pub struct Broyden {
    /// Steps made, one after the other, each as long as z.
    steps: Vec<f64>,
}

/// Most steps. Smooth equations of a step take 2 to 12.
const MOST: usize = 60;

impl Broyden {
    pub fn with_unknowns(unknowns: usize) -> Self {
        Broyden { steps: Vec::with_capacity(MOST * unknowns) }
    }

    /// Solves from the guess in `z`. `residual(z, out)` puts G(z) − z into `out` and says whether that is small enough;
    /// None from it, like no end of the iteration, is failure.
    pub fn solve(
        &mut self,
        z: &mut [f64],
        step: &mut [f64],
        mut residual: impl FnMut(&[f64], &mut [f64]) -> Option<bool>,
    ) -> bool {
        let n = z.len();
        self.steps.clear();
        for _ in 0..MOST {
            match residual(z, step) {
                None => return false,
                Some(true) => return true,
                Some(false) => {}
            }
            self.correct(step);
            z.iter_mut().zip(step.iter()).for_each(|(z, s)| *z += s);
            self.steps.extend_from_slice(&step[..n]);
        }
        false
    }

    /// Turns −B₀⁻¹F, with B₀ = −1, into −B⁻¹F by all updates so far.
    fn correct(&self, step: &mut [f64]) {
        let n = step.len();
        let mut made = self.steps.chunks_exact(n).peekable();
        while let Some(s) = made.next() {
            let part = part(step, s);
            match made.peek() {
                Some(next) => step.iter_mut().zip(*next).for_each(|(x, next)| *x += next * part),
                None => step.iter_mut().for_each(|x| *x /= 1.0 - part),
            }
        }
    }
}

/// s·x / s·s, also where the squares underflow.
fn part(x: &[f64], s: &[f64]) -> f64 {
    let largest = s.iter().fold(0.0, |max: f64, s| max.max(s.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    let scaled = |a: &[f64]| a.iter().zip(s).map(|(a, s)| (a / largest) * (s / largest)).sum::<f64>();
    scaled(x) / scaled(s)
}
