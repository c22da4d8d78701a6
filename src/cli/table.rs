//! Tables on the terminal.

use comfy_table::{ContentArrangement, Table, presets};
use std::io::IsTerminal;

/// Width of a table in a file or a CI's log, in letters.
const WIDTH: u16 = 140;

/// An empty table with this header, as wide as the terminal.
pub fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::UTF8_HORIZONTAL_ONLY).set_content_arrangement(ContentArrangement::Dynamic);
    if !std::io::stdout().is_terminal() {
        table.set_width(WIDTH);
    }
    table.set_header(header);
    table
}
