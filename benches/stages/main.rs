//! Time of every stage of a run, one by one: the contact test, its manifolds, what is gathered, the solvers, the
//! judges, a step of each method, a case beside its stepping, a recording.
//!
//!     cargo bench --locked --bench stages            # all
//!     cargo bench --locked --bench stages -- solver  # those whose name holds it
//!
//! The figures of docs/benchmarks.md are medians of these.

use divan::Bencher;
use divan::counter::ItemsCount;
use gotai::collide::approach::Approach;
use gotai::collide::broad::{Bounds, Broad};
use gotai::collide::{Contact, Detector, Reach};
use gotai::deadline::Deadline;
use gotai::experiment::ExperimentFile;
use gotai::experiment::types::{Cone, Correction, Experiment, Iteration, Limits, Local, Order, Solver};
use gotai::measure::Judge;
use gotai::model::{Model, pose_of_solid};
use gotai::record::Recorder;
use gotai::record::mcap::McapRecorder;
use gotai::record::rerun::RerunRecorder;
use gotai::record::sample::{Batch, ContactSample};
use gotai::record::writer::Target;
use gotai::run::advance::{Advance, only_step};
use gotai::scene::build;
use gotai::shape::pair::touches;
use gotai::solve::Impulse;
use gotai::solve::gauss_seidel::{Sweeps, Variant};
use gotai::solve::problem::ContactProblem;
use gotai::solve::solver::ContactSolver;
use gotai::solve::twist::Twist;
use gotai::state::State;
use gotai::study::{self, Place};
use gotai::sweep::plan::SweepPlan;
use gotai::sweep::runner::{Job, Progress, build_and_run};
use gotai::sweep::store::Store;
use gotai::work::Work;
use nalgebra::Vector3;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

mod raw;
#[allow(dead_code, reason = "of what the tests record, a part")]
#[path = "../../tests/record/synthetic.rs"]
mod synthetic;

fn main() {
    divan::main();
}

/// The lecture's scene: a cube thrown into a box.
const CUBE: &str = "
scene:
  friction: 0.3
  container: { box: { size_m: [4, 4, 4] } }
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 5 }
      mass_kg: 1
      inertia_from: lumped
      position_m: [0, 2, 0]
  random: { speed_m_s: 4, spin_rad_s: 6, attitude: true }
time: { step_s: 1e-3, end_s: 1 }
";

const STACK: &str = "
scene:
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - name: brick
      shape: { box: { size_m: [1, 1, 1] } }
      mass_kg: 1
      position_m: [0, 0.5, 0]
      copies: { count: 10, step_m: [0, 1, 0] }
time: { step_s: 1e-3, end_s: 0.1 }
";

const PILE: &str = "
scene:
  friction: 0.5
  container: { box: { size_m: [1.45, 4, 1.45] } }
  bodies:
    - name: pile
      shape: { box: { size_m: [0.2, 0.2, 0.2] } }
      mass_kg: 1
      position_m: [-0.5, 0.3, -0.5]
      copies: { grid: [5, 5, 5], step_m: [0.25, 0.25, 0.25] }
method: { time-stepping: { solver: pgs } }
time: { step_s: 1e-2, end_s: 1 }
";

/// Free points: next to nothing but the case itself.
const POINTS: &str = "
scene:
  bodies: [{ name: point, shape: none, mass_kg: 1, inertia_kg_m2: [1, 1, 1], position_m: [0, 1, 0] }]
  random: { speed_m_s: 4 }
method: free
time: { step_s: 1, end_s: 1 }
sweep: { axes: { seed: 0..1999 } }
";

fn text_of(scene: &str) -> &'static str {
    match scene {
        "cube" => CUBE,
        "stack" => STACK,
        _ => PILE,
    }
}

fn file(text: &str, sets: &[&str]) -> ExperimentFile {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    ExperimentFile::from_text(Path::new("bench.yaml"), text, &sets).unwrap_or_else(|error| panic!("{error}"))
}

