//! Forces of contact that keep what is in contact together: A f + b = 0 at the level of accelerations, for given modes.
//!
//! b is J V̇ without contact plus the touches' bias. A contact that sticks has three rows; one that slides has its
//! normal row, and its force lies on the edge of the cone, n − μ d, so that the system is not symmetric and may have no
//! solution (Painlevé). Contacts may be redundant (the four corners of a slab): then the forces are not unique and the
//! motion is, of contacts that stick or all slide the same way. `Selection::Any` finds one solution by elimination,
//! `Selection::Least` the smallest.

use super::touch::{Here, Touch};
use crate::collide::Contact;
use crate::collide::approach::Approach;
use crate::deadline::Deadline;
use crate::integrate::rotation::gyroscopic_torque_B;
use crate::math::few::{Few, OneOrTwo};
use crate::math::full_pivot::{Eliminated, FEW as FEW_UNKNOWNS, Numbers, Selection, Square, amax};
use crate::model::{Body, Model};
use crate::solve::Impulse;
use crate::solve::block::Block;
use crate::solve::pins::{self, Pin, PinEnd};
use crate::solve::problem::ContactProblem;
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use nalgebra::Vector3;
use smallvec::SmallVec;

/// How a contact holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    Stick,
    /// Along this direction (unit, world), the body's point against the other's. Without friction, zero.
    Slide(Vector3<f64>),
}

/// What the direction of a slip is in a step (`slip`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slip {
    /// At every moment its own.
    Fast,
    /// It has just begun: up to this speed (m/s), the one in which it began.
    Young(f64),
    /// It follows a line, and keeps its direction; beyond its end, too, so that an integrator may step over it.
    Straight,
    /// It ends at once, and keeps its direction.
    Fading,
}

#[derive(Clone, Debug)]
pub struct Held {
    pub touch: Touch,
    pub mode: Mode,
    pub slip: Slip,
}

impl Held {
    /// It slides with friction.
    pub fn slides(&self) -> Option<Vector3<f64>> {
        match self.mode {
            Mode::Slide(d) if d != Vector3::zeros() => Some(d),
            _ => None,
        }
    }
}

/// What a block's force may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Rows {
    /// The normal row; the force is along this, in the contact's frame.
    Normal(Vector3<f64>),
    All,
}

/// Contacts and pins of one state. One value is gathered anew from state to state, to spare the allocator.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    pub problem: ContactProblem,
    /// Of the touches.
    pub here: Vec<Here>,
    /// Accelerations without contact, of every body.
    pub free: Vec<Twist>,
    /// What is not solved by then is not.
    pub deadline: Deadline,
    contacts: Vec<Contact>,
    pins: Vec<Pin>,
    /// Blocks, by their numbers, that share bodies which forces move.
    pub islands: Vec<Vec<usize>>,
}

/// Forces, and what they do.
#[derive(Clone, Debug, Default)]
pub struct Solved {
    /// f of every contact and pin, in its frame.
    pub p: Few<Impulse>,
    /// Of every body, by the forces.
    pub added: OneOrTwo<Twist>,
    /// They keep what was to hold, to rounding.
    pub holds: bool,
}

impl Solved {
    /// V̇ of a body.
    pub fn acceleration(&self, gathered: &Gathered, body: usize) -> Twist {
        let (free, added) = (&gathered.free[body], &self.added[body]);
        Twist { v: free.v + added.v, w: free.w + added.w }
    }

    /// The norm of the largest force.
    pub fn largest(&self) -> f64 {
        self.p.iter().map(|p| p.norm()).fold(0.0, f64::max)
    }
}

/// Forces that the modes of what holds tell, and nothing is left to share.
pub struct Told<'a> {
    gathered: &'a Gathered,
    unknowns: SmallVec<[Unknown; FEW_UNKNOWNS]>,
    eliminated: Eliminated,
    normals: Few<f64>,
}

impl Told<'_> {
    /// What all bodies' accelerations change by, per radian that a contact's slip turns, its direction by t (unit).
    /// None: it does not slip, or time is up.
    pub fn turn(&self, contact: usize, t_W: &Vector3<f64>) -> Option<OneOrTwo<Twist>> {
        let blocks = &self.gathered.problem.blocks;
        let block = &blocks[contact];
        let mut turned = edge(block.friction, &block.frame, t_W) - Vector3::x();
        turned *= self.normals[contact];
        let responses = block.responses(&turned);
        let lacks = |of: &Unknown| -blocks[of.block].row_of(of.row, block, &responses);
        let lacks: Numbers = self.unknowns.iter().map(lacks).collect();
        let changes = self.eliminated.solve(&lacks, Selection::Any)?;
        let mut p = self.gathered.no_forces();
        p[contact] = turned;
        self.unknowns.iter().zip(&changes).for_each(|(of, x)| p[of.block] += of.along * *x);
        Some(self.gathered.solved(p, true).added)
    }
}

