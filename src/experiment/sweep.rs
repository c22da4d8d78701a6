//! The keys of `sweep:` as they are written; `axes.rs` and `search.rs` read them.

use super::search::SearchText;
use super::tree::Mapping;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Sweep {
    #[serde(default)]
    pub axes: Mapping,
    /// Groups of axes that advance side by side.
    #[serde(default)]
    pub together: Vec<Vec<String>>,
    /// Search that makes one row a cell of the axes: the critical value of one more key.
    pub search: Option<SearchText>,
}
