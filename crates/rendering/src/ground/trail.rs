//! The past of a run in bounded memory: ribbons, ghosts, errors over time, and the smoothed camera.

use crate::camera::smoothing::SmoothedFormation;
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use vocabulary::math;
use vocabulary::{Contact, EventRecord, FleetInfo, MeasurementRecord, PlannedPath, Pose, StepRecord, wrap};

/// How long a ribbon is, s.
pub(crate) const RIBBON: f64 = 12.0;
/// Between two ghosts, s.
const GHOST_EVERY: f64 = 2.5;
/// Most points of a ribbon.
const RIBBON_POINTS: usize = 160;
/// Most points of a tyre mark or of a curve in the chart, which both keep the whole run.
const CURVE_POINTS: usize = 360;

/// Most contacts that are remembered.
const TOUCHES: usize = 256;
/// Events that are remembered.
const EVENTS: usize = 8;
/// A tyre that slides by less than this does not show it, rad; by the second it leaves all its rubber.
const SLIDE: [f64; 2] = [0.052, 0.35];

/// The past that a picture shows. It depends on the pushed moments alone. A copy shares its data with
/// the original, so that a run can keep one every few seconds to go back to.
#[derive(Debug, Clone)]
pub struct Trail {
    pub(crate) smoothed: SmoothedFormation,
    pub(crate) ribbons: VecDeque<PoseRow>,
    pub(crate) ghosts: VecDeque<PoseRow>,
    pub(crate) marks: Thinning<Arc<[SkidMark]>>,
    /// Contacts by their first sight, old to new.
    pub(crate) touches: VecDeque<Contact>,
    /// What happened to the formation, and when in s, old to new.
    pub(crate) events: VecDeque<(f64, EventRecord)>,
    /// The plans that hold, by their leads.
    pub(crate) plans: BTreeMap<usize, Arc<PlannedPath>>,
    /// Contacts up to this number are known or forgotten.
    forgotten: Option<u64>,
    /// Of the moment before, and how each robot has slid since the last mark.
    before: Vec<Pose>,
    slides: Vec<f32>,
    /// The last measurement of each edge.
    measurements: Vec<Option<MeasurementRecord>>,
    pub(crate) errors: Thinning<Arc<[[f32; 2]]>>,
    fleet: Arc<FleetInfo>,
    spacing: f64,
}

/// The poses of all robots at a time.
#[derive(Debug, Clone)]
pub(crate) struct PoseRow {
    pub(crate) time: f64,
    pub(crate) poses: Arc<[Pose]>,
}

/// Where a robot drove, and how much it slid there: 0 to 1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SkidMark {
    pub(crate) pose: Pose,
    pub(crate) slide: f32,
}

impl Trail {
    /// An empty memory of a run by `fleet`.
    pub fn new(fleet: &FleetInfo) -> Self {
        let lead = fleet.robots.iter().position(|m| m.leads).unwrap_or(0);
        // Many robots have coarser ribbons: the picture shows each of them smaller.
        let points = RIBBON_POINTS.min(6_000 / fleet.robots.len().max(1)).max(48);
        Self {
            smoothed: SmoothedFormation::new(lead, sizes(fleet)),
            ribbons: VecDeque::new(),
            ghosts: VecDeque::new(),
            marks: Thinning::new(),
            touches: VecDeque::new(),
            events: VecDeque::new(),
            plans: BTreeMap::new(),
            forgotten: None,
            before: Vec::new(),
            slides: Vec::new(),
            measurements: vec![None; fleet.edges.len()],
            errors: Thinning::new(),
            fleet: Arc::new(fleet.clone()),
            spacing: RIBBON / points as f64,
        }
    }

    /// The time of the last moment, s.
    pub fn time(&self) -> Option<f64> {
        self.smoothed.time
    }

