//! A body on a plane under a harmonic force, with Coulomb friction (J. P. Den Hartog, Trans. ASME 53 (1931) 107,
//! without the spring): along one line v̇ = a₀ + A cos(ωt + φ) − μ g_n sgn v. It sticks where the drive is within ±μ
//! g_n, else it slips. A slip begins at an arc cosine; it ends at a root of a transcendental equation, between two
//! extremes of the velocity. SI units.

use super::facts::{Lacks, SAME, point};
use super::form::{ClosedForm, ExactMotion};
use super::point_motion::{Harmonic, PointMotion};
use super::touching::{along, covers, lying_flat, only_faces};
use crate::model::Model;
use crate::state::BodyState;
use crate::state::State;
use nalgebra::Vector3;
use std::f64::consts::PI;

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "It sticks and slips; the slips' ends are roots of a transcendental equation.",
    source: "Den Hartog, Trans. ASME 53 (1931) 107",
    scenes: "One body flat on a container of one plane, too low to tip; one cosine force along the line that it moves \
           on, and constant forces that friction holds.",
    motion,
};

#[derive(Clone, Debug)]
pub struct StickSlip {
    start: BodyState,
    /// Unit vector along the line; A > 0 along it.
    line: Vector3<f64>,
    constant_m_s2: f64,
    amplitude_m_s2: f64,
    /// ω > 0.
    rate_rad_s: f64,
    phase_rad: f64,
    /// Deceleration μ g_n of a slip.
    grip_m_s2: f64,
}

#[derive(Clone, Debug)]
struct Phase {
    begin_s: f64,
    /// Sign of the velocity; 0 where it sticks.
    sign: f64,
    way: PointMotion,
}

/// Shortest slip that begins at rest, of a period.
const SHORTEST: f64 = 1e-9;

impl StickSlip {
    /// The motion from its start. `drive` is what accelerates it along the plane but friction. None if the velocity is
    /// not along the drive, or a constant part of the drive outweighs friction.
    pub fn new(start: &BodyState, constant: Vector3<f64>, drive: &Harmonic, grip_m_s2: f64) -> Option<Self> {
        use super::facts::SAME;
        let line = drive.amplitude_m_s2.try_normalize(0.0)?;
        let across = |v: &Vector3<f64>| line.cross(v).norm() > SAME * v.norm();
        let constant_m_s2 = line.dot(&constant);
        if across(&start.v_WB) || across(&constant) || constant_m_s2.abs() >= grip_m_s2 || drive.rate_rad_s == 0.0 {
            return None;
        }
        Some(StickSlip {
            start: *start,
            line,
            constant_m_s2,
            amplitude_m_s2: drive.amplitude_m_s2.norm(),
            rate_rad_s: drive.rate_rad_s.abs(),
            phase_rad: libm::copysign(1.0, drive.rate_rad_s) * drive.phase_rad,
            grip_m_s2,
        })
    }

    pub fn at(&self, t_s: f64) -> BodyState {
        let mut phase = self.first();
        loop {
            let end_s = self.end_s(&phase);
            if end_s > t_s {
                let (p_WB, v_WB) = phase.way.at(t_s - phase.begin_s);
                return BodyState { p_WB, v_WB, ..self.start };
            }
            phase = self.next(&phase, end_s);
        }
    }

    /// Times up to `until_s` at which it begins to slip, or ceases to.
    pub fn changes_s(&self, until_s: f64) -> Vec<f64> {
        let (mut phase, mut changes) = (self.first(), Vec::new());
        loop {
            let end_s = self.end_s(&phase);
            if end_s > until_s {
                return changes;
            }
            changes.push(end_s);
            phase = self.next(&phase, end_s);
        }
    }

    fn first(&self) -> Phase {
        let speed = self.line.dot(&self.start.v_WB);
        let sign = if speed == 0.0 { self.starts(self.drive_m_s2(0.0)) } else { libm::copysign(1.0, speed) };
        self.phase(0.0, self.start.p_WB, speed, sign)
    }

    fn next(&self, phase: &Phase, end_s: f64) -> Phase {
        let (p_WB, _) = phase.way.at(end_s - phase.begin_s);
        // A stick ends where the drive outgrows the grip, on the side where it is.
        let drive = self.drive_m_s2(end_s);
        let sign = if phase.sign == 0.0 { libm::copysign(1.0, drive) } else { self.starts(drive) };
        self.phase(end_s, p_WB, 0.0, sign)
    }

    /// The direction in which a drive moves it from rest.
    fn starts(&self, drive_m_s2: f64) -> f64 {
        if drive_m_s2.abs() <= self.grip_m_s2 { 0.0 } else { libm::copysign(1.0, drive_m_s2) }
    }

    fn drive_m_s2(&self, t_s: f64) -> f64 {
        self.constant_m_s2 + self.amplitude_m_s2 * libm::cos(self.rate_rad_s * t_s + self.phase_rad)
    }

