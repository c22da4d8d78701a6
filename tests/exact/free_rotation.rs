//! The closed form of torque-free rotation against 40 digits (free_rotation.py).

use gotai::exact::free_rotation::FreeRotation;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    name: String,
    I_B: [[f64; 3]; 3],
    q_WB: [f64; 4],
    w_WB: [f64; 3],
    rows: Vec<Row>,
}

#[derive(Deserialize)]
struct Row {
    t_s: f64,
    q_WB: [f64; 4],
    w_WB: [f64; 3],
}

fn quaternion([w, i, j, k]: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k))
}

impl Case {
    fn all() -> Vec<Case> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/exact/free_rotation.json");
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }

    fn I_B(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.I_B[i][j])
    }

    fn start(&self) -> (UnitQuaternion<f64>, Vector3<f64>) {
        (quaternion(self.q_WB), Vector3::from(self.w_WB))
    }

    fn motion(&self) -> FreeRotation {
        let (q_WB, w_W) = self.start();
        FreeRotation::new(&self.I_B(), &q_WB, &w_W)
    }
}

/// Without arccos, which loses half the digits.
fn angle(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>) -> f64 {
    2.0 * (a.inverse() * b).imag().norm().min(1.0).asin()
}

/// L in the world and the kinetic energy.
fn conserved(I_B: &Matrix3<f64>, (q_WB, w_W): &(UnitQuaternion<f64>, Vector3<f64>)) -> (Vector3<f64>, f64) {
    let w_B = q_WB.inverse_transform_vector(w_W);
    (q_WB * (I_B * w_B), (I_B * w_B).dot(&w_B) / 2.0)
}

#[test]
fn every_body_is_where_forty_digits_say() {
    let (mut most, mut w_most) = (0.0_f64, 0.0_f64);
    for case in Case::all() {
        let motion = case.motion();
        for row in &case.rows {
            let (q_WB, w_W) = motion.at(row.t_s);
            let (off, w) = (angle(&q_WB, &quaternion(row.q_WB)), Vector3::from(row.w_WB));
            let w_off = (w_W - w).norm() / w.norm();
            println!("{}, {} s: {off:.1e} rad, ω {w_off:.1e}", case.name, row.t_s);
            (most, w_most) = (most.max(off), w_most.max(w_off));
        }
    }
    // Up to 10⁴ revolutions; measured: 3.7e-15 and 1.5e-15
    assert!(most < 1e-13 && w_most < 1e-13, "{most:.1e} rad, ω {w_most:.1e}");
}

#[test]
fn the_start_and_what_is_conserved_are_kept_to_rounding() {
    let mut most = [0.0_f64; 4];
    for case in Case::all() {
        let (motion, start, I_B) = (case.motion(), case.start(), case.I_B());
        let (at, (L, E)) = (motion.at(0.0), conserved(&I_B, &start));
        let mut here = [angle(&at.0, &start.0), (at.1 - start.1).norm() / start.1.norm(), 0.0, 0.0];
        for i in -100..1000 {
            let (L_t, E_t) = conserved(&I_B, &motion.at(f64::from(i) * 1.7));
            here[2] = here[2].max((L_t - L).norm() / L.norm());
            here[3] = here[3].max((E_t / E - 1.0).abs());
        }
        println!("{}: {}", case.name, here.map(|x| format!("{x:.1e}")).join(", "));
        most = [0, 1, 2, 3].map(|i| most[i].max(here[i]));
    }
    // measured: 3.7e-16, 1.6e-15, 2.9e-15, 5.2e-15
    assert!(most[0] < 3e-15 && most[1] < 3e-15 && most[2] < 1e-14 && most[3] < 2e-14, "{most:?}");
}

/// Printed, not judged: it is the machine's.
#[test]
fn an_evaluation_is_quick() {
    const COUNT: u32 = 200_000;
    for case in Case::all() {
        let motion = case.motion();
        let clock = std::time::Instant::now();
        let sum: f64 = (0..COUNT).map(|i| motion.at(f64::from(i) * 1e-2).0.w).sum();
        let each = clock.elapsed() / COUNT;
        println!("{}: {each:?} ({sum:.0})", case.name);
    }
}

const TILTED: [f64; 4] = [0.7977693643100509, 0.29916351161626903, -0.3988846821550254, 0.3390519798317716];

fn diagonal(moments: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(moments))
}