    /// Adds the next moment; every control sample, or at least 30 a second.
    ///
    /// A moment that is not later than the last one is ignored.
    pub fn push(&mut self, record: &StepRecord) {
        let time = record.snapshot.time;
        if !time.is_finite() || self.smoothed.time.is_some_and(|last| time <= last) {
            return;
        }
        let goals: Vec<_> = set_points(&self.fleet, record).into_iter().flatten().collect();
        self.smoothed.push(record, &goals);
        let poses = || record.snapshot.robots.iter().map(|r| r.motion.pose).collect::<Arc<[Pose]>>();
        keep(&mut self.ribbons, time, self.spacing, RIBBON, poses);
        keep(&mut self.ghosts, time, GHOST_EVERY, RIBBON, poses);
        self.touch(&record.contacts);
        for event in &record.events {
            self.events.push_back((time, *event));
            if self.events.len() > EVENTS {
                self.events.pop_front();
            }
        }
        for plan in &record.plans {
            let Some(lead) = plan.lead() else { continue };
            // Another may lead in the place of one that has failed.
            self.plans.retain(|_, known| !known.robots.contains(&lead));
            self.plans.insert(lead, plan.clone());
        }
        for frame in &record.frames {
            if let Some(last) = self.measurements.get_mut(frame.edge) {
                *last = Some(*frame);
            }
        }
        self.slide(record);
        let (before, slides) = (&self.before, &self.slides);
        let marks = || {
            before.iter().zip(slides).map(|(pose, slide)| SkidMark { pose: *pose, slide: *slide }).collect()
        };
        if self.marks.push(time, marks) {
            self.slides.fill(0.0);
        }
        // Who follows nobody has no error.
        let error = |index: usize| match record.edge(&self.fleet, index) {
            Some(_) => record.edges[index].error.map(|x| x as f32),
            None => [f32::NAN; 2],
        };
        self.errors.push(time, || (0..record.edges.len()).map(error).collect());
    }

    /// The last measurement of an edge that arrived.
    pub(crate) fn measurement(&self, edge: usize) -> Option<&MeasurementRecord> {
        self.measurements.get(edge)?.as_ref()
    }

    /// Remembers contacts that are new.
    fn touch(&mut self, contacts: &[Contact]) {
        for contact in contacts {
            let known = self.touches.iter().any(|t| t.number == contact.number);
            let place = contact.place.iter().all(|x| x.is_finite());
            if known || !place || self.forgotten.is_some_and(|number| contact.number <= number) {
                continue;
            }
            self.touches.push_back(*contact);
            if self.touches.len() > TOUCHES {
                self.forgotten = self.touches.pop_front().map(|t| t.number).max(self.forgotten);
            }
        }
    }

    /// Compares the robots' motion since the moment before with their headings.
    fn slide(&mut self, record: &StepRecord) {
        let poses = || record.snapshot.robots.iter().map(|r| r.motion.pose);
        self.slides.resize(poses().len(), 0.0);
        for ((slide, from), to) in self.slides.iter_mut().zip(&self.before).zip(poses()) {
            *slide = slide.max(slid(from, &to));
        }
        self.before.clear();
        self.before.extend(poses());
    }
}

/// How much a robot slid between two poses, 0 to 1.
fn slid(from: &Pose, to: &Pose) -> f32 {
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    if math::hypot(dx, dy) < 1e-3 {
        return 0.0;
    }
    let heading = from.heading + 0.5 * wrap(to.heading - from.heading);
    let angle = wrap(math::atan2(dy, dx) - heading).abs();
    // Backwards is no slide.
    let angle = angle.min(std::f64::consts::PI - angle);
    ((angle - SLIDE[0]) / (SLIDE[1] - SLIDE[0])).clamp(0.0, 1.0) as f32
}

/// How many times as large as the default body every robot is.
pub(crate) fn sizes(fleet: &FleetInfo) -> f64 {
    fleet.robots.iter().map(|m| crate::gpu::model::size(&m.body)).fold(0.0, f64::max)
}

