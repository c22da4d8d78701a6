//! A file of `gotai check` with its verdicts.

use super::sweeping::Swept;
use crate::check::Judged;

/// A file, its sweep and its verdicts.
pub struct Checked {
    pub swept: Swept,
    pub judged: Vec<Judged>,
}

impl Checked {
    pub fn name(&self) -> String {
        self.swept.config.display().to_string()
    }

    pub fn is_met(&self) -> bool {
        self.judged.iter().all(|judged| judged.met) && self.swept.failed() == 0
    }
}
