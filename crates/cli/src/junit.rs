//! Results as JUnit XML, which CI systems read.

use crate::failure::Failure;
use crate::replaced::Replaced;
use crate::{Outcome, print};
use metrics::JudgedExpectation;
use output::{Place, write_whole};
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::path::Path;
use std::time::{Duration, Instant};
use vocabulary::readable;

/// One thing that was checked.
pub(crate) struct ReportedCheck {
    /// What was checked.
    pub(crate) name: String,
    pub(crate) came: Came,
    /// How long it took; an equal share of the whole if `None`.
    pub(crate) time: Option<Duration>,
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

impl ReportedCheck {
    /// An expectation of a scene.
    pub(crate) fn of(finding: &JudgedExpectation) -> Self {
        let came = match finding.met {
            Some(true) => Came::Fine,
            Some(false) => Came::Failed(format!("wanted {}, found {}", finding.wanted, finding.found)),
            None => Came::Skipped(finding.found.clone()),
        };
        Self { name: format!("{}: {}", finding.key, finding.wanted), came, time: None }
    }

    /// An expectation that was not judged.
    pub(crate) fn unjudged(finding: &JudgedExpectation, why: &str) -> Self {
        Self { came: Came::Skipped(why.to_owned()), ..Self::of(finding) }
    }
}

/// Standard output, as it is named.
const STREAM: &str = "-";

/// Does `work`, which says what became of its checks, and writes them to `path` if there is one: a file, or standard output,
/// which results for people then make way for.
pub(crate) fn reported(
    path: Option<&Path>,
    name: &str,
    json: bool,
    quiet: bool,
    work: impl FnOnce(&mut Vec<ReportedCheck>) -> Outcome,
) -> Outcome {
    let (began, mut cases) = (Instant::now(), vec![]);
    let _place = match path {
        Some(path) if path.as_os_str() == STREAM && json => {
            let text = "--junit - and --json would both write to standard output: name a file for one of them, such as \
                        --junit report.xml";
            return Err(Failure::Usage(text.to_owned()));
        }
        Some(path) if path.as_os_str() == STREAM => {
            print::make_way();
            None
        }
        path => path.map(Place::file).transpose()?,
    };
    let outcome = work(&mut cases);
    close(path, name, cases, outcome, began.elapsed(), quiet)
}

/// Writes `cases` of the suite called `name`, which took `wall`, to `path` if there is one, whatever came of them. Work that
/// was cut short is an error among them.
fn close(
    path: Option<&Path>,
    name: &str,
    mut cases: Vec<ReportedCheck>,
    outcome: Outcome,
    wall: Duration,
    quiet: bool,
) -> Outcome {
    let Some(path) = path else { return outcome };
    let mut replaced = Replaced::default();
    replaced.look(path);
    let cut = outcome.as_ref().err().and_then(Failure::text);
    if let Some(text) = cut {
        let came = Came::Broken(text.to_owned());
        cases.push(ReportedCheck { name: "the work comes to its end".to_owned(), came, time: None });
    }
    let written = write(path, name, &cases, wall).map(|()| replaced.tell(quiet));
    match outcome {
        Err(first) if first.text().is_some() => {
            if let Err(other) = written {
                other.tell();
            }
            Err(first)
        }
        outcome => written.and(outcome),
    }
}

fn write(path: &Path, name: &str, cases: &[ReportedCheck], wall: Duration) -> Result<(), Failure> {
    let name = allowed(name);
    let mut suite = TestSuite::new(name.as_str());
    suite.set_time(wall);
    let own: Duration = cases.iter().filter_map(|case| case.time).sum();
    let others = cases.iter().filter(|case| case.time.is_none()).count() as u32;
    let share = wall.saturating_sub(own).checked_div(others).unwrap_or_default();
    for case in cases {
        let (mut status, text) = match &case.came {
            Came::Fine => (TestCaseStatus::success(), None),
            Came::Failed(text) => (TestCaseStatus::non_success(NonSuccessKind::Failure), Some(text)),
            Came::Skipped(text) => (TestCaseStatus::skipped(), Some(text)),
            Came::Broken(text) => (TestCaseStatus::non_success(NonSuccessKind::Error), Some(text)),
        };
        if let Some(text) = text {
            status.set_message(allowed(text));
        }
        let mut written = TestCase::new(allowed(&case.name), status);
        written.set_classname(name.as_str()).set_time(case.time.unwrap_or(share));
        suite.add_test_case(written);
    }
    let mut report = Report::new("echelon");
    report.set_time(wall).add_test_suite(suite);
    let text =
        report.to_string().map_err(|e| Failure::Machine(format!("cannot write {}: {e}", path.display())))?;
    let text = kept_lines(&text);
    if path.as_os_str() == STREAM {
        print::verbatim(&text);
        return Ok(());
    }
    Ok(write_whole(path, text.as_bytes())?)
}

/// XML with the line ends of attributes spelt out: a reader takes bare ones for spaces. Quotes stand around attributes only.
fn kept_lines(xml: &str) -> String {
    let spelt = |part: &str| part.replace('\n', "&#10;").replace('\r', "&#13;").replace('\t', "&#9;");
    let parts = xml.split('"').enumerate();
    let parts: Vec<_> =
        parts.map(|(k, part)| if k % 2 == 1 { spelt(part) } else { part.to_owned() }).collect();
    parts.join("\"")
}

/// Text with what XML does not allow, though escaped, made visible: names of files may hold anything.
fn allowed(text: &str) -> String {
    let fits = |c: char| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..);
    readable(text)
        .chars()
        .map(|c| if fits(c) && !matches!(c, '\u{7f}'..='\u{9f}') { c } else { '\u{fffd}' })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_failed_is_told_and_marked_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("report.xml");
        let case = |name: &str, failure: Option<&str>| ReportedCheck {
            name: name.into(),
            time: None,
            came: failure.map_or(Came::Fine, |text| Came::Failed(text.to_owned())),
        };
        let open = ReportedCheck {
            name: "open".into(),
            came: Came::Skipped("too short".into()),
            time: Some(Duration::from_millis(2500)),
        };
        write(
            &path,
            "line",
            &[case("fine", None), case("a < b", Some("wanted ≤ 1 m,\nfound \"2\" m & more")), open],
            Duration::from_secs(4),
        )
        .expect("written");
        let text = std::fs::read_to_string(&path).expect("text");
        assert!(text.contains("tests=\"3\"") && text.contains("failures=\"1\""), "{text}");
        assert!(text.contains("<skipped") && text.contains("too short"), "{text}");
        assert!(
            text.contains("a &lt; b") && text.contains("wanted ≤ 1 m,&#10;found &quot;2&quot; m &amp; more"),
            "{text}"
        );
        // The whole takes 4 s; what has no time of its own shares what is left.
        for (times, mark) in [(2, "time=\"4.000\""), (1, "time=\"2.500\""), (2, "time=\"0.750\"")] {
            assert_eq!(text.matches(mark).count(), times, "{mark}: {text}");
        }
    }

    /// U+FFFE in a file's name made a report that no reader takes.
    #[test]
    fn what_xml_does_not_allow_is_made_visible() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("report.xml");
        let broken = ReportedCheck {
            name: "a\u{fffe}b\u{1b}[31mc".into(),
            came: Came::Broken("\u{ffff}\0 no".into()),
            time: None,
        };
        write(&path, "x\u{fffe}.toml", &[broken], Duration::ZERO).expect("written");
        let text = std::fs::read_to_string(&path).expect("text");
        assert!(text.contains("errors=\"1\"") && text.contains("a\u{fffd}b\u{fffd}[31mc"), "{text}");
        let fits = |c: char| c >= ' ' && c != '\u{fffe}' && c != '\u{ffff}' || c == '\n';
        assert!(text.chars().all(fits), "{text:?}");
    }
}
