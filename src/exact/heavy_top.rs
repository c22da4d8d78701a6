//! A symmetric heavy top with a fixed point, attitude and angular velocity at any time (Klein & Sommerfeld, Über die
//! Theorie des Kreisels, 1897–1910, ch. VI; Whittaker, Analytical Dynamics, §§ 71–75; integrals of the third kind as in
//! DLMF 19.7.8). Covers precession of any kind, the sleeping top, the spherical and the plane pendulum.
//!
//! Z is a frame with axis 3 upwards, A one of the body with axis 3 from the pin to the centre of mass; u = cos θ is the
//! cosine between. With a = I₃ω₃/I₁, b = L_up/I₁, β = 2mgl/I₁: u̇² = (1 − u²)(α − βu) − (b − au)² has the roots
//! u₁ ≤ u₂ ≤ 1 ≤ u₃, and u = u₁ + (u₂ − u₁) sn² x, x = x₀ + λt, λ² = β(u₃ − u₁)/4, k² = (u₂ − u₁)/(u₃ − u₁).
//!
//! q_ZA = (w, x, y, z) is held as Cayley's and Klein's α = w + iz = cos(θ/2) exp(i(φ + ψ)/2) and
//! β = x + iy = sin(θ/2) exp(i(φ − ψ)/2), which are smooth where Euler's angles are not, at u = ±1. With x′ = x − K,
//! ρ = (ω₃ − a)/2, J_c(x) = ∫ c sn²/(cn² + c sn²) dx and constants for the start:
//!
//! - √2 α = (√z₁ cn dn ± i √(z₂z₃/(u₃ − u₁)) sn)/√(1 + κ sn²) · exp i(ρt + (b + a)/(2λz₃) J_{1+κ}(x)), with z = 1 + u,
//!   κ = z₁/(u₃ − u₁)
//! - √2 β = (√y₂ cn dn ± i (u₃ − u₂) √(y₁/((u₃ − u₁)|y₃|)) sn)/(dn √(1 + κ sn²)) · exp i(−ρt + (b − a)/(2λ|y₃|)
//!   (J_{1+κ}(x′) − x′)), functions of x′, with y = 1 − u, κ = y₂/|y₃|, if κ ≤ 1;
//! - else √2 β = √(y₂(1 + c sn²))/dn · exp i(−ρt + (b − a)/(2λy₂)(x′ − (u₂ − u₁)/y₁ J_{1+c}(x′))), c = k²|y₃|/y₂
//!
//! Rates and roots are double-double, whole periods are counted. Known limits: beyond 10¹⁵ nutations their count is not
//! exact; an axis within 10⁻¹⁵ of the vertical that also does not tilt stays there; a top without a transverse moment
//! is refused; gravity that changes ω by less than 10⁻³⁰ in a turn is left out.

use super::facts::{Lacks, SAME, about, only_pin};
use super::form::{ClosedForm, ExactMotion};
use super::free_rotation::power_of_two;
use super::principal::body_axes;
use super::symmetric_body::{SymmetricBody, of_revolution};
use super::top_phase::{Amplitude, Wave};
use super::top_roots::{Roots, Start};
use crate::math::dd::Dd;
use crate::math::elliptic::{Jacobi, carlson_rf, cel};
use crate::model::Model;
use crate::state::{BodyState, State};
use nalgebra::{Complex, Quaternion, UnitQuaternion, Vector3};
use std::f64::consts::FRAC_1_SQRT_2;

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Precession and nutation, sleeping top, spherical pendulum, by elliptic functions and integrals.",
    source: "Whittaker, Analytical Dynamics, 71–75",
    scenes: "Gravity; every body one of revolution, on one pin to the world on its axis.",
    motion,
};

/// Tilt and its rate, in half radians and of the fastest rate, below which the axis is vertical.
const VERTICAL: f64 = 5e-16;

/// m g l/I₁ over the square of the fastest rate, below which there is no gravity.
const WEIGHTLESS: f64 = 1e-60;

/// A top, by its moments about the pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Top {
    pub transverse_kg_m2: f64,
    pub axial_kg_m2: f64,
    /// The axis of symmetry in the body, any length; the centre of mass is on it.
    pub axis_B: Vector3<f64>,
    /// First moment m l, the distance l from pin to centre of mass positive along the axis.
    pub first_moment_kg_m: f64,
    pub gravity_m_s2: Vector3<f64>,
}

