//! What a pair of surfaces does: Coulomb friction and restitution, by default the geometric mean of the two bodies'
//! own. Tangential restitution is a pair's alone.

use super::{Body, Geometry, Model};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    pub friction: f64,
    pub restitution: f64,
    pub tangential_restitution: f64,
}

/// A value of `scene.pairs`; the container is None.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    pub between: [Option<usize>; 2],
    pub friction: Option<f64>,
    pub restitution: Option<f64>,
    pub tangential_restitution: Option<f64>,
}

impl Model {
    /// Of two bodies, or a body and the container.
    pub fn pair(&self, body: usize, other: Option<usize>) -> Surface {
        let own = self.bodies[body].surface;
        let others = other.map_or(self.container_surface, |other| self.bodies[other].surface);
        let given = self.pairs.iter().find(|pair| {
            let [a, b] = pair.between;
            (a, b) == (Some(body), other) || (b, a) == (Some(body), other)
        });
        Surface {
            friction: given.and_then(|pair| pair.friction).unwrap_or_else(|| mean(own.friction, others.friction)),
            restitution: given
                .and_then(|pair| pair.restitution)
                .unwrap_or_else(|| mean(own.restitution, others.restitution)),
            tangential_restitution: given.and_then(|pair| pair.tangential_restitution).unwrap_or(0.0),
        }
    }

    /// Some contact that can be has friction.
    pub fn is_rough(&self) -> bool {
        let touching = |body: &Body| !matches!(body.geometry, Geometry::None) && body.surface.friction > 0.0;
        self.bodies.iter().any(touching) || self.pairs.iter().any(|pair| pair.friction.is_some_and(|f| f > 0.0))
    }
}

/// Geometric; of equal values the value itself, to the last bit.
fn mean(a: f64, b: f64) -> f64 {
    if a == b { a } else { (a * b).sqrt() }
}
