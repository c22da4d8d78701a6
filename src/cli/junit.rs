//! Verdicts as a JUnit file: a suite an experiment, a test an expectation; what could not be checked is an error.

use super::checked::{Checked, NamedCase, Report, Unchecked};
use super::error::CliError;
use super::output::counted;
use crate::check::{Failing, Judged};
use quick_junit::{NonSuccessKind, Report as Document, TestCase, TestCaseStatus, TestSuite};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

/// Writes the verdicts of all files.
///
/// # Errors
/// The machine failed.
pub fn write(path: &Path, report: &Report) -> Result<(), CliError> {
    let failed = |error: &dyn std::fmt::Display| CliError::Machine(format!("{}: {error}", path.display()));
    let mut document = Document::new("gotai check");
    let begun = report.checked.iter().map(|checked| checked.swept.begun).min();
    document.timestamp = rfc3339(begun.unwrap_or_else(SystemTime::now)).parse().ok();
    document.set_time(report.checked.iter().map(|checked| checked.swept.took).sum());
    document.add_test_suites(report.checked.iter().map(suite));
    document.add_test_suites(report.unchecked.iter().map(unchecked));
    document.add_test_suites(report.skipped.iter().map(|file| skipped(file)));
    let text = document.to_string().map_err(|error| failed(&error))?;
    std::fs::write(path, text).map_err(|error| failed(&error))
}

fn suite(checked: &Checked) -> TestSuite {
    let mut suite = TestSuite::new(checked.name());
    suite.timestamp = rfc3339(checked.swept.begun).parse().ok();
    suite.set_time(checked.swept.took);
    suite.add_test_cases(checked.judged().iter().map(|judged| test(checked, judged)));
    if checked.swept.failed() > 0 {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_message(format!("{} failed", counted(checked.swept.failed(), "case")));
        status.set_description(described(checked, &checked.swept.broken));
        let mut test = TestCase::new("no case fails", status);
        test.set_classname(checked.name());
        suite.add_test_case(test);
    }
    suite
}

fn test(checked: &Checked, judged: &Judged) -> TestCase {
    let status = match judged.met {
        true => TestCaseStatus::success(),
        false => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_message(format!("expected {}, measured {}", judged.bound, judged.measured));
            status.set_description(described(checked, &judged.failing));
            status
        }
    };
    let mut test = TestCase::new(format!("{}: {}", judged.expectation, judged.bound), status);
    test.set_classname(checked.name());
    test.timestamp = rfc3339(checked.swept.begun).parse().ok();
    // All expectations of a file are judged by the same rows: each has its share of their time.
    test.set_time(checked.swept.took / u32::try_from(checked.judged().len()).unwrap_or(1).max(1));
    test.set_system_out(format!("measured: {}\nwhy: {}", judged.measured, judged.why.as_deref().unwrap_or("-")));
    test
}

/// A case a paragraph: what it is, the command that runs it again, and its recordings.
fn described(checked: &Checked, failing: &[Failing]) -> String {
    let cases = checked.cases(failing);
    let more = failing.len() - cases.len();
    let mut lines: Vec<String> = Vec::new();
    for NamedCase { id, place, measured, command, recordings, .. } in &cases {
        lines.push(format!("{id}: {measured}{}{place}", if place.is_empty() { "" } else { ", at " }));
        lines.push(format!("  {command}"));
        lines.extend(recordings.iter().map(|file| format!("  {}", file.display())));
    }
    if more > 0 {
        lines.push(format!("… and {more} more"));
    }
    lines.join("\n")
}

fn unchecked(Unchecked { path, error }: &Unchecked) -> TestSuite {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
    let said = error.to_string();
    status.set_message(said.lines().next().unwrap_or_default());
    status.set_type(if error.code() == 2 { "wrong input" } else { "failed machine" });
    status.set_description(said);
    only(&path.display().to_string(), "the file can be checked", status)
}

fn skipped(file: &str) -> TestSuite {
    let mut status = TestCaseStatus::skipped();
    status.set_message("left out: another file was not met, and --fail-fast was given");
    only(file, "all expectations", status)
}

fn only(file: &str, name: &str, status: TestCaseStatus) -> TestSuite {
    let mut suite = TestSuite::new(file);
    suite.timestamp = rfc3339(SystemTime::now()).parse().ok();
    let mut test = TestCase::new(name, status);
    test.set_classname(file);
    suite.add_test_case(test);
    suite
}

/// A time in UTC, as `2026-01-31T23:59:59Z`; 1970 for what lies before it.
fn rfc3339(time: SystemTime) -> String {
    let s = time.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    // Years from March on, in eras of 400 of them (H. Hinnant, chrono-Compatible Low-Level Date Algorithms, 2021).
    let days = s / 86_400 + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year + year / 4 - year / 100);
    let from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    let year = year + era * 400 + u64::from(month <= 2);
    let (hour, minute, second) = (s / 3600 % 24, s / 60 % 60, s % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}
