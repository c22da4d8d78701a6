//! Which contacts hold, which stick and which slide from here on: Signorini's condition and Coulomb's law for
//! accelerations (C. Glocker, Set-Valued Force Laws, 2001).
//!
//! Most often what was there goes on: one linear system and a look at the cones. Else contacts that cannot stick are
//! made to slide against the force that would be needed. Only then the law itself is solved, all contacts at once, by
//! the exact contact solver: with accelerations for velocities it is the same law for contacts that do not slip; one
//! that slips gets so large a fictitious slip that its force is on the edge of the cone.

use super::forces::{Forces, Held, Mode, NO_SLIP, Rows, Slip, direction, edge, meeting_m_s};
use super::touch::{Here, Touch};
use crate::math::full_pivot::Selection;
use crate::model::Model;
use crate::solve::block::Block;
use crate::solve::{Impulse, newton};
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;

/// What is known of a change: these contacts are about to open, these to slip.
#[derive(Clone, Debug, Default)]
pub struct Change {
    /// What slips no faster, sticks if it can.
    pub slow_m_s: f64,
    pub opening: Vec<crate::collide::Key>,
    pub slipping: Vec<(crate::collide::Key, Vector3<f64>)>,
}

#[derive(Clone, Debug)]
pub enum Decision {
    Holds(Vec<Held>),
    /// No force keeps a slip going, and none ends it: an impulse has to (Painlevé).
    Jams,
    Unsolved,
}

/// Of the largest acceleration: what the law's solution leaves.
const ROUNDING: f64 = 1e-10;

/// Of the largest acceleration: less does not tell a direction.
const PLAIN: f64 = 1e-6;

/// Proximal problems of an island before the law is given up.
const MOST: u32 = 200;

/// Fictitious slip over the largest acceleration.
const FAST: f64 = 1e3;

pub fn decide(
    model: &Model,
    state: &State,
    touches: Vec<Touch>,
    change: &Change,
    forces: &mut Forces,
    work: &mut Work,
) -> Decision {
    let touches: Vec<Touch> = touches.into_iter().filter(|touch| !change.opening.contains(&touch.key())).collect();
    if touches.is_empty() {
        return Decision::Holds(Vec::new());
    }
    forces.gather(model, state, touches.iter());
    let slow: Vec<bool> = touches
        .iter()
        .enumerate()
        .map(|(i, touch)| slips(model, state, forces, (i, touch), change.slow_m_s).is_none())
        .collect();
    let young = |i: usize| if slow[i] { Slip::Young } else { Slip::Fast };
    let modes: Vec<Mode> =
        touches.iter().enumerate().map(|(i, touch)| mode(model, state, forces, i, touch, change)).collect();
    work.contact_solves += 1;
    if let [touch] = &touches[..]
        && model.pins.is_empty()
        && let Some(decision) = alone(forces, touch, modes[0], young(0))
    {
        if let Decision::Holds(held) = &decision
            && !held.is_empty()
        {
            forces.hold(held, Selection::Any);
        }
        return decision;
    }
    let hold = |modes: &[Mode]| {
        let held = |(i, mode): (usize, &Mode)| Held { touch: touches[i].clone(), mode: *mode, slip: young(i) };
        Decision::Holds(modes.iter().enumerate().map(held).collect())
    };
    if try_modes(forces, &modes) {
        let failing = failing_sticks(forces, &modes);
        if is_pressing(forces, &modes) && failing.is_empty() {
            return hold(&modes);
        }
        let sliding = made_to_slide(forces, &modes, &failing);
        if try_modes(forces, &sliding) && is_pressing(forces, &sliding) && slide_on(forces, &modes, &sliding) {
            return hold(&sliding);
        }
    }
    by_law(forces, &modes, &touches, &slow, work)
}

/// Of a contact as it moves now.
fn mode(model: &Model, state: &State, forces: &Forces, i: usize, touch: &Touch, change: &Change) -> Mode {
    if touch.friction() == 0.0 {
        return Mode::Slide(Vector3::zeros());
    }
    if let Some((_, d)) = change.slipping.iter().find(|(key, _)| *key == touch.key()) {
        return Mode::Slide(*d);
    }
    slips(model, state, forces, (i, touch), change.slow_m_s).map_or(Mode::Stick, Mode::Slide)
}

