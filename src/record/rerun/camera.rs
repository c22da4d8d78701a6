//! The camera that a recording opens with: on what the bodies sweep, not on the container.

use super::seen::{Room, Seen};
use crate::record::sample::{Header, cross, dot, norm};

/// Direction from the middle to the eye: in front, to the right, above.
const FROM: [f64; 3] = [0.45, 0.34, 0.83];
/// The viewer's vertical angle of view, in radians (55°), and width by height of the narrowest view it gets.
const ANGLE: f64 = 0.96;
const ASPECT: f64 = 1.1;
/// Part of the view's height, or width, that the motion takes.
const PART: f64 = 0.68;
/// Length of the way in bodies' diameters from which the camera follows a body that is alone: with all of it in view
/// the body would take less than a sixth of the view's height.
const FAR: f64 = 3.0;
/// Distance of a camera that follows, in bounding radii: a ball takes a third of the view's height, a disc that lies a
/// sixth.
const FOLLOWING: f64 = 5.5;
/// Distance from which the viewer looks at what it goes along with, in radii of the sphere about its box. (Measured.)
const VIEWERS_OWN: f64 = 1.5;

/// Where the eye is and what it looks at.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub position: [f64; 3],
    pub target: [f64; 3],
    /// Whether it goes along with the one body.
    pub follows: bool,
    /// Length of the motion that is in view.
    pub size_m: f64,
    /// Middle, lowest corner and half of the longest side of the room that is in view.
    pub middle: [f64; 3],
    pub low: [f64; 3],
    pub half_m: f64,
}

impl Camera {
    /// Whether a place is in the picture, or near it.
    pub fn is_near(&self, p: [f32; 3]) -> bool {
        /// Half sides of the room.
        const NEAR: f64 = 2.5;
        (0..3).all(|i| (f64::from(p[i]) - self.middle[i]).abs() <= NEAR * self.half_m)
    }
}

/// Lengths that the viewer shows as they are; smaller and larger scenes are drawn to this scale, as its near plane
/// stands still.
const SHOWN_M: [f64; 2] = [0.5, 500.0];

/// Factor by which a scene is drawn: a power of ten, 1 where the viewer can show it as it is. The numbers beside the
/// picture are not touched by it.
pub fn scale(header: &Header) -> f64 {
    let size_m = header.bodies.iter().map(|body| 4.0 * body.bounding_radius_m).fold(0.0, f64::max);
    if !(size_m > 0.0 && size_m.is_finite()) || (SHOWN_M[0]..SHOWN_M[1]).contains(&size_m) {
        return 1.0;
    }
    libm::exp10(libm::round(libm::log10(10.0 / size_m)))
}

/// Camera of a run that was calm until a time; None where there is nothing to see.
pub fn camera(header: &Header, seen: &Seen, calm_until_s: f64) -> Option<Camera> {
    camera_on(header, seen.room_until(calm_until_s)?)
}

/// Camera on a room that is swept.
pub fn camera_on(header: &Header, room: Room) -> Option<Camera> {
    let radius_m = header.bodies.iter().map(|body| body.bounding_radius_m).fold(0.0, f64::max);
    let (mut low, mut high) = (room.low, room.high);
    if let Some((floor, ceiling)) = header.container_box_m() {
        for i in 0..3 {
            low[i] = low[i].max(floor[i]).min(high[i]);
            high[i] = high[i].min(ceiling[i]).max(low[i]);
        }
    }
    let follows = header.bodies.len() == 1 && way_m(room, radius_m) > FAR * 2.0 * radius_m && header.streams.bodies;
    let from = FROM.map(|x| x / norm(FROM));
    let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
    let half: [f64; 3] = std::array::from_fn(|i| 0.5 * (high[i] - low[i]));
    let size_m = 2.0 * norm(half);
    if size_m.is_nan() || size_m <= 0.0 || !size_m.is_finite() {
        return None;
    }
    let away_m = if follows { FOLLOWING * radius_m } else { distance_m(half, from) };
    let position = std::array::from_fn(|i| middle[i] + away_m * from[i]);
    let half_m = half.iter().copied().fold(0.0, f64::max);
    Some(Camera {
        position,
        target: middle,
        follows,
        size_m: if follows { 6.0 * radius_m } else { size_m },
        middle,
        low,
        half_m,
    })
}

/// Half the side of a cube about a body of this radius from which the viewer, going along, looks from as far as is
/// asked for: it looks at the box of what it is told to follow, from where it likes.
pub fn followed_half_m(radius_m: f64) -> f64 {
    FOLLOWING * radius_m / (VIEWERS_OWN * 3_f64.sqrt())
}

fn way_m(room: Room, radius_m: f64) -> f64 {
    norm(std::array::from_fn(|i| room.high[i] - room.low[i] - 2.0 * radius_m))
}

/// Distance from which a box of these half sides takes its part of the view.
fn distance_m(half: [f64; 3], from: [f64; 3]) -> f64 {
    let right = [from[2], 0.0, -from[0]];
    let right = right.map(|x| x / norm(right));
    let up = cross(from, right);
    let tangent = libm::tan(0.5 * ANGLE);
    let corners = (0..8).map(|i| std::array::from_fn(|axis| if i >> axis & 1 == 1 { half[axis] } else { -half[axis] }));
    let needed = |corner: [f64; 3]| {
        let (x, y, near) = (dot(corner, right).abs(), dot(corner, up).abs(), dot(corner, from));
        near + (y / (tangent * PART)).max(x / (tangent * ASPECT * PART))
    };
    corners.map(needed).fold(0.0, f64::max)
}

/// A round length of about a tenth of the motion.
pub fn spacing_m(size_m: f64) -> f64 {
    rounded(0.1 * size_m)
}

/// The nearest number that is 1, 2 or 5 of a power of ten.
pub fn rounded(exact: f64) -> f64 {
    let power = libm::exp10(libm::floor(libm::log10(exact)));
    let part = exact / power;
    power
        * if part < 1.5 {
            1.0
        } else if part < 3.5 {
            2.0
        } else if part < 7.5 {
            5.0
        } else {
            10.0
        }
}
