//! How bodies move once it is known what holds: which have a closed form, and until when.

use super::forces::{Gathered, Held, NO_SLIP, Solved};
use super::motion::{ClosedMotion, Motion};
use crate::exact::arc::Arc;
use crate::experiment::types::Skip;
use crate::model::Model;
use crate::solve::block::Block;
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// Of the acceleration without contact: what is less is none.
const NONE: f64 = 1e-11;

/// What is gathered, and its forces.
#[derive(Clone, Copy)]
pub struct Forces<'a> {
    pub gathered: &'a Gathered,
    pub solved: &'a Solved,
}

/// Fills `motions`; what rests is put to rest to the last bit. When the first slip of a closed form ends.
/// `forces`: of what is held, at this state.
pub fn settle(
    model: &Model,
    state: &mut State,
    held: &[Held],
    forces: Forces,
    motions: &mut Vec<Motion>,
) -> Option<f64> {
    let bodies = if held.is_empty() { 0 } else { model.bodies.len() };
    let resting: Vec<bool> = (0..bodies).map(|i| is_at_rest(model, state, i, held, forces)).collect();
    let is_closed = model.skips.has(Skip::ClosedForms);
    let mut settling = Settling { model, held, forces, resting: &resting, ends_s: f64::INFINITY, is_closed };
    motions.clear();
    let mut dense = 0;
    for i in 0..model.bodies.len() {
        motions.push(settling.closed(state, i).map_or(Motion::Dense(dense), Motion::Closed));
        dense += usize::from(matches!(motions[i], Motion::Dense(_)));
    }
    Some(settling.ends_s).filter(|ends_s| ends_s.is_finite())
}

fn is_at_rest(model: &Model, state: &State, i: usize, held: &[Held], forces: Forces) -> bool {
    let (body, at) = (&model.bodies[i], &state.bodies[i]);
    let a = forces.solved.acceleration(forces.gathered, i);
    let arms_m = model.pins.iter().filter(|pin| pin.body == i).map(|pin| pin.r_B.norm());
    let (radius_m, fall) = (arms_m.fold(body.bounding_radius_m, f64::max), model.gravity_m_s2.norm());
    let still = at.v_WB.norm() + radius_m * at.w_WB.norm() <= NO_SLIP * (fall * radius_m).sqrt();
    let left = a.v.norm() + radius_m * a.w.norm();
    let none = NONE * forces.gathered.free[i].v.norm();
    let is_rounding = || left <= rounding_m_s2(model, i, forces) && !slips_off(i, held, forces, none);
    let stays = || left <= none || is_rounding();
    still && (body.driven || (stays() && model.constant_pull(i).is_some()))
}

/// Whether a body begins to slip faster than that where nothing grips.
fn slips_off(i: usize, held: &[Held], Forces { gathered, solved }: Forces, none: f64) -> bool {
    let slips = |(held, block): (&Held, &Block)| {
        let grips = block.friction > 0.0 && held.slides().is_none();
        !grips && block.ends().any(|end| end.body == i) && block.velocity(&solved.added).yz().norm() > none
    };
    held.iter().zip(&gathered.problem.blocks).any(slips)
}

/// Acceleration of a body that the rounding of all forces of its island may leave, though they cancel: what is light
/// under what is heavy.
fn rounding_m_s2(model: &Model, i: usize, Forces { gathered, solved }: Forces) -> f64 {
    let blocks = &gathered.problem.blocks;
    let is_own = |block: &usize| blocks[*block].ends().any(|end| end.body == i);
    let Some(island) = gathered.islands.iter().find(|island| island.iter().any(is_own)) else { return 0.0 };
    let gives = |k: &usize| {
        let compliance_1_kg = blocks[*k].ends().map(|end| model.bodies[end.body].compliance_1_kg()).sum::<f64>();
        compliance_1_kg * solved.p.get(*k).map_or(0.0, |p| p.norm())
    };
    f64::EPSILON * island.iter().map(gives).sum::<f64>()
}

struct Settling<'a> {
    model: &'a Model,
    held: &'a [Held],
    forces: Forces<'a>,
    resting: &'a [bool],
    ends_s: f64,
    /// Whether motions that have a closed form take it; what rests does in any case.
    is_closed: bool,
}

