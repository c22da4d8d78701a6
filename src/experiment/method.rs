//! The vocabulary of `method:`: every method with its settings, defaults with their reasons. A part of `types.rs`.

use super::accuracy::Accuracy;
use super::checks::{
    Result, at_least_one, holds_a_face, listed, not_negative, positive, reachable, relaxation, series, unexpected,
};
use super::defaults::is_default;
use super::error::number;
use super::facts::{About, Approach, ContactModel, Facts, MethodSettings, Restitution, about};
use super::integrator::Integrator;
use super::key_path::Path;
use super::solver::Solver;
use super::tolerances::{DEFAULT_TOLERANCE, SMALLEST_GLOBAL, SMALLEST_TOLERANCE};
use super::variants::*;
use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// A method: one word, or one key with settings. The exchangeable unit is the whole step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, IntoStaticStr)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[strum(serialize_all = "kebab-case")]
pub enum Method {
    Free(Free),
    Lecture(Lecture),
    Penalty(Penalty),
    TimeStepping(TimeStepping),
    EventDriven(EventDriven),
    Auto(Auto),
}

/// A method that steps, with its settings. `auto` is none: it chooses one of them (`study/choose.rs`).
#[derive(Clone, Debug, PartialEq)]
pub enum SteppingMethod {
    Free(Free),
    Lecture(Lecture),
    Penalty(Penalty),
    TimeStepping(TimeStepping),
    EventDriven(EventDriven),
}

impl Method {
    /// The method itself, if it steps.
    ///
    /// # Errors
    /// It leaves that to another one.
    pub fn stepping(&self) -> std::result::Result<SteppingMethod, &Auto> {
        Ok(match self {
            Method::Free(settings) => SteppingMethod::Free(settings.clone()),
            Method::Lecture(settings) => SteppingMethod::Lecture(settings.clone()),
            Method::Penalty(settings) => SteppingMethod::Penalty(settings.clone()),
            Method::TimeStepping(settings) => SteppingMethod::TimeStepping(settings.clone()),
            Method::EventDriven(settings) => SteppingMethod::EventDriven(settings.clone()),
            Method::Auto(auto) => return Err(auto),
        })
    }
}

impl From<SteppingMethod> for Method {
    fn from(method: SteppingMethod) -> Self {
        match method {
            SteppingMethod::Free(settings) => Method::Free(settings),
            SteppingMethod::Lecture(settings) => Method::Lecture(settings),
            SteppingMethod::Penalty(settings) => Method::Penalty(settings),
            SteppingMethod::TimeStepping(settings) => Method::TimeStepping(settings),
            SteppingMethod::EventDriven(settings) => Method::EventDriven(settings),
        }
    }
}

impl Default for Method {
    /// The sound method: nobody should get the lecture's instability without asking for it.
    fn default() -> Self {
        Method::TimeStepping(TimeStepping::default())
    }
}

impl Method {
    /// The one `match` of the vocabulary: whatever else is asked of a method, its settings answer.
    pub fn settings(&self) -> &dyn MethodSettings {
        match self {
            Method::Free(settings) => settings,
            Method::Lecture(settings) => settings,
            Method::Penalty(settings) => settings,
            Method::TimeStepping(settings) => settings,
            Method::EventDriven(settings) => settings,
            Method::Auto(settings) => settings,
        }
    }

    pub fn facts(&self) -> Facts {
        self.settings().facts()
    }

    /// Setting that makes the method more accurate.
    pub fn accuracy(&self) -> Accuracy {
        self.facts().accuracy
    }

    /// Tolerance that the method controls its error by.
    pub fn tolerance(&self) -> Option<f64> {
        self.facts().tolerance
    }

    /// Whether the method goes from event to event; the clock then says only when to end.
    pub fn follows_events(&self) -> bool {
        self.facts().follows_events
    }

    /// Law of the method's impacts; Newton's where it has no choice of them.
    pub fn impact(&self) -> Impact {
        self.facts().impact.unwrap_or(Impact::Newton)
    }

    /// Stiffness of the springs that it has in place of a law of contact.
    pub fn stiffness_n_m(&self) -> Option<f64> {
        self.penalty().map(|settings| settings.stiffness_n_m)
    }

    /// Settings of the penalty method; none of any other.
    pub fn penalty(&self) -> Option<&Penalty> {
        match self {
            Method::Penalty(settings) => Some(settings),
            _ => None,
        }
    }

    /// Word of the method in the file.
    pub fn word(&self) -> &'static str {
        self.into()
    }
}

/// Motion without contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Free {
    #[serde(default)]
    pub integrator: Integrator,
    /// Error of one inner step of `dop853` and `taylor`, relative and absolute; where absent, 1e-9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}

