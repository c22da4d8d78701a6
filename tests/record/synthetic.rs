//! A made-up run to record: a cube bounces, turning, on the floor of a 4 m box. Everything follows from the sample's
//! number, so that a test can say what a file must hold.

use gotai::outcome::Outcome;
use gotai::record::name::RecordingName;
use gotai::record::sample::{Batch, BodyHeader, ContactSample, Ending, EnergySample, Header, Streams, contact_mode};
use gotai::record::story::{Decisive, EnergyGain, Story, TurningPoint};
use gotai::rows::{BodyRow, Measured, cells};

pub const ALL: Streams = Streams { bodies: true, contacts: true, forces: true, energy: true, velocities: false };
pub const NONE: Streams = Streams { bodies: false, contacts: false, forces: false, energy: false, velocities: false };

pub const STEP_S: f64 = 0.001;
pub const CONFIG: &str = "name: bouncing\nscene:\n  bodies:\n    - { name: cube, shape: { cube: { edge_m: 0.8 } } }\n";

const HALF_EDGE_M: f64 = 0.4;
const MASS_KG: f64 = 1.0;
const BOUNCE_M: f64 = 2.0;
const FRICTION: f64 = 0.5;

pub fn header(streams: Streams) -> Header {
    Header {
        case: "0123456789abcdef".to_owned(),
        name: RecordingName::new(&["0.5".to_owned(), "fine".to_owned()], "01234567"),
        axes: vec![("scene.friction".to_owned(), 0.5.into()), ("method".to_owned(), "fine".into())],
        title: "A cube bounces in a box".to_owned(),
        question: "Does it bounce?".to_owned(),
        method: "lecture".to_owned(),
        program: "gotai 0.0.0".to_owned(),
        build: "0123abcd".to_owned(),
        config_yaml: CONFIG.to_owned(),
        step_s: Some(STEP_S),
        sample_every_s: STEP_S,
        streams,
        bodies: vec![BodyHeader {
            name: "cube[0]".to_owned(),
            has_no_shape: false,
            touches_with_nodes: true,
            pins_m: Vec::new(),
            vertices_m: corners(HALF_EDGE_M).to_vec(),
            triangles: TRIANGLES.to_vec(),
            bounding_radius_m: HALF_EDGE_M * 3.0_f64.sqrt(),
        }],
        container_strips_m: box_strips(),
        planes: vec![([0.0, 1.0, 0.0], 0.0)],
        ground: ([0.0; 3], 2.0),
        arrow_m_per_n: 0.02,
        arrow_weight_n: Some(9.8),
        arrow_longest_m: 7.0,
        arrow_m_per_m_s: 0.1,
        energy_unit: ("J", 1.0),
        end_s: 1e3,
        most_bytes: 1 << 30,
        energy_factor: Some(1000.0),
    }
}

pub const WARNING: &str = "the run is not solved (residual_max 0.8)";

/// A run that exploded.
pub fn ending() -> Ending {
    Ending {
        outcome: Outcome::Diverged,
        criterion: Some("energy".to_owned()),
        end_time_s: 0.25,
        steps: 250,
        warnings: Some(WARNING.to_owned()),
        notes: None,
        row: cells(&Measured { contacts_max: 4, residual_max: Some(0.8), ..Measured::default() }),
        story: story(),
        flight: None,
        left_out: 0,
    }
}

/// A first contact, and a gain that ends it.
pub fn story() -> Story {
    let turn = |what, step, text: &str| TurningPoint { what, step, time_s: time_s(step), text: text.to_owned() };
    let gain = EnergyGain { step: 240, acted_s: time_s(239), time_s: time_s(240), before_j: 1.0, after_j: 40_000.0 };
    Story {
        turns: vec![
            turn(Decisive::FirstContact, 0, "cube[0] and container"),
            turn(Decisive::Onset, 240, "1 → 40000 J"),
            turn(Decisive::End, 250, "diverged: energy"),
        ],
        gains: vec![gain],
        gains_count: 1,
        start_j: energy(0).total_j,
        stretch_s: [0.2, 0.25],
        calm_until_s: 0.24,
    }
}

