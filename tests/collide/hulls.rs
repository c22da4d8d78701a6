use super::oracle::Draws;
use gotai::shape::hull::{Hull, HullError};
use nalgebra::Vector3;

fn cube() -> Vec<Vector3<f64>> {
    (0..8).map(|i| Vector3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect()
}

#[test]
fn a_cubes_twelve_triangles_are_six_squares() {
    let turn = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::new(0.3, 0.5, 0.7));
    for vertices in [cube(), cube().iter().map(|v| turn * v + Vector3::repeat(7.0)).collect()] {
        let hull = Hull::new(vertices).unwrap();
        assert_eq!((hull.faces.len(), hull.edge_directions.len()), (6, 3));
        assert!(hull.faces.iter().all(|face| face.corners.len() == 4));
        // measured: 3.6e-15
        assert!((hull.area_m2() - 6.0).abs() < 1e-13);
    }
}

/// Euler: V − E + F = 2; all vertices behind every face; every face counter-clockwise.
#[test]
fn random_points_of_a_sphere_are_a_closed_polyhedron() {
    let mut draws = Draws(3);
    for n in [4, 5, 8, 30, 120] {
        let hull = Hull::new((0..n).map(|_| draws.direction()).collect()).unwrap();
        let edges: usize = hull.faces.iter().map(|face| face.corners.len()).sum::<usize>() / 2;
        assert_eq!(n + hull.faces.len(), edges + 2);
        for face in &hull.faces {
            let at = |i: usize| hull.vertices[face.corners[i] as usize];
            assert!((at(1) - at(0)).cross(&(at(2) - at(0))).dot(&face.normal) > 0.0);
            for v in &hull.vertices {
                // measured: 2.2e-16
                assert!(face.normal.dot(&(v - at(0))) < 1e-14);
            }
        }
    }
}

#[test]
fn what_is_no_corner_is_named() {
    let with = |more: [f64; 3]| Hull::new(cube().into_iter().chain([more.into()]).collect());
    for inner in [[0.5, 0.5, 0.5], [0.5, 0.5, 0.0], [0.5, 0.0, 0.0], [1.0, 1.0, 1.0], [0.5, 1.0, 1.0 - 1e-12]] {
        assert_eq!(with(inner), Err(HullError::NotConvex(8)), "{inner:?}");
    }
    assert!(with([0.5, 0.5, 1.1]).is_ok());
    assert_eq!(Hull::new(cube()[..4].to_vec()), Err(HullError::Flat));
    assert_eq!(Hull::new(cube()[..3].to_vec()), Err(HullError::Few(3)));
    assert_eq!(Hull::new(vec![Vector3::zeros(); 5]), Err(HullError::Flat));
}
