//! Texts of lists about the words of the vocabulary: what each is, and where it comes from. Settings, their words and
//! defaults are asked of the parser (`vocabulary.rs`).

use super::facts::{About, about};
use super::types::{Measure, Shape};

impl Shape {
    /// Sentence for lists about what of the shape touches.
    pub fn about(&self) -> About {
        match self {
            Shape::Sphere(_) => about("Touches with its surface, or the nodes of its mesh (`subdivisions`).", ""),
            Shape::Box(_) => about("Touches with its corners, or the nodes of its mesh (`nodes_per_edge`).", ""),
            Shape::Cylinder(_) => about("Axis y; touches with its rims and caps.", ""),
            Shape::Capsule(_) => {
                about("Axis y, its height between the centres of its two spheres; touches with its surface.", "")
            }
            Shape::Ellipsoid(_) => about("Touches with its surface.", ""),
            Shape::Convex(_) => about("Hull of its vertices, all of which are corners; touches with them.", ""),
            Shape::None => about("A point with mass and inertia, without contact.", ""),
        }
    }
}

impl Measure {
    pub fn about(self) -> About {
        match self {
            Measure::State => about("Every body's state at the end.", ""),
            Measure::Inertia => about("Every body's mass properties, as the run used them.", "lecture L8, L9"),
            Measure::ContactMatrix => about(
                "A = J M⁻¹ Jᵀ of the contacts: its rank, and how fast Jacobi's iteration grows.",
                "lecture L16, L20",
            ),
            Measure::CriticalStep => about("The longest stable step of `penalty`, by linear theory.", "lecture L15"),
            Measure::DifferenceQuotients => {
                about("Difference quotients of the positions of a run against its velocities.", "lecture L1")
            }
            Measure::Sensitivity => about(
                "Three twin runs whose start is displaced a little. The column is always filled \
                 for `auto`, and with `reference:`.",
                "",
            ),
        }
    }
}
