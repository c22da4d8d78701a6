//! What is planned: a case, or a search that makes one row.

use super::cell::Cell;
use crate::case::Case;

/// One row to come.
#[derive(Clone, Debug)]
pub struct Planned {
    pub case: Case,
    /// Many runs that make the row: a bisection, whose first run is the case's.
    pub search: Option<Cell>,
}

impl From<Case> for Planned {
    fn from(case: Case) -> Self {
        Planned { case, search: None }
    }
}
