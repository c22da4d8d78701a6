//! The one list of columns: tables, `check`, `gotai list columns` and docs/columns.md are made from it. Those of every
//! row are the fields of `Row`, `Measured` and `Work`; here are those that only some experiments have.

use super::Row;
use crate::heading::{Aim, CellKind, Heading, Headings};

/// Columns of every row, axes left out.
pub fn of_every_row() -> Vec<Heading> {
    Row::headings()
}

/// Columns that a search adds. Those of every row are of its run at `search_low`.
pub const SEARCH: [Heading; 4] = [
    number("search_low", "Lower end of the bracket, in the unit of the key. Null where the verdict is `below`."),
    number("search_high", "Upper end of the bracket, in the unit of the key. Null where the verdict is `above`."),
    count("search_runs", "Number of runs that the search took."),
    text(
        "search_verdict",
        "`found`, or, where both ends of `between` are of one kind, the side on which the critical value is: `below` \
         or `above`.",
    ),
];

/// Columns that a clock makes: two runs of one case may differ in them, and in no other.
pub const OF_A_CLOCK: [&str; 2] = ["wall_s", "wall_search_s"];

/// Whether two runs of one case may differ in this column: one that a clock makes, or that says which file shows the
/// run.
pub fn is_beside_the_run(name: &str) -> bool {
    OF_A_CLOCK.contains(&name) || name == "recording"
}

/// Columns that are shown where nothing else is asked for, if they are not empty in all rows.
pub const TELLING: [&str; 10] = [
    "outcome",
    "criterion",
    "end_time_s",
    "energy_drift_rel",
    "energy_rise_max_rel",
    "penetration_max_m",
    "residual_max",
    "error_position_m",
    "search_low",
    "search_high",
];

/// Columns of `measure: [state]`; the fields of `BodyRow`.
pub const STATE: [Heading; 4] = [
    number("<body>.position_m", "Position of the body's centre of mass at the end, world frame.").with_parts(&XYZ),
    number("<body>.orientation_xyzw", "Attitude at the end, body to world, as a unit quaternion.")
        .with_parts(&["x", "y", "z", "w"]),
    number("<body>.velocity_m_s", "Velocity of the centre of mass at the end, world frame.").with_parts(&XYZ),
    number("<body>.angular_velocity_rad_s", "Angular velocity at the end, world frame.").with_parts(&XYZ),
];

/// Columns of `measure: [inertia]`, as the run used them.
pub const INERTIA: [Heading; 3] = [
    number("<body>.mass_kg", "Mass of the body."),
    number("<body>.center_of_mass_m", "Centre of mass in the body frame.").with_parts(&XYZ),
    number(
        "<body>.inertia_kg_m2",
        "Inertia about the centre of mass, body axes. Null for a point without `inertia_kg_m2`.",
    )
    .with_parts(&["xx", "yy", "zz", "xy", "yz", "zx"]),
];

/// Columns of `measure: [contact-matrix]`: of A = J M⁻¹ Jᵀ in the first step with the most contacts.
pub const CONTACT_MATRIX: [Heading; 3] = [
    count(
        "contact_matrix_contacts",
        "Number of contacts in the first step with the most of them. Null if nothing touched.",
    ),
    count("contact_matrix_rank", "Rank of A = J M⁻¹ Jᵀ in that step."),
    number(
        "jacobi_radius",
        "Spectral radius of E − D⁻¹A in that step, D the diagonal of A: the factor by which a sweep of Jacobi's \
         iteration makes an error grow.",
    ),
];

/// Columns of `measure: [critical-step]`: of the first contact.
pub const CRITICAL_STEP: [Heading; 2] = [
    number(
        "normal_lambda_max_1_kg",
        "Largest eigenvalue of Jn M⁻¹ Jnᵀ in the first step in which a node is inside. Null if nothing touched.",
    ),
    number(
        "critical_step_s",
        "Longest stable step of `penalty` in that state, by linear theory. Null for other methods.",
    ),
];

/// Columns of `measure: [difference-quotients]`.
pub const DIFFERENCE_QUOTIENTS: [Heading; 3] = [
    number("difference_forward_m_s", "Largest difference of the forward quotient of positions from the velocity."),
    number("difference_backward_m_s", "Largest difference of the backward quotient of positions from the velocity."),
    number(
        "difference_central_m_s",
        "Largest difference of the central quotient of positions from the velocity. Null after a single step.",
    ),
];

const XYZ: [&str; 3] = ["x", "y", "z"];

const fn number(name: &'static str, meaning: &'static str) -> Heading {
    Heading::new(name, CellKind::Number, meaning)
}

const fn count(name: &'static str, meaning: &'static str) -> Heading {
    Heading::new(name, CellKind::Count, meaning)
}

const fn text(name: &'static str, meaning: &'static str) -> Heading {
    Heading::new(name, CellKind::Text, meaning)
}

/// Names of the columns under these headings, `<body>` as it stands.
pub fn names(headings: &[Heading]) -> Vec<String> {
    headings.iter().flat_map(Heading::names).collect()
}

/// Kind of the cells of a column of every row, or of a search's. Axes, and columns that `measure:` adds, are not among
/// them: their kind is that of their values.
pub fn kind(name: &str) -> Option<CellKind> {
    known(name).map(|heading| heading.kind)
}

/// What is better in a column of every row, if the smaller number is.
pub fn aim(name: &str) -> Option<Aim> {
    known(name)?.aim
}

/// Oldest format of which it is known what every column meant.
pub const OLDEST: u32 = 2;

/// Columns whose meaning has changed, by the format since which they have the one of today.
const CHANGED: [(u32, &[&str]); 1] = [(
    3,
    &[
        "energy_drift_rel",
        "energy_growth_max",
        "energy_rise_max_rel",
        "energy_balance_rel",
        "linear_momentum_drift_rel",
        "angular_momentum_drift_rel",
        "residual_max",
    ],
)];

/// The format, of those after the older of two and up to the newer, in which the meaning of a column has changed.
pub fn changed_between(name: &str, older: u32, newer: u32) -> Option<u32> {
    let changes = CHANGED.iter().filter(|(format, _)| older < *format && *format <= newer);
    changes.filter(|(_, columns)| columns.contains(&name)).map(|(format, _)| *format).next_back()
}

/// Whether a column of every row is relative and has a sign.
pub fn is_signed(name: &str) -> bool {
    known(name).is_some_and(|heading| heading.signed)
}

fn known(name: &str) -> Option<Heading> {
    of_every_row().into_iter().chain(SEARCH).find(|heading| heading.name == name)
}
