//! Contacts of one step, kept to be measured when the run has ended.

use crate::collide::Contact;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector3, Vector6};

/// The contacts that a step met, and the state before it.
#[derive(Clone, Debug, Default)]
pub(super) struct Kept {
    pub contacts: Vec<Contact>,
    bodies: Vec<BodyState>,
}

impl Kept {
    pub fn keep(&mut self, before: &State, contacts: impl Iterator<Item = Contact>) {
        self.contacts.clear();
        self.contacts.extend(contacts);
        self.bodies.clone_from(&before.bodies);
    }

    /// The rows of J M^(−1/2) along the first `axes` of every contact's frame, of each body that has a contact.
    pub fn rows(&self, model: &Model, axes: usize) -> Vec<Vec<Vector6<f64>>> {
        let of_body = |(index, (body, at)): (usize, (&Body, &BodyState))| {
            let root = Root::of(body, at);
            let own = self.contacts.iter().filter(|contact| contact.body == index && contact.other.is_none());
            own.flat_map(|contact| contact.frame().into_iter().take(axes).map(|e| root.row(contact, &e))).collect()
        };
        let all = model.bodies.iter().zip(&self.bodies).enumerate().map(of_body);
        all.filter(|rows: &Vec<_>| !rows.is_empty()).collect()
    }
}

/// M^(−1/2) of one body.
struct Root {
    linear: f64,
    angular: Matrix3<f64>,
}

impl Root {
    fn of(body: &Body, at: &BodyState) -> Self {
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(body.I_W_inverse(at));
        let roots = Matrix3::from_diagonal(&eigenvalues.map(|value| value.max(0.0).sqrt()));
        Root { linear: 1.0 / body.mass_kg.sqrt(), angular: eigenvectors * roots * eigenvectors.transpose() }
    }

    /// [eᵀ (r × e)ᵀ] M^(−1/2).
    fn row(&self, contact: &Contact, e: &Vector3<f64>) -> Vector6<f64> {
        let (v, w) = (e * self.linear, self.angular * contact.r_BC_W.cross(e));
        Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z)
    }
}

/// The six largest eigenvalues of the matrix of all products of two rows, largest first: those of Σ row rowᵀ, which is
/// 6×6 however many rows there are. None of what is not finite.
pub(super) fn eigenvalues(rows: &[Vector6<f64>]) -> Option<[f64; 6]> {
    let gram: Matrix6<f64> = rows.iter().map(|row| row * row.transpose()).sum();
    if !gram.iter().all(|x| x.is_finite()) {
        return None;
    }
    let mut values: [f64; 6] = gram.symmetric_eigenvalues().into();
    values.sort_by(|a, b| b.total_cmp(a));
    Some(values)
}
