//! From pictures to poses.

mod synthetic;

use perception::detect::{Detector, Locus, Tag, recognise, sharpen};
use perception::imaging::{ImageSensor, Optics, Purpose, noise_stream};
use perception::pose::{Prior, locate};
use synthetic::{Scenes, sensor};
use vocabulary::math;
use vocabulary::{CameraModel, FACES, Grey, Region, wrap};

/// The library's conventions are ours: pixel (0, 0) has its middle at (0, 0), corners go clockwise from the top left.
#[test]
fn corners_are_where_they_should_be_and_in_order() {
    let mut views = Scenes::seeded(1);
    let mut sensor = sensor(views.camera_model);
    let mut detector = Locus::new();
    let (mut sum, mut n, mut tags) = ([0.0; 2], 0.0, vec![]);
    for frame in 0..12 {
        let scene = views.next(2.0);
        let picture = scene.picture(&mut sensor, Region::whole(&views.camera_model), frame);
        detector.detect(&picture, &mut tags);
        for tag in &tags {
            let face = scene.rig.shell.face_of(tag.id).expect("a tag of the shell");
            let truth = scene.corners(face).expect("in front");
            for (got, want) in tag.corners.iter().zip(truth) {
                let off = [got[0] - want[0], got[1] - want[1]];
                assert!(math::hypot(off[0], off[1]) < 0.7, "{tag:?} {truth:?}");
                sum = [sum[0] + off[0], sum[1] + off[1]];
                n += 1.0;
            }
        }
    }
    assert!(n >= 60.0 && sum.iter().all(|s| (s / n).abs() < 0.03), "{n} {sum:?}");
}

/// Root of the mean square error of range (share), bearing and heading (rad) over scenes in which two faces are found,
/// and how many of those and of all there were.
fn errors(
    views: &mut Scenes,
    sensor: &mut ImageSensor,
    told: &Optics,
    distance: f64,
    scenes: u64,
) -> ([f64; 3], f64, usize) {
    let mut detector = Locus::new();
    let (mut squares, mut n, mut seen) = ([0.0; 3], 0.0, 0);
    for frame in 0..scenes {
        let scene = views.next(distance);
        let region = scene.region();
        let picture = scene.picture(sensor, region, frame);
        let faces = recognise(&mut detector, &picture, region, told, &scene.rig.shell, FACES);
        let Some(found) = locate(&scene.rig, &faces, 0.02, &Prior::default(), None) else { continue };
        seen += 1;
        let heading = wrap(found.pose.heading - scene.pose.heading);
        assert!(found.ambiguous || heading.abs() < 8_f64.to_radians(), "a flip: {found:?} {:?}", scene.pose);
        if faces.len() > 1 {
            let range = math::hypot(found.pose.x, found.pose.y) / distance - 1.0;
            let bearing =
                wrap(math::atan2(found.pose.y, found.pose.x) - math::atan2(scene.pose.y, scene.pose.x));
            for (sum, error) in squares.iter_mut().zip([range, bearing, heading]) {
                *sum += error * error;
            }
            n += 1.0;
        }
    }
    (squares.map(|s| (s / n).sqrt()), n, seen)
}

/// Range, bearing and heading of what perception.md wants if it can be had: per cent, degrees, degrees.
const STRETCH: [(f64, [f64; 3]); 3] =
    [(2.0, [0.03, 0.01, 0.06]), (3.0, [0.07, 0.01, 0.15]), (4.0, [0.12, 0.012, 0.25])];

fn assert_within(what: &str, errors: [f64; 3], limits: [f64; 3]) {
    let got = [100.0 * errors[0], errors[1].to_degrees(), errors[2].to_degrees()];
    assert!(got.iter().zip(limits).all(|(g, l)| *g < l), "{what}: {got:?} against {limits:?}");
}

#[test]
fn leaders_are_located_as_well_as_they_should_be() {
    for (distance, limits) in STRETCH {
        let mut views = Scenes::seeded(2);
        let mut sensor = sensor(views.camera_model);
        let told = *sensor.optics();
        let (errors, n, seen) = errors(&mut views, &mut sensor, &told, distance, 40);
        assert!(n >= 25.0 && seen >= 39, "{n} {seen}");
        assert_within("default camera", errors, limits);
    }
}

/// Neither a lens that distorts nor a blur and noise that are not what was said does much harm.
#[test]
fn other_cameras_do_as_well() {
    let distorting = CameraModel { distortion: [-0.28, 0.09, 1e-3, -7e-4, -0.01], ..CameraModel::default() };
    let usual = Optics::default();
    let cameras = [
        ("distorting", distorting, usual.blur, usual.noise),
        ("softer than told", CameraModel::default(), 1.1, usual.noise),
        ("sharper than told", CameraModel::default(), 0.3, usual.noise),
        ("noisier than told", CameraModel::default(), usual.blur, 2.0 * usual.noise),
    ];
    for (name, camera_model, blur, noise) in cameras {
        let mut views = Scenes::seeded(3);
        views.camera_model = camera_model;
        let mut sensor = ImageSensor::new(Optics { camera_model, blur, noise });
        let told = Optics { camera_model, ..usual };
        let (errors, n, _) = errors(&mut views, &mut sensor, &told, 3.0, 30);
        println!("{name}: {errors:?}");
        assert!(n >= 15.0);
        assert_within(name, errors, STRETCH[1].1);
    }
}

