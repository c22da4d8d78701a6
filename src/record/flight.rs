//! Flight recorder: the contact system of the step that gained most, which says which contact gained.
//!
//! u⁺ = A p + b (L16): u⁺ are the velocities of the contact points after the step's impulses p, b those without them, A
//! = J M⁻¹ Jᵀ. Three rows a contact, along its normal and two tangents. A contact gives the bodies the kinetic energy
//! p·½(b + u⁺): nothing, or what is negative, but where rebound and friction meet.

use crate::collide::SolvedContact;
use crate::model::Model;
use crate::state::State;
use nalgebra::{DMatrix, DVector, Vector3};
use serde::{Deserialize, Serialize};

/// Most contacts of which A is written: the rest of a large step would hide it, and its eigenvalues take long.
const MOST: usize = 100;

/// What is kept of a step until it is known whether a later one gains more.
pub struct KeptContacts {
    pub acted: State,
    pub step: u64,
    pub step_s: f64,
    pub contacts: Vec<SolvedContact>,
}

/// Contact system of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flight {
    pub step: u64,
    /// When its contacts act.
    pub time_s: f64,
    /// Length of the step: forces are impulses over it.
    pub step_s: f64,
    /// Those that gave most energy come first; of many contacts the first hundred, `contacts_count` is all.
    pub contacts: Vec<FlightContact>,
    pub contacts_count: usize,
    /// Energy that all contacts gave.
    pub given_j: f64,
    /// Rows of A, in 1/kg: three a contact, along its axes, in the order of the contacts.
    pub a_per_kg: Vec<Vec<f64>>,
    /// Eigenvalues of A, the largest first.
    pub eigenvalues_per_kg: Vec<f64>,
}

/// One contact of a step, in its own axes: normal, two tangents.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlightContact {
    pub bodies: [String; 2],
    pub point_m: [f64; 3],
    /// Normal and tangents, world axes.
    pub axes: [[f64; 3]; 3],
    pub gap_m: f64,
    /// Velocity before the step, without its impulses (b of u⁺ = A p + b), and with them.
    pub before_m_s: [f64; 3],
    pub b_m_s: [f64; 3],
    pub after_m_s: [f64; 3],
    /// Impulse over the step.
    pub force_n: [f64; 3],
    /// Energy that the contact gave.
    pub given_j: f64,
}

impl Flight {
    /// The system of a step's contacts at the state at which they act.
    pub fn of(model: &Model, KeptContacts { acted, step, step_s, contacts }: &KeptContacts) -> Self {
        let (step, step_s) = (*step, *step_s);
        let axes: Vec<[Vector3<f64>; 3]> = contacts.iter().map(|solved| solved.contact.frame()).collect();
        let free = |i: usize| {
            let at = &acted.bodies[i];
            let (v, w) = model.gained(i, acted.time_s, at, step_s);
            [at.v_WB + v, at.w_WB + w]
        };
        let gained = gained(model, acted, contacts);
        let u = |solved: &SolvedContact, of: &dyn Fn(usize) -> [Vector3<f64>; 2]| solved.contact.velocity(of);
        let along = |i: usize, v: Vector3<f64>| axes[i].map(|axis| axis.dot(&v));
        let mut all: Vec<(usize, FlightContact)> = contacts
            .iter()
            .enumerate()
            .map(|(i, solved)| {
                let before = u(solved, &|k| [acted.bodies[k].v_WB, acted.bodies[k].w_WB]);
                let without = u(solved, &free);
                let after = u(solved, &|k| {
                    let [v, w] = free(k);
                    [v + gained[k][0], w + gained[k][1]]
                });
                let other = solved.contact.other.map_or("container", |other| model.bodies[other].name.as_str());
                let contact = FlightContact {
                    bodies: [model.bodies[solved.contact.body].name.clone(), other.to_string()],
                    point_m: solved.contact.p_WC.into(),
                    axes: axes[i].map(|axis| axis.into()),
                    gap_m: solved.contact.gap_m,
                    before_m_s: along(i, before),
                    b_m_s: along(i, without),
                    after_m_s: along(i, after),
                    force_n: along(i, solved.impulse_W / step_s),
                    given_j: 0.5 * solved.impulse_W.dot(&(without + after)),
                };
                (i, contact)
            })
            .collect();
        let given_j = all.iter().map(|(_, contact)| contact.given_j).sum();
        all.sort_by(|(_, a), (_, b)| b.given_j.total_cmp(&a.given_j));
        all.truncate(MOST);
        let order: Vec<usize> = all.iter().map(|(i, _)| *i).collect();
        let a = matrix(model, acted, contacts, &axes, &order);
        let mut eigenvalues: Vec<f64> = match a.iter().all(|x| x.is_finite()) && !a.is_empty() {
            true => a.symmetric_eigenvalues().iter().copied().collect(),
            false => Vec::new(),
        };
        eigenvalues.sort_by(|a, b| b.total_cmp(a));
        Flight {
            step,
            time_s: acted.time_s,
            step_s,
            contacts: all.into_iter().map(|(_, contact)| contact).collect(),
            contacts_count: contacts.len(),
            given_j,
            a_per_kg: a.row_iter().map(|row| row.iter().copied().collect()).collect(),
            eigenvalues_per_kg: eigenvalues,
        }
    }
}

/// Velocities that the impulses give the bodies.
fn gained(model: &Model, acted: &State, contacts: &[SolvedContact]) -> Vec<[Vector3<f64>; 2]> {
    let mut gained = vec![[Vector3::zeros(); 2]; model.bodies.len()];
    for solved in contacts {
        for (body, r_W, sign) in solved.contact.ends() {
            let [v, w] = response(model, acted, body, r_W, solved.impulse_W * sign);
            gained[body][0] += v;
            gained[body][1] += w;
        }
    }
    gained
}

/// Velocities that an impulse at a lever arm gives a body.
fn response(model: &Model, at: &State, i: usize, r_W: Vector3<f64>, impulse_W: Vector3<f64>) -> [Vector3<f64>; 2] {
    let body = &model.bodies[i];
    if body.driven {
        return [Vector3::zeros(); 2];
    }
    [impulse_W / body.mass_kg, body.I_W_inverse(&at.bodies[i]) * r_W.cross(&impulse_W)]
}

/// A of some of the contacts.
fn matrix(
    model: &Model,
    acted: &State,
    contacts: &[SolvedContact],
    axes: &[[Vector3<f64>; 3]],
    order: &[usize],
) -> DMatrix<f64> {
    let mut columns: Vec<DVector<f64>> = Vec::new();
    for &j in order {
        for axis in axes[j] {
            let unit = [SolvedContact { impulse_W: axis, ..contacts[j] }];
            let given = gained(model, acted, &unit);
            let rows = order.iter().flat_map(|&i| {
                let u = contacts[i].contact.velocity(|k| given[k]);
                axes[i].map(|axis| axis.dot(&u))
            });
            columns.push(DVector::from_iterator(3 * order.len(), rows));
        }
    }
    if columns.is_empty() { DMatrix::zeros(0, 0) } else { DMatrix::from_columns(&columns) }
}
