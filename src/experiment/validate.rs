//! Checks of what the types cannot say: bounds, and words that must fit together. The body's part is
//! `validate_body.rs`.

use super::checks::{Result, a_part, at_least_one, direction, not_negative, positive, reachable, sizes, unexpected};
use super::error::{ExperimentError, number};
use super::key_path::{KeyPath, Path};
use super::types::{
    Accuracy, Body, CONTAINER, ContactModel, Container, Diverge, EventDriven, Experiment, Limits, Measure, Method,
    Pair, Plane, Random, Record, RecordCases, Restitution, Scene, Shape, Time,
};
use super::validate_body::validate_body;
use super::validate_loads::{validate_loads, who_lacks};

/// Most steps of a run: more than a machine makes in weeks, and so a slip in a unit.
const MOST_STEPS: f64 = 1e12;

/// Checks that an experiment makes sense.
///
/// # Errors
/// The first thing that makes none, with its key path.
pub fn validate(experiment: &Experiment) -> Result<()> {
    let base = KeyPath::default();
    let root = Path::Base(&base);
    validate_scene(&experiment.scene, root.key("scene"))?;
    let method = &experiment.method;
    method.settings().check(root.key("method").key(method.word()))?;
    validate_contact(experiment, root.key("scene"))?;
    validate_loads(experiment, root.key("scene"))?;
    validate_exact(experiment, root.key("exact"))?;
    validate_reference(experiment, root)?;
    validate_time(&experiment.time, method, root.key("time"))?;
    validate_diverge(&experiment.diverge, root.key("diverge"))?;
    validate_limits(&experiment.limits, root.key("limits"))?;
    validate_record(&experiment.record, root.key("record"))?;
    validate_measure(experiment, root.key("measure"))
}

/// Whether the time of an experiment makes sense, all else of which does.
pub fn is_time_valid(experiment: &Experiment) -> bool {
    let base = KeyPath::default();
    validate_time(&experiment.time, &experiment.method, Path::Base(&base)).is_ok()
}

/// Deviation from 1 of the squared length of a normalised quaternion: four components, a root and two quotients, each
/// rounded.
const UNIT_SLACK: f64 = 8.0 * f64::EPSILON;

