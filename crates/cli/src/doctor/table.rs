//! The measurements of `echelon doctor --bench` as lines and as JSON, each with what a user may expect.

use serde_json::{Value, json};
use studies::pace::Pace;

/// A picture a second below which nobody sees steps, and one below which motion is no longer followed.
const LIVE: f64 = 30.0;
const FOLLOWED: f64 = 10.0;
/// Frames of a second of film.
pub(crate) const FILM_RATE: f64 = 30.0;

/// What a row is about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Subject {
    /// A picture, drawn and read back; width and height in pixels.
    Picture([u32; 2]),
    /// A frame of a film, drawn and encoded.
    Frame([u32; 2]),
    /// An instant at which so many cameras on robots take pictures, and the time to the next, s.
    Instant { cameras: usize, period: f64 },
    /// A second of a run without pictures.
    Second,
}

/// A measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Row {
    pub(crate) subject: Subject,
    pub(crate) scene: &'static str,
    pub(crate) robots: usize,
    pub(crate) pace: Pace,
}

impl Row {
    /// What is measured, and in which detail.
    fn words(&self) -> (&'static str, String) {
        let size = |[width, height]: [u32; 2]| format!("{width}×{height}");
        match self.subject {
            Subject::Picture(of) => ("picture", size(of)),
            Subject::Frame(of) => ("film frame", size(of)),
            Subject::Instant { cameras, .. } => ("camera instant", format!("{cameras} cameras")),
            Subject::Second => ("second of a run", String::new()),
        }
    }

    /// Simulated time that a repetition stands for, s, where there is one.
    fn simulated(&self) -> Option<f64> {
        match self.subject {
            Subject::Picture(_) => None,
            Subject::Frame(_) => Some(1.0 / FILM_RATE),
            Subject::Instant { period, .. } => Some(period),
            Subject::Second => Some(1.0),
        }
    }

    /// Whether the pace is one of pictures, not of simulated time.
    fn counts_pictures(&self) -> bool {
        matches!(self.subject, Subject::Picture(_) | Subject::Frame(_))
    }

    fn expectation(&self) -> String {
        let Some(simulated) = self.simulated() else {
            let rate = 1.0 / self.pace.seconds;
            let word = match rate {
                rate if rate >= LIVE => "live",
                rate if rate >= FOLLOWED => "jerky",
                _ => "slow",
            };
            return word.to_owned();
        };
        let minute = span(60.0 * self.pace.seconds / simulated);
        match self.subject {
            Subject::Frame(_) => format!("a minute of film in {minute}"),
            _ if self.pace.seconds <= simulated => format!("live; a minute in {minute}"),
            _ => format!("slower than live; a minute in {minute}"),
        }
    }

    /// As a line of the table.
    pub(crate) fn text(&self) -> String {
        let (what, detail) = self.words();
        let pace = match self.simulated().filter(|_| !self.counts_pictures()) {
            None => format!("{} a second", figures(1.0 / self.pace.seconds)),
            Some(simulated) => format!("{} × real time", figures(simulated / self.pace.seconds)),
        };
        let median = format!("{} ms", figures(1e3 * self.pace.seconds));
        line([what, self.scene, &self.robots.to_string(), &detail, &median, &pace, &self.expectation()])
    }

    /// As JSON.
    pub(crate) fn as_json(&self) -> Value {
        let mut value = json!({
            "what": self.words().0, "scene": self.scene, "robots": self.robots,
            "median_ms": 1e3 * self.pace.seconds, "repetitions": self.pace.repetitions, "expect": self.expectation(),
        });
        match self.subject {
            Subject::Picture(size) | Subject::Frame(size) => value["size"] = json!(size),
            Subject::Instant { cameras, .. } => value["cameras"] = json!(cameras),
            Subject::Second => {}
        }
        if self.counts_pictures() {
            value["per_second"] = json!(1.0 / self.pace.seconds);
        } else {
            value["times_real_time"] = json!(self.simulated().map(|simulated| simulated / self.pace.seconds));
        }
        value
    }
}

