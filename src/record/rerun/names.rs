//! Names in an .rrd: application, timelines, entities.

use crate::record::schema::Series;
use ::rerun::EntityPath;

/// Id of the application: recordings of one application share a layout and are listed together.
pub const APPLICATION: &str = "gotai";

/// Timelines: simulated time, and the number of the step.
pub const SIM_TIME: &str = "sim_time";
pub const STEP: &str = "step";

/// Entities. A body is `/world/bodies/<name>`, a plotted energy `/energy/<name>`.
pub const WORLD: &str = "/world";
pub const CONTAINER: &str = "/world/container";
pub const BODIES: &str = "/world/bodies";
pub const CONTACTS: &str = "/world/contacts";
pub const FORCES: &str = "/world/forces";
pub const ENERGY: &str = "/energy";
pub const PENETRATION: &str = "/penetration";
pub const CONTACT_COUNT: &str = "/contact/count";
pub const CONTACT_FORCE: &str = "/contact/force";
pub const LOG: &str = "/log";
pub const CONFIG: &str = "/config";

/// Entity of a plotted energy. Penetration has a plot of its own: it is a length.
pub fn energy_path(series: &Series) -> EntityPath {
    match series.name {
        "penetration" => PENETRATION.into(),
        name => format!("{ENERGY}/{name}").into(),
    }
}
