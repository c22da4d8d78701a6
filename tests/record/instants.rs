//! Contacts stand in a picture with the bodies that they act on at one instant.

use super::story::recorded;
use gotai::record::pictures::Pictures;
use gotai::record::sample::{Batch, ContactSample};
use gotai::rows::BodyRow;
use nalgebra::Vector3;

/// Distance from a contact's point to the nearest node of the demo's cube, 1 m with 3 nodes an edge.
fn from_node_m(body: &BodyRow, contact: &ContactSample) -> f64 {
    let at = body.state();
    let own = at.q_WB.inverse_transform_vector(&(Vector3::from(contact.point_m) - at.p_WB));
    own.map(|x| x - (2.0 * x).round().clamp(-1.0, 1.0) / 2.0).norm()
}

/// Bodies of the picture at a time.
fn at(instants: &gotai::record::pictures::Pictured, time_s: f64) -> Option<&BodyRow> {
    instants.time_s.iter().rposition(|t| *t == time_s).map(|i| &instants.bodies[i])
}

#[test]
fn contacts_are_drawn_where_they_act() {
    for method in
        ["{lecture: {}}", "time-stepping", "{time-stepping: {scheme: moreau}}", "{penalty: {stiffness_n_m: 1e4}}"]
    {
        for every in ["0", "0.05"] {
            let sets = [format!("method={method}"), format!("record.every_s={every}"), "time.step_s=0.01".to_string()];
            let mut args = vec!["configs/lecture/demo.yaml", "--set", "time.end_s=1.5"];
            sets.iter().for_each(|set| args.extend(["--set", set.as_str()]));
            let (_, _folder, _, recording) = recorded(&args);
            let instants = Pictures::default().of(&recording.samples);
            let mut contacts = 0;
            let mut moved_m = 0.0_f64;
            for (sample, time_s) in recording.samples.samples().zip(&instants.contacts_s) {
                for contact in sample.contacts {
                    contacts += 1;
                    let body = at(&instants, *time_s).expect("a picture of the instant");
                    let apart_m = from_node_m(body, contact);
                    // The point lies between the node and the face: at most as far as the gap.
                    assert!(apart_m <= 1e-9 + contact.gap_m.abs(), "{method} {every}: {apart_m} at {time_s}");
                    moved_m = moved_m.max((from_node_m(&sample.bodies[0], contact) - contact.gap_m.abs()).abs());
                }
            }
            assert!(contacts > 5, "{contacts}");
            // With the state after the step they would be off by what it moved: measured, 0.04 m and more.
            assert!(moved_m > 1e-2, "{method} {every}: {moved_m}");
        }
    }
}

/// What is left out between two samples does not tear a contact from its bodies.
#[test]
fn a_sample_of_which_the_one_before_is_left_out_has_its_own_picture() {
    let (_, _folder, file, recording) = recorded(&[
        "configs/lecture/demo.yaml",
        "--set",
        "record.every_s=0",
        "--set",
        "time.end_s=3",
        "--set",
        "record.max_mb=0.12",
    ]);
    let bytes = std::fs::metadata(&file).unwrap().len();
    assert!(bytes < 125_000, "{bytes}");
    let left_out: u64 = recording.said["left_out"].parse().unwrap();
    assert!(left_out > 500 && recording.samples.len() as u64 + left_out == 1501, "{left_out}");
    // To the end.
    assert_eq!(recording.samples.time_s.last(), Some(&3.0));
    let instants = Pictures::default().of(&recording.samples);
    for (sample, time_s) in recording.samples.samples().zip(&instants.contacts_s) {
        for contact in sample.contacts {
            let body = at(&instants, *time_s).expect("a picture of the instant");
            assert!(from_node_m(body, contact) <= 1e-9 + contact.gap_m.abs(), "at {time_s}");
        }
    }
}

#[test]
fn pictures_end_with_the_last_state() {
    let (d, _folder, _, recording) = recorded(&["configs/lecture/demo.yaml", "--set", "time.end_s=1"]);
    let mut pictures = Pictures::default();
    let first = pictures.of(&recording.samples);
    let last = pictures.end();
    let end = last.bodies.first().or(first.bodies.last()).unwrap();
    assert_eq!(Some(end.position_m[1]), d["bodies"][0]["position_m"][1].as_f64());
    assert!(pictures.end().bodies.is_empty());
    assert!(Pictures::default().of(&Batch::default()).time_s.is_empty());
}
