//! Which contacts hold, which stick and which slide from here on: Signorini's condition and Coulomb's law for
//! accelerations (C. Glocker, Set-Valued Force Laws, 2001).
//!
//! Most often what was there goes on: one linear system and a look at the cones. Else contacts that cannot stick are
//! made to slide against the force that would be needed. Only then, and of many contacts at once, the law
//! itself is solved (`law`).

use super::forces::{Gathered, Held, Mode, NO_SLIP, Slip, Solved, edge, meeting_m_s};
use super::last_forces::LastForces;
use super::law::{Law, MANY, ROUNDING, by_law, goes_on};
use super::shares::lawful_shares;
use super::slip;
use super::touch::Touch;
use crate::collide::Key;
use crate::math::few::Few;
use crate::math::full_pivot::Selection;
use crate::model::Model;
use crate::solve::block::Block;
use crate::solve::twist::Twist;
use crate::solve::{Impulse, exact_contact};
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;

/// What is known of a change: these contacts are about to open, where they are, these to slip.
#[derive(Clone, Debug, Default)]
pub struct Change {
    /// What slips no faster, sticks if it can.
    pub slow_m_s: f64,
    /// However slowly, what slips has not come to its end.
    pub slips_on: bool,
    pub opening: Vec<(Key, Vector3<f64>)>,
    /// These have begun to open a moment before, and go on if nothing brings them back.
    pub opened: Vec<(Key, Vector3<f64>)>,
    pub slipping: Vec<(Key, Vector3<f64>)>,
}

#[derive(Clone, Debug)]
pub enum Decision {
    /// These, with their forces.
    Holds(Vec<Held>, Box<Solved>),
    /// No force keeps a slip going, and none ends it: an impulse has to (Painlevé).
    Jams,
    Unsolved,
}

/// An acceleration that tells a direction, relative to the largest.
const PLAIN: f64 = 1e-6;

/// A force along the edge of the cone accelerates its own contact by more than this part of its normal element of A, or
/// nothing keeps the slip going: what is less is rounding of their difference.
const KEEPS_ON: f64 = 1e-12;

/// Of a body's size: points that are nearer to each other are one.
pub const SAME: f64 = 1e-6;

/// A pull, or a force outside of its cone, relative to the largest: more is no rounding.
pub const PULL: f64 = -1e-11;

/// A margin that is not known, over the largest force: slightly positive, as redundant contacts could share otherwise.
const NOT_KNOWN: f64 = 1e-3;

pub fn decide(
    model: &Model,
    state: &State,
    touches: Vec<Touch>,
    change: &Change,
    gathered: &mut Gathered,
    work: &mut Work,
) -> Decision {
    // What has come to be touched in the meantime may have the name of what opens, where outlines cross, and what opens
    // another one.
    let opens = |touch: &Touch, places: &[(Key, Vector3<f64>)]| {
        let (body, other, _) = touch.key();
        let near_m = SAME * model.bodies[body].bounding_radius_m;
        let is_there = |place: &Vector3<f64>| (touch.here(state).contact.p_WC - place).norm() <= near_m;
        let is_it = |(key, place): &(Key, Vector3<f64>)| match other {
            None => *key == touch.key(),
            Some(_) => (key.0, key.1) == (body, other) && is_there(place),
        };
        places.iter().any(is_it)
    };
    let opens_now: Vec<bool> = touches.iter().map(|touch| opens(touch, &change.opening)).collect();
    let opened = touches.iter().map(|touch| opens(touch, &change.opened));
    let mut opening: Vec<bool> = opens_now.iter().zip(opened).map(|(now, before)| *now || before).collect();
    let decide_now = |opening: &[bool], gathered: &mut Gathered, work: &mut Work| {
        let left = touches.iter().zip(opening).filter(|(_, opens)| !**opens).map(|(touch, _)| touch.clone());
        decide_all((model, state), left.collect(), change, gathered, work)
    };
    loop {
        let decision = decide_now(&opening, gathered, work);
        // Of several that carry nothing, not all of them may leave at once, but the last one does.
        let is_last = opens_now.iter().zip(&opening).filter(|(now, opens)| **now && **opens).count() == 1;
        let may = |i: &usize| opening[*i] && !(is_last && opens_now[*i]);
        let leaving: Vec<usize> = (0..touches.len()).filter(may).collect();
        let comes_back = match &decision {
            Decision::Holds(_, solved) if !leaving.is_empty() => {
                first_closing((model, state), &touches, leaving, (gathered, solved))
            }
            _ => None,
        };
        match comes_back {
            Some(i) => opening[i] = false,
            None => return decision,
        }
    }
}

