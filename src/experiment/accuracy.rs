//! What makes a method more accurate.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// A shorter `time.step_s`.
    Step,
    /// A smaller tolerance, which is at this path; the method finds its own steps inside those of the clock.
    Tolerance(&'static [&'static str]),
    /// Nothing: it is a closed form.
    Closed,
}
