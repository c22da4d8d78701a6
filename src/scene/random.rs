//! Random start states: the same on every host, depending on the seed and the body's name alone.

use crate::experiment::types::{Direction, Random};
use crate::state::BodyState;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

/// The draws of one body.
pub struct Draws {
    rng: ChaCha8Rng,
}

impl Draws {
    pub fn new(seed: u64, name: &str) -> Self {
        Draws { rng: generator(seed, name) }
    }

    /// Replaces what `random` names and returns a number uniform on (0, 1). All draws are made whether they are asked
    /// for or not, in one order, so that asking for a spin does not change the velocity.
    pub fn next(&mut self, random: &Random, state: &mut BodyState) -> f64 {
        let rng = &mut self.rng;
        let (along_v, along_w, attitude) = (direction(rng), direction(rng), attitude(rng));
        if let Some(speed) = random.speed_m_s {
            state.v_WB = along_v * speed;
            if random.direction == Some(Direction::Downward) {
                state.v_WB.y = -state.v_WB.y.abs();
            }
        }
        if let Some(spin) = random.spin_rad_s {
            state.w_WB = along_w * spin;
        }
        if random.attitude {
            state.q_WB = attitude;
        }
        unit(rng)
    }
}

fn generator(seed: u64, name: &str) -> ChaCha8Rng {
    let digest = Sha256::new().chain_update(seed.to_le_bytes()).chain_update(name).finalize();
    ChaCha8Rng::from_seed(digest.into())
}

/// A number uniform on [−1, 1) in steps of 2⁻⁵², which is f64's epsilon.
fn symmetric(rng: &mut ChaCha8Rng) -> f64 {
    (rng.next_u64() >> 11) as f64 * f64::EPSILON - 1.0
}

/// A number uniform on (0, 1), both ends left out: odd multiples of 2⁻⁵³.
fn unit(rng: &mut ChaCha8Rng) -> f64 {
    ((rng.next_u64() >> 12) as f64 + 0.5) * f64::EPSILON
}

/// A point of the open unit disc and its squared radius, by rejection: no trigonometry, hence the same bits everywhere.
fn disc(rng: &mut ChaCha8Rng) -> (f64, f64, f64) {
    loop {
        let (x, y) = (symmetric(rng), symmetric(rng));
        let s = x * x + y * y;
        if s < 1.0 && s > 0.0 {
            return (x, y, s);
        }
    }
}

/// A direction uniform on the sphere (G. Marsaglia, Ann. Math. Stat. 43 (1972) 645).
fn direction(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    let (x, y, s) = disc(rng);
    let r = 2.0 * (1.0 - s).sqrt();
    Vector3::new(x * r, y * r, 1.0 - 2.0 * s)
}

/// An attitude uniform on SO(3): a quaternion uniform on the 3-sphere (same paper).
fn attitude(rng: &mut ChaCha8Rng) -> UnitQuaternion<f64> {
    let (x, y, s) = disc(rng);
    let (z, w, t) = disc(rng);
    let r = ((1.0 - s) / t).sqrt();
    UnitQuaternion::from_quaternion(Quaternion::new(x, y, z * r, w * r))
}
