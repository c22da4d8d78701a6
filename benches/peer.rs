//! gotai as one of several engines in a comparison: reads a scene, prints where its bodies end and how long that took.
//!
//!     cargo build --release --locked --example peer
//!     target/release/examples/peer SCENE_FILE REPEATS DT [key=value ...]
//!
//! Keys: `method` (time-stepping, the default; event-driven, auto), `tolerance`, `scheme`, `solver`, as in an
//! experiment file. DT is the step of methods that take one. It prints one line, `RESULT dt steps wall_s n` and 13
//! numbers a body: px py pz qw qx qy qz vx vy vz wx wy wz (world frame, centre of mass, quaternion body to world).
//! `wall_s` is the best of at least REPEATS runs, stepping alone.
//!
//! The scene has one item a line, SI units:
//!
//!     scene NAME
//!     duration T
//!     gravity gx gy gz
//!     mu MU                     Coulomb coefficient of every pair
//!     restitution E             Newton restitution of every pair
//!     plane nx ny nz d          half-space, n.x >= d is free
//!     body SHAPE a b c  m  Ix Iy Iz  px py pz  qw qx qy qz  vx vy vz  wx wy wz
//!
//! SHAPE is sphere (a = radius), box (a b c = half extents), ellipsoid (a b c = semi-axes) or none (no contact).

use gotai::bench::peer;
use std::process::ExitCode;

const USAGE: &str = "usage: peer SCENE_FILE REPEATS DT [key=value ...]";

fn main() -> ExitCode {
    match result(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(line) => {
            println!("{line}");
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("peer: {message}");
            ExitCode::from(2)
        }
    }
}

fn result(args: &[String]) -> Result<String, String> {
    let [scene, repeats, step_s, settings @ ..] = args else { return Err(USAGE.to_string()) };
    let text = std::fs::read_to_string(scene).map_err(|error| format!("{scene}: {error}"))?;
    let repeats = repeats.parse().map_err(|_| format!("REPEATS: expected a whole number, found `{repeats}`"))?;
    let step_s = step_s.parse().map_err(|_| format!("DT: expected a number, found `{step_s}`"))?;
    peer::run(&text, repeats, step_s, settings).map_err(|error| format!("{scene}: {error}"))
}
