//! Pairs of bodies that may touch: a uniform grid of the bodies' centres, and the few large ones against all.
//!
//! Bodies no larger than a cell overlap only within neighbouring cells. Cells are sorted rather than hashed: the order
//! is the same on every host, and once the buffers have grown nothing is allocated.

use nalgebra::Vector3;

/// An axis-aligned box around a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub low_m: Vector3<f64>,
    pub high_m: Vector3<f64>,
}

impl Bounds {
    pub fn around(centre: &Vector3<f64>, radius_m: f64) -> Self {
        Bounds { low_m: centre.add_scalar(-radius_m), high_m: centre.add_scalar(radius_m) }
    }

    /// Whether two boxes overlap; touching counts.
    pub fn overlaps(&self, other: &Bounds) -> bool {
        (0..3).all(|i| self.low_m[i] <= other.high_m[i] && other.low_m[i] <= self.high_m[i])
    }

    fn extent_m(&self) -> f64 {
        (self.high_m - self.low_m).max()
    }
}

/// Most cells along an axis, 20 bits; what lies beyond is in the last one.
const MOST_CELLS: f64 = 1_048_575.0;
/// Edge of a cell, of the median extent: small enough that few bodies share a cell, and bodies a little above the
/// median count as small.
const CELL: f64 = 1.5;

#[derive(Clone, Debug, Default)]
pub struct Broad {
    extents_m: Vec<f64>,
    /// Cell and body of every small body, sorted.
    small: Vec<(u64, u32)>,
    large: Vec<u32>,
}

impl Broad {
    /// Replaces `pairs` by all (i, j), i < j, whose bounds overlap, sorted.
    pub fn pairs(&mut self, bounds: &[Bounds], pairs: &mut Vec<(u32, u32)>) {
        pairs.clear();
        self.sort(bounds);
        let mut consider = |i: u32, j: u32| {
            if bounds[i as usize].overlaps(&bounds[j as usize]) {
                pairs.push((i.min(j), i.max(j)));
            }
        };
        for &large in &self.large {
            for other in 0..bounds.len() as u32 {
                let is_large = self.large.binary_search(&other).is_ok();
                if other != large && (!is_large || large < other) {
                    consider(large, other);
                }
            }
        }
        // Rows of up to three cells along z that lie after a cell: they advance with it, so that no search is needed.
        let mut starts = [0; ROWS.len()];
        for (at, &(cell, body)) in self.small.iter().enumerate() {
            for (start, &(dx, dy, from, to)) in starts.iter_mut().zip(&ROWS) {
                let first = shifted(cell, dx, dy, from);
                let last = shifted(cell, dx, dy, to);
                while self.small.get(*start).is_some_and(|(other, _)| *other < first) {
                    *start += 1;
                }
                let row = self.small[*start..].iter().enumerate().take_while(|(_, (other, _))| *other <= last);
                for (further, &(other_cell, other)) in row {
                    // Within its own cell each pair once.
                    if other_cell != cell || *start + further > at {
                        consider(body, other);
                    }
                }
            }
        }
        pairs.sort_unstable();
    }

    fn sort(&mut self, bounds: &[Bounds]) {
        self.extents_m.clear();
        self.small.clear();
        self.large.clear();
        if bounds.is_empty() {
            return;
        }
        self.extents_m.extend(bounds.iter().map(Bounds::extent_m));
        let middle = self.extents_m.len() / 2;
        let cell_m = CELL * *self.extents_m.select_nth_unstable_by(middle, f64::total_cmp).1;
        let centre = |b: &Bounds| (b.low_m + b.high_m) * 0.5;
        let origin = bounds.iter().map(centre).fold(Vector3::repeat(f64::INFINITY), |low, c| low.inf(&c));
        for (i, b) in bounds.iter().enumerate() {
            if b.extent_m() > cell_m {
                self.large.push(i as u32);
                continue;
            }
            let cell = (centre(b) - origin).map(|x| ((x / cell_m).min(MOST_CELLS) as u64) + 1);
            self.small.push((packed(cell.x, cell.y, cell.z), i as u32));
        }
        self.small.sort_unstable();
    }
}

/// Neighbours of a cell as (dx, dy, dz from, dz to): one half of the 26, and the cell itself.
const ROWS: [(i64, i64, i64, i64); 5] = [(0, 0, 0, 1), (0, 1, -1, 1), (1, -1, -1, 1), (1, 0, -1, 1), (1, 1, -1, 1)];

/// Cell numbers from 1 to 2²⁰, so that neighbours need no sign and no carry.
fn packed(x: u64, y: u64, z: u64) -> u64 {
    x << 42 | y << 21 | z
}

fn shifted(cell: u64, dx: i64, dy: i64, dz: i64) -> u64 {
    cell.wrapping_add_signed((dx << 42) + (dy << 21) + dz)
}