/// Results go into a run's digest: they must not depend on how many threads there are.
#[test]
fn tags_do_not_depend_on_the_number_of_threads() {
    let mut views = Scenes::seeded(4);
    let mut sensor = sensor(views.camera_model);
    let pictures: Vec<Grey> = (0..6)
        .map(|frame| views.next(2.5).picture(&mut sensor, Region::whole(&views.camera_model), frame))
        .collect();
    let found = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut detector = Locus::new();
            let mut tags = vec![];
            pictures
                .iter()
                .flat_map(|picture| {
                    detector.detect(picture, &mut tags);
                    tags.clone()
                })
                .collect::<Vec<Tag>>()
        })
    };
    let one = found(1);
    assert!(one.len() >= 10);
    for threads in [2, 3, 7] {
        assert_eq!(one, found(threads));
    }
    assert_eq!(one, found(1), "a second time");
}

/// A detector that has seen other pictures before finds the same.
#[test]
fn a_detector_remembers_nothing() {
    let mut views = Scenes::seeded(5);
    let mut sensor = sensor(views.camera_model);
    let pictures: Vec<Grey> = (0..4)
        .map(|frame| {
            let scene = views.next(1.5 + 0.7 * frame as f64);
            scene.picture(&mut sensor, scene.region(), frame)
        })
        .collect();
    let (mut used, mut tags, mut again) = (Locus::new(), vec![], vec![]);
    for picture in &pictures {
        used.detect(picture, &mut tags);
        assert!(!tags.is_empty(), "every picture shows a leader near enough to be read");
    }
    for picture in pictures.iter().rev() {
        used.detect(picture, &mut tags);
        Locus::new().detect(picture, &mut again);
        assert_eq!(tags, again);
    }
}

/// Tiny pictures, pictures that are none, noise, stripes: no tag and no panic.
#[test]
fn odd_pictures_hold_no_tags() {
    let mut detector = Locus::new();
    let mut tags = vec![];
    let mut random = noise_stream(9, 0, 0, Purpose::Pixels);
    for (width, height) in
        [(0, 0), (1, 1), (15, 200), (16, 16), (17, 23), (24, 300), (33, 16), (101, 67), (320, 240)]
    {
        for kind in 0..4 {
            let value = |k: u32| match kind {
                0 => 0,
                1 => (random.uniform() * 256.0) as u8,
                2 => {
                    if ((k % width.max(1)) / 3).is_multiple_of(2) {
                        255
                    } else {
                        0
                    }
                }
                _ => {
                    if k.is_multiple_of(7) {
                        255
                    } else {
                        30
                    }
                }
            };
            let picture = Grey { width, height, values: (0..width * height).map(value).collect() };
            detector.detect(&picture, &mut tags);
            assert!(tags.is_empty(), "{width} {height} {kind}: {tags:?}");
        }
    }
    detector.detect(&Grey { width: 40, height: 40, values: vec![0; 7] }, &mut tags);
    assert!(tags.is_empty());
}

proptest::proptest! {
    /// Corners from anywhere: those that nothing fits stay where they are, and nothing panics.
    #[test]
    fn sharpening_survives_any_corners(
        numbers in proptest::array::uniform8(proptest::prelude::prop_oneof![-50.0..250.0_f64, proptest::num::f64::ANY]),
        id in 0_u16..700,
        blur in proptest::num::f64::ANY,
        distortion in proptest::array::uniform5(-2.0..2.0_f64),
    ) {
        let mut random = noise_stream(10, 0, 0, Purpose::Pixels);
        let values = (0..120 * 90).map(|_| (random.uniform() * 256.0) as u8).collect();
        let picture = Grey { width: 120, height: 90, values };
        let corners = [0, 1, 2, 3].map(|k| [numbers[2 * k], numbers[2 * k + 1]]);
        let mut tags = [Tag { id, corners, deviation: 0.0 }];
        let optics = Optics { camera_model: CameraModel { distortion, ..CameraModel::default() }, blur, noise: 0.0 };
        sharpen(&picture, Region { x: 30, y: 20, width: 120, height: 90 }, &optics, &mut tags);
        let was_finite = corners.iter().flatten().all(|x| x.is_finite());
        assert!(!was_finite || tags[0].corners.iter().flatten().all(|x| x.is_finite()));
    }
}
