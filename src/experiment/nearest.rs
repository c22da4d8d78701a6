//! «Did you mean»: the nearest known key.

/// The known word that `word` was most likely meant to be, if any is near.
///
/// A key without its unit (`mass` for `mass_kg`) is near; else at most a third of the letters may be wrong, which still
/// finds two slips in a short key and does not offer `speed_m_s` for `colour`.
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let word = word.to_lowercase().replace('-', "_");
    if word.is_empty() {
        return None;
    }
    let without_unit =
        known.iter().find(|key| plain(key).strip_prefix(&word).is_some_and(|rest| rest.starts_with('_')));
    if let Some(key) = without_unit {
        return Some(key);
    }
    let distance = |key: &str| strsim::osa_distance(&word, &plain(key));
    let best = known.iter().min_by_key(|key| distance(key))?;
    let allowed = (word.chars().count().max(best.chars().count()) / 3).max(1);
    (distance(best) <= allowed).then_some(*best)
}

fn plain(key: &str) -> String {
    key.to_lowercase().replace('-', "_")
}
