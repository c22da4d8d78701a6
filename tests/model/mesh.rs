use gotai::shape::mesh::{TetMesh, box_counts, box_mesh, signed_volume, sphere_mesh};
use nalgebra::Vector3;
use std::collections::HashMap;

fn meshes() -> Vec<TetMesh> {
    let size = [0.4, 0.5, 1.6];
    let boxes = [2, 3, 5].map(|n| box_mesh(size, box_counts(size, n)));
    boxes.into_iter().chain([0, 1, 3].map(|k| sphere_mesh(0.5, k))).collect()
}

#[test]
fn a_bar_has_near_cubic_cells() {
    assert_eq!(box_counts([0.4, 0.4, 1.6], 3), [3, 3, 9]);
    assert_eq!(box_counts([1.0, 1.0, 1.0], 5), [5, 5, 5]);
}

#[test]
fn an_icosphere_has_12_42_162_surface_nodes_and_a_centre() {
    for (k, nodes) in [(0, 12), (1, 42), (2, 162), (3, 642)] {
        let mesh = sphere_mesh(0.5, k);
        assert_eq!((mesh.nodes.len(), mesh.tets.len()), (nodes + 1, 2 * (nodes - 2)));
        let on_sphere = mesh.nodes.iter().filter(|u| (u.norm() - 0.5).abs() < 1e-15).count();
        assert_eq!(on_sphere, nodes);
    }
}

#[test]
fn every_tet_is_positive_and_a_box_is_filled() {
    for mesh in meshes() {
        assert!(mesh.tets.iter().all(|tet| signed_volume(&mesh.corners(tet)) > 0.0));
    }
    let size = [0.4, 0.5, 1.6];
    let mesh = box_mesh(size, box_counts(size, 4));
    let volume: f64 = mesh.tets.iter().map(|tet| signed_volume(&mesh.corners(tet))).sum();
    // measured: 5.6e-17
    assert!((volume - 0.4 * 0.5 * 1.6).abs() < 1e-15);
}

/// The order of contacts, and so part of the method: lexicographic in a box, by subdivision in a sphere.
#[test]
fn nodes_are_in_a_known_order() {
    let size = [0.4, 0.5, 1.6];
    let key = |u: &Vector3<f64>| (u.x, u.y, u.z);
    let boxed = box_mesh(size, box_counts(size, 4)).nodes;
    assert!(boxed.windows(2).all(|pair| key(&pair[0]) < key(&pair[1])));
    let (coarse, fine) = (sphere_mesh(0.5, 1).nodes, sphere_mesh(0.5, 2).nodes);
    assert_eq!((&coarse[..42], coarse[42], fine[162]), (&fine[..42], Vector3::zeros(), Vector3::zeros()));
}

#[test]
fn the_surface_is_closed_and_looks_outward() {
    for mesh in meshes() {
        let surface = mesh.surface();
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for [a, b, c] in &surface {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*from.min(to), *from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
            let [a, b, c] = [a, b, c].map(|i| mesh.nodes[*i as usize]);
            // Both shapes are star-shaped about their centre.
            assert!((b - a).cross(&(c - a)).dot(&(a + b + c)) > 0.0);
        }
        assert!(edges.values().all(|balance| *balance == 0));
    }
}
