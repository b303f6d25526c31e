//! From pictures to poses.

mod synthetic;

use perception::detect::{Detector, Locus, Tag, recognise};
use synthetic::{Scenes, sensor};
use vocabulary::{Grey, Region};

/// The library's conventions are ours: pixel (0, 0) has its middle at (0, 0), corners go clockwise from the top left.
#[test]
fn corners_are_where_they_should_be_and_in_order() {
    let mut views = Scenes::seeded(1);
    let mut sensor = sensor(views.lens);
    let mut detector = Locus::new();
    let (mut sum, mut n, mut tags) = ([0.0; 2], 0.0, vec![]);
    for frame in 0..12 {
        let scene = views.next(2.0);
        let picture = scene.picture(&mut sensor, Region::whole(&views.lens), frame);
        detector.detect(&picture, &mut tags);
        for tag in &tags {
            let face = scene.rig.shell.face_of(tag.id).expect("a tag of the shell");
            let truth = scene.corners(face).expect("in front");
            for (got, want) in tag.corners.iter().zip(truth) {
                let off = [got[0] - want[0], got[1] - want[1]];
                assert!(off[0].hypot(off[1]) < 0.7, "{tag:?} {truth:?}");
                sum = [sum[0] + off[0], sum[1] + off[1]];
                n += 1.0;
            }
        }
    }
    assert!(n >= 60.0 && sum.iter().all(|s| (s / n).abs() < 0.03), "{n} {sum:?}");
}
