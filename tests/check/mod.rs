//! Expectations, their statistics, searches, and `gotai check` as a CI meets it.

mod bad;
mod command;
mod compare;
mod search;
mod trend;
mod verdicts;
