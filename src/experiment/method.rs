//! The vocabulary of `method:`: every method with its settings, defaults with their reasons. A part of `types.rs`.

use super::defaults::is_default;
use super::tolerances::DEFAULT_TOLERANCE;
use serde::{Deserialize, Serialize};

/// The exchangeable unit is the whole step. One word, or one key with settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Method {
    Free(Free),
    Lecture(Lecture),
    Penalty(Penalty),
    TimeStepping(TimeStepping),
    EventDriven(EventDriven),
    Auto(Auto),
}

impl Default for Method {
    /// The sound method: nobody should get the lecture's instability without asking for it.
    fn default() -> Self {
        Method::TimeStepping(TimeStepping::default())
    }
}

impl Method {
    /// The law of its impacts; of a method without one, Newton's.
    pub fn impact(&self) -> Impact {
        match self {
            Method::TimeStepping(stepping) => stepping.impact,
            Method::EventDriven(settings) => settings.impact,
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::Auto(_) => Impact::Newton,
        }
    }

    /// It goes from event to event, and the clock says only when to end.
    pub fn follows_events(&self) -> bool {
        matches!(self, Method::EventDriven(_) | Method::Auto(_))
    }

    /// Its word in the file.
    pub fn word(&self) -> &'static str {
        match self {
            Method::Free(_) => "free",
            Method::Lecture(_) => "lecture",
            Method::Penalty(_) => "penalty",
            Method::TimeStepping(_) => "time-stepping",
            Method::EventDriven(_) => "event-driven",
            Method::Auto(_) => "auto",
        }
    }
}

/// Motion without contact.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Free {
    #[serde(default)]
    pub integrator: Integrator,
    /// Of `dop853` and `taylor`: error of one inner step, relative and absolute. Absent: 1e-9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}

/// What each promises: `integrate::claims`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// The slide's formula (L5): u uses the old v.
    ExplicitEuler,
    /// The slide's C program (L5): u uses the new v.
    #[default]
    SemiImplicitEuler,
    /// The trapezoidal rule.
    CrankNicolson,
    /// Keeps energy and angular momentum.
    ImplicitMidpoint,
    /// The classical Runge–Kutta method.
    Rk4,
    /// Keeps energy and angular momentum, and the symplectic form.
    MoserVeselov,
    /// Dormand and Prince's 8(5,3) with error control.
    Dop853,
    /// Taylor's series, of as high an order as the tolerance asks for.
    Taylor,
    /// The closed form: a parabola and elliptic functions, from the start in one leap to every time.
    Exact,
}

impl Integrator {
    /// All of them, as written above; a test holds this against the parser's own list.
    pub const ALL: [Integrator; 9] = [
        Integrator::ExplicitEuler,
        Integrator::SemiImplicitEuler,
        Integrator::CrankNicolson,
        Integrator::ImplicitMidpoint,
        Integrator::Rk4,
        Integrator::MoserVeselov,
        Integrator::Dop853,
        Integrator::Taylor,
        Integrator::Exact,
    ];

    /// Its word in the file.
    pub fn word(self) -> &'static str {
        match self {
            Integrator::ExplicitEuler => "explicit-euler",
            Integrator::SemiImplicitEuler => "semi-implicit-euler",
            Integrator::CrankNicolson => "crank-nicolson",
            Integrator::ImplicitMidpoint => "implicit-midpoint",
            Integrator::Rk4 => "rk4",
            Integrator::MoserVeselov => "moser-veselov",
            Integrator::Dop853 => "dop853",
            Integrator::Taylor => "taylor",
            Integrator::Exact => "exact",
        }
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

/// First guess of the constraint force (L20).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// F = 0.
    None,
    /// F = −A⁻¹ b by LU; a non-finite start is replaced by 0.
    Direct,
    /// The same with the inverse matrix.
    Inverse,
    /// The same with the Moore–Penrose inverse.
    PseudoInverse,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Iteration {
    /// The printed formula.
    Jacobi,
    /// In place.
    GaussSeidel,
}

/// When forces are put back into the friction cone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Correction {
    /// All contacts, once a sweep.
    AfterSweep,
    /// Right after the contact's three rows: this is projected Gauss–Seidel.
    PerContact,
}

/// What |f_c2, f_c3| < μ |f_c1| bounds (L19).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cone {
    /// The length of (f₂, f₃): Coulomb's law.
    #[default]
    Disc,
    /// f₂ and f₃ each, as the line can be read: up to √2 times the friction, by the direction.
    Box,
}

/// Which velocity moves the position (L5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Update {
    Explicit,
    #[default]
    SemiImplicit,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rotation {
    /// I dω/dt = τ, R ← dR R: the slide's, without the gyroscopic term.
    Literal,
    /// World-frame angular momentum conserved, midpoint rotation.
    Momentum,
}