/// Of the largest acceleration without contact: a contact that opens does not come nearer.
const COMES_BACK: f64 = 1e-9;

/// The one that comes nearer the fastest, of contacts that should open, by the forces of the others.
fn first_closing(
    (model, state): (&Model, &State),
    touches: &[Touch],
    of: Vec<usize>,
    (gathered, solved): (&Gathered, &Solved),
) -> Option<usize> {
    let mut own = Gathered::until(gathered.deadline);
    own.gather(model, state, of.iter().map(|i| &touches[*i]));
    let mut added = solved.added.clone();
    added.resize(model.bodies.len(), Twist::ZERO);
    let scale = own.free.iter().map(|free| free.v.norm()).fold(0.0, f64::max);
    let closes = |(i, block): (&usize, &Block)| (*i, block.velocity(&added).x);
    let fastest = of.iter().zip(&own.problem.blocks).map(closes).min_by(|a, b| a.1.total_cmp(&b.1))?;
    (fastest.1 < -COMES_BACK * scale).then_some(fastest.0)
}

/// Of all of these.
fn decide_all(
    (model, state): (&Model, &State),
    touches: Vec<Touch>,
    change: &Change,
    gathered: &mut Gathered,
    work: &mut Work,
) -> Decision {
    if touches.is_empty() {
        return Decision::Holds(Vec::new(), Box::default());
    }
    gathered.gather(model, state, touches.iter());
    if gathered.islands.len() == 1 || !model.pins.is_empty() {
        return decide_island((model, state), touches, change, gathered, work);
    }
    let islands = gathered.islands.clone();
    let mut own = Gathered::until(gathered.deadline);
    let mut p = vec![Impulse::zeros(); touches.len()];
    let mut all: Vec<(usize, Held)> = Vec::new();
    for island in &islands {
        let here: Vec<Touch> = island.iter().map(|i| touches[*i].clone()).collect();
        own.gather(model, state, here.iter());
        match decide_island((model, state), here, change, &own, work) {
            Decision::Holds(held, solved) => {
                island.iter().zip(&solved.p).for_each(|(i, of)| p[*i] = *of);
                let place = |held: &Held| island.iter().copied().find(|i| touches[*i].key() == held.touch.key());
                all.extend(held.into_iter().filter_map(|held| Some((place(&held)?, held))));
            }
            other => return other,
        }
    }
    all.sort_by_key(|(place, _)| *place);
    Decision::Holds(all.into_iter().map(|(_, held)| held).collect(), Box::new(gathered.solved(p, true)))
}

/// Of contacts that share bodies: the others do not matter to them.
fn decide_island(
    (model, state): (&Model, &State),
    touches: Vec<Touch>,
    change: &Change,
    gathered: &Gathered,
    work: &mut Work,
) -> Decision {
    let slow: Vec<bool> = touches
        .iter()
        .enumerate()
        .map(|(i, touch)| slips(model, state, gathered, (i, touch), change.slow_m_s).is_none())
        .collect();
    let young = |i: usize| if slow[i] { slip::young(model, state, &touches[i]) } else { Slip::Fast };
    let modes: Vec<Mode> =
        touches.iter().enumerate().map(|(i, touch)| mode(model, state, gathered, i, touch, change)).collect();
    work.contact_solves += 1;
    if let [touch] = &touches[..]
        && model.pins.is_empty()
        && let Some(alone) = alone(gathered, modes[0])
    {
        return match alone {
            Alone::Holds(mode) => {
                let held = Held { touch: touch.clone(), mode, slip: young(0) };
                let solved = gathered.hold(std::slice::from_ref(&held), Selection::Any);
                Decision::Holds(vec![held], Box::new(solved))
            }
            Alone::Leaves => Decision::Holds(Vec::new(), Box::default()),
            Alone::Jams => Decision::Jams,
        };
    }
    let hold = |modes: &mut dyn Iterator<Item = (usize, Mode)>, solved: Solved| {
        let held = |(i, mode): (usize, Mode)| Held { touch: touches[i].clone(), mode, slip: young(i) };
        let mut held: Vec<Held> = modes.map(held).collect();
        let aligned = if held.len() == touches.len() { slip::align(gathered, &mut held) } else { None };
        Decision::Holds(held, Box::new(aligned.unwrap_or(solved)))
    };
    if touches.len() <= MANY
        && let Some((modes, solved)) = goes_on_or_slides(gathered, &modes, work)
    {
        return hold(&mut modes.into_iter().enumerate(), solved);
    }
    match by_law(gathered, &modes, work) {
        Law::Holds(now, solved) => hold(&mut now.into_iter(), *solved),
        Law::Jams => Decision::Jams,
        Law::Unsolved => Decision::Unsolved,
    }
}