impl Settling<'_> {
    /// None: there is no closed form of it.
    fn closed(&mut self, state: &mut State, i: usize) -> Option<ClosedMotion> {
        let (body, at) = (&self.model.bodies[i], state.bodies[i]);
        if body.driven {
            return Some(ClosedMotion::Driven(state.time_s, at));
        }
        if self.model.pins.iter().any(|pin| pin.holds(i)) {
            return self
                .rests_on_pins(i, &at)
                .then(|| ClosedMotion::Arc(Arc::straight(state.time_s, at, Vector3::zeros())));
        }
        let pull = self.model.constant_pull(i)?;
        let own = || self.held.iter().enumerate().filter(move |(_, held)| held.touch.bodies().any(|b| b == i));
        if own().next().is_none() {
            return self.is_closed.then(|| ClosedMotion::free(body, state.time_s, &at, pull));
        }
        let all_others =
            |rest: &dyn Fn(usize) -> bool| own().all(|(_, held)| held.touch.bodies().all(|b| b == i || rest(b)));
        if self.resting[i] && all_others(&|b| self.resting[b]) {
            state.bodies[i].v_WB = Vector3::zeros();
            state.bodies[i].w_WB = Vector3::zeros();
            return Some(ClosedMotion::Arc(Arc::straight(state.time_s, state.bodies[i], Vector3::zeros())));
        }
        if !all_others(&|b| self.model.bodies[b].driven && self.resting[b]) {
            return None;
        }
        if !self.is_closed || !own().all(|(_, held)| held.touch.is_on_plane(i)) {
            return None;
        }
        let own: Vec<usize> = own().map(|(k, _)| k).collect();
        self.steady(state, i, &own).map(ClosedMotion::Arc)
    }

    /// Whether a body on pins is at rest to the last bit, and with it all that it touches and that pins join to it.
    fn rests_on_pins(&self, i: usize, at: &BodyState) -> bool {
        let is_still = at.v_WB == Vector3::zeros() && at.w_WB == Vector3::zeros();
        let pins = || self.model.pins.iter().filter(|pin| pin.holds(i));
        let turns = self.model.bodies[i].bounding_radius_m == 0.0 && pins().all(|pin| pin.r_B == Vector3::zeros());
        let touched = self.held.iter().filter(|held| held.touch.bodies().any(|b| b == i));
        let others = touched.flat_map(|held| held.touch.bodies());
        let joined = pins().flat_map(|pin| (0..self.resting.len()).filter(|b| pin.holds(*b)));
        is_still && !turns && !self.resting.is_empty() && others.chain(joined).all(|b| self.resting[b])
    }

    /// A ball, or a body that does not turn, on what does not move, and every slip keeps its direction: all forces are
    /// constant.
    fn steady(&mut self, state: &mut State, i: usize, own: &[usize]) -> Option<Arc> {
        let body = &self.model.bodies[i];
        let (radius_m, scale) = (body.bounding_radius_m, self.forces.gathered.free[i].v.norm());
        let Twist { v: a, w: mut alpha } = self.forces.solved.acceleration(self.forces.gathered, i);
        let at = &mut state.bodies[i];
        if !body.is_centred_ball() {
            let turning = at.w_WB.norm() * radius_m > NO_SLIP * (at.v_WB.norm() + (scale * radius_m).sqrt());
            if turning || alpha.norm() * radius_m > NONE * scale {
                return None;
            }
            at.w_WB = Vector3::zeros();
            alpha = Vector3::zeros();
        }
        let mut ends_s = f64::INFINITY;
        for k in own {
            let (here, block) = (&self.forces.gathered.here[*k], &self.forces.gathered.problem.blocks[*k]);
            let Some(d) = self.held[*k].slides() else { continue };
            let change = block.velocity(&self.forces.solved.added);
            let change_W = block.along_W(&change);
            let along = d.dot(&change_W);
            if (change_W - d * along).norm() > NONE * scale {
                return None;
            }
            if along < -NONE * scale {
                ends_s = ends_s.min(state.time_s + here.slip_W().norm() / -along);
            }
        }
        self.ends_s = self.ends_s.min(ends_s);
        Some(Arc { t_s: state.time_s, from: *at, acceleration_m_s2: a, angular_rad_s2: alpha })
    }
}
