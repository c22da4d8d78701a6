//! From a scene of bodies that touch to the closed form that is its motion. A container of one plane: nothing else is
//! hit.

use super::ball::{Ball, Setting};
use super::dome_scene::{self, OnDome};
use super::facts::{Lacks, SAME, point};
use super::sliding::Sliding;
use super::stick_slip::StickSlip;
use super::toppling_scene::{self, Block, LadderAt, Rod};
use super::touching::{ON, along, covers, lying_flat, on_its_own, only_faces, rounding_m, sphere, unhindered};
use super::turntable::Turntable;
use super::wheel_scene::{self, Wheel};
use crate::experiment::types::Exact;
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// The exact motion of one body.
#[derive(Clone, Debug)]
pub enum Touching {
    Rest(BodyState),
    Sliding(Sliding),
    Ball(Box<Ball>),
    Turntable(Turntable),
    Block(Box<Block>),
    Rod(Box<Rod>),
    Ladder(Box<LadderAt>),
    Wheel(Box<Wheel>),
    Dome(Box<OnDome>),
    StickSlip(Box<StickSlip>),
}

impl Touching {
    pub fn at(&self, t_s: f64) -> BodyState {
        match self {
            Touching::Rest(at) => *at,
            Touching::Sliding(sliding) => sliding.at(t_s),
            Touching::Ball(ball) => ball.at(t_s),
            Touching::Turntable(turntable) => turntable.at(t_s),
            Touching::Block(block) => block.at(t_s),
            Touching::Rod(rod) => rod.at(t_s),
            Touching::Ladder(ladder) => ladder.at(t_s),
            Touching::Wheel(wheel) => wheel.at(t_s),
            Touching::Dome(dome) => dome.at(t_s),
            Touching::StickSlip(body) => body.at(t_s),
        }
    }

    /// Up to when it is the motion.
    pub fn holds_until_s(&self) -> f64 {
        if let Touching::Dome(dome) = self { dome.holds_until_s() } else { f64::INFINITY }
    }
}

/// The motion of one of the model's bodies, of a closed form with contact.
pub fn motion(which: Exact, model: &Model, start: &State, index: usize) -> Result<Touching, Lacks> {
    let at = &start.bodies[index];
    match which {
        Exact::Sliding => sliding(model, index, at),
        Exact::Ball => ball(model, index, at),
        Exact::Turntable => turntable(model, start, index),
        Exact::RockingBlock => toppling_scene::block(model, index, at).map(|block| Touching::Block(Box::new(block))),
        Exact::FallingRod => toppling_scene::rod(model, index, at).map(|rod| Touching::Rod(Box::new(rod))),
        Exact::Ladder => toppling_scene::ladder(model, index, at).map(|ladder| Touching::Ladder(Box::new(ladder))),
        Exact::RimlessWheel => wheel_scene::wheel(model, index, at).map(|wheel| Touching::Wheel(Box::new(wheel))),
        Exact::Dome => dome_scene::dome(model, start, index).map(|dome| Touching::Dome(Box::new(dome))),
        Exact::StickSlip => stick_slip(model, index, at),
        Exact::Rest => rest(&model.bodies[index], at),
        // Of bodies that meet nothing: `scene.rs` has them.
        Exact::FreeMotion
        | Exact::SymmetricBody
        | Exact::LinearDrag
        | Exact::QuadraticDrag
        | Exact::HeavyTop
        | Exact::Pendulum => Err("nothing to touch".into()),
    }
}

fn rest(body: &Body, at: &BodyState) -> Result<Touching, Lacks> {
    let still = at.v_WB == Vector3::zeros() && at.w_WB == Vector3::zeros();
    if still { Ok(Touching::Rest(*at)) } else { Err(format!("`{}` at rest at the start", body.name)) }
}

fn sliding(model: &Model, index: usize, at: &BodyState) -> Result<Touching, Lacks> {
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
    Ok(Touching::Sliding(sliding))
}

fn stick_slip(model: &Model, index: usize, at: &BodyState) -> Result<Touching, Lacks> {
    let forces = point(model, index, at)?;
    let [face] = only_faces(model).ok_or("a `container` of one plane, and one body with a shape")?;
    let body = &model.bodies[index];
    let (feet, start) = lying_flat(body, at, &face)?;
    let [drive] = forces.harmonics[..] else { return Err("one cosine among the `forces`".into()) };
    let (normal, weight) = (face.normal, forces.constant_m_s2);
    let press = -normal.dot(&weight);
    if press <= 0.0 || normal.dot(&drive.amplitude_m_s2).abs() > SAME * drive.amplitude_m_s2.norm() {
        return Err(format!("`{}` pressed on the plane, and a cosine along it", body.name));
    }
    let friction = model.pair(index, None).friction;
    let body_slips = StickSlip::new(&start, along(&weight, &normal, weight.norm()), &drive, friction * press)
        .ok_or("everything along one line, and friction that holds what is constant")?;
    // The contact presses where its force has no moment about the centre of mass.
    let tips = drive.amplitude_m_s2.normalize() * (friction * normal.dot(&feet[0]));
    if ![tips, -tips].iter().all(|point| covers(&feet, &normal, point)) {
        return Err(format!("`{}` too low to tip: the resultant within its base", body.name));
    }
    Ok(Touching::StickSlip(Box::new(body_slips)))
}