/// Along which direction.
fn slips(
    model: &Model,
    state: &State,
    forces: &Forces,
    (i, touch): (usize, &Touch),
    slow_m_s: f64,
) -> Option<Vector3<f64>> {
    let slip = forces.here[i].slip_W();
    let speed = slip.norm();
    (speed > slow_m_s.max(NO_SLIP * meeting_m_s(model, state, touch.bodies()))).then(|| slip / speed)
}

/// One contact has its law solved by hand. None: leave it to the law.
fn alone(forces: &mut Forces, touch: &Touch, mode: Mode, slip: Slip) -> Option<Decision> {
    let holds = |mode: Mode| Some(Decision::Holds(vec![Held { touch: touch.clone(), mode, slip }]));
    let block = forces.problem.blocks[0];
    if block.b.x >= 0.0 {
        return Some(Decision::Holds(Vec::new()));
    }
    match mode {
        Mode::Slide(d) => {
            let k = block.A.row(0).transpose().dot(&edge(block.friction, &block.frame, &d));
            if k > 1e-12 * block.A[(0, 0)] { holds(mode) } else { Some(Decision::Jams) }
        }
        Mode::Stick => {
            let p = -block.A.try_inverse()? * block.b;
            if p.x > 0.0 && p.yz().norm() <= block.friction * p.x {
                return holds(Mode::Stick);
            }
            let p = crate::solve::exact_contact::solve(&block.A, &block.b, &Impulse::zeros(), block.friction);
            let a = block.b + block.A * p;
            let d = block.along_W(&a);
            if p.x <= 0.0 { Some(Decision::Holds(Vec::new())) } else { holds(Mode::Slide(d.try_normalize(0.0)?)) }
        }
    }
}

fn set_rows(forces: &mut Forces, modes: &[Mode]) {
    forces.rows.clear();
    for (mode, block) in modes.iter().zip(&forces.problem.blocks) {
        forces.rows.push(match mode {
            Mode::Stick => Rows::All,
            Mode::Slide(d) => Rows::Normal(edge(block.friction, &block.frame, d)),
        });
    }
    forces.rows.resize(forces.problem.blocks.len(), Rows::All);
}

fn try_modes(forces: &mut Forces, modes: &[Mode]) -> bool {
    set_rows(forces, modes);
    forces.solve(Selection::Least)
}

/// No contact pulls. Of contacts that share a force evenly, none does unless one has to.
fn is_pressing(forces: &Forces, modes: &[Mode]) -> bool {
    let largest = forces.p.iter().map(|p| p.norm()).fold(0.0, f64::max);
    forces.p.iter().take(modes.len()).all(|p| p.x >= -ROUNDING * largest)
}

fn failing_sticks(forces: &Forces, modes: &[Mode]) -> Vec<usize> {
    let outside = |i: &usize| {
        let (p, friction) = (&forces.p[*i], forces.problem.blocks[*i].friction);
        modes[*i] == Mode::Stick && p.yz().norm() > friction * p.x.max(0.0) * (1.0 + ROUNDING)
    };
    (0..modes.len()).filter(outside).collect()
}

/// Those that fail, and with them all that stick on, slide against their force.
fn made_to_slide(forces: &Forces, modes: &[Mode], failing: &[usize]) -> Vec<Mode> {
    let slide = |i: usize| {
        let d = -forces.problem.blocks[i].along_W(&forces.p[i]);
        d.try_normalize(0.0).map_or(Mode::Stick, Mode::Slide)
    };
    let change = |(i, mode): (usize, &Mode)| match mode {
        Mode::Stick if !failing.is_empty() => slide(i),
        _ => *mode,
    };
    modes.iter().enumerate().map(change).collect()
}

/// What has begun to slide does so along its direction.
fn slide_on(forces: &Forces, before: &[Mode], after: &[Mode]) -> bool {
    let largest = forces.problem.blocks.iter().map(|block| block.b.norm()).fold(0.0, f64::max);
    before.iter().zip(after).enumerate().all(|(i, (before, after))| match (before, after) {
        (Mode::Stick, Mode::Slide(d)) => {
            let block = &forces.problem.blocks[i];
            let a = block.velocity(&forces.added);
            let a_W = block.along_W(&a);
            let along = d.dot(&a_W);
            along >= PLAIN * largest && (a_W - d * along).norm() <= ROUNDING * largest
        }
        _ => true,
    })
}

