//! `gotai list`: what can be written, one line each.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{print, print_json};
use crate::experiment::types::{Accuracy, Exact, Integrator};
use crate::integrate::claims::{Claim, Kept, claim};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// What to list
    #[arg(value_enum)]
    what: What,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum What {
    Methods,
    Shapes,
    /// Closed forms that errors can be measured against (`exact:`)
    Exact,
    /// What `measure:` can ask for
    Measures,
}

/// Word, settings with defaults, what it is, source.
type Line = (&'static str, &'static str, &'static str, &'static str);

const METHODS: [Line; 6] = [
    (
        "free",
        "integrator: semi-implicit-euler (default), or one of those below; tolerance: 1e-9 (of dop853 and taylor)",
        "motion without contact",
        "lecture L4, L5, L24",
    ),
    (
        "lecture",
        "start: none (default) | direct | inverse | pseudo-inverse; iteration: jacobi | gauss-seidel (default); \
         correction: after-sweep (default) | per-contact; cone: disc (default) | box; sweeps: 50; update: explicit | semi-implicit (default); \
         rotation: literal (default) | momentum",
        "the lecture's constraint method, order 1; unstable at long steps and many nodes",
        "lecture L16–L21",
    ),
    (
        "penalty",
        "stiffness_n_m (needed); damping_n_s_m: 0; slip_speed_m_s: 0.01; update: explicit | semi-implicit (default); \
         rotation: literal | momentum (default)",
        "a spring and a damper in every penetrating node; critical step 2/√λmax",
        "lecture L15",
    ),
    (
        "time-stepping",
        "solver: pgs (default) | nncg | newton; scheme: semi-implicit (default) | moreau; impact: newton (default) | poisson \
         | sequential; sweeps: 50 (newton: 500); tolerance: 1e-12 (newton: 1e-10); \
         position_correction: projection (default) | none; local: common (default) | rows | exact; relaxation: 1; order: \
         fixed (default) | shuffled; contacts_per_face: all (default) or at least 3",
        "velocity–impulse with projected Gauss–Seidel, its conjugate gradients or the exact law of contact; gaps close to \
         zero and no further; free rotation in closed form; order 1, between impacts 2 with `moreau`; the default method",
        "Moreau 1988, 1999; Stewart & Trinkle 1996; Anitescu & Potra 1997; Glocker & Pfeiffer 1995; Stronge 1990",
    ),
    (
        "event-driven",
        "tolerance: 1e-9 (of positions at the end, metres, times the sensitivity where that is above 1; at least 1e-13); \
         impact: newton (default) | poisson | sequential",
        "closed forms between events, else order 8 with a continuous extension of order 7; impacts, ends and beginnings of \
         slips, and openings as roots in time; where events lead no further, short steps of time-stepping (work_fallbacks)",
        "Dormand & Prince 8(5,3); Glocker 2001; Mirtich 1996",
    ),
    (
        "auto",
        "tolerance: 1e-6 (of positions at the end, metres)",
        "event-driven, or time-stepping where that stalls or falls back: whatever two runs say is accurate enough; columns \
         method_used, error_estimate_m",
        "",
    ),
];

const SHAPES: [Line; 7] = [
    ("box", "size_m: [x, y, z]; mesh: { nodes_per_edge: n | [nx, ny, nz] }", "touches with corners, or mesh nodes", ""),
    ("sphere", "radius_m; mesh: { subdivisions: k }", "touches with its surface, or mesh nodes", ""),
    ("cylinder", "radius_m; height_m", "axis y; touches with its rims and caps", ""),
    ("capsule", "radius_m; height_m (between the centres of its spheres)", "axis y; touches with its surface", ""),
    ("ellipsoid", "semi_axes_m: [x, y, z]", "touches with its surface", ""),
    ("convex", "vertices_m: [[x, y, z], ...], corners of the hull", "polyhedron; touches with its vertices", ""),
    ("none", "", "a point with mass and inertia, without contact", ""),
];

