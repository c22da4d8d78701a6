//! `copies:` — one described body as a row or a grid of bodies: `stack[0]`, `stack[1]`, …; `pile[0,0,0]`,
//! `pile[0,0,1]`, ….

use super::checks::{Result, unexpected};
use super::key_path::Path;
use super::types::{Body, Copies, Experiment};

/// Most bodies that copies make. More is a slip, and would end in a lack of memory.
const MOST: u64 = 100_000;

impl Copies {
    /// What stands behind the name of every copy, and its displacement from the first one.
    fn each(&self) -> Vec<(String, [f64; 3])> {
        let step_m = self.step_m;
        if let Some(count) = self.count {
            return (0..count).map(|i| (i.to_string(), step_m.map(|x| x * f64::from(i)))).collect();
        }
        let [nx, ny, nz] = self.grid.unwrap_or_default();
        let cells = (0..nx).flat_map(|i| (0..ny).flat_map(move |j| (0..nz).map(move |k| [i, j, k])));
        cells
            .map(|[i, j, k]| {
                let at = [0, 1, 2].map(|axis| step_m[axis] * f64::from([i, j, k][axis]));
                (format!("{i},{j},{k}"), at)
            })
            .collect()
    }
}

impl Body {
    /// Whether this is a body's name in the scene; of a body with copies, one of theirs.
    pub fn is_called(&self, name: &str) -> bool {
        match &self.copies {
            None => self.name == name,
            Some(copies) => name
                .strip_prefix(self.name.as_str())
                .and_then(|rest| rest.strip_prefix('[')?.strip_suffix(']'))
                .is_some_and(|number| copies.each().iter().any(|(known, _)| known == number)),
        }
    }

    /// Name of the body in the scene, or of the first of its copies.
    pub fn called(&self) -> String {
        let first = self.copies.and_then(|copies| copies.each().into_iter().next());
        first.map_or_else(|| self.name.clone(), |(number, _)| format!("{}[{number}]", self.name))
    }
}

/// Name that a body of the scene has in the file.
pub fn described_as(name: &str) -> &str {
    name.split_once('[').map_or(name, |(described, _)| described)
}

/// Name of a copy without its number, if that is written as `each` writes it.
pub fn without_number(name: &str) -> Option<&str> {
    let (described, number) = name.strip_suffix(']')?.split_once('[')?;
    let is_index = |text: &str| text.parse::<u32>().is_ok_and(|n| n.to_string() == text);
    let indices: Vec<&str> = number.split(',').collect();
    ([1, 3].contains(&indices.len()) && indices.into_iter().all(is_index)).then_some(described)
}

/// Checks that copies have a `count` or a `grid`, and how many bodies they make.
///
/// # Errors
/// Neither of the two or both, no body, or too many.
pub fn validate_copies(copies: &Copies, at: Path) -> Result<()> {
    let number = match (copies.count, copies.grid) {
        (Some(count), None) => u64::from(count),
        (None, Some(grid)) => grid.iter().map(|n| u64::from(*n)).fold(1, u64::saturating_mul),
        (None, None) => return Err(unexpected(at, "a `count` or a `grid`", "neither")),
        (Some(_), Some(_)) => return Err(unexpected(at.key("grid"), "either `count` or `grid`", "both")),
    };
    let key = at.key(if copies.count.is_some() { "count" } else { "grid" });
    if number == 0 || number > MOST {
        return Err(unexpected(key, &format!("1 to {MOST} bodies"), &number.to_string()));
    }
    Ok(())
}

/// Every body with copies becomes them, in their order.
pub fn expand(experiment: &mut Experiment) {
    let described = std::mem::take(&mut experiment.scene.bodies);
    experiment.scene.bodies = described.into_iter().flat_map(each).collect();
}

fn each(body: Body) -> Vec<Body> {
    let Some(copies) = body.copies else { return vec![body] };
    let copy = |(number, from_first): (String, [f64; 3])| Body {
        name: format!("{}[{number}]", body.name),
        position_m: [0, 1, 2].map(|axis| body.position_m[axis] + from_first[axis]),
        copies: None,
        ..body.clone()
    };
    copies.each().into_iter().map(copy).collect()
}
