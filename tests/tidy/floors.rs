//! The floors: who may import whom, no circles, faces that define nothing, one type a name, and where the edges are.

use super::sources::{Source, arrows, circle, sources};
use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};

/// Room → rooms that it may import, from the ground up. A room stands above all that it imports, so that this list
/// is in an order: a new arrow is a line here, seen in review.
const ROOMS: &[(&str, &[&str])] = &[
    ("deadline", &[]),
    ("math", &["deadline"]),
    ("state", &[]),
    ("outcome", &[]),
    ("digest", &[]),
    ("shared", &[]),
    ("heading", &["shared"]),
    ("interrupt", &[]),
    ("work", &["heading"]),
    ("files", &[]),
    ("build_info", &[]),
    ("panics", &[]),
    ("clock", &["state"]),
    ("shape", &["math"]),
    ("rows", &["shared", "state", "digest", "math", "heading", "outcome", "work"]),
    ("experiment", &["shared", "shape", "clock", "outcome"]),
    ("model", &["shared", "experiment", "shape", "state"]),
    ("case", &["shared", "digest", "experiment"]),
    ("check", &["experiment", "rows", "heading", "outcome", "math"]),
    ("report", &["check", "rows", "heading", "math"]),
    ("collide", &["experiment", "model", "shape", "state", "work"]),
    ("integrate", &["deadline", "model", "experiment", "math", "state", "work"]),
    ("plan", &["experiment", "model"]),
    ("shown", &["collide", "experiment", "model", "outcome", "state"]),
    ("scene", &["shared", "experiment", "model", "shape", "collide", "state", "work"]),
    ("exact", &["experiment", "model", "shape", "collide", "math", "state"]),
    ("solve", &["deadline", "experiment", "model", "collide", "math", "state", "work"]),
    (
        "event",
        &[
            "deadline",
            "exact",
            "solve",
            "integrate",
            "collide",
            "model",
            "shape",
            "experiment",
            "math",
            "state",
            "work",
        ],
    ),
    // The judges know no method: neither what steps, nor what solves, nor a closed form.
    (
        "measure",
        &["plan", "shown", "collide", "model", "shape", "experiment", "rows", "heading", "outcome", "state", "work"],
    ),
    (
        "record",
        &[
            "shown",
            "shape",
            "collide",
            "work",
            "measure",
            "case",
            "rows",
            "outcome",
            "model",
            "experiment",
            "state",
            "clock",
            "files",
            "digest",
            "build_info",
            "panics",
        ],
    ),
    (
        "step",
        &[
            "event",
            "exact",
            "solve",
            "integrate",
            "collide",
            "model",
            "experiment",
            "math",
            "state",
            "work",
            "plan",
            "shown",
            "clock",
            "deadline",
            "outcome",
        ],
    ),
    (
        "run",
        &[
            "step",
            "record",
            "measure",
            "exact",
            "plan",
            "shown",
            "model",
            "experiment",
            "rows",
            "outcome",
            "work",
            "state",
            "clock",
            "deadline",
            "interrupt",
        ],
    ),
    (
        "study",
        &[
            "run",
            "record",
            "measure",
            "collide",
            "model",
            "experiment",
            "case",
            "rows",
            "outcome",
            "work",
            "state",
            "clock",
            "files",
            "digest",
            "build_info",
        ],
    ),
    (
        "sweep",
        &[
            "shared",
            "heading",
            "digest",
            "interrupt",
            "study",
            "run",
            "record",
            "exact",
            "scene",
            "model",
            "case",
            "experiment",
            "rows",
            "outcome",
            "state",
            "files",
            "build_info",
            "panics",
        ],
    ),
    (
        "bench",
        &["sweep", "study", "run", "measure", "check", "model", "experiment", "rows", "outcome", "state", "panics"],
    ),
    (
        "cli",
        &[
            "digest",
            "interrupt",
            "heading",
            "bench",
            "sweep",
            "study",
            "run",
            "shown",
            "record",
            "measure",
            "exact",
            "scene",
            "plan",
            "integrate",
            "check",
            "case",
            "model",
            "report",
            "experiment",
            "rows",
            "math",
            "outcome",
            "state",
            "files",
            "build_info",
        ],
    ),
];