/// Slower, of the speeds that meet at a contact, is no slip, and no approach.
pub const NO_SLIP: f64 = 1e-12;

/// Of a body's points, and a part of what a fall by its own size would make of it.
pub fn speed_m_s(model: &Model, body: &Body, at: &BodyState) -> f64 {
    let fall = (model.gravity_m_s2.norm() * body.bounding_radius_m).sqrt();
    at.v_WB.norm() + at.w_WB.norm() * body.bounding_radius_m + 1e-2 * fall
}

/// Of the bodies that meet.
pub fn meeting_m_s(model: &Model, state: &State, bodies: impl Iterator<Item = usize>) -> f64 {
    bodies.map(|i| speed_m_s(model, &model.bodies[i], &state.bodies[i])).fold(0.0, f64::max)
}

impl Gathered {
    pub fn until(deadline: Deadline) -> Self {
        Gathered { deadline, ..Gathered::default() }
    }

    /// Accelerations without contact, and b, of these touches and of all pins.
    pub fn gather<'a>(&mut self, model: &Model, state: &State, touches: impl Iterator<Item = &'a Touch>) {
        self.free.clear();
        self.free.extend((0..model.bodies.len()).map(|i| free_acceleration(model, state, i)));
        self.look(model, state, touches);
        for (block, here) in self.problem.blocks.iter_mut().zip(&self.here) {
            block.b += here.bias(&block.frame);
        }
        self.pin(model, state, |at, r_W| at.w_WB.cross(&at.w_WB.cross(r_W)));
    }

    /// The same with velocities in the place of accelerations: b = J V.
    pub fn gather_velocities<'a>(&mut self, model: &Model, state: &State, touches: impl Iterator<Item = &'a Touch>) {
        self.free.clear();
        self.free.extend(state.bodies.iter().map(Twist::of));
        self.look(model, state, touches);
        self.pin(model, state, |_, _| Vector3::zeros());
    }

    /// The same of contacts that have just been found.
    pub fn gather_plain(&mut self, model: &Model, state: &State, contacts: &[Contact]) {
        self.free.clear();
        self.free.extend(state.bodies.iter().map(Twist::of));
        self.here.clear();
        self.contacts.clear();
        self.contacts.extend_from_slice(contacts);
        self.problem.gather(model, state, &self.free, &mut self.contacts, (Approach::Touching, 1.0));
        self.pin(model, state, |_, _| Vector3::zeros());
    }

    fn look<'a>(&mut self, model: &Model, state: &State, touches: impl Iterator<Item = &'a Touch>) {
        self.here.clear();
        self.here.extend(touches.map(|touch| touch.here(state)));
        self.contacts.clear();
        self.contacts.extend(self.here.iter().map(|here| here.contact));
        self.problem.gather(model, state, &self.free, &mut self.contacts, (Approach::Touching, 1.0));
    }

    /// Fills `islands`, in the order of their first blocks.
    fn part(&mut self, model: &Model) {
        let moved = |block: &Block| -> OneOrTwo<usize> {
            block.ends().map(|end| end.body).filter(|i| !model.bodies[*i].driven).collect()
        };
        let blocks = &self.problem.blocks;
        let mut bodies = blocks.iter().map(moved);
        if let Some(first) = bodies.next()
            && first.len() == 1
            && bodies.all(|other| other == first)
        {
            self.islands.resize_with(1, Vec::new);
            self.islands[0].clear();
            self.islands[0].extend(0..blocks.len());
            return;
        }
        let mut of_body: Vec<usize> = (0..model.bodies.len()).collect();
        fn root(of_body: &[usize], mut i: usize) -> usize {
            while of_body[i] != i {
                i = of_body[i];
            }
            i
        }
        for block in blocks {
            if let [a, b] = moved(block)[..] {
                let [a, b] = [a, b].map(|i| root(&of_body, i));
                of_body[a.max(b)] = a.min(b);
            }
        }
        self.islands.clear();
        let mut place = vec![None; model.bodies.len()];
        for (k, block) in blocks.iter().enumerate() {
            let of = moved(block).first().map(|i| root(&of_body, *i));
            match of.and_then(|of| place[of]) {
                Some(island) => Vec::push(&mut self.islands[island], k),
                None => {
                    if let Some(of) = of {
                        place[of] = Some(self.islands.len());
                    }
                    self.islands.push(vec![k]);
                }
            }
        }
    }

    /// `bias`: what a pin's end is accelerated by the body's rotation.
    fn pin(&mut self, model: &Model, state: &State, bias: impl Fn(&BodyState, &Vector3<f64>) -> Vector3<f64>) {
        if model.pins.is_empty() {
            return self.part(model);
        }
        let of = |end: &PinEnd| bias(&state.bodies[end.body], &end.r_W) * end.sign;
        let both = |own: &PinEnd, other: Option<&PinEnd>| of(own) + other.map_or_else(Vector3::zeros, of);
        pins::at(model, state, |_, own, other| -both(own, other), &mut self.pins);
        self.problem.pin(model, state, &self.free, &self.pins);
        self.part(model);
    }

    /// The largest of b.
    pub fn scale(&self) -> f64 {
        self.problem.blocks.iter().map(|block| block.b.norm()).fold(0.0, f64::max)
    }

    /// Forces for what holds, pins with it.
    pub fn hold(&self, held: &[Held], choice: Selection) -> Solved {
        self.hold_as(self.modes(held), choice)
    }

    /// Forces for contacts of these modes, pins with them.
    pub fn hold_as(&self, modes: impl ExactSizeIterator<Item = Mode>, choice: Selection) -> Solved {
        let contacts = modes.len();
        let rows = self.rows(modes);
        let solved = self.solve(&rows, choice);
        if choice == Selection::Any || !solved.holds { solved } else { self.push_only(&rows, solved, contacts) }
    }

    /// Changes of velocity that leave none along the rows that hold, of every island that has such; none: there is not
    /// more than `least`, their rounding.
    pub fn stop(&self, held: &[Held], least: f64) -> Option<Solved> {
        let rows = self.rows(self.modes(held));
        let off = |(block, rows): (&Block, &Rows)| match rows {
            Rows::Normal(_) => block.b.x.abs(),
            Rows::All => block.b.amax(),
        };
        let largest = self.problem.blocks.iter().zip(&rows).map(off).fold(0.0, f64::max);
        (largest > least).then(|| self.put_right(&rows, least))
    }

    /// Displacements that close b, of so many contacts along their normals, of pins whole, of every island that has
    /// such; `least`: their rounding.
    pub fn close(&self, contacts: usize, least: f64) -> Solved {
        let mut rows = Few::from_elem(Rows::Normal(Vector3::x()), contacts);
        rows.resize(self.problem.blocks.len(), Rows::All);
        self.put_right(&rows, least)
    }

    /// Modes of what is held, slips along what they are now.
    pub fn modes<'a>(&'a self, held: &'a [Held]) -> impl ExactSizeIterator<Item = Mode> + 'a {
        held.iter().zip(&self.here).map(|(held, here)| match held.mode {
            Mode::Stick => Mode::Stick,
            Mode::Slide(_) => Mode::Slide(direction(held, here)),
        })
    }

    /// What the blocks' forces may be: of contacts by their modes, of pins all.
    pub(super) fn rows(&self, modes: impl Iterator<Item = Mode>) -> Few<Rows> {
        let of = |(mode, block): (Mode, &Block)| match mode {
            Mode::Stick => Rows::All,
            Mode::Slide(d) => Rows::Normal(edge(block.friction, &block.frame, &d)),
        };
        let mut rows: Few<Rows> = modes.zip(&self.problem.blocks).map(of).collect();
        rows.resize(self.problem.blocks.len(), Rows::All);
        rows
    }

    /// Of an island's blocks: whether the normal part of its force, and whether all of it, is the same however they
    /// share their forces.
    pub fn known(&self, held: &[Held], island: &[usize]) -> Few<[bool; 2]> {
        let unknowns = unknowns(island, &self.rows(self.modes(held)));
        let eliminated =
            matrix(&self.problem, &unknowns, self.deadline).and_then(|matrix| Eliminated::new(matrix, self.deadline));
        let is_open = eliminated.map_or_else(|| SmallVec::from_elem(true, unknowns.len()), |it| it.leaves_open());
        let of_block = |block: usize| {
            let own = || unknowns.iter().zip(&is_open).filter(move |(of, _)| of.block == block);
            [own().all(|(of, is_open)| of.row > 0 || !is_open), own().all(|(_, is_open)| !is_open)]
        };
        island.iter().map(|block| of_block(*block)).collect()
    }

    /// The forces of these modes, if the modes alone tell all of them.
    pub fn told(&self, modes: &[Mode], solved: &Solved) -> Option<Told<'_>> {
        let [island] = &self.islands[..] else { return None };
        let slides = |mode: &Mode| matches!(mode, Mode::Slide(_));
        let is_left_out = |(mode, p): (&Mode, &Impulse)| slides(mode) && p.x == 0.0;
        if !solved.holds || modes.iter().zip(&solved.p).any(is_left_out) {
            return None;
        }
        let unknowns = unknowns(island, &self.rows(modes.iter().copied()));
        let eliminated = Eliminated::new(matrix(&self.problem, &unknowns, self.deadline)?, self.deadline)?;
        let normals = solved.p.iter().map(|p| p.x).collect();
        eliminated.is_regular().then_some(Told { gathered: self, unknowns, eliminated, normals })
    }

    fn solve(&self, rows: &[Rows], choice: Selection) -> Solved {
        let mut p = self.no_forces();
        let mut holds = true;
        for island in &self.islands {
            let missed = missed(&self.problem, island, rows, choice, &mut p, self.deadline);
            holds &= missed.is_some_and(|missed| missed.is_nothing());
        }
        self.solved(p, holds)
    }

    /// Any solution of every island that has one; `rounding`: of b, which equations that say the same thing twice
    /// differ by.
    fn put_right(&self, rows: &[Rows], rounding: f64) -> Solved {
        let mut p = self.no_forces();
        let mut holds = true;
        for island in &self.islands {
            let missed = missed(&self.problem, island, rows, Selection::Any, &mut p, self.deadline);
            // What is rounding itself is not put right by rounding.
            let is_rounding = |missed: Missed| missed.size <= ROUNDINGS * rounding && missed.of_all <= PUT_RIGHT;
            if missed.is_none_or(|missed| !missed.is_nothing() && !is_rounding(missed)) {
                island.iter().for_each(|i| p[*i] = Impulse::zeros());
                holds = false;
            }
        }
        self.solved(p, holds)
    }

    /// No solution.
    pub fn without_forces(&self) -> Solved {
        self.solved(self.no_forces(), false)
    }

    pub(super) fn no_forces(&self) -> Few<Impulse> {
        Few::from_elem(Impulse::zeros(), self.problem.blocks.len())
    }

    /// What forces do.
    pub fn solved(&self, p: impl Into<Few<Impulse>>, holds: bool) -> Solved {
        let p = p.into();
        let mut added = OneOrTwo::from_elem(Twist::ZERO, self.free.len());
        self.problem.add_response(&p, &mut added);
        Solved { p, added, holds }
    }
}

