//! Proximity sensors: what is within a range of a robot, all round, and how fast it moves.
//!
//! A sensor tells the middle of a robot and the nearest point of a prop, as seen from a point on the robot. By its own
//! odometry, which is taken as exact, the robot knows where these are on the ground; a high-gain observer with a double
//! pole at −1/ε estimates their velocities. What stands for good has none. Nothing hides anything.

use crate::imaging::{Purpose, noise_stream};
use crate::outline::Outline;
use vocabulary::{EntityId, Mobility, Placement, Prop, RobotInfo, Snapshot, Solid, math};

/// The sensor of one robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProximitySensor {
    /// m.
    pub range: f64,
    /// Between measurements, s; 0 for one at every control sample.
    pub interval: f64,
    /// Standard deviation of a distance, m.
    pub distance_noise: f64,
    /// Standard deviation of a direction, rad.
    pub bearing_noise: f64,
    /// ε of the observer of velocities, s.
    pub epsilon: f64,
}

/// Parameters of all proximity sensors.
#[derive(Debug, Clone)]
pub struct ProximityConfig {
    /// The sensor of every robot that has one.
    pub sensors: Vec<Option<ProximitySensor>>,
    /// What robots are, in the order of the snapshots.
    pub robots: Vec<RobotInfo>,
    /// What props are, in the order of the snapshots.
    pub props: Vec<Prop>,
    /// Seed of the noise.
    pub seed: u64,
}

/// State of one proximity sensor.
#[derive(Debug, Clone, Default)]
pub struct ProximityState {
    taken: u64,
    /// When the last measurement was, s; `None` before there was one.
    stamp: Option<f64>,
    /// Where it was, m.
    from: [f64; 2],
    /// Outlines of what it was of, as far as it was asked for them.
    outlines: Vec<Outline>,
    /// By what they are of.
    tracks: Vec<ProximityTrack>,
    spare: Vec<ProximityTrack>,
}

/// What is known of one thing.
#[derive(Debug, Clone, Copy)]
struct ProximityTrack {
    thing: EntityId,
    /// Last measurement, m.
    measured: [f64; 2],
    /// When that was, s.
    stamp: f64,
    /// Estimate of place and velocity at that time, m and m/s.
    place: [f64; 2],
    velocity: [f64; 2],
    /// Of the circle around it, m; 0 for a point of an outline.
    radius: f64,
    /// Whether the sensor is within its outline.
    inside: bool,
    /// Where it has been since when, s, within [`STAYS`].
    stays: ([f64; 2], f64),
}

/// Something that a robot senses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensed {
    /// A robot or prop.
    pub thing: EntityId,
    /// Unit vector from it to the sensor.
    pub normal: [f64; 2],
    /// From its outline, for a robot the circle around its body, to the sensor, m; below zero inside.
    pub distance: f64,
    /// Its velocity on the ground, m/s.
    pub velocity: [f64; 2],
}

/// Directions closer to each other than this, m, are none.
const NEAREST: f64 = 1e-9;
/// Instants closer together than this are one, s.
const INSTANT: f64 = 1e-9;

impl ProximityConfig {
    /// What `robot` senses from the place `from`, m, at `snapshot`; nothing where it has no sensor.
    pub fn sense(
        &self,
        state: &mut ProximityState,
        robot: usize,
        from: [f64; 2],
        snapshot: &Snapshot,
        out: &mut Vec<Sensed>,
    ) {
        out.clear();
        self.take(state, robot, from, snapshot, false);
        for track in &state.tracks {
            let age = snapshot.time - track.stamp;
            let at = [0, 1].map(|k| track.place[k] + age * track.velocity[k]);
            // A place that moves with the robot, such as the nearest of a wall, is told as measured.
            let at = if age > 0.0 { at } else { track.measured };
            let off = [from[0] - at[0], from[1] - at[1]];
            let gap = math::hypot(off[0], off[1]);
            let sign = if track.inside { -1.0 } else { 1.0 };
            let normal = if gap > NEAREST { off.map(|x| sign * x / gap) } else { [1.0, 0.0] };
            out.push(Sensed {
                thing: track.thing,
                normal,
                distance: sign * gap - track.radius,
                velocity: track.velocity,
            });
        }
    }

    /// Takes the measurement of `robot` that is due at `snapshot`, from the place `from`, m; `outlines` asks for more than
    /// the nearest points, see [`ProximityState::is_free`].
    pub fn take(
        &self,
        state: &mut ProximityState,
        robot: usize,
        from: [f64; 2],
        snapshot: &Snapshot,
        outlines: bool,
    ) {
        let Some(sensor) = &self.sensors[robot] else { return };
        let due = snapshot.time + INSTANT >= state.taken as f64 * sensor.interval;
        if due && state.stamp != Some(snapshot.time) {
            (state.stamp, state.from) = (Some(snapshot.time), from);
            self.measure(sensor, state, robot, from, snapshot);
            state.outlines.clear();
            if outlines {
                self.outline(state, snapshot);
            }
        }
    }