fn ball(model: &Model, index: usize, at: &BodyState) -> Result<Touching, Lacks> {
    let (face, acceleration_m_s2) = on_its_own(model, index)?;
    let body = &model.bodies[index];
    let (radius_m, inertia) = sphere(body)?;
    let gap_m = face.gap_m(&at.p_WB) - radius_m;
    let near_m = rounding_m(radius_m, at);
    if gap_m < -near_m {
        return Err(format!("`{}` outside the plane", body.name));
    }
    let surface = model.pair(index, None);
    let setting = Setting {
        normal: face.normal,
        acceleration_m_s2,
        radius_m,
        inertia,
        friction: surface.friction,
        restitution: surface.restitution,
        tangential_restitution: surface.tangential_restitution,
    };
    let height_m = if gap_m <= near_m { 0.0 } else { gap_m };
    let ball = Ball::new(setting, at, height_m)
        .ok_or_else(|| format!("`{}` slipping along the line of slope, or on a level plane", body.name))?;
    Ok(Touching::Ball(Box::new(ball)))
}

fn turntable(model: &Model, start: &State, index: usize) -> Result<Touching, Lacks> {
    let (body, at) = (&model.bodies[index], &start.bodies[index]);
    let (radius_m, inertia) = sphere(body)?;
    let acceleration = unhindered(model, index)?;
    let others: Vec<usize> = (0..model.bodies.len()).filter(|i| *i != index).collect();
    let [table] = others[..] else { return Err("a ball and a table".into()) };
    if model.container.is_some() {
        return Err("no `container`".into());
    }
    let level = || format!("`{}` turning about the vertical axis through its middle", model.bodies[table].name);
    let press = acceleration.norm();
    let up = (-acceleration).try_normalize(0.0).ok_or("gravity")?;
    let (table_body, table_at) = (&model.bodies[table], &start.bodies[table]);
    let (height_m, reach_m) = table_top(table_body, table_at, &up).ok_or_else(level)?;
    let w = table_at.w_WB;
    if !table_body.driven || w.cross(&up).norm() > SAME * w.norm() || table_at.v_WB != Vector3::zeros() {
        return Err(level());
    }
    let to_ball = at.p_WB - table_at.p_WB;
    let from_axis = to_ball - up * up.dot(&to_ball);
    let gap_m = up.dot(&to_ball) - height_m - radius_m;
    let slip = at.v_WB - at.w_WB.cross(&up) * radius_m - w.cross(&from_axis);
    let speeds = at.v_WB.norm() + at.w_WB.norm() * radius_m + w.norm() * from_axis.norm();
    if gap_m.abs() > rounding_m(radius_m, at) || slip.norm() > SAME * speeds {
        return Err(format!("`{}` rolling on the table", body.name));
    }
    let turntable = Turntable::new(at, up, up.dot(&w), from_axis, radius_m, inertia);
    if turntable.acceleration_m_s2() > model.pair(index, Some(table)).friction * press {
        return Err("more friction than rolling takes".into());
    }
    let circle_m = (from_axis + turntable.to_centre_m()).norm() + turntable.radius_m();
    if w.norm() > 0.0 && circle_m > reach_m {
        return Err(format!("`{}` staying on the table", body.name));
    }
    Ok(Touching::Turntable(turntable))
}

/// Height of a level top above the centre of mass, and how far from the axis it is there in every direction.
fn table_top(body: &Body, at: &BodyState, up: &Vector3<f64>) -> Option<(f64, f64)> {
    let Geometry::Solid { solid, centre } = &body.geometry else { return None };
    let up_B = at.q_WB.inverse_transform_vector(up);
    let axis = up_B.iamax();
    let level = (up_B.abs() - Vector3::ith(axis, 1.0)).norm() <= SAME;
    let (half_m, reach_m) = match solid {
        Solid::Box { half_m } => (half_m[axis], half_m[(axis + 1) % 3].min(half_m[(axis + 2) % 3])),
        Solid::Cylinder { radius_m, half_height_m } if axis == 1 => (*half_height_m, *radius_m),
        _ => return None,
    };
    (level && centre.norm() <= ON * half_m).then_some((half_m, reach_m))
}
