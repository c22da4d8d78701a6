//! The pages say what is there: those that are made from the program and from configs/ are made again and compared, and
//! links, paths and commands of the others lead somewhere.
//!
//! `GOTAI_BLESS=1 cargo test --locked --release docs::` writes the pages that are made.

use crate::cli::run;
use crate::tidy::files;
use gotai::outcome::{Criterion, Outcome};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn holds(path: &str, made: &str) {
    if std::env::var_os("GOTAI_BLESS").is_some() {
        std::fs::write(root().join(path), made).unwrap();
    }
    let there = std::fs::read_to_string(root().join(path)).unwrap_or_default();
    let first = there.lines().zip(made.lines()).find(|(there, made)| there != made);
    assert!(there == made, "{path} is not what is made today (GOTAI_BLESS=1 writes it): {first:?}");
}

/// All pages that people read.
fn pages() -> Vec<PathBuf> {
    let mut pages = files("docs", "md");
    pages.extend(["README.md", "configs/README.md", "recordings/README.md"].map(|page| root().join(page)));
    pages
}

fn name(page: &Path) -> String {
    page.strip_prefix(root()).unwrap().display().to_string()
}

#[test]
fn pages_of_lists_are_what_the_program_prints() {
    for (page, lists) in
        [("docs/methods.md", &["methods", "shapes", "exact", "measures"][..]), ("docs/columns.md", &["columns"])]
    {
        let (code, out, err) = run(&[&["list"], lists, &["--markdown"]].concat());
        assert_eq!((code, err.as_str()), (0, ""));
        holds(page, &out);
    }
    let columns = read("docs/columns.md");
    let words = Outcome::ALL.map(Outcome::name).into_iter().chain(Criterion::ALL.map(Criterion::name));
    for word in words {
        assert!(columns.contains(&format!("`{word}`")), "docs/columns.md lacks {word}");
    }
}

/// An editor says of every key what the page says, so that nobody writes it twice, and no key is without a word.
#[test]
fn the_schema_describes_every_key_with_the_words_of_the_pages() {
    fn below(schema: &serde_json::Value, path: &mut Vec<String>, found: &mut BTreeMap<String, String>) {
        for (key, value) in schema["properties"].as_object().into_iter().flatten() {
            if path.last() != Some(key) {
                path.push(key.clone());
                found.insert(path.join("."), value["description"].as_str().unwrap_or_default().to_string());
                below(value, path, found);
                path.pop();
            }
        }
        let parts = schema["anyOf"].as_array().into_iter().flatten().chain(schema.get("items"));
        parts.for_each(|part| below(part, path, found));
    }
    let (code, out, err) = run(&["schema"]);
    assert_eq!((code, err.as_str()), (0, ""));
    let mut found = BTreeMap::new();
    below(&serde_json::from_str(&out).unwrap(), &mut Vec::new(), &mut found);
    let silent: Vec<&String> = found.iter().filter(|(_, said)| said.is_empty()).map(|(path, _)| path).collect();
    // measured: 219 keys
    assert!(silent.is_empty() && found.len() > 200, "{} keys, without a word: {silent:?}", found.len());
    for (path, said) in [
        ("scene.allow_overlap", "true starts bodies inside walls or each other"),
        ("record.max_mb", "max_mb (default 32): largest file, in megabytes"),
        ("method.time-stepping.scheme", "scheme: semi-implicit (order 1)"),
        ("sweep.search.over", "over: the axis whose runs are tried together"),
        ("expect.within", "Within. within: x asks for a value of at most x in size"),
        ("expect.where", "Values (numbers match within 1e-9 relative)"),
    ] {
        assert!(found[path].starts_with(said), "{path}: {}", found[path]);
    }
    assert!(found.values().all(|said| !said.contains("**") && !said.contains('`') && !said.contains("](")));
}

/// Folders of configs/, in the order in which a newcomer reads them, and what they ask about.
const FOLDERS: [(&str, &str); 7] = [
    ("", "First steps."),
    ("lecture", "The lecture's method and its stability notes."),
    ("free", "Motion without contact: integrators against closed forms and conserved quantities."),
    ("contact", "Contact: laws of impact and friction, methods against closed forms."),
    ("stack", "Many bodies on each other."),
    ("event", "Motion from event to event, to a tolerance."),
    ("lecture-full", "The lecture's maps in full, with as many runs as the numbers were first measured with: minutes."),
];