/// n − μ d in the contact's frame.
pub fn edge(friction: f64, frame: &[Vector3<f64>; 3], d_W: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(1.0, -friction * frame[1].dot(d_W), -friction * frame[2].dot(d_W))
}

/// Of a slip: beyond zero it goes on smoothly, so that an integrator may try a step over its end.
pub fn direction(held: &Held, here: &Here) -> Vector3<f64> {
    let Some(from) = held.slides() else { return Vector3::zeros() };
    let slip = here.slip_W();
    let speed = slip.norm();
    let is_kept = match held.slip {
        Slip::Fast => speed == 0.0,
        Slip::Young(until_m_s) => speed <= until_m_s,
        Slip::Straight | Slip::Fading => true,
    };
    if is_kept {
        return along(&from, &here.contact.normal);
    }
    if slip.dot(&from) >= 0.0 { slip / speed } else { -slip / speed }
}

/// The direction in the plane of contact.
pub fn along(d: &Vector3<f64>, normal: &Vector3<f64>) -> Vector3<f64> {
    (d - normal * normal.dot(d)).try_normalize(0.0).unwrap_or(*d)
}

/// V̇ of a body by gravity, loads and its own rotation.
fn free_acceleration(model: &Model, state: &State, index: usize) -> Twist {
    let (body, at) = (&model.bodies[index], &state.bodies[index]);
    if body.driven {
        return Twist::ZERO;
    }
    let mut v = model.gravity_m_s2;
    let mut torque_B = Vector3::zeros();
    if model.has_loads() {
        let load = model.load(index, state.time_s, at);
        v += load.force / body.mass_kg;
        torque_B = at.q_WB.inverse_transform_vector(&load.torque);
    }
    if !body.isotropic {
        torque_B += gyroscopic_torque_B(body, &at.q_WB.inverse_transform_vector(&at.w_WB));
    }
    let w = if torque_B == Vector3::zeros() { torque_B } else { at.q_WB * (body.I_B_inverse * torque_B) };
    Twist { v, w }
}

