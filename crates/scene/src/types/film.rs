//! How a film is made: measures, cards, and the storyboard.

use super::stage::ViewForm;
use crate::text::words::word;
use crate::text::{
    Couple, Flag, Form, Node, Optional, Part, Reporter, Text, Value, integer, list, number, settings, table,
};
use serde_json::{Value as Json, json};
use vocabulary::words;

/// Longest card, s.
const CARD: f64 = 60.0;
/// Most shots of a storyboard.
const MOST_SHOTS: usize = 200;

settings! {
    /// How a film is made when the command line does not say.
    pub struct Film from FilmPart {
        /// View; the scene's default view if left out.
        pub view: Option<String> = None, Optional(ViewForm);
        /// Frames a second.
        pub fps: f64 = 30.0, number("1/s").from(1.0).up_to(240.0);
        /// [width, height] in pixels, both even.
        pub size: [u32; 2] = [1280, 720], Couple(integer::<u32>(16, 8192), integer::<u32>(16, 8192));
        /// How long a card with the title stands before the run, s; 0 for none.
        pub title: f64 = 0.0, number("s").from(0.0).up_to(CARD);
        /// How long a card with what the run showed stands after it, s; 0 for none.
        pub end: f64 = 0.0, number("s").from(0.0).up_to(CARD);
        /// The storyboard: shots in the order of time. Without any the film is one shot of the whole run.
        pub shots: Vec<Shot> = vec![], list(ShotForm, 0, MOST_SHOTS);
    }
}

settings! {
    /// One shot of a film.
    pub struct Shot from ShotPart {
        /// When it begins, s of the run; where the shot before ends if left out. What lies between is skipped.
        pub from: Option<f64> = None, Optional(number("s").from(0.0).up_to(1e5));
        /// When it ends, s of the run; where the next begins, or with the run, if left out.
        pub to: Option<f64> = None, Optional(number("s").from(0.0).up_to(1e5));
        /// View as for pictures; several joined by '+' split the picture. The one before if left out.
        pub view: Option<String> = None, Optional(LayoutForm);
        /// Seconds of the run in a second of the film: below 1 is slow motion.
        pub speed: f64 = 1.0, number("").from(0.01).up_to(100.0);
        /// How long the camera moves from the view before to this one, s of the film; 0 cuts. Split pictures and cameras on
        /// robots are cut to.
        pub glide: f64 = 1.5, number("s").from(0.0).up_to(CARD);
        /// A line at the bottom of the picture.
        pub line: String = String::new(), Text(200);
        /// Whether the set points stand in that line.
        pub set_points: bool = false, Flag;
        /// What is plotted beside the view as the run goes, at most four.
        pub plots: Vec<Plot> = vec![], list(word::<Plot>(), 0, 4);
        /// Elements of pictures to leave out, such as "labels", "inset", "ghosts".
        pub without: Vec<String> = vec![], list(Text(40), 0, 40);
    }
}

words! {
    /// What is plotted beside a view.
    pub enum Plot {
        /// Error of the distance, m.
        DistanceError = "distance-error",
        /// Error of the bearing, degrees.
        BearingError = "bearing-error",
        /// Forward speed, m/s.
        Speed = "speed",
        /// Turn rate that was applied, rad/s.
        TurnRate = "turn-rate",
        /// Acceleration that was applied, m/s².
        Acceleration = "acceleration",
        /// Distance between leader and follower, m.
        Distance = "distance",
    }
}

impl Film {
    /// What of the storyboard is beyond the end of a run of `duration` s, in words; `None` where all of it is in the run.
    pub fn beyond(&self, duration: f64) -> Option<String> {
        // A run ends at its last sample, which rounding may put a little before its duration.
        let end = duration * (1.0 + 1e-9);
        let late = |shot: &Shot| {
            shot.to.is_some_and(|to| to > end) || shot.from.is_some_and(|from| from >= duration)
        };
        let (index, shot) = self.shots.iter().enumerate().find(|(_, shot)| late(shot))?;
        Some(format!(
            "shot {} of the film, from {} to {} s, is beyond the end of the run at {duration} s: end it earlier, or \
             leave the storyboard out with --set film.shots=[]",
            index + 1,
            shot.from.unwrap_or(0.0),
            shot.to.unwrap_or(duration)
        ))
    }
}

/// A shot.
struct ShotForm;

impl Form for ShotForm {
    type Out = Shot;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Shot> {
        table::<ShotPart>().read(node, reporter).map(|part| part.complete(&ShotPart::default()))
    }

    fn schema(&self) -> Json {
        table::<ShotPart>().schema()
    }
}

/// One to four views joined by '+'.
struct LayoutForm;

impl Form for LayoutForm {
    type Out = String;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<String> {
        let expected = || "views joined by '+', such as \"snake+top\"".to_owned();
        let text = reporter.expect(node.as_text(), node, expected)?;
        let parts: Vec<&str> = text.split('+').collect();
        if parts.len() > 4 {
            reporter
                .report(node.span, format!("{} views are too many for one picture: at most 4", parts.len()));
            return None;
        }
        let known = parts.iter().all(|part| {
            let part = Node { span: node.span, value: Value::Text(part.trim().to_owned()) };
            ViewForm.read(&part, reporter).is_some()
        });
        known.then(|| text.to_owned())
    }

    fn schema(&self) -> Json {
        json!({ "type": "string", "description": "views joined by '+'" })
    }
}
