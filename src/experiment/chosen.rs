//! A method that steps. `auto` is none: it chooses one of them (`study/choose.rs`).

use super::method::{Auto, EventDriven, Free, Lecture, Method, Penalty, TimeStepping};

/// A method that steps, with its settings.
#[derive(Clone, Debug, PartialEq)]
pub enum SteppingMethod {
    Free(Free),
    Lecture(Lecture),
    Penalty(Penalty),
    TimeStepping(TimeStepping),
    EventDriven(EventDriven),
}

impl Method {
    /// The method itself, if it steps.
    ///
    /// # Errors
    /// It leaves that to another one.
    pub fn stepping(&self) -> Result<SteppingMethod, &Auto> {
        Ok(match self {
            Method::Free(settings) => SteppingMethod::Free(settings.clone()),
            Method::Lecture(settings) => SteppingMethod::Lecture(settings.clone()),
            Method::Penalty(settings) => SteppingMethod::Penalty(settings.clone()),
            Method::TimeStepping(settings) => SteppingMethod::TimeStepping(settings.clone()),
            Method::EventDriven(settings) => SteppingMethod::EventDriven(settings.clone()),
            Method::Auto(auto) => return Err(auto),
        })
    }
}

impl From<SteppingMethod> for Method {
    fn from(method: SteppingMethod) -> Self {
        match method {
            SteppingMethod::Free(settings) => Method::Free(settings),
            SteppingMethod::Lecture(settings) => Method::Lecture(settings),
            SteppingMethod::Penalty(settings) => Method::Penalty(settings),
            SteppingMethod::TimeStepping(settings) => Method::TimeStepping(settings),
            SteppingMethod::EventDriven(settings) => Method::EventDriven(settings),
        }
    }
}
