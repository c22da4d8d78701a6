//! What contacts take: D, the energy that impulses take from the bodies' motion against each other, −Σ p·½(u⁻ + u⁺),
//! u the relative velocity before (without the step's forces) and after.
//!
//! The law lets contacts take energy and never give any, and what has e = 1 takes none along its normal. What an island
//! would gain in all is therefore no part of the books: it shows as drift.

use super::exchange::{Exchange, Met};
use crate::collide::SolvedContact;
use nalgebra::Vector3;

/// Sums below this part of Σ|p|s, s the largest relative speed, are rounding.
const NOTHING: f64 = 1e-9;

/// The law by which a contact may take energy.
#[derive(Clone, Copy, Debug)]
pub(super) struct Law {
    /// Newton's restitution contact by contact: e = 1 takes nothing along the normal. By the other laws an impact takes
    /// nothing only where it is without friction as well.
    pub newton: bool,
    /// Of springs in place of a law, k times the step, N s/m: what springs hold is stored, not taken.
    pub spring_n_s_m: f64,
}

/// Energies of one exchange, J.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Taken {
    /// Over islands the sum of what the law lets them take.
    pub lawful: f64,
    /// All of it with its sign.
    pub all: f64,
    /// Σ|p·½(u⁻ + u⁺)|, whose rounding the others have.
    pub parts: f64,
}

/// Sums over one island.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    taken_j: f64,
    size_j: f64,
}

/// The keeper of the sums, for its memory.
#[derive(Clone, Debug)]
pub(super) struct Dissipation {
    islands: Vec<Sum>,
}

impl Dissipation {
    pub fn with_capacity(bodies: usize) -> Self {
        Dissipation { islands: Vec::with_capacity(bodies) }
    }

    pub fn of(&mut self, exchange: &Exchange, contacts: &[SolvedContact], law: &Law) -> Taken {
        self.islands.clear();
        self.islands.resize(exchange.moved.len(), Sum::default());
        let mut taken = Taken::default();
        for (solved, met) in contacts.iter().zip(&exchange.met) {
            let p = not_stored(solved, law);
            let along = (met.before + met.after) / 2.0;
            let all_j = -p.dot(&along);
            taken.all += all_j;
            taken.parts += all_j.abs();
            let island = &mut self.islands[met.island];
            island.taken_j += may_take(solved, met, law, all_j);
            island.size_j += p.norm() * met.speed();
        }
        let lawful = |sum: &Sum| if sum.taken_j > NOTHING * sum.size_j { sum.taken_j } else { 0.0 };
        taken.lawful = self.islands.iter().map(lawful).sum();
        taken
    }
}

/// The impulse less that of a spring.
fn not_stored(solved: &SolvedContact, law: &Law) -> Vector3<f64> {
    let depth_m = (-solved.contact.gap_m).max(0.0);
    solved.impulse_W - solved.contact.normal * (law.spring_n_s_m * depth_m)
}

fn may_take(SolvedContact { contact, impulse_W }: &SolvedContact, met: &Met, law: &Law, all_j: f64) -> f64 {
    if contact.restitution < 1.0 {
        return all_j;
    }
    if law.newton {
        let tangent = |u: &Vector3<f64>| u - contact.normal * contact.normal.dot(u);
        return -tangent(impulse_W).dot(&tangent(&(met.before + met.after))) / 2.0;
    }
    if contact.friction > 0.0 { all_j } else { 0.0 }
}