#[test]
fn a_body_without_spin_stays() {
    let q_WB = quaternion(TILTED);
    for moments in [[1.0, 2.0, 3.0], [2.0, 2.0, 0.0], [1.0; 3], [0.0; 3]] {
        let (q, w) = FreeRotation::new(&diagonal(moments), &q_WB, &Vector3::zeros()).at(1e3);
        assert_eq!(w, Vector3::zeros());
        // Normalised anew: a rounding or two.
        assert!(angle(&q, &q_WB) < 1e-15, "{moments:?}");
    }
}

#[test]
fn a_rod_is_the_limit_of_a_pencil_and_a_point_turns_as_it_did() {
    let (q_WB, w_W) = (quaternion(TILTED), Vector3::new(2.0, 1.0, -0.7));
    let at = |moments| FreeRotation::new(&diagonal(moments), &q_WB, &w_W).at(5.0);
    let (rod, pencil) = (at([2.0, 2.0, 0.0]), at([2.0, 2.0, 1e-12]));
    println!("rod: {:.1e}, ω {:.1e}", angle(&rod.0, &pencil.0), (rod.1 - pencil.1).norm());
    // measured: 4.9e-12 (the moment left out) and 8.0e-14
    assert!(angle(&rod.0, &pencil.0) < 1e-11 && (rod.1 - pencil.1).norm() < 1e-11);
    for moments in [[0.0; 3], [2.0; 3]] {
        let (q, w) = at(moments);
        let turned = UnitQuaternion::from_scaled_axis(w_W * 5.0) * q_WB;
        println!("point: {:.1e}, ω {:.1e}", angle(&q, &turned), (w - w_W).norm());
        // measured: 7.6e-16 and 1.1e-16
        assert!(angle(&q, &turned) < 1e-14 && (w - w_W).norm() < 1e-15);
    }
}

#[test]
fn units_do_not_matter() {
    let (q_WB, w_W) = (quaternion(TILTED), Vector3::new(2.0, 1.0, -0.7));
    let I_B = diagonal([1.0, 2.0, 2.5]);
    let (q, w) = FreeRotation::new(&I_B, &q_WB, &w_W).at(3.0);
    for scale in [f64::MIN_POSITIVE.sqrt(), f64::MIN_POSITIVE.sqrt().recip()] {
        let scaled = FreeRotation::new(&(I_B * scale), &q_WB, &(w_W * scale)).at(3.0 / scale);
        assert_eq!(scaled, (q, w * scale));
    }
}

#[test]
fn the_quaternion_does_not_jump() {
    for case in Case::all() {
        let motion = case.motion();
        let mut before = motion.at(0.0).0;
        for i in 1..2000 {
            let now = motion.at(f64::from(i) * 0.05).0;
            assert!(before.coords.dot(&now.coords) > 0.9, "{}: {i}", case.name);
            before = now;
        }
    }
}

#[test]
fn no_start_is_undefined() {
    // Axes, planes, the separatrix, and starts that are next to nothing off them.
    let (mut start, most) = (0.0_f64, [0.0, 1.0, -1.0, 3.0, 4.0, 1e-9, -1e-17, 1e-170]);
    for moments in
        [[4.0, 3.0, 1.5], [1.5, 3.0, 4.0], [2.0, 2.0, 1.0], [2.0, 2.0, 2.0], [3.0, 1.0, 2.0], [2.0, 0.0, 2.0]]
    {
        let I_B = diagonal(moments);
        for (x, y, z) in most.iter().flat_map(|x| most.iter().flat_map(move |y| most.map(|z| (*x, *y, z)))) {
            let w_W = Vector3::new(x, y, z);
            let motion = FreeRotation::new(&I_B, &UnitQuaternion::identity(), &w_W);
            let at = motion.at(0.0);
            start = start.max(angle(&at.0, &UnitQuaternion::identity()));
            assert!((at.1 - w_W).norm() <= 1e-13 * w_W.norm(), "{moments:?} {w_W:?}: {at:?}");
            for t_s in [1e-3, 1.0, 55.0, 1e6, 1e200] {
                let (q_WB, w) = motion.at(t_s);
                assert!((q_WB.norm() - 1.0).abs() < 1e-14 && w.sum().is_finite(), "{moments:?} {w_W:?} {t_s}");
            }
        }
    }
    // A phase of many units rounds next to the middle axis; 1.8e-14 seen at w = (0, 1, -1e-17)
    assert!(start < 1e-12, "{start:.1e}");
}
