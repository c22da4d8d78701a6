//! Values that a resolved experiment leaves out.

/// Whether a value is the default, which a resolved experiment leaves out, so that a case that does not use a newer key
/// keeps its id.
pub(super) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
