//! Needs of a scene: the stages that run, and the reasons why others are skipped.
//!
//! A skip follows from a property that is checked, never from one mesh or scene, and changes no bit of the motion.

use crate::experiment::types::{
    Approach, ContactModel, Facts, Impact, Method, PositionCorrection, Solver, rule_of_auto,
};
use crate::model::Model;
use crate::skips::Skips;

/// Stages of a run, decided once.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Whether some body can touch something, and the method looks.
    pub contact: bool,
    /// Room for contacts: every point touching the three faces of a corner at once; beyond some thousand contacts what
    /// keeps them grows when they come.
    pub contacts: usize,
    /// Whether the method claims that its impulses obey the law of contact, and is held to it.
    pub constraint: bool,
    /// Whether tangent rows are solved.
    pub friction: bool,
    /// Way of the method through a contact.
    pub approach: Approach,
    /// Whether restitution is Newton's law.
    pub newton: bool,
    /// Stiffness of the springs that a method has in place of a law of contact.
    pub stiffness_n_m: Option<f64>,
    /// What its steps leave out.
    pub skips: Skips,
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
        let facts = method.facts();
        let contact = contact(model, method.word(), facts.contact);
        let friction = friction(model, &facts, contact.runs);
        let (has_contact, has_friction) = (contact.runs, friction.runs);
        let mut stages = vec![
            contact,
            friction,
            gyroscopic(model, facts.gyroscopic),
            position_correction(facts.position_correction, has_contact),
            loads(model),
            pins(model),
        ];
        stages.extend(facts.solver.map(|solver| contact_solver(solver, has_contact)));
        stages.extend(facts.follows_events.then(|| events(model)));
        stages.extend(facts.tolerance.filter(|_| facts.chooses).map(choice));
        let newton = method.impact() == Impact::Newton;
        let constraint = has_contact && facts.contact == ContactModel::Law;
        Plan {
            contact: has_contact,
            contacts: if has_contact { most_contacts(model) } else { 0 },
            constraint,
            friction: has_friction,
            approach: facts.approach,
            newton,
            stiffness_n_m: method.stiffness_n_m().filter(|_| has_contact),
            skips: Skips::default(),
            stages,
        }
    }
}

fn most_contacts(model: &Model) -> usize {
    const MOST: usize = 4096;
    let points: usize = model.bodies.iter().map(|body| body.geometry.points()).sum();
    let faces = model.container.as_ref().map_or(0, |container| container.faces.len());
    (points * faces.min(3)).min(MOST)
}

fn stage(name: &'static str, runs: bool, why: impl Into<String>) -> Stage {
    Stage { name, runs, why: why.into() }
}

fn contact(model: &Model, method: &str, by: ContactModel) -> Stage {
    let name = "contact test";
    let feeling = model.bodies.iter().filter(|body| body.feels_container());
    let points: usize = feeling.map(|body| body.geometry.points()).sum();
    let solids = model.bodies.iter().filter(|body| body.solid().is_some()).count();
    let faces = model.container.as_ref().map_or(0, |container| container.faces.len());
    let with_faces =
        || format!("{points} points, {faces} faces; a face beyond the bounding radius costs one dot product");
    let with_others = || format!("{solids} bodies, of which only those with overlapping bounds are compared");
    match (faces > 0 && points > 0, model.touching_pairs) {
        _ if by == ContactModel::None => stage(name, false, format!("`{method}` is motion without contact")),
        (false, false) if faces == 0 && points > 0 => stage(name, false, "no container: nothing to hit"),
        (false, false) => stage(name, false, "no body has a shape"),
        (true, false) => stage(name, true, with_faces()),
        (false, true) => stage(name, true, with_others()),
        (true, true) => stage(name, true, format!("{}; {}", with_faces(), with_others())),
    }
}

fn friction(model: &Model, facts: &Facts, contact: bool) -> Stage {
    let name = "friction rows";
    let rough = model.is_rough();
    match facts.tangents_anyway {
        _ if !contact => stage(name, false, "no contact test"),
        _ if rough => stage(name, true, "μ > 0"),
        Some(why) => stage(name, true, format!("μ = 0, but {why}")),
        None => stage(name, false, "μ = 0: normal rows only"),
    }
}

fn gyroscopic(model: &Model, has_it: bool) -> Stage {
    let name = "gyroscopic term";
    if !has_it {
        stage(name, false, "`rotation: literal` leaves it out, as the slides do")
    } else if model.bodies.iter().all(|b| b.isotropic) {
        stage(name, false, "all moments of inertia are equal")
    } else {
        stage(name, true, "unequal moments of inertia")
    }
}

fn position_correction(by: Option<PositionCorrection>, contact: bool) -> Stage {
    let name = "position correction";
    match by {
        _ if !contact => stage(name, false, "no contact test"),
        Some(PositionCorrection::Projection) => stage(name, true, "only in steps that would end with a contact inside"),
        Some(PositionCorrection::None) => stage(name, false, "position_correction: none"),
        None => stage(name, false, "the method has none"),
    }
}

fn contact_solver(solver: Solver, contact: bool) -> Stage {
    let name = "contact solver";
    match solver {
        _ if !contact => stage(name, false, "no contact test"),
        Solver::Auto => stage(name, true, rule_of_auto()),
        Solver::Pgs | Solver::Nncg | Solver::Newton => {
            stage(name, true, format!("{}: {}", solver.word(), solver.facts().about))
        }
    }
}

/// Stage between the events of a method that follows them.
fn events(model: &Model) -> Stage {
    let name = "integration between events";
    let moving = || model.bodies.iter().enumerate().filter(|(_, body)| !body.driven);
    let pinned = moving().any(|(i, _)| model.pins.iter().any(|pin| pin.holds(i)));
    let loaded = moving().any(|(i, _)| model.constant_pull(i).is_none());
    match (pinned || loaded, moving().all(|(_, body)| body.is_centred_ball() || body.solid().is_none())) {
        (true, _) => stage(name, true, "pins, or forces that change: no closed form"),
        (false, true) => stage(name, false, "flight, and balls that slide straight or roll, have closed forms"),
        (false, false) => {
            stage(name, true, "only while a body turns in contact; flight, rest and straight slips are closed")
        }
    }
}

/// Stage of what `auto` considers.
fn choice(tolerance: f64) -> Stage {
    let why = format!(
        "event-driven at {tolerance:e} and finer, until two runs agree to {tolerance:e} m; where all stall or fall \
         back, time-stepping (moreau, newton), its step halved until two runs agree or a \
         budget is used up"
    );
    stage("choice of method", true, why)
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
