//! Bounds on one side of a column with a sign: `max: 1e-3` on an energy drift lets any loss pass.

use crate::experiment::expect::{Expectation, What};
use crate::experiment::key_path::{KeyPath, Path};
use crate::experiment::predicate::{Bounds, Column, Predicate};
use crate::rows::columns;

/// Bound that holds a signed column on one side alone.
#[derive(Clone, Debug, PartialEq)]
pub struct OneSided {
    /// Name of the column.
    pub column: String,
    /// Key of the bound.
    pub key: &'static str,
    /// Place of the bound in the experiment.
    pub at: KeyPath,
}

/// Bounds of the list `expect:` that hold a signed column on one side alone. A bound that 0 does not meet says that
/// something is gained or lost, and is meant so; two cells are compared on one side by right.
pub fn one_sided(expectations: &[Expectation]) -> Vec<OneSided> {
    let base = KeyPath::of_keys(&["expect"]);
    let base = Path::Base(&base);
    let found = expectations.iter().enumerate().filter_map(|(i, expectation)| {
        let at = base.item(i, None);
        match &expectation.what {
            What::Column { column, bounds, .. } => of_column(column, bounds, at),
            What::Fraction { of: Predicate::Column { column, bounds }, .. } => {
                of_column(column, bounds, at.key("fraction"))
            }
            What::Fraction { .. }
            | What::Trend { .. }
            | What::Order { .. }
            | What::Equal { .. }
            | What::Compare { .. } => None,
        }
    });
    found.collect()
}

fn of_column(column: &Column, bounds: &Bounds, at: Path) -> Option<OneSided> {
    let name = column.names().find(|name| columns::is_signed(name))?;
    if !bounds.is_one_sided() || !bounds.contain(0.0) {
        return None;
    }
    let (key, _) = bounds.given().next()?;
    Some(OneSided { column: name.to_string(), key, at: at.key(key).to_key_path() })
}