    /// Notes the outlines of what has been measured.
    fn outline(&self, state: &mut ProximityState, snapshot: &Snapshot) {
        let ProximityState { tracks, outlines, from, .. } = state;
        outlines.extend(tracks.iter().map(|track| match track.thing {
            EntityId::Prop(index) => {
                let nearest = gap_to(&self.props[index].solid, &snapshot.props[index], *from, 0.0);
                let nearest =
                    nearest.map(|(normal, distance)| [0, 1].map(|k| from[k] - distance * normal[k]));
                Outline::prop(
                    track.thing,
                    &self.props[index].solid,
                    &snapshot.props[index],
                    [*from, nearest.unwrap_or(track.measured), track.measured],
                )
            }
            _ => Outline::robot(track.thing, track.measured, track.radius, track.stood(snapshot.time)),
        }));
    }

    fn measure(
        &self,
        sensor: &ProximitySensor,
        state: &mut ProximityState,
        robot: usize,
        from: [f64; 2],
        snapshot: &Snapshot,
    ) {
        let mut noise = noise_stream(self.seed, robot, state.taken, Purpose::Proximity);
        let mut before = state.tracks.iter().peekable();
        let next = &mut state.spare;
        next.clear();
        let mut note = |thing: EntityId, normal: [f64; 2], distance: f64, radius: f64, stands: bool| {
            if distance > sensor.range {
                return;
            }
            let (mut distance, mut normal) = (distance + radius, normal);
            if sensor.distance_noise > 0.0 || sensor.bearing_noise > 0.0 {
                distance += sensor.distance_noise * f64::from(noise.normal());
                let (sin, cos) = math::sin_cos(sensor.bearing_noise * f64::from(noise.normal()));
                normal = [cos * normal[0] - sin * normal[1], sin * normal[0] + cos * normal[1]];
            }
            let measured = [0, 1].map(|k| from[k] - distance * normal[k]);
            let mut track = ProximityTrack {
                thing,
                measured,
                stamp: snapshot.time,
                place: measured,
                velocity: [0.0; 2],
                radius,
                inside: distance < 0.0,
                stays: (measured, snapshot.time),
            };
            while let Some(last) = before.next_if(|last| last.thing <= thing) {
                if last.thing == thing && !stands {
                    track.follow(last, sensor.epsilon);
                    let (place, _) = last.stays;
                    if math::hypot(measured[0] - place[0], measured[1] - place[1]) < STAYS {
                        track.stays = last.stays;
                    }
                }
            }
            next.push(track);
        };
        for (index, (other, info)) in snapshot.robots.iter().zip(&self.robots).enumerate() {
            let body = &info.body;
            let at = other.motion.pose.world_from_body(0.5 * body.wheelbase, 0.0);
            let off = [from[0] - at[0], from[1] - at[1]];
            let radius = body.radius();
            // Most are far away.
            if index == robot
                || !other.is_present()
                || off[0].abs() > sensor.range + radius
                || off[1].abs() > sensor.range + radius
            {
                continue;
            }
            let gap = math::hypot(off[0], off[1]);
            let normal = if gap > NEAREST { off.map(|x| x / gap) } else { [1.0, 0.0] };
            note(EntityId::Robot(index), normal, gap - radius, radius, false);
        }
        let body = &self.robots[robot].body;
        let middle = snapshot.robots[robot].attitude.height + 0.5 * body.height;
        for (index, (placement, prop)) in snapshot.props.iter().zip(&self.props).enumerate() {
            if let Some((normal, distance)) = gap_to(&prop.solid, placement, from, middle) {
                let stands = prop.mobility == Mobility::Fixed;
                note(EntityId::Prop(index), normal, distance, 0.0, stands);
            }
        }
        state.taken += 1;
        std::mem::swap(&mut state.tracks, &mut state.spare);
    }
}

/// Who stays within this, m, does not go on.
const STAYS: f64 = 0.1;

impl ProximityState {
    /// Whether a circle of `radius` m around `place`, m, is free of what was sensed at the last measurement: the outlines of
    /// props as far as they are within the sensor's `range`, m, and robots that have stood for a second, but `leader`. What is
    /// beyond that is not known, and counts as free.
    pub fn is_free(&self, place: [f64; 2], radius: f64, range: f64, leader: usize) -> bool {
        let near = |outline: &&Outline| outline.thing != EntityId::Robot(leader);
        self.outlines.iter().filter(near).all(|outline| outline.leaves(place, radius, self.from, range))
    }
}