#[test]
fn the_page_of_experiments_has_every_question() {
    let mut folders: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    for config in files("configs", "yaml") {
        let path = config.strip_prefix(root().join("configs")).unwrap();
        let file: serde_yaml::Value = serde_yaml::from_str(&std::fs::read_to_string(&config).unwrap()).unwrap();
        let question = file["question"].as_str().unwrap_or_else(|| panic!("{}: no question", path.display()));
        let folder = path.parent().unwrap().display().to_string();
        folders.entry(folder).or_default().push((path.display().to_string(), question.to_string()));
    }
    let mut text = String::from(
        "# The experiments\n\nA question a file. Made from their `question:` by `tests/docs.rs`. `gotai explain FILE` says \
         what one costs, `gotai check FILE` whether it finds what it expects.\n",
    );
    for (folder, about) in FOLDERS {
        let questions = folders.remove(folder).unwrap_or_else(|| panic!("configs/{folder} is empty"));
        let title = if folder.is_empty() { "configs/".to_string() } else { format!("configs/{folder}/") };
        text += &format!("\n## `{title}`\n\n{about}\n\n| file | question |\n|---|---|\n");
        for (path, question) in questions {
            let file = path.rsplit('/').next().unwrap();
            text += &format!("| [`{file}`]({path}) | {} |\n", question.replace('|', "\\|"));
        }
    }
    assert!(folders.is_empty(), "folders without a sentence: {:?}", folders.keys());
    holds("configs/README.md", &text);
}

#[test]
fn every_link_leads_to_a_file_or_a_heading_that_is_there() {
    let mut lost = Vec::new();
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap()) {
            if link.starts_with("http") {
                continue;
            }
            let (path, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if path.is_empty() { page.clone() } else { page.parent().unwrap().join(path) };
            if !target.exists() {
                lost.push(format!("{}: {link}", name(&page)));
            } else if !heading.is_empty() {
                let there = std::fs::read_to_string(&target).unwrap();
                if !there.lines().filter(|line| line.starts_with('#')).any(|line| anchor(line) == heading) {
                    lost.push(format!("{}: {link}: no such heading", name(&page)));
                }
            }
        }
    }
    assert!(lost.is_empty(), "links that lead nowhere: {lost:#?}");
}

/// As GitHub makes them from a heading.
fn anchor(heading: &str) -> String {
    let words = heading.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
    words.chars().filter(|c| c.is_alphanumeric() || *c == '-' || *c == '_').collect()
}

#[test]
fn every_row_of_the_lecture_leads_to_files_that_are_there() {
    let text = read("docs/lecture.md");
    for row in 1..=25 {
        assert!(text.contains(&format!("| L{row} |")), "docs/lecture.md lacks L{row}");
    }
    // Between backticks: a file or folder of the repository, of src/ or of configs/, or an experiment without `.yaml`.
    let is_there = |path: &&str| {
        ["", "src/", "configs/", "configs/lecture/"].iter().any(|folder| {
            let path = root().join(format!("{folder}{path}"));
            path.exists() || path.with_extension("yaml").exists()
        })
    };
    let is_path =
        |path: &&str| path.contains('/') || [".rs", ".py", ".yaml"].iter().any(|ending| path.ends_with(ending));
    let named = text.split('`').skip(1).step_by(2).filter(|path| !path.contains(' ') && !path.starts_with('.'));
    let lost: Vec<&str> = named.filter(is_path).filter(|path| !is_there(path)).collect();
    assert!(lost.is_empty(), "docs/lecture.md names what is not there: {lost:?}");
}

/// Brackets and braces are patterns to a shell: zsh refuses what they match nothing with.
#[test]
fn examples_of_commands_are_quoted() {
    for page in pages().into_iter().chain(files("configs", "yaml")) {
        // Of an experiment, what its comments say.
        let is_page = page.extension().is_some_and(|ending| ending == "md");
        let text = std::fs::read_to_string(&page).unwrap();
        for line in text.lines().filter(|line| is_page || line.starts_with('#')) {
            let first = line.split_whitespace().next().unwrap_or_default();
            let whole = ["gotai", "cargo", "pip", "rerun"].contains(&first) && line.trim_start() != line;
            let parts = if whole { vec![line] } else { line.split('`').skip(1).step_by(2).collect() };
            for command in parts.into_iter().filter(|part| whole || part.contains("--") || part.starts_with("gotai ")) {
                let bare: String = command.split(['\'', '"']).step_by(2).collect();
                assert!(!bare.contains(['[', '{']), "{}: {command}: brackets without quotes", name(&page));
            }
        }
    }
}

/// Recordings follow the viewer's version: another one may not open them.
#[test]
fn the_viewer_is_named_with_the_version_of_the_recordings() {
    let manifest = read("Cargo.toml");
    let (_, after) = manifest.split_once("rerun = { version = \"=").unwrap();
    let pinned = format!("rerun-sdk=={}", after.split('"').next().unwrap());
    let texts = files("src", "rs").into_iter().chain(pages());
    for path in texts.chain([root().join(".ci/run")]) {
        let text = std::fs::read_to_string(&path).unwrap();
        let named = text.matches("rerun-sdk").count();
        assert_eq!(named, text.matches(&pinned).count(), "{}: {pinned}", name(&path));
    }
}
