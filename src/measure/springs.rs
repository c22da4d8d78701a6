//! What springs in place of a law of contact hold: ½ k δ² of every node that is inside.

use crate::collide::{Contact, Detector, Reach};
use crate::model::Model;
use crate::state::State;
use crate::work::Work;

/// Springs of one stiffness; the memory of the look at who is inside.
#[derive(Debug)]
pub(super) struct Springs {
    pub stiffness_n_m: f64,
    detector: Detector,
    inside: Vec<Contact>,
}

impl Springs {
    pub fn new(stiffness_n_m: f64, contacts: usize) -> Self {
        Springs { stiffness_n_m, detector: Detector::default(), inside: Vec::with_capacity(contacts) }
    }

    pub fn stored_j(&mut self, model: &Model, state: &State) -> f64 {
        self.detector.detect(model, state, &Reach::INSIDE, &mut self.inside, &mut Work::default());
        let stored = |contact: &Contact| 0.5 * self.stiffness_n_m * contact.gap_m.min(0.0).powi(2);
        self.inside.iter().map(stored).sum()
    }
}
