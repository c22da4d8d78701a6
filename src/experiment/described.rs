//! What the pages say of a key, for the schema: an editor shows what `docs/experiment-file.md` and
//! `docs/expectations.md` say, and nobody writes it twice.
//!
//! A heading is a key, or one below the key of the heading above it; a paragraph or an item of a list that begins with
//! names is about them; of other keys the first sentence speaks that has their name in code.

use serde_json::{Value, json};

const FILE: &str = include_str!("../../docs/experiment-file.md");
const EXPECTATIONS: &str = include_str!("../../docs/expectations.md");

/// Most letters of a description; what is longer ends with a sentence before.
const MOST: usize = 400;

/// Paragraphs and items of a list below a heading.
struct Section {
    path: Vec<String>,
    blocks: Vec<String>,
}

/// The pages, by their headings.
pub(super) struct Described {
    sections: Vec<Section>,
}

impl Described {
    /// What the pages of this version say.
    pub(super) fn of_pages() -> Self {
        let mut sections = sections(FILE, &[]);
        // One page for one key: its title stands for the list itself, a heading that is no name of a key for nothing.
        for (level, heading, mut blocks) in sections_of(EXPECTATIONS) {
            let mut path = vec!["expect".to_string()];
            if level > 1 {
                path.push(heading);
            } else {
                let begins = blocks.iter().position(|block| block.starts_with("`expect:` is a list"));
                blocks.drain(..begins.unwrap_or_default());
            }
            sections.push(Section { path, blocks });
        }
        Described { sections }
    }

    /// Puts descriptions to all keys of a schema.
    pub(super) fn describe(&self, schema: &mut Value) {
        self.below(schema, &mut Vec::new());
    }

    fn below(&self, schema: &mut Value, path: &mut Vec<String>) {
        let Value::Object(schema) = schema else { return };
        if let Some(Value::Object(keys)) = schema.get_mut("properties") {
            for (key, value) in keys {
                // A predicate takes a predicate: what stands in itself is not said again.
                if path.contains(key) && path.last() == Some(key) {
                    continue;
                }
                path.push(key.clone());
                self.below(value, path);
                if let Some(said) = self.said(path) {
                    let wanted = value["description"].as_str().map(|wanted| format!(" (Takes {wanted}.)"));
                    value["description"] = json!(said + &wanted.unwrap_or_default());
                }
                path.pop();
            }
        }
        if let Some(items) = schema.get_mut("items") {
            self.below(items, path);
        }
        for one in schema.get_mut("anyOf").and_then(Value::as_array_mut).into_iter().flatten() {
            self.below(one, path);
        }
    }

    /// What is said of a key: below the heading that is nearest to it, else below those above.
    fn said(&self, path: &[String]) -> Option<String> {
        let key = path.last()?;
        (0..=path.len()).rev().find_map(|depth| {
            let own = |section: &&Section| section.path == path[..depth];
            self.sections.iter().filter(own).find_map(|section| match depth == path.len() {
                true => section.blocks.first().map(|block| shortened(&unmarked(block))),
                false => of_block(&section.blocks, key).or_else(|| of_sentence(&section.blocks, key)),
            })
        })
    }
}

/// Sections whose headings are keys: of the second level, and of the third below them.
fn sections(page: &str, above: &[String]) -> Vec<Section> {
    let mut path = above.to_vec();
    let section = |(level, heading, blocks): (usize, String, Vec<String>)| {
        path.truncate(level.saturating_sub(2) + above.len());
        path.push(heading);
        Section { path: path.clone(), blocks }
    };
    sections_of(page).into_iter().filter(|(level, ..)| *level > 1).map(section).collect()
}

