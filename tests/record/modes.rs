//! What a contact does is told by its force alone.

use gotai::record::sample::{ContactMode, contact_mode};
use gotai::record::story::brief;

#[test]
fn a_force_tells_what_its_contact_does() {
    let up = [0.0, 1.0, 0.0];
    let cases = [
        ([0.0, 0.0, 0.0], 0.5, ContactMode::Open, 0.0),
        ([0.0, 2.0, 0.0], 0.5, ContactMode::Sticking, 0.0),
        ([0.0, 2.0, 0.5], 0.5, ContactMode::Sticking, 0.5),
        ([0.6, 2.0, 0.8], 0.5, ContactMode::Sliding, 1.0),
        ([0.0, 2.0, 1.5], 0.5, ContactMode::Unsolved, 1.5),
        ([0.0, -2.0, 0.0], 0.5, ContactMode::Unsolved, 0.0),
        ([0.0, 2.0, 0.0], 0.0, ContactMode::Sliding, 0.0),
        ([1.0, 0.0, 0.0], 0.5, ContactMode::Unsolved, f64::INFINITY),
    ];
    for (force_n, friction, mode, used) in cases {
        assert_eq!(contact_mode(force_n, up, friction), (mode, used), "{force_n:?}");
        // Whatever the unit of force.
        let scaled = contact_mode(force_n.map(|f| f * 1e-12), up, friction);
        assert_eq!(scaled.0, mode, "{force_n:?}");
    }
}

#[test]
fn numbers_for_people_have_four_digits() {
    let cases = [
        (0.0, "0"),
        (4.0, "4"),
        (0.25, "0.25"),
        (1.0 / 3.0, "0.3333"),
        (647.123, "647.1"),
        (123_456.7, "123457"),
        (-7.49e-4, "-7.49e-4"),
        (2.0e7, "2e7"),
        (f64::NAN, "NaN"),
    ];
    for (x, text) in cases {
        assert_eq!(brief(x), text);
    }
}
