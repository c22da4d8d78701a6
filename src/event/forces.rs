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
use crate::math::full_pivot::{Eliminated, Selection};
use crate::model::{Body, Model};
use crate::solve::Impulse;
use crate::solve::block::Block;
use crate::solve::pins::{self, Pin, PinEnd};
use crate::solve::problem::ContactProblem;
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use nalgebra::{DMatrix, DVector, Vector3};

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
enum Rows {
    None,
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
    pub p: Vec<Impulse>,
    /// Of every body, by the forces.
    pub added: Vec<Twist>,
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

/// Contacts that share bodies: of more, to leave out one after another of those that pull costs more than the law.
const FEW: usize = 8;

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
        let mut of_body: Vec<usize> = (0..model.bodies.len()).collect();
        fn root(of_body: &[usize], mut i: usize) -> usize {
            while of_body[i] != i {
                i = of_body[i];
            }
            i
        }
        let moved = |block: &Block| {
            let bodies: Vec<usize> = block.ends().map(|end| end.body).filter(|i| !model.bodies[*i].driven).collect();
            bodies
        };
        for block in &self.problem.blocks {
            if let [a, b] = moved(block)[..] {
                let [a, b] = [a, b].map(|i| root(&of_body, i));
                of_body[a.max(b)] = a.min(b);
            }
        }
        self.islands.clear();
        let mut place = vec![None; model.bodies.len()];
        for (k, block) in self.problem.blocks.iter().enumerate() {
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
        if choice == Selection::Any || !solved.holds { solved } else { self.push_only(rows, solved, contacts) }
    }

    /// Forces of these modes, and of all pins, each contact pulling as it may.
    pub fn try_modes(&self, modes: &[Mode]) -> Solved {
        self.solve(&self.rows(modes.iter().copied()), Selection::Least)
    }

    /// Changes of velocity that leave none along the rows that hold; none: there is not more than `least`.
    pub fn stop(&self, held: &[Held], least: f64) -> Option<Solved> {
        let rows = self.rows(self.modes(held));
        let off = |(block, rows): (&Block, &Rows)| match rows {
            Rows::None => 0.0,
            Rows::Normal(_) => block.b.x.abs(),
            Rows::All => block.b.amax(),
        };
        let largest = self.problem.blocks.iter().zip(&rows).map(off).fold(0.0, f64::max);
        (largest > least).then(|| self.solve(&rows, Selection::Any))
    }

    /// Displacements that close b, of so many contacts along their normals, of pins whole.
    pub fn close(&self, contacts: usize) -> Solved {
        let mut rows = vec![Rows::Normal(Vector3::x()); contacts];
        rows.resize(self.problem.blocks.len(), Rows::All);
        self.solve(&rows, Selection::Any)
    }

    /// Modes of what is held, slips along what they are now.
    pub fn modes<'a>(&'a self, held: &'a [Held]) -> impl ExactSizeIterator<Item = Mode> + 'a {
        held.iter().zip(&self.here).map(|(held, here)| match held.mode {
            Mode::Stick => Mode::Stick,
            Mode::Slide(_) => Mode::Slide(direction(held, here)),
        })
    }

    /// What the blocks' forces may be: of contacts by their modes, of pins all.
    fn rows(&self, modes: impl Iterator<Item = Mode>) -> Vec<Rows> {
        let of = |(mode, block): (Mode, &Block)| match mode {
            Mode::Stick => Rows::All,
            Mode::Slide(d) => Rows::Normal(edge(block.friction, &block.frame, &d)),
        };
        let mut rows: Vec<Rows> = modes.zip(&self.problem.blocks).map(of).collect();
        rows.resize(self.problem.blocks.len(), Rows::All);
        rows
    }

    /// Of contacts that share forces, those that would pull are left out as long as the others can hold them: which of
    /// them press decides how a slab that spins is slowed. Each island by itself.
    fn push_only(&self, rows: Vec<Rows>, mut all: Solved, contacts: usize) -> Solved {
        let mut changed = false;
        for island in &self.islands {
            let own: Vec<usize> = island.iter().copied().filter(|i| *i < contacts).collect();
            let slides = |i: &usize| matches!(rows[*i], Rows::Normal(edge) if edge != Vector3::x());
            // However contacts share forces that none of them slides by, the motion is the same.
            let matters = own.len() <= FEW || own.iter().any(slides);
            if matters
                && own.iter().any(|i| all.p[*i].x < 0.0)
                && let Some(p) = self.push_only_of(island, &own, &rows, &all)
            {
                island.iter().for_each(|i| all.p[*i] = p[*i]);
                changed = true;
            }
        }
        if changed { self.solved(all.p, true) } else { all }
    }