fn built(text: &str, sets: &[&str]) -> (Experiment, Model, State) {
    let experiment = file(text, sets).experiment().unwrap_or_else(|error| panic!("{error}"));
    let (model, start) = build(&experiment).unwrap();
    (experiment, model, start)
}

/// A scene at the end of its time.
fn settled(text: &str, sets: &[&str]) -> (Experiment, Model, State) {
    let (experiment, model, start) = built(text, sets);
    let method = experiment.method.stepping().unwrap();
    let end = only_step(&method, &model, start, &experiment.clock(), &Limits::default()).state;
    (experiment, model, end)
}

fn found(model: &Model, state: &State) -> Vec<Contact> {
    let mut contacts = Vec::new();
    Detector::default().detect(model, state, &Reach { margin: 0.01 }, &mut contacts, &mut Work::default());
    contacts
}

/// Folder below the build's own, emptied.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("stages").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

#[divan::bench(args = ["cube", "stack", "pile"])]
fn contact_test(bencher: Bencher, scene: &str) {
    let (_, model, state) = settled(text_of(scene), &["time.end_s=1", "time.step_s=1e-2"]);
    let (mut detector, mut contacts, mut work) = (Detector::default(), Vec::new(), Work::default());
    bencher.bench_local(|| {
        detector.detect(&model, &state, &Reach { margin: 0.01 }, &mut contacts, &mut work);
        contacts.len()
    });
}

#[divan::bench(args = [10, 100, 1000])]
fn broad_phase(bencher: Bencher, bodies: usize) {
    // A low-discrepancy sequence, so that some are near each other.
    let place = |i: usize| [0.819_172_513, 0.671_043_607, 0.549_700_478].map(|part| (i as f64 * part).fract());
    let edge_m = libm::cbrt(bodies as f64) * 0.25;
    let bounds: Vec<Bounds> = (0..bodies).map(|i| Bounds::around(&(Vector3::from(place(i)) * edge_m), 0.17)).collect();
    let (mut broad, mut pairs) = (Broad::default(), Vec::new());
    bencher.counter(ItemsCount::new(bodies)).bench_local(|| {
        broad.pairs(&bounds, &mut pairs);
        pairs.len()
    });
}

#[divan::bench(args = ["box", "sphere", "cylinder", "capsule", "ellipsoid"])]
fn manifold(bencher: Bencher, shape: &str) {
    let shape = match shape {
        "box" => "{ box: { size_m: [1, 1, 1] } }",
        "sphere" => "{ sphere: { radius_m: 0.5 } }",
        "cylinder" => "{ cylinder: { radius_m: 0.5, height_m: 1 } }",
        "capsule" => "{ capsule: { radius_m: 0.25, height_m: 0.5 } }",
        _ => "{ ellipsoid: { semi_axes_m: [0.5, 0.5, 0.4] } }",
    };
    let text = format!(
        "
scene:
  allow_overlap: true
  bodies:
    - {{ name: a, shape: {{ box: {{ size_m: [2, 1, 2] }} }}, mass_kg: 1 }}
    - name: b
      shape: {shape}
      mass_kg: 1
      position_m: [0.3, 0.99, 0.2]
      orientation: {{ axis: [0, 1, 0], angle_deg: 20 }}
time: {{ step_s: 1, end_s: 1 }}
"
    );
    let (_, model, state) = built(&text, &[]);
    let [(a, at_a), (b, at_b)] = [0, 1].map(|i| {
        let (solid, centre) = model.bodies[i].solid().unwrap();
        (solid, pose_of_solid(centre, &state.bodies[i]))
    });
    let mut out = Vec::new();
    bencher.bench_local(|| {
        out.clear();
        touches(a, &at_a, b, &at_b, 0.05, &mut out)
    });
}

