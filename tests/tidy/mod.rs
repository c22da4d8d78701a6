//! Rules of the repository that a reader could forget.

mod floors;
mod sources;

use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![root().join(folder)]);
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == ending) {
                found.push(path);
            }
        }
    }
    assert!(!found.is_empty());
    found.sort();
    found
}

/// std's functions follow the host's libm: the same case would give other bits elsewhere.
#[test]
fn no_kernel_uses_the_hosts_libm() {
    const HOST: [&str; 14] = [
        ".sin()",
        ".cos()",
        ".tan()",
        ".sin_cos()",
        ".asin()",
        ".acos()",
        ".atan()",
        ".atan2(",
        ".exp()",
        ".ln()",
        ".log10()",
        ".powf(",
        ".cbrt()",
        ".hypot(",
    ];
    for file in files("src", "rs") {
        let text = std::fs::read_to_string(&file).unwrap();
        for call in HOST {
            assert!(!text.contains(call), "{}: {call} (use libm)", file.display());
        }
    }
}

#[test]
fn files_stay_short() {
    for file in files("src", "rs").into_iter().chain(files("tests", "rs")) {
        let lines = std::fs::read_to_string(&file).unwrap().lines().count();
        assert!(lines <= 600, "{}: {lines} lines", file.display());
    }
}

#[test]
fn main_is_a_page() {
    let text = std::fs::read_to_string(root().join("src/main.rs")).unwrap();
    assert!(text.lines().count() < 70);
}

/// Comments too, which rustfmt does not wrap. Lines of YAML in tests' texts are as long as a file's may be.
#[test]
fn lines_stay_short() {
    const LONGEST: usize = 120;
    for file in files("src", "rs").into_iter().chain(files("benches", "rs")).chain(files("tests", "rs")) {
        let of_tests = file.starts_with(root().join("tests"));
        for (i, line) in std::fs::read_to_string(&file).unwrap().lines().enumerate() {
            let is_held = !of_tests || line.trim_start().starts_with("//");
            assert!(!is_held || line.chars().count() <= LONGEST, "{}:{}", file.display(), i + 1);
        }
    }
}

/// Folders of experiments are found by `.ci/run` itself; whole maps wait for `.ci/full`.
#[test]
fn every_folder_of_experiments_is_checked() {
    let read = |script: &str| std::fs::read_to_string(root().join(script)).unwrap();
    assert!(read(".ci/run").contains("find configs -mindepth 1 -maxdepth 1 -type d ! -name '*-full'"));
    assert!(read(".ci/full").contains("for folder in configs/*-full"));
    for entry in std::fs::read_dir(root().join("configs")).unwrap() {
        let folder = entry.unwrap().path();
        let expects = |file: &PathBuf| std::fs::read_to_string(file).unwrap().contains("\nexpect:");
        if folder.is_dir() {
            let files = files(folder.strip_prefix(root()).unwrap().to_str().unwrap(), "yaml");
            assert!(files.iter().any(expects), "{}: nothing to check", folder.display());
        }
    }
}
