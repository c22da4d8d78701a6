//! Figures and pages from rows. Knows the columns of result files, verdicts on them and how to draw, never the
//! simulator.
//!
//! A [`Subject`](subject::Subject) is rows as columns ([`RowFrame`](frame::RowFrame)), their axes, and what is known of
//! them. By rules (`choose.rs`), each a file, it has figures: the map (`map.rs`), the share along an axis (`share.rs`),
//! critical values (`critical.rs`), run time against error (`pareto.rs`), error against step (`convergence.rs`), energy
//! over seeds (`ensemble.rs`), work (`work.rs`).
//!
//! A [`Figure`](figure::Figure) is one value: what it says, with numbers, its axes, marks and cells, and what is left
//! out of it. It is drawn four ways, which tests hold to one another: in characters (`text.rs`), for a page
//! (`plotly.rs`), as SVG (`svg.rs`) and as PNG (`png.rs`); the last two draw the strokes of one layout (`sheet.rs`).
//! `page.rs` is all of it in one file that needs no other (L25: a result carries its conditions).

pub mod choose;
mod convergence;
mod critical;
mod ensemble;
pub mod figure;
pub mod frame;
pub mod labels;
mod map;
mod number;
pub mod page;
pub mod palette;
pub mod pareto;
mod plotly;
pub mod png;
mod pooling;
pub mod power_law;
mod rows_of_page;
pub mod said;
mod share;
pub mod sheet;
pub mod stats;
pub mod subject;
pub mod svg;
mod text;
pub mod tried;
mod verdicts_of_page;
mod work;

pub use number::{cut, is_shown, plain};