/// What `open` calls the files of such a run, without their endings.
pub const NAME: &str = "0.5_fine_diverged.01234567";

/// Appends sample number `i` to a batch.
pub fn push(batch: &mut Batch, i: u64, streams: Streams) {
    let body = body(i);
    let contacts = contacts(i);
    batch.step.push(i);
    batch.time_s.push(time_s(i));
    if streams.bodies {
        batch.bodies.push(body);
    }
    if streams.any_contact() {
        batch.contacts_len.push(contacts.len() as u32);
        batch.contacts.extend(contacts);
    }
    if streams.energy {
        batch.energy.push(energy(i));
    }
}

pub fn batch(samples: std::ops::Range<u64>, streams: Streams) -> Batch {
    let mut batch = Batch::default();
    samples.for_each(|i| push(&mut batch, i, streams));
    batch
}

pub fn time_s(i: u64) -> f64 {
    i as f64 * STEP_S
}

/// One bounce a second, one turn about an edge a second.
pub fn body(i: u64) -> BodyRow {
    let part = time_s(i).fract();
    let half_turn = std::f64::consts::PI * part;
    BodyRow {
        position_m: [0.3, HALF_EDGE_M + 4.0 * BOUNCE_M * part * (1.0 - part), -0.2],
        orientation_xyzw: [0.0, 0.0, libm::sin(half_turn), libm::cos(half_turn)],
        velocity_m_s: [0.0, 4.0 * BOUNCE_M * (1.0 - 2.0 * part), 0.0],
        angular_velocity_rad_s: [0.0, 0.0, 2.0 * std::f64::consts::PI],
    }
}

/// Corners close to the floor, none for most of the flight.
pub fn contacts(i: u64) -> Vec<ContactSample> {
    let body = body(i);
    let [_, _, sin, cos] = body.orientation_xyzw;
    let (sin, cos) = (2.0 * sin * cos, cos * cos - sin * sin);
    let corner = |[x, y, z]: [f64; 3]| {
        let [px, py, pz] = body.position_m;
        [px + cos * x - sin * y, py + sin * x + cos * y, pz + z]
    };
    let near = corners(HALF_EDGE_M).map(corner).into_iter().filter(|point| point[1] < 0.1);
    let contact = |point: [f64; 3]| {
        let (normal, force_n) = ([0.0, 1.0, 0.0], [3.0 * sin, 300.0 * (0.1 - point[1]), 0.0]);
        let (mode, friction_use) = contact_mode(force_n, normal, FRICTION);
        ContactSample { body: 0, other: None, point_m: point, normal, force_n, gap_m: point[1], friction_use, mode }
    };
    near.map(contact).collect()
}

pub fn energy(i: u64) -> EnergySample {
    let BodyRow { position_m, velocity_m_s, .. } = body(i);
    let kinetic_j = 0.5 * MASS_KG * velocity_m_s[1] * velocity_m_s[1];
    let potential_j = MASS_KG * 8.0 * BOUNCE_M * position_m[1];
    let lowest_m = contacts(i).iter().map(|contact| contact.gap_m).fold(0.0, f64::min);
    EnergySample { kinetic_j, potential_j, total_j: kinetic_j + potential_j, penetration_m: -lowest_m }
}

fn corners(half_m: f64) -> [[f64; 3]; 8] {
    std::array::from_fn(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { half_m } else { -half_m }))
}

const TRIANGLES: [[u32; 3]; 12] = [
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
];

/// Floor, ceiling and four edges of the box from (-2, 0, -2) to (2, 4, 2).
fn box_strips() -> Vec<Vec<[f64; 3]>> {
    let square = |y: f64| vec![[-2.0, y, -2.0], [2.0, y, -2.0], [2.0, y, 2.0], [-2.0, y, 2.0], [-2.0, y, -2.0]];
    let edge = |x: f64, z: f64| vec![[x, 0.0, z], [x, 4.0, z]];
    vec![square(0.0), square(4.0), edge(-2.0, -2.0), edge(2.0, -2.0), edge(2.0, 2.0), edge(-2.0, 2.0)]
}
