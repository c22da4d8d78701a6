//! Keys and words of the vocabulary that a type does not know: those of a later version, refused with their own message
//! until then, and those that are taken out before the type is read.

/// Words of a later version by what they stand in (the Rust type of `types.rs`). A word leaves this list in the change
/// that adds its field or variant.
const LATER: &[(&str, &[&str])] = &[("Sweep", &["where", "sample"]), ("Container", &["mesh"]), ("Shape", &["mesh"])];

/// Whether a later version knows this word in this type.
pub fn is_later(type_name: &str, word: &str) -> bool {
    LATER.iter().any(|(name, words)| *name == type_name && words.contains(&word))
}

/// Keys that a file has beside those of its experiment; they are taken out before it is read, and no case has them.
pub const BESIDE_EXPERIMENT: [&str; 4] = ["sweep", "expect", "bench", "extends"];

/// All keys that may be written where this type stands.
pub fn all_keys<'a>(type_name: &str, fields: &[&'a str]) -> Vec<&'a str> {
    let besides: &[&str] = if type_name == "Experiment" { &BESIDE_EXPERIMENT } else { &[] };
    fields.iter().chain(besides).copied().collect()
}