/// What forces leave of the equations, and that over the terms that it is left of.
#[derive(Clone, Copy, Debug, Default)]
struct Missed {
    size: f64,
    of_all: f64,
}

impl Missed {
    /// The forces solve the equations.
    fn is_nothing(&self) -> bool {
        self.of_all <= CONSISTENT
    }
}

/// Forces of an island, the others' left as they are, and what they miss. None: there are none.
fn missed(
    problem: &ContactProblem,
    island: &[usize],
    rows: &[Rows],
    choice: Selection,
    p: &mut [Impulse],
    deadline: Deadline,
) -> Option<Missed> {
    if let [i] = *island
        && let Rows::Normal(edge) = rows[i]
    {
        let block = &problem.blocks[i];
        let k = block.A.row(0).transpose().dot(&edge);
        p[i] = edge * (-block.b.x / k);
        return (k > 0.0).then(Missed::default);
    }
    let unknowns = unknowns(island, rows);
    if unknowns.is_empty() {
        return Some(Missed::default());
    }
    let K = matrix(problem, &unknowns, deadline)?;
    let rhs = right_side(problem, &unknowns);
    let (x, size) = solution(&K, &rhs, choice, deadline)?;
    for (of, x) in unknowns.iter().zip(x.iter()) {
        p[of.block] += of.along * *x;
    }
    let all = amax(&rhs) + K.amax() * amax(&x);
    Some(Missed { size, of_all: if size == 0.0 { 0.0 } else { size / all } })
}

