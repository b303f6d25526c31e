//! What a follower has measured of its leader.

use crate::{FACES, Region, Relative, words};

/// One measurement of a leader: what a sensor reports of one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measurement {
    /// The instant of the measurement, s from the start of the run.
    pub stamp: f64,
    /// Relative position as measured.
    pub relative: Relative,
    /// Standard deviations of distance, bearing and view angle as the sensor judges them itself, [m, rad, rad].
    pub deviation: [f64; 3],
}

words! {
    /// How well a follower knows where its leader is.
    pub enum TrackingState = Truth {
        /// It is told the truth at every instant.
        Truth = "truth",
        /// It has not seen its leader yet.
        Waiting = "waiting",
        /// It has seen its leader a moment ago.
        Tracking = "tracking",
        /// It has missed some measurements and goes by its prediction.
        Coasting = "coasting",
        /// It has not seen its leader for too long: it slows down and searches.
        Lost = "lost",
    }
}

words! {
    /// What came of one measurement.
    pub enum Outcome = Used {
        /// The estimate was corrected by it.
        Used = "used",
        /// It was too far from the prediction to be believed.
        Rejected = "rejected",
        /// Two poses explain it alike.
        Ambiguous = "ambiguous",
        /// The leader was not seen.
        Missed = "missed",
        /// The frame never arrived.
        Dropped = "dropped",
    }
}

impl Outcome {
    /// Whether the leader was recognised in it.
    pub fn seen(self) -> bool {
        matches!(self, Self::Used | Self::Rejected | Self::Ambiguous)
    }
}

/// One measurement of a leader as it goes into the record.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeasurementRecord {
    /// Index of the edge.
    pub edge: usize,
    /// The measurement; only its stamp counts where the leader was not recognised.
    pub measurement: Measurement,
    /// When it reached the follower, s from the start of the run.
    pub arrival: f64,
    /// What came of it.
    pub outcome: Outcome,
    /// Where the follower truly was at the stamp.
    pub truth: Relative,
    /// Corners of the tags seen, by face, pixels: top left, top right, bottom right, bottom left of the tag.
    pub tags: [Option<[[f64; 2]; 4]>; FACES],
    /// The part of the picture that was searched; empty for sensors without pictures.
    pub region: Region,
    /// Direction of the camera from the follower's heading at the stamp, rad.
    pub pan: f64,
}

impl MeasurementRecord {
    /// How many faces were seen.
    pub fn faces(&self) -> usize {
        self.tags.iter().flatten().count()
    }
}
