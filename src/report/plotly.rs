//! A figure for a page: traces and layout of plotly.js, with the numbers of the figure. Colours of paper and letters
//! are the page's own, which puts them in.

use super::figure::{Drawn, Figure, FigureAxis, FigureScale, Mark};
use super::number::wrapped;
use super::palette::{COLOURS, MARKER_NAMES, hex, is_dark};
use serde_json::{Value, json};

/// Letters for plotly, which takes some markup, and what stands between two $ for a formula: none of it is.
fn letters(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('$', "&#36;")
}

/// Letters of a legend, in lines that a phone has room for.
fn lines(text: &str) -> String {
    const MOST: usize = 36;
    wrapped(text, MOST).iter().map(|line| letters(line)).collect::<Vec<_>>().join("<br>")
}

impl Figure {
    /// Traces and layout, as plotly.js takes them. `customdata` of a point is its row, of a cell `pick` and its row.
    pub fn plotly(&self) -> Value {
        let mut data = Vec::new();
        if let Some(field) = &self.field {
            data.push(self.heat(field));
        }
        let marks = self.marks.iter().zip(self.asides()).filter(|(mark, _)| !mark.dots.is_empty());
        data.extend(marks.map(|(mark, aside)| self.trace(mark, aside)));
        let [x, y] = self.extent();
        let mut layout = json!({ "xaxis": axis(&self.x, x), "yaxis": axis(&self.y, y), "annotations": [] });
        let triangles = self.marks.iter().filter(|mark| mark.drawn == Drawn::Triangle);
        let annotation = |mark: &Mark| {
            let (low, high) = (mark.dots.get(1)?, mark.dots.get(2)?);
            let middle = 0.5 * (self.y.place(low.y) + self.y.place(high.y));
            Some(json!({
                "x": self.x.place(high.x), "y": middle, "text": mark.label.trim_start_matches("order "),
                "showarrow": false, "xanchor": "left", "xshift": 4,
            }))
        };
        layout["annotations"] = triangles.filter_map(annotation).collect();
        if let Some(field) = &self.field {
            layout["annotations"] = self.texts(field);
        }
        json!({ "name": self.name, "data": data, "layout": layout })
    }

    fn heat(&self, field: &super::figure::Shading) -> Value {
        let (columns, rows) = (self.x.names().map_or(0, <[String]>::len), self.y.names().map_or(0, <[String]>::len));
        let grid = |of: &dyn Fn(&super::figure::GridCell) -> Value| -> Value {
            let mut grid = vec![vec![Value::Null; columns]; rows];
            for cell in &field.cells {
                grid[cell.y][cell.x] = of(cell);
            }
            json!(grid)
        };
        let scale = field.scale();
        let colours: Vec<Value> = field
            .shades()
            .iter()
            .enumerate()
            .map(|(i, shade)| json!([i as f64 / (field.shades().len() - 1) as f64, hex(*shade)]))
            .collect();
        // Shown by their place among the shades, so that a logarithm needs no other axis.
        let part = |cell: &super::figure::GridCell| json!(cell.value.map(|value| field.part(scale, value)));
        json!({
            "type": "heatmap", "z": grid(&part), "zmin": 0, "zmax": 1, "colorscale": colours, "xgap": 2, "ygap": 2,
            "text": grid(&|cell| json!(letters(&cell.said))), "hoverinfo": "text", "hoverongaps": true,
            "colorbar": {
                "thickness": 12, "outlinewidth": 0, "title": { "text": letters(&field.titled()), "side": "right" },
                "tickvals": field.ticks(scale).iter().map(|(part, _)| *part).collect::<Vec<_>>(),
                "ticktext": field.ticks(scale).iter().map(|(_, text)| letters(text)).collect::<Vec<_>>(),
            },
            "customdata": grid(&|cell| json!({ "value": cell.value, "row": cell.row, "pick": cell.pick })),
        })
    }

    /// What stands in the cells, unless there are too many of them.
    fn texts(&self, field: &super::figure::Shading) -> Value {
        const MOST: usize = 200;
        if field.cells.len() > MOST {
            return json!([]);
        }
        let scale = field.scale();
        let text = |cell: &super::figure::GridCell| {
            let colour =
                cell.value.map(|value| if is_dark(field.colour(scale, value)) { "#ffffff" } else { "#1e1e1e" });
            let doubt = if cell.is_doubtful { " !" } else { "" };
            let mut text = json!({
                "x": cell.x, "y": cell.y, "text": letters(&format!("{}{doubt}", cell.text)), "showarrow": false,
                "captureevents": false,
            });
            if let Some(colour) = colour {
                text["font"] = json!({ "color": colour });
            }
            text
        };
        field.cells.iter().map(text).collect()
    }