/// Makes quaternions unit ones, of which any multiple may be written. One that is a unit up to rounding stays as it is,
/// bit for bit, so that what is written of a resolved experiment is read as the same.
pub fn normalise_quaternions(experiment: &mut Experiment) {
    let orientations = experiment.scene.bodies.iter_mut().filter_map(|body| body.orientation.as_mut());
    for q in orientations.filter_map(|orientation| orientation.quaternion_xyzw.as_mut()) {
        if (q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() <= UNIT_SLACK {
            continue;
        }
        let largest = q.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        let scaled = q.map(|x| x / largest);
        let norm = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
        *q = scaled.map(|x| x / norm);
    }
}

fn validate_scene(scene: &Scene, at: Path) -> Result<()> {
    not_negative(scene.friction, at.key("friction"))?;
    a_part(scene.restitution, at.key("restitution"))?;
    if let Some(container) = &scene.container {
        validate_container(container, at.key("container"))?;
    }
    let bodies = at.key("bodies");
    if scene.bodies.is_empty() {
        return Err(unexpected(bodies, "at least one body", "an empty list"));
    }
    for (i, body) in scene.bodies.iter().enumerate() {
        validate_body(body, bodies.item(i, Some(&body.name)))?;
        let is_taken = |(j, other): (usize, &Body)| match &other.copies {
            None => j < i && other.name == body.name,
            Some(_) => (j < i && other.name == body.name) || (j != i && other.is_called(&body.name)),
        };
        if let Some(other) = scene.bodies.iter().enumerate().position(is_taken) {
            let found = format!("`{}`, which item {other} of the list has", body.name);
            return Err(unexpected(bodies.item(i, None).key("name"), "a name of its own", &found));
        }
    }
    let pairs = at.key("pairs");
    scene.pairs.iter().enumerate().try_for_each(|(i, pair)| validate_pair(pair, scene, pairs.item(i, None)))?;
    scene.random.as_ref().map_or(Ok(()), |random| validate_random(random, scene, at.key("random")))
}

fn validate_pair(pair: &Pair, scene: &Scene, at: Path) -> Result<()> {
    let between = at.key("between");
    for (i, name) in pair.between.iter().enumerate() {
        if name != CONTAINER && !scene.bodies.iter().any(|body| body.is_called(name)) {
            let bodies: Vec<String> = scene.bodies.iter().map(|body| body.called()).collect();
            let known: Vec<&str> = bodies.iter().map(String::as_str).chain([CONTAINER]).collect();
            return Err(ExperimentError::unknown_word(between.item(i, None).to_key_path(), name, &known));
        }
    }
    let [a, b] = &pair.between;
    if a == b {
        return Err(unexpected(between, "two different names", &format!("`{a}` twice")));
    }
    pair.friction.map_or(Ok(()), |friction| not_negative(friction, at.key("friction")))?;
    pair.restitution.map_or(Ok(()), |restitution| a_part(restitution, at.key("restitution")))?;
    let tangential = pair.tangential_restitution;
    tangential.map_or(Ok(()), |restitution| a_part(restitution, at.key("tangential_restitution")))
}

fn validate_container(container: &Container, at: Path) -> Result<()> {
    match container {
        Container::Box(box_) => sizes(&box_.size_m, at.key("box").key("size_m")),
        Container::Plane(plane) => validate_plane(plane, at.key("plane")),
        Container::Planes(planes) if planes.is_empty() => {
            Err(unexpected(at.key("planes"), "at least one plane", "an empty list"))
        }
        Container::Planes(planes) => {
            let list = at.key("planes");
            planes.iter().enumerate().try_for_each(|(i, plane)| validate_plane(plane, list.item(i, None)))
        }
    }
}

fn validate_plane(plane: &Plane, at: Path) -> Result<()> {
    direction(&plane.normal, at.key("normal"))
}

fn validate_random(random: &Random, scene: &Scene, at: Path) -> Result<()> {
    random.speed_m_s.map_or(Ok(()), |speed| not_negative(speed, at.key("speed_m_s")))?;
    random.spin_rad_s.map_or(Ok(()), |spin| not_negative(spin, at.key("spin_rad_s")))?;
    if random.direction.is_some() && random.speed_m_s.is_none() {
        return Err(ExperimentError::missing(at.key("speed_m_s").to_key_path(), "`direction` needs a speed"));
    }
    if random.place.is_some() {
        validate_place(scene, at.key("place"))?;
    }
    let is_point = |shape: &Shape| *shape == Shape::None;
    let point = scene.bodies.iter().find(|body| is_point(&body.shape) && body.inertia_kg_m2.is_none());
    match (point, random.spin_rad_s) {
        (Some(point), Some(spin)) if spin > 0.0 => {
            let expected = format!("no spin, as `{}` is a point without `inertia_kg_m2`", point.name);
            Err(unexpected(at.key("spin_rad_s"), &expected, &number(spin)))
        }
        _ => Ok(()),
    }
}

fn validate_place(scene: &Scene, at: Path) -> Result<()> {
    if scene.container.is_none() {
        return Err(unexpected(at, "no place, as the scene has no `container` to touch", "`at-contact`"));
    }
    if scene.bodies.iter().all(|body| body.shape == Shape::None) {
        return Err(unexpected(at, "no place, as no body has a shape", "`at-contact`"));
    }
    Ok(())
}

/// Checks that the method can do what the scene's contacts ask for.
fn validate_contact(experiment: &Experiment, at: Path) -> Result<()> {
    let (scene, method) = (&experiment.scene, &experiment.method);
    if method.facts().needs_mesh {
        needs_meshes(method.word(), scene, at)?;
    }
    match method.facts().restitution {
        Restitution::All => Ok(()),
        Restitution::Normal => no_tangential_restitution(&who_lacks(method), scene, at),
        Restitution::None { instead } => {
            let who = who_lacks(method);
            no_restitution(&format!("0, as {who} has no restitution ({instead})"), scene, at)?;
            no_tangential_restitution(&who, scene, at)
        }
    }
}

/// A closed form is the truth only where its assumptions hold.
fn validate_exact(experiment: &Experiment, at: Path) -> Result<()> {
    let scene = &experiment.scene;
    let touches = scene.container.is_some() && scene.bodies.iter().any(|body| body.shape != Shape::None);
    let free = experiment.method.facts().contact == ContactModel::None;
    let word = experiment.method.word();
    match experiment.exact {
        Some(exact) if exact.touches() && free => {
            let expected = format!("a motion without contact, or a method with contact: `{word}` has none");
            Err(unexpected(at, &expected, &format!("`{}`", exact.word())))
        }
        Some(exact) if !exact.touches() && touches && !free => {
            let expected = "an exact motion with contact, none, or the method `free`: a body may touch the container";
            Err(unexpected(at, expected, &format!("`{}`", exact.word())))
        }
        _ => Ok(()),
    }
}

/// Checks that the motion is one that `event-driven` can follow, and the same one.
fn validate_reference(experiment: &Experiment, root: Path) -> Result<()> {
    let Some(reference) = &experiment.reference else { return Ok(()) };
    let at = root.key("reference");
    reachable(reference.tolerance, at.key("tolerance"))?;
    if let Some(exact) = experiment.exact {
        let expected = "either `exact` or `reference`: errors are measured against one of them";
        return Err(unexpected(at, expected, &format!("`exact: {}` beside it", exact.word())));
    }
    let scene = &experiment.scene;
    let method = &experiment.method;
    let without = method.facts().contact == ContactModel::None;
    if without && scene.bodies.iter().any(|body| body.shape != Shape::None) {
        let expected = format!(
            "bodies of shape `none`, or a method with contact: the reference has contact and `{}` has none",
            method.word()
        );
        return Err(unexpected(at, &expected, "bodies that may touch"));
    }
    let tolerance = reference.tolerance;
    let method = Method::EventDriven(EventDriven { tolerance, impact: method.impact() });
    let followed = Experiment { method, ..experiment.clone() };
    validate_contact(&followed, root.key("scene"))?;
    validate_loads(&followed, root.key("scene"))
}

fn needs_meshes(method: &str, scene: &Scene, at: Path) -> Result<()> {
    let bodies = at.key("bodies");
    for (i, body) in scene.bodies.iter().enumerate() {
        if body.shape != Shape::None && body.mesh.is_none() {
            let what = format!("the method `{method}` touches with nodes and needs a mesh");
            let path = bodies.item(i, Some(&body.name)).key("mesh").to_key_path();
            return Err(ExperimentError::missing(path, &what));
        }
    }
    Ok(())
}

fn no_restitution(expected: &str, scene: &Scene, at: Path) -> Result<()> {
    if scene.restitution != 0.0 {
        return Err(unexpected(at.key("restitution"), expected, &number(scene.restitution)));
    }
    let bodies = at.key("bodies");
    for (i, body) in scene.bodies.iter().enumerate() {
        if let Some(restitution) = body.restitution.filter(|e| *e != 0.0) {
            let path = bodies.item(i, Some(&body.name));
            return Err(unexpected(path.key("restitution"), expected, &number(restitution)));
        }
    }
    Ok(())
}

fn no_tangential_restitution(who: &str, scene: &Scene, at: Path) -> Result<()> {
    for (i, pair) in scene.pairs.iter().enumerate() {
        if let Some(restitution) = pair.tangential_restitution.filter(|e| *e != 0.0) {
            let path = at.key("pairs");
            let expected = format!("0, as {who} has no tangential restitution");
            return Err(unexpected(path.item(i, None).key("tangential_restitution"), &expected, &number(restitution)));
        }
    }
    Ok(())
}

/// Whoever needs no step makes one of the whole time if none is given.
fn validate_time(time: &Time, method: &Method, at: Path) -> Result<()> {
    positive(time.end_s, at.key("end_s"))?;
    let step = at.key("step_s");
    let step_s = match (time.step_s, method.accuracy()) {
        (Some(step_s), _) => step_s,
        (None, Accuracy::Step) => {
            return Err(ExperimentError::missing(step.to_key_path(), "the length of a step, in seconds"));
        }
        (None, _) => return Ok(()),
    };
    positive(step_s, step)?;
    let steps = time.end_s / step_s;
    if steps > MOST_STEPS {
        let found = format!("{} ({} steps to {} s)", number(step_s), number(steps.round()), number(time.end_s));
        return Err(unexpected(step, &format!("a step that needs at most {MOST_STEPS:e} steps"), &found));
    }
    Ok(())
}

fn validate_diverge(diverge: &Diverge, at: Path) -> Result<()> {
    if let Some(factor) = diverge.energy_factor.filter(|factor| *factor <= 1.0) {
        return Err(unexpected(at.key("energy_factor"), "a number greater than 1", &number(factor)));
    }
    diverge.speed_m_s.map_or(Ok(()), |speed| positive(speed, at.key("speed_m_s")))?;
    diverge.penetration_m.map_or(Ok(()), |depth| positive(depth, at.key("penetration_m")))
}

fn validate_limits(limits: &Limits, at: Path) -> Result<()> {
    limits.wall_s.map_or(Ok(()), |wall_s| positive(wall_s, at.key("wall_s")))?;
    for (key, count) in [("steps", limits.steps), ("events", limits.events)] {
        if count == Some(0) {
            return Err(unexpected(at.key(key), "a whole number of at least 1", "0"));
        }
    }
    Ok(())
}

fn validate_record(record: &Record, at: Path) -> Result<()> {
    not_negative(record.every_s, at.key("every_s"))?;
    positive(record.max_mb, at.key("max_mb"))?;
    match record.cases {
        RecordCases::Sample(count) => at_least_one(count, at.key("cases").key("sample")),
        _ => Ok(()),
    }
}

fn validate_measure(experiment: &Experiment, at: Path) -> Result<()> {
    let critical = experiment.measure.iter().position(|measure| *measure == Measure::CriticalStep);
    match critical {
        None => Ok(()),
        Some(_) if experiment.method.facts().contact == ContactModel::Springs => Ok(()),
        Some(i) => {
            let expected = "what every method has, as only the step of the method `penalty` is critical";
            Err(unexpected(at.item(i, None), expected, "`critical-step`"))
        }
    }
}