/// The law of all contacts.
fn by_law(forces: &mut Forces, modes: &[Mode], touches: &[Touch], slow: &[bool], work: &mut Work) -> Decision {
    let mut problem = forces.problem.clone();
    let scale = problem.blocks.iter().map(|block| block.b.norm()).fold(0.0, f64::max);
    for (block, mode) in problem.blocks.iter_mut().zip(modes) {
        if let Mode::Slide(d) = mode {
            block.b.y += FAST * scale * d.dot(&block.frame[1]);
            block.b.z += FAST * scale * d.dot(&block.frame[2]);
        }
    }
    let mut p = vec![Impulse::zeros(); problem.blocks.len()];
    if !newton::solve_evenly(&problem, &newton::to_rounding(MOST, forces.deadline), &mut p, work) {
        return Decision::Unsolved;
    }
    forces.problem.response(&p, &mut forces.added);
    let mut held = Vec::new();
    for (i, touch) in touches.iter().enumerate() {
        let block = &forces.problem.blocks[i];
        let a = block.velocity(&forces.added);
        if let Mode::Slide(d) = modes[i]
            && is_stopped(block, &p[i], &a, FAST * scale * d)
        {
            return Decision::Jams;
        }
        if a.x > ROUNDING * scale {
            continue;
        }
        let a_W = block.along_W(&a);
        let mode = match modes[i] {
            // Against its force, which is known to more digits than an acceleration that has just begun.
            Mode::Stick if a_W.norm() > ROUNDING * scale => {
                let p_W = block.along_W(&p[i]);
                Mode::Slide((-p_W).try_normalize(0.0).unwrap_or_else(|| a_W.normalize()))
            }
            mode => mode,
        };
        let slip = if slow[i] { Slip::Young } else { Slip::Fast };
        held.push(Held { touch: touch.clone(), mode, slip });
    }
    forces.p = p;
    Decision::Holds(held)
}

/// Even the fictitious slip.
fn is_stopped(block: &Block, p: &Impulse, a: &Vector3<f64>, slip_W: Vector3<f64>) -> bool {
    let left = Vector3::new(0.0, a.y + slip_W.dot(&block.frame[1]), a.z + slip_W.dot(&block.frame[2]));
    slip_W != Vector3::zeros() && p.x > 0.0 && left.norm() <= 1e-6 * slip_W.norm()
}

/// How far the contacts that hold are from a change, over the largest force: the least normal force, and what is left
/// of the cone of those that stick. Negative: something has changed. Where redundant contacts share forces so that one
/// of them pulls or slips, but could share them otherwise, nothing has.
pub fn margin(model: &Model, state: &State, held: &[Held], forces: &mut Forces, work: &mut Work) -> f64 {
    forces.gather(model, state, held.iter().map(|held| &held.touch));
    if !forces.hold(held, Selection::Least) {
        return -1.0;
    }
    let largest = forces.p.iter().map(|p| p.norm()).fold(0.0, f64::max);
    if largest == 0.0 {
        // Coulomb's law of a young slip does not pull: it lets go.
        let lets_go = forces.problem.blocks.iter().take(held.len()).any(|block| block.b.x > 0.0);
        return if lets_go { -1.0 } else { 0.0 };
    }
    let margin = held.iter().zip(&forces.p).map(|(held, p)| match held.mode {
        Mode::Stick => p.x.min(held.touch.friction() * p.x - p.yz().norm()),
        Mode::Slide(_) => p.x,
    });
    let least = margin.fold(f64::INFINITY, f64::min) / largest;
    if least >= 0.0 || held.len() == 1 {
        return least;
    }
    let mode = |(held, here): (&Held, &Here)| match held.mode {
        Mode::Slide(_) => Mode::Slide(direction(held, here)),
        Mode::Stick => Mode::Stick,
    };
    let modes: Vec<Mode> = held.iter().zip(&forces.here).map(mode).collect();
    let touches: Vec<Touch> = held.iter().map(|held| held.touch.clone()).collect();
    let now = by_law(forces, &modes, &touches, &vec![true; held.len()], work);
    match now {
        // Slightly positive: the true margin is not known.
        Decision::Holds(now)
            if now.len() == held.len() && now.iter().zip(&modes).all(|(now, mode)| now.mode == *mode) =>
        {
            1e-3
        }
        // The forces are now those of the law: which contacts change is seen in them.
        _ => least,
    }
}
