//! What a contact or a pin is to one of its bodies: rows of J and of M⁻¹Jᵀ.

use super::Impulse;
use super::twist::Twist;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::{Matrix3, Vector3};

/// One row of J and of M⁻¹Jᵀ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// [eᵀ (u_c × e)ᵀ]: times V, the contact point's velocity along e.
    pub(super) j: Twist,
    /// What a unit impulse along e does to V.
    pub(super) response: Twist,
}

impl Row {
    #[inline]
    pub(super) fn along(&self, u: &Twist) -> f64 {
        self.j.v.dot(&u.v) + self.j.w.dot(&u.w)
    }
}

/// What a contact is to one of its bodies.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub body: usize,
    pub(super) rows: [Row; 3],
}

impl End {
    /// `sign`: of the contact's impulse on this body.
    pub(super) fn new(
        body: usize,
        sign: f64,
        r_W: &Vector3<f64>,
        frame: &[Vector3<f64>; 3],
        inertia: &Inertia,
    ) -> Self {
        let row = |e: &Vector3<f64>| {
            let e = e * sign;
            let j = Twist { v: e, w: r_W.cross(&e) };
            Row { j, response: Twist { v: e / inertia.mass_kg, w: inertia.inverse_W * j.w } }
        };
        End { body, rows: [row(&frame[0]), row(&frame[1]), row(&frame[2])] }
    }

    /// Distance of the contact from the centre of mass: Σ|r×e|² over three orthonormal e is 2 r².
    pub(super) fn arm_m(&self) -> f64 {
        (self.rows.iter().map(|row| row.j.w.norm_squared()).sum::<f64>() / 2.0).sqrt()
    }

    /// Trace of the body's part of J M⁻¹ Jᵀ.
    pub(super) fn compliance(&self) -> f64 {
        self.rows.iter().map(|row| row.along(&row.response)).sum()
    }

    /// J u.
    pub(super) fn motion(&self, u: &Twist) -> Vector3<f64> {
        Vector3::new(self.rows[0].along(u), self.rows[1].along(u), self.rows[2].along(u))
    }

    /// M⁻¹ Jᵀ p.
    #[inline]
    pub(super) fn response(&self, p: &Impulse) -> Twist {
        let [n, t1, t2] = [0, 1, 2].map(|k| self.rows[k].response);
        Twist { v: n.v * p.x + t1.v * p.y + t2.v * p.z, w: n.w * p.x + t1.w * p.y + t2.w * p.z }
    }

    /// u += M⁻¹ Jᵀ Δp.
    pub(super) fn apply(&self, change: &Impulse, u: &mut [Twist]) {
        for (row, p) in self.rows.iter().zip(change.iter()) {
            u[self.body].add_scaled(&row.response, *p);
        }
    }

    /// The body's velocities without an impulse that is in them.
    pub fn take_off(&self, p: &Impulse, velocities: &mut Twist) {
        self.rows.iter().zip(p.iter()).for_each(|(row, p)| velocities.add_scaled(&row.response, -p));
    }

    /// J M⁻¹ Jᵀ of two contacts of the same body.
    pub(super) fn coupling(&self, other: &End) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.rows[i].along(&other.rows[j].response))
    }
}

/// M of one body; infinite where nothing moves it.
#[derive(Clone, Copy, Debug)]
pub struct Inertia {
    pub mass_kg: f64,
    pub inverse_W: Matrix3<f64>,
}

impl Inertia {
    pub fn of(body: &Body, at: &BodyState) -> Self {
        if body.driven {
            return Inertia { mass_kg: f64::INFINITY, inverse_W: Matrix3::zeros() };
        }
        Inertia { mass_kg: body.mass_kg, inverse_W: body.I_W_inverse(at) }
    }
}
