//! Motion without contact (L4, L5): every island of bodies that pins join on its own.

use crate::clock::Clock;
use crate::deadline::Deadline;
use crate::exact::Closed;
use crate::experiment::tolerances::DEFAULT_TOLERANCE;
use crate::experiment::types::{Exact, Free as Settings, Integrator, Update};
use crate::integrate::chain::Chain;
use crate::integrate::{
    crank_nicolson, dop853, euler, implicit, implicit_midpoint, momentum, moser_veselov, rk4, taylor,
};
use crate::model::Model;
use crate::outcome::Criterion;
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;

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
    islands: Vec<(Chain, Method)>,
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
        Free { islands: islands.collect(), motion, stalled: None, deadline: Deadline::default(), work: Work::default() }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        let (span, deadline) = ([state.time_s, clock.step_s], self.deadline);
        for (island, method) in &mut self.islands {
            island.take(state);
            if !method.step(island, model, span, deadline, &mut self.work) {
                let criterion = if deadline.is_over() { Criterion::Limit } else { Criterion::NotConverged };
                self.stalled.get_or_insert(criterion);
            }
            island.hold(model, span[0] + span[1], &mut self.work);
            island.give(state);
        }
        clock.advance(state);
        if let Some(motion) = &self.motion {
            motion.write(state);
        }
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
