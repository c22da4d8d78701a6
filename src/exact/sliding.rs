//! A body that slides on a plane without turning, with Coulomb friction (for instance Goldstein, Classical Mechanics,
//! § 1.5, or any first course): v̇ = g_t − μ g_n v/|v|. It slides along one line, stops, and stays (|g_t| ≤ μ g_n) or
//! starts back down the slope. SI units.

use super::arc::{self, Arc};
use super::facts::SAME;
use crate::state::BodyState;
use nalgebra::Vector3;

#[derive(Clone, Debug)]
pub struct Sliding {
    arcs: Vec<Arc>,
}

impl Sliding {
    /// Along the plane everything accelerates with `pull`, and presses on it with `press` > 0 (of a unit mass). None if
    /// it moves across the pull: then it slides on a curve.
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

    /// What it does at one time or another.
    pub fn accelerations(&self) -> impl Iterator<Item = Vector3<f64>> {
        self.arcs.iter().map(|arc| arc.acceleration_m_s2)
    }
}
