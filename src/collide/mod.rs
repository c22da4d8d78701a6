//! Contact test (L18, step 1 of L21): points of a body against the faces of its container (`faces.rs`) and against the
//! other bodies (`shape/pair.rs`, found by `broad.rs`).
//!
//! A point is a contact when its gap, n·(u_c − u_p) for a face, is below a margin and what the gap may close by in the
//! step: the law of contact then keeps it from closing further than to zero. Which of two bodies' axes that is, where
//! there are several, is for `doubt.rs`. Contacts come in a stable order: body, other body, feature.

mod ahead;
pub mod approach;
pub mod broad;
pub mod closed;
mod contact;
pub mod detector;
pub mod doubt;
pub mod faces;
pub mod islands;
pub mod lasting;
mod limits;
pub mod reduce;
mod two;
pub mod way;

pub use ahead::Ahead;
pub use contact::{Contact, Key, Partner, SolvedContact, pinned_to};
pub use detector::{Detector, deepest};
pub use limits::Reach;
