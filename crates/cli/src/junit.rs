//! Results as JUnit XML, which CI systems read.

use crate::failure::Failure;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use recording::write_whole;
use simulation::verdict::Finding;
use std::path::Path;

/// One thing that was checked.
pub(crate) struct Case {
    /// What was checked.
    pub(crate) name: String,
    /// What was wanted and what was found instead; `None` where it is as it should be.
    pub(crate) failure: Option<String>,
    /// Why it was not judged.
    pub(crate) skipped: Option<String>,
}

impl Case {
    /// An expectation of a scene.
    pub(crate) fn of(finding: &Finding) -> Self {
        let failure = finding.failed().then(|| format!("wanted {}, found {}", finding.wanted, finding.found));
        let skipped = finding.met.is_none().then(|| finding.found.clone());
        Self { name: format!("{}: {}", finding.key, finding.wanted), failure, skipped }
    }
}

/// Writes `cases` of the suite called `name` to `path`.
pub(crate) fn write(path: &Path, name: &str, cases: &[Case]) -> Result<(), Failure> {
    let mut suite = TestSuite::new(name);
    for case in cases {
        let mut status = match (&case.failure, &case.skipped) {
            (Some(_), _) => TestCaseStatus::non_success(NonSuccessKind::Failure),
            (None, Some(_)) => TestCaseStatus::skipped(),
            (None, None) => TestCaseStatus::success(),
        };
        if let Some(text) = case.failure.as_ref().or(case.skipped.as_ref()) {
            status.set_message(text.as_str());
        }
        let mut written = TestCase::new(case.name.as_str(), status);
        written.set_classname(name);
        suite.add_test_case(written);
    }
    let mut report = Report::new("echelon");
    report.add_test_suite(suite);
    let text =
        report.to_string().map_err(|e| Failure::Machine(format!("cannot write {}: {e}", path.display())))?;
    Ok(write_whole(path, text.as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_failed_is_told_and_marked_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("report.xml");
        let case = |name: &str, failure: Option<&str>| Case {
            name: name.into(),
            failure: failure.map(str::to_owned),
            skipped: None,
        };
        let open = Case { skipped: Some("too short".into()), ..case("open", None) };
        write(
            &path,
            "line",
            &[case("fine", None), case("a < b", Some("wanted ≤ 1 m, found 2 m & more")), open],
        )
        .expect("written");
        let text = std::fs::read_to_string(&path).expect("text");
        assert!(text.contains("tests=\"3\"") && text.contains("failures=\"1\""), "{text}");
        assert!(text.contains("<skipped") && text.contains("too short"), "{text}");
        assert!(text.contains("a &lt; b") && text.contains("2 m &amp; more"), "{text}");
    }
}
