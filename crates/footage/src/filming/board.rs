//! The storyboard as frames: which moment of the run a frame shows, from where, and with what beside it.

use super::words::set_point_rows;
use crate::error::Error;
use rendering::{ViewLayout, Viewpoint};
use scene::{Film, Plot, Shot};

/// How long a card comes and goes, s of the film; and a line at the bottom.
const FADE: [f64; 2] = [0.6, 0.4];

/// A film, shot by shot.
pub(super) struct Board {
    cuts: Vec<Cut>,
    /// Lengths of the cards before and after, s.
    title: f64,
    end: f64,
}

/// A shot with everything said.
struct Cut {
    from: f64,
    to: f64,
    shot: Shot,
    layout: ViewLayout,
    /// The single view before it, where the camera moves from there.
    glides_from: Option<Viewpoint>,
}

/// One frame.
pub(super) struct FramePlan<'a> {
    /// s of the run.
    pub(super) time: f64,
    pub(super) layout: ViewLayout,
    pub(super) line: &'a str,
    pub(super) set_points: bool,
    pub(super) plots: &'a [Plot],
    pub(super) without: &'a [String],
    /// Opacity of the line.
    pub(super) line_opacity: f64,
    /// Opacity of the title card and of the end card.
    pub(super) cards: [f64; 2],
}

impl Board {
    /// That of `film`, whose run lasts `duration` s; or `whole`, a view for all of it, without cards. `view` is where there
    /// is no other.
    pub(super) fn new(
        film: &Film,
        whole: Option<&str>,
        view: &str,
        duration: f64,
        names: &[String],
    ) -> Result<Self, Error> {
        if let Some(view) = whole {
            let shot = Shot { to: Some(duration), ..Shot::default() };
            return Ok(Self { cuts: vec![Cut::new(shot, view, names)?], title: 0.0, end: 0.0 });
        }
        if let Some(beyond) = film.beyond(duration) {
            return Err(Error::Usage(beyond));
        }
        let shots = match film.shots.as_slice() {
            [] => vec![Shot { to: Some(duration), ..Shot::default() }],
            shots => shots.to_vec(),
        };
        let mut cuts: Vec<Cut> = Vec::with_capacity(shots.len());
        let mut view = view.to_owned();
        for shot in shots {
            view = shot.view.clone().unwrap_or(view);
            let mut cut = Cut::new(shot, &view, names)?;
            if let Some(before) = cuts.last() {
                // A jump in time is a cut.
                let same_time = (cut.from - before.to).abs() < 1e-9;
                let both =
                    single(&before.layout).filter(|from| same_time && Some(*from) != single(&cut.layout));
                cut.glides_from = both.and_then(|from| single(&cut.layout).map(|_| from.clone()));
            }
            cuts.push(cut);
        }
        Ok(Self { cuts, title: film.title, end: film.end })
    }

    /// Frames of the whole film at `rate` a second.
    pub(super) fn frames(&self, rate: f64) -> u64 {
        let cuts: u64 = self.cuts.iter().map(|cut| cut.frames(rate)).sum();
        (count(self.title, rate) + cuts + count(self.end, rate)).max(1)
    }

    /// The frame with which the end card begins.
    pub(super) fn last_card(&self, rate: f64) -> u64 {
        self.frames(rate).saturating_sub(count(self.end, rate))
    }

    /// Most rows of a line at the bottom, in a run with so many edges.
    pub(super) fn rows(&self, edges: usize) -> usize {
        let rows = |shot: &Shot| {
            usize::from(!shot.line.is_empty()) + if shot.set_points { set_point_rows(edges) } else { 0 }
        };
        self.cuts.iter().map(|cut| rows(&cut.shot)).max().unwrap_or(0)
    }

    /// Frame number `index`, from 0.
    pub(super) fn at(&self, index: u64, rate: f64) -> FramePlan<'_> {
        let title = count(self.title, rate);
        let mut left = index.saturating_sub(title);
        let seconds = index as f64 / rate;
        let ends = |cut: usize| &self.cuts[cut.min(self.cuts.len() - 1)];
        if index < title {
            let gone = ((self.title - seconds) / FADE[0]).clamp(0.0, 1.0);
            return ends(0).frame(0, rate, [smooth(gone), 0.0]);
        }
        for cut in &self.cuts {
            let frames = cut.frames(rate);
            if left < frames {
                return cut.frame(left, rate, [0.0; 2]);
            }
            left -= frames;
        }
        let last = ends(usize::MAX);
        let opacity = smooth(((left as f64 + 1.0) / rate / FADE[0]).min(1.0));
        FramePlan { time: last.to, line_opacity: 0.0, ..last.frame(last.frames(rate), rate, [0.0, opacity]) }
    }
}

