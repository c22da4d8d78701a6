//! One binary of tests, one folder a subject. A new test goes to the folder of the subject it is about:
//!
//! - `experiment/`: what a file, a `--set` and an axis mean, and what is said when they mean nothing
//! - `record/`: recordings, read back from their files

mod experiment;
mod record;
