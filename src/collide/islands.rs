//! Islands: bodies that contacts join, but not through one that nothing moves.

use super::Contact;
use crate::model::Model;

/// The islands of one set of contacts, kept from set to set to spare the allocator.
#[derive(Clone, Debug, Default)]
pub struct Islands {
    /// Of every body one of its island before it, or itself.
    parent: Vec<usize>,
}

impl Islands {
    /// With room for so many bodies.
    pub fn with_capacity(bodies: usize) -> Self {
        Islands { parent: Vec::with_capacity(bodies) }
    }

    /// Finds those that contacts make.
    pub fn find(&mut self, model: &Model, contacts: impl Iterator<Item = Contact>) {
        self.parent.clear();
        self.parent.extend(0..model.bodies.len());
        for contact in contacts {
            let Some(other) = contact.other else { continue };
            if !model.bodies[contact.body].driven && !model.bodies[other].driven {
                let (a, b) = (self.root(contact.body), self.root(other));
                self.parent[a.max(b)] = a.min(b);
            }
        }
    }

    /// The first body of the island of a contact: that of a body which the contact can move.
    pub fn of(&mut self, model: &Model, contact: &Contact) -> usize {
        let moving = contact.ends().find(|(i, ..)| !model.bodies[*i].driven);
        self.root(moving.map_or(contact.body, |(i, ..)| i))
    }

    /// The first body of a body's island.
    pub fn first(&mut self, body: usize) -> usize {
        self.root(body)
    }

    /// Halves the way that it goes: the next one is shorter.
    fn root(&mut self, mut body: usize) -> usize {
        while self.parent[body] != body {
            self.parent[body] = self.parent[self.parent[body]];
            body = self.parent[body];
        }
        body
    }
}