/// The smallest impulses that leave no velocity at any contact. None: there are none.
pub fn stop(problem: &ContactProblem, deadline: Deadline) -> Option<Few<Impulse>> {
    let contacts = problem.blocks.len();
    let (island, rows): (Few<usize>, Few<Rows>) = (0..contacts).map(|i| (i, Rows::All)).unzip();
    let mut p = Few::from_elem(Impulse::zeros(), contacts);
    missed(problem, &island, &rows, Selection::Least, &mut p, deadline)?.is_nothing().then_some(p)
}

/// A force that is looked for, and the equation beside it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unknown {
    pub(super) block: usize,
    /// One unit of it, in the block's frame.
    pub(super) along: Impulse,
    /// The block's row that it is to close.
    pub(super) row: usize,
}

pub(super) fn unknowns(island: &[usize], rows: &[Rows]) -> SmallVec<[Unknown; FEW_UNKNOWNS]> {
    let mut unknowns = SmallVec::new();
    for &block in island {
        match rows[block] {
            // Forces are the smallest as the law has it, with their friction.
            Rows::Normal(along) => unknowns.push(Unknown { block, along: along.normalize(), row: 0 }),
            Rows::All => unknowns.extend((0..3).map(|row| Unknown { block, along: Vector3::ith(row, 1.0), row })),
        }
    }
    unknowns
}

/// What forces are to take from every row.
pub(super) fn right_side(problem: &ContactProblem, unknowns: &[Unknown]) -> Numbers {
    unknowns.iter().map(|of| -problem.blocks[of.block].b[of.row]).collect()
}

/// What every unit does to every row. None: out of time, as it may be large.
pub(super) fn matrix(problem: &ContactProblem, unknowns: &[Unknown], deadline: Deadline) -> Option<Square> {
    let blocks = &problem.blocks;
    let mut K = Square::zeros(unknowns.len());
    for (c, of) in unknowns.iter().enumerate() {
        if deadline.is_over() {
            return None;
        }
        let responses = blocks[of.block].responses(&of.along);
        for (r, row) in unknowns.iter().enumerate() {
            K[(r, c)] = blocks[row.block].row_of(row.row, &blocks[of.block], &responses);
        }
    }
    Some(K)
}

/// Of the right side: what is left of a consistent system.
pub(super) const CONSISTENT: f64 = 1e-9;

/// Roundings of one velocity or place that the sum of a few may be wrong by.
const ROUNDINGS: f64 = 64.0;

/// Part of what is off that may be left where the rest of it is rounding.
const PUT_RIGHT: f64 = 1e-3;

/// Once more for what rounding has left; and what is left then.
pub(super) fn solution(K: &Square, rhs: &[f64], choice: Selection, deadline: Deadline) -> Option<(Numbers, f64)> {
    let left = |x: &[f64]| -> Numbers { rhs.iter().zip(K.times(x)).map(|(rhs, of)| rhs - of).collect() };
    let eliminated = Eliminated::new(K.clone(), deadline)?;
    let mut x = eliminated.solve(rhs, choice)?;
    let mut missed = left(&x);
    if amax(&missed) > 0.0 {
        let again = eliminated.solve(&missed, choice)?;
        x.iter_mut().zip(&again).for_each(|(x, again)| *x += again);
        missed = left(&x);
    }
    Some((x, amax(&missed)))
}
