use gotai::model::container::{Container, Face};
use nalgebra::Vector3;

fn face(normal: [f64; 3], offset_m: f64) -> Face {
    Face { normal: Vector3::from(normal).normalize(), offset_m }
}

#[test]
fn a_box_has_its_floor_first_and_all_faces_look_inward() {
    let container = Container::new_box([4.0, 3.0, 2.0], [0.0, 1.5, 0.0]);
    let inside = Vector3::new(0.5, 1.0, -0.25);
    let gaps: Vec<f64> = container.faces.iter().map(|face| face.gap_m(&inside)).collect();
    assert_eq!(gaps, [1.0, 2.0, 2.5, 1.5, 0.75, 1.25]);
}

#[test]
fn the_lowest_point_is_found_where_there_is_one() {
    let up = Vector3::y();
    assert_eq!(Container::new_box([4.0; 3], [0.0, 7.0, 0.0]).lowest_m(&up), Some(5.0));
    assert_eq!(Container { faces: vec![face([0.0, 2.0, 0.0], -3.0)] }.lowest_m(&up), Some(-3.0));
    // A slope goes down for ever, a wall holds nothing.
    assert_eq!(Container { faces: vec![face([1.0, 1.0, 0.0], 0.0)] }.lowest_m(&up), None);
    assert_eq!(Container { faces: vec![face([1.0, 0.0, 0.0], 0.0)] }.lowest_m(&up), None);
    // A gutter and a funnel, their deepest points at y = −2.
    let down = -2.0 / 2.0_f64.sqrt();
    let gutter = Container { faces: vec![face([1.0, 1.0, 0.0], down), face([-1.0, 1.0, 0.0], down)] };
    assert!((gutter.lowest_m(&up).unwrap() + 2.0).abs() < 1e-14);
    let third = |angle: f64| face([libm::cos(angle), 1.0, libm::sin(angle)], down);
    let funnel = Container { faces: [0.0, 2.1, 4.2].map(third).to_vec() };
    assert!((funnel.lowest_m(&up).unwrap() + 2.0).abs() < 1e-14);
}
