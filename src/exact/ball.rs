//! A ball and a plane, with restitution e, tangential restitution ε and Coulomb friction μ: flights, impacts, sliding,
//! rolling. SI units.
//!
//! - Impact (Walton, in Particulate Two-Phase Flow, 1993, ch. 25): the normal speed w becomes e w; with k = I/(m r²)
//!   the tangential impulse −(1 + ε) s k/(1 + k) turns the slip s into −ε s, if that is at most μ(1 + e) w, else μ(1 +
//!   e) w acts against s. ε = e = 1 is Garwin's superball (Am. J. Phys. 37 (1969) 88). Without a rebound, e = 0, it is
//!   ε = 0.
//! - Impacts after the first, of the normal speed w, come 2we/g_n (1 − eⁿ)/(1 − e) later; the last one (Zeno's) after
//!   2we/(g_n (1 − e)).
//! - On the plane the slip ends after |s|/((1 + 1/k) μ g_n − g_t·s/|s|); then the ball rolls with g_t/(1 + k), if that
//!   takes no more friction than μ g_n, else it slides down (Routh, Advanced Rigid Dynamics, § 240; 5/7 g sin θ for a
//!   homogeneous ball). The spin about the normal never changes.
//!
//! The attitude is by `arc.rs`. A motion asked at later and later times takes every impact once, and none beyond the
//! last time. Known limits: the error grows by some ulp with every impact before t.

use super::arc::{self, Arc};
use super::facts::{Lacks, SAME};
use super::form::{ClosedForm, ExactMotion};
use super::touching::{on_its_own, rounding_m, sphere};
use crate::model::Model;
use crate::state::BodyState;
use crate::state::State;
use nalgebra::Vector3;
use std::cell::{OnceCell, RefCell};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Flights, impacts with restitution (normal and tangential) and friction up to Zeno's point, sliding, \
           rolling.",
    source: "Walton 1993; Garwin, Am. J. Phys. 37 (1969) 88; Routh, Advanced Rigid Dynamics, 240",
    scenes: "Gravity, constant forces of the world at the centre of mass; one sphere and a container of one plane; \
           where it slips, along the line of slope or on a level plane.",
    motion,
};

/// Impacts weaker than this part of the first one are left out: their times differ by less than rounding.
const WEAKEST: f64 = 1e-18;

/// Impacts that are looked at for the end of a slip across the slope; a ball that needs more is refused.
const LOOKED_AT: u64 = 1_000_000;

/// Slip that is none, of |v| + r|ω|: what is left of a slip that has ended.
const NO_SLIP: f64 = 1e-12;

#[derive(Clone, Debug)]
pub struct Setting {
    /// Unit normal of the plane, towards the ball.
    pub normal: Vector3<f64>,
    /// Acceleration in flight, in m/s².
    pub acceleration_m_s2: Vector3<f64>,
    pub radius_m: f64,
    /// Ratio k = I/(m r²).
    pub inertia: f64,
    pub friction: f64,
    pub restitution: f64,
    pub tangential_restitution: f64,
}

#[derive(Clone, Debug)]
pub struct Ball {
    setting: Setting,
    start: BodyState,
    bounces: Option<Bounces>,
    flown: RefCell<Flown>,
    /// Arcs after the last impact.
    after: OnceCell<Vec<Arc>>,
}

/// The flight that was asked for last.
#[derive(Clone, Debug)]
struct Flown {
    /// Number of impacts before it.
    impacts: u64,
    arc: Arc,
    /// Number of impacts that all questions together have taken.
    taken: u64,
}

/// Data of all impacts.
#[derive(Clone, Debug)]
struct Bounces {
    first_s: f64,
    /// Normal speed w of the first.
    speed_m_s: f64,
    restitution: f64,
    /// Acceleration g_n towards the plane.
    press_m_s2: f64,
    /// Offset of the centre at an impact along the normal: that of the plane and the radius.
    offset_m: f64,
}

impl Ball {
    /// The motion from a start at a height (m) of the ball above the plane, 0 on it. None if the ball slides on a curve
    /// at some time.
    pub fn new(setting: Setting, start: &BodyState, height_m: f64) -> Option<Self> {
        let press = setting.press_m_s2();
        let normal_speed = setting.normal.dot(&start.v_WB);
        let on_plane = height_m == 0.0 && press > 0.0 && normal_speed.abs() <= SAME * start.v_WB.norm();
        let flight = Arc::straight(0.0, *start, setting.acceleration_m_s2);
        let flown = RefCell::new(Flown { impacts: 0, arc: flight, taken: 0 });
        let mut ball = Ball { setting, start: *start, bounces: None, flown, after: OnceCell::new() };
        if on_plane {
            ball.after = OnceCell::from(ball.setting.on_plane(0.0, *start));
            return (!ball.setting.curves(start)).then_some(ball);
        }
        ball.bounces = impact(height_m, normal_speed, press).map(|(first_s, speed_m_s)| Bounces {
            first_s,
            speed_m_s,
            restitution: ball.setting.restitution,
            press_m_s2: press,
            offset_m: ball.setting.normal.dot(&start.p_WB) - height_m,
        });
        let keeps_to_a_line = ball.bounces.as_ref().is_none_or(|bounces| ball.setting.lands_straight(bounces, start));
        keeps_to_a_line.then_some(ball)
    }

