//! Pins among the contacts of a problem, put there by hand: every solver holds them, the exact one to rounding.

use super::assemblies::{Assembly, chain_to_the_floor, pendulum_at_a_wall};
use gotai::experiment::types::Solver;

fn each(check: impl Fn(&str, Assembly)) {
    for friction in [0.0, 0.3, 1.0] {
        check(&format!("pendulum {friction}"), pendulum_at_a_wall(friction));
        check(&format!("chain {friction}"), chain_to_the_floor(friction));
    }
}

#[test]
fn pinned_boxes_against_a_wall_and_on_the_floor_obey_pins_and_contacts() {
    each(|what, assembly| {
        let gathered = assembly.gathered();
        let solved = gathered.solve(Solver::Newton, 50, 1e-14);
        let (pins, law) = (gathered.pin_error(&solved.p), gathered.law_error(&solved.p));
        assert!(solved.says, "{what}");
        // measured: 6.3e-14 m/s and 7.6e-14
        assert!(pins <= 1e-12 && law <= 1e-12, "{what}: {pins} {law}");
        assert!(gathered.energy(&solved.p) < 0.0, "{what}");
    });
}

#[test]
fn every_solver_holds_pins() {
    each(|what, assembly| {
        let gathered = assembly.gathered();
        for &solver in Solver::ALL {
            let solved = gathered.solve(solver, 3000, 1e-14);
            let (pins, law) = (gathered.pin_error(&solved.p), gathered.law_error(&solved.p));
            // measured: 1.9e-14 and 2.3e-13
            assert!(pins <= 1e-9 && law <= 1e-9, "{what}, {solver:?}: {pins} {law}");
        }
    });
}
