//! A body that slides on a plane without turning, with Coulomb friction (for instance Goldstein, Classical Mechanics,
//! § 1.5, or any first course): v̇ = g_t − μ g_n v/|v|. It slides along one line, stops, and stays (|g_t| ≤ μ g_n) or
//! starts back down the slope. SI units.

use super::arc::{self, Arc};
use super::facts::{Lacks, SAME};
use super::form::{ClosedForm, ExactMotion};
use super::touching::{along, covers, lying_flat, on_its_own};
use crate::model::Model;
use crate::state::BodyState;
use crate::state::State;
use nalgebra::Vector3;

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Sliding to a stop, sticking, or starting back down; Coulomb friction.",
    source: "Goldstein, Classical Mechanics, 1.5",
    scenes: "Gravity, constant forces of the world at the centre of mass; one body flat on a container of one plane, \
           without spin, moving along the line of slope or on a level plane; too low to tip.",
    motion,
};

#[derive(Clone, Debug)]
pub struct Sliding {
    arcs: Vec<Arc>,
}

impl Sliding {
    /// The motion from its start. Along the plane everything accelerates with `pull`, and presses on it with `press` >
    /// 0 (of a unit mass). None if it moves across the pull: then it slides on a curve.
    pub fn new(start: &BodyState, pull: Vector3<f64>, press: f64, friction: f64) -> Option<Self> {
        let grip = friction * press;
        if grip == 0.0 {
            return Some(Sliding { arcs: vec![Arc::straight(0.0, *start, pull)] });
        }
        let (mut t_s, mut at, mut arcs) = (0.0, *start, Vec::new());
        let speed = at.v_WB.norm();
        if speed > 0.0 {
            let along = at.v_WB / speed;
            if pull.cross(&along).norm() > SAME * pull.norm() {
                return None;
            }
            let slowing = grip - pull.dot(&along);
            let arc = Arc::straight(t_s, at, pull - along * grip);
            if slowing <= 0.0 {
                return Some(Sliding { arcs: vec![arc] });
            }
            t_s = speed / slowing;
            at = BodyState { v_WB: Vector3::zeros(), ..arc.at(t_s) };
            arcs.push(arc);
        }
        let steep = pull.norm();
        let down = if steep <= grip { Vector3::zeros() } else { pull * (1.0 - grip / steep) };
        arcs.push(Arc::straight(t_s, at, down));
        Some(Sliding { arcs })
    }

    pub fn at(&self, t_s: f64) -> BodyState {
        arc::at(&self.arcs, t_s)
    }

    /// Accelerations that it has at one time or another, in m/s².
    pub fn accelerations(&self) -> impl Iterator<Item = Vector3<f64>> {
        self.arcs.iter().map(|arc| arc.acceleration_m_s2)
    }
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let (face, acceleration) = on_its_own(model, index)?;
    let body = &model.bodies[index];
    let (feet, start) = lying_flat(body, at, &face)?;
    let press = -face.normal.dot(&acceleration);
    if press <= 0.0 {
        return Err(format!("`{}` pressed on the plane", body.name));
    }
    let pull = along(&acceleration, &face.normal, acceleration.norm());
    let sliding = Sliding::new(&start, pull, press, model.pair(index, None).friction)
        .ok_or_else(|| format!("`{}` moving along the line of slope, or on a level plane", body.name))?;
    // The contact presses where its force has no moment about the centre of mass.
    let height = -face.normal.dot(&feet[0]);
    let upright = |a: Vector3<f64>| covers(&feet, &face.normal, &((pull - a) * (height / press)));
    if !sliding.accelerations().all(upright) {
        return Err(format!("`{}` too low to tip: the resultant within its base", body.name));
    }
    Ok(ExactMotion::new(move |t_s| sliding.at(t_s)))
}
