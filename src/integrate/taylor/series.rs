//! The series of the motion: how many terms, and how far they reach.

use super::super::chain::Chain;
use super::equations::Equations;
use crate::deadline::Deadline;
use crate::model::Model;
use crate::work::Work;

/// Most expansions in one step of the clock, after which it is given up.
const MOST: u32 = 1_000_000;

pub struct Taylor {
    tolerance: f64,
    /// Number of the highest term.
    order: usize,
    equations: Equations,
    /// Start and end of the present expansion, in seconds.
    reach_s: Option<[f64; 2]>,
}

impl Taylor {
    /// Series for a tolerance. At the step that costs least terms shrink by e² from one to the next, whatever the
    /// tolerance, which asks for 1 − ½ log ε of them (Jorba & Zou, 3.1); as many more as pay for what every expansion
    /// costs once.
    pub fn new(tolerance: f64, island: &Chain, model: &Model) -> Self {
        /// Number of terms more. Measured on a free top at 1e-12: 0 more take 1.3 times as long, 8 more 1.03 times.
        const MORE: f64 = 5.0;
        let order = (1.0 - libm::log(tolerance) / 2.0 + MORE).ceil().clamp(4.0, super::tape::HIGHEST as f64) as usize;
        Taylor { tolerance, order, equations: Equations::new(island, model), reach_s: None }
    }

    /// Takes an island over one step of the clock. False where no expansion reaches far enough to get on, or time is
    /// up.
    pub fn step(
        &mut self,
        island: &mut Chain,
        model: &Model,
        [t_s, step_s]: [f64; 2],
        deadline: Deadline,
        work: &mut Work,
    ) -> bool {
        let end_s = t_s + step_s;
        for _ in 0..MOST {
            let [start_s, reached_s] = match self.reach_s {
                Some(reach) => reach,
                None => {
                    self.equations.start(island);
                    self.expand(island, model, t_s, work)
                }
            };
            if end_s <= reached_s {
                self.equations.write(self.order, end_s - start_s, island);
                return true;
            }
            if reached_s - start_s <= 16.0 * f64::EPSILON * step_s || deadline.is_over() {
                break;
            }
            if island.pins().is_some() {
                self.equations.write(self.order, reached_s - start_s, island);
                island.hold(model, reached_s, work);
                self.equations.start(island);
            } else {
                self.equations.go_on(self.order, reached_s - start_s);
            }
            self.expand(island, model, reached_s, work);
        }
        false
    }

    fn expand(&mut self, island: &mut Chain, model: &Model, t_s: f64, work: &mut Work) -> [f64; 2] {
        self.equations.expand(island, model, t_s, self.order, work);
        work.inner_steps += 1;
        *self.reach_s.insert([t_s, t_s + self.reach(self.order).min(self.reach(self.order - 1))])
    }

    /// Time after which term k has grown to a part of the tolerance: the terms left out are together about as large.
    fn reach(&self, k: usize) -> f64 {
        /// Brings the error of an expansion to that of a step of `dop853`.
        const PART: f64 = 0.1;
        libm::pow(PART * self.tolerance / self.equations.relative_size(k), 1.0 / k as f64)
    }
}
