//! Needs of a scene: the stages that run, and the reasons why others are skipped.
//!
//! A skip follows from a property that is checked, never from one mesh or scene, and changes no bit of the motion, or
//! none beyond the bound that its word has in the vocabulary. Where `plan: { skip }` does not name it, the stage runs
//! all the same.

use crate::experiment::types::{
    Approach, ContactModel, Facts, Impact, Method, PositionCorrection, Skip, Skips, Solver, rule_of_auto,
};
use crate::model::Model;

/// Stages of a run, decided once.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Whether some body can touch something, and the method looks.
    pub contact: bool,
    /// Whether the method looks, if only because nothing may be skipped.
    pub looks: bool,
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
    /// Skips that are allowed.
    pub skips: Skips,
    pub stages: Vec<Stage>,
}

/// A part of the work, for people.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    pub name: &'static str,
    pub runs: bool,
    /// Property that decides, the same text for all scenes that have it.
    pub why: String,
    /// What there is of it, which differs from scene to scene.
    pub sizes: Vec<(&'static str, usize)>,
    /// Word by which `plan: { skip }` allows to leave it out; None where there is nothing to allow.
    pub skip: Option<Skip>,
    /// Column that counts it.
    pub counter: Option<&'static str>,
}

impl Stage {
    fn new(name: &'static str, runs: bool, why: impl Into<String>) -> Self {
        Stage { name, runs, why: why.into(), sizes: Vec::new(), skip: None, counter: None }
    }

    /// A stage that a property makes needless, and that runs all the same where its skip is not allowed.
    fn skippable(name: &'static str, skip: Skip, skips: Skips, needed: Result<String, String>) -> Self {
        let (runs, why) = match needed {
            Ok(why) => (true, why),
            Err(why) if skips.has(skip) => (false, why),
            Err(why) => (true, format!("not needed ({why}), but `plan.skip` leaves `{}` out", skip.word())),
        };
        Stage { skip: Some(skip), counter: Some(skip.counter()), ..Stage::new(name, runs, why) }
    }

