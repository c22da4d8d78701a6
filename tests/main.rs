//! Every test of the project, in one binary: it links the dependencies once.
//!
//! - `record`: recordings, read back from their files

mod record;