impl Cut {
    fn new(shot: Shot, view: &str, names: &[String]) -> Result<Self, Error> {
        let layout = ViewLayout::parse(view, names)?;
        let (from, to) = (shot.from.unwrap_or(0.0), shot.to.unwrap_or(0.0));
        Ok(Self { from, to, shot, layout, glides_from: None })
    }

    /// s of the film.
    fn length(&self) -> f64 {
        (self.to - self.from) / self.shot.speed
    }

    fn frames(&self, rate: f64) -> u64 {
        count(self.length(), rate).max(1)
    }

    fn frame(&self, index: u64, rate: f64, cards: [f64; 2]) -> FramePlan<'_> {
        let seconds = index as f64 / rate;
        let layout = match (&self.glides_from, single(&self.layout)) {
            (Some(from), Some(to)) if seconds < self.shot.glide => {
                let share = smooth(seconds / self.shot.glide);
                ViewLayout::single(Viewpoint::Between(Box::new(from.clone()), Box::new(to.clone()), share))
            }
            _ => self.layout.clone(),
        };
        let shown = (seconds / FADE[1]).min((self.length() - seconds) / FADE[1]);
        FramePlan {
            time: (self.from + seconds * self.shot.speed).min(self.to),
            layout,
            line: &self.shot.line,
            set_points: self.shot.set_points,
            plots: &self.shot.plots,
            without: &self.shot.without,
            line_opacity: if cards[0] > 0.0 { 0.0 } else { smooth(shown.clamp(0.0, 1.0)) },
            cards,
        }
    }
}

/// The one view of a layout, where a camera can move to and from.
fn single(layout: &ViewLayout) -> Option<&Viewpoint> {
    match layout.views.as_slice() {
        [Viewpoint::Camera(_)] => None,
        [view] => Some(view),
        _ => None,
    }
}

fn count(seconds: f64, rate: f64) -> u64 {
    (seconds * rate).round().max(0.0) as u64
}

/// From 0 to 1 without a jerk at either end.
fn smooth(x: f64) -> f64 {
    x * x * x * (x * (6.0 * x - 15.0) + 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn board(shots: Vec<Shot>, title: f64, end: f64) -> Board {
        let film = Film { shots, title, end, ..Film::default() };
        Board::new(&film, None, "snake", 10.0, &["a".to_owned()]).expect("a board")
    }

    fn shot(from: f64, to: f64, view: &str, speed: f64) -> Shot {
        Shot { from: Some(from), to: Some(to), view: Some(view.to_owned()), speed, ..Shot::default() }
    }

    #[test]
    fn without_a_storyboard_the_film_is_the_run() {
        let board = board(vec![], 0.0, 0.0);
        assert_eq!(board.frames(30.0), 300);
        assert_eq!((board.at(0, 30.0).time, board.at(150, 30.0).time), (0.0, 5.0));
        assert_eq!(board.at(7, 30.0).layout, ViewLayout::single(Viewpoint::Snake));
    }

    #[test]
    fn cards_shots_and_slow_motion_follow_each_other() {
        let board = board(vec![shot(0.0, 2.0, "snake", 1.0), shot(4.0, 5.0, "top", 0.25)], 1.0, 2.0);
        assert_eq!(board.frames(10.0), 10 + 20 + 40 + 20);
        assert_eq!(board.at(0, 10.0).cards, [1.0, 0.0]);
        assert_eq!((board.at(0, 10.0).time, board.at(9, 10.0).time), (0.0, 0.0));
        assert!((board.at(20, 10.0).time - 1.0).abs() < 1e-12);
        // A jump in time is a cut: no camera goes through it.
        assert_eq!(board.at(30, 10.0).layout, ViewLayout::single(Viewpoint::Top));
        assert!((board.at(34, 10.0).time - 4.1).abs() < 1e-12);
        assert!(board.last_card(10.0) == 70 && board.at(70, 10.0).cards[1] > 0.0);
        assert!(board.at(69, 10.0).cards[1] == 0.0);
        let last = board.at(89, 10.0);
        assert!(last.time == 5.0 && last.cards == [0.0, 1.0]);
    }

    #[test]
    fn the_camera_moves_where_time_goes_on() {
        let board = board(vec![shot(0.0, 2.0, "snake", 1.0), shot(2.0, 6.0, "top", 1.0)], 0.0, 0.0);
        let share = |frame: u64| match &board.at(frame, 10.0).layout.views[0] {
            Viewpoint::Between(from, to, share) => {
                assert_eq!((&**from, &**to), (&Viewpoint::Snake, &Viewpoint::Top));
                *share
            }
            _ => 1.0,
        };
        assert!(share(20) == 0.0 && share(35) == 1.0);
        assert!((0..15).all(|k| share(20 + k) <= share(21 + k)));
    }
}
