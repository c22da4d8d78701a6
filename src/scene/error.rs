//! Errors of a scene that cannot be built.

/// Reason why an experiment cannot be built; to be reported with file and line of `path`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{path}: expected {expected}, found {found}")]
pub struct BuildError {
    pub path: String,
    pub expected: String,
    pub found: String,
}
