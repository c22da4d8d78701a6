//! Motion without contact (L4, L5): every island of bodies that pins join on its own.

use super::moments::moments;
use crate::clock::Clock;
use crate::deadline::Deadline;
use crate::event::motion::ClosedMotion;
use crate::exact::Closed;
use crate::experiment::tolerances::DEFAULT_TOLERANCE;
use crate::experiment::types::{Accuracy, Exact, Free as Settings, Integrator, Update};
use crate::integrate::chain::Chain;
use crate::integrate::{
    crank_nicolson, dop853, euler, implicit, implicit_midpoint, momentum, moser_veselov, rk4, taylor,
};
use crate::model::Model;
use crate::outcome::Criterion;
use crate::shown::{Moment, Smooth};
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;
use std::cell::RefCell;

/// An integrator with its scratch, of one island.
enum Method {
    Euler(Update),
    CrankNicolson(implicit::Scratch),
    /// The method's equation; when a torque acts, the step around it and where in the step it sees the drive.
    Momentum {
        equation: momentum::Equation,
        driven: implicit::Kernel,
        seen: f64,
        momenta: Vec<Vector3<f64>>,
        scratch: implicit::Scratch,
    },
    Rk4(rk4::Scratch),
    Dop853(dop853::Control, Box<dop853::Scratch>),
    Taylor(Box<taylor::Taylor>),
}

pub struct Free {
    settings: Settings,
    start: State,
    islands: Vec<(Chain, Method)>,
    /// Another one that goes the way of a step once more, in parts, for those who look; it leaves the run as it is.
    follower: RefCell<Option<Box<Free>>>,
    /// What acts on its bodies changes on the way, so that the ends of a step do not show what it did.
    shows_way: bool,
    /// From the start, for `exact`.
    motion: Option<Closed>,
    /// A step has no solution, or the tolerance is out of reach, or no time is left.
    pub(super) stalled: Option<Criterion>,
    /// Steps have time until then.
    pub(super) deadline: Deadline,
    pub(super) work: Work,
}

impl Free {
    pub fn new(settings: &Settings, model: &Model, start: &State) -> Self {
        let exact = || Closed::new(Exact::FreeMotion, model, start).ok();
        let motion = (settings.integrator == Integrator::Exact).then(exact).flatten();
        let islands = Chain::all(model, start).into_iter();
        let islands = islands.filter_map(|island| Method::new(settings, &island, model).map(|method| (island, method)));
        Free {
            settings: settings.clone(),
            start: start.clone(),
            islands: islands.collect(),
            follower: RefCell::default(),
            shows_way: shows_way(settings, model),
            motion,
            stalled: None,
            deadline: Deadline::default(),
            work: Work::default(),
        }
    }

    /// The way of the last step, where its ends do not show all.
    pub(super) fn shown_way(&self) -> Option<&dyn Smooth> {
        self.shows_way.then_some(self)
    }

    /// Moves a state on to a time, driven bodies too.
    fn follow(&mut self, model: &Model, state: &mut State, to_s: f64) {
        let from_s = state.time_s;
        self.integrate(model, state, to_s - from_s);
        state.time_s = to_s;
        for (at, _) in state.bodies.iter_mut().zip(&model.bodies).filter(|(_, body)| body.driven) {
            *at = ClosedMotion::Driven(from_s, *at).at(to_s);
        }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        self.integrate(model, state, clock.step_s);
        clock.advance(state);
        if let Some(motion) = &self.motion {
            motion.write(state);
        }
    }

    /// Moves the bodies on by a time, which is left to the caller to count.
    fn integrate(&mut self, model: &Model, state: &mut State, step_s: f64) {
        let (span, deadline) = ([state.time_s, step_s], self.deadline);
        for (island, method) in &mut self.islands {
            island.take(state);
            if !method.step(island, model, span, deadline, &mut self.work) {
                let criterion = if deadline.is_over() { Criterion::Limit } else { Criterion::NotConverged };
                self.stalled.get_or_insert(criterion);
            }
            island.hold(model, span[0] + span[1], &mut self.work);
            island.give(state);
        }
    }
}

fn shows_way(settings: &Settings, model: &Model) -> bool {
    let is_controlled = matches!(settings.integrator.accuracy(), Accuracy::Tolerance(_));
    let is_exact = settings.integrator == Integrator::Exact;
    !is_exact && (model.has_driven_pins() || is_controlled && model.has_varying_loads())
}

impl Smooth for Free {
    fn moments(&self, model: &Model, [before, after]: [&State; 2]) -> Vec<Moment> {
        let mut follower = self.follower.borrow_mut();
        let follower = follower.get_or_insert_with(|| Box::new(Free::new(&self.settings, model, &self.start)));
        let mut place = before.clone();
        moments(before, after.time_s - before.time_s, |state| {
            follower.follow(model, &mut place, state.time_s);
            state.bodies.copy_from_slice(&place.bodies);
            Vec::new()
        })
    }
}

impl Method {
    /// None: the closed form, which is not a step from the state before.
    fn new(settings: &Settings, island: &Chain, model: &Model) -> Option<Self> {
        let implicit = || implicit::Scratch::new(island);
        Some(match settings.integrator {
            Integrator::ExplicitEuler => Method::Euler(Update::Explicit),
            Integrator::SemiImplicitEuler => Method::Euler(Update::SemiImplicit),
            Integrator::CrankNicolson => Method::CrankNicolson(implicit()),
            Integrator::ImplicitMidpoint => Method::Momentum {
                equation: implicit_midpoint::equation,
                driven: implicit_midpoint::driven,
                seen: 0.5,
                momenta: momentum::momenta(island, model),
                scratch: implicit(),
            },
            Integrator::Rk4 => Method::Rk4(rk4::Scratch::new(island)),
            Integrator::MoserVeselov => Method::Momentum {
                equation: moser_veselov::equation,
                driven: moser_veselov::driven,
                seen: 1.0,
                momenta: momentum::momenta(island, model),
                scratch: implicit(),
            },
            Integrator::Dop853 => {
                let tolerance = settings.tolerance.unwrap_or(DEFAULT_TOLERANCE);
                Method::Dop853(dop853::Control::new(tolerance), Box::new(dop853::Scratch::new(island)))
            }
            Integrator::Taylor => {
                let tolerance = settings.tolerance.unwrap_or(DEFAULT_TOLERANCE);
                Method::Taylor(Box::new(taylor::Taylor::new(tolerance, island, model)))
            }
            Integrator::Exact => return None,
        })
    }

    /// From the time `span[0]`, `span[1]` long. False: there is no solution, or no time for it.
    fn step(&mut self, island: &mut Chain, model: &Model, span: [f64; 2], deadline: Deadline, work: &mut Work) -> bool {
        match self {
            Method::Euler(update) => euler::step(*update, island, model, span, work),
            Method::Rk4(scratch) => rk4::step(island, model, span, scratch, work),
            Method::CrankNicolson(scratch) => {
                return implicit::step(crank_nicolson::driven, 1.0, island, model, span, scratch, work);
            }
            Method::Momentum { equation, momenta, .. } if island.is_free() => {
                return momentum::step_free(*equation, island, model, span[1], momenta, work);
            }
            Method::Momentum { driven, seen, scratch, .. } => {
                return implicit::step(*driven, *seen, island, model, span, scratch, work);
            }
            Method::Taylor(taylor) => return taylor.step(island, model, span, deadline, work),
            Method::Dop853(control, scratch) => {
                return dop853::step(island, model, (span, deadline), control, scratch, work);
            }
        }
        true
    }
}
