//! The contacts of the step of the largest gain, in a row that is run again.

use super::story::EXPLODES;
use crate::cli::{json, run};
use crate::scratch;
use gotai::record::flight::Flight;
use gotai::record::read::recording_of;
use nalgebra::{DMatrix, DVector};

fn replayed() -> (Flight, gotai::record::read::ReadBack) {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let d = json(&[&["run"], &EXPLODES[..], &["--record", "none", "--json", "--out", out]].concat());
    let id = d["case"].as_str().unwrap();
    let (code, _, err) = run(&["run", out, "--case", id, "--record", "mcap"]);
    assert_eq!(code, 0, "{err}");
    let files = std::fs::read_dir(folder.path().join("replays")).unwrap().map(|entry| entry.unwrap().path());
    let file = files.into_iter().find(|path| path.extension().is_some_and(|ending| ending == "mcap")).unwrap();
    let recording = recording_of(&file).unwrap().unwrap();
    let flight = recording.ending.clone().unwrap().flight.unwrap();
    (flight, recording)
}

#[test]
fn the_step_of_the_largest_gain_shows_its_contacts() {
    let (flight, recording) = replayed();
    let Flight { contacts, a_per_kg, eigenvalues_per_kg, .. } = &flight;
    assert!(!contacts.is_empty() && contacts.len() == flight.contacts_count);
    // The first one gained.
    assert!(contacts[0].given_j > 0.0 && contacts.is_sorted_by(|a, b| a.given_j >= b.given_j));
    // u⁺ = A p + b.
    let rows = 3 * contacts.len();
    let a = DMatrix::from_fn(rows, rows, |i, k| a_per_kg[i][k]);
    let of = |pick: fn(&gotai::record::flight::FlightContact) -> [f64; 3]| {
        DVector::from_iterator(rows, contacts.iter().flat_map(pick))
    };
    let p = of(|contact| contact.force_n) * flight.step_s;
    let after = of(|contact| contact.after_m_s);
    let error = (&a * p + of(|contact| contact.b_m_s) - &after).norm() / after.norm();
    assert!(error < 1e-12, "{error}"); // measured: 2e-15
    // Six degrees of freedom.
    let largest = eigenvalues_per_kg[0];
    assert!(eigenvalues_per_kg.iter().filter(|value| **value > 1e-9 * largest).count() <= 6);
    let trace: f64 = eigenvalues_per_kg.iter().sum();
    assert!((trace / a.trace() - 1.0).abs() < 1e-12);
    // What the contacts gave is what the kinetic energy gained, but for what gravity did before.
    let samples = &recording.samples;
    let i = samples.step.iter().position(|step| *step == flight.step).unwrap();
    let before = &samples.bodies[i - 1];
    let (mass_kg, g) = (1.0, -9.81);
    let v = before.velocity_m_s[1];
    let gravity_j = mass_kg * g * flight.step_s * (v + 0.5 * g * flight.step_s);
    let gained_j = samples.energy[i].kinetic_j - samples.energy[i - 1].kinetic_j - gravity_j;
    assert!((flight.given_j / gained_j - 1.0).abs() < 1e-9, "{} {gained_j}", flight.given_j);
    assert_eq!(flight.time_s, samples.time_s[i - 1]);
}
