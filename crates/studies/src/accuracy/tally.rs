//! What came of many pictures, by distance.

use crate::accuracy::poses::BINS;
use metrics::RootMeanSquare;

/// A heading that is off by more, rad, is a flip.
const FLIP: f64 = 8.0 * std::f64::consts::PI / 180.0;

/// Errors of one pose: range (share of the range), bearing, heading (rad).
pub(super) type Errors = [f64; 3];

/// What came of one pose of the leader.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PoseSample {
    /// m.
    pub distance: f64,
    /// Faces that should be read.
    pub readable: usize,
    /// Faces that were, in the part of the picture that a camera looks at which tracks the leader.
    pub seen: usize,
    /// And in the whole picture.
    pub seen_whole: usize,
    /// Ids found that are not there, in both together.
    pub wrong: usize,
    /// Faces whose corners are not where they should be, in both together.
    pub strayed: usize,
    /// Errors of the pose found, refined: range as a share of the range, bearing and heading in rad.
    pub refined: Option<[f64; 3]>,
    /// Whether another pose explains the picture as well, so that this one is not relied on.
    pub ambiguous: bool,
    /// The same of what POSIT alone found.
    pub raw: Option<[f64; 3]>,
}

/// Range in percent, bearing and heading in degrees, of root mean square errors; `None` of nothing.
pub fn readable_rms(errors: &RootMeanSquare<3>) -> Option<[f64; 3]> {
    errors.root().map(|[range, bearing, heading]| [100.0 * range, bearing.to_degrees(), heading.to_degrees()])
}

/// All samples of one bin of distances.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AccuracyBin {
    /// Poses tried.
    pub poses: u32,
    /// Views in which a face, and two faces, should be read.
    pub views: [u32; 2],
    /// In how many of these so many were, in the part that is tracked.
    pub seen: [u32; 2],
    /// And in the whole picture.
    pub seen_whole: [u32; 2],
    /// Ids found that are not there.
    pub wrong: usize,
    /// Faces whose corners are not where they should be.
    pub strayed: usize,
    /// Poses that were relied on and flipped.
    pub flips: u32,
    /// Poses that were not relied on.
    pub ambiguous: u32,
    /// Two faces and more.
    pub refined: RootMeanSquare<3>,
    /// Two faces and more, POSIT alone.
    pub raw: RootMeanSquare<3>,
    /// One face, unless ambiguous.
    pub single: RootMeanSquare<3>,
}

impl AccuracyBin {
    /// Takes in a sample.
    pub fn add(&mut self, sample: &PoseSample) {
        self.poses += 1;
        self.wrong += sample.wrong;
        self.strayed += sample.strayed;
        for (k, least) in [1, 2].into_iter().enumerate() {
            if sample.readable >= least {
                self.views[k] += 1;
                self.seen[k] += u32::from(sample.seen >= least);
                self.seen_whole[k] += u32::from(sample.seen_whole >= least);
            }
        }
        let Some(errors) = &sample.refined else { return };
        self.ambiguous += u32::from(sample.ambiguous);
        self.flips += u32::from(!sample.ambiguous && errors[2].abs() > FLIP);
        match sample.seen {
            0 => {}
            1 if sample.ambiguous => {}
            1 => self.single.add(*errors),
            _ => {
                self.refined.add(*errors);
                if let Some(raw) = &sample.raw {
                    self.raw.add(*raw);
                }
            }
        }
    }
}

/// The bin of a distance.
pub(super) fn bin_of(distance: f64) -> usize {
    let last = BINS.len() - 1;
    BINS.iter().position(|[_, high]| distance < *high).unwrap_or(last)
}

/// What has to be reached, and what should be, in a bin: range in percent, bearing and heading in degrees.
pub fn targets(bin: usize) -> Option<[[f64; 3]; 2]> {
    match bin {
        0 | 1 => Some([[0.1, 0.03, 0.2], [0.03, 0.01, 0.06]]),
        2 => Some([[0.15, 0.03, 0.4], [0.07, 0.01, 0.15]]),
        3 => Some([[0.25, 0.03, 0.5], [0.12, 0.012, 0.25]]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::math;

    #[test]
    fn samples_are_counted_where_they_belong() {
        let mut bin = AccuracyBin::default();
        let two = PoseSample {
            readable: 2,
            seen: 2,
            seen_whole: 1,
            refined: Some([0.003, 0.0, 0.2]),
            raw: Some([0.004, 0.0, 0.0]),
            ..PoseSample::default()
        };
        bin.add(&two);
        bin.add(&PoseSample { refined: Some([0.004, 0.0, 0.0]), ..two });
        bin.add(&PoseSample { readable: 1, seen: 1, seen_whole: 1, ..two });
        bin.add(&PoseSample { readable: 1, seen: 1, ambiguous: true, ..two });
        bin.add(&PoseSample { readable: 1, wrong: 1, ..PoseSample::default() });
        bin.add(&PoseSample::default());
        assert_eq!((bin.poses, bin.views, bin.seen), (6, [5, 2], [4, 2]));
        assert_eq!((bin.seen_whole, bin.wrong), ([4, 0], 1));
        assert_eq!((bin.flips, bin.ambiguous), (2, 1));
        assert_eq!((bin.refined.count(), bin.raw.count(), bin.single.count()), (2, 2, 1));
        let range = readable_rms(&bin.refined).expect("two")[0];
        assert!(
            (range - 100.0 * (0.5 * (math::powi(0.003_f64, 2) + math::powi(0.004_f64, 2))).sqrt()).abs()
                < 1e-12
        );
        assert_eq!(readable_rms(&RootMeanSquare::EMPTY), None);
    }

    #[test]
    fn bins_and_targets_go_together() {
        assert_eq!([0.5, 0.99, 1.0, 3.99, 4.0, 6.0, 9.0].map(bin_of), [0, 0, 1, 3, 4, 5, 5]);
        for bin in 0..BINS.len() {
            let Some([must, stretch]) = targets(bin) else { continue };
            assert!((0..3).all(|k| stretch[k] < must[k]));
        }
        assert!(targets(4).is_none());
    }
}
