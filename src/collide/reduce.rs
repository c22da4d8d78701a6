//! Reduction of many contacts on a face to few: the deepest, then always the one farthest from those already taken. On
//! a face of a box that is its corners, and what holds all corners holds the face.

use super::Contact;

/// Distance of a contact that is taken.
const TAKEN: f64 = -1.0;

#[derive(Clone, Debug)]
pub struct Reduction {
    /// Number of contacts of one body on one face that are kept.
    most: usize,
    /// Squared distance of every contact to the nearest taken one, in m².
    nearest: Vec<f64>,
    /// Contacts of the last call that were not taken.
    pub left_out: Vec<Contact>,
}

impl Reduction {
    pub fn new(most: u32, contacts: usize) -> Self {
        let most = most as usize;
        Reduction { most, nearest: Vec::with_capacity(contacts), left_out: Vec::with_capacity(contacts) }
    }

    /// Leaves at most that many of every body's contacts with every face, in their order.
    pub fn apply(&mut self, contacts: &mut Vec<Contact>) {
        self.nearest.clear();
        self.left_out.clear();
        for face in contacts.chunk_by(|a, b| (a.body, a.other, a.feature.0) == (b.body, b.other, b.feature.0)) {
            self.take(face);
        }
        let (mut nearest, left_out) = (self.nearest.iter(), &mut self.left_out);
        contacts.retain(|contact| {
            let kept = nearest.next() == Some(&TAKEN);
            if !kept {
                left_out.push(*contact);
            }
            kept
        });
    }

    fn take(&mut self, face: &[Contact]) {
        let start = self.nearest.len();
        self.nearest.resize(start + face.len(), f64::INFINITY);
        let nearest = &mut self.nearest[start..];
        let mut next = first_largest(face.iter().map(|contact| -contact.gap_m));
        for _ in 0..self.most.min(face.len()) {
            let from = face[next].r_BC_W;
            for (distance, contact) in nearest.iter_mut().zip(face) {
                *distance = distance.min((contact.r_BC_W - from).norm_squared());
            }
            nearest[next] = TAKEN;
            next = first_largest(nearest.iter().copied());
        }
    }
}

/// Position of the largest value; of equal ones the first.
fn first_largest(values: impl Iterator<Item = f64>) -> usize {
    let mut largest = (0, f64::NEG_INFINITY);
    for (i, value) in values.enumerate() {
        if value > largest.1 {
            largest = (i, value);
        }
    }
    largest.0
}
