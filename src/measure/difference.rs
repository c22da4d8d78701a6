//! The three difference quotients (L1), forward, backward and central, of the position of every body's centre of mass
//! against its velocity: the largest differences over a run.

use crate::state::State;
use serde_json::{Value, json};

#[derive(Clone, Debug, Default)]
pub struct Differences {
    largest: [f64; 3],
    /// The state before the last step's; none before the second step.
    earlier: Option<State>,
}

impl Differences {
    /// Takes note of a step of length `h`.
    pub fn observe(&mut self, before: &State, after: &State, h: f64) {
        for (i, (a, b)) in before.bodies.iter().zip(&after.bodies).enumerate() {
            let quotient = (b.p_WB - a.p_WB) / h;
            self.note(0, (quotient - a.v_WB).norm());
            self.note(1, (quotient - b.v_WB).norm());
            if let Some(earlier) = &self.earlier {
                let central = (b.p_WB - earlier.bodies[i].p_WB) / (2.0 * h);
                self.note(2, (central - a.v_WB).norm());
            }
        }
        match &mut self.earlier {
            Some(earlier) => earlier.copy_from(before),
            None => self.earlier = Some(before.clone()),
        }
    }

    fn note(&mut self, quotient: usize, difference: f64) {
        self.largest[quotient] = self.largest[quotient].max(difference);
    }

    /// The central one is null after a single step.
    pub fn columns(&self) -> Vec<Value> {
        let central = self.earlier.is_some().then_some(self.largest[2]);
        vec![json!(self.largest[0]), json!(self.largest[1]), json!(central)]
    }
}
