//! What lists say of the words of the vocabulary: what each is, and where it comes from. Settings, their words and
//! defaults are asked of the parser (`vocabulary.rs`).

use super::facts::{About, about};
use super::types::{Exact, Measure, Shape};

impl Shape {
    /// What of it touches.
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

impl Exact {
    /// The motion.
    pub fn about(self) -> About {
        match self {
            Exact::FreeMotion => about(
                "Parabola and torque-free rotation of any body, by Jacobi elliptic functions.",
                "van Zon & Schofield, JCP 225 (2007) 145",
            ),
            Exact::SymmetricBody => about(
                "Parabola and torque-free rotation, by elementary functions.",
                "Kane, Likins & Levinson 1983, 3.1",
            ),
            Exact::LinearDrag => {
                about("Stokes' drag, exp(−c t/m), and torque-free rotation.", "lecture L2; Stokes 1851")
            }
            Exact::QuadraticDrag => about(
                "Newton's drag, tanh and ln cosh, and torque-free rotation.",
                "Parker, Am. J. Phys. 45 (1977) 606",
            ),
            Exact::HeavyTop => about(
                "Precession and nutation, sleeping top, spherical pendulum, by elliptic functions and integrals.",
                "Whittaker, Analytical Dynamics, 71–75",
            ),
            Exact::Pendulum => about(
                "The compound plane pendulum at any amplitude, by elliptic functions.",
                "Whittaker, Analytical Dynamics, 44",
            ),
            Exact::Rest => about("All bodies stay where they are.", "Newton's first law"),
            Exact::Sliding => about(
                "Sliding to a stop, sticking, or starting back down; Coulomb friction.",
                "Goldstein, Classical Mechanics, 1.5",
            ),
            Exact::Ball => about(
                "Flights, impacts with restitution (normal and tangential) and friction up to Zeno's point, sliding, \
                 rolling.",
                "Walton 1993; Garwin, Am. J. Phys. 37 (1969) 88; Routh, Advanced Rigid Dynamics, 240",
            ),
            Exact::Turntable => about(
                "Circles at k/(1 + k) of the table's rate, k = I/(m r²): 2/7 of it for a homogeneous ball.",
                "Routh, Advanced Rigid Dynamics, 224; Weltner, Am. J. Phys. 47 (1979) 984",
            ),
            Exact::RockingBlock => about(
                "Elliptic functions from impact to impact, until it stands.",
                "Housner, Bull. Seism. Soc. Am. 53 (1963) 403",
            ),
            Exact::FallingRod => about(
                "Its centre falls straight down, by a quadrature; then it lies flat, at rest.",
                "Routh, Elementary Rigid Dynamics, 136",
            ),
            Exact::Ladder => about(
                "It leaves the wall at 2/3 of its height, by elliptic functions; then a falling rod that goes on \
                 sideways.",
                "Routh, Elementary Rigid Dynamics, 144",
            ),
            Exact::RimlessWheel => about(
                "It rolls over its edges, on and on or back and forth until it stands; elliptic functions from \
                 impact to impact.",
                "McGeer, Int. J. Robotics Research 9 (1990) 62",
            ),
            Exact::Dome => about(
                "It slides until it leaves at 2/3 of the height, then flies; or rolls until it slips; elliptic \
                 functions.",
                "Routh, Elementary Rigid Dynamics, 137",
            ),
            Exact::StickSlip => about(
                "It sticks and slips; the slips' ends are roots of a transcendental equation.",
                "Den Hartog, Trans. ASME 53 (1931) 107",
            ),
        }
    }

    /// The scenes that it is the motion of.
    pub fn scenes(self) -> &'static str {
        match self {
            Exact::FreeMotion => {
                "Gravity, and constant or cosine forces of the world at the centre of mass; no air, no pins, no \
                 contact."
            }
            Exact::SymmetricBody => {
                "The same forces; every body with two equal moments of inertia; no air, no pins, no contact."
            }
            Exact::LinearDrag => {
                "Gravity, constant forces of the world at the centre of mass, air with `linear_drag_n_s_m`."
            }
            Exact::QuadraticDrag => {
                "Gravity, constant forces of the world at the centre of mass, air with a `drag_coefficient`; \
                 velocity along the line of the forces, or no forces."
            }
            Exact::HeavyTop => "Gravity; every body one of revolution, on one pin to the world on its axis.",
            Exact::Pendulum => {
                "Gravity; every body on one pin to the world, turning about a horizontal principal axis of the pin."
            }
            Exact::Rest => "Every body at rest at the start; for piles and slopes that hold.",
            Exact::Sliding => {
                "Gravity, constant forces of the world at the centre of mass; one body flat on a container of one \
                 plane, without spin, moving along the line of slope or on a level plane; too low to tip."
            }
            Exact::Ball => {
                "Gravity, constant forces of the world at the centre of mass; one sphere and a container of one \
                 plane; where it slips, along the line of slope or on a level plane."
            }
            Exact::Turntable => {
                "A sphere that rolls on a level box or cylinder with a kinematic spin about its vertical axis; no \
                 container."
            }
            Exact::RockingBlock => {
                "One box on a container of one level plane, restitution 0, friction that holds; tilted about a lower \
                 edge, or turning about it, not enough to overturn."
            }
            Exact::FallingRod => {
                "One capsule leaning at rest, one end on a container of one level plane; no friction, restitution 0."
            }
            Exact::Ladder => {
                "One capsule leaning at rest, one end on each of a container's two planes, one level and one \
                 upright; no friction, restitution 0."
            }
            Exact::RimlessWheel => {
                "One regular prism (a box or a convex) on a container of one plane, restitution 0, friction that \
                 holds; tilted about a lower edge, or turning about one, along the line of slope."
            }
            Exact::Dome => {
                "One sphere at rest on a fixed one, off its top; restitution 0; no friction, or friction that holds \
                 until the end."
            }
            Exact::StickSlip => {
                "One body flat on a container of one plane, too low to tip; one cosine force along the line that it \
                 moves on, and constant forces that friction holds."
            }
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
                "Twin runs whose start is displaced a little. The column is always filled \
                 for methods that follow events.",
                "",
            ),
        }
    }
}