/// Of a contact as it moves now.
fn mode(model: &Model, state: &State, gathered: &Gathered, i: usize, touch: &Touch, change: &Change) -> Mode {
    if touch.friction() == 0.0 {
        return Mode::Slide(Vector3::zeros());
    }
    if let Some((_, d)) = change.slipping.iter().find(|(key, _)| *key == touch.key()) {
        return Mode::Slide(*d);
    }
    slips(model, state, gathered, (i, touch), change.slow_m_s).map_or(Mode::Stick, Mode::Slide)
}

/// Along which direction.
fn slips(
    model: &Model,
    state: &State,
    gathered: &Gathered,
    (i, touch): (usize, &Touch),
    slow_m_s: f64,
) -> Option<Vector3<f64>> {
    let slip = gathered.here[i].slip_W();
    let speed = slip.norm();
    (speed > slow_m_s.max(NO_SLIP * meeting_m_s(model, state, touch.bodies()))).then(|| slip / speed)
}

/// What one contact does.
enum Alone {
    Holds(Mode),
    Leaves,
    Jams,
}

/// One contact has its law solved by hand. None: leave it to the law.
fn alone(gathered: &Gathered, mode: Mode) -> Option<Alone> {
    let block = &gathered.problem.blocks[0];
    if block.b.x >= 0.0 {
        return Some(Alone::Leaves);
    }
    match mode {
        Mode::Slide(d) => {
            let k = block.A.row(0).transpose().dot(&edge(block.friction, &block.frame, &d));
            if k > KEEPS_ON * block.A[(0, 0)] { Some(Alone::Holds(mode)) } else { Some(Alone::Jams) }
        }
        Mode::Stick => {
            let p = -block.A.try_inverse()? * block.b;
            if p.x > 0.0 && p.yz().norm() <= block.friction * p.x {
                return Some(Alone::Holds(Mode::Stick));
            }
            let p = exact_contact::solve(&block.A, &block.b, &Impulse::zeros(), block.friction);
            let a = block.b + block.A * p;
            let d = block.along_W(&a);
            if p.x <= 0.0 { Some(Alone::Leaves) } else { Some(Alone::Holds(Mode::Slide(d.try_normalize(0.0)?))) }
        }
    }
}

/// What was there, if it goes on, or slides where it fails; with its forces.
fn goes_on_or_slides(gathered: &Gathered, modes: &[Mode], work: &mut Work) -> Option<(Vec<Mode>, Solved)> {
    let share = |modes: &[Mode]| gathered.hold_as(modes.iter().copied(), Selection::Least);
    let as_it_was = share(modes);
    if !as_it_was.holds {
        return None;
    }
    let failing = failing_sticks(gathered, &as_it_was, modes);
    if is_pressing(&as_it_was, modes) && failing.is_empty() {
        return Some((modes.to_vec(), as_it_was));
    }
    if let Some(solved) = lawful_shares(gathered, modes, &as_it_was, work) {
        return Some((modes.to_vec(), solved));
    }
    let sliding = made_to_slide(gathered, &as_it_was, modes, &failing);
    let solved = share(&sliding);
    let holds = solved.holds && is_pressing(&solved, &sliding) && slide_on(gathered, &solved, modes, &sliding);
    holds.then_some((sliding, solved))
}

/// No contact pulls. Of contacts that share a force evenly, none does unless one has to.
fn is_pressing(solved: &Solved, modes: &[Mode]) -> bool {
    let largest = solved.largest();
    solved.p.iter().take(modes.len()).all(|p| p.x >= -ROUNDING * largest)
}

