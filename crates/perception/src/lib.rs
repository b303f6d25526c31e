//! What each robot knows of its leader.
//!
//! [`observe`] is what is seen at an instant; [`tracks`] is what uninterrupted observation over the last step would
//! have seen, for observers that run in continuous time between control samples. Those two are the truth; what a camera
//! makes of it goes from [`imaging`] through [`detect`] to [`pose`]. [`sensors`] puts
//! all of it behind one interface: who measures when, and when the follower has the result.

pub mod detect;
pub mod imaging;
mod outline;
pub mod pose;
pub mod proximity;
pub mod sensors;

use vocabulary::{
    Edge, EdgeSample, HeadingReference, Motion, Observation, Relative, Snapshot, StepInterpolant,
    TRACK_NODES, Track, math, nearest_turn, wrap,
};

/// One observation per edge, of the truth.
pub fn observe(snapshot: &Snapshot, edges: &[Edge], observations: &mut Vec<Observation>) {
    observations.clear();
    let motions = |edge: &Edge| [edge.leader, edge.follower].map(|robot| &snapshot.robots[robot].motion);
    observations.extend(edges.iter().map(|edge| Observation::true_of(motions(edge))));
}

/// Stretches shorter than this, in s, are not worth a track of their own: a kink so close to an end of the step
/// changes no rate by more than 1e-9 of the jump.
const SHORTEST: f64 = 1e-6;

/// The last step as `edge` saw it, in smooth stretches handed to `visit` one after the other; its bearings are counted
/// from what `reference` says.
pub fn tracks(
    interpolant: &(impl StepInterpolant + ?Sized),
    edge: Edge,
    reference: HeadingReference,
    mut visit: impl FnMut(&Track),
) {
    let end = interpolant.duration();
    let [a, b] = [edge.leader, edge.follower].map(|k| interpolant.saturation_time(k).unwrap_or(end));
    let mut from = 0.0;
    for until in [a.min(b), a.max(b)] {
        if until - from > SHORTEST && end - until > SHORTEST {
            visit(&track(interpolant, edge, reference, [from, until]));
            from = until;
        }
    }
    visit(&track(interpolant, edge, reference, [from, end]));
}

/// The edge as seen at one instant of the last step. For a follower that holds its bearing against a path's heading it is the
/// direction of the line in the world, which it knows by its own heading.
pub fn sample(
    interpolant: &(impl StepInterpolant + ?Sized),
    edge: Edge,
    reference: HeadingReference,
    elapsed: f64,
) -> EdgeSample {
    first_sample(&motions(interpolant, edge, elapsed), reference)
}

/// Leader and follower at an instant of the last step.
fn motions(interpolant: &(impl StepInterpolant + ?Sized), edge: Edge, elapsed: f64) -> [Motion; 2] {
    [edge.leader, edge.follower].map(|robot| interpolant.during(robot, elapsed))
}

fn first_sample([leader, follower]: &[Motion; 2], reference: HeadingReference) -> EdgeSample {
    let mut relative = Relative::between(leader.pose, follower.pose);
    if reference == HeadingReference::Path {
        relative.bearing = wrap(relative.view_angle + follower.pose.heading);
    }
    sample_of(relative, follower)
}

fn sample_of(relative: Relative, follower: &Motion) -> EdgeSample {
    EdgeSample {
        relative,
        own_speed: follower.speed,
        acceleration: follower.acceleration,
        turn_rate: follower.turn_rate,
    }
}

fn track(
    interpolant: &(impl StepInterpolant + ?Sized),
    edge: Edge,
    reference: HeadingReference,
    [from, until]: [f64; 2],
) -> Track {
    let duration = until - from;
    let mut samples = [EdgeSample::default(); TRACK_NODES];
    let mut before = motions(interpolant, edge, from);
    samples[0] = first_sample(&before, reference);
    for (k, node) in Track::NODES.into_iter().enumerate().skip(1) {
        let now = motions(interpolant, edge, from + node * duration);
        let last = samples[k - 1].relative;
        samples[k] = if apart(&before) && apart(&now) {
            sample_of(turned(&last, [&before, &now], reference), &now[1])
        } else {
            // A line without length has no direction to count from.
            let mut sample = first_sample(&now, reference);
            sample.relative.bearing = nearest_turn(sample.relative.bearing, last.bearing);
            sample
        };
        before = now;
    }
    // A node on a kink belongs to the stretch it is sampled for: its acceleration is that of the middle.
    let middle = interpolant.during(edge.follower, from + duration / 2.0);
    for sample in &mut samples {
        sample.acceleration = middle.acceleration;
    }
    Track { duration, samples }
}