fn falling(model: &Model, state: &State, step_s: f64) -> Vec<Twist> {
    let fall = model.gravity_m_s2 * step_s;
    state.bodies.iter().map(|at| Twist { v: at.v_WB + fall, w: at.w_WB }).collect()
}

#[divan::bench(args = ["cube", "stack", "pile"])]
fn gather(bencher: Bencher, scene: &str) {
    let (experiment, model, state) = settled(text_of(scene), &["time.end_s=1", "time.step_s=1e-2"]);
    let step_s = experiment.clock().step_s;
    let (free, contacts) = (falling(&model, &state, step_s), found(&model, &state));
    let mut problem = ContactProblem::default();
    bencher.counter(ItemsCount::new(contacts.len())).with_inputs(|| contacts.clone()).bench_local_refs(|contacts| {
        problem.gather(&model, &state, &free, contacts, (Approach::Inside, step_s));
    });
}

#[divan::bench(args = ["pgs", "nncg", "newton", "auto"])]
fn solver(bencher: Bencher, word: &str) {
    let which = match word {
        "pgs" => Solver::Pgs,
        "nncg" => Solver::Nncg,
        "newton" => Solver::Newton,
        _ => Solver::Auto,
    };
    // From no impulses at all.
    let (experiment, model, state) = built(STACK, &["time.step_s=1e-2"]);
    let step_s = experiment.clock().step_s;
    let (free, mut contacts) = (falling(&model, &state, step_s), found(&model, &state));
    let mut problem = ContactProblem::default();
    problem.gather(&model, &state, &free, &mut contacts, (Approach::Inside, step_s));
    let sweeps = Sweeps {
        iteration: Iteration::GaussSeidel,
        correction: Correction::PerContact,
        cone: Cone::Disc,
        most: 1000,
        tolerance: 1e-10,
        friction: true,
        variant: Variant { local: Local::Common, relaxation: 1.0, order: Order::ForthAndBack },
        deadline: Deadline::default(),
    };
    let mut solver = ContactSolver::new(which, contacts.len(), model.bodies.len(), true);
    let mut work = Work::default();
    bencher
        .counter(ItemsCount::new(contacts.len()))
        .with_inputs(|| vec![Impulse::zeros(); contacts.len()])
        .bench_local_refs(|p| solver.solve(&problem, &sweeps, (p, &[]), &mut work));
}

/// Judges of one step, of bodies at rest.
#[divan::bench(args = ["cube", "stack", "pile"])]
fn judges(bencher: Bencher, scene: &str) {
    let (experiment, model, state) = settled(text_of(scene), &["time.end_s=1", "time.step_s=1e-2"]);
    let state = State { step: 0, time_s: 0.0, ..state };
    let method = experiment.method.stepping().unwrap();
    let limits = Limits::default();
    let mut advance = Advance::new(&method, &model, state.clone(), experiment.clock(), &limits);
    let mut judge = Judge::new(&model, &state, &experiment.diverge, advance.plan());
    let shown = advance.next(&model).unwrap();
    bencher.bench_local(|| judge.observe(&model, &shown));
}

const METHODS: [&str; 8] = [
    "free",
    "lecture",
    "{penalty: {stiffness_n_m: 1e4}}",
    "{time-stepping: {solver: pgs}}",
    "{time-stepping: {solver: newton}}",
    "time-stepping",
    "{time-stepping: {scheme: moreau}}",
    "{event-driven: {tolerance: 1e-6}}",
];

/// A second of the lecture's cube, a thousand steps where the method takes steps.
#[divan::bench(args = METHODS, sample_count = 10)]
fn steps(bencher: Bencher, method: &str) {
    let (experiment, model, start) = built(CUBE, &[&format!("method={method}"), "diverge.escape=false"]);
    let method = experiment.method.stepping().unwrap();
    bencher
        .counter(ItemsCount::new(experiment.clock().steps))
        .bench_local(|| only_step(&method, &model, start.clone(), &experiment.clock(), &Limits::default()).state);
}

struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: usize) {}
    fn one_done(&self) {}
    fn end(&self) {}
}

/// A case of a sweep, planned, run in one step, kept and written into the tables, on all cores.
#[divan::bench(sample_count = 10)]
fn case_of_a_sweep(bencher: Bencher) {
    let dir = folder("cases");
    let file = file(POINTS, &[]);
    bencher.counter(ItemsCount::new(file.axes().len())).bench_local(|| {
        let _ = std::fs::remove_dir_all(&dir);
        let plan = SweepPlan::new(&file).unwrap();
        let store = Mutex::new(Store::open(&dir, &plan, false).unwrap());
        let work = |planned: &_, targets: &[Target]| build_and_run(planned, &dir, targets);
        Job { dir: &dir, targets: &[], csv: false, work: &work, progress: &Silent }.sweep(&plan.cases, &store).unwrap()
    });
}

/// A second of the lecture's cube, judged, and recorded at 100 Hz into nothing, MCAP, or all kinds of file.
#[divan::bench(args = ["none", "mcap", "all"], sample_count = 10)]
fn recording(bencher: Bencher, to: &str) {
    let targets = match to {
        "none" => &[][..],
        "mcap" => &[Target::Mcap],
        _ => Target::AVAILABLE,
    };
    let dir = folder(to);
    let file = file(CUBE, &[]);
    let planned = &SweepPlan::single(&file).unwrap().cases[0];
    let (model, start) = build(&planned.case.experiment).unwrap();
    bencher.bench_local(|| {
        let place = Place { references: None, recording: planned.recording(&dir, targets) };
        study::measure(&planned.case.experiment, &model, start.clone(), &place).recorded.is_ok()
    });
}

const SAMPLES: u64 = 20_000;

/// Samples of one body with eight contacts, in batches as full ones are.
fn batches() -> Vec<Batch> {
    let batch = |from: u64| {
        let mut batch = Batch::default();
        for i in from..from + 1000 {
            let all = synthetic::ALL;
            synthetic::push(&mut batch, i, all);
            let lowest = synthetic::body(i).position_m;
            batch.contacts.truncate(batch.contacts.len() - batch.contacts_len.pop().unwrap() as usize);
            batch.contacts_len.push(8);
            batch.contacts.extend((0..8).map(|k| ContactSample {
                body: 0,
                other: None,
                point_m: lowest.map(|x| x + 0.1 * f64::from(k)),
                normal: [0.0, 1.0, 0.0],
                force_n: [lowest[1], 9.8 + 0.01 * i as f64, f64::from(k)],
                gap_m: -1e-4 * lowest[1],
                friction_use: 0.5,
                mode: Default::default(),
            }));
        }
        batch
    };
    (0..SAMPLES).step_by(1000).map(batch).collect()
}

/// One body and eight contacts at every step, into both kinds of file: by their libraries alone, and by this program.
#[divan::bench(args = ["raw mcap", "mcap", "raw rerun", "rerun"], sample_count = 10)]
fn files(bencher: Bencher, by: &str) {
    let batches = batches();
    let dir = folder("files");
    let header = synthetic::header(synthetic::ALL);
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| match by {
        "raw mcap" => raw::mcap(&dir.join("raw.mcap"), &batches),
        "raw rerun" => raw::rerun(&dir.join("raw.rrd"), &batches),
        "mcap" => written(Box::new(McapRecorder::create(&dir.join("a.mcap"), &header).unwrap()), &batches),
        _ => written(Box::new(RerunRecorder::create(&dir.join("a.rrd"), &header).unwrap()), &batches),
    });
}

fn written(mut file: Box<dyn Recorder>, batches: &[Batch]) {
    for batch in batches {
        file.write(batch).unwrap();
    }
    file.finish(&synthetic::ending()).unwrap();
}
