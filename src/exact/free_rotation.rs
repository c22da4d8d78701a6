//! Torque-free rotation of any rigid body in closed form: angular velocity by Jacobi's functions, attitude by an
//! elliptic integral of the third kind (van Zon & Schofield, J. Comput. Phys. 225 (2007) 145; Celledoni, Fassò,
//! Säfström & Zanna, SIAM J. Sci. Comput. 30 (2008) 2084).
//!
//! P are the principal axes, right-handed. u = L_P/|L| circles axis 3, which has the largest or the smallest moment
//! (sign s = +1 if the smallest), at u₁ ≥ 0 and u₃ ≥ 0 when t = 0. With a = 1/I, α = |a₃ − a₂|, β = |a₂ − a₁| and the
//! constant D = α u₃² − β u₁² ≥ 0, which is zero on the separatrix:
//!
//! - u = (u₁ₘ cn x, −s u₂ₘ sn x, u₃ₘ dn x), x = ε + λ t, λ² = |L|² α (D + β), k′² = D (α + β) / (α (D + β))
//! - u₁ₘ² = (α − D)/(α + β), u₂ₘ² = (α − D)/α, u₃ₘ² = (D + β)/(α + β)
//! - R(t) = R(0) M(u₀) R_z(ψ) M(u)⁻¹, where M(u) is the shortest turn from axis 3 to u
//! - ψ is Euler's angle less the azimuth of u (which is undefined at u = e₃, unlike their sum): ψ̇ = |L| (a₁ u₁² + a₂
//!   u₂²)/(u₁² + u₂²) − d/dt atan2(u₂, u₁). With c = (α + β)/α = (u₂ₘ/u₁ₘ)², a constant of the body, ψ = |L| a₁ t + s
//!   (β|L|/λ) ΔJ(x) + s Δatan(√c sn x/cn x), J′ = c sn²/(cn² + c sn²)
//!
//! No difference of near numbers is left but D, I₂ − I₃ and I₁ − I₂; these and the rates are double-double.
//! Known limits: beyond 10¹⁵ half periods their count is not exact; spin within 10⁻¹⁴⁰ of the middle axis stays there.

use super::principal::{Principal, body_axes, cross, principal};
use crate::math::dd::{Dd, dot};
use crate::math::elliptic::{Jacobi, ThirdKind, carlson_rf, cel};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// Moment that is none, of the largest: that of a rod about its axis.
const NO_MOMENT: f64 = 1e-14;

/// Distance from the middle axis, squared, below which spin is about that axis: squares would underflow.
const MIDDLE: f64 = 1e-280;

#[derive(Clone, Debug)]
pub struct FreeRotation {
    motion: Motion,
}

#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "boxed, every step of a method would allocate")]
enum Motion {
    Steady(Steady),
    Tumbling(Tumbling),
}

/// ω is constant in the world but for a spin about an axis without moment, which is constant in the body.
#[derive(Clone, Debug)]
struct Steady {
    q_WB: UnitQuaternion<f64>,
    axis_W: Vector3<f64>,
    rate: Dd,
    axis_B: Vector3<f64>,
    spin: f64,
}

#[derive(Clone, Debug)]
struct Tumbling {
    /// R(0) M(u₀).
    q_WM: UnitQuaternion<f64>,
    q_PB: UnitQuaternion<f64>,
    /// ω_P = u · this.
    w_of_u: Vector3<f64>,
    /// (u₁ₘ, −s u₂ₘ, u₃ₘ).
    u_most: Vector3<f64>,
    jacobi: Jacobi,
    third: ThirdKind,
    s: f64,
    /// Weight β|L|/λ.
    weight: f64,
    lambda: Dd,
    epsilon: f64,
    /// Half period 2K; None on the separatrix.
    half_period: Option<Dd>,
    /// Rate |L| a₁.
    psi_rate: Dd,
    /// Gain of the phase in a half period, without `psi_rate`.
    psi_half_period: Dd,
    /// Phase at ε, likewise without `psi_rate`.
    psi_start: f64,
}

