//! Names in an .rrd: application, timelines, entities.

use crate::record::schema::Series;
use ::rerun::{ApplicationId, EntityPath};
use std::error::Error;

/// Beginning of an application's name. Recordings of one application share a layout, and every recording opens with its
/// own.
pub(super) const APPLICATION: &str = "gotai";

/// Name of a recording's application: one of its own for every recording. What no name may hold becomes a hyphen.
///
/// # Errors
/// Rerun's own.
pub fn application(named: &str) -> Result<ApplicationId, Box<dyn Error>> {
    let is_safe = |c: char| c.is_alphanumeric() || c == '_' || c == '-' || c == ' ';
    let safe: String = named.chars().map(|c| if is_safe(c) { c } else { '-' }).collect();
    Ok(ApplicationId::try_new(format!("{APPLICATION} {safe}"))?)
}

/// Property that holds the stretch that is played, from and to.
pub const STRETCH: &str = "stretch_s";

/// Property that holds the unit in which energies are plotted, in joules.
pub const ENERGY_UNIT: &str = "energy_unit_j";

/// Timelines: simulated time, and the number of the step.
pub const SIM_TIME: &str = "sim_time";
pub const STEP: &str = "step";

/// Entities. A body is `/world/bodies/<name>`, a plotted energy `/energy/<name>`.
pub const WORLD: &str = "/world";
pub const CONTAINER: &str = "/world/container";
pub const GROUND: &str = "/world/ground";
pub const AXES: &str = "/world/axes";
pub const BODIES: &str = "/world/bodies";
pub const TRAILS: &str = "/world/trails";
pub const CONTACTS: &str = "/world/contacts";
pub const FORCES: &str = "/world/forces";
pub const VELOCITIES: &str = "/world/velocities";
pub const ENERGY: &str = "/energy";
pub const LOG_ENERGY: &str = "/log_energy";
pub const LOG_ENERGY_TOTAL: &str = "/log_energy/total";
/// Marks of the two plots of energy: the limit of divergence, and steps that gained energy.
pub const LIMIT: &str = "/log_energy/limit";
pub const LOG_GAINS: &str = "/log_energy/gains";
pub const GAINS: &str = "/energy/gains";
pub const PENETRATION: &str = "/penetration";
pub const CONTACT_COUNT: &str = "/contact/count";
pub const CONTACT_FORCE: &str = "/contact/force";
pub const FRICTION_USE: &str = "/contact/friction_use";
pub const LOG: &str = "/log";
/// Instants that decide, in the log: a click on the time of one goes there, as no link of a page can.
pub const DECISIVE: &str = "/log/decisive";
pub const HEADLINE: &str = "/headline";
pub const CONFIG: &str = "/config";
pub const FLIGHT: &str = "/largest_gain";

/// Entity of a plotted energy. Penetration has a plot of its own: it is a length.
pub fn energy_path(series: &Series) -> EntityPath {
    if series.is_length() { PENETRATION.into() } else { format!("{ENERGY}/{}", series.name).into() }
}

/// What the viewer goes along with: a cube about a body, of which nothing is seen.
pub fn followed_path(name: &str) -> EntityPath {
    body_path(name).join(&EntityPath::from_single_string("about"))
}

/// A body's name is one part of the path, whatever characters it has.
pub fn body_path(name: &str) -> EntityPath {
    EntityPath::from(BODIES).join(&EntityPath::from_single_string(name))
}
