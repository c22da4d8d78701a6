//! What pages tell people to do is done as it stands there: the guard of a CI, and how results are read.

use crate::scratch;
use serde_yaml::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn page(name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(name)).unwrap()
}

/// Blocks of a page between fences of a language.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("\n```{language}\n");
    page.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().to_string()).collect()
}

/// A line of a shell in a folder, which finds this program as `gotai`.
fn shell(line: &str, folder: &Path) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_gotai")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap_or_default());
    let mut command = Command::new("sh");
    command.args(["-c", line]).current_dir(folder).env("PATH", path).env("NO_COLOR", "1").output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Lines of the program that a workflow's steps run.
fn lines(steps: &Value) -> Vec<String> {
    let scripts = steps.as_sequence().unwrap().iter().filter_map(|step| step["run"].as_str());
    scripts.flat_map(str::lines).filter(|line| line.starts_with("gotai ")).map(str::to_string).collect()
}

fn with_ending(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|path| path.extension().is_some_and(|found| found == ending)).collect()
}

#[test]
fn the_guard_of_a_ci_passes_and_fails_as_its_page_says() {
    let page = page("ci.md");
    let [scene, workflow, against] = &blocks(&page, "yaml")[..] else { panic!("docs/ci.md has other blocks") };
    let workflow: Value = serde_yaml::from_str(workflow).unwrap();
    let against: Value = serde_yaml::from_str(against).unwrap();
    let build = workflow["jobs"]["check"]["steps"][3]["run"].as_str().unwrap();
    assert!(build.contains("cargo build --locked --release --no-default-features"), "{build}");
    let check = lines(&workflow["jobs"]["check"]["steps"]);
    assert_eq!(check.len(), 1);
    let folder = scratch::folder();
    let of = |name: &str, scene: &str| {
        let folder = folder.path().join(name);
        std::fs::create_dir_all(folder.join("scenes")).unwrap();
        std::fs::write(folder.join("scenes/tray.yaml"), scene).unwrap();
        folder
    };
    let good = of("good", scene);
    for line in check.iter().chain(&lines(&against)) {
        let ran = shell(line, &good);
        assert_eq!(ran.status.code(), Some(0), "{line}: {}{}", text(&ran.stdout), text(&ran.stderr));
    }
    assert!(good.join("changes.html").is_file() && with_ending(&good.join("results/tray"), "mcap").is_empty());
    // The lecture's method makes energy of contacts: rows, verdicts and recordings are there for the artefact.
    let bad = scene.replace("method: time-stepping", "method: lecture");
    let bad = of("bad", &bad.replace("mass_kg: 1,", "mesh: { nodes_per_edge: 3 }, mass_kg: 1,"));
    let ran = shell(&check[0], &bad);
    assert_eq!(ran.status.code(), Some(1), "{}", text(&ran.stderr));
    let kept = with_ending(&bad.join("results/tray"), "mcap").len();
    assert!((1..=24).contains(&kept), "{kept}");
    assert!(bad.join("results/tray/rows.csv").is_file());
    let junit = std::fs::read_to_string(bad.join("junit.xml")).unwrap();
    assert!(junit.contains("<failure") && junit.contains("gotai run results/tray --case "), "{junit}");
    // And it is worse than the version before.
    std::fs::copy(bad.join("scenes/tray.yaml"), good.join("scenes/tray.yaml")).unwrap();
    let [_, after, compare] = &lines(&against)[..] else { panic!("docs/ci.md compares otherwise") };
    assert_eq!(shell(after, &good).status.code(), Some(0));
    let ran = shell(compare, &good);
    assert!(ran.status.code() == Some(1) && text(&ran.stdout).contains("energy_drift_rel"), "{}", text(&ran.stdout));
}

#[test]
fn results_are_read_as_the_page_says() {
    let modules = ["pandas", "polars", "duckdb", "pyarrow", "matplotlib", "nbclient", "ipykernel"];
    let Some(python) = crate::tools::python_for(&modules) else { return };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (page, folder) = (page("results.md"), scratch::folder());
    std::fs::create_dir_all(folder.path().join("configs/lecture")).unwrap();
    let config = "configs/lecture/stability.yaml";
    std::fs::copy(root.join(config), folder.path().join(config)).unwrap();
    for line in page.lines().filter_map(|line| line.strip_prefix("    gotai ")) {
        let ran = shell(&format!("gotai {line}"), folder.path());
        assert!(ran.status.success(), "{line}: {}", text(&ran.stderr));
    }
    let script = folder.path().join("page.py");
    std::fs::write(&script, blocks(&page, "python").concat()).unwrap();
    let ran = Command::new(&python).arg(&script).current_dir(folder.path()).output().unwrap();
    let (said, err) = (text(&ran.stdout), text(&ran.stderr));
    assert!(ran.status.success(), "{said}{err}");
    let expected = blocks(&page, "text").concat();
    for line in expected.lines().filter(|line| *line != "…") {
        assert!(said.lines().any(|said| said.trim_end() == line), "{line}: {said}");
    }
    // The command that the page prints is one.
    let command = said.lines().find(|line| line.starts_with("gotai run ")).unwrap();
    let ran = shell(&format!("{command} --record none"), folder.path());
    assert!(text(&ran.stderr).contains("the same as the row, bit for bit"), "{}", text(&ran.stderr));
    // The notebook, as it stands.
    let run = "import nbformat, nbclient, sys\n\
               notebook = nbformat.read(sys.argv[1], 4)\n\
               nbformat.validate(notebook)\n\
               nbclient.NotebookClient(notebook, timeout=300, kernel_name='python3').execute()\n\
               outputs = [output for cell in notebook.cells for output in cell.get('outputs', [])]\n\
               print(''.join(output.get('text', '') for output in outputs))\n\
               print(sum('image/png' in output.get('data', {}) for output in outputs), 'picture')\n";
    let picture = folder.path().join("map.png");
    let mut command = Command::new(&python);
    command.args(["-c", run]).arg(root.join("docs/results.ipynb")).current_dir(folder.path());
    command.env("GOTAI_RESULTS", folder.path().join("results/stability")).env("GOTAI_PICTURE", &picture);
    command.env("MPLBACKEND", "module://matplotlib_inline.backend_inline");
    let ran = command.output().unwrap();
    let said = text(&ran.stdout);
    assert!(ran.status.success(), "{}", text(&ran.stderr));
    assert!(said.contains("1 picture") && said.contains("ico 162 at 50 ms: 9 of 10 diverge, 60 to 98 %"), "{said}");
    assert!(std::fs::metadata(picture).unwrap().len() > 5_000);
}