/// All places on the ground that the set point of edge number `index` allows, m, as a line: the circle of a wanted distance
/// around the leader where the bearing is left free, the ray of a wanted bearing where the distance is. The line begins and
/// ends opposite the follower, or at the leader. `None` where both are wanted, or nobody is followed.
pub fn free_places(fleet: &FleetInfo, record: &StepRecord, index: usize) -> Option<Vec<[f64; 2]>> {
    let free = fleet.free(index);
    let state = record.edges.get(index)?;
    let leader = record.snapshot.robots.get(record.edge(fleet, index)?.leader)?.motion.pose;
    let [distance, bearing] = state.set_point;
    let place = |k: u32| {
        let share = f64::from(k) / f64::from(SIDES);
        match free {
            [false, true] => {
                Some(leader.polar(distance, bearing + (2.0 * share - 1.0) * std::f64::consts::PI))
            }
            [true, false] => Some(leader.polar(1.5 * share * distance, bearing)),
            _ => None,
        }
    };
    let places = (0..=SIDES).map(place).collect::<Option<Vec<_>>>()?;
    places.iter().flatten().all(|x| x.is_finite()).then_some(places)
}

/// Sides of what is drawn for a circle.
const SIDES: u32 = 96;

/// The set point of each edge on the ground, m; `None` where its follower follows nobody. What is left free of one is as it
/// is.
pub fn set_points(fleet: &FleetInfo, record: &StepRecord) -> Vec<Option<[f64; 2]>> {
    let place = |k: usize| {
        let state = record.edges.get(k)?;
        let leader = record.snapshot.robots.get(record.edge(fleet, k)?.leader)?;
        let [distance, bearing] = state.set_point;
        let place = leader.motion.pose.polar(distance, bearing);
        place.iter().all(|x| x.is_finite()).then_some(place)
    };
    (0..fleet.edges.len()).map(place).collect()
}

