//! A step of Newton's method on the law of contact after which impulses and velocities along the normals are
//! complementary: the linear complementarity problem in the normal impulses is solved, what sticks and slips, and which
//! way, being as it was (N. H. Josephy, Newton's method for generalized equations, 1979).
//!
//! The natural map decides where a step begins which contacts press in it. Where two contacts are but just apart, it
//! may change its mind for ever: a step in which one presses has it pull, and the other one overlap, and the next step
//! the other way round. And contacts of one face whose gaps do not go together, by what the step of the clock before
//! has left of them, are all closed to it, though one of them is to open. Here the step itself decides.

use super::Impulse;
use super::island::{Island, Point, Share};
use super::law::{self, Law};
use super::modes::{Mode, against, onto_cone, turning};
use super::slope::Slope;
use crate::math::few::{BlockVector, Few};
use crate::math::lemke;
use nalgebra::Vector3;

/// Contacts, and contacts times bodies, up to which such steps are made: they take a solution a contact, and pivots
/// that grow with the square of it.
const MOST_TOUCHES: usize = 64;
const MOST: usize = 256;

/// η of what sticks and turns, and of normal impulses: so small that one step takes those where they belong.
const ETA: f64 = 1e-8;
const NORMAL_ETA: f64 = 1e-11;

/// What the impulse of a contact does when velocities change and its normal impulse is to be λ: p = `kept` − D (u + Δu)
/// + λ `edge`.
struct Complementary {
    kept: Impulse,
    D: Slope,
    edge: Vector3<f64>,
    mode: Mode,
}

impl Complementary {
    fn new(touch: &Share, p: &Impulse, u: &Vector3<f64>) -> Self {
        let friction = touch.law.friction();
        let mode = match Mode::of(touch, p, u) {
            Mode::Open if friction > 0.0 => against(u).map_or(Mode::Open, Mode::Slips),
            mode => mode,
        };
        let normal = Vector3::x();
        match mode {
            Mode::Slips(t) => Complementary {
                kept: Impulse::zeros(),
                D: Slope::along_side(&t, friction, 0.0, turning(p, u, friction, ETA)),
                edge: law::edge(&t, friction),
                mode,
            },
            Mode::Held if touch.law == Law::Pin => {
                Complementary { kept: *p, D: Slope::alike(1.0 / ETA), edge: normal, mode }
            }
            Mode::Held if friction > 0.0 => {
                let D = Slope::Diagonal(Vector3::new(0.0, 1.0 / ETA, 1.0 / ETA));
                Complementary { kept: Impulse::new(0.0, p.y, p.z), D, edge: normal, mode }
            }
            _ => Complementary { kept: Impulse::zeros(), D: Slope::Nothing, edge: normal, mode },
        }
    }
}

/// Whether such steps are made.
pub(super) fn is_affordable(island: &Island) -> bool {
    let touches = island.touches.len();
    touches <= MOST_TOUCHES && touches * island.bodies() <= MOST
}

/// A step of Newton's method after which no contact pulls or overlaps.
pub(super) fn step(island: &Island, at: &Point) -> Option<Point> {
    let touches = || island.touches.iter().zip(&at.p).zip(&at.u);
    let all: Few<Complementary> = touches().map(|((touch, p), u)| Complementary::new(touch, p, u)).collect();
    let factors = island.coupled(all.iter().map(|own| &own.D), 1.0).factors(island.deadline)?;
    // Without normal impulses, and what each of them adds.
    let kept = touches().zip(&all).map(|(((_, p), u), own)| own.kept - p - own.D.times(u));
    let base = factors.solve(&island.pushed(kept))?;
    let contacts: Vec<usize> = (0..all.len()).filter(|i| island.touches[*i].law != Law::Pin).collect();
    let alone = |i: &usize| factors.solve(&island.pushed_by(*i, &all[*i].edge));
    let added = contacts.iter().map(alone).collect::<Option<Vec<_>>>()?;
    let normal = |i: usize, change: &BlockVector| island.touches[i].motion(change).x;
    let mut M = Vec::with_capacity(contacts.len() * contacts.len());
    for (k, i) in contacts.iter().enumerate() {
        M.extend(added.iter().map(|change| normal(*i, change)));
        M[k * contacts.len() + k] += NORMAL_ETA;
    }
    let free = |i: &usize| at.u[*i].x + normal(*i, &base) - NORMAL_ETA * at.p[*i].x;
    let q: Vec<f64> = contacts.iter().map(free).collect();
    let pressing = lemke::solve(&M, &q)?;
    let (mut change, mut lambda) = (base, Few::from_elem(0.0, all.len()));
    for ((i, added), own) in contacts.iter().zip(&added).zip(&pressing) {
        change.add_scaled(added, *own);
        lambda[*i] = *own;
    }
    let next = touches().zip(&all).zip(&lambda).map(|((((touch, _), u), own), lambda)| {
        let p = own.kept - own.D.times(&(u + touch.motion(&change))) + own.edge * *lambda;
        match own.mode {
            _ if *lambda == 0.0 && touch.law != Law::Pin => Impulse::zeros(),
            Mode::Slips(_) => onto_cone(&p, touch.law.friction()),
            _ => p,
        }
    });
    Some(island.at(next.collect()))
}
