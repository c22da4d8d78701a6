//! Tables on the terminal.

use super::output::width;
use comfy_table::{ContentArrangement, Table, presets};

/// An empty table with this header, as wide as the terminal.
pub fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::UTF8_HORIZONTAL_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    // What has colour is decided in one place, and not by the table.
    table.force_no_tty().set_width(width());
    table.set_header(header);
    table
}