#[test]
fn rooms_import_downward() {
    for (i, (room, allowed)) in ROOMS.iter().enumerate() {
        for below in *allowed {
            let floor = ROOMS.iter().position(|(name, _)| name == below);
            assert!(floor.is_some_and(|floor| floor < i), "the table has {below} above {room}");
        }
    }
    let sources = sources();
    let rooms: BTreeSet<&str> = sources.iter().map(Source::room).filter(|room| *room != "lib").collect();
    assert_eq!(rooms, ROOMS.iter().map(|(room, _)| *room).collect(), "every room of src/ has its line in the table");
    let mut used = BTreeMap::new();
    let mut wrong = Vec::new();
    for (from, to) in arrows(&sources) {
        let (from, to) = (&sources[from], &sources[to]);
        let allowed = ROOMS.iter().find(|(room, _)| *room == from.room()).map_or(&[][..], |(_, allowed)| allowed);
        if from.room() != to.room() {
            used.entry(from.room()).or_insert_with(BTreeSet::new).insert(to.room());
            if !allowed.contains(&to.room()) {
                wrong.push(format!("{} imports {}", from.name, to.name));
            }
        }
    }
    assert!(wrong.is_empty(), "imports that no floor allows:\n{}", wrong.join("\n"));
    for (room, allowed) in ROOMS {
        let unused: Vec<_> =
            allowed.iter().filter(|to| !used.get(room).is_some_and(|used| used.contains(**to))).collect();
        assert!(unused.is_empty(), "{room} no longer imports {unused:?}: strike it from the table");
    }
}

#[test]
fn no_files_go_in_a_circle() {
    let sources = sources();
    let found = circle(&arrows(&sources), sources.len());
    let names = |way: Vec<usize>| way.iter().map(|file| sources[*file].name.clone()).collect::<Vec<_>>().join(" → ");
    assert!(found.is_none(), "{}", found.map(names).unwrap_or_default());
}

/// It holds docs, `mod` and `pub use`.
#[test]
fn a_mod_rs_is_a_face() {
    let mut faces = 0;
    for source in sources().iter().filter(|source| source.is_face()) {
        faces += 1;
        for item in &source.syntax.items {
            let hands_on = match item {
                syn::Item::Mod(module) => module.content.is_none(),
                // Its own children, and names of libraries.
                syn::Item::Use(item) => {
                    let path = item.tree.to_token_stream().to_string();
                    let is_own = !path.starts_with("crate") && !path.starts_with("super") && !path.contains('*');
                    is_own && !matches!(item.vis, syn::Visibility::Inherited)
                }
                _ => false,
            };
            assert!(hands_on, "{} defines something", source.name);
        }
    }
    assert!(faces > 15, "{faces} faces");
}

/// Names that two public types still share: a word of the file and what it becomes in the model (`Body`), the settings
/// of a method and the method (`Free`), a quantity and its message in a recording (`Energy`), and some that wait for a
/// better word. The list only shrinks.
const SHARED: &[&str] = &[
    "Axis",
    "Ball",
    "Body",
    "BodyState",
    "Bounds",
    "Change",
    "Contact",
    "Container",
    "Dense",
    "End",
    "Energy",
    "EventDriven",
    "Face",
    "Field",
    "Free",
    "Inertia",
    "Law",
    "Lecture",
    "Order",
    "Pair",
    "Penalty",
    "Pin",
    "Place",
    "Push",
    "Sample",
    "Scene",
    "Scratch",
    "Start",
    "TimeStepping",
];

