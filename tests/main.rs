//! One binary of tests, one folder or file a subject. A new test goes to the subject it is about:
//!
//! - `experiment/`: what a file, a `--set` and an axis mean, and what is said when they mean nothing
//! - `model/`: meshes, mass properties, containers, start states
//! - `collide/`: contact points of solids with planes and with each other, candidate pairs
//! - `methods/`: each method against its own recurrence, the exact motion, its conserved quantities
//! - `event/`: motion from event to event, against closed forms, itself and what mechanics keeps
//! - `exact/`: closed forms against 40-digit references
//! - `measure/`: the judges: columns against another way to their numbers, faults made by hand
//! - `map_a`: the lecture's stability notes against the measured table
//! - `sweep/`: resume, threads, panics, tables, recordings of a sweep
//! - `record/`: recordings, read back from their files
//! - `cli/`: the program as a user meets it: output, exit codes
//! - `check/`: expectations, their statistics, searches, `gotai check`
//! - `bench/`: run time against error: rows, orders, bad inputs
//! - `report/`: figures, drawn four ways that say the same; pages, in a browser too; maps on the terminal
//! - `configs`: every file under configs/ runs
//! - `allocation`: no step allocates
//! - `counters`: how much work a run is
//! - `docs`: pages that are made, links, paths and commands of the others
//! - `guides`: what docs/ci.md and docs/results.md tell people to do is done as it stands there
//! - `tidy`: rules of the repository
//! - `dependencies`: the program and its tests are made of the same crates
//! - `assets`: what is vendored is what its README says
//! - `tools`: tests that need more than cargo: how they find it, skip without it, fail where it is required

#![allow(non_snake_case)]

mod allocation;
mod assets;
mod bench;
mod check;
mod cli;
mod collide;
mod configs;
mod counters;
mod dependencies;
mod docs;
mod event;
mod exact;
mod experiment;
mod guides;
mod map_a;
mod measure;
mod methods;
mod model;
mod record;
mod report;
mod scratch;
mod sweep;
mod tidy;
mod tools;
mod yaml;