impl MethodSettings for Free {
    fn facts(&self) -> Facts {
        Facts {
            accuracy: self.integrator.accuracy(),
            tolerance: self.controls_its_error().then(|| self.tolerance.unwrap_or(DEFAULT_TOLERANCE)),
            follows_events: false,
            chooses: false,
            contact: ContactModel::None,
            solves_contacts: false,
            approach: Approach::Inside,
            impact: None,
            restitution: Restitution::All,
            needs_mesh: false,
            pins: true,
            tangents_anyway: None,
            gyroscopic: true,
            position_correction: None,
            solver: None,
            integrator: Some(self.integrator),
        }
    }

    fn about(&self) -> About {
        about(
            "Motion without contact, with pins; `tolerance` is of one inner step of dop853 and taylor, relative and \
             absolute.",
            "lecture L4, L5, L24",
        )
    }

    fn unless_set(&self, _: &str) -> String {
        format!("{DEFAULT_TOLERANCE:e}")
    }

    fn check(&self, at: Path) -> Result<()> {
        let Some(tolerance) = self.tolerance else { return Ok(()) };
        let refused = |expected: String| Err(unexpected(at.key("tolerance"), &expected, &number(tolerance)));
        if !self.controls_its_error() {
            let with = |integrator: &&Integrator| Free { integrator: **integrator, tolerance: None };
            let others = Integrator::ALL.iter().filter(|integrator| with(integrator).controls_its_error());
            return refused(format!(
                "no tolerance, as `{}` does not control its error ({} do)",
                self.integrator.word(),
                listed(others.map(|integrator| integrator.word()))
            ));
        }
        if tolerance < SMALLEST_TOLERANCE {
            return refused(format!("a number of at least {SMALLEST_TOLERANCE:e}"));
        }
        Ok(())
    }
}

impl Free {
    fn controls_its_error(&self) -> bool {
        matches!(self.integrator.accuracy(), Accuracy::Tolerance(_))
    }
}

/// The lecture's constraint method with all its variants (L16–L21).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Lecture {
    pub start: Start,
    pub iteration: Iteration,
    pub correction: Correction,
    #[serde(skip_serializing_if = "is_default")]
    pub cone: Cone,
    pub sweeps: u32,
    pub update: Update,
    pub rotation: Rotation,
}

impl Default for Lecture {
    /// The variant that reproduces both of the lecture's stability notes.
    fn default() -> Self {
        Lecture {
            start: Start::None,
            iteration: Iteration::GaussSeidel,
            correction: Correction::AfterSweep,
            cone: Cone::Disc,
            sweeps: 50,
            update: Update::SemiImplicit,
            rotation: Rotation::Literal,
        }
    }
}

impl MethodSettings for Lecture {
    fn facts(&self) -> Facts {
        Facts {
            accuracy: Accuracy::Step,
            tolerance: None,
            follows_events: false,
            chooses: false,
            contact: ContactModel::Law,
            solves_contacts: false,
            approach: Approach::Inside,
            impact: None,
            restitution: Restitution::Normal,
            needs_mesh: true,
            pins: false,
            tangents_anyway: Some("the lecture corrects after the sweep: tangent rows are felt inside it"),
            gyroscopic: self.rotation != Rotation::Literal,
            position_correction: None,
            solver: None,
            integrator: None,
        }
    }

    fn about(&self) -> About {
        about(
            "The lecture's constraint method, of order 1; unstable at long steps and with many nodes.",
            "lecture L16–L21",
        )
    }

    fn check(&self, at: Path) -> Result<()> {
        at_least_one(self.sweeps, at.key("sweeps"))
    }
}

/// Spring and damper per penetrating node (L15).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Penalty {
    pub stiffness_n_m: f64,
    #[serde(default)]
    pub damping_n_s_m: f64,
    /// Slip below which the regularised Coulomb force falls linearly to 0.
    #[serde(default = "default_slip_speed")]
    pub slip_speed_m_s: f64,
    #[serde(default)]
    pub update: Update,
    #[serde(default = "momentum")]
    pub rotation: Rotation,
}

impl MethodSettings for Penalty {
    fn facts(&self) -> Facts {
        Facts {
            accuracy: Accuracy::Step,
            tolerance: None,
            follows_events: false,
            chooses: false,
            contact: ContactModel::Springs,
            solves_contacts: false,
            approach: Approach::Inside,
            impact: None,
            restitution: Restitution::None { instead: "`damping_n_s_m` dissipates" },
            needs_mesh: true,
            pins: false,
            tangents_anyway: Some("a force of slip takes their place"),
            gyroscopic: self.rotation != Rotation::Literal,
            position_correction: None,
            solver: None,
            integrator: None,
        }
    }

