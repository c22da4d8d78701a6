//! Which line a key path stands on: serde_yaml's values do not know, so a second parser walks the same text.
//!
//! Best effort by design: a path it does not know (below an alias, a merged key, a default) gets its nearest known
//! ancestor's line.

use super::key_path::KeyPath;
use saphyr_parser::{Event, Parser, Span};
use std::collections::HashMap;

/// Line and column, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    pub line: usize,
    pub column: usize,
}

/// A key that a mapping has twice.
#[derive(Clone, Debug, PartialEq)]
pub struct Duplicate {
    pub path: KeyPath,
    pub first: Position,
    pub second: Position,
}

/// The position of every key and list item in a text.
#[derive(Clone, Debug, Default)]
pub struct Positions {
    known: HashMap<Vec<String>, Position>,
}

impl Positions {
    /// Walks the first document of the text, as far as it parses; also the first duplicate key on the way.
    pub fn of(text: &str) -> (Positions, Option<Duplicate>) {
        let mut walk = Walk::default();
        for event in Parser::new_from_str(text) {
            match event {
                Ok((Event::DocumentEnd, _)) | Err(_) => break,
                Ok((event, span)) => walk.on(event, span),
            }
        }
        (walk.positions, walk.duplicate)
    }

    /// The position of the path or of its nearest known ancestor.
    pub fn nearest(&self, path: &KeyPath) -> Option<Position> {
        let mut segments = path.lookup();
        while !segments.is_empty() {
            if let Some(position) = self.known.get(&segments) {
                return Some(*position);
            }
            segments.pop();
        }
        None
    }
}

/// A mapping or list that is still open.
enum Frame {
    /// Holds whether the next node is a key.
    Mapping(bool),
    /// Holds the index of the next item.
    Sequence(usize),
    /// A key that is itself a mapping or list: the reader of values refuses it, so nothing in it needs a position.
    Key,
}

#[derive(Default)]
struct Walk {
    positions: Positions,
    duplicate: Option<Duplicate>,
    frames: Vec<Frame>,
    path: Vec<String>,
}

impl Walk {
    fn on(&mut self, event: Event, span: Span) {
        match event {
            Event::Scalar(text, ..) => self.leaf(&text, span),
            Event::Alias(_) => self.leaf("", span),
            Event::MappingStart(..) => self.open(Frame::Mapping(true), span),
            Event::SequenceStart(..) => self.open(Frame::Sequence(0), span),
            Event::MappingEnd | Event::SequenceEnd => {
                self.frames.pop();
                self.node_ended();
            }
            _ => {}
        }
    }

    fn leaf(&mut self, text: &str, span: Span) {
        if let Some(Frame::Mapping(is_key @ true)) = self.frames.last_mut() {
            *is_key = false;
            self.path.push(text.to_string());
            self.remember(span);
        } else {
            self.enter_item(span);
            self.node_ended();
        }
    }

    fn open(&mut self, frame: Frame, span: Span) {
        if matches!(self.frames.last(), Some(Frame::Key | Frame::Mapping(true))) {
            self.frames.push(Frame::Key);
            return;
        }
        self.enter_item(span);
        self.frames.push(frame);
    }

    /// Only list items enter here: a mapping's value stands where its key does.
    fn enter_item(&mut self, span: Span) {
        if let Some(Frame::Sequence(next)) = self.frames.last_mut() {
            self.path.push(next.to_string());
            *next += 1;
            self.remember(span);
        }
    }

    /// A whole node is behind us: back to the mapping or list it stands in.
    fn node_ended(&mut self) {
        match self.frames.last_mut() {
            Some(Frame::Mapping(is_key @ true)) => {
                *is_key = false;
                self.path.push(String::new());
            }
            Some(Frame::Mapping(is_key)) => {
                *is_key = true;
                self.path.pop();
            }
            Some(Frame::Sequence(_)) => {
                self.path.pop();
            }
            Some(Frame::Key) | None => {}
        }
    }

    fn remember(&mut self, span: Span) {
        let second = Position { line: span.start.line(), column: span.start.col() + 1 };
        let first = *self.positions.known.entry(self.path.clone()).or_insert(second);
        let is_named = self.path.last().is_some_and(|key| !key.is_empty());
        if first != second && is_named && self.duplicate.is_none() {
            let keys: Vec<&str> = self.path.iter().map(String::as_str).collect();
            self.duplicate = Some(Duplicate { path: KeyPath::of_keys(&keys), first, second });
        }
    }
}
