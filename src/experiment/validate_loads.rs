//! Checks of `forces:`, `air:`, `pins:` and of bodies that move as they are told.

use super::checks::{Result, listed, not_negative, unexpected};
use super::error::{ExperimentError, number};
use super::key_path::Path;
use super::types::{Air, Body, Course, Experiment, Force, Integrator, Method, Pin, Scene, Shape};
use super::vocabulary::{Word, words};

/// Checks what acts on the bodies, and whether the method has it.
///
/// # Errors
/// The first load that is wrong, or that the method lacks.
pub fn validate_loads(experiment: &Experiment, at: Path) -> Result<()> {
    let scene = &experiment.scene;
    let (forces, pins) = (at.key("forces"), at.key("pins"));
    scene.forces.iter().enumerate().try_for_each(|(i, force)| validate_force(force, scene, forces.item(i, None)))?;
    scene.air.as_ref().map_or(Ok(()), |air| validate_air(air, scene, at.key("air")))?;
    scene.pins.iter().enumerate().try_for_each(|(i, pin)| validate_pin(pin, scene, pins.item(i, None)))?;
    fits_the_method(&experiment.method, scene, at)
}

fn fits_the_method(method: &Method, scene: &Scene, at: Path) -> Result<()> {
    let facts = method.facts();
    if facts.integrator.is_some_and(Integrator::needs_series) {
        no_quadratic_drag(scene, at.key("air"))?;
    }
    if facts.pins || scene.pins.is_empty() {
        return Ok(());
    }
    let others = match facts.impact {
        Some(law) if !law.has_all() => "`newton` has pins".to_string(),
        _ => {
            let have = |word: &Word<Method>| word.value.facts().pins;
            format!("{} have pins", listed(words::<Method>().iter().filter(|word| have(word)).map(|word| word.name)))
        }
    };
    let feature = format!("a pin with {} ({others})", who_lacks(method));
    Err(ExperimentError::feature_not_available(at.key("pins").to_key_path(), &feature))
}

/// Words about who lacks what other methods have: the law of impact, if there is one that has it.
pub(super) fn who_lacks(method: &Method) -> String {
    match method.facts().impact {
        Some(law) if !law.has_all() => format!("the law of impact `{}`", law.word()),
        _ => format!("the method `{}`", method.word()),
    }
}

/// Refuses |v| v: where v = 0 the third derivative of a body with it jumps, and no coefficient says so.
fn no_quadratic_drag(scene: &Scene, at: Path) -> Result<()> {
    match scene.air {
        Some(air) if air.drag_coefficient > 0.0 => {
            let expected = "no quadratic drag, as it has no Taylor series where v = 0 (`dop853` takes it)";
            Err(unexpected(at.key("drag_coefficient"), expected, &number(air.drag_coefficient)))
        }
        _ => Ok(()),
    }
}

fn validate_force(force: &Force, scene: &Scene, at: Path) -> Result<()> {
    let body = &scene.bodies[index_of(&force.body, scene, at.key("body"))?];
    if body.is_driven() {
        let expected = "a body that forces move (this one is `fixed` or `kinematic`)";
        return Err(unexpected(at.key("body"), expected, &format!("`{}`", force.body)));
    }
    if force.force_n.is_none() && force.torque_n_m.is_none() {
        return Err(ExperimentError::missing(at.key("force_n").to_key_path(), "give `force_n` or `torque_n_m`"));
    }
    if force.at_m.is_some() && force.force_n.is_none() {
        return Err(unexpected(at.key("at_m"), "a `force_n` that acts there", "`torque_n_m` alone"));
    }
    let turns = [("torque_n_m", force.torque_n_m), ("at_m", force.at_m)];
    for (key, vector) in turns {
        if is_point(body) && vector.is_some_and(|v| v != [0.0; 3]) {
            return Err(no_rotation(body, at.key(key)));
        }
    }
    match force.course {
        Course::Cosine(cosine) => {
            not_negative(cosine.frequency_rad_s, at.key("as").key("cosine").key("frequency_rad_s"))
        }
        Course::Constant => Ok(()),
    }
}