fn failing_sticks(gathered: &Gathered, solved: &Solved, modes: &[Mode]) -> Vec<usize> {
    let outside = |i: &usize| {
        let (p, friction) = (&solved.p[*i], gathered.problem.blocks[*i].friction);
        modes[*i] == Mode::Stick && p.yz().norm() > friction * p.x.max(0.0) * (1.0 + ROUNDING)
    };
    (0..modes.len()).filter(outside).collect()
}

/// Those that fail, and with them all that stick on, slide against their force.
fn made_to_slide(gathered: &Gathered, solved: &Solved, modes: &[Mode], failing: &[usize]) -> Vec<Mode> {
    let slide = |i: usize| {
        let d = -gathered.problem.blocks[i].along_W(&solved.p[i]);
        d.try_normalize(0.0).map_or(Mode::Stick, Mode::Slide)
    };
    let change = |(i, mode): (usize, &Mode)| match mode {
        Mode::Stick if !failing.is_empty() => slide(i),
        _ => *mode,
    };
    modes.iter().enumerate().map(change).collect()
}

/// What has begun to slide does so along its direction.
fn slide_on(gathered: &Gathered, solved: &Solved, before: &[Mode], after: &[Mode]) -> bool {
    let largest = gathered.scale();
    before.iter().zip(after).enumerate().all(|(i, (before, after))| match (before, after) {
        (Mode::Stick, Mode::Slide(d)) => {
            let block = &gathered.problem.blocks[i];
            let a = block.velocity(&solved.added);
            let a_W = block.along_W(&a);
            let along = d.dot(&a_W);
            along >= PLAIN * largest && (a_W - d * along).norm() <= ROUNDING * largest
        }
        _ => true,
    })
}

/// How far the contacts that hold are from a change.
pub struct Margin {
    /// Over the largest force: the least normal force, and what is left of the cone of those that stick. Negative:
    /// something has changed. Where redundant contacts share forces so that one of them pulls or slips, but could share
    /// them otherwise, nothing has.
    pub least: f64,
    /// Forces there: those of the law, where it says which contacts change.
    pub solved: Solved,
}

/// Of what holds in a state, which is gathered; `last`: forces of the last look at it.
pub fn margin(
    model: &Model,
    state: &State,
    held: &[Held],
    (gathered, last): (&mut Gathered, &mut LastForces),
    work: &mut Work,
) -> Margin {
    margin_by(model, state, held, (gathered, last), (AskedOf::Law, work))
}

/// Who says of redundant contacts whether they go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AskedOf {
    Law,
    /// Without the law, which is asked only where something seems to change: what seems not to change does not.
    Modes,
}

/// The same, asked so.
pub fn margin_by(
    model: &Model,
    state: &State,
    held: &[Held],
    (gathered, last): (&mut Gathered, &mut LastForces),
    (asked, work): (AskedOf, &mut Work),
) -> Margin {
    gathered.gather(model, state, held.iter().map(|held| &held.touch));
    if held.len() > MANY {
        let modes: Vec<Mode> = gathered.modes(held).collect();
        return by_law_alone(gathered, &modes, work);
    }
    let solved = gathered.hold(held, Selection::Least);
    if !solved.holds {
        return Margin { least: -1.0, solved };
    }
    let largest = solved.largest();
    if largest == 0.0 {
        return Margin { least: 0.0, solved };
    }
    let of = |i: usize| left_of(&held[i], &solved.p[i]);
    let all = (0..held.len()).map(of).fold(f64::INFINITY, f64::min) / largest;
    if all >= PULL || held.len() == 1 {
        return Margin { least: all, solved };
    }
    let least_of = |island: &[usize]| island.iter().copied().map(of).fold(f64::INFINITY, f64::min) / largest;
    let mut least = f64::INFINITY;
    let mut p = solved.p.clone();
    for island in &gathered.islands {
        let own: Vec<usize> = island.iter().copied().filter(|i| *i < held.len()).collect();
        let of_own = least_of(&own);
        let mut ask = || {
            if let Some(p) = last.go_on(held, gathered, &own, work) {
                let left = least_left(own.iter().map(|i| (&held[*i], &p[*i])));
                return Some((own.iter().map(|i| p[*i]).collect(), left));
            }
            let surely_changes = || surely_changes(held, gathered, (island, &own), &solved);
            (asked == AskedOf::Law && !surely_changes()).then(|| law_of(model, state, held, &own, gathered, work))?
        };
        let law = if of_own < PULL && own.len() > 1 { ask() } else { None };
        if let Some((p, left)) = &law
            && *left >= 0.0
        {
            last.note(gathered, held.len(), &own, p);
        }
        least = least.min(law.as_ref().map_or(of_own, |(_, left)| *left));
        law.iter().for_each(|(of, _)| own.iter().zip(of).for_each(|(i, of)| p[*i] = *of));
    }
    if p == solved.p {
        return Margin { least, solved };
    }
    Margin { least, solved: gathered.solved(p, true) }
}

