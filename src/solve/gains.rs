//! Energy that contacts give to the bodies of their islands, beside what of it is rounding.

use crate::collide::Contact;
use crate::collide::islands::Islands;
use crate::model::Model;

/// Energy that contacts give, of the sizes of impulses and velocities: rounding.
const NOTHING: f64 = 1e-13;

/// What the contacts of every island give, kept from step to step to spare the allocator.
#[derive(Clone, Debug, Default)]
pub struct Gains {
    islands: Islands,
    /// Of every island by its first body: what its contacts give, and the size of what it is made of.
    of: Vec<(f64, f64)>,
}

impl Gains {
    /// With room for so many bodies.
    pub fn with_capacity(bodies: usize) -> Self {
        Gains { islands: Islands::with_capacity(bodies), of: Vec::with_capacity(bodies) }
    }

    /// Adds up what contacts give: of each the energy, or any multiple of it that all have, and the size of its terms.
    pub fn add_up(&mut self, model: &Model, contacts: &[Contact], each: impl Iterator<Item = (f64, f64)>) {
        self.islands.find(model, contacts.iter().copied());
        self.of.clear();
        self.of.resize(model.bodies.len(), (0.0, 0.0));
        for (contact, (given, size)) in contacts.iter().zip(each) {
            let of = &mut self.of[self.islands.of(model, contact)];
            *of = (of.0 + given, of.1 + size);
        }
    }

    /// Whether the island of a contact gets any.
    pub fn to_island_of(&mut self, model: &Model, contact: &Contact) -> bool {
        let first = self.islands.of(model, contact);
        self.is_some(first)
    }

    /// Whether the island of a body gets any.
    pub fn to_island_with(&mut self, body: usize) -> bool {
        let first = self.islands.first(body);
        self.is_some(first)
    }

    fn is_some(&self, first: usize) -> bool {
        let (given, size) = self.of[first];
        given > NOTHING * size
    }
}