/// Headings of a page with their levels, and the blocks below each; code is none.
fn sections_of(page: &str) -> Vec<(usize, String, Vec<String>)> {
    let mut all: Vec<(usize, String, Vec<String>)> = Vec::new();
    let (mut is_code, mut is_begun) = (false, false);
    for line in page.lines() {
        if line.starts_with("```") {
            (is_code, is_begun) = (!is_code, false);
            continue;
        }
        if is_code || line.starts_with("    ") || line.starts_with('|') {
            continue;
        }
        let level = line.chars().take_while(|c| *c == '#').count();
        if level > 0 {
            all.push((level, line.trim_start_matches('#').trim().to_string(), Vec::new()));
            is_begun = false;
            continue;
        }
        let Some((_, _, blocks)) = all.last_mut() else { continue };
        let text = line.trim();
        match (text.strip_prefix("- "), blocks.last_mut().filter(|_| is_begun)) {
            _ if text.is_empty() => is_begun = false,
            (Some(item), _) => {
                blocks.push(item.to_string());
                is_begun = true;
            }
            (None, Some(block)) => *block += &format!(" {text}"),
            (None, None) => {
                blocks.push(text.to_string());
                is_begun = true;
            }
        }
    }
    all
}

/// The block that begins with the form of a key, `{ key: …`, or with its name, alone or among others.
fn of_block(blocks: &[String], key: &str) -> Option<String> {
    let is_form = |block: &&String| block.starts_with("`{ ") && words(block).next() == Some(key);
    let is_of = |block: &&String| {
        let mut rest = block.as_str();
        while let Some(mark) = ["**", "`"].into_iter().find(|mark| rest.starts_with(mark)) {
            let Some((name, after)) = rest[mark.len()..].split_once(mark) else { return false };
            if words(name).next().is_some_and(|word| word.eq_ignore_ascii_case(key)) {
                return true;
            }
            // What follows may be another name of the same paragraph.
            match [", ", " and "].into_iter().find_map(|between| after.strip_prefix(between)) {
                Some(next) => rest = next,
                None => return false,
            }
        }
        false
    };
    let found = blocks.iter().find(is_form).or_else(|| blocks.iter().find(is_of));
    found.map(|block| shortened(&unmarked(block)))
}

/// The first sentence that has the name of a key in code: at its beginning, else as a part.
fn of_sentence(blocks: &[String], key: &str) -> Option<String> {
    let sentences = || blocks.iter().flat_map(|block| sentences(block));
    let codes = |sentence: &str, mark: &str| -> Vec<String> {
        sentence.split(mark).skip(1).step_by(2).map(str::to_string).collect()
    };
    let begins = |code: &String| {
        let rest = code.strip_prefix(key);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(':'))
    };
    let has = |code: &String| words(code).any(|word| word == key);
    let whole = sentences().find(|sentence| codes(sentence, "`").iter().any(begins));
    let part = || sentences().find(|sentence| codes(sentence, "`").iter().any(has));
    let bold = || sentences().find(|sentence| codes(sentence, "**").iter().any(has));
    whole.or_else(part).or_else(bold).map(|sentence| shortened(&unmarked(&sentence)))
}

/// Names in a piece of code.
fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '-')).filter(|word| !word.is_empty())
}

/// Sentences of a block, and what semicolons part in them outside of brackets.
fn sentences(block: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    let (mut depth, mut before) = (0i32, ' ');
    let letters: Vec<char> = block.chars().collect();
    for (i, c) in letters.iter().copied().enumerate() {
        match c {
            '(' | '{' | '[' => depth += 1,
            ')' | '}' | ']' => depth -= 1,
            _ => {}
        }
        let next = letters.get(i + 1).copied().unwrap_or(' ');
        let begins = next.is_uppercase() || "`*".contains(next);
        let is_end = c == ' ' && depth == 0 && (before == ';' || (before == '.' && begins));
        match all.last_mut() {
            Some(last) if !is_end => last.push(c),
            _ => all.push(String::new()),
        }
        before = c;
    }
    all
}

/// A text without marks of Markdown; of a link its words.
fn unmarked(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once("](") {
        let (text, name) = before.rsplit_once('[').unwrap_or((before, ""));
        out += &format!("{text}{name}");
        rest = link.split_once(')').map_or("", |(_, after)| after);
    }
    (out + rest).replace("**", "").replace('`', "")
}

/// The first sentences of a text, as many as there is room for; at least one.
fn shortened(text: &str) -> String {
    let mut out = String::new();
    for sentence in sentences(text) {
        if !out.is_empty() && out.chars().count() + sentence.chars().count() > MOST {
            break;
        }
        if !out.is_empty() {
            out.push(' ');
        }
        out += sentence.trim();
    }
    out.trim_end_matches(';').to_string()
}