#[derive(Clone, Debug)]
pub struct HeavyTop {
    motion: Motion,
}

#[derive(Clone, Debug)]
enum Motion {
    /// Motion without gravity, or upright or hanging for ever.
    Free(SymmetricBody),
    Nutating(Box<Nutating>),
}

#[derive(Clone, Debug)]
struct Nutating {
    q_WZ: UnitQuaternion<f64>,
    q_AB: UnitQuaternion<f64>,
    jacobi: Jacobi,
    /// Waves: α from u₁, β from u₂.
    waves: [Wave; 2],
    lambda: Dd,
    x_start: Dd,
    /// Quarter period K; None on the separatrix.
    quarter: Option<Dd>,
    /// (ω₃ − a)/2.
    spin_half: Dd,
    w_3: f64,
    /// exp of the constants of α and β.
    at_start: [Complex<f64>; 2],
    u: (f64, f64),
}

impl HeavyTop {
    /// The motion from its start. None if the transverse moment is not positive, the axial one negative, or the axis
    /// none.
    pub fn new(top: &Top, q_WB: &UnitQuaternion<f64>, w_W: &Vector3<f64>) -> Option<Self> {
        if !(top.transverse_kg_m2 > 0.0 && top.axial_kg_m2 >= 0.0 && top.axis_B.amax() > 0.0) {
            return None;
        }
        let g = top.gravity_m_s2.norm();
        let rate = (w_W.amax().powi(2) + top.first_moment_kg_m.abs() * g / top.transverse_kg_m2).sqrt();
        let nutating = (rate > 0.0).then(|| Nutating::new(top, q_WB, w_W, power_of_two(rate))).flatten();
        let motion = match nutating {
            Some(nutating) => Motion::Nutating(Box::new(nutating)),
            None => Motion::Free(SymmetricBody::new(top.transverse_kg_m2, top.axial_kg_m2, &top.axis_B, q_WB, w_W)),
        };
        Some(HeavyTop { motion })
    }

    /// Attitude and angular velocity (q_WB, w_WB) at a time of either sign.
    pub fn at(&self, t_s: f64) -> (UnitQuaternion<f64>, Vector3<f64>) {
        match &self.motion {
            Motion::Free(free) => free.at(t_s),
            Motion::Nutating(nutating) => nutating.at(t_s),
        }
    }

    /// The least and the largest cosine between up and the direction from pin to centre of mass; None without gravity.
    pub fn nutation(&self) -> Option<(f64, f64)> {
        match &self.motion {
            Motion::Free(_) => None,
            Motion::Nutating(nutating) => Some(nutating.u),
        }
    }

    /// Period of u, in seconds; in steady precession, that of small nutation. None without gravity, upright or hanging,
    /// and on the separatrix.
    pub fn nutation_period_s(&self) -> Option<f64> {
        match &self.motion {
            Motion::Free(_) => None,
            Motion::Nutating(nutating) => nutating.quarter.map(|quarter| 2.0 * (quarter / nutating.lambda).f64()),
        }
    }
}

