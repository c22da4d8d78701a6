//! What is left out of a resolved experiment.

/// Left out of the resolved experiment, so that a case that does not use a newer key keeps its id.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