impl ProximityTrack {
    /// For how long it has not gone on, s.
    fn stood(&self, time: f64) -> f64 {
        time - self.stays.1
    }

    /// Carries the estimate of `last` on to this measurement: exact for a place that moved evenly in between.
    fn follow(&mut self, last: &Self, epsilon: f64) {
        let time = self.stamp - last.stamp;
        if time <= 0.0 {
            (self.place, self.velocity) = (last.place, last.velocity);
            return;
        }
        let (decay, t) = (math::exp(-time / epsilon), time);
        for k in 0..2 {
            let slope = (self.measured[k] - last.measured[k]) / t;
            let [z1, z2] = [last.place[k] - last.measured[k], last.velocity[k] - slope];
            self.place[k] = self.measured[k] + decay * (z1 + t * (z2 - z1 / epsilon));
            self.velocity[k] = slope + decay * (z2 + t * (z2 / epsilon - z1 / (epsilon * epsilon)));
        }
    }
}

/// Tilted further than this (cosine), a solid is taken for a ball.
const UPRIGHT: f64 = 0.99;

/// The unit vector from a solid's outline on the ground to `from`, and the distance in m, below zero inside; `None` for what
/// is driven over: ramps, and what is lower than `middle` in m.
pub fn gap_to(solid: &Solid, placement: &Placement, from: [f64; 2], middle: f64) -> Option<([f64; 2], f64)> {
    let [x, y, z] = placement.position;
    let [length, width, height] = solid.extent();
    if matches!(solid, Solid::Wedge { .. }) || z + height < middle {
        return None;
    }
    let off = [from[0] - x, from[1] - y];
    let round = |radius: f64| {
        let gap = math::hypot(off[0], off[1]);
        let normal = if gap > NEAREST { off.map(|x| x / gap) } else { [1.0, 0.0] };
        (normal, gap - radius)
    };
    let [qx, qy, qz, qw] = placement.rotation;
    let upright = 1.0 - 2.0 * (qx * qx + qy * qy) > UPRIGHT;
    Some(match *solid {
        _ if !upright => round(0.5 * math::hypot(math::hypot(length, width), 2.0 * height)),
        Solid::Cylinder { radius, .. } | Solid::Cone { radius, .. } => round(radius),
        Solid::Block { .. } | Solid::Wedge { .. } => {
            let (sin, cos) = math::sin_cos(2.0 * math::atan2(qz, qw));
            let own = [cos * off[0] + sin * off[1], cos * off[1] - sin * off[0]];
            let (normal, distance) = from_rectangle([0.5 * length, 0.5 * width], own);
            ([cos * normal[0] - sin * normal[1], sin * normal[0] + cos * normal[1]], distance)
        }
    })
}