impl Nutating {
    fn new(top: &Top, q_WB: &UnitQuaternion<f64>, w_W: &Vector3<f64>, rate: f64) -> Option<Self> {
        let axis = top.axis_B * libm::copysign(1.0, top.first_moment_kg_m);
        let (to_Z, to_A) = (from_third(&-top.gravity_m_s2), from_third(&axis));
        // q_ZA = q_WZ⁻¹ q_WB q_BA.
        let [w, x, y, z] = product(product(conjugate(to_Z), coordinates(q_WB)), to_A);
        let norm = w.squared() + x.squared() + y.squared() + z.squared();
        let root = norm.sqrt();
        let (alpha, beta) = ([w / root, z / root], [x / root, y / root]);
        let (q_WZ, q_AB) = (rounded(to_Z), rounded(conjugate(to_A)));
        let w_B = body_axes(q_WB, &(w_W / rate));
        let [p, q, w_3] = turned(conjugate(to_A), w_B);
        // Z = 2i ᾱβ is the upward direction across the axis, h + i u̇ = (p + iq) Z̄.
        let two = Dd::from(2.0);
        let up = [two * (alpha[1] * beta[0] - alpha[0] * beta[1]), two * (alpha[0] * beta[0] + alpha[1] * beta[1])];
        let I_1 = Dd::from(top.transverse_kg_m2);
        let g = top.gravity_m_s2.map(|x| x / rate / rate);
        let g = (0..3).map(|i| Dd::from(g[i]).squared()).fold(Dd::ZERO, |sum, x| sum + x).sqrt();
        let start = Start {
            a: Dd::from(top.axial_kg_m2) * w_3 / I_1,
            beta: two * Dd::from(top.first_moment_kg_m.abs()) * g / I_1,
            y: two * (beta[0].squared() + beta[1].squared()),
            z: two * (alpha[0].squared() + alpha[1].squared()),
            h: p * up[0] + q * up[1],
            u_dot: q * up[0] - p * up[1],
            T: p.squared() + q.squared(),
        };
        let vertical = start.y.min(start.z).f64() < VERTICAL * VERTICAL && start.T.f64() < VERTICAL * VERTICAL;
        if vertical || start.beta.f64() < WEIGHTLESS {
            return None;
        }
        let number = |[re, im]: [Dd; 2]| Complex::new(re.f64(), im.f64());
        let (alpha, beta) = (number(alpha), number(beta));
        let (across, i_3) = (Complex::new(p.f64(), q.f64()), Complex::new(0.0, w_3.f64()));
        // From q̇ = ½ q ω.
        let alpha_dot = (i_3 * alpha - across.conj() * beta) / 2.0;
        let beta_dot = (-i_3 * beta + across * alpha) / 2.0;
        let mut nutating = Self::of_start(&start, w_3, rate, q_WZ, q_AB);
        let model = nutating.waves_at(0.0);
        nutating.at_start = [0, 1].map(|i| {
            let (at, at_dot) = [(alpha, alpha_dot), (beta, beta_dot)][i];
            // Both have the same argument; one of them may be zero.
            let sum = at * model[i].0.conj() + at_dot * (model[i].1 / rate).conj();
            if sum.norm() > 0.0 { sum / sum.norm() } else { Complex::new(1.0, 0.0) }
        });
        Some(nutating)
    }

    fn of_start(start: &Start, w_3: Dd, rate: f64, q_WZ: UnitQuaternion<f64>, q_AB: UnitQuaternion<f64>) -> Self {
        let roots = start.roots();
        let twice_lambda = (start.beta * roots.gap_31).sqrt();
        let kc = (roots.gap_32 / roots.gap_31).max(Dd::ZERO).sqrt();
        let quarter = (kc.f64() > 0.0).then(|| cel(kc, Dd::ONE, Dd::ONE, Dd::ONE));
        let half = Dd::from(0.5);
        Nutating {
            q_WZ,
            q_AB,
            jacobi: Jacobi::new(kc.f64()),
            waves: [
                Wave::hanging(&roots, start.sum(), twice_lambda, kc),
                Wave::upright(&roots, start.d(), twice_lambda, kc),
            ],
            lambda: twice_lambda * half * Dd::from(rate),
            x_start: Dd::from(phase(start, &roots)),
            quarter,
            spin_half: (w_3 - start.a) * half * Dd::from(rate),
            w_3: w_3.f64() * rate,
            at_start: [Complex::new(1.0, 0.0); 2],
            u: ((roots.z[0] - Dd::ONE).f64(), (Dd::ONE - roots.y[1]).f64()),
        }
    }

    /// α and β without their constants, and their rates.
    fn waves_at(&self, t_s: f64) -> [(Complex<f64>, Complex<f64>); 2] {
        let t = Dd::from(t_s);
        let x = self.x_start + self.lambda * t;
        [0, 1].map(|i| {
            let spin = if i == 0 { self.spin_half } else { -self.spin_half };
            // Without a period, both are counted from u₁.
            let (count, x) = match self.quarter {
                Some(K) => (if i == 0 { x } else { x - K }).reduce(K + K),
                None => (0.0, x.f64()),
            };
            let Amplitude { value, slope, phase, phase_slope } = self.waves[i].at(x, &self.jacobi);
            let angle = spin * t + self.waves[i].half_period * Dd::from(count) + Dd::from(phase);
            let (_, angle) = angle.reduce(Dd::PI + Dd::PI);
            let odd = count % 2.0 != 0.0 && self.waves[i].changes_sign();
            let sign = if odd { -FRAC_1_SQRT_2 } else { FRAC_1_SQRT_2 };
            let turn = Complex::new(libm::cos(angle), libm::sin(angle)) * sign;
            let lambda = self.lambda.f64();
            let turning = Complex::new(0.0, spin.f64() + phase_slope * lambda);
            (value * turn, (slope * lambda + turning * value) * turn)
        })
    }

