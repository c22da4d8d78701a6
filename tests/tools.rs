//! Tests that need what cargo does not bring: a program, or a module of Python's. Where it is missing the test prints
//! SKIP and passes; where `GOTAI_REQUIRE` names it (names apart by commas or spaces) the test fails. `.ci/run` installs
//! what is needed and requires it.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The program of this name on the PATH. None: skip the test.
///
/// # Panics
/// If it is missing and required.
pub fn tool(name: &str) -> Option<PathBuf> {
    available(name, on_path(name))
}

/// The Rerun Viewer, if it can draw without a screen: on Linux with a Vulkan driver. None: skip the test.
///
/// # Panics
/// If it is missing and required, as `viewer`.
pub fn viewer() -> Option<PathBuf> {
    let drivers = std::fs::read_dir("/usr/share/vulkan/icd.d").is_ok_and(|mut drivers| drivers.next().is_some());
    available("viewer", on_path("rerun").filter(|_| drivers))
}

/// A Python that can import all of these modules; its name in `GOTAI_REQUIRE` is `python`. None: skip the test.
///
/// # Panics
/// If it is missing and required.
pub fn python_for(modules: &[&str]) -> Option<PathBuf> {
    available("python", on_path("python3").filter(|python| imports(python, &modules.join(", "))))
}

/// A browser and the program that drives it: Chromium and its driver. None: skip the test.
///
/// # Panics
/// If one is missing and required, as `browser`.
pub fn browser() -> Option<(PathBuf, PathBuf)> {
    let driver = available("browser", on_path("chromedriver").filter(|_| on_path("chromium").is_some()));
    driver.and_then(|driver| Some((on_path("chromium")?, driver)))
}

/// A Python that can import `module`, whose name is also its name in `GOTAI_REQUIRE`. None: skip the test.
///
/// # Panics
/// If it is missing and required.
pub fn python_with(module: &str) -> Option<PathBuf> {
    available(module, on_path("python3").filter(|python| imports(python, module)))
}

fn imports(python: &Path, modules: &str) -> bool {
    let mut command = Command::new(python);
    command.args(["-c", &format!("import {modules}")]).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

fn on_path(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|file| is_program(file))
}

fn is_program(file: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    std::fs::metadata(file).is_ok_and(|about| about.is_file() && about.permissions().mode() & 0o111 != 0)
}

fn available(name: &str, found: Option<PathBuf>) -> Option<PathBuf> {
    let required = std::env::var("GOTAI_REQUIRE").unwrap_or_default();
    let found = rule(name, found, &required).unwrap_or_else(|error| panic!("{error}"));
    if found.is_none() {
        // Not `eprintln!`: of a test that passes, that is not shown.
        let test = std::thread::current().name().unwrap_or_default().to_owned();
        let _ = writeln!(std::io::stderr(), "SKIP {test}: {name} is not on this machine");
    }
    found
}

fn rule(name: &str, found: Option<PathBuf>, required: &str) -> Result<Option<PathBuf>, String> {
    let required = required.split([',', ' ']).any(|word| word == name);
    if found.is_none() && required {
        return Err(format!("GOTAI_REQUIRE names {name}, and it is not on this machine"));
    }
    Ok(found)
}

#[test]
fn a_missing_tool_skips_its_test_unless_it_is_required() {
    let here = Some(PathBuf::from("/bin/it"));
    for required in ["", "it", "other,it", "other it", "other, it"] {
        assert_eq!(rule("it", here.clone(), required), Ok(here.clone()));
    }
    for required in ["", "other", "it2,2it", "other it2"] {
        assert_eq!(rule("it", None, required), Ok(None), "{required}");
    }
    for required in ["it", "other,it", "it other", "other, it"] {
        assert!(rule("it", None, required).unwrap_err().contains("it"), "{required}");
    }
}

#[test]
fn tools_are_looked_for_on_the_path() {
    assert!(tool("cargo").is_some_and(|path| path.is_absolute()));
    assert_eq!(on_path("no-such-program-of-anybody"), None);
    // A folder and a file that nobody may run are no programs.
    assert!(!is_program(Path::new(env!("CARGO_MANIFEST_DIR"))) && !is_program(Path::new(file!())));
}
