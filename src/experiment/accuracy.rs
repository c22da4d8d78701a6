//! The setting that makes a method more accurate.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// A step: `time.step_s`, which is made shorter.
    Step,
    /// A tolerance, at this path, which is made smaller; the method finds its own steps inside those of the clock.
    Tolerance(&'static [&'static str]),
    /// No setting: the method is a closed form.
    Closed,
}
