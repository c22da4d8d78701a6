//! Linear systems of six unknowns a body, held against a library's.

use gotai::math::block_lu::{BlockMatrix, Pattern};
use gotai::math::few::BlockVector;
use gotai::math::lu6::Lu6;
use gotai::math::six::add_products;
use nalgebra::{DMatrix, DVector, Matrix6, Vector6};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn matrix(random: &mut ChaCha8Rng) -> Matrix6<f64> {
    Matrix6::from_fn(|_, _| random.random_range(-1.0..1.0))
}

#[test]
fn factors_of_one_block_solve_what_a_library_solves() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut worst = 0.0_f64;
    for _ in 0..1000 {
        let (A, x) = (matrix(&mut random), Vector6::from_fn(|_, _| random.random_range(-1.0..1.0)));
        let lu = Lu6::new(&A).unwrap();
        let found = lu.solve(&(A * x));
        let of_library = A.lu().solve(&(A * x)).unwrap();
        worst = worst.max((found - of_library).norm() / (1e-14 * condition(&A)));
        let mut all = A;
        lu.solve_all(&mut all);
        assert!((all - Matrix6::identity()).amax() < 1e-13 * condition(&A), "{all}");
    }
    // measured: 0.1
    assert!(worst < 1.0, "{worst}");
}

fn condition(A: &Matrix6<f64>) -> f64 {
    let values = A.singular_values();
    values.max() / values.min()
}

/// A row that is another one's multiple, exactly.
#[test]
fn a_singular_block_has_no_factors() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for k in 0..6 {
        let mut A = matrix(&mut random);
        A.fill_column(k, 0.0);
        assert!(Lu6::new(&A).is_none(), "{A}");
    }
}

/// E + Gᵀ G of chains of bodies: the same by blocks and by one dense matrix.
#[test]
fn chains_of_bodies_are_solved_by_their_blocks() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut worst = 0.0_f64;
    for bodies in 1..6 {
        let pattern = Pattern::new(bodies, (1..bodies).map(|body| (body - 1, body)));
        let mut blocks = BlockMatrix::diagonal(&pattern, 1.0);
        let mut dense = DMatrix::identity(6 * bodies, 6 * bodies);
        for body in 0..bodies {
            for (row, column) in [(body, body), (body, body + 1), (body + 1, body)] {
                if row.max(column) < bodies {
                    let [a, b] = [0, 1].map(|_| [0, 1, 2].map(|_| [0; 6].map(|_| random.random_range(-0.3..0.3))));
                    add_products(blocks.block(row, column), &a, &b);
                    for (a, b) in a.iter().zip(&b) {
                        let product = Vector6::from(*a) * Vector6::from(*b).transpose();
                        let mut view = dense.fixed_view_mut::<6, 6>(6 * row, 6 * column);
                        view += product;
                    }
                }
            }
        }
        let right = DVector::from_fn(6 * bodies, |_, _| random.random_range(-1.0..1.0));
        let mut by_body = BlockVector::zeros(bodies);
        (0..bodies).for_each(|body| by_body[body].copy_from(&right.fixed_rows::<6>(6 * body)));
        let found = blocks.solve(&by_body, Default::default()).unwrap();
        let of_library = dense.lu().solve(&right).unwrap();
        for body in 0..bodies {
            worst = worst.max((found[body] - of_library.fixed_rows::<6>(6 * body)).amax());
        }
    }
    // measured: 1e-14
    assert!(worst < 1e-12, "{worst}");
}
