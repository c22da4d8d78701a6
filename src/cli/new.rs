//! `gotai new`: a commented experiment to start from.

use super::error::CliError;
use super::output::print;
use crate::experiment::nearest::nearest;
use crate::files::quoted;
use crate::files::{make_folder, write_whole};
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// Name of the file, with or without .yaml
    name: PathBuf,
    /// What it begins as
    #[arg(long, value_name = "TEMPLATE", default_value = "start")]
    from: String,
}

/// Templates by their names. Each is a file of configs/, which the tests run and check.
const TEMPLATES: [(&str, &str); 8] = [
    ("start", include_str!("../../configs/start.yaml")),
    ("projectile", include_str!("../../configs/projectile.yaml")),
    ("demo", include_str!("../../configs/lecture/demo.yaml")),
    ("stability", include_str!("../../configs/lecture/stability.yaml")),
    ("critical-step", include_str!("../../configs/lecture/friction-critical.yaml")),
    ("pile", include_str!("../../configs/stack/pile.yaml")),
    ("bricks", include_str!("../../configs/stack/bricks.yaml")),
    ("overhang", include_str!("../../configs/stack/overhang.yaml")),
];

impl Command {
    /// Writes the file.
    ///
    /// # Errors
    /// There is no such template, the file is there already, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let names = TEMPLATES.map(|(name, _)| name);
        let Some((_, text)) = TEMPLATES.iter().find(|(name, _)| *name == self.from) else {
            let near = nearest(&self.from, &names).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
            let (from, known) = (&self.from, names.join(", "));
            return Err(CliError::Input(format!("--from: expected a template, found `{from}`{near} (known: {known})")));
        };
        let path = match self.name.extension() {
            Some(ending) if ending == "yaml" || ending == "yml" => self.name.clone(),
            _ => {
                let mut name = self.name.clone().into_os_string();
                name.push(".yaml");
                name.into()
            }
        };
        if path.exists() {
            return Err(CliError::Input(format!("{}: expected a new name, found a file", path.display())));
        }
        if let Some(folder) = path.parent().filter(|folder| *folder != Path::new("")) {
            make_folder(folder)?;
        }
        write_whole(&path, text.as_bytes())?;
        let said = quoted(&path.display().to_string());
        print(format!("wrote {said}   (what it costs: gotai explain {said}; whether it holds: gotai check {said})"));
        Ok(ExitCode::SUCCESS)
    }
}