/// Spring and damper per penetrating node (L15).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Penalty {
    pub stiffness_n_m: f64,
    #[serde(default)]
    pub damping_n_s_m: f64,
    /// Below this slip the regularised Coulomb force falls linearly to 0.
    #[serde(default = "default_slip_speed")]
    pub slip_speed_m_s: f64,
    #[serde(default)]
    pub update: Update,
    #[serde(default = "momentum")]
    pub rotation: Rotation,
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
    /// Most sweeps of a step; of `newton` most proximal problems. Absent: the solver's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sweeps: Option<u32>,
    /// Stop when a sweep changes no impulse by more than this part of the largest; 0: only when nothing changes. Of
    /// `newton` the residual of the law of contact. Absent: the solver's own.
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
    /// So many contacts of a body on a face are solved, the deepest and those farthest from each other; the others get
    /// no impulse. Absent: all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contacts_per_face: Option<u32>,
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

/// The cheapest method and step that meet a tolerance in this scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Auto {
    /// Wanted error of positions at the end, in metres.
    pub tolerance: f64,
}

impl Default for Auto {
    /// A micrometre: what no engine with a fixed step reaches through an impact.
    fn default() -> Self {
        Auto { tolerance: 1e-6 }
    }
}

fn is_one(x: &f64) -> bool {
    *x == 1.0
}

impl Default for TimeStepping {
    fn default() -> Self {
        TimeStepping {
            solver: Solver::Pgs,
            scheme: Scheme::SemiImplicit,
            impact: Impact::Newton,
            sweeps: None,
            tolerance: None,
            position_correction: PositionCorrection::Projection,
            local: Local::Common,
            relaxation: 1.0,
            order: Order::Fixed,
            contacts_per_face: None,
        }
    }
}

impl TimeStepping {
    /// Given, or the solver's own: `newton` mostly needs none, and in a pile of 125 cubes more than 200 in one step of
    /// 150.
    pub fn sweeps(&self) -> u32 {
        self.sweeps.unwrap_or(match self.solver {
            Solver::Pgs | Solver::Nncg => 50,
            Solver::Newton => 500,
        })
    }

    /// Given, or the solver's own: what is left of a sweep's change at 1e-12 is below the rounding of a step; a
    /// residual of 1e-10 is met even where 400 contacts share a force or masses are 1 : 10⁶, and `newton` mostly ends
    /// at 1e-15.
    pub fn tolerance(&self) -> f64 {
        let own = if self.solver == Solver::Newton { 1e-10 } else { 1e-12 };
        self.tolerance.unwrap_or(own)
    }
}

/// What a contact does at its turn in a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Local {
    /// The normal row, then both tangents by one step length, then the disc.
    #[default]
    Common,
    /// Every tangent row by its own diagonal (the common textbook form): it settles away from the solution.
    Rows,
    /// Its 3×3 problem solved exactly (nonlinear Gauss–Seidel).
    Exact,
}

/// In which order a sweep visits the contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Order {
    /// That of the contact test.
    #[default]
    Fixed,
    /// Another one every sweep, the same in every step.
    Shuffled,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Solver {
    /// Projected Gauss–Seidel, disc per contact.
    Pgs,
    /// Its sweeps as gradients of a nonlinear conjugate gradient method.
    Nncg,
    /// The law of contact to rounding, the smallest of all impulses that obey it.
    Newton,
}

impl Solver {
    /// Its word in the file.
    pub fn word(self) -> &'static str {
        match self {
            Solver::Pgs => "pgs",
            Solver::Nncg => "nncg",
            Solver::Newton => "newton",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Contacts and forces at the old position, position with the new velocity. Order 1.
    SemiImplicit,
    /// Half of the motion, contacts and forces there, the other half with the new velocity (J. J. Moreau 1999; θ = ½).
    /// Order 2 between impacts; without friction and with e = 1 the energy is kept.
    Moreau,
}

/// What happens to the normal velocity of an approaching contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Impact {
    /// Multiplied by −e, all contacts at once (Moreau). With friction it may gain energy.
    Newton,
    /// All contacts at once, compression and expansion (Glocker & Pfeiffer). Never gains energy.
    Poisson,
    /// One contact after the other, the fastest approach first, by the energy of its own compression (Stronge). Never
    /// gains energy.
    Sequential,
}

impl Impact {
    /// Its word in the file.
    pub fn word(self) -> &'static str {
        match self {
            Impact::Newton => "newton",
            Impact::Poisson => "poisson",
            Impact::Sequential => "sequential",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PositionCorrection {
    /// Split impulse: penetration is removed by a pseudo-velocity that is forgotten after the step.
    Projection,
    None,
}
