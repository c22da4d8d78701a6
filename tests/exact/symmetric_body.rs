//! The symmetric body by elementary functions against the elliptic functions of any body.

use gotai::exact::free_rotation::FreeRotation;
use gotai::exact::symmetric_body::SymmetricBody;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn angle(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>) -> f64 {
    2.0 * (a.inverse() * b).imag().norm().min(1.0).asin()
}

#[test]
fn both_closed_forms_of_a_symmetric_body_agree() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut draw = || random.random_range(-1.0..1.0_f64);
    let mut most = [0.0_f64; 2];
    for i in 0..300 {
        let axial = 0.9 + 0.8 * draw();
        // From a disc to a pencil, and spheres.
        let transverse = if i % 5 == 0 { axial } else { (1.5 + draw()).max(axial / 2.0) };
        let axis = i % 3;
        let q_WB = UnitQuaternion::new_normalize(Quaternion::new(draw(), draw(), draw(), draw()));
        let w_B = match i % 7 {
            0 => Vector3::ith(axis, 3.0),
            1 => Vector3::ith((axis + 1) % 3, -3.0),
            _ => Vector3::new(draw(), draw(), draw()) * 4.0,
        };
        let w_W = q_WB * w_B;
        let mut moments = Vector3::repeat(transverse);
        moments[axis] = axial;
        let any = FreeRotation::new(&Matrix3::from_diagonal(&moments), &q_WB, &w_W);
        let symmetric = SymmetricBody::new(transverse, axial, &Vector3::ith(axis, 2.0), &q_WB, &w_W);
        for t_s in [-2.0, 0.0, 0.7, 30.0, 1e4] {
            let ((q, w), (p, v)) = (any.at(t_s), symmetric.at(t_s));
            most = [most[0].max(angle(&q, &p)), most[1].max((w - v).norm() / v.norm())];
        }
    }
    println!("{most:?}");
    // measured: 1.5e-15 rad and 2.2e-15, after up to 10⁴ s
    assert!(most.iter().all(|x| *x < 1e-13), "{most:?}");
}
