use super::oracle::{Draws, about, at, level_at, reach, solids};
use gotai::shape::solid::{Meeting, Pose, Solid, plane_touches};
use nalgebra::{UnitQuaternion, Vector3};

fn on_floor(solid: &Solid, pose: &Pose, margin_m: f64) -> Vec<Meeting> {
    let mut touches = Vec::new();
    plane_touches(solid, pose, &Vector3::y(), 0.0, margin_m, &mut touches);
    touches
}

fn standing(solid: &Solid, q_W: UnitQuaternion<f64>) -> Pose {
    let mut pose = Pose { p_W: Vector3::zeros(), q_W };
    pose.p_W.y = reach(solid, &pose, &-Vector3::y());
    pose
}

#[test]
fn the_deepest_point_is_on_the_surface_and_as_deep_as_the_solid() {
    let mut draws = Draws(1);
    for solid in solids() {
        for _ in 0..200 {
            let pose = Pose { p_W: draws.vector(), q_W: draws.attitude() };
            let (normal, offset_m) = (draws.direction(), draws.next());
            let mut touches = Vec::new();
            plane_touches(&solid, &pose, &normal, offset_m, 10.0, &mut touches);
            let deepest = touches.iter().min_by(|a, b| a.gap_m.total_cmp(&b.gap_m)).unwrap();
            let truth = -reach(&solid, &pose, &-normal) - offset_m;
            // measured: 6.7e-16
            assert!((deepest.gap_m - truth).abs() < 1e-14, "{solid:?}");
            for touch in &touches {
                let ends = [0.5, -0.5].map(|part| touch.p_W + normal * (part * touch.gap_m));
                // No point of the solid's is outside of it; measured: 1.0e-15 and 1.4e-15
                assert!(level_at(&solid, &pose, &ends[0]) < 1e-14, "{solid:?}");
                assert!((normal.dot(&ends[1]) - offset_m).abs() < 1e-14, "{solid:?}");
            }
            let on_surface = deepest.p_W + normal * (0.5 * deepest.gap_m);
            assert!(level_at(&solid, &pose, &on_surface).abs() < 1e-14, "{solid:?}");
        }
    }
}

/// Name, what stands how, and the numbers of its points.
#[test]
fn what_lies_on_a_plane_touches_in_all_points_that_hold_it_whatever_the_last_bit_says() {
    let flat = UnitQuaternion::identity();
    let lying = about(Vector3::z(), std::f64::consts::FRAC_PI_2);
    let solids = solids();
    let rows = [
        (&solids[0], flat, vec![0]),
        (&solids[1], flat, vec![0, 1, 4, 5]),
        (&solids[2], flat, vec![0, 1, 2, 3]),
        (&solids[2], lying, vec![0, 4]),
        (&solids[3], flat, vec![0]),
        (&solids[3], lying, vec![0, 1]),
        (&solids[4], flat, vec![0]),
    ];
    let mut draws = Draws(2);
    for (solid, q_W, features) in rows {
        for _ in 0..50 {
            let mut pose = standing(solid, q_W * about(draws.direction(), 1e-13 * draws.next()));
            pose.p_W.y += 1e-13 * draws.next();
            let found: Vec<u32> = on_floor(solid, &pose, 1e-6).iter().map(|touch| touch.feature.0).collect();
            assert_eq!(found, features, "{solid:?}");
        }
    }
}

#[test]
fn a_rolling_disk_touches_in_its_lowest_point() {
    let disk = Solid::Cylinder { radius_m: 0.5, half_height_m: 0.01 };
    for spin in [0.0, 1.0, 2.0, 3.0] {
        let q_W = about(Vector3::x(), 0.6) * about(Vector3::y(), spin);
        let touches = on_floor(&disk, &standing(&disk, q_W), 1e-6);
        assert_eq!(touches.len(), 1);
        assert!(touches[0].feature == (0, 0) || touches[0].feature == (4, 0));
        // The same point of space, however far it has turned; measured: 5.6e-17
        assert!(touches[0].p_W.x.abs() < 1e-14);
    }
}

#[test]
fn what_is_beyond_the_margin_does_not_touch() {
    for solid in solids() {
        let mut pose = standing(&solid, UnitQuaternion::identity());
        pose.p_W.y += 0.1;
        assert!(on_floor(&solid, &pose, 0.0999).is_empty() && !on_floor(&solid, &pose, 0.1001).is_empty());
        assert!(on_floor(&solid, &at(Vector3::y() * 10.0), 0.1).is_empty());
    }
}