/// Whether leader and follower are not on one spot.
fn apart([leader, follower]: &[Motion; 2]) -> bool {
    [leader.pose.x, leader.pose.y] != [follower.pose.x, follower.pose.y]
}

/// Where a follower is relative to its leader a little later than at `relative`: by how far the line between them and both robots
/// have turned, so that the bearing is continuous.
fn turned(relative: &Relative, [before, now]: [&[Motion; 2]; 2], reference: HeadingReference) -> Relative {
    let line =
        |[leader, follower]: &[Motion; 2]| [leader.pose.x - follower.pose.x, leader.pose.y - follower.pose.y];
    let ([x, y], turn) = (line(now), angle(line(before), line(now)));
    let own = |robot: usize| wrap(now[robot].pose.heading - before[robot].pose.heading);
    let frame = if reference == HeadingReference::Path { 0.0 } else { own(0) };
    Relative {
        distance: (x * x + y * y).sqrt(),
        bearing: relative.bearing + turn - frame,
        view_angle: wrap(relative.view_angle + turn - own(1)),
    }
}

/// The angle from one vector to another, rad; between neighbouring samples it is small nearly always.
fn angle(from: [f64; 2], to: [f64; 2]) -> f64 {
    let (across, along) = (from[0] * to[1] - from[1] * to[0], from[0] * to[0] + from[1] * to[1]);
    let slope = across / along;
    if along > 0.0 && slope.abs() < 1.0 / 64.0 {
        // The power series of the arc tangent; the next term is below 1e-19 of the first.
        let square = slope * slope;
        let rest = 1.0 / 3.0 - square * (1.0 / 5.0 - square * (1.0 / 7.0 - square * (1.0 / 9.0)));
        slope - slope * (square * rest)
    } else {
        math::atan2(across, along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vocabulary::{Pose, RobotState};

    /// A leader at rest at the origin; a follower on a circle around it, whose acceleration jumps at 4 ms.
    struct Circling;

    impl StepInterpolant for Circling {
        fn duration(&self) -> f64 {
            0.01
        }

        fn during(&self, robot: usize, elapsed: f64) -> Motion {
            if robot == 0 {
                return Motion::default();
            }
            // Half a turn less 2 ms: the bearing crosses the seam on the way.
            let angle = std::f64::consts::PI - 0.002 + elapsed;
            let pose = Pose::new(2.0 * math::cos(angle), 2.0 * math::sin(angle), angle);
            let acceleration = if elapsed <= 0.004 { 5.0 } else { 0.0 };
            Motion { pose, speed: 2.0, acceleration, turn_rate: 1.0 }
        }

        fn saturation_time(&self, robot: usize) -> Option<f64> {
            (robot == 1).then_some(0.004)
        }
    }

    /// The same, of a leader that drives and turns: its heading crosses the seam as well.
    struct Turning;

    impl StepInterpolant for Turning {
        fn duration(&self) -> f64 {
            Circling.duration()
        }

        fn during(&self, robot: usize, elapsed: f64) -> Motion {
            let pose = Pose::new(0.3 * elapsed, -elapsed, wrap(3.135 + 2.0 * elapsed));
            if robot == 0 { Motion { pose, ..Motion::default() } } else { Circling.during(1, elapsed) }
        }

        fn saturation_time(&self, robot: usize) -> Option<f64> {
            Circling.saturation_time(robot)
        }
    }

    /// A follower that is on its leader's spot for a while.
    struct Meeting;

    impl StepInterpolant for Meeting {
        fn duration(&self) -> f64 {
            1.0
        }

        fn during(&self, robot: usize, elapsed: f64) -> Motion {
            let x = if robot == 1 && elapsed < 0.5 { elapsed - 0.5 } else { 0.0 };
            let y = if robot == 1 && elapsed > 0.8 { elapsed - 0.8 } else { 0.0 };
            Motion { pose: Pose::new(x, y, 0.0), ..Motion::default() }
        }

        fn saturation_time(&self, _: usize) -> Option<f64> {
            None
        }
    }

    const EDGE: Edge = Edge { leader: 0, follower: 1 };

    /// Where the line has no length its direction begins anew.
    #[test]
    fn a_meeting_spoils_no_later_sample() {
        tracks(&Meeting, EDGE, HeadingReference::Leader, |track| {
            let last = track.samples[TRACK_NODES - 1].relative;
            let alone = sample(&Meeting, EDGE, HeadingReference::Leader, 1.0).relative;
            assert!((last.distance - 0.2).abs() < 1e-12);
            assert!(wrap(last.bearing - alone.bearing).abs() < 1e-12, "{last:?} {alone:?}");
        });
    }

    #[test]
    fn a_step_with_a_kink_is_seen_in_two_smooth_stretches() {
        let mut seen = vec![];
        tracks(&Circling, EDGE, HeadingReference::Leader, |track| seen.push(*track));
        assert_eq!(seen.len(), 2);
        assert!((seen[0].duration - 0.004).abs() < 1e-15 && (seen[1].duration - 0.006).abs() < 1e-15);
        assert!(seen[0].samples.iter().all(|s| s.acceleration == 5.0));
        assert!(seen[1].samples.iter().all(|s| s.acceleration == 0.0));
    }

    #[test]
    fn the_bearing_is_continuous_along_a_track_over_the_seam() {
        tracks(&Circling, EDGE, HeadingReference::Leader, |track| {
            for pair in track.samples.windows(2) {
                assert!((pair[1].relative.bearing - pair[0].relative.bearing).abs() < 0.01);
            }
        });
    }

    /// What is counted from one sample to the next is what each sample says by itself, whole turns aside.
    #[test]
    fn samples_of_a_track_are_those_of_their_instants() {
        for reference in [HeadingReference::Leader, HeadingReference::Path] {
            let mut from = 0.0_f64;
            tracks(&Turning, EDGE, reference, |track| {
                for (node, seen) in Track::NODES.iter().zip(&track.samples) {
                    let alone = sample(&Turning, EDGE, reference, from + node * track.duration);
                    let (ours, theirs) = (seen.relative, alone.relative);
                    assert!((ours.distance - theirs.distance).abs() < 1e-15);
                    assert!((ours.bearing - nearest_turn(theirs.bearing, ours.bearing)).abs() < 4e-15);
                    assert!((ours.view_angle - theirs.view_angle).abs() < 4e-15, "{ours:?} {theirs:?}");
                    assert_eq!((seen.own_speed, seen.turn_rate), (alone.own_speed, alone.turn_rate));
                }
                from += track.duration;
            });
        }
    }

    proptest! {
        #[test]
        fn the_angle_between_vectors_is_their_arc_tangent(r in 0.1..50.0_f64, s in 0.1..50.0_f64, a in -3.1..3.1_f64, small in -0.03..0.03_f64, any in -3.1..3.1_f64) {
            for turn in [small, any] {
                let (from, to) = (math::sin_cos(a), math::sin_cos(a + turn));
                let found = angle([r * from.1, r * from.0], [s * to.1, s * to.0]);
                prop_assert!((found - turn).abs() < 2e-15, "{found} {turn}");
            }
        }
    }

    #[test]
    fn one_observation_per_edge() {
        let mut robots = [RobotState::default(); 2];
        robots[0].motion.speed = 1.5;
        robots[1].motion.pose = Pose::new(-2.0, 0.0, 0.0);
        let snapshot = Snapshot { time: 0.0, robots: robots.to_vec(), props: vec![] };
        let mut observations = vec![];
        observe(&snapshot, &[EDGE], &mut observations);
        assert_eq!(observations.len(), 1);
        assert_eq!(observations[0].relative.distance, 2.0);
        assert_eq!(observations[0].leader_speed, Some(1.5));
    }
}