/// The unit vector from a rectangle of these half sides around the origin to a point, and the distance, below zero inside.
fn from_rectangle(half: [f64; 2], point: [f64; 2]) -> ([f64; 2], f64) {
    let beyond = [0, 1].map(|k| point[k].abs() - half[k]);
    let sign = point.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
    if beyond.iter().all(|x| *x <= 0.0) {
        let k = usize::from(beyond[1] > beyond[0]);
        let mut normal = [0.0; 2];
        normal[k] = sign[k];
        return (normal, beyond[k]);
    }
    let off = [0, 1].map(|k| sign[k] * beyond[k].max(0.0));
    let gap = math::hypot(off[0], off[1]);
    (off.map(|x| x / gap), gap)
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Body, Pose, RobotState};

    fn sensor() -> ProximitySensor {
        ProximitySensor { range: 4.0, interval: 0.0, distance_noise: 0.0, bearing_noise: 0.0, epsilon: 0.02 }
    }

    fn config(sensor: ProximitySensor, props: Vec<Prop>) -> ProximityConfig {
        let robots = ["a", "b"].map(|name| RobotInfo::new(name, false, Body::default())).to_vec();
        ProximityConfig { sensors: vec![Some(sensor), None], robots, props, seed: 3 }
    }

    /// One robot at the origin, another where its middle is at a place.
    fn snapshot(time: f64, [x, y]: [f64; 2], props: Vec<Placement>) -> Snapshot {
        let mut robots = vec![RobotState::default(); 2];
        robots[1].motion.pose = Pose::new(x - 0.5 * Body::default().wheelbase, y, 0.0);
        Snapshot { time, robots, props }
    }

    #[test]
    fn a_velocity_is_found_within_a_few_time_constants() {
        let config = config(sensor(), vec![]);
        let (mut state, mut out) = (ProximityState::default(), vec![]);
        for k in 0..40 {
            let t = f64::from(k) * 0.01;
            config.sense(&mut state, 0, [0.0; 2], &snapshot(t, [3.0 - 0.8 * t, 0.3 * t], vec![]), &mut out);
        }
        let [vx, vy] = out[0].velocity;
        assert!((vx + 0.8).abs() < 1e-5 && (vy - 0.3).abs() < 1e-5, "{vx} {vy}");
        let [x, y] = [3.0 - 0.8 * 0.39, 0.3 * 0.39];
        assert!((out[0].distance - (math::hypot(x, y) - Body::default().radius())).abs() < 1e-12);
        assert!((out[0].normal[0] + x / math::hypot(x, y)).abs() < 1e-12);
    }

    /// The observer's step against its equations, integrated in small steps.
    #[test]
    fn the_observer_is_exact_for_even_motion() {
        let (epsilon, time) = (0.05, 0.03);
        let place = |t: f64| [1.0 + 2.0 * t, -0.5 * t];
        let last = ProximityTrack {
            thing: EntityId::Robot(1),
            measured: place(0.0),
            stamp: 0.0,
            place: [1.1, 0.2],
            velocity: [0.5, -1.0],
            radius: 0.0,
            inside: false,
            stays: (place(0.0), 0.0),
        };
        let mut next = ProximityTrack { measured: place(time), stamp: time, ..last };
        next.follow(&last, epsilon);
        let (mut x, mut v, steps) = (last.place, last.velocity, 300_000);
        let h = time / f64::from(steps);
        for k in 0..steps {
            let y = place((f64::from(k) + 0.5) * h);
            for i in 0..2 {
                let miss = y[i] - x[i];
                x[i] += h * (v[i] + 2.0 / epsilon * miss);
                v[i] += h * miss / (epsilon * epsilon);
            }
        }
        for i in 0..2 {
            assert!((next.place[i] - x[i]).abs() < 1e-5 && (next.velocity[i] - v[i]).abs() < 1e-3);
        }
    }

    #[test]
    fn what_is_beyond_the_range_is_not_sensed_and_noise_depends_on_the_seed() {
        let noisy = ProximitySensor { distance_noise: 0.1, bearing_noise: 0.01, ..sensor() };
        let sensed = |config: &ProximityConfig, at: [f64; 2]| {
            let (mut state, mut out) = (ProximityState::default(), vec![]);
            config.sense(&mut state, 0, [0.0; 2], &snapshot(0.0, at, vec![]), &mut out);
            out
        };
        assert!(sensed(&config(sensor(), vec![]), [4.3, 0.0]).is_empty());
        assert_eq!(sensed(&config(sensor(), vec![]), [4.1, 0.0]).len(), 1);
        let one = sensed(&config(noisy, vec![]), [3.0, 0.0])[0].distance;
        assert_eq!(one, sensed(&config(noisy, vec![]), [3.0, 0.0])[0].distance);
        let other = ProximityConfig { seed: 4, ..config(noisy, vec![]) };
        assert_ne!(one, sensed(&other, [3.0, 0.0])[0].distance);
    }

    #[test]
    fn props_are_sensed_by_their_nearest_points_and_ramps_are_not() {
        let prop = |solid: Solid| Prop { solid, mobility: Mobility::Fixed, ..Prop::default() };
        let solids = [
            Solid::Block { size: [2.0, 1.0, 0.5] },
            Solid::Cylinder { radius: 0.3, height: 1.0 },
            Solid::Wedge { size: [1.0, 1.0, 0.5] },
            Solid::Block { size: [2.0, 1.0, 0.05] },
        ];
        let config = config(sensor(), solids.map(prop).to_vec());
        let quarter = std::f64::consts::FRAC_PI_2;
        let places = [[2.0, 0.0, quarter], [0.0, -1.3, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let places = places.map(|[x, y, turn]| Placement::upright(Pose::new(x, y, turn), 0.0)).to_vec();
        let (mut state, mut out) = (ProximityState::default(), vec![]);
        config.sense(&mut state, 0, [0.0; 2], &snapshot(0.0, [-9.0, 0.0], places), &mut out);
        let found: Vec<_> =
            out.iter().map(|s| (s.thing, s.normal.map(|x| (x * 1e6).round()), s.distance)).collect();
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!((found[0].0, found[0].1), (EntityId::Prop(0), [-1e6, 0.0]));
        assert!((found[0].2 - 1.5).abs() < 1e-12 && (found[1].2 - 1.0).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn inside_a_wall_the_nearest_way_out_counts() {
        let (normal, distance) = from_rectangle([2.0, 1.0], [0.5, -0.8]);
        assert!(normal == [0.0, -1.0] && (distance + 0.2).abs() < 1e-12);
        assert_eq!(from_rectangle([2.0, 1.0], [-1.9, 0.2]).0, [-1.0, 0.0]);
        let (normal, distance) = from_rectangle([2.0, 1.0], [5.0, 5.0]);
        assert!((distance - 5.0).abs() < 1e-12 && (normal[0] - 0.6).abs() < 1e-12);
    }
}
