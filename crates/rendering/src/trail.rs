//! Memory of the past, bounded however long the run: ribbons, ghosts, errors over time, and the steady camera.

use crate::steady::Steady;
use std::collections::VecDeque;
use vocabulary::{Cast, Moment, Pose};

/// How long a ribbon is, s.
pub(crate) const RIBBON: f64 = 12.0;
/// Between two ghosts, s.
const GHOST_EVERY: f64 = 2.5;
/// Most points of a ribbon.
const RIBBON_POINTS: usize = 160;
/// Most points of a tyre mark or of a curve in the chart, which both keep the whole run.
const CURVE_POINTS: usize = 360;

/// What a picture needs to know of the past. It depends on the pushed moments alone.
#[derive(Debug, Clone)]
pub struct Trail {
    pub(crate) steady: Steady,
    pub(crate) ribbons: VecDeque<Row>,
    pub(crate) ghosts: VecDeque<Row>,
    pub(crate) marks: Thinning<Vec<Pose>>,
    pub(crate) errors: Thinning<Vec<[f32; 2]>>,
    cast: Cast,
    spacing: f64,
}

/// The poses of all robots at a time.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    pub(crate) time: f64,
    pub(crate) poses: Vec<Pose>,
}

impl Trail {
    /// An empty memory of a run by `cast`.
    pub fn new(cast: &Cast) -> Self {
        let lead = cast.members.iter().position(|m| m.leads).unwrap_or(0);
        // Many robots have coarser ribbons: the picture shows each of them smaller.
        let points = RIBBON_POINTS.min(6_000 / cast.members.len().max(1)).max(48);
        Self {
            steady: Steady::new(lead),
            ribbons: VecDeque::new(),
            ghosts: VecDeque::new(),
            marks: Thinning::new(),
            errors: Thinning::new(),
            cast: cast.clone(),
            spacing: RIBBON / points as f64,
        }
    }

    /// Takes in the next moment; every control sample, or at least 30 a second.
    ///
    /// A moment that is not later than the last one is ignored.
    pub fn push(&mut self, moment: &Moment) {
        let time = moment.snapshot.time;
        if !time.is_finite() || self.steady.time().is_some_and(|last| time <= last) {
            return;
        }
        let goals: Vec<_> = set_points(&self.cast, moment).into_iter().flatten().collect();
        self.steady.push(moment, &goals);
        let poses = || moment.snapshot.robots.iter().map(|r| r.motion.pose).collect::<Vec<_>>();
        keep(&mut self.ribbons, time, self.spacing, RIBBON, poses);
        keep(&mut self.ghosts, time, GHOST_EVERY, RIBBON, poses);
        self.marks.push(time, poses);
        let error = |e: &[f64; 2]| e.map(|x| x as f32);
        self.errors.push(time, || moment.edges.iter().map(|e| error(&e.error)).collect());
    }
}

/// Where on the ground each edge wants its follower, m.
pub(crate) fn set_points(cast: &Cast, moment: &Moment) -> Vec<Option<[f64; 2]>> {
    let place = |k: usize| {
        let state = moment.edges.get(k)?;
        let leader = moment.snapshot.robots.get(cast.edges.get(k)?.leader)?;
        let [distance, bearing] = state.set_point;
        let (sin, cos) = bearing.sin_cos();
        let place = leader.motion.pose.world_from_body(distance * cos, distance * sin);
        place.iter().all(|x| x.is_finite()).then_some(place)
    };
    (0..cast.edges.len()).map(place).collect()
}

fn keep(rows: &mut VecDeque<Row>, time: f64, every: f64, span: f64, poses: impl Fn() -> Vec<Pose>) {
    // Whole multiples of the spacing, so that what is kept does not hang on where the run began.
    let due =
        rows.back().is_none_or(|last| (time / every + 1e-9).floor() > (last.time / every + 1e-9).floor());
    if due {
        rows.push_back(Row { time, poses: poses() });
    }
    // One row beyond the span, so that a ribbon's end can be cut between two rows.
    while rows.get(1).is_some_and(|second| second.time < time - span) {
        rows.pop_front();
    }
}

/// A record of a whole run in bounded memory: when it is full, every second entry goes and the spacing doubles.
#[derive(Debug, Clone)]
pub(crate) struct Thinning<T> {
    pub(crate) entries: Vec<(f64, T)>,
    every: f64,
}

impl<T> Thinning<T> {
    fn new() -> Self {
        Self { entries: Vec::new(), every: 0.1 }
    }

    fn push(&mut self, time: f64, value: impl FnOnce() -> T) {
        let due = |last: f64| (time / self.every + 1e-9).floor() > (last / self.every + 1e-9).floor();
        if self.entries.last().is_some_and(|(last, _)| !due(*last)) {
            return;
        }
        if self.entries.len() >= CURVE_POINTS {
            let mut index = 0;
            self.entries.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.every *= 2.0;
        }
        self.entries.push((time, value()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Member, RobotState, Snapshot};

    #[test]
    fn memory_is_bounded() {
        let member = Member { name: "a".into(), leads: true, body: vocabulary::Body::default() };
        let cast = Cast { members: vec![member], ..Cast::default() };
        let mut trail = Trail::new(&cast);
        for k in 0..200_000 {
            let robots = vec![RobotState::default()];
            let snapshot = Snapshot { time: f64::from(k) * 0.01, robots, ..Snapshot::default() };
            trail.push(&Moment { snapshot, ..Moment::default() });
        }
        assert!(trail.ribbons.len() <= RIBBON_POINTS + 2);
        assert!(trail.ghosts.len() <= 6);
        assert!(trail.marks.entries.len() <= CURVE_POINTS && trail.marks.entries.len() > CURVE_POINTS / 4);
        assert!(trail.marks.entries[0].0 == 0.0);
    }
}