    fn phase(&self, begin_s: f64, position_m: Vector3<f64>, speed: f64, sign: f64) -> Phase {
        let moves = sign.abs();
        let drive = Harmonic {
            amplitude_m_s2: self.line * (self.amplitude_m_s2 * moves),
            rate_rad_s: self.rate_rad_s,
            phase_rad: self.rate_rad_s * begin_s + self.phase_rad,
        };
        let constant_m_s2 = self.line * ((self.constant_m_s2 - sign * self.grip_m_s2) * moves);
        let way = PointMotion { position_m, velocity_m_s: self.line * speed, constant_m_s2, harmonics: vec![drive] };
        Phase { begin_s, sign, way }
    }

    /// cos(ωt + φ) where the drive is ±grip.
    fn cosine(&self, sign: f64) -> f64 {
        (sign * self.grip_m_s2 - self.constant_m_s2) / self.amplitude_m_s2
    }

    /// The first time after `t_s` by which ωt + φ is `angle`, modulo 2π.
    fn comes_s(&self, angle: f64, t_s: f64) -> f64 {
        let turns = (self.rate_rad_s * t_s + self.phase_rad - angle) / (2.0 * PI);
        let at = |n: f64| (angle + 2.0 * PI * n - self.phase_rad) / self.rate_rad_s;
        let next = libm::ceil(turns);
        if at(next) > t_s { at(next) } else { at(next + 1.0) }
    }

    fn end_s(&self, phase: &Phase) -> f64 {
        if phase.sign != 0.0 { self.stops_s(phase) } else { self.breaks_loose_s(phase.begin_s) }
    }

    /// The drive rises through the grip at −arccos, and falls through that of the other direction at arccos.
    fn breaks_loose_s(&self, begin_s: f64) -> f64 {
        let outgrows = |sign: f64| {
            let cosine = self.cosine(sign);
            let reached = cosine.abs() < 1.0;
            if reached { self.comes_s(-sign * libm::acos(cosine), begin_s) } else { f64::INFINITY }
        };
        outgrows(1.0).min(outgrows(-1.0))
    }

    /// Time at which the slip ends: the speed falls from arccos to 2π − arccos, backward from −arccos to arccos, and in
    /// one such time it comes to zero.
    fn stops_s(&self, phase: &Phase) -> f64 {
        let edge = libm::acos(self.cosine(phase.sign).clamp(-1.0, 1.0));
        let least_angle = if phase.sign > 0.0 { 2.0 * PI - edge } else { edge };
        let falls_s = (if phase.sign > 0.0 { 2.0 * PI - 2.0 * edge } else { 2.0 * edge }) / self.rate_rad_s;
        let speed = |t_s: f64| phase.sign * self.line.dot(&phase.way.at(t_s - phase.begin_s).1);
        let at_rest = phase.way.velocity_m_s == Vector3::zeros();
        let after_s = if at_rest { SHORTEST * 2.0 * PI / self.rate_rad_s } else { 0.0 };
        let mut slowest_s = self.comes_s(least_angle, phase.begin_s + after_s);
        while speed(slowest_s) >= 0.0 {
            slowest_s = self.comes_s(least_angle, slowest_s + falls_s / 2.0);
        }
        root_s([f64::max(slowest_s - falls_s, phase.begin_s), slowest_s], speed)
    }
}

/// Time between two others at which a speed that falls comes to zero.
fn root_s([mut before_s, mut after_s]: [f64; 2], speed: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle_s = (before_s + after_s) / 2.0;
        if middle_s <= before_s || middle_s >= after_s {
            return after_s;
        }
        if speed(middle_s) >= 0.0 {
            before_s = middle_s;
        } else {
            after_s = middle_s;
        }
    }
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let forces = point(model, index, at)?;
    let [face] = only_faces(model).ok_or("a `container` of one plane, and one body with a shape")?;
    let body = &model.bodies[index];
    let (feet, start) = lying_flat(body, at, &face)?;
    let [drive] = forces.harmonics[..] else { return Err("one cosine among the `forces`".into()) };
    let (normal, weight) = (face.normal, forces.constant_m_s2);
    let press = -normal.dot(&weight);
    if press <= 0.0 || normal.dot(&drive.amplitude_m_s2).abs() > SAME * drive.amplitude_m_s2.norm() {
        return Err(format!("`{}` pressed on the plane, and a cosine along it", body.name));
    }
    let friction = model.pair(index, None).friction;
    let body_slips = StickSlip::new(&start, along(&weight, &normal, weight.norm()), &drive, friction * press)
        .ok_or("everything along one line, and friction that holds what is constant")?;
    // The contact presses where its force has no moment about the centre of mass.
    let tips = drive.amplitude_m_s2.normalize() * (friction * normal.dot(&feet[0]));
    if ![tips, -tips].iter().all(|point| covers(&feet, &normal, point)) {
        return Err(format!("`{}` too low to tip: the resultant within its base", body.name));
    }
    Ok(ExactMotion::new(move |t_s| body_slips.at(t_s)))
}
