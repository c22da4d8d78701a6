//! Motion from event to event: between events it is smooth and known, in closed form or by a continuous method of high
//! order; events are roots in time. `step/event_driven.rs` is the loop; here is what it is made of.
//!
//! - `touch`: a point of contact in any state, and its rates; `shown`: which parts of two bodies meet there
//! - `forces`: the forces that keep what is in contact together; `pushing`: those of which none pulls; `last_forces`:
//!   those of the last look
//! - `decide`: which contacts hold, stick, slide; `law`: the law of contact of all at once; `proportion`: the forces of
//!   a pile that slides as one; `shares`: those by which all go on
//! - `settle`, `motion`: closed forms between events, and bounds; `dense`: all other motion, `field`: its equations;
//!   `slip`: where that is stiff; `stiff`: its steps there
//! - `caps`: of cylinders, that lie flat, fall flat and tip, `pressing`: over which point; `descent`, `rolling`: how a
//!   rim comes nearer
//! - `change`: when a contact that holds stops doing so
//! - `watch`: when the next gap closes, and the proof that none was missed, of two bodies in `pairs`, from `look` to
//!   look
//! - `which`: what bodies that share an edge alone do to each other; `flush`: blocks side by side
//! - `patience`: when steps of equal length take the place of events
//! - `impact`: the laws of impact at one moment; `zeno`: which of them is the last that matters
//!
//! Errors. A gap beyond δ = 1e-13 of the body (and rounding of its coordinates) is never stepped over. Impacts that
//! would never end (Zeno) end when the height of the bounces left, times 1/(1 − e)², is below a millionth of the
//! tolerance, or what is left stays within δ: the contact then holds. A body between two others that come nearer loses
//! its restitution on both sides then, however fast these are. What is left of a rocking is ended with the
//! friction that comes with it; that its contacts have to pull for this is seen in the residual of that blow.

pub mod caps;
pub mod change;
pub mod decide;
pub mod dense;
pub mod descent;
pub mod ending;
pub mod field;
pub mod flush;
pub mod forces;
pub mod impact;
pub mod last_forces;
pub mod law;
pub mod look;
pub mod motion;
mod pairs;
pub mod patience;
pub mod pressing;
mod proportion;
mod pushing;
pub mod radau_tableau;
mod rolling;
pub mod settle;
mod shares;
pub mod shown;
pub mod slip;
pub mod stiff;
pub mod touch;
pub mod watch;
pub mod which;
pub mod zeno;