impl FreeRotation {
    /// The rotation from its start; `I_B` is about the centre of mass. The other two moments of a rod are equal.
    pub fn new(I_B: &Matrix3<f64>, q_WB: &UnitQuaternion<f64>, w_W: &Vector3<f64>) -> Self {
        let (moment, rate) = (power_of_two(I_B.amax()), power_of_two(w_W.amax()));
        let body = principal(&(I_B / moment));
        let motion = match Tumbling::new(&body, q_WB, &(w_W / rate), rate) {
            Some(tumbling) => Motion::Tumbling(tumbling),
            None => Motion::Steady(Steady::new(&body, q_WB, w_W)),
        };
        FreeRotation { motion }
    }

    /// Attitude and angular velocity (q_WB, w_WB) at a time of either sign. q is continuous: it does not jump to −q.
    pub fn at(&self, t_s: f64) -> (UnitQuaternion<f64>, Vector3<f64>) {
        match &self.motion {
            Motion::Steady(steady) => steady.at(t_s),
            Motion::Tumbling(tumbling) => tumbling.at(t_s),
        }
    }
}

impl Steady {
    fn new(body: &Principal, q_WB: &UnitQuaternion<f64>, w_W: &Vector3<f64>) -> Self {
        let [least, _, most] = body.moments.map(Dd::f64);
        // A point has no axis: it turns as it did.
        let rod = most > 0.0 && least <= NO_MOMENT * most;
        let axis_B = if rod { rounded(&body.axes[0]) } else { Vector3::zeros() };
        let spin = q_WB.inverse_transform_vector(w_W).dot(&axis_B);
        let across = w_W - q_WB * axis_B * spin;
        let scale = power_of_two(across.amax());
        let w = [across.x / scale, across.y / scale, across.z / scale].map(Dd::from);
        let rate = dot(&w, &w).sqrt() * Dd::from(scale);
        let axis_W = if across.amax() > 0.0 { across / rate.f64() } else { across };
        Steady { q_WB: *q_WB, axis_W, rate, axis_B, spin }
    }

    fn at(&self, t_s: f64) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let t = Dd::from(t_s);
        let spun = turn(&self.axis_B, Dd::from(self.spin) * t);
        let q_WB = turn(&self.axis_W, self.rate * t) * self.q_WB * spun;
        (q_WB, self.axis_W * self.rate.f64() + q_WB * self.axis_B * self.spin)
    }
}

impl Tumbling {
    /// The turning of a body; None if the motion is steady. The moments are scaled; ω is to be scaled by `rate`.
    fn new(body: &Principal, q_WB: &UnitQuaternion<f64>, w_W: &Vector3<f64>, rate: f64) -> Option<Self> {
        let w_B = body_axes(q_WB, w_W);
        let frame = Frame::new(body, &w_B)?;
        let Frame { s, I, alpha, beta, D, L, .. } = frame;
        let product = I[0] * I[1] * I[2];
        let (LL, both) = (dot(&L, &L), alpha + beta);
        let far = D + beta * LL;
        // |L|² (α − D).
        let near = alpha * L[1].squared() + both * L[0].squared();
        let u_most = Vector3::new(
            (near / (both * LL)).sqrt().f64(),
            -s * (near / (alpha * LL)).sqrt().f64(),
            (far / (both * LL)).sqrt().f64(),
        );
        let speed = (alpha * far).sqrt();
        let weight = if beta > Dd::ZERO { beta * LL.sqrt() / speed } else { Dd::ZERO };
        let kc = if beta > Dd::ZERO { (D * both / (alpha * far)).sqrt() } else { Dd::ONE };
        let (jacobi, third) = (Jacobi::new(kc.f64()), ThirdKind { c: (both / alpha).f64() });
        let epsilon = frame.phase();
        let [sn, cn, dn] = jacobi.at(epsilon);
        let (half_period, psi_half_period) = half_period(kc, both / alpha, weight);
        let q_WP = q_WB * quaternion(&frame.axes);
        let mut tumbling = Tumbling {
            q_WM: q_WP * shortest(&u_at(&u_most, [sn, cn, dn])),
            q_PB: quaternion(&frame.axes).inverse(),
            w_of_u: Vector3::from(I.map(|i| (LL.sqrt() / i).f64() * rate)),
            u_most,
            jacobi,
            third,
            s,
            weight: weight.f64(),
            lambda: speed / product * Dd::from(rate),
            epsilon,
            half_period,
            psi_rate: LL.sqrt() / I[0] * Dd::from(rate),
            psi_half_period: psi_half_period * Dd::from(s),
            psi_start: 0.0,
        };
        tumbling.psi_start = tumbling.psi(epsilon, [sn, cn, dn]);
        Some(tumbling)
    }