/// Whether some contact of an island pulls, or is outside of its cone, however these share their forces.
fn surely_changes(held: &[Held], gathered: &Gathered, (island, own): (&[usize], &[usize]), solved: &Solved) -> bool {
    let least = PULL * solved.largest();
    let known = gathered.known(held, island);
    let changes = |i: &usize| {
        let (p, [normal, all]) = (&solved.p[*i], known[island.iter().position(|block| block == i)?]);
        let slips = held[*i].mode == Mode::Stick && held[*i].touch.friction() * p.x - p.yz().norm() < least;
        Some((normal && p.x < least) || (all && slips))
    };
    own.iter().any(|i| changes(i) == Some(true))
}

/// Forces by the law of contacts that share bodies, and how far they are from a change: the least force that presses
/// and has not come to the edge of its cone, over the largest; where some do not go on, the largest acceleration of
/// those, over the largest without contact, and negative. None: it is not solved.
fn law_of(
    model: &Model,
    state: &State,
    held: &[Held],
    island: &[usize],
    gathered: &Gathered,
    work: &mut Work,
) -> Option<(Few<Impulse>, f64)> {
    let part: Vec<Held> = island.iter().map(|i| held[*i].clone()).collect();
    let mut own = Gathered::until(gathered.deadline);
    own.gather(model, state, part.iter().map(|held| &held.touch));
    let modes: Vec<Mode> = own.modes(&part).collect();
    let shared = own.hold_as(modes.iter().copied(), Selection::Least);
    if let Some(solved) = lawful_shares(&own, &modes, &shared, work) {
        let left = least_left(part.iter().zip(&solved.p));
        return Some((solved.p, left));
    }
    let Law::Holds(now, solved) = by_law(&own, &modes, work) else { return None };
    let left = if goes_on(&now, &modes) {
        least_left(part.iter().zip(&solved.p))
    } else {
        -leaves(&own, &modes, &now, &solved)
    };
    Some((solved.p, left))
}

/// Of what presses, and of the cone of what sticks.
fn left_of(held: &Held, p: &Impulse) -> f64 {
    match held.mode {
        Mode::Stick => p.x.min(held.touch.friction() * p.x - p.yz().norm()),
        Mode::Slide(_) => p.x,
    }
}

/// Of contacts that go on; not negative.
fn least_left<'a>(held: impl Iterator<Item = (&'a Held, &'a Impulse)>) -> f64 {
    let (mut least, mut largest) = (f64::INFINITY, f64::MIN_POSITIVE);
    for (held, p) in held {
        (least, largest) = (least.min(left_of(held, p)), largest.max(p.norm()));
    }
    (least / largest).clamp(0.0, NOT_KNOWN)
}

/// Of contacts that do not go on: how fast they open or begin to slip. At least what is no rounding.
fn leaves(gathered: &Gathered, modes: &[Mode], now: &[(usize, Mode)], solved: &Solved) -> f64 {
    let of = |(i, (mode, block)): (usize, (&Mode, &Block))| {
        let a = block.velocity(&solved.added);
        match now.iter().find(|(k, _)| *k == i) {
            None => a.x,
            Some((_, after)) if after != mode => a.yz().norm(),
            Some(_) => 0.0,
        }
    };
    let largest = modes.iter().zip(&gathered.problem.blocks).enumerate().map(of).fold(0.0, f64::max);
    (largest / gathered.scale().max(f64::MIN_POSITIVE)).max(ROUNDING)
}

/// Of many contacts only whether they go on.
fn by_law_alone(gathered: &Gathered, modes: &[Mode], work: &mut Work) -> Margin {
    match by_law(gathered, modes, work) {
        Law::Holds(now, solved) => {
            Margin { least: if goes_on(&now, modes) { NOT_KNOWN } else { -1.0 }, solved: *solved }
        }
        Law::Jams | Law::Unsolved => Margin { least: -1.0, solved: gathered.without_forces() },
    }
}
