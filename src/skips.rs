//! What steps leave out because it is known without. Each can be switched off, and changes no bit of the motion.

/// Skips of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Skips {
    /// Contact tests of bodies that cannot have come to anything yet.
    pub flight: bool,
    /// Steps that would be the one before over again.
    pub rest: bool,
}

impl Skips {
    /// The full path.
    pub const NONE: Skips = Skips { flight: false, rest: false };
}

impl Default for Skips {
    fn default() -> Self {
        Skips { flight: true, rest: true }
    }
}
