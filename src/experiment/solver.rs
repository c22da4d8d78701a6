//! The contact solvers of `time-stepping`, a part of `method.rs`: their words, and one row of facts for each.

use serde::{Deserialize, Serialize};
use strum::{IntoStaticStr, VariantArray};

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Solver {
    /// The exact one where it is affordable, else the best iteration: for each island, in each step, by counts.
    Auto,
    /// Projected Gauss–Seidel, disc per contact.
    Pgs,
    /// Nonlinear conjugate gradients: the sweeps of `pgs` as gradients.
    Nncg,
    /// The law of contact to rounding, the smallest of all impulses that obey it.
    Newton,
}

/// Products of 6×6 blocks that the factors of an island's linear system may take for `auto` to solve it exactly, and
/// bodies that it may have: a stack of 1000 cubes takes 10³, a pile of 1000 about 10⁵. Beyond, the exact solution
/// takes seconds a step.
pub const AFFORDABLE_PRODUCTS: usize = 200_000;
pub const AFFORDABLE_BODIES: usize = 5_000;
/// Proximal problems that the exact solver may try, times bodies, and at least: of many bodies that are wedged so that
/// so many do not solve it, more seldom do, and `newton` takes seconds a step for them.
pub const AFFORDABLE_PROBLEMS: u32 = 400;
pub const FEWEST_PROBLEMS: u32 = 20;

/// The rule of `auto`, for people.
pub fn rule_of_auto() -> String {
    format!(
        "auto: impulses of the last step that meet the tolerance still are taken as they are; else an island whose \
         linear system has at most {AFFORDABLE_BODIES} bodies and takes at most {AFFORDABLE_PRODUCTS} products of \
         6×6 blocks is solved exactly (newton), any other, and what {AFFORDABLE_PROBLEMS} proximal problems over \
         its bodies (at least {FEWEST_PROBLEMS}) do not solve, by nncg"
    )
}

/// Facts of a solver, whatever the contacts.
#[derive(Clone, Copy, Debug)]
pub struct SolverFacts {
    /// Most sweeps of a step, where `sweeps` is not given; none: the solver counts for itself.
    pub sweeps: Option<u32>,
    /// Tolerance, where `tolerance` is not given.
    pub tolerance: f64,
    /// Whether the solver goes from contact to contact: `local`, `relaxation` and `order` say how.
    pub by_contact: bool,
    /// Whether a step may ask for memory.
    pub allocates: bool,
    /// Noun for lists.
    pub about: &'static str,
}

impl Solver {
    pub const ALL: &'static [Solver] = Solver::VARIANTS;

    /// Word of the solver in the file.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// Row of the table. What is left of a sweep's change at 1e-12 is below the rounding of a step. `newton` mostly
    /// needs no proximal problem, and in a pile of 125 cubes more than 200 in one step of 150; a residual of 1e-10 is
    /// met even where 400 contacts share a force or masses are 1 : 10⁶, and it mostly ends at 1e-15.
    pub fn facts(self) -> SolverFacts {
        let (sweeps, tolerance, by_contact, allocates, about) = match self {
            Solver::Auto => (None, 1e-10, false, true, "the exact solver where it is affordable"),
            Solver::Pgs => (Some(50), 1e-12, true, false, "projected Gauss–Seidel"),
            Solver::Nncg => (Some(50), 1e-12, true, false, "its conjugate gradients"),
            Solver::Newton => (Some(500), 1e-10, false, true, "the exact law of contact"),
        };
        SolverFacts { sweeps, tolerance, by_contact, allocates, about }
    }

    /// A default of the solvers', for people: that of the first, and of those that differ.
    pub(super) fn default_of(shown: impl Fn(SolverFacts) -> String) -> String {
        let first = shown(Solver::ALL[0].facts());
        let differs = |solver: &&Solver| shown(solver.facts()) != first;
        let others = Solver::ALL.iter().filter(differs);
        let others: Vec<_> = others.map(|solver| format!("{}: {}", solver.word(), shown(solver.facts()))).collect();
        if others.is_empty() { first } else { format!("{first} ({})", others.join(", ")) }
    }
}
