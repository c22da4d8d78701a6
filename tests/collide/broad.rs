use super::oracle::Draws;
use gotai::collide::broad::{Bounds, Broad};
use nalgebra::Vector3;

fn all_pairs(bounds: &[Bounds]) -> Vec<(u32, u32)> {
    let n = bounds.len() as u32;
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    pairs.filter(|(i, j)| bounds[*i as usize].overlaps(&bounds[*j as usize])).collect()
}

#[test]
fn candidates_are_those_of_all_pairs() {
    let mut draws = Draws(4);
    let (mut broad, mut pairs) = (Broad::default(), Vec::new());
    let mut found = 0;
    for n in [0, 1, 2, 3, 50, 400] {
        for largest in [0.05, 0.2, 3.0] {
            // Half of a decade in size, and a few bodies ten times as large.
            let mut bounds: Vec<Bounds> = (0..n)
                .map(|i| {
                    let size = largest * (0.55 + 0.45 * draws.next()) * if i % 37 == 36 { 10.0 } else { 1.0 };
                    Bounds::around(&(draws.vector() * 2.0), size)
                })
                .collect();
            if n > 3 {
                // One has escaped, two are flush.
                bounds[1] = Bounds::around(&Vector3::repeat(1e9), 0.05);
                bounds[2] = Bounds::around(&Vector3::zeros(), 0.1);
                bounds[3] = Bounds::around(&Vector3::new(0.2, 0.0, 0.0), 0.1);
            }
            broad.pairs(&bounds, &mut pairs);
            assert_eq!(pairs, all_pairs(&bounds), "{n} {largest}");
            found += pairs.len();
        }
    }
    // measured: 65776
    assert!(found > 10_000, "{found}");
}

/// A cubic lattice of touching spheres has 3 n² (n − 1) contacts.
#[test]
fn a_lattice_of_spheres_gives_its_neighbours() {
    let n = 12;
    let lattice = (0..n * n * n).map(|i| [i % n, i / n % n, i / n / n].map(|x| f64::from(x as u16)));
    let bounds: Vec<Bounds> = lattice.map(|p| Bounds::around(&p.into(), 0.5)).collect();
    let (mut broad, mut pairs) = (Broad::default(), Vec::new());
    broad.pairs(&bounds, &mut pairs);
    let near = |(i, j): &&(u32, u32)| (bounds[*i as usize].low_m - bounds[*j as usize].low_m).norm() < 1.1;
    assert_eq!(pairs.iter().filter(near).count(), 3 * n * n * (n - 1));
    assert_eq!(pairs, all_pairs(&bounds));
}