    pub fn at(&self, t_s: f64) -> BodyState {
        let end_s = self.end_s();
        if t_s < end_s {
            return self.flight_at(t_s);
        }
        arc::at(self.after.get_or_init(|| self.setting.on_plane(end_s, self.flight_at(end_s))), t_s)
    }

    /// Time at which the ball has flown for the last time, in seconds.
    pub fn end_s(&self) -> f64 {
        match &self.bounces {
            None if self.after.get().is_none() => f64::INFINITY,
            None => 0.0,
            Some(bounces) => bounces.end_s(),
        }
    }

    /// Number of impacts that were computed up to now, for all times that were asked for.
    pub fn taken(&self) -> u64 {
        self.flown.borrow().taken
    }

    /// State in the flight of this time, or at its beginning.
    fn flight_at(&self, t_s: f64) -> BodyState {
        let g = self.setting.acceleration_m_s2;
        let mut flown = self.flown.borrow_mut();
        if t_s < flown.arc.t_s {
            (flown.impacts, flown.arc) = (0, Arc::straight(0.0, self.start, g));
        }
        let Some(bounces) = &self.bounces else { return flown.arc.at(t_s) };
        for n in flown.impacts..bounces.count() {
            let impact_s = bounces.time_s(n);
            if impact_s > t_s {
                break;
            }
            let mut at = flown.arc.at(impact_s);
            let normal = &self.setting.normal;
            at.p_WB += normal * (bounces.offset_m - normal.dot(&at.p_WB));
            self.setting.strike(&mut at, bounces.speed_m_s(n));
            *flown = Flown { impacts: n + 1, arc: Arc::straight(impact_s, at, g), taken: flown.taken + 1 };
        }
        flown.arc.at(t_s)
    }
}

/// Time and normal speed of the first impact.
fn impact(height_m: f64, normal_speed: f64, press: f64) -> Option<(f64, f64)> {
    let squared = normal_speed * normal_speed + 2.0 * press * height_m;
    if squared < 0.0 || (press <= 0.0 && normal_speed >= 0.0) {
        return None;
    }
    let speed = squared.sqrt();
    let time =
        if normal_speed > 0.0 { (normal_speed + speed) / press } else { 2.0 * height_m / (speed - normal_speed) };
    Some((time, speed))
}

impl Bounces {
    fn count(&self) -> u64 {
        match self.restitution {
            _ if self.press_m_s2 <= 0.0 => 1,
            0.0 => 1,
            1.0 => u64::MAX,
            e => libm::ceil(libm::log(WEAKEST) / libm::log(e)) as u64,
        }
    }

    fn time_s(&self, n: u64) -> f64 {
        let e = self.restitution;
        let sum = match (n, e) {
            (0, _) => return self.first_s,
            (_, 1.0) => n as f64,
            (_, 0.0) => 1.0,
            _ => -libm::expm1(n as f64 * libm::log(e)) / (1.0 - e),
        };
        self.first_s + 2.0 * self.speed_m_s * e / self.press_m_s2 * sum
    }

    fn speed_m_s(&self, n: u64) -> f64 {
        self.speed_m_s * libm::pow(self.restitution, n as f64)
    }

    fn end_s(&self) -> f64 {
        let e = self.restitution;
        if self.press_m_s2 <= 0.0 || e == 1.0 {
            return f64::INFINITY;
        }
        self.first_s + 2.0 * self.speed_m_s * e / (self.press_m_s2 * (1.0 - e))
    }
}

impl Setting {
    /// Acceleration g_n towards the plane.
    fn press_m_s2(&self) -> f64 {
        -self.normal.dot(&self.acceleration_m_s2)
    }

    fn along(&self, v: &Vector3<f64>) -> Vector3<f64> {
        v - self.normal * self.normal.dot(v)
    }

    /// Velocity of the point of contact along the plane.
    fn slip(&self, at: &BodyState) -> Vector3<f64> {
        self.along(&at.v_WB) - at.w_WB.cross(&self.normal) * self.radius_m
    }

    /// Change of the spin by the friction of a unit mass.
    fn turning(&self, friction: &Vector3<f64>) -> Vector3<f64> {
        -self.normal.cross(friction) / (self.inertia * self.radius_m)
    }

    fn strike(&self, at: &mut BodyState, speed: f64) {
        let (slip, limit) = (self.slip(at), self.friction * (1.0 + self.restitution) * speed);
        let back = if self.restitution > 0.0 { self.tangential_restitution } else { 0.0 };
        let turning = -slip * ((1.0 + back) * self.inertia / (1.0 + self.inertia));
        let needed = turning.norm();
        let push = if needed <= limit { turning } else { turning * (limit / needed) };
        at.v_WB = self.along(&at.v_WB) + push + self.normal * (self.restitution * speed);
        at.w_WB += self.turning(&push);
    }

