//! Verdicts as a JUnit file: a suite an experiment, a test an expectation.

use super::checked::Checked;
use super::error::CliError;
use crate::check::Judged;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::path::Path;

/// Writes the verdicts of all files.
///
/// # Errors
/// The machine failed.
pub fn write(path: &Path, checked: &[Checked]) -> Result<(), CliError> {
    let failed = |error: &dyn std::fmt::Display| CliError::Machine(format!("{}: {error}", path.display()));
    let mut report = Report::new("gotai check");
    report.add_test_suites(checked.iter().map(suite));
    let text = report.to_string().map_err(|error| failed(&error))?;
    std::fs::write(path, text).map_err(|error| failed(&error))
}

fn suite(checked: &Checked) -> TestSuite {
    let mut suite = TestSuite::new(checked.name());
    suite.add_test_cases(checked.judged.iter().map(|judged| test(checked, judged)));
    if checked.swept.failed() > 0 {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_message(format!("{} cases failed", checked.swept.failed()));
        suite.add_test_case(TestCase::new("no case fails", status));
    }
    suite
}

fn test(checked: &Checked, judged: &Judged) -> TestCase {
    let status = match judged.met {
        true => TestCaseStatus::success(),
        false => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_message(format!("expected {}, measured {}", judged.bound, judged.measured));
            status
        }
    };
    let mut test = TestCase::new(format!("{}: {}", judged.expectation, judged.bound), status);
    test.set_classname(checked.name());
    test.set_system_out(format!("measured: {}\nwhy: {}", judged.measured, judged.why.as_deref().unwrap_or("-")));
    test
}
