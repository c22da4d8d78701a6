//! The kinds of contact.

use super::crossing::OnRim;
use super::curved::Curved;
use super::plane::Plane;
use super::rim_on_edge::RimOnEdge;
use crate::event::shown::{Ball, Line, Part};

/// What meets what.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Parts {
    /// A part of one body on a plane of the other, or of the container.
    OnPlane {
        of: usize,
        part: Part,
        plane: Plane,
    },
    Balls([Ball; 2]),
    /// Two edges, or round sides, that cross.
    Lines([Line; 2]),
    /// The ball is of the first body, or of the other.
    BallOnLine {
        first: bool,
        ball: Ball,
        line: Line,
    },
    /// What lies flat on a cap crosses its rim.
    OnRim(OnRim),
    Curved(Curved),
    /// The rim of a cap that is next to flat crosses an edge.
    RimOnEdge(RimOnEdge),
}
