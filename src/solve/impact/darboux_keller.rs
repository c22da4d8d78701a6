//! The impact of one contact with Coulomb friction, its sliding followed along the normal impulse (G. Darboux, Bull.
//! Sci. Math. 4 (1880) 126; J. B. Keller, J. Appl. Mech. 53 (1986) 1), ended by W. J. Stronge's energetic restitution
//! (Proc. R. Soc. A 431 (1990) 169): the normal impulse gives back e² of the work that it took.
//!
//! Bodies do not move, velocities do: du/dp_n = A (1, f), with the contact's 3×3 block A and friction f = −μ t opposite
//! to the slip. At slip 0 it sticks by f = −A_tt⁻¹ A_tn if |f| ≤ μ; else it starts to slip in the one direction that
//! the disc
//! |f| ≤ μ leaves (dissipation is least at the f of `disc::least`). That and any slip of constant direction, so every
//! planar impact, is piecewise linear and solved exactly; a slip that turns has a hodograph, followed by its Taylor
//! series (`hodograph`). Work of friction is never positive and that of the normal impulse is −(1 − e²) W_compression,
//! so no impact gains energy. For central and for frictionless impacts it is Newton's and Poisson's law.

use super::super::Impulse;
use super::disc;
use super::hodograph::Turn;
use super::path::{Path, Phase};
use nalgebra::{Matrix3, Vector2, Vector3};

/// Of the speed before the impact: a slip below it has ended.
const SLIP_ENDS: f64 = 1e-15;

/// Of what turns the slip: a turn below it is rounding.
const TURN_ENDS: f64 = 8.0 * f64::EPSILON;

/// Steps along a hodograph end after tens.
const MOST: usize = 10_000;

/// The impulse of a contact that has velocity `v` and, alone, the block `A` of A. `restitution`: e.
pub fn impulse(A: &Matrix3<f64>, v: &Vector3<f64>, friction: f64, restitution: f64) -> Impulse {
    let mut path = Path {
        A,
        friction,
        e2: restitution * restitution,
        u: *v,
        p: Impulse::zeros(),
        store: 0.0,
        phase: Phase::Compression,
    };
    if v.x < 0.0 && A[(0, 0)] > 0.0 {
        path.follow();
    }
    path.p
}

impl Path<'_> {
    fn follow(&mut self) {
        if self.friction == 0.0 {
            return self.straight(&Vector2::zeros(), f64::INFINITY);
        }
        let ends = SLIP_ENDS * self.u.norm();
        for _ in 0..MOST {
            if self.phase == Phase::Over || self.slip().norm() <= ends {
                break;
            }
            self.slide();
        }
        if self.phase != Phase::Over && self.slip().norm() <= ends {
            self.stop();
            let f = disc::least(&self.tangents(), &-self.coupling(), self.friction);
            self.straight(&f, f64::INFINITY);
        }
    }

    /// To the end of the slip if it keeps its direction, else a step.
    fn slide(&mut self) {
        let slip = self.slip();
        let speed = slip.norm();
        let t = slip / speed;
        let (a, B) = (self.coupling(), self.tangents() * self.friction);
        let change = a - B * t;
        if t.perp(&change).abs() > TURN_ENDS * (a.norm() + B.norm()) {
            return Turn::new(self).step(self);
        }
        let along = t.dot(&change);
        self.straight(&(t * -self.friction), if along < 0.0 { speed / -along } else { f64::INFINITY });
        if self.phase != Phase::Over {
            self.stop();
        }
    }

    fn stop(&mut self) {
        (self.u.y, self.u.z) = (0.0, 0.0);
    }

    /// Constant friction `f` for at most so much normal impulse: velocity linear in it, work quadratic.
    fn straight(&mut self, f: &Vector2<f64>, mut most: f64) {
        let along = Impulse::new(1.0, f.x, f.y);
        let change = self.A * along;
        while self.phase != Phase::Over {
            let (to_turn, to_end) = (self.to_turn(change.x), self.to_end(change.x));
            let part = to_turn.min(to_end).min(most);
            if part.is_infinite() {
                // Only without mass: A is not positive.
                self.phase = Phase::Over;
                return;
            }
            self.take_work((self.u.x + change.x * part / 2.0) * part);
            self.u += change * part;
            self.p += along * part;
            if part == to_end {
                self.phase = Phase::Over;
            } else if part == to_turn {
                self.turn();
            } else {
                return;
            }
            most -= part;
        }
    }

    /// The normal impulse has done so much work.
    fn take_work(&mut self, work: f64) {
        self.store -= self.store_rate() * work;
    }

    /// The normal velocity is 0: compression ends, or begins again.
    pub fn turn(&mut self) {
        self.u.x = 0.0;
        self.phase = match self.phase {
            Phase::Compression if self.store > 0.0 => Phase::Restitution,
            Phase::Compression => Phase::Over,
            _ => Phase::Compression,
        };
    }

    /// Normal impulse until the normal velocity is 0.
    fn to_turn(&self, change: f64) -> f64 {
        match self.phase {
            Phase::Compression if change > 0.0 => -self.u.x / change,
            Phase::Restitution if change < 0.0 => self.u.x / -change,
            _ => f64::INFINITY,
        }
    }

    /// Normal impulse until the store is empty.
    fn to_end(&self, change: f64) -> f64 {
        let square = self.u.x * self.u.x + 2.0 * change * self.store;
        if self.phase != Phase::Restitution || square < 0.0 {
            return f64::INFINITY;
        }
        2.0 * self.store / (self.u.x + square.sqrt())
    }
}
