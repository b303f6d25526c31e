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
    Edge, EdgeSample, HeadingReference, Observation, Relative, Snapshot, StepInterpolant, Track,
    nearest_turn, wrap,
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
    let mut kinks = [interpolant.saturation_time(edge.leader), interpolant.saturation_time(edge.follower)]
        .map(|k| k.unwrap_or(end));
    kinks.sort_by(f64::total_cmp);
    let mut from = 0.0;
    for until in kinks {
        if until - from > SHORTEST && end - until > SHORTEST {
            visit(&track(interpolant, edge, reference, [from, until]));
            from = until;
        }
    }
    visit(&track(interpolant, edge, reference, [from, end]));
}

/// The edge as seen at one instant of the last step; the bearing is the turn nearest to `near`. For a follower that holds
/// it against a path's heading it is the direction of the line in the world, which it knows by its own heading.
pub fn sample(
    interpolant: &(impl StepInterpolant + ?Sized),
    edge: Edge,
    reference: HeadingReference,
    elapsed: f64,
    near: Option<f64>,
) -> EdgeSample {
    let (leader, follower) =
        (interpolant.during(edge.leader, elapsed), interpolant.during(edge.follower, elapsed));
    let mut relative = Relative::between(leader.pose, follower.pose);
    if reference == HeadingReference::Path {
        relative.bearing = wrap(relative.view_angle + follower.pose.heading);
    }
    if let Some(near) = near {
        relative.bearing = nearest_turn(relative.bearing, near);
    }
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
    // A node on a kink belongs to the stretch it is sampled for: its acceleration is that of the middle.
    let middle = interpolant.during(edge.follower, from + duration / 2.0);
    let mut near = None;
    let samples = Track::NODES.map(|node| {
        let mut sample = sample(interpolant, edge, reference, from + node * duration, near);
        sample.acceleration = middle.acceleration;
        near = Some(sample.relative.bearing);
        sample
    });
    Track { duration, samples }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::math;
    use vocabulary::{Motion, Pose, RobotState};

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

    const EDGE: Edge = Edge { leader: 0, follower: 1 };

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