    /// Phase at |x| ≤ K, without `psi_rate`.
    fn psi(&self, x: f64, [sn, cn, dn]: [f64; 3]) -> f64 {
        let azimuth = libm::atan2(self.third.c.sqrt() * sn, cn);
        self.s * (self.weight * self.third.at(x, [sn, cn, dn], &self.jacobi) + azimuth)
    }

    fn at(&self, t_s: f64) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let t = Dd::from(t_s);
        let x = Dd::from(self.epsilon) + self.lambda * t;
        let (count, x) = self.half_period.map_or((0.0, x.f64()), |half_period| x.reduce(half_period));
        let functions = self.jacobi.at(x);
        let long = self.psi_rate * t + self.psi_half_period * Dd::from(count);
        let psi = long + Dd::from(self.psi(x, functions) - self.psi_start);
        // sn and cn change sign every half period.
        let mut u = u_at(&self.u_most, functions);
        if count % 2.0 != 0.0 {
            (u.x, u.y) = (-u.x, -u.y);
        }
        let q_WP = self.q_WM * turn(&Vector3::z(), psi) * shortest(&u).inverse();
        let mut q_WB = q_WP * self.q_PB;
        q_WB.renormalize();
        (q_WB, q_WP * u.component_mul(&self.w_of_u))
    }
}

/// Principal axes in the order and with the signs of the closed form.
struct Frame {
    s: f64,
    I: [Dd; 3],
    axes: [[Dd; 3]; 3],
    /// α, β times I₁ I₂ I₃.
    alpha: Dd,
    beta: Dd,
    /// Constant D, times I₁ I₂ I₃ |L|².
    D: Dd,
    L: [Dd; 3],
}

impl Frame {
    fn new(body: &Principal, w_B: &[Dd; 3]) -> Option<Frame> {
        let I = body.moments;
        if I[0].f64() <= NO_MOMENT * I[2].f64() {
            return None;
        }
        let L = [0, 1, 2].map(|i| I[i] * dot(&body.axes[i], w_B));
        let (alpha, beta) = (I[2] * (I[1] - I[0]), I[0] * (I[2] - I[1]));
        // Without a difference of moments; about the middle axis; without any spin; not a number.
        let off_middle = (L[0].squared() + L[2].squared()).f64();
        if (alpha, beta) == (Dd::ZERO, Dd::ZERO) || off_middle < MIDDLE || !off_middle.is_finite() {
            return None;
        }
        let D = alpha * L[0].squared() - beta * L[2].squared();
        let smallest = D > Dd::ZERO || D == Dd::ZERO && alpha >= beta;
        let (s, order) = if smallest { (1.0, [2, 1, 0]) } else { (-1.0, [0, 1, 2]) };
        let (alpha, beta, D) = if smallest { (alpha, beta, D) } else { (beta, alpha, -D) };
        let (mut axes, mut L) = (order.map(|i| body.axes[i]), order.map(|i| L[i]));
        for i in [0, 2] {
            if L[i] < Dd::ZERO {
                (axes[i], L[i]) = (axes[i].map(|x| -x), -L[i]);
            }
        }
        let right = cross(&axes[2], &axes[0]);
        if dot(&right, &axes[1]) < Dd::ZERO {
            L[1] = -L[1];
        }
        axes[1] = right;
        Some(Frame { s, I: order.map(|i| I[i]), axes, alpha, beta, D, L })
    }