/// The settings column says of which scenes.
const EXACT: [Line; 16] = [
    (
        Exact::FreeMotion.word(),
        "gravity, and constant or cosine forces of the world at the centre of mass; no air, no pins, no contact",
        "parabola and torque-free rotation of any body, by Jacobi elliptic functions",
        "van Zon & Schofield, JCP 225 (2007) 145",
    ),
    (
        Exact::SymmetricBody.word(),
        "the same, every body with two equal moments of inertia",
        "parabola and torque-free rotation, by elementary functions",
        "Kane, Likins & Levinson 1983, 3.1",
    ),
    (
        Exact::LinearDrag.word(),
        "gravity, constant forces of the world at the centre of mass, air with linear_drag_n_s_m",
        "Stokes' drag, exp(-c t/m), and torque-free rotation",
        "lecture L2; Stokes 1851",
    ),
    (
        Exact::QuadraticDrag.word(),
        "the same, air with a drag_coefficient; velocity along the line of the forces, or no forces",
        "Newton's drag, tanh and ln cosh, and torque-free rotation",
        "Parker, Am. J. Phys. 45 (1977) 606",
    ),
    (
        Exact::HeavyTop.word(),
        "gravity; every body one of revolution, on one pin to the world on its axis",
        "precession and nutation, sleeping top, spherical pendulum, by elliptic functions and integrals",
        "Whittaker, Analytical Dynamics, 71-75",
    ),
    (
        Exact::Pendulum.word(),
        "gravity; every body on one pin to the world, turning about a horizontal principal axis of the pin",
        "the compound plane pendulum at any amplitude, by elliptic functions",
        "Whittaker, Analytical Dynamics, 44",
    ),
    (
        Exact::Rest.word(),
        "every body at rest at the start; for piles and slopes that hold",
        "all bodies stay where they are",
        "Newton's first law",
    ),
    (
        Exact::Sliding.word(),
        "gravity, constant forces of the world at the centre of mass; one body flat on a container of one plane, without \
         spin, moving along the line of slope or on a level plane; too low to tip",
        "sliding to a stop, sticking, or starting back down; Coulomb friction",
        "Goldstein, Classical Mechanics, 1.5",
    ),
    (
        Exact::Ball.word(),
        "the same forces; one sphere and a container of one plane; where it slips, along the line of slope or on a level \
         plane",
        "flights, impacts with restitution (normal and tangential) and friction up to Zeno's point, sliding, rolling",
        "Walton 1993; Garwin, Am. J. Phys. 37 (1969) 88; Routh, Advanced Rigid Dynamics, 240",
    ),
    (
        Exact::Turntable.word(),
        "a sphere that rolls on a level box or cylinder with a kinematic spin about its vertical axis; no container",
        "circles at k/(1 + k) of the table's rate, k = I/(m r²): 2/7 of it for a homogeneous ball",
        "Routh, Advanced Rigid Dynamics, 224; Weltner, Am. J. Phys. 47 (1979) 984",
    ),
    (
        Exact::RockingBlock.word(),
        "one box on a container of one level plane, restitution 0, friction that holds; tilted about a lower edge, or turning \
         about it, not enough to overturn",
        "elliptic functions from impact to impact, until it stands",
        "Housner, Bull. Seism. Soc. Am. 53 (1963) 403",
    ),
    (
        Exact::FallingRod.word(),
        "one capsule leaning at rest, one end on a container of one level plane; no friction, restitution 0",
        "its centre falls straight down, by a quadrature; then flat at rest",
        "Routh, Elementary Rigid Dynamics, 136",
    ),
    (
        Exact::Ladder.word(),
        "one capsule leaning at rest, one end on each of a container's two planes, one level and one upright; no friction, \
         restitution 0",
        "leaves the wall at 2/3 of its height, by elliptic functions; then a falling rod that goes on sideways",
        "Routh, Elementary Rigid Dynamics, 144",
    ),
    (
        Exact::RimlessWheel.word(),
        "one regular prism (a box or a convex) on a container of one plane, restitution 0, friction that holds; tilted about \
         a lower edge, or turning about one, along the line of slope",
        "rolls over its edges, on and on or back and forth until it stands; elliptic functions from impact to impact",
        "McGeer, Int. J. Robotics Research 9 (1990) 62",
    ),
    (
        Exact::Dome.word(),
        "one sphere at rest on a fixed one, off its top; restitution 0; no friction, or friction that holds until the end",
        "slides until it leaves at 2/3 of the height, then flies; or rolls until it slips; elliptic functions",
        "Routh, Elementary Rigid Dynamics, 137",
    ),
    (
        Exact::StickSlip.word(),
        "one body flat on a container of one plane, too low to tip; one cosine force along the line that it moves on, and \
         constant forces that friction holds",
        "sticks and slips; the slips' ends are roots of a transcendental equation",
        "Den Hartog, Trans. ASME 53 (1931) 107",
    ),
];