fn keep(rows: &mut VecDeque<PoseRow>, time: f64, every: f64, span: f64, poses: impl Fn() -> Arc<[Pose]>) {
    // Whole multiples of the spacing, so that what is kept does not hang on where the run began.
    let due =
        rows.back().is_none_or(|last| (time / every + 1e-9).floor() > (last.time / every + 1e-9).floor());
    if due {
        rows.push_back(PoseRow { time, poses: poses() });
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

    /// Whether the value was due and is kept.
    fn push(&mut self, time: f64, value: impl FnOnce() -> T) -> bool {
        let due = |last: f64| (time / self.every + 1e-9).floor() > (last / self.every + 1e-9).floor();
        if self.entries.last().is_some_and(|(last, _)| !due(*last)) {
            return false;
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
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{RobotInfo, RobotState, Snapshot};

    #[test]
    fn memory_is_bounded() {
        let member = RobotInfo::new("a", true, vocabulary::Body::default());
        let fleet = FleetInfo { robots: vec![member], ..FleetInfo::default() };
        let mut trail = Trail::new(&fleet);
        for k in 0..200_000 {
            let robots = vec![RobotState::default()];
            let snapshot = Snapshot { time: f64::from(k) * 0.01, robots, ..Snapshot::default() };
            trail.push(&StepRecord { snapshot, ..StepRecord::default() });
        }
        assert!(trail.ribbons.len() <= RIBBON_POINTS + 2);
        assert!(trail.ghosts.len() <= 6);
        assert!(trail.marks.entries.len() <= CURVE_POINTS && trail.marks.entries.len() > CURVE_POINTS / 4);
        assert!(trail.marks.entries[0].0 == 0.0);
    }

    #[test]
    fn a_copy_shares_what_is_remembered() {
        let member = RobotInfo::new("a", true, vocabulary::Body::default());
        let fleet = FleetInfo { robots: vec![member; 7], ..FleetInfo::default() };
        let mut trail = Trail::new(&fleet);
        assert_eq!(trail.time(), None);
        for k in 0..6_000 {
            let robots = vec![RobotState::default(); 7];
            let snapshot = Snapshot { time: f64::from(k) * 0.01, robots, ..Snapshot::default() };
            trail.push(&StepRecord { snapshot, ..StepRecord::default() });
        }
        assert_eq!(trail.time(), Some(59.99));
        let copy = trail.clone();
        let shared = |k: usize| Arc::ptr_eq(&trail.marks.entries[k].1, &copy.marks.entries[k].1);
        assert!((0..trail.marks.entries.len()).all(shared));
        // What is its own, bytes.
        let rows = copy.ribbons.len() + copy.ghosts.len();
        let entries = copy.marks.entries.len() + copy.errors.entries.len();
        let own = rows * size_of::<PoseRow>() + entries * size_of::<(f64, Arc<[SkidMark]>)>();
        assert!(own < 30_000, "{own}");
    }

    #[test]
    fn what_is_left_free_of_a_set_point_is_a_circle_or_a_ray() {
        let robots = vec![RobotInfo::new("a", true, vocabulary::Body::default()); 2];
        let edges = vec![vocabulary::Edge { leader: 0, follower: 1 }];
        let mut fleet = FleetInfo { robots, edges, ..FleetInfo::default() };
        let mut robots = vec![RobotState::default(); 2];
        robots[0].motion.pose = Pose::new(1.0, 2.0, 0.5);
        let edge = vocabulary::EdgeState { set_point: [2.0, 2.5], ..vocabulary::EdgeState::default() };
        let snapshot = Snapshot { robots, ..Snapshot::default() };
        let record = StepRecord { snapshot, edges: vec![edge], ..StepRecord::default() };
        assert_eq!(free_places(&fleet, &record, 0), None);
        let goal = set_points(&fleet, &record)[0].expect("a set point");
        let away = |[x, y]: [f64; 2], [u, v]: [f64; 2]| vocabulary::math::hypot(x - u, y - v);
        fleet.free = vec![[false, true]];
        let circle = free_places(&fleet, &record, 0).expect("a circle");
        assert!(circle.iter().all(|place| (away(*place, [1.0, 2.0]) - 2.0).abs() < 1e-12));
        assert!(away(circle[circle.len() / 2], goal) < 1e-12, "the follower is in its middle");
        assert!(away(circle[0], circle[circle.len() - 1]) < 1e-12, "it is closed");
        fleet.free = vec![[true, false]];
        let ray = free_places(&fleet, &record, 0).expect("a ray");
        assert_eq!((ray[0], ray.len()), ([1.0, 2.0], circle.len()));
        let end = ray[ray.len() - 1];
        assert!((away(end, goal) - 1.0).abs() < 1e-12 && (away(end, [1.0, 2.0]) - 3.0).abs() < 1e-12);
    }

    #[test]
    fn contacts_are_remembered_once_and_not_for_ever() {
        let mut trail = Trail::new(&FleetInfo::default());
        let contact = |number: u64, begin: f64| Contact {
            number,
            things: [vocabulary::EntityId::Robot(0), vocabulary::EntityId::Ground],
            begin,
            end: begin,
            open: true,
            place: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
            impulse: 0.0,
        };
        for k in 0..2_000_u64 {
            let contacts = vec![contact(k, k as f64), contact(k / 2, k as f64)];
            let snapshot = Snapshot { time: k as f64, ..Snapshot::default() };
            trail.push(&StepRecord { snapshot, contacts, ..StepRecord::default() });
        }
        assert_eq!(trail.touches.len(), TOUCHES);
        assert!(trail.touches.iter().all(|t| t.begin == t.number as f64));
    }

    #[test]
    fn only_sideways_is_a_slide() {
        let pose = |x, y, heading| Pose::new(x, y, heading);
        assert_eq!(slid(&pose(0.0, 0.0, 0.0), &pose(0.1, 0.0, 0.0)), 0.0);
        assert_eq!(slid(&pose(0.0, 0.0, 0.0), &pose(-0.1, 0.0, 0.0)), 0.0);
        assert_eq!(slid(&pose(0.0, 0.0, 3.1), &pose(-0.1, 0.0, -3.1)), 0.0);
        assert!(slid(&pose(0.0, 0.0, 0.0), &pose(0.1, 0.01, 0.0)) > 0.1);
        assert_eq!(slid(&pose(0.0, 0.0, 0.0), &pose(0.0, 0.1, 0.0)), 1.0);
    }
}