    fn trace(&self, mark: &Mark, aside: f64) -> Value {
        let colour = hex(COLOURS[mark.colour % COLOURS.len()]);
        let of = |of: &dyn Fn(&super::figure::Dot) -> Value| -> Vec<Value> { mark.dots.iter().map(of).collect() };
        let (x, y) = (of(&|dot| json!(self.shifted(dot.x, aside))), of(&|dot| json!(dot.y)));
        let mut trace = json!({
            "type": "scatter", "name": lines(&mark.label), "x": x, "y": y,
            "text": of(&|dot| json!(letters(&dot.said))), "hoverinfo": "text",
            "customdata": of(&|dot| json!({ "row": dot.row })),
        });
        let (mode, line) = match mark.drawn {
            Drawn::Line => ("lines+markers", json!({ "color": colour, "width": 2 })),
            Drawn::Points => ("markers", json!({ "color": colour })),
            Drawn::Dashed => ("lines", json!({ "color": colour, "width": 1.5, "dash": "dash" })),
            Drawn::Front => ("lines", json!({ "color": "rgba(128,128,128,0.25)", "width": 12 })),
            Drawn::Triangle => ("lines", json!({ "color": "#888888", "width": 1.4 })),
            Drawn::Boundary => ("lines", json!({ "color": colour, "width": 3 })),
            Drawn::Band => ("lines", json!({ "width": 0 })),
        };
        trace["mode"] = json!(mode);
        trace["line"] = line;
        trace["marker"] = json!({
            "color": colour, "symbol": MARKER_NAMES[mark.colour % MARKER_NAMES.len()], "size": 8,
        });
        match mark.drawn {
            Drawn::Band => {
                let outlines = self.outlines(mark);
                // A null ends an outline.
                let all = |of: fn(&(f64, f64)) -> f64| -> Vec<Value> {
                    let outlines: Vec<Vec<Value>> =
                        outlines.iter().map(|outline| outline.iter().map(|point| json!(of(point))).collect()).collect();
                    outlines.join(&Value::Null)
                };
                (trace["x"], trace["y"]) = (json!(all(|point| point.0)), json!(all(|point| point.1)));
                trace["fill"] = json!("toself");
                trace["fillcolor"] = json!(format!("{colour}2a"));
                trace["hoverinfo"] = json!("skip");
                trace["showlegend"] = json!(false);
            }
            Drawn::Line | Drawn::Points if mark.dots.iter().any(|dot| dot.high.is_some()) => {
                let high = of(&|dot| json!(dot.high.map(|high| high - dot.y)));
                let low = of(&|dot| json!(dot.low.map(|low| dot.y - low)));
                trace["error_y"] = json!({
                    "type": "data", "symmetric": false, "array": high, "arrayminus": low, "thickness": 1.2, "width": 3,
                });
            }
            Drawn::Boundary => {
                let pieces = Figure::pieces(mark);
                // A null ends a piece.
                let all = |of: fn(&(f64, f64)) -> f64| -> Vec<Value> {
                    pieces.iter().flat_map(|piece| [json!(of(&piece[0])), json!(of(&piece[1])), Value::Null]).collect()
                };
                trace["meta"] = json!({ "x": trace["x"], "y": trace["y"] });
                (trace["x"], trace["y"]) = (json!(all(|point| point.0)), json!(all(|point| point.1)));
                trace["hoverinfo"] = json!("skip");
                trace["customdata"] = Value::Null;
            }
            Drawn::Front | Drawn::Triangle => trace["hoverinfo"] = json!("skip"),
            _ => {}
        }
        if matches!(mark.drawn, Drawn::Triangle | Drawn::Dashed) {
            trace["showlegend"] = json!(false);
        }
        trace
    }
}

fn axis(axis: &FigureAxis, (low, high): (f64, f64)) -> Value {
    let mut out = json!({
        "title": { "text": letters(&axis.titled()) }, "range": [axis.place(low), axis.place(high)], "automargin": true,
    });
    let ticks = axis.ticks(low, high);
    out["tickvals"] = json!(ticks.iter().map(|(value, _)| *value).collect::<Vec<_>>());
    out["ticktext"] = json!(ticks.iter().map(|(_, text)| letters(text)).collect::<Vec<_>>());
    match &axis.scale {
        FigureScale::Linear => {}
        FigureScale::Logarithmic => out["type"] = json!("log"),
        FigureScale::Named(_) => {
            out["showgrid"] = json!(false);
            out["zeroline"] = json!(false);
        }
    }
    out
}