    fn of(self, sizes: impl IntoIterator<Item = (&'static str, usize)>) -> Self {
        Stage { sizes: sizes.into_iter().collect(), ..self }
    }

    fn counted(self, counter: &'static str) -> Self {
        Stage { counter: Some(counter), ..self }
    }
}

impl Plan {
    pub fn new(model: &Model, method: &Method) -> Self {
        let (facts, skips) = (method.facts(), model.skips);
        let touches = touches(model, method.word(), facts.contact);
        let has_contact = touches.is_ok();
        let contact = contact(model, &facts, touches, skips);
        let looks = contact.runs;
        let friction = friction(model, &facts, has_contact, skips);
        let has_friction = friction.runs;
        let mut stages = vec![contact];
        stages.extend(has_contact.then(|| far_away(model, skips)));
        stages.extend([
            friction,
            gyroscopic(model, facts.gyroscopic, skips),
            position_correction(facts.position_correction, has_contact),
            loads(model),
            pins(model),
        ]);
        stages.extend(facts.solver.map(|solver| contact_solver(solver, has_contact)));
        stages.extend((facts.solver.is_some() && has_contact).then(|| kept_impulses(skips)));
        let steps_alike = has_contact && facts.solver.is_some() && facts.approach == Approach::Start;
        stages.extend(steps_alike.then(|| [flight(skips), rest(skips)]).into_iter().flatten());
        stages.extend(facts.follows_events.then(|| events(model, skips)));
        stages.extend(facts.tolerance.filter(|_| facts.chooses).map(choice));
        let newton = method.impact() == Impact::Newton;
        let constraint = has_contact && facts.contact == ContactModel::Law;
        Plan {
            contact: has_contact,
            looks,
            contacts: if has_contact { most_contacts(model) } else { 0 },
            constraint,
            friction: has_friction,
            approach: facts.approach,
            newton,
            stiffness_n_m: method.stiffness_n_m().filter(|_| has_contact),
            skips,
            stages,
        }
    }
}

/// Stage of the runs beside the one that is shown, from which `sensitivity` follows.
pub fn twins(are_wanted: bool) -> Stage {
    let why = match are_wanted {
        true => "three, as `measure: [sensitivity]`, `auto` or `reference:` asks for them",
        false => "nobody asks for `sensitivity`",
    };
    Stage::new("twin runs", are_wanted, why)
}

fn most_contacts(model: &Model) -> usize {
    const MOST: usize = 4096;
    (points(model) * faces(model).min(3)).min(MOST)
}

/// Points that are held against a face.
fn points(model: &Model) -> usize {
    model.bodies.iter().filter(|body| body.feels_container()).map(|body| body.geometry.points()).sum()
}

fn faces(model: &Model) -> usize {
    model.container.as_ref().map_or(0, |container| container.faces.len())
}

/// Whether something can touch, and what; the property that says that nothing can.
fn touches(model: &Model, method: &str, by: ContactModel) -> Result<String, String> {
    match (faces(model) > 0 && points(model) > 0, model.touching_pairs) {
        _ if by == ContactModel::None => Err(format!("`{method}` is motion without contact")),
        (false, false) if faces(model) == 0 && points(model) > 0 => Err("no container: nothing to hit".to_string()),
        (false, false) => Err("no body that moves has a shape".to_string()),
        (true, false) => Ok("points against faces".to_string()),
        (false, true) => Ok("bodies against each other".to_string()),
        (true, true) => Ok("points against faces, bodies against each other".to_string()),
    }
}

fn contact(model: &Model, facts: &Facts, touches: Result<String, String>, skips: Skips) -> Stage {
    let name = "contact test";
    if facts.contact == ContactModel::None {
        let why = touches.unwrap_or_else(|why| why);
        return Stage::new(name, false, why).counted(Skip::ContactTest.counter());
    }
    let solids = model.bodies.iter().filter(|body| body.solid().is_some()).count();
    let with_faces = [("points", points(model)), ("faces", faces(model))];
    let with_others = model.touching_pairs.then_some(("bodies", solids));
    let sizes = with_faces.into_iter().filter(|_| faces(model) > 0 && points(model) > 0).chain(with_others);
    Stage::skippable(name, Skip::ContactTest, skips, touches).of(sizes)
}

fn far_away(model: &Model, skips: Skips) -> Stage {
    let why = match (faces(model) > 0, model.touching_pairs) {
        (true, false) => "a face beyond the bounding radius costs one dot product",
        (false, _) => "only bodies with overlapping bounds are compared",
        (true, true) => {
            "a face beyond the bounding radius costs one dot product; only bodies with overlapping bounds are compared"
        }
    };
    Stage::skippable("what is far away", Skip::Bounds, skips, Err(why.to_string()))
}

fn friction(model: &Model, facts: &Facts, contact: bool, skips: Skips) -> Stage {
    let name = "friction rows";
    let rough = model.is_rough();
    match facts.tangents_anyway {
        _ if !contact => Stage::new(name, false, "no contact test"),
        Some(why) if !rough => Stage::new(name, true, format!("μ = 0, but {why}")),
        _ if rough => Stage::skippable(name, Skip::FrictionRows, skips, Ok("μ > 0".to_string())),
        _ => {
            let why = match facts.solver {
                Some(Solver::Auto | Solver::Newton) => "μ = 0: normal rows only, in sweeps; exact systems have all",
                Some(Solver::Pgs | Solver::Nncg) | None => "μ = 0: normal rows only",
            };
            Stage::skippable(name, Skip::FrictionRows, skips, Err(why.to_string()))
        }
    }
}

fn gyroscopic(model: &Model, has_it: bool, skips: Skips) -> Stage {
    let name = "gyroscopic term";
    if !has_it {
        let why = "`rotation: literal` leaves it out, as the slides do";
        return Stage::new(name, false, why).counted(Skip::GyroscopicTerm.counter());
    }
    let needed = match model.bodies.iter().all(|b| b.isotropic) {
        true => Err("all moments of inertia are equal".to_string()),
        false => Ok("unequal moments of inertia".to_string()),
    };
    Stage::skippable(name, Skip::GyroscopicTerm, skips, needed)
}

fn position_correction(by: Option<PositionCorrection>, contact: bool) -> Stage {
    let name = "position correction";
    match by {
        _ if !contact => Stage::new(name, false, "no contact test"),
        Some(PositionCorrection::Projection) => {
            Stage::new(name, true, "only in steps that would end with a contact inside")
        }
        Some(PositionCorrection::None) => Stage::new(name, false, "position_correction: none"),
        None => Stage::new(name, false, "the method has none"),
    }
}

fn contact_solver(solver: Solver, contact: bool) -> Stage {
    let name = "contact solver";
    let stage = match solver {
        _ if !contact => Stage::new(name, false, "no contact test"),
        Solver::Auto => Stage::new(name, true, rule_of_auto()),
        Solver::Pgs | Solver::Nncg | Solver::Newton => {
            Stage::new(name, true, format!("{}: {}", solver.word(), solver.facts().about))
        }
    };
    stage.counted("work_contact_solves")
}

fn kept_impulses(skips: Skips) -> Stage {
    let why = "last step's impulses that still obey the law are taken as they are".to_string();
    Stage::skippable("solving what stays the same", Skip::KeptImpulses, skips, Err(why))
}

fn flight(skips: Skips) -> Stage {
    let why = "until a body can have come to something nothing is held against it".to_string();
    Stage::skippable("contact test in flight", Skip::Flight, skips, Err(why))
}

fn rest(skips: Skips) -> Stage {
    let why = "a step that would be the one before over again, bit for bit, is not made".to_string();
    Stage::skippable("steps at rest", Skip::Rest, skips, Err(why))
}

/// Stage between the events of a method that follows them.
fn events(model: &Model, skips: Skips) -> Stage {
    let name = "integration between events";
    let moving = || model.bodies.iter().enumerate().filter(|(_, body)| !body.driven);
    let pinned = moving().any(|(i, _)| model.pins.iter().any(|pin| pin.holds(i)));
    let loaded = moving().any(|(i, _)| model.constant_pull(i).is_none());
    let needed = match (pinned || loaded, moving().all(|(_, body)| body.is_centred_ball() || body.solid().is_none())) {
        (true, _) => Ok("pins, or forces that change: no closed form".to_string()),
        (false, true) => Err("flight, and balls that slide straight or roll, have closed forms".to_string()),
        (false, false) => {
            Ok("only while a body turns in contact; flight, rest and straight slips are closed".to_string())
        }
    };
    Stage::skippable(name, Skip::ClosedForms, skips, needed)
}

/// Stage of what `auto` considers.
fn choice(tolerance: f64) -> Stage {
    let why = format!(
        "event-driven at {tolerance:e} and finer, until two runs agree to {tolerance:e} m; where all stall or fall \
         back, time-stepping (moreau, newton), its step halved until two runs agree or a \
         budget is used up"
    );
    Stage::new("choice of method", true, why)
}

fn loads(model: &Model) -> Stage {
    let name = "forces and air";
    let dragged = model.bodies.iter().filter(|body| !body.drag.is_none()).count();
    let sizes = [("forces", model.forces.len()), ("bodies in air", dragged)];
    match (model.forces.len(), dragged) {
        (0, 0) => Stage::new(name, false, "gravity alone"),
        _ => Stage::new(name, true, "at every evaluation").of(sizes.into_iter().filter(|(_, count)| *count > 0)),
    }
}

fn pins(model: &Model) -> Stage {
    let name = "pins";
    let stage = match model.pins.len() {
        0 => Stage::new(name, false, "none: every body is on its own"),
        pins => Stage::new(name, true, "three equations each, and a projection after every step").of([("pins", pins)]),
    };
    stage.counted("work_pin_solves")
}
