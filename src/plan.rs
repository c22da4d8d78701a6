//! What this scene needs: the stages that run, and the reasons why others are skipped.
//!
//! A skip follows from a property that is checked, never from one mesh or scene, and changes no bit of the motion.

use crate::collide::approach::Approach;
use crate::experiment::types::{Auto, Impact, Method, Scheme};
use crate::model::Model;

/// Decided once a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Some body can touch something, and the method looks.
    pub contact: bool,
    /// The method claims that its impulses obey the law of contact, and is held to it.
    pub constraint: bool,
    /// Tangent rows are solved.
    pub friction: bool,
    /// How it steps through a contact.
    pub approach: Approach,
    /// Restitution is Newton's law.
    pub newton: bool,
    pub stages: Vec<Stage>,
}

/// A part of the work, for people.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    pub name: &'static str,
    pub runs: bool,
    pub why: String,
}

impl Plan {
    pub fn new(model: &Model, method: &Method) -> Self {
        let contact = contact(model, method);
        let friction = friction(model, method, contact.runs);
        let (has_contact, has_friction) = (contact.runs, friction.runs);
        let mut stages = vec![
            contact,
            friction,
            gyroscopic(model, method),
            position_correction(method, has_contact),
            loads(model),
            pins(model),
        ];
        stages.extend(events(model, method));
        stages.extend(choice(method));
        let newton = method.impact() == Impact::Newton;
        let constraint = has_contact && !matches!(method, Method::Penalty(_));
        Plan { contact: has_contact, constraint, friction: has_friction, approach: approach(method), newton, stages }
    }
}

/// How a method steps through a contact.
fn approach(method: &Method) -> Approach {
    match method {
        Method::TimeStepping(stepping) => match stepping.scheme {
            Scheme::SemiImplicit => Approach::Start,
            Scheme::Moreau => Approach::Middle,
        },
        // From event to event an impact takes no time, and forces do not act in it.
        Method::EventDriven(_) | Method::Auto(_) => Approach::Inside,
        Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) => Approach::Inside,
    }
}

fn stage(name: &'static str, runs: bool, why: impl Into<String>) -> Stage {
    Stage { name, runs, why: why.into() }
}

fn contact(model: &Model, method: &Method) -> Stage {
    let name = "contact test";
    let feeling = model.bodies.iter().filter(|body| body.feels_container());
    let points: usize = feeling.map(|body| body.geometry.points()).sum();
    let solids = model.bodies.iter().filter(|body| body.solid().is_some()).count();
    let faces = model.container.as_ref().map_or(0, |container| container.faces.len());
    let with_faces =
        || format!("{points} points, {faces} faces; a face beyond the bounding radius costs one dot product");
    let with_others = || format!("{solids} bodies, of which only those with overlapping bounds are compared");
    match (faces > 0 && points > 0, model.touching_pairs) {
        _ if matches!(method, Method::Free(_)) => stage(name, false, "`free` is motion without contact"),
        (false, false) if faces == 0 && points > 0 => stage(name, false, "no container: nothing to hit"),
        (false, false) => stage(name, false, "no body has a shape"),
        (true, false) => stage(name, true, with_faces()),
        (false, true) => stage(name, true, with_others()),
        (true, true) => stage(name, true, format!("{}; {}", with_faces(), with_others())),
    }
}

fn friction(model: &Model, method: &Method, contact: bool) -> Stage {
    let name = "friction rows";
    let rough = model.is_rough();
    match method {
        _ if !contact => stage(name, false, "no contact test"),
        Method::Lecture(_) if !rough => {
            stage(name, true, "μ = 0, but the lecture corrects after the sweep: tangent rows are felt inside it")
        }
        _ if !rough => stage(name, false, "μ = 0: normal rows only"),
        _ => stage(name, true, "μ > 0"),
    }
}

fn gyroscopic(model: &Model, method: &Method) -> Stage {
    use crate::experiment::types::Rotation::Literal;
    let name = "gyroscopic term";
    let literal = match method {
        Method::Lecture(s) => s.rotation == Literal,
        Method::Penalty(s) => s.rotation == Literal,
        _ => false,
    };
    if literal {
        stage(name, false, "`rotation: literal` leaves it out, as the slides do")
    } else if model.bodies.iter().all(|b| b.isotropic) {
        stage(name, false, "all moments of inertia are equal")
    } else {
        stage(name, true, "unequal moments of inertia")
    }
}

fn position_correction(method: &Method, contact: bool) -> Stage {
    use crate::experiment::types::PositionCorrection::Projection;
    let name = "position correction";
    match method {
        _ if !contact => stage(name, false, "no contact test"),
        Method::TimeStepping(s) if s.position_correction == Projection => {
            stage(name, true, "only in steps that would end with a contact inside")
        }
        Method::TimeStepping(_) => stage(name, false, "position_correction: none"),
        _ => stage(name, false, "the method has none"),
    }
}

/// What a method that follows events does between them; of other methods nothing.
fn events(model: &Model, method: &Method) -> Option<Stage> {
    if !method.follows_events() {
        return None;
    }
    let name = "integration between events";
    let moving = || model.bodies.iter().enumerate().filter(|(_, body)| !body.driven);
    let pinned = moving().any(|(i, _)| model.pins.iter().any(|pin| pin.holds(i)));
    let loaded = moving().any(|(i, _)| model.constant_pull(i).is_none());
    Some(match (pinned || loaded, moving().all(|(_, body)| body.is_centred_ball() || body.solid().is_none())) {
        (true, _) => stage(name, true, "pins, or forces that change: no closed form"),
        (false, true) => stage(name, false, "flight, and balls that slide straight or roll, have closed forms"),
        (false, false) => {
            stage(name, true, "only while a body turns in contact; flight, rest and straight slips are closed")
        }
    })
}

/// What `auto` considers; of other methods nothing.
fn choice(method: &Method) -> Option<Stage> {
    let Method::Auto(Auto { tolerance }) = method else { return None };
    let why = format!(
        "event-driven at {tolerance:e} and finer, until two runs agree to {tolerance:e} m; where all stall or fall \
         back, time-stepping (moreau, newton), its step halved until two runs agree or a \
         budget is used up"
    );
    Some(stage("choice of method", true, why))
}

fn loads(model: &Model) -> Stage {
    let name = "forces and air";
    let dragged = model.bodies.iter().filter(|body| !body.drag.is_none()).count();
    match (model.forces.len(), dragged) {
        (0, 0) => stage(name, false, "gravity alone"),
        (forces, 0) => stage(name, true, format!("{forces} applied")),
        (forces, bodies) => stage(name, true, format!("{forces} applied; {bodies} bodies feel the air")),
    }
}

fn pins(model: &Model) -> Stage {
    let name = "pins";
    match model.pins.len() {
        0 => stage(name, false, "none: every body is on its own"),
        pins => stage(name, true, format!("{pins}: {} equations, and a projection after every step", 3 * pins)),
    }
}