fn validate_air(air: &Air, scene: &Scene, at: Path) -> Result<()> {
    let (density, coefficient) = (at.key("density_kg_m3"), at.key("drag_coefficient"));
    not_negative(air.density_kg_m3, density)?;
    not_negative(air.drag_coefficient, coefficient)?;
    not_negative(air.linear_drag_n_s_m, at.key("linear_drag_n_s_m"))?;
    match (air.density_kg_m3 > 0.0, air.drag_coefficient > 0.0) {
        (true, false) => {
            Err(ExperimentError::missing(coefficient.to_key_path(), "`density_kg_m3` needs a coefficient"))
        }
        (false, true) => Err(ExperimentError::missing(density.to_key_path(), "`drag_coefficient` needs a density")),
        (false, false) if air.linear_drag_n_s_m == 0.0 => {
            Err(ExperimentError::missing(density.to_key_path(), "air without density and linear drag does nothing"))
        }
        (true, true) => match scene.bodies.iter().find(|body| body.shape == Shape::None && !body.is_driven()) {
            Some(point) => {
                let expected = format!("bodies with a surface, for the quadratic drag (`{}` has none)", point.name);
                Err(unexpected(coefficient, &expected, &number(air.drag_coefficient)))
            }
            None => Ok(()),
        },
        _ => Ok(()),
    }
}

fn validate_pin(pin: &Pin, scene: &Scene, at: Path) -> Result<()> {
    let (first, second) = (at.key("body"), at.key("with"));
    let body = &scene.bodies[index_of(&pin.body, scene, first)?];
    let with = match &pin.with {
        Some(with) if *with == pin.body => {
            return Err(unexpected(second, "another body than the one that is pinned", &format!("`{with}`")));
        }
        Some(with) => Some(&scene.bodies[index_of(with, scene, second)?]),
        None => None,
    };
    if body.is_driven() && with.is_none_or(Body::is_driven) {
        let end = with.map_or("the world".to_string(), |with| format!("`{}`", with.name));
        let found = format!("a pin between two fixed ends (`{}` and {end})", body.name);
        return Err(unexpected(at, "a pin with a body at one end that it can move", &found));
    }
    if is_point(body) && pin.point_m != [0.0; 3] {
        return Err(no_rotation(body, at.key("point_m")));
    }
    Ok(())
}

fn no_rotation(body: &Body, at: Path) -> ExperimentError {
    let expected = format!("nothing that turns `{}`, a point without `inertia_kg_m2`", body.name);
    unexpected(at, &expected, "a lever arm or a torque")
}

fn is_point(body: &Body) -> bool {
    body.shape == Shape::None && body.inertia_kg_m2.is_none()
}

fn index_of(name: &str, scene: &Scene, at: Path) -> Result<usize> {
    scene.bodies.iter().position(|body| body.is_called(name)).ok_or_else(|| {
        let known: Vec<String> = scene.bodies.iter().map(Body::called).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        ExperimentError::unknown_word(at.to_key_path(), name, &known)
    })
}

/// Checks a body that moves as it is told.
///
/// # Errors
/// A body that moves as it is told, with keys that contradict that.
pub fn validate_driven(body: &Body, at: Path) -> Result<()> {
    if !body.is_driven() {
        return Ok(());
    }
    if body.fixed && body.kinematic.is_some() {
        return Err(unexpected(at.key("kinematic"), "either `fixed` or `kinematic`", "both"));
    }
    let velocities = [
        ("velocity_m_s", body.velocity_m_s),
        ("angular_velocity_rad_s", body.angular_velocity_rad_s),
        ("angular_velocity_body_rad_s", body.angular_velocity_body_rad_s),
    ];
    match velocities.iter().find(|(_, v)| v.is_some_and(|v| v != [0.0; 3])) {
        Some((key, _)) if body.fixed => Err(unexpected(at.key(key), "no velocity, as the body is `fixed`", "one")),
        Some((key, _)) => Err(unexpected(at.key(key), "the velocities below `kinematic`", "one beside it")),
        None => Ok(()),
    }
}