const MEASURES: [Line; 6] = [
    (
        "state",
        "<body>.position_m.x, .orientation_xyzw.x, .velocity_m_s.x, .angular_velocity_rad_s.x, …",
        "each body's end state: centre of mass, body → world, world frame",
        "",
    ),
    (
        "inertia",
        "<body>.mass_kg, .center_of_mass_m.x, …, .inertia_kg_m2.xx, …",
        "mass properties that the run used; inertia about the centre of mass, body axes",
        "lecture L8, L9",
    ),
    (
        "contact-matrix",
        "contact_matrix_contacts, contact_matrix_rank, jacobi_radius",
        "A = J M⁻¹ Jᵀ at the first step with the most contacts: its rank, and the spectral radius of E − D⁻¹A",
        "lecture L16, L20",
    ),
    (
        "critical-step",
        "normal_lambda_max_1_kg, critical_step_s",
        "largest eigenvalue of Jn M⁻¹ Jnᵀ at the first contact, and the longest stable step of `penalty` by linear theory",
        "lecture L15",
    ),
    (
        "difference-quotients",
        "difference_forward_m_s, difference_backward_m_s, difference_central_m_s",
        "quotients of the positions of a run against its velocities, the largest difference",
        "lecture L1",
    ),
    (
        "sensitivity",
        "sensitivity (a column of every row; of `event-driven` and `auto` it is never null unless no twin arrives)",
        "twin runs whose start is displaced a little: their largest distance at the end over that at the start",
        "",
    ),
];

impl Command {
    pub fn run(self) -> Result<ExitCode, CliError> {
        let lines: &[Line] = match self.what {
            What::Methods => &METHODS,
            What::Shapes => &SHAPES,
            What::Exact => &EXACT,
            What::Measures => &MEASURES,
        };
        if self.output.json {
            print_json(&lines.iter().map(line_json).collect::<Vec<_>>());
        } else {
            for (name, settings, what, source) in lines {
                let from = if source.is_empty() { String::new() } else { format!(" [{source}]") };
                print(format!("{name:14} {what}{from}\n{:14}   {settings}", ""));
                for integrator in integrators(name) {
                    print(format!("{:14}     {}", "", promise(*integrator)));
                }
            }
        }
        Ok(ExitCode::SUCCESS)
    }
}

/// Those that a method chooses among.
fn integrators(method: &str) -> &'static [Integrator] {
    if method == "free" { &Integrator::ALL } else { &[] }
}

fn line_json((name, settings, what, source): &Line) -> Value {
    let mut line = json!({ "name": name, "settings": settings, "what": what, "source": source });
    let integrators = integrators(name);
    if !integrators.is_empty() {
        let named = |i: &Integrator| json!({ "name": i.word(), "claim": claim(*i) });
        line["integrators"] = integrators.iter().map(named).collect();
    }
    line
}

fn promise(integrator: Integrator) -> String {
    let Claim { order, energy, angular_momentum, parabola, source } = claim(integrator);
    let kept = [(energy, "energy"), (angular_momentum, "angular momentum"), (parabola, "parabola")];
    let kept: Vec<&str> = kept.iter().filter(|(kept, _)| *kept == Kept::ToRounding).map(|(_, what)| *what).collect();
    let keeps = if kept.is_empty() { String::new() } else { format!("; to rounding: {}", kept.join(", ")) };
    let order = match (integrator.accuracy(), order) {
        (_, Some(order)) => format!("order {order}"),
        (Accuracy::Closed, _) => "without error".to_string(),
        _ => "any order, as the tolerance asks".to_string(),
    };
    format!("{:19} {order}{keeps} [{source}]", integrator.word())
}