    /// ε: sn and cn from L₂ and L₁, dn = u₃/u₃ₘ.
    fn phase(&self) -> f64 {
        let (alpha, beta, L) = (self.alpha, self.beta, self.L);
        let sn = Dd::from(-self.s) * alpha.sqrt() * L[1];
        let cn = (alpha + beta).sqrt() * L[0];
        let radius = (sn.squared() + cn.squared()).sqrt();
        if radius == Dd::ZERO {
            return 0.0;
        }
        let dn_squared =
            if beta > Dd::ZERO { (alpha + beta) * L[2].squared() / (self.D + beta * dot(&L, &L)) } else { Dd::ONE };
        let (sn, cn) = ((sn / radius).f64(), (cn / radius).f64());
        sn * carlson_rf(cn * cn, dn_squared.f64(), 1.0)
    }
}

/// 2K, and what Euler's angle and the azimuth gain in it.
fn half_period(kc: Dd, c: Dd, weight: Dd) -> (Option<Dd>, Dd) {
    if kc.f64() == 0.0 {
        return (None, Dd::ZERO);
    }
    let two = Dd::from(2.0);
    let J = cel(kc, c, Dd::ZERO, c);
    (Some(two * cel(kc, Dd::ONE, Dd::ONE, Dd::ONE)), two * weight * J + Dd::PI)
}

/// A power of two near the number, so that scaling by it neither rounds nor leaves squares out of range.
pub(super) fn power_of_two(x: f64) -> f64 {
    libm::ldexp(1.0, libm::frexp(x).1)
}

fn u_at(most: &Vector3<f64>, [sn, cn, dn]: [f64; 3]) -> Vector3<f64> {
    Vector3::new(most.x * cn, most.y * sn, most.z * dn).normalize()
}

/// M(u): the shortest turn from e₃ to u, u₃ ≥ 0.
fn shortest(u: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(Quaternion::new(1.0 + u.z, -u.y, u.x, 0.0))
}

pub(super) fn turn(axis: &Vector3<f64>, angle: Dd) -> UnitQuaternion<f64> {
    let (_, angle) = angle.reduce(Dd::PI * Dd::from(4.0));
    let half = angle / 2.0;
    UnitQuaternion::new_normalize(Quaternion::from_parts(libm::cos(half), axis * libm::sin(half)))
}

fn rounded(v: &[Dd; 3]) -> Vector3<f64> {
    Vector3::from(v.map(Dd::f64))
}

/// q_BP of the axes, a right-handed frame: the largest of the four components first (Shepperd, J. Guidance 1 (1978)
/// 223).
fn quaternion(axes: &[[Dd; 3]; 3]) -> UnitQuaternion<f64> {
    let [x, y, z] = axes.each_ref().map(rounded);
    let q = if x.x + y.y + z.z > 0.0 {
        Quaternion::new(1.0 + x.x + y.y + z.z, y.z - z.y, z.x - x.z, x.y - y.x)
    } else if x.x >= y.y && x.x >= z.z {
        Quaternion::new(y.z - z.y, 1.0 + x.x - y.y - z.z, y.x + x.y, z.x + x.z)
    } else if y.y >= z.z {
        Quaternion::new(z.x - x.z, y.x + x.y, 1.0 - x.x + y.y - z.z, z.y + y.z)
    } else {
        Quaternion::new(x.y - y.x, z.x + x.z, z.y + y.z, 1.0 - x.x - y.y + z.z)
    };
    UnitQuaternion::new_normalize(q)
}
