//! Keys and words of the vocabulary that a later version brings: refused with their own message until then.

/// What the key or word stands in (the Rust type of `types.rs`), and the words. A word leaves this list in the change
/// that adds its field or variant.
const LATER: &[(&str, &[&str])] = &[("Sweep", &["where", "sample"]), ("Container", &["mesh"]), ("Shape", &["mesh"])];

/// Whether a later version knows this word in this type.
pub fn is_later(type_name: &str, word: &str) -> bool {
    LATER.iter().any(|(name, words)| *name == type_name && words.contains(&word))
}
