//! Surface of a pair: Coulomb friction and restitution, by default the geometric mean of the two bodies' own.
//! Tangential restitution is a pair's alone.

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    pub friction: f64,
    pub restitution: f64,
    pub tangential_restitution: f64,
}

/// Surface that a line of `scene.pairs` says; the container is None.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    pub between: [Option<usize>; 2],
    pub friction: Option<f64>,
    pub restitution: Option<f64>,
    pub tangential_restitution: Option<f64>,
}
