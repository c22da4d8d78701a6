//! A point of contact as a function of where its bodies are, and how it moves with them: the geometry that
//! accelerations need.
//!
//! `Contact` is what the contact test finds in one state; a `Touch` is the same point in every other state: which parts
//! of the two bodies meet. Its rates are analytic. With V̇ = 0 the relative velocity u of the geometric point of
//! contact changes by β = ω_A × ṙ_A − ω_B × ṙ_B, and its normal part by n·β + ṅ·u: for a rolling sphere ṙ = 0, for a
//! corner ṙ = ω × r (F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts, 1996, ch. 4).

mod ball_on_line;
mod balls;
mod crossing;
mod curved;
mod lines;
mod moving;
mod parts;
mod past_end;
mod plane;
mod rates;
mod recognise;
mod rim_on_edge;
mod standing;
mod two_rims;

pub use moving::{Here, Touch};
pub use past_end::{beyond_edge_W, is_nothing};
pub use standing::Standing;
