//! Two boxes: all fifteen axes that can part them (S. Gottschalk, M. C. Lin, D. Manocha, OBBTree, SIGGRAPH 1996).

use super::parting::Parting;
use super::posed::Posed;
use nalgebra::Vector3;

/// Sine of an angle: edges that are more nearly parallel span no axis of their own.
const PARALLEL: f64 = 1e-9;

pub fn boxes(a: &Posed, half_a: &Vector3<f64>, b: &Posed, half_b: &Vector3<f64>) -> Parting {
    let r = a.R.tr_mul(&(a.p - b.p));
    // Column j: axis j of b, in the axes of a.
    let C = a.R.tr_mul(&b.R);
    let size = C.abs();
    let mut best = (f64::NEG_INFINITY, Vector3::zeros());
    let mut consider = |axis: Vector3<f64>, along: f64, reach: f64| {
        let gap_m = along.abs() - reach;
        if gap_m > best.0 {
            best = (gap_m, axis * 1.0_f64.copysign(along));
        }
    };
    for i in 0..3 {
        consider(Vector3::ith(i, 1.0), r[i], half_a[i] + size.row(i).transpose().dot(half_b));
    }
    for j in 0..3 {
        let axis = C.column(j).into_owned();
        consider(axis, axis.dot(&r), half_b[j] + size.column(j).dot(half_a));
    }
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            // eᵢ × axis j.
            let (y, z) = (-C[(i2, j)], C[(i1, j)]);
            let length = (y * y + z * z).sqrt();
            if length > PARALLEL {
                let (y, z) = (y / length, z / length);
                let of_b = |k: usize| half_b[k] * (y * C[(i1, k)] + z * C[(i2, k)]).abs();
                let mut axis = Vector3::zeros();
                (axis[i1], axis[i2]) = (y, z);
                let reach = half_a[i1] * y.abs() + half_a[i2] * z.abs() + of_b(0) + of_b(1) + of_b(2);
                consider(axis, y * r[i1] + z * r[i2], reach);
            }
        }
    }
    Parting { gap_m: best.0, normal: a.R * best.1 }
}
