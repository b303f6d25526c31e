//! Results as JUnit XML, which CI systems read.

use crate::failure::Failure;
use output::write_whole;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use simulation::verdict::Finding;
use std::path::Path;
use vocabulary::readable;

/// One thing that was checked.
pub(crate) struct Case {
    /// What was checked.
    pub(crate) name: String,
    pub(crate) came: Came,
}

/// What came of a check.
pub(crate) enum Came {
    /// It is as it should be.
    Fine,
    /// What was wanted, and what was found instead.
    Failed(String),
    /// Why it was not judged.
    Skipped(String),
    /// Why it could not be checked at all.
    Broken(String),
}

impl Case {
    /// An expectation of a scene.
    pub(crate) fn of(finding: &Finding) -> Self {
        let came = match finding.met {
            Some(true) => Came::Fine,
            Some(false) => Came::Failed(format!("wanted {}, found {}", finding.wanted, finding.found)),
            None => Came::Skipped(finding.found.clone()),
        };
        Self { name: format!("{}: {}", finding.key, finding.wanted), came }
    }
}

/// Writes `cases` of the suite called `name` to `path`.
pub(crate) fn write(path: &Path, name: &str, cases: &[Case]) -> Result<(), Failure> {
    let name = allowed(name);
    let mut suite = TestSuite::new(name.as_str());
    for case in cases {
        let not = |kind, text: &String| {
            let mut status = TestCaseStatus::non_success(kind);
            status.set_message(allowed(text));
            status
        };
        let status = match &case.came {
            Came::Fine => TestCaseStatus::success(),
            Came::Failed(text) => not(NonSuccessKind::Failure, text),
            Came::Skipped(text) => {
                let mut status = TestCaseStatus::skipped();
                status.set_message(allowed(text));
                status
            }
            Came::Broken(text) => not(NonSuccessKind::Error, text),
        };
        let mut written = TestCase::new(allowed(&case.name), status);
        written.set_classname(name.as_str());
        suite.add_test_case(written);
    }
    let mut report = Report::new("echelon");
    report.add_test_suite(suite);
    let text =
        report.to_string().map_err(|e| Failure::Machine(format!("cannot write {}: {e}", path.display())))?;
    Ok(write_whole(path, text.as_bytes())?)
}

/// Text with what XML does not allow, though escaped, made visible: names of files may hold anything.
fn allowed(text: &str) -> String {
    let fits = |c: char| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..);
    readable(text).chars().map(|c| if fits(c) && !matches!(c, '\u{7f}'..='\u{9f}') { c } else { '\u{fffd}' }).collect()
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
            came: failure.map_or(Came::Fine, |text| Came::Failed(text.to_owned())),
        };
        let open = Case { name: "open".into(), came: Came::Skipped("too short".into()) };
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

    /// U+FFFE in a file's name made a report that no reader takes.
    #[test]
    fn what_xml_does_not_allow_is_made_visible() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("report.xml");
        let broken =
            Case { name: "a\u{fffe}b\u{1b}[31mc".into(), came: Came::Broken("\u{ffff}\0 no".into()) };
        write(&path, "x\u{fffe}.toml", &[broken]).expect("written");
        let text = std::fs::read_to_string(&path).expect("text");
        assert!(text.contains("errors=\"1\"") && text.contains("a\u{fffd}b\u{fffd}[31mc"), "{text}");
        let fits = |c: char| c >= ' ' && c != '\u{fffe}' && c != '\u{ffff}' || c == '\n';
        assert!(text.chars().all(fits), "{text:?}");
    }
}
