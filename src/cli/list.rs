//! `gotai list`: what can be written, one line each.

use super::{CliError, OutputArgs, print, print_json};
use clap::{Args, ValueEnum};
use serde_json::json;
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
}

/// Word, settings with defaults, what it is, source.
type Line = (&'static str, &'static str, &'static str, &'static str);

const METHODS: [Line; 4] = [
    (
        "free",
        "integrator: explicit-euler | semi-implicit-euler (default)",
        "motion without contact; order 1",
        "lecture L4, L5",
    ),
    (
        "lecture",
        "start: none (default) | direct | inverse | pseudo-inverse; iteration: jacobi | gauss-seidel (default); \
         correction: after-sweep (default) | per-contact; sweeps: 50; update: explicit | semi-implicit (default); \
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
        "solver: pgs (default); scheme: semi-implicit (default); impact: newton (default); sweeps: 50; tolerance: 1e-12; \
         position_correction: projection (default) | none",
        "velocity–impulse with projected Gauss–Seidel, momentum-conserving rotation; order 1; the default method",
        "Moreau 1988; Stewart & Trinkle 1996; Anitescu & Potra 1997",
    ),
];

const SHAPES: [Line; 3] = [
    ("box", "size_m: [x, y, z]; mesh: { nodes_per_edge: n | [nx, ny, nz] }", "touches with corners, or mesh nodes", ""),
    ("sphere", "radius_m; mesh: { subdivisions: k }", "touches with its surface, or mesh nodes", ""),
    ("none", "", "a point with mass and inertia, without contact", ""),
];

impl Command {
    pub fn run(self) -> Result<ExitCode, CliError> {
        let lines: &[Line] = match self.what {
            What::Methods => &METHODS,
            What::Shapes => &SHAPES,
        };
        if self.output.json {
            let document: Vec<_> = lines
                .iter()
                .map(|(name, settings, what, source)| {
                    json!({ "name": name, "settings": settings, "what": what, "source": source })
                })
                .collect();
            print_json(&document);
        } else {
            for (name, settings, what, source) in lines {
                let from = if source.is_empty() { String::new() } else { format!(" [{source}]") };
                print(format!("{name:14} {what}{from}\n{:14}   {settings}", ""));
            }
        }
        Ok(ExitCode::SUCCESS)
    }
}
