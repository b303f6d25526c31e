//! What is hidden from whom, for those who know the truth.

use super::{Exposure, SensorConfig, sightline};
use vocabulary::Snapshot;

impl SensorConfig {
    /// Whether anything hides the point `to` on the robot `watched` from the point `from` on the robot `watcher`, both
    /// in the world's frame, m; those two robots themselves do not count.
    pub fn hides(
        &self,
        snapshot: &Snapshot,
        [watcher, watched]: [usize; 2],
        from: [f64; 3],
        to: [f64; 3],
    ) -> bool {
        let exposure = Exposure {
            edge: 0,
            leader: watched,
            follower: watcher,
            number: 0,
            snapshot,
            expected: None,
            seen: false,
            pan_rate: 0.0,
        };
        sightline::hidden(self, &exposure, from, to)
    }
}
