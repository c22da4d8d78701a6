//! Tables on the terminal.

use super::output::width;
use crate::report::cut;
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

/// Letters between columns, and the fewest that a long cell is cut to.
const GAP: usize = 2;
const LEAST_CELL: usize = 16;

/// A table of rows in lines of at most so many letters: heads are broken at their dots and underscores, cells
/// are not. Of columns that have no room the last ones are left out, but for those that are kept; their indices come
/// with it. What is too long even then is cut.
pub fn fitted(head: &[&str], rows: &[Vec<String>], kept: &[bool], most: usize) -> (String, Vec<usize>) {
    let pieces: Vec<Vec<&str>> = head.iter().map(|name| name.split_inclusive(['.', '_']).collect::<Vec<_>>()).collect();
    let wide = |i: usize| {
        let cells = rows.iter().map(|row| row[i].chars().count());
        cells.chain(pieces[i].iter().map(|piece| piece.chars().count())).max().unwrap_or(0)
    };
    let mut widths: Vec<usize> = (0..head.len()).map(wide).collect();
    let (mut shown, mut left_out): (Vec<usize>, Vec<usize>) = ((0..head.len()).collect(), Vec::new());
    let all =
        |shown: &[usize], widths: &[usize]| shown.iter().map(|i| widths[*i] + GAP).sum::<usize>().saturating_sub(GAP);
    while all(&shown, &widths) > most
        && let Some(last) = shown.iter().rposition(|i| !kept[*i])
    {
        left_out.insert(0, shown.remove(last));
    }
    // Then the longest cells are cut.
    while all(&shown, &widths) > most {
        let widest = shown.iter().copied().max_by_key(|i| widths[*i]).filter(|i| widths[*i] > LEAST_CELL);
        let Some(widest) = widest else { break };
        let over = all(&shown, &widths) - most;
        widths[widest] = widths[widest].saturating_sub(over).max(LEAST_CELL);
    }
    // Pieces of a head that have room stand in one line.
    let lines = |i: usize| {
        let mut lines: Vec<String> = Vec::new();
        for piece in &pieces[i] {
            match lines.last_mut() {
                Some(line) if line.chars().count() + piece.chars().count() <= widths[i] => *line += piece,
                _ => lines.push(piece.to_string()),
            }
        }
        lines
    };
    let heads: Vec<Vec<String>> = shown.iter().map(|i| lines(*i)).collect();
    let high = heads.iter().map(Vec::len).max().unwrap_or(0);
    let written = |cell: &dyn Fn(usize) -> String| {
        let cells = shown.iter().enumerate().map(|(at, i)| format!("{:<1$}", cut(&cell(at), widths[*i]), widths[*i]));
        cells.collect::<Vec<_>>().join(&" ".repeat(GAP)).trim_end().to_string()
    };
    let heads = (0..high).map(|line| written(&|at| heads[at].get(line).cloned().unwrap_or_default()));
    let rows = rows.iter().map(|row| written(&|at| row[shown[at]].clone()));
    (heads.chain(rows).collect::<Vec<_>>().join("\n"), left_out)
}