    fn about(&self) -> About {
        about("A spring and a damper in every penetrating node, of order 1; critical step 2/√λmax.", "lecture L15")
    }

    fn check(&self, at: Path) -> Result<()> {
        positive(self.stiffness_n_m, at.key("stiffness_n_m"))?;
        not_negative(self.damping_n_s_m, at.key("damping_n_s_m"))?;
        positive(self.slip_speed_m_s, at.key("slip_speed_m_s"))
    }
}

/// A thousandth of the speeds met in the lecture's scene (some m/s): slower slip counts as sticking, larger values
/// creep more on a slope, smaller ones need smaller steps.
fn default_slip_speed() -> f64 {
    1e-2
}

fn momentum() -> Rotation {
    Rotation::Momentum
}

/// Velocity–impulse time-stepping (Moreau 1988; Stewart & Trinkle 1996; Anitescu & Potra 1997).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TimeStepping {
    pub solver: Solver,
    pub scheme: Scheme,
    pub impact: Impact,
    /// Most sweeps of a step; of `newton` most proximal problems. Where absent, the solver's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sweeps: Option<u32>,
    /// Change of an impulse below which sweeps stop, of the largest impulse; 0: only when nothing changes. Of `newton`
    /// the residual of the law of contact. Where absent, the solver's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    pub position_correction: PositionCorrection,
    #[serde(skip_serializing_if = "is_default")]
    pub local: Local,
    /// Part of a contact's change that is made at its turn, between 0 and 2. Below 1 fewer impacts end in a limit
    /// cycle, and all take longer.
    #[serde(skip_serializing_if = "is_one")]
    pub relaxation: f64,
    #[serde(skip_serializing_if = "is_default")]
    pub order: Order,
    /// Most contacts of a body on a face that are solved, the deepest and those farthest from each other; the others
    /// get no impulse. Where absent, all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contacts_per_face: Option<u32>,
}

fn is_one(x: &f64) -> bool {
    *x == 1.0
}

impl Default for TimeStepping {
    fn default() -> Self {
        TimeStepping {
            solver: Solver::Auto,
            scheme: Scheme::SemiImplicit,
            impact: Impact::Newton,
            sweeps: None,
            tolerance: None,
            position_correction: PositionCorrection::Projection,
            local: Local::Common,
            relaxation: 1.0,
            order: Order::ForthAndBack,
            contacts_per_face: None,
        }
    }
}

impl TimeStepping {
    /// Most sweeps of a step: those given, or the solver's own; none: the solver counts for itself.
    pub fn sweeps(&self) -> Option<u32> {
        self.sweeps.or(self.solver.facts().sweeps)
    }

    /// Tolerance of the solver: the one given, or the solver's own.
    pub fn tolerance(&self) -> f64 {
        self.tolerance.unwrap_or(self.solver.facts().tolerance)
    }

    /// Settings of sweeps mean nothing to a solver of all contacts at once, nor their number to one that counts for
    /// itself.
    fn only_what_the_solver_reads(&self, at: Path) -> Result<()> {
        if self.sweeps.is_some() && self.solver.facts().sweeps.is_none() {
            let counted = Solver::ALL.iter().filter(|solver| solver.facts().sweeps.is_some());
            let expected = format!(
                "nothing, as the solver `{}` counts for itself ({} take a number of sweeps)",
                self.solver.word(),
                listed(counted.map(|solver| solver.word()))
            );
            return Err(unexpected(at.key("sweeps"), &expected, "a number of sweeps"));
        }
        let TimeStepping { local, relaxation, order, .. } = Default::default();
        let given = [
            ("local", self.local != local),
            ("relaxation", self.relaxation != relaxation),
            ("order", self.order != order),
        ];
        match given.iter().find(|(_, given)| *given) {
            Some((key, _)) if !self.solver.facts().by_contact => {
                let sweep = Solver::ALL.iter().filter(|solver| solver.facts().by_contact);
                let expected = format!(
                    "nothing, as the solver `{}` solves all contacts at once ({} sweep)",
                    self.solver.word(),
                    listed(sweep.map(|solver| solver.word()))
                );
                Err(unexpected(at.key(key), &expected, "a setting of sweeps"))
            }
            _ => Ok(()),
        }
    }
}

impl MethodSettings for TimeStepping {
    fn facts(&self) -> Facts {
        Facts {
            // The tolerance of `time-stepping` is its solver's, not the motion's.
            accuracy: Accuracy::Step,
            tolerance: None,
            follows_events: false,
            chooses: false,
            contact: ContactModel::Law,
            solves_contacts: true,
            approach: match self.scheme {
                Scheme::SemiImplicit => Approach::Start,
                Scheme::Moreau => Approach::Middle,
            },
            impact: Some(self.impact),
            restitution: Restitution::of(self.impact),
            needs_mesh: false,
            pins: self.impact.has_all(),
            tangents_anyway: None,
            gyroscopic: true,
            position_correction: Some(self.position_correction),
            solver: Some(self.solver),
            integrator: None,
        }
    }

