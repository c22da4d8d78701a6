//! The end of infinitely many impacts in a finite time, as the judge of contact sees it.

use crate::yaml::experiment;
use gotai::collide::approach::Approach;
use gotai::collide::{Detector, Reach, SolvedContact};
use gotai::experiment::types::Diverge;
use gotai::measure::Judge;
use gotai::model::Model;
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::shown::{Acted, Shown};
use gotai::state::State;
use gotai::work::Work;

/// A light ball between a wall and a heavy ball that comes toward it.
const AT_A_WALL: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  restitution: 0.5
  container: { planes: [{ normal: [1, 0, 0], offset_m: -1 }] }
  bodies:
    - { name: a, shape: { sphere: { radius_m: 0.45 } }, mass_kg: 1, position_m: [-0.5, 0, 0], velocity_m_s: [1, 0, 0] }
    - { name: b, shape: { sphere: { radius_m: 0.45 } }, mass_kg: 20, position_m: [0.5, 0, 0], velocity_m_s: [-0.3, 0, 0] }
method: event-driven
time: { end_s: 4 }
";

struct Watched {
    model: Model,
    state: State,
    judge: Judge,
}

impl Watched {
    /// Normal impulses (N s) of the wall and of the two balls, where they are and touch; `ended`: without restitution.
    fn strike(&mut self, impulses: [f64; 2], ended: bool) {
        let before = self.state.clone();
        let mut found = Vec::new();
        let reach = Reach { margin: 1e-6 };
        Detector::default().detect(&self.model, &before, &reach, &mut found, &mut Work::default());
        let mut contacts = Vec::new();
        for mut contact in found {
            let p = impulses[usize::from(contact.other.is_some())];
            contact.restitution = if ended { 0.0 } else { contact.restitution };
            for (i, _, sign) in contact.ends() {
                self.state.bodies[i].v_WB += contact.normal * (p * sign / self.model.bodies[i].mass_kg);
            }
            if p > 0.0 {
                contacts.push(SolvedContact { contact, impulse_W: contact.normal * p });
            }
        }
        self.show(&before, Acted::Blow { contacts: &contacts });
    }

    fn fly(&mut self, step_s: f64) {
        let before = self.state.clone();
        self.state.bodies.iter_mut().for_each(|at| at.p_WB += at.v_WB * step_s);
        self.state.time_s += step_s;
        let acted = Acted::Kick { kicked: &before, contacts: &[], step_s, approach: Approach::Touching };
        self.show(&before, acted);
    }

    fn show(&mut self, before: &State, acted: Acted) {
        self.state.step += 1;
        let shown = Shown { before, after: &self.state, acted, way: None, stalled: None, is_last: false };
        self.judge.observe(&self.model, &shown);
    }
}

/// The residual of all impacts down to gaps of 1e-12 m, after which the light ball is at rest on the wall, and the
/// heavy one comes to it and rebounds with such a restitution.
fn residual(last_restitution: f64) -> f64 {
    let experiment = experiment(AT_A_WALL, &[]);
    let (model, state) = build(&experiment).unwrap();
    let plan = Plan::new(&model, &experiment.method);
    let judge = Judge::new(&model, &state, &Diverge::default(), &plan);
    let mut watched = Watched { model, state, judge };
    // Of the two gaps, as positions have no room for them.
    let (mut left_m, mut between_m) = (0.05, 0.1);
    loop {
        let [u, v] = [0, 1].map(|i| watched.state.bodies[i].v_WB.x);
        let closes_s = |gap_m: f64, speed: f64| if speed > 0.0 { gap_m / speed } else { f64::INFINITY };
        let all_s = [closes_s(left_m, -u), closes_s(between_m, u - v)];
        let step_s = all_s[0].min(all_s[1]);
        left_m += u * step_s;
        between_m += (v - u) * step_s;
        watched.fly(step_s);
        let is_over = left_m + between_m < 1e-12;
        if all_s[0] < all_s[1] {
            left_m = 0.0;
            watched.strike([if is_over { -u } else { -1.5 * u }, 0.0], is_over);
            if is_over {
                watched.fly(between_m / -v);
                let p = -20.0 * v * (1.0 + last_restitution);
                watched.strike([p, p], last_restitution == 0.0);
                break;
            }
        } else {
            between_m = 0.0;
            watched.strike([0.0, 1.5 * (u - v) * 20.0 / 21.0], false);
        }
    }
    watched.fly(0.1);
    let Watched { model, state, mut judge } = watched;
    judge.end(&model, &state);
    judge.residual.max.unwrap()
}

#[test]
fn what_rebounds_at_the_end_of_infinitely_many_impacts_is_seen() {
    let [right, wrong] = [0.0, 0.5].map(residual);
    // measured: below 1e-9, and 1.6e-2, which is 1/63: beside the trace of the contact's block of A
    assert!(right < 1e-9 && wrong > 1e-2, "{right:e} {wrong:e}");
}
