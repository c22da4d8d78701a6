//! Builder of the constant `Model` and the first `State` of one resolved experiment.

use super::body::{build_body, index_of};
use super::error::BuildError;
use super::first::{first_state, potential_zero};
use super::overlap::refuse_overlap;
use super::pins::build_pins;
use super::place::Landing;
use crate::experiment::types as file;
use crate::model::container::{Container, Face};
use crate::model::loads::AppliedForce;
use crate::model::surface::{Pair, Surface};
use crate::model::{Body, Model};
use crate::shared::Shared;
use crate::state::State;
use nalgebra::Vector3;
use std::cell::RefCell;

/// Model and first state of an experiment that has passed validation.
///
/// # Errors
/// What only geometry shows: vertices that make no hull, velocities that contradict a pin, bodies that overlap, or no
/// draw that lands.
pub fn build(experiment: &file::Experiment) -> Result<(Model, State), BuildError> {
    let scene = &experiment.scene;
    let container = scene.container.as_ref().map(build_container);
    let landing = Landing::new(experiment, container.as_ref());
    let bodies = build_bodies(&experiment.scene, experiment.plan.skip)?;
    let mut states = Vec::with_capacity(scene.bodies.len());
    let mut depths_m = Vec::with_capacity(scene.bodies.len());
    for (described, body) in scene.bodies.iter().zip(bodies.iter()) {
        let (state, depth_m) = first_state(described, body, experiment, landing.as_ref())?;
        states.push(state);
        depths_m.push(depth_m);
    }
    let forces = scene.forces.iter().map(|force| build_force(force, &bodies)).collect();
    let pins = build_pins(scene, &bodies, &mut states)?;
    let gravity_m_s2 = Vector3::from(scene.gravity_m_s2);
    let potential_zero_m = potential_zero(&gravity_m_s2, container.as_ref(), &bodies, &states);
    let solids = || bodies.iter().filter(|body| body.solid().is_some());
    let model = Model {
        touching_pairs: solids().count() > 1 && solids().any(|body| !body.driven),
        gravity_m_s2,
        container,
        container_surface: Surface {
            friction: scene.friction,
            restitution: scene.restitution,
            tangential_restitution: 0.0,
        },
        pairs: scene.pairs.iter().map(|pair| build_pair(pair, &bodies)).collect(),
        bodies,
        forces,
        pins,
        potential_zero_m,
        skips: experiment.plan.skip,
    };
    let state = State { step: 0, time_s: 0.0, bodies: states };
    if experiment.method.facts().contact != file::ContactModel::None && !scene.allow_overlap {
        refuse_overlap(&model, &state, &depths_m)?;
    }
    Ok((model, state))
}

/// Whether an experiment that can be built can be built with every other seed, and every other step.
pub fn is_sound_whatever_the_seed(experiment: &file::Experiment) -> bool {
    let scene = &experiment.scene;
    let Some(random) = &scene.random else { return true };
    let solids = scene.bodies.iter().filter(|body| body.shape != file::Shape::None).count();
    let is_looked_at = experiment.method.facts().contact != file::ContactModel::None && !scene.allow_overlap;
    let may_overlap = is_looked_at && random.attitude && (solids > 1 || (solids > 0 && scene.container.is_some()));
    scene.pins.is_empty() && random.place.is_none() && !may_overlap
}

/// Bodies that have been built, and what of.
struct Built {
    scene: Shared<file::Scene>,
    skips: file::Skips,
    bodies: Shared<Vec<Body>>,
}

thread_local! {
    /// Bodies that this thread has built last, and of which scene: the cases of a sweep that differ by seed or step
    /// alone have one.
    static LAST: RefCell<Option<Built>> = const { RefCell::new(None) };
}

fn build_bodies(scene: &Shared<file::Scene>, skips: file::Skips) -> Result<Shared<Vec<Body>>, BuildError> {
    let is_it = |built: &&Built| built.scene.is_one_with(scene) && built.skips == skips;
    if let Some(bodies) = LAST.with_borrow(|last| last.as_ref().filter(is_it).map(|built| built.bodies.clone())) {
        return Ok(bodies);
    }
    let bodies = scene.bodies.iter().map(|described| build_body(described, scene, skips));
    let bodies = Shared::new(bodies.collect::<Result<Vec<_>, _>>()?);
    LAST.set(Some(Built { scene: scene.clone(), skips, bodies: bodies.clone() }));
    Ok(bodies)
}

fn build_container(container: &file::Container) -> Container {
    let face = |plane: &file::Plane| {
        let normal = Vector3::from(plane.normal);
        Face { normal: normal / normal.norm(), offset_m: plane.offset_m }
    };
    match container {
        file::Container::Box(b) => Container::new_box(b.size_m, b.center()),
        file::Container::Plane(plane) => Container { faces: vec![face(plane)] },
        file::Container::Planes(planes) => Container { faces: planes.iter().map(face).collect() },
    }
}

fn build_pair(pair: &file::Pair, bodies: &[Body]) -> Pair {
    let index = |name: &String| (name != file::CONTAINER).then(|| index_of(name, bodies));
    Pair {
        between: pair.between.each_ref().map(index),
        friction: pair.friction,
        restitution: pair.restitution,
        tangential_restitution: pair.tangential_restitution,
    }
}

fn build_force(force: &file::Force, bodies: &[Body]) -> AppliedForce {
    let body = index_of(&force.body, bodies);
    let vector = |given: Option<[f64; 3]>| given.map_or_else(Vector3::zeros, Vector3::from);
    AppliedForce {
        body,
        force_n: vector(force.force_n),
        torque_n_m: vector(force.torque_n_m),
        r_B: force.at_m.map_or_else(Vector3::zeros, |at| Vector3::from(at) - bodies[body].p_BoBcm),
        frame: force.frame,
        cosine: match force.course {
            file::Course::Constant => None,
            file::Course::Cosine(cosine) => Some((cosine.frequency_rad_s, cosine.phase_rad)),
        },
    }
}