    fn about(&self) -> About {
        let solvers: Vec<&str> = Solver::ALL.iter().map(|solver| solver.facts().about).collect();
        about(
            format!(
                "Velocity and impulse, by {}; gaps close to zero and no further; free rotation in closed form; of \
                 order 1, with `moreau` of order 2 between impacts.",
                series(&solvers, "or")
            ),
            "Moreau 1988, 1999; Stewart & Trinkle 1996; Anitescu & Potra 1997; Glocker & Pfeiffer 1995; Stronge 1990",
        )
    }

    fn unless_set(&self, setting: &str) -> String {
        match setting {
            "sweeps" => {
                Solver::default_of(|solver| solver.sweeps.map_or("its own".to_string(), |most| most.to_string()))
            }
            "tolerance" => Solver::default_of(|solver| format!("{:e}", solver.tolerance)),
            _ => "all".to_string(),
        }
    }

    fn check(&self, at: Path) -> Result<()> {
        self.sweeps.map_or(Ok(()), |sweeps| at_least_one(sweeps, at.key("sweeps")))?;
        self.tolerance.map_or(Ok(()), |tolerance| not_negative(tolerance, at.key("tolerance")))?;
        relaxation(self.relaxation, at.key("relaxation"))?;
        self.only_what_the_solver_reads(at)?;
        self.contacts_per_face.map_or(Ok(()), |count| holds_a_face(count, at.key("contacts_per_face")))
    }
}

/// Motion from event to event: impacts, and changes between sliding, sticking and flight, are found as roots in time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EventDriven {
    /// Wanted error at the end, of positions in metres, unless the motion itself lets errors grow.
    pub tolerance: f64,
    pub impact: Impact,
}

impl Default for EventDriven {
    fn default() -> Self {
        EventDriven { tolerance: DEFAULT_TOLERANCE, impact: Impact::Newton }
    }
}

impl MethodSettings for EventDriven {
    fn facts(&self) -> Facts {
        Facts {
            accuracy: Accuracy::Tolerance(&["method", "event-driven", "tolerance"]),
            tolerance: Some(self.tolerance),
            follows_events: true,
            chooses: false,
            contact: ContactModel::Law,
            solves_contacts: true,
            approach: Approach::Inside,
            impact: Some(self.impact),
            restitution: Restitution::of(self.impact),
            needs_mesh: false,
            pins: self.impact.has_all(),
            tangents_anyway: Some("its exact solver has all rows of a contact"),
            gyroscopic: true,
            position_correction: None,
            solver: None,
            integrator: None,
        }
    }

    fn about(&self) -> About {
        about(
            format!(
                "Closed forms between events, else order 8 with a continuous extension of order 7; impacts, ends and \
                 beginnings of slips, and openings are roots in time; where events lead no further, short steps of \
                 `time-stepping` (column `work_fallbacks`). `tolerance` is of positions at the end, in metres, times \
                 the column `sensitivity` where that is above 1; at least {SMALLEST_GLOBAL:e}."
            ),
            "Dormand & Prince 8(5,3); Glocker 2001; Mirtich 1996",
        )
    }

    fn check(&self, at: Path) -> Result<()> {
        reachable(self.tolerance, at.key("tolerance"))
    }
}

/// The cheapest method and step that meet a tolerance in this scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Auto {
    /// Wanted error of positions at the end, in metres.
    pub tolerance: f64,
}

impl Default for Auto {
    /// A tolerance of a micrometre: what no engine with a fixed step reaches through an impact.
    fn default() -> Self {
        Auto { tolerance: 1e-6 }
    }
}

impl MethodSettings for Auto {
    /// Facts of what it tries first, but for the law of impact, which is left to what it chooses.
    fn facts(&self) -> Facts {
        Facts {
            accuracy: Accuracy::Tolerance(&["method", "auto", "tolerance"]),
            chooses: true,
            impact: None,
            restitution: Restitution::All,
            pins: true,
            ..EventDriven { tolerance: self.tolerance, ..EventDriven::default() }.facts()
        }
    }

    fn about(&self) -> About {
        about(
            "`event-driven`, or `time-stepping` where that stalls or falls back, or its judges do not believe it: \
             whatever two runs say is accurate enough (columns `method_used`, `error_estimate_m`, `tolerance_met`). \
             `tolerance` is of positions at the end, in metres.",
            "",
        )
    }

    fn check(&self, at: Path) -> Result<()> {
        reachable(self.tolerance, at.key("tolerance"))
    }
}
