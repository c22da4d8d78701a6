//! An `Experiment` (YAML) expands into `Case`s; each Case builds a constant `Model` and a first `State`; `run` advances
//! the State with a `Stepper`, shows every step to the judges and the recorders, ends in an `Outcome` and writes one
//! `Row`; `report` and `check` read only files.
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

// In reading order: rustfmt sorts within a paragraph only.
pub mod experiment;

pub mod sweep;

pub mod case;

pub mod model;

pub mod state;

pub mod plan;

pub mod run;

pub mod due;

pub mod sensitivity;

pub mod auto;

pub mod reference;

pub mod step;

pub mod linear;

pub mod integrate;

pub mod collide;

pub mod solve;

pub mod event;

pub mod measure;

pub mod exact;

pub mod row;

pub mod record;

pub mod check;

pub mod bench;

pub mod report;

pub mod cli;

pub mod build_info;

mod panics;
