//! An `Experiment` expands into `Case`s; a scene is built: a constant `Model` and a first `State`; `run` advances the
//! State with a `Stepper` and shows every step to the judges and the recorders; a study says which method runs, against
//! what, and how far to trust it; sweeps gather `Row`s; `check` and `report` know rows alone.
//!
//! Words have their unit last in files and public fields, SI and f64 inside. In kernels a name is quantity, target,
//! frame; W is the world, B the body's axes at its centre of mass, Bo the origin of the body frame:
//!
//! | lecture | here | |
//! |---|---|---|
//! | u_G | `p_WB` | position of the centre of mass |
//! | R | `R_WB`, `q_WB` | attitude, body → world |
//! | v, ω | `v_WB`, `w_WB` | velocities, world frame (`w_B`: body axes) |
//! | ᴼI, I | `I_B`, `I_W` | inertia about the centre of mass, body and world axes |
//! | ᴳu_c | `r_BC_W` | from the centre of mass to a contact, world axes |
//! | ᶜF_c Δt | `Impulse` | normal, tangent 1, tangent 2 |
//! | J, A, b | `ContactProblem` | |

// The kernels read like the papers: R_WB, I_B, A.
#![allow(non_snake_case)]

// From the ground up: a room imports only from the paragraphs above its own (`tests/tidy/`; on the ground floor `clock`
// knows `state`, and `work` its `heading`). rustfmt sorts within a paragraph only.
pub mod build_info;
pub mod clock;
pub mod deadline;
pub mod digest;
pub mod files;
pub mod heading;
pub mod math;
pub mod outcome;
mod panics;
pub mod state;
pub mod work;

pub mod rows;
pub mod shape;

pub mod experiment;
pub mod report;

pub mod case;
pub mod check;
pub mod model;

pub mod collide;
pub mod integrate;

pub mod exact;
pub mod plan;
pub mod scene;
pub mod shown;
pub mod skips;
pub mod solve;

pub mod event;
pub mod measure;

pub mod record;
pub mod step;

pub mod run;

pub mod study;

pub mod sweep;

pub mod bench;

pub mod cli;
