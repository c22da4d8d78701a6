//! Principal moments and axes in double-double, by cyclic Jacobi rotations (Golub & Van Loan, Matrix Computations,
//! 4th ed., 8.5): a rounded moment would be seen after 10⁴ turns.

use crate::math::dd::{Dd, dot};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Principal moments in rising order; axes\[i\] in body axes.
pub struct Principal {
    pub moments: [Dd; 3],
    pub axes: [[Dd; 3]; 3],
}

pub fn principal(I_B: &Matrix3<f64>) -> Principal {
    /// Convergence is quadratic: four or five sweeps are enough.
    const SWEEPS: usize = 12;
    // The mean of both triangles: an inertia that was turned is symmetric to rounding only.
    let half = Dd::from(0.5);
    let mut A: [[Dd; 3]; 3] =
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| (Dd::from(I_B[(i, j)]) + Dd::from(I_B[(j, i)])) * half));
    let mut axes = [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { Dd::ONE } else { Dd::ZERO }));
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            annihilate(&mut A, &mut axes, p, q);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| A[i][i].f64().total_cmp(&A[j][j].f64()));
    Principal { moments: order.map(|i| A[i][i]), axes: order.map(|i| axes[i]) }
}

/// A ← Jᵀ A J with A_pq = 0.
fn annihilate(A: &mut [[Dd; 3]; 3], axes: &mut [[Dd; 3]; 3], p: usize, q: usize) {
    if A[p][q] == Dd::ZERO {
        return;
    }
    let twice = A[p][q] + A[p][q];
    let gap = A[q][q] - A[p][p];
    // The smaller root of t² + 2 θ t = 1, θ = gap / twice.
    let t = twice / (gap.abs() + (gap.squared() + twice.squared()).sqrt());
    let t = if gap < Dd::ZERO { -t } else { t };
    let c = Dd::ONE / (t.squared() + Dd::ONE).sqrt();
    let s = t * c;
    for row in A.iter_mut() {
        (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
    }
    for rows in [A, axes] {
        let (at_p, at_q) = (rows[p], rows[q]);
        for k in 0..3 {
            (rows[p][k], rows[q][k]) = (c * at_p[k] - s * at_q[k], s * at_p[k] + c * at_q[k]);
        }
    }
}

/// Angular velocity ω in body axes, free of rounding; q_WB is normalised here.
pub fn body_axes(q_WB: &UnitQuaternion<f64>, w_W: &Vector3<f64>) -> [Dd; 3] {
    let w = [w_W.x, w_W.y, w_W.z].map(Dd::from);
    let (s, v) = (Dd::from(q_WB.w), [-q_WB.i, -q_WB.j, -q_WB.k].map(Dd::from));
    let two = Dd::from(2.0);
    let (vv, ss, vw, vxw) = (dot(&v, &v), s.squared(), dot(&v, &w), cross(&v, &w));
    [0, 1, 2].map(|i| ((ss - vv) * w[i] + two * (vw * v[i] + s * vxw[i])) / (ss + vv))
}

pub fn cross(a: &[Dd; 3], b: &[Dd; 3]) -> [Dd; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