    /// Part of the acceleration along the plane.
    fn pull(&self) -> Vector3<f64> {
        let pull = self.along(&self.acceleration_m_s2);
        if pull.norm() <= 4.0 * f64::EPSILON * self.acceleration_m_s2.norm() { Vector3::zeros() } else { pull }
    }

    /// Slip that is rounding, in m/s.
    fn no_slip_m_s(&self, at: &BodyState) -> f64 {
        NO_SLIP * (at.v_WB.norm() + at.w_WB.norm() * self.radius_m)
    }

    /// The slip of a ball that slides on the plane, its direction and speed; None of one that rolls.
    fn sliding(&self, at: &BodyState) -> Option<(Vector3<f64>, f64)> {
        let slip = self.slip(at);
        let speed = slip.norm();
        (speed > self.no_slip_m_s(at)).then_some((slip / speed, speed))
    }

    /// Whether a ball on the plane slides on a curve: friction turns its slip towards the pull.
    fn curves(&self, at: &BodyState) -> bool {
        let (at, pull) = (BodyState { v_WB: self.along(&at.v_WB), ..*at }, self.pull());
        let across = |(direction, _): (Vector3<f64>, f64)| pull.cross(&direction).norm() > SAME * pull.norm();
        self.friction * self.press_m_s2() != 0.0 && self.sliding(&at).is_some_and(across)
    }

    /// Whether a ball that has bounced for the last time does not slide on a curve: there is no slope, or its slip has
    /// come into line with it. Flights and impacts keep a slip along the slope there.
    fn lands_straight(&self, bounces: &Bounces, start: &BodyState) -> bool {
        let (pull, end_s) = (self.pull(), bounces.end_s());
        let slides_for_ever = self.friction * self.press_m_s2() == 0.0;
        if pull == Vector3::zeros() || slides_for_ever || end_s == f64::INFINITY {
            return true;
        }
        let (mut at, mut t_s) = (BodyState { v_WB: self.along(&start.v_WB), ..*start }, 0.0);
        for n in 0..bounces.count() {
            let impact_s = bounces.time_s(n);
            at.v_WB = self.along(&at.v_WB) + pull * (impact_s - t_s);
            let slip = self.slip(&at);
            let across = pull.cross(&slip).norm() / pull.norm();
            if across <= SAME * slip.norm() {
                return true;
            }
            // All that friction can still do to the slip: (1 + 1/k) μ (1 + e) w/(1 − e).
            let e = self.restitution;
            let most = (1.0 + 1.0 / self.inertia) * self.friction * (1.0 + e) * bounces.speed_m_s(n) / (1.0 - e);
            if n == LOOKED_AT || across > 2.0 * most + self.no_slip_m_s(&at) {
                return false;
            }
            self.strike(&mut at, bounces.speed_m_s(n));
            t_s = impact_s;
        }
        at.v_WB = self.along(&at.v_WB) + pull * (end_s - t_s);
        !self.curves(&at)
    }

    /// Sliding, and what comes after it.
    fn on_plane(&self, t_s: f64, mut at: BodyState) -> Vec<Arc> {
        at.v_WB = self.along(&at.v_WB);
        let (limit, k, pull) = (self.friction * self.press_m_s2(), self.inertia, self.pull());
        let arc = |t_s: f64, from: BodyState, friction: Vector3<f64>| Arc {
            t_s,
            from,
            acceleration_m_s2: pull + friction,
            angular_rad_s2: self.turning(&friction),
        };
        if limit == 0.0 {
            return vec![arc(t_s, at, Vector3::zeros())];
        }
        let (mut t_s, mut arcs) = (t_s, Vec::new());
        if let Some((direction, speed)) = self.sliding(&at) {
            let sliding = arc(t_s, at, -direction * limit);
            let slowing = (1.0 + 1.0 / k) * limit - pull.dot(&direction);
            if slowing <= 0.0 {
                return vec![sliding];
            }
            t_s += speed / slowing;
            at = sliding.at(t_s);
            arcs.push(sliding);
        }
        let rolling = -pull * (k / (1.0 + k));
        let needed = rolling.norm();
        arcs.push(arc(t_s, at, if needed <= limit { rolling } else { rolling * (limit / needed) }));
        arcs
    }
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let (face, acceleration_m_s2) = on_its_own(model, index)?;
    let body = &model.bodies[index];
    let (radius_m, inertia) = sphere(body)?;
    let gap_m = face.gap_m(&at.p_WB) - radius_m;
    let near_m = rounding_m(radius_m, at);
    if gap_m < -near_m {
        return Err(format!("`{}` outside the plane", body.name));
    }
    let surface = model.pair(index, None);
    let setting = Setting {
        normal: face.normal,
        acceleration_m_s2,
        radius_m,
        inertia,
        friction: surface.friction,
        restitution: surface.restitution,
        tangential_restitution: surface.tangential_restitution,
    };
    let height_m = if gap_m <= near_m { 0.0 } else { gap_m };
    let ball = Ball::new(setting, at, height_m)
        .ok_or_else(|| format!("`{}` slipping along the line of slope, or on a level plane", body.name))?;
    Ok(ExactMotion::new(move |t_s| ball.at(t_s)))
}
