//! Pins of a scene, and velocities that agree with them.

use super::body::index_of;
use super::error::BuildError;
use crate::experiment::types as file;
use crate::model::Body;
use crate::model::pins::{Anchor, Pin};
use crate::state::BodyState;
use nalgebra::Vector3;

/// Pins of a scene. Velocities agree with them: one that the file does not give follows from the pin.
///
/// # Errors
/// Given velocities that contradict a pin.
pub fn build_pins(scene: &file::Scene, bodies: &[Body], states: &mut [BodyState]) -> Result<Vec<Pin>, BuildError> {
    let index = |name: &String| index_of(name, bodies);
    let pins: Vec<Pin> = scene
        .pins
        .iter()
        .map(|pin| {
            let (mut body, with) = (index(&pin.body), pin.with.as_ref().map(index));
            let r_B = Vector3::from(pin.point_m) - bodies[body].p_BoBcm;
            let p_W = states[body].p_WB + states[body].q_WB * r_B;
            let mut own_r_B = r_B;
            let anchor = match with {
                None => Anchor::World(p_W),
                Some(other) => {
                    let other_r_B = states[other].q_WB.inverse_transform_vector(&(p_W - states[other].p_WB));
                    if bodies[body].driven {
                        own_r_B = other_r_B;
                        let anchor = Anchor::Body(body, r_B);
                        body = other;
                        anchor
                    } else {
                        Anchor::Body(other, other_r_B)
                    }
                }
            };
            Pin { body, r_B: own_r_B, anchor }
        })
        .collect();
    follow(scene, bodies, &pins, states);
    agree(scene, bodies, &pins, states)?;
    Ok(pins)
}

/// Velocities from body to body, beginning where they are known: at the world, at bodies that move as they are told, at
/// given velocities; where nothing is known, at the first body, which then is at rest.
fn follow(scene: &file::Scene, bodies: &[Body], pins: &[Pin], states: &mut [BodyState]) {
    let drawn = scene.random.as_ref().is_some_and(|random| random.speed_m_s.is_some());
    let given = |i: usize| bodies[i].driven || (!drawn && scene.bodies[i].velocity_m_s.is_some());
    let pinned = |i: usize| pins.iter().any(|pin| pin.holds(i));
    let mut known: Vec<bool> = (0..bodies.len()).map(|i| given(i) || !pinned(i)).collect();
    loop {
        let mut changed = false;
        for pin in pins {
            let (a, r_a) = (pin.body, states[pin.body].q_WB * pin.r_B);
            match pin.anchor {
                Anchor::World(_) if !known[a] => {
                    states[a].v_WB = -states[a].w_WB.cross(&r_a);
                    known[a] = true;
                    changed = true;
                }
                Anchor::Body(b, r_B) if known[a] != known[b] => {
                    let r_b = states[b].q_WB * r_B;
                    let (from, r_from, to, r_to) = if known[a] { (a, r_a, b, r_b) } else { (b, r_b, a, r_a) };
                    let v_pin = states[from].v_WB + states[from].w_WB.cross(&r_from);
                    states[to].v_WB = v_pin - states[to].w_WB.cross(&r_to);
                    known[to] = true;
                    changed = true;
                }
                _ => {}
            }
        }
        if !changed {
            match known.iter().position(|known| !known) {
                Some(first) => {
                    states[first].v_WB = Vector3::zeros();
                    known[first] = true;
                }
                None => return,
            }
        }
    }
}

/// A pin holds from the first moment on.
fn agree(scene: &file::Scene, bodies: &[Body], pins: &[Pin], states: &[BodyState]) -> Result<(), BuildError> {
    /// Rounding, of the speeds that meet at the pin: what is written with some ten digits agrees.
    const ROUNDING: f64 = 1e-9;
    for (i, pin) in pins.iter().enumerate() {
        let velocity = |index: usize, r_B: &Vector3<f64>| {
            let (at, r) = (&states[index], states[index].q_WB * r_B);
            (at.v_WB + at.w_WB.cross(&r), at.v_WB.norm() + at.w_WB.norm() * r.norm())
        };
        let (own, own_speed) = velocity(pin.body, &pin.r_B);
        let (other, other_speed, name) = match &pin.anchor {
            Anchor::World(_) => (Vector3::zeros(), 0.0, "the world"),
            Anchor::Body(b, r_B) => {
                let (velocity, speed) = velocity(*b, r_B);
                (velocity, speed, bodies[*b].name.as_str())
            }
        };
        let apart = (own - other).norm();
        if apart > ROUNDING * own_speed.max(other_speed) {
            let body = &bodies[pin.body].name;
            let follows = if scene.bodies[pin.body].velocity_m_s.is_some() {
                format!(" (without `scene.bodies.{body}.velocity_m_s` it follows from the pin)")
            } else {
                String::new()
            };
            return Err(BuildError {
                path: format!("scene.pins.{i}"),
                expected: format!("velocities that agree at the pin{follows}"),
                found: format!("`{body}` and {name} parting with {apart:.3e} m/s"),
            });
        }
    }
    Ok(())
}
