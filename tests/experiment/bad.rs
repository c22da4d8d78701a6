//! Bad input: every row says where the message must point and what it must say.

use super::{BASE, experiment, file};
use gotai::experiment::ExperimentFile;
use gotai::experiment::error::Kind;
use std::path::Path;

/// What is wrong, the edit of `BASE` that makes it so, the line and key path of the message, and a part of it.
type Row = (&'static str, &'static str, &'static str, usize, &'static str, &'static str);

const CUBE: &str = "      mass_kg: 1.0\n";
const FRICTION: &str = "  friction: 0.3\n";
const LECTURE: &str = "method: lecture\n";
const END: &str = "  end_s: 1.0\n";

#[rustfmt::skip]
const ROWS: &[Row] = &[
    // Keys.
    ("a slip in a key", "friction: 0.3", "fricton: 0.3", 2, "scene.fricton", "unknown key; did you mean `friction`? (known here: gravity_m_s2, friction,"),
    ("a key without its unit", "mass_kg: 1.0", "mass: 1.0", 10, "scene.bodies.cube.mass", "did you mean `mass_kg`?"),
    ("a key of a wrong unit", "step_s: 0.01", "step_ms: 10", 18, "time.step_ms", "did you mean `step_s`?"),
    ("a key near nothing", END, "  end_s: 1.0\n  colour: red\n", 20, "time.colour", "unknown key (known here: step_s, end_s)"),
    ("a key at the top", "seed: 7", "sede: 7", 15, "sede", "did you mean `seed`?"),
    ("a key that is a number", "seed: 7", "7: 7", 15, "7", "unknown key"),
    ("a key twice", "seed: 7\n", "seed: 7\nseed: 8\n", 16, "seed", "this key is already there, on line 15"),
    ("a key twice, nested", CUBE, "      mass_kg: 1\n      name: cuboid\n", 11, "scene.bodies.0.name", "already there, on line 7"),
    ("no steps at all", "seed: 7\n", "seed: 7\nlimits: { steps: 0 }\n", 16, "limits.steps", "expected a whole number of at least 1, found 0"),
    ("two things to measure against", "seed: 7\n", "exact: rest\nreference: { tolerance: 1e-12 }\n", 16, "reference", "either `exact` or `reference`: errors are measured against one of them, found `exact: rest` beside it"),
    ("a reference that f64 cannot give", "seed: 7\n", "reference: { tolerance: 1e-14 }\n", 15, "reference.tolerance", "expected a number of at least 1e-13"),
    ("a reference of something else", "method: lecture", "reference: {}\nmethod: free", 16, "reference", "the reference has contact and `free` has none"),
    ("no time at all", "seed: 7\n", "seed: 7\nlimits: { wall_s: 0 }\n", 16, "limits.wall_s", "expected a number greater than 0, found 0"),
    ("a later key of a container", "    box:\n", "    mesh: {}\n    box:\n", 4, "scene.container.mesh", "not available in this version"),
    ("a pair with nobody", FRICTION, "  pairs: [{ between: [cube, contaner], friction: 0.5 }]\n", 2, "scene.pairs.0.between.1", "did you mean `container`?"),
    ("a pair of one", FRICTION, "  pairs: [{ between: [cube, cube], friction: 0.5 }]\n", 2, "scene.pairs.0.between", "two different names"),
    ("a pair that bounces too much", FRICTION, "  pairs: [{ between: [cube, container], restitution: 1.5 }]\n", 2, "scene.pairs.0.restitution", "from 0 to 1"),
    ("a pair that gives back more slip than there was", FRICTION, "  pairs: [{ between: [cube, container], tangential_restitution: -0.1 }]\n", 2, "scene.pairs.0.tangential_restitution", "from 0 to 1"),
    ("copies without a number", CUBE, "      mass_kg: 1.0\n      copies: { step_m: [0, 1, 0] }\n", 11, "scene.bodies.cube.copies", "expected a `count` or a `grid`, found neither"),
    ("copies counted twice", CUBE, "      mass_kg: 1.0\n      copies: { count: 2, grid: [1, 1, 2], step_m: [0, 1, 0] }\n", 11, "scene.bodies.cube.copies.grid", "expected either `count` or `grid`, found both"),
    ("no copies", CUBE, "      mass_kg: 1.0\n      copies: { grid: [3, 0, 3], step_m: [0, 1, 0] }\n", 11, "scene.bodies.cube.copies.grid", "expected 1 to 100000 bodies, found 0"),
    ("too many copies", CUBE, "      mass_kg: 1.0\n      copies: { grid: [1000, 1000, 1000], step_m: [0, 1, 0] }\n", 11, "scene.bodies.cube.copies.grid", "expected 1 to 100000 bodies, found 1000000000"),
    ("a copy too far", FRICTION, "  pairs: [{ between: ['cube[7]', container], friction: 0.5 }]\n", 2, "scene.pairs.0.between.0", "expected one of cube, point, container, found `cube[7]`"),
    ("a later key of a sweep", "seed: 7\n", "sweep: { where: [] }\n", 15, "sweep.where", "not available in this version"),
    ("a way of making it as an axis", "seed: 7\n", "sweep: { axes: { plan.skip: [[], [bounds]] } }\n", 15, "sweep.axes.plan.skip", "expected a key that a case's id depends on"),
    // Words.
    ("a slip in a skip", "seed: 7\n", "plan: { skip: [contact-tests] }\n", 15, "plan.skip.0", "expected one of contact-test, bounds, friction-rows, gyroscopic-term, kept-impulses, flight, rest, closed-forms, found `contact-tests`; did you mean `contact-test`?"),
    ("an unknown word", LECTURE, "method: lectur\n", 16, "method", "expected one of free, lecture, penalty, time-stepping, event-driven, auto, found `lectur`; did you mean `lecture`?"),
    ("an unknown word with settings", LECTURE, "method:\n  lectur: {}\n", 17, "method.lectur", "did you mean `lecture`?"),
    ("an underscore for a hyphen", LECTURE, "method: time_stepping\n", 16, "method", "did you mean `time-stepping`?"),
    ("two words", LECTURE, "method:\n  lecture: {}\n  free: {}\n", 18, "method.free", "found `free` beside `lecture`"),
    ("a tolerance that f64 cannot give", LECTURE, "method: { event-driven: { tolerance: 1e-14 } }\n", 16, "method.event-driven.tolerance", "expected a number of at least 1e-13"),
    ("a tolerance of nothing", LECTURE, "method: { event-driven: { tolerance: 0 } }\n", 16, "method.event-driven.tolerance", "expected a number of at least 1e-13: positions of some metres are known to 1e-16 of them"),
    ("an unknown law of impact", LECTURE, "method: { event-driven: { impact: hertz } }\n", 16, "method.event-driven.impact", "expected one of newton, poisson, sequential, found `hertz`"),
    ("a step for a method without one", LECTURE, "method: { event-driven: { step_s: 1 } }\n", 16, "method.event-driven.step_s", "unknown key (known here: tolerance, impact)"),
    ("a later word with settings", "shape: none", "shape: { mesh: { file: a.obj } }", 13, "scene.bodies.point.shape.mesh", "`mesh` is not available in this version"),
    ("a cylinder without height", "shape: none", "shape: { cylinder: { radius_m: 1, height_m: 0 } }", 13, "scene.bodies.point.shape.cylinder.height_m", "expected a number greater than 0, found 0"),
    ("a capsule without radius", "shape: none", "shape: { capsule: { radius_m: 0, height_m: 1 } }", 13, "scene.bodies.point.shape.capsule.radius_m", "expected a number greater than 0, found 0"),
    ("a flat ellipsoid", "shape: none", "shape: { ellipsoid: { semi_axes_m: [1, 0, 1] } }", 13, "scene.bodies.point.shape.ellipsoid.semi_axes_m.1", "expected a number greater than 0, found 0"),
    ("three vertices", "shape: none", "shape: { convex: { vertices_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0]] } }", 13, "scene.bodies.point.shape.convex.vertices_m", "expected at least 4 vertices, found 3 vertices"),
    ("vertices in a plane", "shape: none", "shape: { convex: { vertices_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]] } }", 13, "scene.bodies.point.shape.convex.vertices_m", "expected vertices that span a volume, found all of them in one plane"),
    ("a vertex inside", "shape: none", "shape: { convex: { vertices_m: [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0.5, 0.5, 0.5], [0, 0, 3]] } }", 13, "scene.bodies.point.shape.convex.vertices_m.3", "expected a corner of the convex hull, found a vertex inside"),
    ("a vertex that is no number", "shape: none", "shape: { convex: { vertices_m: [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, .nan, 3]] } }", 13, "scene.bodies.point.shape.convex.vertices_m.3.1", "expected a finite number, found .nan"),
    ("a mesh of a capsule", "shape: { box: { size_m: [1, 1, 1] } }", "shape: { capsule: { radius_m: 1, height_m: 1 } }", 9, "scene.bodies.cube.mesh", "expected no mesh, as only a `box` and a `sphere` can have one"),
    ("sweeps of a solver without", LECTURE, "method: { time-stepping: { solver: newton, order: shuffled } }\n", 16, "method.time-stepping.order", "`newton` solves all contacts at once"),
    ("sweeps for who counts himself", LECTURE, "method: { time-stepping: { sweeps: 50 } }\n", 16, "method.time-stepping.sweeps", "expected nothing, as the solver `auto` counts for itself (`pgs`, `nncg` and `newton` take a number of sweeps), found a number of sweeps"),
    ("no relaxation", LECTURE, "method: { time-stepping: { relaxation: 0 } }\n", 16, "method.time-stepping.relaxation", "expected a number between 0 and 2, found 0"),
    ("too much of it", LECTURE, "method: { time-stepping: { relaxation: 2 } }\n", 16, "method.time-stepping.relaxation", "expected a number between 0 and 2, found 2"),
    ("two contacts a face", LECTURE, "method: { time-stepping: { contacts_per_face: 2 } }\n", 16, "method.time-stepping.contacts_per_face", "at least 3, as fewer contacts hold no face, found 2"),
    ("an unknown order", LECTURE, "method: { time-stepping: { order: shuffle } }\n", 16, "method.time-stepping.order", "did you mean `shuffled`?"),
    ("an unknown integrator", LECTURE, "method: { free: { integrator: rk5 } }\n", 16, "method.free.integrator", "did you mean `rk4`?"),
    ("no tolerance", LECTURE, "method: { free: { integrator: dop853, tolerance: 0 } }\n", 16, "method.free.tolerance", "expected a number of at least 1e-15, found 0"),
    ("a negative tolerance", LECTURE, "method: { free: { integrator: dop853, tolerance: -1e-9 } }\n", 16, "method.free.tolerance", "expected a number of at least 1e-15, found -1e-9"),
    ("a tolerance below rounding", LECTURE, "method: { free: { integrator: dop853, tolerance: 1e-16 } }\n", 16, "method.free.tolerance", "expected a number of at least 1e-15, found 1e-16"),
    ("a tolerance without error control", LECTURE, "method: { free: { integrator: rk4, tolerance: 1e-9 } }\n", 16, "method.free.tolerance", "expected no tolerance, as `rk4` does not control its error (`dop853` and `taylor` do)"),
    ("a tag", LECTURE, "method: !lecture { sweeps: 3 }\n", 16, "method", "found the tag `!lecture`"),
    ("settings of a word without any", "shape: none", "shape: { none: { radius_m: 1 } }", 13, "scene.bodies.point.shape.none", "expected the word `none` alone"),
    ("a bare word that needs settings", LECTURE, "method: penalty\n", 16, "method.penalty.stiffness_n_m", "missing"),
    // Types.
    ("text for a number", "friction: 0.3", "friction: high", 2, "scene.friction", "expected a number, found the text `high`"),
    ("a number too large for a float", "friction: 0.3", "friction: 1e400", 2, "scene.friction", "expected a number, found the text `1e400`"),
    ("infinity", "friction: 0.3", "friction: .inf", 2, "scene.friction", "expected a finite number, found .inf"),
    ("not a number", "[0, 2, 0]", "[0, .nan, 0]", 11, "scene.bodies.cube.position_m.1", "expected a finite number, found .nan"),
    ("two coordinates", "[0, 2, 0]", "[0, 2]", 11, "scene.bodies.cube.position_m", "expected a list of 3, found a list of 2"),
    ("a number for a list", "[0, 2, 0]", "2", 11, "scene.bodies.cube.position_m", "expected a list of 3, found 2"),
    ("a fraction for a whole number", LECTURE, "method: { lecture: { sweeps: 2.5 } }\n", 16, "method.lecture.sweeps", "expected a whole number from 0 to 4294967295, found 2.5"),
    ("a negative seed", "seed: 7", "seed: -1", 15, "seed", "expected a whole number of at least 0, found -1"),
    ("half a node", "nodes_per_edge: 3", "nodes_per_edge: 2.5", 9, "scene.bodies.cube.mesh.nodes_per_edge", "expected a whole number or a list of three"),
    ("two counts of nodes", "nodes_per_edge: 3", "nodes_per_edge: [3, 3]", 9, "scene.bodies.cube.mesh.nodes_per_edge", "a list of 2"),
    ("a number for a name", "name: point", "name: 5", 12, "scene.bodies.1.name", "expected text (in quotes), found 5"),
    ("text for a flag", END, "  end_s: 1.0\ndiverge: { escape: yes }\n", 20, "diverge.escape", "expected true or false, found the text `yes`"),
    ("a list for a mapping", LECTURE, "method: { lecture: [] }\n", 16, "method.lecture", "expected a mapping (known keys: start, iteration,"),
    ("a list for a method", LECTURE, "method: [lecture]\n", 16, "method", "expected one of free, lecture, penalty, time-stepping, event-driven, auto, found a list of 1"),
    ("no end", END, "", 17, "time.end_s", "missing"),
    ("two moments", CUBE, "      mass_kg: 1\n      inertia_kg_m2: [1, 2]\n", 11, "scene.bodies.cube.inertia_kg_m2", "expected three principal moments or three rows of three, found a list of 2"),
    // Bodies.
    ("no mass", CUBE, "", 7, "scene.bodies.cube.mass_kg", "missing: give `mass_kg` or `density_kg_m3`"),
    ("a negative mass", "mass_kg: 1.0", "mass_kg: -1", 10, "scene.bodies.cube.mass_kg", "expected a number greater than 0, found -1"),
    ("mass and density", CUBE, "      mass_kg: 1\n      density_kg_m3: 1\n", 11, "scene.bodies.cube.density_kg_m3", "either `mass_kg` or `density_kg_m3`"),
    ("the density of a point", "mass_kg: 0.5", "density_kg_m3: 1", 14, "scene.bodies.point.density_kg_m3", "has no volume"),
    ("a flat box", "[1, 1, 1]", "[1, 0, 1]", 8, "scene.bodies.cube.shape.box.size_m.1", "expected a number greater than 0, found 0"),
    ("a name twice", "name: point", "name: cube", 12, "scene.bodies.1.name", "a name of its own, found `cube`"),
    ("a dot in a name", "name: point", "name: a.b", 12, "scene.bodies.1.name", "without any of . [ ]"),
    ("an empty name", "name: point", "name: ''", 12, "scene.bodies.1.name", "expected a name"),
    ("the container's name", "name: point", "name: container", 12, "scene.bodies.container.name", "another name"),
    ("no bodies", "  bodies:\n", "  bodies: []\n  ignored:\n", 7, "scene.ignored", "unknown key"),
    ("one node an edge", "nodes_per_edge: 3", "nodes_per_edge: 1", 9, "scene.bodies.cube.mesh.nodes_per_edge", "at least 2 nodes"),
    ("a mesh that fills the memory", "nodes_per_edge: 3", "nodes_per_edge: 1000", 9, "scene.bodies.cube.mesh.nodes_per_edge", "found 1000000000 nodes"),
    ("the sphere's mesh on a box", "nodes_per_edge: 3", "subdivisions: 3", 9, "scene.bodies.cube.mesh.subdivisions", "`nodes_per_edge` for a box"),
    ("a mesh of nothing", "{ nodes_per_edge: 3 }", "{}", 9, "scene.bodies.cube.mesh.nodes_per_edge", "missing"),
    ("a mesh on a point", "shape: none", "shape: none\n      mesh: { subdivisions: 1 }", 14, "scene.bodies.point.mesh", "no mesh"),
    ("a sphere too fine", "{ box: { size_m: [1, 1, 1] } }\n      mesh: { nodes_per_edge: 3 }", "{ sphere: { radius_m: 1 } }\n      mesh: { subdivisions: 8 }", 9, "scene.bodies.cube.mesh.subdivisions", "from 0 to 7, found 8"),
    ("an impossible inertia", CUBE, "      mass_kg: 1\n      inertia_kg_m2: [1, 1, 2.1]\n", 11, "scene.bodies.cube.inertia_kg_m2", "none is larger than the sum of the other two, found principal moments 1, 1, 2.1"),
    ("an impossible inertia, in full", CUBE, "      mass_kg: 1\n      inertia_kg_m2: [[1, 0, 0], [0, 2, 0], [0, 0, 9]]\n", 11, "scene.bodies.cube.inertia_kg_m2", "none is larger than the sum"),
    ("an inertia that is not symmetric", CUBE, "      mass_kg: 1\n      inertia_kg_m2: [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]\n", 11, "scene.bodies.cube.inertia_kg_m2", "symmetric"),
    ("an inertia of zero", CUBE, "      mass_kg: 1\n      inertia_kg_m2: [0, 1, 1]\n", 11, "scene.bodies.cube.inertia_kg_m2", "greater than 0"),
    ("a spinning point", "mass_kg: 0.5", "mass_kg: 0.5\n      angular_velocity_rad_s: [0, 1, 0]", 15, "scene.bodies.point.angular_velocity_rad_s", "cannot spin"),
    ("two angular velocities", CUBE, "      mass_kg: 1\n      angular_velocity_rad_s: [0, 1, 0]\n      angular_velocity_body_rad_s: [0, 1, 0]\n", 12, "scene.bodies.cube.angular_velocity_body_rad_s", "found both"),
    ("no rotation", CUBE, "      mass_kg: 1\n      orientation: { quaternion_xyzw: [0, 0, 0, 0] }\n", 11, "scene.bodies.cube.orientation.quaternion_xyzw", "the zero quaternion"),
    ("two orientations", CUBE, "      mass_kg: 1\n      orientation: { euler_xyz_deg: [0, 0, 0], axis: [1, 0, 0], angle_deg: 3 }\n", 11, "scene.bodies.cube.orientation", "found more than one"),
    ("an axis without angle", CUBE, "      mass_kg: 1\n      orientation: { axis: [1, 0, 0] }\n", 11, "scene.bodies.cube.orientation.angle_deg", "missing"),
    ("an axis of length zero", CUBE, "      mass_kg: 1\n      orientation: { axis: [0, 0, 0], angle_deg: 3 }\n", 11, "scene.bodies.cube.orientation.axis", "the zero vector"),
    ("a restitution above 1", CUBE, "      mass_kg: 1\n      restitution: 1.1\n", 11, "scene.bodies.cube.restitution", "from 0 to 1"),
    ("lumped without a mesh", "shape: none", "shape: none\n      inertia_from: lumped", 14, "scene.bodies.point.inertia_from", "no `mesh`"),
    // The rest of the scene.
    ("a negative friction", "friction: 0.3", "friction: -0.3", 2, "scene.friction", "at least 0, found -0.3"),
    ("a flat container", "[4, 4, 4]", "[4, 4, -4]", 5, "scene.container.box.size_m.2", "greater than 0"),
    ("a plane without direction", "    box:\n      size_m: [4, 4, 4]\n", "    planes:\n      - normal: [0, 1, 0]\n      - normal: [0, 0, 0]\n", 6, "scene.container.planes.1.normal", "the zero vector"),
    ("a container of no planes", "    box:\n      size_m: [4, 4, 4]\n", "    planes: []\n", 4, "scene.container.planes", "at least one plane"),
    ("a container from a mesh", "    box:\n", "    mesh:\n", 4, "scene.container.mesh", "`mesh` is not available in this version"),
    ("a direction without speed", "  friction: 0.3\n", "  random: { direction: downward }\n", 2, "scene.random.speed_m_s", "`direction` needs a speed"),
    ("a random spin of a point", "  friction: 0.3\n", "  random: { spin_rad_s: 1 }\n", 2, "scene.random.spin_rad_s", "`point` is a point without `inertia_kg_m2`"),
    ("a contact with nothing", "  friction: 0.3\n  container:\n    box:\n      size_m: [4, 4, 4]\n", "  random: { place: at-contact }\n", 2, "scene.random.place", "no `container` to touch"),
    ("a contact of nothing", "  bodies:\n    - name: cube\n      shape: { box: { size_m: [1, 1, 1] } }\n      mesh: { nodes_per_edge: 3 }\n      mass_kg: 1.0\n      position_m: [0, 2, 0]\n", "  random: { place: at-contact }\n  bodies:\n", 6, "scene.random.place", "no body has a shape"),
    // Method and scene.
    ("the lecture without mesh", "      mesh: { nodes_per_edge: 3 }\n", "", 7, "scene.bodies.cube.mesh", "the method `lecture` touches with nodes and needs a mesh"),
    ("no sweeps", LECTURE, "method: { lecture: { sweeps: 0 } }\n", 16, "method.lecture.sweeps", "at least 1, found 0"),
    ("no stiffness", LECTURE, "method: { penalty: { stiffness_n_m: 0 } }\n", 16, "method.penalty.stiffness_n_m", "greater than 0"),
    // Time, divergence, recording.
    ("no step", "  step_s: 0.01\n", "", 17, "time.step_s", "missing: the length of a step"),
    ("a negative step", "step_s: 0.01", "step_s: -0.01", 18, "time.step_s", "greater than 0"),
    ("a step too small", "step_s: 0.01", "step_s: 1e-13", 18, "time.step_s", "found 1e-13 (10000000000000 steps to 1 s)"),
    ("an end at zero", "end_s: 1.0", "end_s: 0", 19, "time.end_s", "greater than 0, found 0"),
    ("an energy factor of 1", END, "  end_s: 1\ndiverge:\n  energy_factor: 1\n", 21, "diverge.energy_factor", "greater than 1"),
    ("a negative interval", END, "  end_s: 1\nrecord: { every_s: -1 }\n", 20, "record.every_s", "at least 0"),
    ("an unknown stream", END, "  end_s: 1\nrecord:\n  streams: [bodies, contact]\n", 21, "record.streams.1", "did you mean `contacts`?"),
    ("a critical step of no spring", END, "  end_s: 1\nmeasure: [state, critical-step]\n", 20, "measure.1", "only the step of the method `penalty` is critical, found `critical-step`"),
    ("an unknown closed form", END, "  end_s: 1\nexact: free-motoin\n", 20, "exact", "found `free-motoin`; did you mean `free-motion`?"),
    ("a closed form where bodies touch", END, "  end_s: 1\nexact: free-motion\n", 20, "exact", "a body may touch the container, found `free-motion`"),
    ("an unknown measure", END, "  end_s: 1\nmeasure: [contact-matrx]\n", 20, "measure.0", "did you mean `contact-matrix`?"),
    ("an unknown cone", LECTURE, "method: { lecture: { cone: disk } }\n", 16, "method.lecture.cone", "did you mean `disc`?"),
    // Forces, air, pins. (Item 0 is `cube`, item 1 `point`, without inertia.)
    ("a force on nobody", FRICTION, "  forces: [{ body: cub, force_n: [1, 0, 0] }]\n", 2, "scene.forces.0.body", "did you mean `cube`?"),
    ("a force without force", FRICTION, "  forces: [{ body: cube }]\n", 2, "scene.forces.0.force_n", "give `force_n` or `torque_n_m`"),
    ("a place without force", FRICTION, "  forces: [{ body: cube, torque_n_m: [1, 0, 0], at_m: [1, 0, 0] }]\n", 2, "scene.forces.0.at_m", "a `force_n` that acts there"),
    ("a torque on a point", FRICTION, "  forces: [{ body: point, torque_n_m: [1, 0, 0] }]\n", 2, "scene.forces.0.torque_n_m", "a point without `inertia_kg_m2`"),
    ("an unknown course", FRICTION, "  forces: [{ body: cube, force_n: [1, 0, 0], as: sine }]\n", 2, "scene.forces.0.as", "expected one of constant, cosine"),
    ("a negative frequency", FRICTION, "  forces: [{ body: cube, force_n: [1, 0, 0], as: { cosine: { frequency_rad_s: -1 } } }]\n", 2, "scene.forces.0.as.cosine.frequency_rad_s", "at least 0"),
    ("air without a coefficient", FRICTION, "  air: { density_kg_m3: 1.2 }\n", 2, "scene.air.drag_coefficient", "`density_kg_m3` needs a coefficient"),
    ("air that is nothing", FRICTION, "  air: {}\n", 2, "scene.air.density_kg_m3", "does nothing"),
    ("the drag of a point", FRICTION, "  air: { density_kg_m3: 1.2, drag_coefficient: 1 }\n", 2, "scene.air.drag_coefficient", "bodies with a surface"),
    ("a pin with a contact method", FRICTION, "  pins: [{ body: cube, point_m: [0, 0, 0] }]\n", 2, "scene.pins", "a pin with the method `lecture`"),
    ("a pin on itself", FRICTION, "  pins: [{ body: cube, point_m: [0, 0, 0], with: cube }]\n", 2, "scene.pins.0.with", "another body"),
    ("a pin beside a point", FRICTION, "  pins: [{ body: point, point_m: [1, 0, 0] }]\n", 2, "scene.pins.0.point_m", "a point without `inertia_kg_m2`"),
    ("fixed and told to move", CUBE, "      mass_kg: 1.0\n      fixed: true\n      kinematic: {}\n", 12, "scene.bodies.cube.kinematic", "either `fixed` or `kinematic`"),
    ("fixed with a velocity", CUBE, "      mass_kg: 1.0\n      fixed: true\n      velocity_m_s: [1, 0, 0]\n", 12, "scene.bodies.cube.velocity_m_s", "the body is `fixed`"),
    // The text.
    ("a bracket left open", "[0, 2, 0]", "[0, 2, 0", 12, "", "not valid YAML"),
    ("a tab", "seed: 7", "\tseed: 7", 15, "", "not valid YAML"),
];

fn edited(from: &str, to: &str) -> String {
    assert!(BASE.contains(from), "`{from}` is not in the base");
    BASE.replacen(from, to, 1)
}

#[test]
fn a_bad_input_is_refused_with_its_line_its_key_path_and_what_was_expected() {
    for (what, from, to, line, path, fragment) in ROWS {
        let error = experiment(&edited(from, to), &[]).expect_err(what);
        let details = error.details();
        let text = error.to_string();
        assert_eq!((details.line, details.path.to_string().as_str()), (Some(*line), *path), "{what}: {text}");
        assert!(text.contains(fragment), "{what}: {text}");
        assert!(text.starts_with(&format!("a.yaml:{line}: ")), "{what}: {text}");
        assert!(!text.contains('\n') && !error.is_machine(), "{what}: {text}");
    }
}

#[test]
fn the_base_of_the_bad_inputs_is_good() {
    experiment(BASE, &[]).unwrap();
}

#[test]
fn penalty_refuses_restitution_wherever_it_is_written() {
    let penalty = BASE.replace("method: lecture", "method: { penalty: { stiffness_n_m: 1e4 } }");
    experiment(&penalty, &[]).unwrap();
    for path in ["scene.restitution", "scene.bodies.cube.restitution"] {
        let error = experiment(&penalty, &[&format!("{path}=0.5")]).unwrap_err();
        assert_eq!(error.details().path.to_string(), path);
        assert!(error.to_string().contains("`penalty` has no restitution"), "{error}");
    }
}

#[test]
fn tangential_restitution_is_newtons_law_of_time_stepping_alone() {
    let line = "  pairs: [{ between: [cube, container], restitution: 0, tangential_restitution: 0.5 }]\n";
    let with = |method: &str| BASE.replace(FRICTION, &format!("{FRICTION}{line}")).replace(LECTURE, method);
    experiment(&with("method: time-stepping\n"), &[]).unwrap();
    experiment(&with("method: free\n"), &[]).unwrap();
    for (method, word) in [
        ("method: lecture\n", "`lecture`"),
        ("method: { penalty: { stiffness_n_m: 1e4 } }\n", "`penalty`"),
        ("method: { time-stepping: { impact: poisson } }\n", "`poisson`"),
        ("method: { time-stepping: { impact: sequential } }\n", "`sequential`"),
    ] {
        let error = experiment(&with(method), &[]).unwrap_err();
        assert_eq!(error.details().path.to_string(), "scene.pairs.0.tangential_restitution");
        assert!(error.to_string().contains(&format!("{word} has no tangential restitution")), "{error}");
    }
}

#[test]
fn a_pin_needs_an_end_that_moves_and_velocities_that_agree() {
    let free = BASE.replace("method: lecture", "method: free");
    let refused = |sets: &[&str], path: &str, fragment: &str| {
        let error = file(&free, sets).and_then(|file| gotai::sweep::plan::single_case(&file)).unwrap_err();
        assert_eq!(error.details().path.to_string(), path);
        assert!(error.to_string().contains(fragment), "{error}");
    };
    let pin = "scene.pins=[{ body: cube, point_m: [0, 1, 0] }]";
    refused(&[pin, "scene.bodies.cube.fixed=true"], "scene.pins.0", "two fixed ends (`cube` and the world)");
    let other = "scene.pins=[{ body: cube, point_m: [0, 1, 0], with: point }]";
    let told = "scene.bodies.point.kinematic={ velocity_m_s: [1, 0, 0] }";
    refused(&[other, told, "scene.bodies.cube.fixed=true"], "scene.pins.0", "two fixed ends (`cube` and `point`)");
    let off = "scene.bodies.cube.velocity_m_s=[0, 0.001, 0]";
    refused(&[pin, off], "scene.pins.0", "`cube` and the world parting with 1.000e-3 m/s");
    refused(&[pin, off], "scene.pins.0", "without `scene.bodies.cube.velocity_m_s` it follows from the pin");
}

#[test]
fn bodies_that_never_touch_may_be_many() {
    let text = BASE.replace("shape: none", "shape: { sphere: { radius_m: 1 } }").replace("lecture", "free");
    experiment(&text, &[]).unwrap();
}

#[test]
fn a_file_without_content_says_so() {
    for text in ["", "\n\n", "# only a comment\n", "---\n"] {
        let error = file(text, &[]).unwrap_err();
        assert!(error.to_string().starts_with("a.yaml: the file is empty"), "{text:?}: {error}");
    }
    for text in ["[1, 2]", "just text", "5"] {
        let error = file(text, &[]).unwrap_err();
        assert!(error.to_string().starts_with("a.yaml: expected an experiment"), "{text:?}: {error}");
    }
    let two = file("a: 1\n---\nb: 2\n", &[]).unwrap_err();
    assert_eq!((two.details().kind, two.details().line), (Kind::Syntax, Some(3)), "{two}");
}

#[test]
fn a_list_without_bodies_is_refused() {
    let error = experiment("scene: { bodies: [] }\ntime: { step_s: 1, end_s: 1 }\n", &[]).unwrap_err();
    assert_eq!(error.to_string(), "a.yaml:1: scene.bodies: expected at least one body, found an empty list");
}

#[test]
fn an_unreadable_file_is_told_from_a_wrong_one() {
    let folder = crate::scratch::folder();
    let bytes = folder.path().join("bytes.yaml");
    std::fs::write(&bytes, b"seed: 1\nquestion: \xff\n").unwrap();
    let load = |path: &Path| ExperimentFile::load(path, &[]).unwrap_err();
    for (path, kind) in [
        (folder.path().join("absent.yaml"), Kind::File),
        (folder.path().to_path_buf(), Kind::File),
        (bytes.join("below-a-file.yaml"), Kind::File),
        (bytes.clone(), Kind::File),
    ] {
        let error = load(&path);
        assert_eq!(error.details().kind, kind, "{error}");
        assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
    }
    assert_eq!(load(&bytes).details().line, Some(2));
    // A file of the kernel that exists and cannot be read, even by root.
    let unreadable = Path::new("/proc/self/mem");
    if unreadable.exists() {
        assert!(load(unreadable).is_machine());
    }
}

#[test]
fn text_that_nests_without_end_is_refused_quickly() {
    let error = file(&"[".repeat(100_000), &[]).unwrap_err();
    assert_eq!(error.details().kind, Kind::Syntax);
}

#[test]
fn any_slip_of_one_character_gives_an_experiment_or_one_line_that_says_where() {
    let slips = ["", ":", "- ", "{", "}", "[", ",", "&", "*", "|", "'", "#", "\n", "\t", "?", "~", "0", ".", "é"];
    let (mut good, mut bad) = (0, 0);
    for (i, slip) in (0..BASE.len()).flat_map(|i| slips.map(|slip| (i, slip))) {
        let text = format!("{}{slip}{}", &BASE[..i], &BASE[i + 1..]);
        match experiment(&text, &[]) {
            Ok(_) => good += 1,
            Err(error) => {
                bad += 1;
                assert!(error.details().line.is_some() && !error.to_string().contains('\n'), "{text}\n{error}");
            }
        }
    }
    // Measured: 310 and 6,036.
    assert!(good > 200 && bad > 5000, "{good} good, {bad} bad");
}

#[test]
fn an_error_below_an_alias_points_to_the_line_that_uses_it() {
    let text =
        BASE.replace("[0, 2, 0]", "&here [0, 2]").replace("mass_kg: 0.5", "mass_kg: 0.5\n      position_m: *here");
    let error = experiment(&text, &["scene.bodies.cube.position_m=[0,0,0]"]).unwrap_err();
    assert_eq!(error.details().line, Some(15), "{error}");
}

#[test]
fn the_machine_readable_form_has_every_part() {
    let error = experiment(&BASE.replace("friction", "fricton"), &[]).unwrap_err();
    let json = serde_json::to_value(error.details()).unwrap();
    assert_eq!(json["file"], "a.yaml");
    assert_eq!((json["line"].as_u64(), json["column"].as_u64()), (Some(2), Some(3)));
    assert_eq!(json["kind"], "unknown-key");
    assert_eq!(json["path"], "scene.fricton");
    assert_eq!(json["found"], "`fricton`");
    assert_eq!(json["nearest"], "friction");
    assert_eq!(json["known"][1], "friction");
}

#[test]
fn another_module_can_complain_about_a_value_at_its_line() {
    let error = file(BASE, &[]).unwrap().error_at(&[], "scene.bodies.cube.position_m", "no overlap", "overlap");
    assert_eq!(error.to_string(), "a.yaml:11: scene.bodies.cube.position_m: expected no overlap, found overlap");
    let error = file(BASE, &["scene.bodies.cube.position_m=[0,0,0]"]).unwrap();
    let error = error.error_at(&[], "scene.bodies.cube.position_m", "no overlap", "overlap");
    assert!(error.to_string().starts_with("--set scene.bodies.cube.position_m=[0,0,0]: "), "{error}");
}

#[test]
fn a_brace_at_the_start_of_a_line_does_not_lose_the_lines_below() {
    let text = BASE.replace("method: lecture", "method: {\n  lecture: { sweeps: 3 }\n}").replace("step_s", "stp_s");
    assert_eq!(experiment(&text, &[]).unwrap_err().details().line, Some(20));
}