/// Above the rows.
pub(crate) fn head() -> String {
    line(["", "scene", "robots", "", "median", "pace", "expect"])
}

/// Below the rows.
pub(crate) fn legend() -> String {
    format!(
        "live: {LIVE} pictures a second or more, or as fast as the clock; jerky: {FOLLOWED} or more; slow: fewer"
    )
}

fn line([what, scene, robots, detail, median, pace, expect]: [&str; 7]) -> String {
    let line = format!("{what:<16}{scene:<19}{robots:>6}  {detail:<10}{median:>11}{pace:>20}  {expect}");
    line.trim_end().to_owned()
}

/// A number with three figures that count.
fn figures(value: f64) -> String {
    let digits = match value {
        value if value >= 99.95 => 0,
        value if value >= 9.995 => 1,
        value if value >= 0.9995 => 2,
        _ => 3,
    };
    format!("{value:.digits$}")
}

/// A time in the unit that suits it.
fn span(seconds: f64) -> String {
    match seconds {
        seconds if seconds >= 5400.0 => format!("{} h", figures(seconds / 3600.0)),
        seconds if seconds >= 90.0 => format!("{} min", figures(seconds / 60.0)),
        seconds => format!("{} s", figures(seconds)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(subject: Subject, seconds: f64) -> Row {
        Row { subject, scene: "figure-eight-seven", robots: 7, pace: Pace { seconds, repetitions: 4 } }
    }

    #[test]
    fn the_judgement_of_a_picture_has_stated_limits() {
        let judged = |rate: f64| row(Subject::Picture([640, 360]), 1.0 / rate).expectation();
        assert_eq!([30.1, 29.9, 10.1, 9.9].map(judged), ["live", "jerky", "jerky", "slow"]);
        assert!(legend().contains("live: 30 ") && legend().contains("jerky: 10 "));
    }

    #[test]
    fn lengths_of_work_are_those_of_a_minute() {
        let expected = |subject, seconds| row(subject, seconds).expectation();
        assert_eq!(expected(Subject::Frame([1280, 720]), 0.1), "a minute of film in 3.00 min");
        assert_eq!(expected(Subject::Instant { cameras: 6, period: 0.04 }, 0.02), "live; a minute in 30.0 s");
        assert_eq!(expected(Subject::Second, 2.0), "slower than live; a minute in 2.00 min");
        assert_eq!(expected(Subject::Second, 0.001), "live; a minute in 0.060 s");
        assert_eq!(span(7200.0), "2.00 h");
    }

    #[test]
    fn columns_stand_below_each_other() {
        let rows = [
            row(Subject::Picture([3840, 2160]), 1.234_56),
            row(Subject::Frame([1280, 720]), 0.05),
            row(Subject::Instant { cameras: 6, period: 0.04 }, 0.02),
            row(Subject::Second, 0.002),
        ];
        let place = |line: &str, word: &str| line.find(word).map(|byte| line[..byte].chars().count());
        let expect = place(&head(), "expect").expect("a head");
        for row in rows {
            let line = row.text();
            assert_eq!(place(&line, &row.expectation()), Some(expect), "{line}");
            assert_eq!(place(&line, row.scene), place(&head(), "scene"), "{line}");
        }
        assert_eq!(
            rows[0].text(),
            "picture         figure-eight-seven      7  3840×2160     1235 ms      0.810 a second  slow"
        );
    }

    #[test]
    fn data_has_the_same_figures() {
        let value = row(Subject::Instant { cameras: 6, period: 0.04 }, 0.02).as_json();
        assert_eq!((&value["median_ms"], &value["times_real_time"]), (&json!(20.0), &json!(2.0)));
        assert_eq!((&value["cameras"], &value["repetitions"]), (&json!(6), &json!(4)));
        let value = row(Subject::Picture([640, 360]), 0.025).as_json();
        assert_eq!((&value["size"], &value["per_second"]), (&json!([640, 360]), &json!(40.0)));
        assert_eq!(value["expect"], "live");
    }
}
