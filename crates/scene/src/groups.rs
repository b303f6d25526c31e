//! Groups become robots.

use crate::{
    Channel, Follow, Law, Robot, Role, Vehicle,
    document::{Follows, GroupKeys, MOST_ROBOTS},
    graph::{Named, check_known},
    robots::{Defaults, Draft, check_distance, check_path, start_pose, start_speed},
    text::{Found, Node, Part, Reading},
};
use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};
use vocabulary::{Pose, wrap};

/// Appends the robots of `group`; `None` after a note.
pub(crate) fn expand(
    group: &Group<'_>,
    seed: u64,
    defaults: &Defaults,
    drafts: &mut Vec<Draft>,
    reading: &mut Reading,
) -> Option<()> {
    let keys = group.keys;
    let count = group.count(drafts.len(), reading)?;
    let vehicle = defaults.vehicle(keys.vehicle.as_ref(), group.node.place, reading);
    let speed = start_speed(keys.speed.as_ref(), &vehicle, reading);
    let law = keys.law.as_ref()?.value.complete_with(&defaults.law, Law::fitting(vehicle.kind));
    let observer = defaults.observer(&keys.observer.as_ref()?.value, &vehicle);
    let sensing = defaults.sensing(&keys.sensing.as_ref()?.value);
    let spacing = keys.distance.as_ref()?;
    check_distance(spacing.value, law.distance_min, spacing.place, reading);
    let (leader, origin) = group.leader(&vehicle, drafts, reading)?;
    let mut scatter = Scatter::new(keys, group.index, seed)?;
    for (place, spot) in group.spots(count)?.into_iter().enumerate().skip(1) {
        let followed = if spot.follows == 0 { leader.clone() } else { group.name(spot.follows) };
        let role = Role::Follow(Box::new(Follow {
            leader: followed,
            speed,
            distance: Channel::Constant(spot.distance),
            bearing: Channel::Constant(spot.bearing),
            law,
            observer,
            sensing,
        }));
        let pose = scatter.around(origin, spot.at);
        group.push(Robot { name: group.name(place), pose, number: 0, vehicle, role }, drafts);
    }
    Some(())
}

/// A place in a group.
struct Spot {
    /// [forward, left] of the group's leader, m.
    at: [f64; 2],
    /// Place that is followed.
    follows: usize,
    /// Distance from there, m.
    distance: f64,
    /// Bearing from there, rad.
    bearing: f64,
}

/// A group as it is written, and where.
pub(crate) struct Group<'a> {
    pub(crate) keys: &'a GroupKeys,
    pub(crate) node: &'a Node,
    pub(crate) index: u64,
}

impl Group<'_> {
    /// Number of places, if the shape and the scene, which has `before` robots already, can take them.
    fn count(&self, before: usize, reading: &mut Reading) -> Option<usize> {
        let (shape, count) = (self.keys.shape.as_ref()?.value, self.keys.count.as_ref()?);
        let crowd = || format!("this makes more than {MOST_ROBOTS} robots");
        let fault = shape.refuses(count.value).or_else(|| (before + count.value > MOST_ROBOTS).then(crowd));
        if let Some(fault) = fault {
            reading.note(count.place, fault);
            return None;
        }
        Some(count.value)
    }

    /// All places; the first is the leader's.
    fn spots(&self, count: usize) -> Option<Vec<Spot>> {
        let keys = self.keys;
        let (shape, follows) = (keys.shape.as_ref()?.value, keys.follows.as_ref()?.value);
        let (spacing, angle) = (keys.distance.as_ref()?.value, keys.angle.as_ref()?.value);
        let mut spots = vec![Spot { at: [0.0; 2], follows: 0, distance: 0.0, bearing: 0.0 }];
        for place in 1..count {
            let step = shape.step(place, count, angle);
            let [x, y] = spots.get(step.leader)?.at;
            let (sin, cos) = step.bearing.sin_cos();
            let [x, y] = [x + spacing * cos, y + spacing * sin];
            let (follows, distance, bearing) = match follows {
                Follows::Neighbour => (step.leader, spacing, step.bearing),
                Follows::Leader => (0, x.hypot(y), wrap(y.atan2(x))),
            };
            spots.push(Spot { at: [x, y], follows, distance, bearing });
        }
        Some(spots)
    }

    /// Name of the robot in `place`, counted from 0.
    fn name(&self, place: usize) -> String {
        format!("{}-{}", self.keys.name.as_ref().map_or("robot", |name| &name.value), place + 1)
    }

    fn push(&self, robot: Robot, drafts: &mut Vec<Draft>) {
        let place = self.keys.name.as_ref().map_or(self.node.place, |name| name.place);
        let name = Some(Found { place, value: robot.name.clone() });
        // Leaders inside the group exist, and the one outside has been looked up.
        drafts.push(Draft { named: Named { name, leader: None }, number: None, robot: Some(robot) });
    }

    /// Name and start pose of the robot in place 1, which is made if it is the group's own.
    fn leader(
        &self,
        vehicle: &Vehicle,
        drafts: &mut Vec<Draft>,
        reading: &mut Reading,
    ) -> Option<(String, Pose)> {
        let keys = self.keys;
        match (self.node.get("path"), self.node.get("leader")) {
            (Some(_), None) => {
                let path = keys.path.as_ref()?;
                check_path(path, vehicle, reading);
                let origin = Found { place: self.node.place, value: [0.0; 3] };
                let given = keys.pose.as_ref().or(path.value.start().is_none().then_some(&origin));
                let pose = start_pose(given, Some(&path.value), self.node.place, reading)?;
                let name = self.name(0);
                let role = Role::Lead { path: path.value.clone() };
                self.push(Robot { name: name.clone(), pose, number: 0, vehicle: *vehicle, role }, drafts);
                Some((name, pose))
            }
            (None, Some(_)) => {
                if let Some(pose) = self.node.entry("pose") {
                    reading.note(
                        pose.place,
                        "`pose` is for groups with a `path`; this one starts at its leader",
                    );
                }
                let leader = keys.leader.as_ref()?;
                check_known(&leader.value, leader.place, drafts.iter().map(|draft| &draft.named), reading);
                let is_leader = |robot: &&Robot| robot.name == leader.value;
                let robot = drafts.iter().filter_map(|draft| draft.robot.as_ref()).find(is_leader)?;
                Some((leader.value.clone(), robot.pose))
            }
            _ => {
                reading
                    .note(self.node.place, "a group needs either a `path` for its own leader, or a `leader`");
                None
            }
        }
    }
}

/// Seeded disorder of start poses.
struct Scatter {
    random: ChaCha8Rng,
    /// m along each axis.
    distance: f64,
    /// rad.
    heading: f64,
}

impl Scatter {
    fn new(keys: &GroupKeys, index: u64, seed: u64) -> Option<Self> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(index);
        Some(Self {
            random,
            distance: keys.scatter.as_ref()?.value,
            heading: keys.scatter_heading.as_ref()?.value,
        })
    }

    /// A pose near [forward, left] in m as seen from `origin`.
    fn around(&mut self, origin: Pose, [forward, left]: [f64; 2]) -> Pose {
        let forward = forward + self.distance * self.next();
        let left = left + self.distance * self.next();
        let [x, y] = origin.world_from_body(forward, left);
        Pose::new(x, y, wrap(origin.heading + self.heading * self.next()))
    }

    /// Evenly distributed in [−1, 1).
    fn next(&mut self) -> f64 {
        let bits = self.random.next_u64() >> 11;
        bits as f64 / (1u64 << 52) as f64 - 1.0
    }
}
