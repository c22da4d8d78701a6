//! Laws of impact: from the velocities just before an impact to its impulses, on the plain data of a `ContactProblem`.
//!
//! `ContactProblem::b` holds the contacts' velocities just before the impact: no forces, no restitution in it. Newton's
//! law is the one that is not here: it is e v⁻ in b, and with friction it can gain kinetic energy. These laws never do,
//! for any J, M, μ and 0 ≤ e ≤ 1:
//!
//! - `darboux_keller`: one contact; its sliding is followed along the normal impulse
//! - `sequential`: that law, one contact at a time, and of the contacts of one face or line all at once
//! - `poisson`: all contacts at once, compression and expansion
//!
//! Impulses in N s, velocities in m/s, rows normal, tangent 1, tangent 2. The laws allocate.

pub mod darboux_keller;
mod disc;
mod hodograph;
mod law;
mod path;
mod plastic;
mod poisson;
mod sequential;

pub use law::{Law, resolve};
pub use plastic::Plastic;
