//! No step allocates. The allocator counts per thread, so that other tests do not disturb.

use crate::yaml::{CUBE_IN_BOX, experiment};
use gotai::experiment::types::{Integrator, Solver};
use gotai::measure::Judge;
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::shown::Shown;
use gotai::step::Stepper;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    // A thread that is ending has no counter any more.
    let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
}

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of a whole run, stepping and judging.
fn allocations(sets: &[&str]) -> (u64, u64) {
    let experiment = experiment(CUBE_IN_BOX, sets);
    let (model, start) = build(&experiment).unwrap();
    let clock = experiment.clock();
    let plan = Plan::new(&model, &experiment.method);
    let mut stepper = Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &start);
    let mut judge = Judge::new(&model, &start, &experiment.diverge, &plan);
    let (mut before, mut state) = (start.clone(), start);
    let counted = ALLOCATIONS.get();
    while state.step < clock.steps {
        before.copy_from(&state);
        stepper.step(&model, &mut state, &clock);
        let acted = stepper.acted(&before, &clock);
        let shown = Shown { before: &before, after: &state, acted, way: None, stalled: None, is_last: false };
        judge.observe(&model, &shown);
    }
    (ALLOCATIONS.get() - counted, stepper.work().contacts)
}

#[test]
fn no_step_allocates() {
    let counted = ALLOCATIONS.get();
    drop(std::hint::black_box(vec![1]));
    assert_eq!(ALLOCATIONS.get() - counted, 1, "the counter counts");
    let solvers = Solver::ALL.iter().filter(|solver| !solver.facts().allocates);
    let with_solver = solvers.map(|solver| format!("{{time-stepping: {{solver: {}}}}}", solver.word()));
    let others = [
        "lecture",
        "{lecture: {iteration: jacobi}}",
        "{lecture: {correction: per-contact, rotation: momentum}}",
        "{penalty: {stiffness_n_m: 1e4}}",
        "{time-stepping: {solver: pgs, local: exact, order: shuffled, relaxation: 0.5, contacts_per_face: 4}}",
    ];
    for method in with_solver.chain(others.map(String::from)) {
        for mesh in ["nodes_per_edge: 2", "nodes_per_edge: 5"] {
            let sets = [format!("method={method}"), format!("scene.bodies.cube.mesh={{ {mesh} }}")];
            let (allocated, contacts) = allocations(&[&sets[0], &sets[1]]);
            assert!(contacts > 0, "{method}: the cube lands");
            assert_eq!(allocated, 0, "{method}, {mesh}");
        }
    }
    for &integrator in Integrator::ALL {
        let set = format!("method.free.integrator={}", integrator.word());
        let sets = [&set, "diverge.escape=false", "scene.bodies.cube.inertia_kg_m2=[0.1, 0.2, 0.25]"];
        assert_eq!(allocations(&sets).0, 0, "{}", integrator.word());
    }
}
