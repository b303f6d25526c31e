//! Ready-made ways to film a scene, for those who have no storyboard.

use scene::{Film, Plot, Shot};
use vocabulary::words;

words! {
    /// What a film is for.
    pub enum Preset {
        /// For a talk: 1920x1080, title, three views, errors beside the second, end card
        Talk = "talk",
        /// For the supplement of a paper: 1280x720, no cards, errors and speeds beside snake view and top view
        Paper = "paper",
        /// For a phone: 1080x1920, snake view over top view, errors below, title and end card, half a minute at most
        Social = "social",
    }
}

impl Preset {
    /// Sets measures and cards; and, where the scene has no storyboard, the shots of a run of `duration` s.
    pub(super) fn apply(self, film: &mut Film, duration: f64) {
        let (size, cards, most) = match self {
            Self::Talk => ([1920, 1080], [2.5, 4.0], 45.0),
            Self::Paper => ([1280, 720], [0.0, 0.0], 60.0),
            Self::Social => ([1080, 1920], [2.0, 3.0], 24.0),
        };
        (film.size, film.fps) = (size, 30.0);
        [film.title, film.end] = cards;
        if !film.shots.is_empty() {
            return;
        }
        // A long run is shown faster than it was.
        let speed = (duration / most).clamp(1.0, 100.0);
        let errors = vec![Plot::DistanceError, Plot::BearingError];
        let shot = |view: &str, ends: [f64; 2], plots: Vec<Plot>| Shot {
            view: Some(view.to_owned()),
            from: Some(ends[0] * duration),
            to: Some(ends[1] * duration),
            speed,
            plots,
            ..Shot::default()
        };
        film.shots = match self {
            Self::Talk => vec![
                Shot { set_points: true, ..shot("snake", [0.0, 0.35], vec![]) },
                shot("snake", [0.35, 0.7], errors),
                shot("orbit", [0.7, 1.0], vec![]),
            ],
            Self::Paper => {
                let all = [errors, vec![Plot::Speed]].concat();
                vec![shot("snake", [0.0, 0.6], all.clone()), shot("top", [0.6, 1.0], all)]
            }
            Self::Social => vec![shot("snake+top", [0.0, 1.0], errors)],
        };
    }
}
