//! Merge of what an extending file says over what its base says.

use super::error::key_text;
use super::key_path::{KeyPath, Segment};
use super::later::BESIDE_EXPERIMENT;
use super::overrides::item_segment;
use super::reading::{Reading, reading};
use super::tree::{Mapping, Value};
use super::value_de::item_name;

/// A part of a tree that came whole from the extending file.
#[derive(Clone, Debug)]
pub(super) struct Graft {
    /// Place in the merged tree.
    pub at: KeyPath,
    /// Place in the extending file, where a list that is merged has other indices.
    pub own: KeyPath,
}

/// Puts `own` over `base`, and says which parts are its.
pub(super) fn merge(base: &mut Value, own: Value) -> Vec<Graft> {
    let mut merge = Merge::default();
    merge.values(base, own);
    merge.grafts
}

#[derive(Default)]
struct Merge {
    /// The place that is being merged, in the merged tree and in the extending file.
    at: KeyPath,
    own: KeyPath,
    grafts: Vec<Graft>,
}

impl Merge {
    fn values(&mut self, base: &mut Value, own: Value) {
        match (base, own) {
            (Value::Mapping(base), Value::Mapping(own)) if self.is_merged(base, &own) => self.keys(base, own),
            (Value::Sequence(base), Value::Sequence(own)) if self.goes_by_name(base, &own) => self.items(base, own),
            (Value::Mapping(base), Value::String(word)) if self.is_word_of(base, &word) => {}
            // `method: { lecture: }` is the word alone.
            (Value::Mapping(_), Value::Null) if self.is_below_word() => {}
            (base, own) => {
                *base = own;
                self.graft();
            }
        }
    }

    fn graft(&mut self) {
        self.grafts.push(Graft { at: self.at.clone(), own: self.own.clone() });
    }

    /// Another word, or another way to say it, has nothing to do with what the base says.
    fn is_merged(&self, base: &Mapping, own: &Mapping) -> bool {
        match reading(&self.at) {
            Reading::Plain => true,
            Reading::Word => base.keys().next() == own.keys().next(),
            Reading::Alternatives => own.keys().all(|key| base.contains_key(key)),
        }
    }

    /// Values of an axis are replaced, whatever they are.
    fn goes_by_name(&self, base: &[Value], own: &[Value]) -> bool {
        let have_names = |items: &[Value]| items.iter().all(|item| item_name(item).is_some());
        !self.is_in_axis() && !own.is_empty() && have_names(base) && have_names(own)
    }

    fn is_word_of(&self, base: &Mapping, word: &str) -> bool {
        !self.is_in_axis() && reading(&self.at) == Reading::Word && base.keys().next().is_some_and(|key| key == word)
    }

    fn is_below_word(&self) -> bool {
        let mut above = self.at.clone();
        above.truncate(self.at.len().saturating_sub(1));
        !self.is_in_axis() && reading(&above) == Reading::Word
    }

    fn is_in_axis(&self) -> bool {
        self.at.len() > 2 && self.at.starts_with(&KeyPath::of_keys(&["sweep", "axes"]))
    }

    fn keys(&mut self, base: &mut Mapping, own: Mapping) {
        for (key, value) in own {
            let segment = Segment::Key(key.as_str().map_or_else(|| key_text(&key), str::to_string));
            self.enter(segment.clone(), segment);
            if value.is_null() && self.is_taken_away() && base.contains_key(&key) {
                base.shift_remove(&key);
            } else if let Some(of_base) = base.get_mut(&key) {
                self.values(of_base, value);
            } else {
                base.insert(key, value);
                self.graft();
            }
            self.leave();
        }
    }

    /// No type reads `null` at these places: an axis, and what stands beside the experiment.
    fn is_taken_away(&self) -> bool {
        match self.at.lookup().iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
            [key] => BESIDE_EXPERIMENT.contains(key),
            ["sweep", "axes", _] => true,
            _ => false,
        }
    }

    /// Merges lists by name. Of two new items that share a name both are appended, and refused later.
    fn items(&mut self, base: &mut Vec<Value>, own: Vec<Value>) {
        let mut is_merged = vec![false; base.len()];
        for (i, item) in own.into_iter().enumerate() {
            let own_segment = item_segment(&item, i);
            let same = (0..is_merged.len()).find(|j| !is_merged[*j] && item_name(&base[*j]) == item_name(&item));
            match same {
                Some(j) => {
                    is_merged[j] = true;
                    self.enter(item_segment(&item, j), own_segment);
                    self.values(&mut base[j], item);
                }
                None => {
                    self.enter(item_segment(&item, base.len()), own_segment);
                    base.push(item);
                    self.graft();
                }
            }
            self.leave();
        }
    }

    fn enter(&mut self, at: Segment, own: Segment) {
        self.at.push(at);
        self.own.push(own);
    }

    fn leave(&mut self) {
        self.at.truncate(self.at.len() - 1);
        self.own.truncate(self.own.len() - 1);
    }
}