#[test]
fn a_name_has_one_type() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for source in sources() {
        for item in &source.syntax.items {
            let (vis, ident) = match item {
                syn::Item::Struct(item) => (&item.vis, &item.ident),
                syn::Item::Enum(item) => (&item.vis, &item.ident),
                syn::Item::Trait(item) => (&item.vis, &item.ident),
                syn::Item::Type(item) => (&item.vis, &item.ident),
                // `columns!` declares a struct.
                syn::Item::Macro(item) if item.mac.path.is_ident("columns") => {
                    let tokens = item.mac.tokens.to_string();
                    for part in tokens.split("pub struct ").skip(1) {
                        let name = part.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
                        places.entry(name.to_string()).or_default().push(source.name.clone());
                    }
                    continue;
                }
                _ => continue,
            };
            if matches!(vis, syn::Visibility::Public(_)) {
                places.entry(ident.to_string()).or_default().push(source.name.clone());
            }
        }
    }
    // Every command is `Command` in its own file.
    places.remove("Command");
    let shared: Vec<_> = places.iter().filter(|(_, places)| places.len() > 1).collect();
    let new: Vec<_> = shared.iter().filter(|(name, _)| !SHARED.contains(&name.as_str())).collect();
    assert!(new.is_empty(), "one name, several types: {new:#?}");
    let gone: Vec<_> = SHARED.iter().filter(|name| !shared.iter().any(|(shared, _)| shared == *name)).collect();
    assert!(gone.is_empty(), "no longer shared, strike them from the list: {gone:?}");
}

/// What is named, and the rooms that may name it.
const PLACES: &[(&str, &[&str])] = &[
    ("serde_yaml", &["experiment"]),
    ("std::fs", &["files", "experiment", "record", "sweep", "cli"]),
    ("Instant", &["deadline", "run", "study", "bench", "record", "cli"]),
    ("std::{", &[]),
    ("SystemTime", &["cli"]),
    ("std::thread", &["record", "cli"]),
    ("print!", &["cli"]),
    ("println!", &["cli"]),
    ("dbg!", &[]),
];

#[test]
fn files_clocks_and_printing_stay_at_the_edges() {
    for source in sources() {
        for (name, rooms) in PLACES {
            let is_named = source.text.lines().any(|line| !line.trim_start().starts_with("//") && line.contains(name));
            assert!(!is_named || rooms.contains(&source.room()), "{} names {name}", source.name);
        }
    }
}

/// Of `experiment/` only what reads and writes the text, and the file from which all others take the tree's types.
#[test]
fn few_files_know_the_yaml_library() {
    const FILES: [&str; 4] = ["emit.rs", "positions.rs", "source.rs", "tree.rs"];
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    let names_it = |source: &&Source| source.text.lines().filter(is_code).any(|line| line.contains("serde_yaml"));
    let sources = sources();
    let found: Vec<_> = sources.iter().filter(names_it).map(|source| source.name.as_str()).collect();
    assert_eq!(found, FILES.map(|file| format!("experiment/{file}")));
}

/// The drawing is of the rooms that there are.
#[test]
fn every_room_is_in_the_drawing_of_the_house() {
    let page = std::fs::read_to_string(super::root().join("docs/house.md")).unwrap();
    let drawing = page.split("```").nth(1).unwrap();
    for (room, _) in ROOMS {
        let drawn = [format!("{room}/"), format!("{room}.rs")].iter().any(|name| drawing.contains(name.as_str()));
        assert!(drawn, "docs/house.md draws no {room}");
    }
}

/// A method, a shape or a closed form whose arm is forgotten would be taken for another: wrong physics without a word.
#[test]
fn steps_and_closed_forms_have_no_wildcard_over_methods_or_closed_forms() {
    struct Wild<'a>(&'a str);
    impl<'ast> syn::visit::Visit<'ast> for Wild<'_> {
        fn visit_expr_match(&mut self, found: &'ast syn::ExprMatch) {
            let patterns: Vec<String> = found.arms.iter().map(|arm| arm.pat.to_token_stream().to_string()).collect();
            let of_ours = |pattern: &String| ["Method ::", "Exact ::"].iter().any(|word| pattern.contains(word));
            let is_wild = |arm: &&syn::Arm| matches!(arm.pat, syn::Pat::Wild(_)) && arm.guard.is_none();
            let wild = found.arms.iter().any(|arm| is_wild(&arm));
            assert!(!(wild && patterns.iter().any(of_ours)), "{}: `_` beside {}", self.0, patterns.join(", "));
            syn::visit::visit_expr_match(self, found);
        }
    }
    for source in sources().iter().filter(|source| ["step", "exact"].contains(&source.room())) {
        syn::visit::Visit::visit_file(&mut Wild(&source.name), &source.syntax);
    }
}