    fn at(&self, t_s: f64) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let [(alpha, alpha_dot), (beta, beta_dot)] = self.waves_at(t_s);
        let [c_alpha, c_beta] = self.at_start;
        let (alpha, alpha_dot, beta, beta_dot) =
            (alpha * c_alpha, alpha_dot * c_alpha, beta * c_beta, beta_dot * c_beta);
        let q_ZA = UnitQuaternion::new_normalize(Quaternion::new(alpha.re, beta.re, beta.im, alpha.im));
        let q_dot = Quaternion::new(alpha_dot.re, beta_dot.re, beta_dot.im, alpha_dot.im);
        let mut w_A = (q_ZA.inverse().into_inner() * q_dot).imag() * 2.0;
        w_A.z = self.w_3;
        let q_WA = self.q_WZ * q_ZA;
        let mut q_WB = q_WA * self.q_AB;
        q_WB.renormalize();
        (q_WB, q_WA * w_A)
    }
}

/// x₀ of u₀ and the sign of u̇₀.
fn phase(start: &Start, roots: &Roots) -> f64 {
    let (below, above) = ((-roots.v[0]).max(Dd::ZERO), roots.v[1].max(Dd::ZERO));
    let both = below + above;
    if both == Dd::ZERO {
        return 0.0;
    }
    let (sn, cc) = ((below / both).sqrt().f64(), (above / both).f64());
    let dd = (roots.v[2] / roots.gap_31).f64();
    libm::copysign(sn * carlson_rf(cc, dd, 1.0), start.u_dot.f64())
}

type Four = [Dd; 4];

fn coordinates(q: &UnitQuaternion<f64>) -> Four {
    [q.w, q.i, q.j, q.k].map(Dd::from)
}

fn conjugate([w, x, y, z]: Four) -> Four {
    [w, -x, -y, -z]
}

fn product([a, b, c, d]: Four, [w, x, y, z]: Four) -> Four {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

fn turned(q: Four, [x, y, z]: [Dd; 3]) -> [Dd; 3] {
    let [_, x, y, z] = product(product(q, [Dd::ZERO, x, y, z]), conjugate(q));
    [x, y, z]
}

fn rounded(q: Four) -> UnitQuaternion<f64> {
    let [w, x, y, z] = q.map(Dd::f64);
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

/// The shortest turn from e₃ to v, or from −e₃ after a half turn about e₁.
fn from_third(v: &Vector3<f64>) -> Four {
    let scale = power_of_two(v.amax());
    let [x, y, z] = [v.x, v.y, v.z].map(|c| Dd::from(c / scale));
    let length = (x.squared() + y.squared() + z.squared()).sqrt();
    let q = if z < Dd::ZERO { [-y, length - z, Dd::ZERO, x] } else { [length + z, -y, x, Dd::ZERO] };
    let norm = q.iter().fold(Dd::ZERO, |sum, c| sum + c.squared()).sqrt();
    q.map(|c| c / norm)
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let (pin_W, r_B) = only_pin(model, index)?;
    let body = &model.bodies[index];
    let lacks = || format!("`{}` a body of revolution, pinned on its axis", body.name);
    let (transverse, axial, axis_B) = of_revolution(&about(body, &r_B)).ok_or_else(lacks)?;
    // A ball may turn about any line through its pin.
    let axis_B = if transverse == axial && r_B != Vector3::zeros() { -r_B.normalize() } else { axis_B };
    let along = -r_B.dot(&axis_B);
    if (r_B + axis_B * along).norm() > SAME * r_B.norm() {
        return Err(lacks());
    }
    let top = Top {
        transverse_kg_m2: transverse,
        axial_kg_m2: axial,
        axis_B,
        first_moment_kg_m: body.mass_kg * along,
        gravity_m_s2: model.gravity_m_s2,
    };
    let top = HeavyTop::new(&top, &at.q_WB, &at.w_WB).ok_or_else(lacks)?;
    Ok(ExactMotion::new(move |t_s| {
        let (q_WB, w_WB) = top.at(t_s);
        let r_W = q_WB * r_B;
        BodyState { p_WB: pin_W - r_W, q_WB, v_WB: -w_WB.cross(&r_W), w_WB }
    }))
}