    /// None: the others cannot hold them.
    fn push_only_of(&self, island: &[usize], own: &[usize], rows: &[Rows], all: &Solved) -> Option<Vec<Impulse>> {
        let scale = island.iter().map(|i| self.problem.blocks[*i].b.norm()).fold(0.0, f64::max);
        let mut rows = rows.to_vec();
        let mut p = all.p.clone();
        for _ in own {
            let worst = own.iter().copied().min_by(|a, b| p[*a].x.total_cmp(&p[*b].x))?;
            if p[worst].x >= 0.0 {
                break;
            }
            rows[worst] = Rows::None;
            p = vec![Impulse::zeros(); self.problem.blocks.len()];
            let holds = solve(&self.problem, island, &rows, Selection::Least, &mut p, self.deadline);
            let now = self.solved(p, holds);
            let lifts = |i: &usize| self.problem.blocks[*i].velocity(&now.added).x.abs() > CONSISTENT * scale;
            if !now.holds || own.iter().any(lifts) {
                return None;
            }
            p = now.p;
        }
        Some(p)
    }

    fn solve(&self, rows: &[Rows], choice: Selection) -> Solved {
        let mut p = vec![Impulse::zeros(); self.problem.blocks.len()];
        let mut holds = true;
        for island in &self.islands {
            holds &= solve(&self.problem, island, rows, choice, &mut p, self.deadline);
        }
        self.solved(p, holds)
    }

    /// No solution.
    pub fn without_forces(&self) -> Solved {
        self.solved(vec![Impulse::zeros(); self.problem.blocks.len()], false)
    }

    /// What forces do.
    pub fn solved(&self, p: Vec<Impulse>, holds: bool) -> Solved {
        let mut added = Vec::new();
        self.problem.response(&p, &mut added);
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

/// Forces of an island; the others' are left as they are.
fn solve(
    problem: &ContactProblem,
    island: &[usize],
    rows: &[Rows],
    choice: Selection,
    p: &mut [Impulse],
    deadline: Deadline,
) -> bool {
    if let [i] = *island
        && let Rows::Normal(edge) = rows[i]
    {
        let block = &problem.blocks[i];
        let k = block.A.row(0).transpose().dot(&edge);
        p[i] = edge * (-block.b.x / k);
        return k > 0.0;
    }
    // Unknowns: which block, and the force of one unit of it; equations: which row.
    let mut unknowns: Vec<(usize, Vector3<f64>, usize)> = Vec::new();
    for &i in island {
        match rows[i] {
            Rows::None => {}
            Rows::Normal(edge) => unknowns.push((i, edge, 0)),
            Rows::All => unknowns.extend((0..3).map(|k| (i, Vector3::ith(k, 1.0), k))),
        }
    }
    let n = unknowns.len();
    if n == 0 {
        return true;
    }
    // The matrix alone may be large.
    if deadline.is_over() {
        return false;
    }
    let mut K = DMatrix::zeros(n, n);
    for (r, (i, _, k)) in unknowns.iter().enumerate() {
        if deadline.is_over() {
            return false;
        }
        for (c, (j, along, _)) in unknowns.iter().enumerate() {
            K[(r, c)] = problem.coupling(*i, *j).row(*k).transpose().dot(along);
        }
    }
    let rhs = DVector::from_iterator(n, unknowns.iter().map(|(i, _, k)| -problem.blocks[*i].b[*k]));
    let Some(x) = solution(&K, &rhs, choice, deadline) else { return false };
    for ((i, along, _), x) in unknowns.iter().zip(x.iter()) {
        p[*i] += along * *x;
    }
    let missed = (&K * &x - &rhs).amax();
    missed <= CONSISTENT * (rhs.amax() + K.amax() * x.amax())
}

/// Of the right side: what is left of a consistent system.
const CONSISTENT: f64 = 1e-9;

/// Once more for what rounding has left.
fn solution(K: &DMatrix<f64>, rhs: &DVector<f64>, choice: Selection, deadline: Deadline) -> Option<DVector<f64>> {
    let eliminated = Eliminated::new(K.clone(), deadline)?;
    let x = eliminated.solve(rhs, choice)?;
    let again = eliminated.solve(&(rhs - K * &x), choice)?;
    Some(x + again)
}
