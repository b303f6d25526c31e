//! What pictures show, by their properties, and a few of them as a whole.
//!
//! These need an adapter; `apt-get install mesa-vulkan-drivers` brings one that draws on the processor.

#[path = "stage/sight.rs"]
mod sight;
mod stage;

use rendering::{AdapterChoice, Error, Gpu, PictureSpec, Renderer, Style, ViewLayout, Viewpoint};
use stage::{Path, Play};
use std::sync::Arc;
use std::sync::OnceLock;
use vocabulary::math;
use vocabulary::{
    BarrierState, Constraint, Contact, EntityId, EventKind, EventRecord, Picture, PlannedPath, PlannedPoint,
    Pose, SafetyState, StepRecord,
};

const SIZE: (u32, u32) = (640, 360);

fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    let wanted = || AdapterChoice::from(std::env::var("ECHELON_ADAPTER").unwrap_or_default().as_str());
    GPU.get_or_init(|| Gpu::open(&wanted()).expect("tests of pictures need a graphics adapter"))
}

fn draw(play: &Play, view: Viewpoint, time: f64, style: &Style) -> Picture {
    let mut renderer = Renderer::new(gpu(), &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    renderer
        .draw(PictureSpec::new(&play.trail(time), &play.at(time), &ViewLayout::single(view), style))
        .unwrap()
}

/// Straight down on the x-y plane, 9 m high: pixels are easily computed.
fn plan() -> Viewpoint {
    Viewpoint::Fixed { eye: [6.0, 0.0, 9.0], target: [6.0, 0.0, 0.0], field_of_view: 0.6 }
}

/// The pixel of a point on the ground in [`plan`], whose picture has +x up and +y to the left.
fn pixel(x: f64, y: f64) -> (u32, u32) {
    let scale = 0.5 * f64::from(SIZE.1) / (math::tan(0.3_f64) * 9.0);
    let at = |middle: u32, shift: f64| (0.5 * f64::from(middle) - shift * scale).round() as u32;
    (at(SIZE.0, y), at(SIZE.1, x - 6.0))
}

fn hue([r, g, b]: [u8; 3]) -> [f64; 3] {
    let most = f64::from(r.max(g).max(b).max(1));
    [r, g, b].map(|c| f64::from(c) / most)
}

/// Pixels of a colour's kind around a place.
fn alike(picture: &Picture, (x, y): (u32, u32), reach: u32, wanted: [f64; 3]) -> usize {
    let near = |c: [u8; 3]| (0..3).all(|k| (hue(c)[k] - wanted[k]).abs() < 0.16) && c.iter().any(|v| *v > 90);
    let columns = x.saturating_sub(reach)..=x + reach;
    let rows = y.saturating_sub(reach)..=y + reach;
    columns
        .flat_map(|x| rows.clone().map(move |y| (x, y)))
        .filter_map(|(x, y)| picture.rgb(x, y))
        .filter(|c| near(*c))
        .count()
}

const ORANGE: [f64; 3] = [1.0, 0.69, 0.05];
const BLUE: [f64; 3] = [0.37, 0.78, 1.0];

#[test]
fn robots_stand_where_they_are_in_their_colours() {
    let play = Play::new(3, Path::Straight);
    let time = 12.0;
    let picture = draw(&play, plan(), time, &Style::bare());
    let record = play.at(time);
    for (robot, colour) in [(1, ORANGE), (2, BLUE)] {
        let pose = record.snapshot.robots[robot].motion.pose;
        let found = alike(&picture, pixel(pose.x + 0.05, pose.y), 8, colour);
        assert!(found > 25, "robot {robot}: {found}");
        assert!(alike(&picture, pixel(pose.x, -pose.y), 8, colour) < 5);
    }
    let lead = record.snapshot.robots[0].motion.pose;
    let (x, y) = pixel(lead.x + 0.24, lead.y + 0.06);
    let dark = picture.rgb(x, y).unwrap();
    assert!(dark.iter().all(|c| *c < 90), "{dark:?}");
}

#[test]
fn the_sky_is_above_and_the_ground_below() {
    let play = Play::new(3, Path::Straight);
    let picture = draw(&play, Viewpoint::Snake, 12.0, &Style::bare());
    for x in [5, 320, 634] {
        let [r, _, b] = picture.rgb(x, 4).unwrap();
        assert!(b > r && b > 190, "sky at {x}");
        let [r, g, b] = picture.rgb(x, 340).unwrap().map(i32::from);
        assert!((r - b).abs() < 40 && (60..200).contains(&g), "ground at {x}: {r} {g} {b}");
    }
}

#[test]
fn no_picture_is_black_or_clipped() {
    let play = Play::new(7, Path::named("eight"));
    let single = [
        Viewpoint::Snake,
        Viewpoint::SnakeEye,
        Viewpoint::Top,
        Viewpoint::Orbit,
        Viewpoint::Follow(3),
        plan(),
    ];
    let split = ViewLayout { views: single[..3].to_vec() };
    for view in single.into_iter().map(ViewLayout::single).chain([split]) {
        let mut renderer = Renderer::new(gpu(), &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
        let picture = renderer
            .draw(PictureSpec::new(&play.trail(9.0), &play.at(9.0), &view, &Style::default()))
            .unwrap();
        let pixels = picture.rgba.chunks_exact(4);
        let total = pixels.len();
        let dark = pixels.clone().filter(|p| p[..3].iter().all(|c| *c < 12)).count();
        let white = pixels.clone().filter(|p| p[..3].iter().all(|c| *c == 255)).count();
        assert!(dark * 50 < total && white * 100 < total, "{view:?}: {dark} dark, {white} white of {total}");
        assert!(pixels.clone().all(|p| p[3] == 255), "{view:?} is transparent");
    }
}

#[test]
fn a_ribbon_lies_behind_its_robot() {
    let play = Play::new(3, Path::Straight);
    let time = 12.0;
    let with = draw(&play, plan(), time, &Style::bare());
    let mut style = Style::bare();
    style.ribbons = true;
    let ribbons = draw(&play, plan(), time, &style);
    let pose = play.at(time).snapshot.robots[1].motion.pose;
    let behind = pixel(pose.x - 0.6, pose.y);
    assert!(alike(&ribbons, behind, 3, ORANGE) > 8);
    assert_eq!(alike(&with, behind, 3, ORANGE), 0);
}

fn touch(pose: Pose) -> Contact {
    Contact {
        number: 0,
        things: [EntityId::Robot(0), EntityId::Ground],
        begin: 1.95,
        end: 2.0,
        open: true,
        place: [pose.x, pose.y, 0.1],
        normal: [0.0, 0.0, 1.0],
        impulse: 0.0,
    }
}

#[test]
fn every_element_can_be_switched_off() {
    let play = Play::new(3, Path::Eight);
    let draw = |style: &Style| {
        let mut renderer = Renderer::new(gpu(), &play.fleet, 800, 600, 4).unwrap();
        let (mut trail, mut record) = (play.trail(1.9), play.at(2.0));
        record.contacts = vec![touch(record.snapshot.robots[0].motion.pose)];
        let barrier =
            BarrierState { constraint: Constraint::Robot(0), value: 0.2, slack: 0.0, direction: 1.0 };
        record.safety = vec![SafetyState { robot: 1, barriers: vec![barrier], ..SafetyState::default() }];
        record.events = vec![EventRecord::done(EventKind::Follow, 1, Some(0))];
        let pose = record.snapshot.robots[0].motion.pose;
        let point = |time: f64| PlannedPoint {
            time,
            poses: vec![Pose { x: pose.x + time, ..pose }],
            ..PlannedPoint::default()
        };
        let points = vec![point(2.0), point(3.0), point(4.0)];
        record.plans = vec![Arc::new(PlannedPath { robots: vec![0], points })];
        trail.push(&record);
        renderer
            .draw(PictureSpec::new(&trail, &record, &ViewLayout::single(Viewpoint::Snake), style))
            .unwrap()
    };
    let full = draw(&Style::default());
    for name in Style::ELEMENTS {
        let without = draw(&Style::without(&[name]).unwrap());
        assert!(without != full, "{name} changes nothing");
    }
}

/// What acts and what leaves no command is told at the robot in every view that has names, a conflict even in a crowd.
#[test]
fn a_filter_tells_at_its_robot_what_it_does() {
    for (robots, views) in [(3, &[Viewpoint::Snake, Viewpoint::Top][..]), (100, &[Viewpoint::Snake][..])] {
        let play = Play::new(robots, Path::Straight);
        for view in views {
            let draw = |state: Option<SafetyState>, style: &Style| {
                let mut renderer = Renderer::new(gpu(), &play.fleet, 800, 600, 1).unwrap();
                let (trail, mut record) = (play.trail(1.9), play.at(2.0));
                record.safety.extend(state);
                renderer
                    .draw(PictureSpec::new(&trail, &record, &ViewLayout::single(view.clone()), style))
                    .unwrap()
            };
            let state = |moved: f64, acting: &[Constraint], conflict: &[Constraint]| {
                let (acting, conflict) = (acting.to_vec(), conflict.to_vec());
                Some(SafetyState { robot: 1, moved, acting, conflict, ..SafetyState::default() })
            };
            let style = Style::default();
            let free = draw(state(0.0, &[], &[]), &style);
            let held = draw(state(1.0, &[Constraint::Braking, Constraint::Robot(0)], &[]), &style);
            let sees = draw(state(1.0, &[Constraint::ViewLeft], &[]), &style);
            let conflict = [Constraint::Robot(0), Constraint::Robot(2), Constraint::LeftTurn];
            let stuck = draw(state(1.0, &[], &conflict), &style);
            assert_eq!(free, draw(None, &style));
            assert_eq!(held != free && sees != free && sees != held, robots < 24);
            assert!(stuck != free && stuck != held);
            let without = Style::without(&["barriers"]).unwrap();
            assert_eq!(draw(state(1.0, &[], &conflict), &without), draw(None, &without));
        }
    }
}

#[test]
fn a_crowd_is_drawn_without_its_labels() {
    let play = Play::new(100, Path::Straight);
    let full = draw(&play, Viewpoint::Snake, 2.0, &Style::default());
    let quiet = Style::without(&["labels", "edges", "ghosts", "names"]).unwrap();
    assert_eq!(draw(&play, Viewpoint::Snake, 2.0, &quiet), full);
}

#[test]
fn the_same_moments_give_the_same_bytes() {
    let play = Play::new(7, Path::Eight);
    let layout = ViewLayout::parse("snake+top", &[]).unwrap();
    let mut renderer = Renderer::new(gpu(), &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    let trail = play.trail(6.0);
    let first = renderer.draw(PictureSpec::new(&trail, &play.at(6.0), &layout, &Style::default())).unwrap();
    // Other pictures in between, and the pipelined way, must not show.
    renderer
        .draw(PictureSpec::new(
            &play.trail(3.0),
            &play.at(3.0),
            &ViewLayout::single(Viewpoint::Top),
            &Style::default(),
        ))
        .unwrap();
    assert_eq!(
        renderer.draw(PictureSpec::new(&trail, &play.at(6.0), &layout, &Style::default())).unwrap(),
        first
    );
    assert!(
        renderer
            .draw_next(PictureSpec::new(&trail, &play.at(6.0), &layout, &Style::default()))
            .unwrap()
            .is_none()
    );
    assert_eq!(
        renderer
            .draw_next(PictureSpec::new(&trail, &play.at(6.0), &layout, &Style::default()))
            .unwrap()
            .as_ref(),
        Some(&first)
    );
    assert_eq!(renderer.finish().unwrap().as_ref(), Some(&first));
    assert!(renderer.finish().unwrap().is_none());
}

#[test]
fn a_formation_far_from_the_origin_looks_the_same() {
    let play = Play::new(3, Path::Circle);
    let away = |record: &StepRecord| {
        let mut moved = record.clone();
        moved.snapshot.robots.iter_mut().for_each(|r| r.motion.pose.x += 40_000.0);
        moved
    };
    let mut renderer = Renderer::new(gpu(), &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    let style = Style::without(&["grid"]).unwrap();
    let mut pictures = Vec::new();
    for shifted in [false, true] {
        let mut trail = rendering::Trail::new(&play.fleet);
        let mut last = StepRecord::default();
        for k in 0..90 {
            let record = play.at(f64::from(k) / 30.0);
            last = if shifted { away(&record) } else { record };
            trail.push(&last);
        }
        pictures.push(
            renderer
                .draw(PictureSpec::new(&trail, &last, &ViewLayout::single(Viewpoint::Snake), &style))
                .unwrap(),
        );
    }
    let differ = |(a, b): (&u8, &u8)| a.abs_diff(*b) > 3;
    let count = pictures[0].rgba.iter().zip(&pictures[1].rgba).filter(|p| differ(*p)).count();
    assert!(count * 500 < pictures[0].rgba.len(), "{count} values differ");
}

#[test]
fn bad_input_is_refused_with_reasons() {
    let play = Play::new(3, Path::Straight);
    for (width, height) in [(0, 720), (1280, 0), (9000, 720), (1280, 1_000_000)] {
        let error = Renderer::new(gpu(), &play.fleet, width, height, 4).unwrap_err();
        assert!(matches!(error, Error::Size { .. }) && error.is_usage(), "{error}");
    }
    assert!(matches!(Renderer::new(gpu(), &play.fleet, 64, 64, 3), Err(Error::Samples(3))));
    let mut renderer = Renderer::new(gpu(), &play.fleet, 64, 64, 1).unwrap();
    let other = Play::new(2, Path::Straight);
    let error = renderer.draw(PictureSpec::new(
        &other.trail(0.0),
        &other.at(0.0),
        &ViewLayout::single(Viewpoint::Top),
        &Style::default(),
    ));
    assert!(matches!(error, Err(Error::FleetInfo { what: "robots", got: 2, want: 3 })));
    let error = Gpu::open(&AdapterChoice::from("voodoo")).unwrap_err();
    assert!(!error.is_usage() && error.to_string().contains("\"voodoo\"; this machine has"), "{error}");
}

/// Compares with a picture that was looked at; `ECHELON_BLESS=1` takes the new one instead.
fn golden(name: &str, picture: &Picture) {
    let file = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/golden/{name}.png"));
    if std::env::var_os("ECHELON_BLESS").is_some() {
        return film::png::write(&file, picture, &[]).unwrap();
    }
    let wanted = image::open(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display())).to_rgb8();
    let rgb = picture.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let got = image::RgbImage::from_raw(picture.width, picture.height, rgb).unwrap();
    let likeness = image_compare::rgb_hybrid_compare(&wanted, &got).unwrap().score;
    assert!(likeness > 0.97, "{name} is like its golden picture to {likeness:.4}");
}

#[test]
fn golden_pictures() {
    let play = Play::new(3, Path::Eight);
    let mut renderer = Renderer::new(gpu(), &play.fleet, 216, 122, 4).unwrap();
    let style = Style { scale: 0.6, ..Style::default() };
    for (name, view) in [("snake", Viewpoint::Snake), ("top", Viewpoint::Top), ("orbit", Viewpoint::Orbit)] {
        let picture = renderer
            .draw(PictureSpec::new(&play.trail(5.0), &play.at(5.0), &ViewLayout::single(view), &style))
            .unwrap();
        golden(name, &picture);
    }
}

/// What a camera sees is shown where its pixels say, and a small picture lies over a large one.
#[test]
fn views_through_cameras_show_what_the_robot_sees() {
    let play = Play::new(3, Path::Eight);
    let mut record = play.at(12.0);
    sight::measurements(&play.fleet, &mut record);
    let frame = record.frames[0];
    let corners = frame.tags.iter().flatten().next().copied().unwrap();
    let bare = Style { shadows: true, ..Style::bare() };
    let marked = Style { detections: true, ..bare.clone() };
    let inside = Style { picture_in_picture: Some(1), ..bare.clone() };
    let draw = |view: Viewpoint, style: &Style| {
        let mut renderer = Renderer::new(gpu(), &play.fleet, 640, 480, 4).unwrap();
        renderer.draw(PictureSpec::new(&play.trail(12.0), &record, &ViewLayout::single(view), style)).unwrap()
    };
    let (plain, drawn) = (draw(Viewpoint::Camera(1), &bare), draw(Viewpoint::Camera(1), &marked));
    for [x, y] in corners {
        let at = |picture: &Picture| picture.rgb(x.round() as u32, y.round() as u32).unwrap();
        let [r, g, b] = at(&drawn).map(i32::from);
        assert!(g > r + 30 && g > b + 30, "{:?} at {x} {y}, {:?} without", at(&drawn), at(&plain));
    }
    // The border of the tag is black a cell inside its corner.
    let middle = [0, 1].map(|k| corners.iter().map(|c| c[k]).sum::<f64>() / 4.0);
    let border = [0, 1].map(|k| (corners[0][k] + (middle[k] - corners[0][k]) / 8.0).round() as u32);
    let dark = plain.rgb(border[0], border[1]).unwrap();
    assert!(dark.iter().all(|c| *c < 70), "{dark:?}");
    // A camera that goes with the formation would keep it out of the corner.
    let (alone, with) = (draw(plan(), &bare), draw(plan(), &inside));
    let changed = |x: u32, y: u32| alone.rgb(x, y) != with.rgb(x, y);
    let count = (0..640 * 480).filter(|k| changed(k % 640, k / 640)).count();
    assert!((15_000..40_000).contains(&count), "{count}");
    assert!((0..640).filter(|x| changed(*x, 300)).count() < 30 && changed(610, 40));
}

#[test]
fn the_arrow_to_a_set_point_shows_through_its_robot() {
    let play = Play::new(3, Path::Straight);
    let mut style = Style::bare();
    // Straight above the robot, which is in the middle of the picture.
    let count = |style: &Style, time: f64| {
        let pose = play.at(time).snapshot.robots[1].motion.pose;
        let view = Viewpoint::Fixed {
            eye: [pose.x, pose.y, 5.0],
            target: [pose.x, pose.y, 0.0],
            field_of_view: 0.6,
        };
        let picture = draw(&play, view, time, style);
        let (x, y) = (SIZE.0 / 2, SIZE.1 / 2);
        let near = (x - 8..=x + 8).flat_map(|x| (y - 8..=y + 8).map(move |y| (x, y)));
        near.map(|(x, y)| picture.rgb(x, y).unwrap()).collect::<Vec<_>>()
    };
    let differ = |a: &[[u8; 3]], b: &[[u8; 3]]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    let plain = [1.0, 18.0].map(|time| count(&style, time));
    style.set_points = true;
    let shown = [1.0, 18.0].map(|time| count(&style, time));
    // At first it is far off, later by a millimetre or two.
    let (early, late) = (differ(&plain[0], &shown[0]), differ(&plain[1], &shown[1]));
    assert!(early > 40 && late < 10, "{early} {late}");
}

/// Of a set point whose bearing is left free an arc around the leader is drawn, which goes on beside where a ring ends.
#[test]
fn a_distance_alone_is_drawn_as_an_arc_around_the_leader() {
    let mut play = Play::new(2, Path::Straight);
    let time = 18.0;
    let (leader, [distance, bearing]) =
        (play.at(time).snapshot.robots[0].motion.pose, play.at(time).edges[0].set_point);
    // Straight above a place on the circle, half a metre from the set point along it.
    let [x, y] = leader.polar(distance, bearing + 0.6 / distance);
    let view = Viewpoint::Fixed { eye: [x, y, 5.0], target: [x, y, 0.0], field_of_view: 0.6 };
    let middle = |play: &Play, set_points: bool| {
        let picture = draw(play, view.clone(), time, &Style { set_points, ..Style::bare() });
        let (x, y) = (SIZE.0 / 2, SIZE.1 / 2);
        let near = (x - 3..=x + 3).flat_map(|x| (y - 3..=y + 3).map(move |y| (x, y)));
        near.map(|(x, y)| picture.rgb(x, y).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(middle(&play, false), middle(&play, true), "a ring does not reach there");
    play.fleet.free = vec![[false, true]];
    let differ = middle(&play, false).iter().zip(middle(&play, true)).filter(|(a, b)| **a != *b).count();
    assert!(differ >= 7, "{differ}");
}

/// The middle of what the shadows darken, pixels.
fn shadow_middle(play: &Play) -> [f64; 2] {
    let lit = draw(play, plan(), 12.0, &Style::without(Style::ELEMENTS).unwrap());
    let shaded = draw(play, plan(), 12.0, &Style::bare());
    let (mut count, mut sum) = (0.0, [0.0; 2]);
    for (x, y) in (0..SIZE.0).flat_map(|x| (0..SIZE.1).map(move |y| (x, y))) {
        let [before, after] = [&lit, &shaded].map(|p| i32::from(p.rgb(x, y).unwrap()[1]));
        if before - after > 20 {
            count += 1.0;
            sum = [sum[0] + f64::from(x), sum[1] + f64::from(y)];
        }
    }
    assert!(count > 50.0, "{count}");
    sum.map(|s| s / count)
}

#[test]
fn shadows_fall_away_from_the_sun() {
    let mut play = Play::new(1, Path::Straight);
    play.fleet.light.sun_elevation = 0.5;
    // The picture has +x up and +y to the left.
    play.fleet.light.sun_azimuth = 0.0;
    let [x, below] = shadow_middle(&play);
    play.fleet.light.sun_azimuth = std::f64::consts::PI;
    let [_, above] = shadow_middle(&play);
    assert!(below > above + 8.0, "{below} {above}");
    play.fleet.light.sun_azimuth = std::f64::consts::FRAC_PI_2;
    let [right, _] = shadow_middle(&play);
    assert!(right > x + 4.0, "{right} {x}");
    // Straight above there is no direction to fall in, and still a picture.
    play.fleet.light.sun_elevation = std::f64::consts::FRAC_PI_2;
    let _ = draw(&play, plan(), 12.0, &Style::bare());
}

#[test]
fn haze_covers_distant_ground_and_spares_what_is_near() {
    let mut play = Play::new(3, Path::Straight);
    let picture = |play: &Play| draw(play, Viewpoint::Snake, 12.0, &Style::bare());
    let clear = picture(&play);
    play.fleet.light.haze_from = 8.0;
    let hazy = picture(&play);
    let row = |picture: &Picture, y: u32| {
        (0..SIZE.0).map(|x| f64::from(picture.rgb(x, y).unwrap()[1])).sum::<f64>() / f64::from(SIZE.0)
    };
    let (far, near) = (SIZE.1 * 16 / 100, SIZE.1 - 8);
    assert!(row(&hazy, far) > row(&clear, far) + 8.0, "{} {}", row(&hazy, far), row(&clear, far));
    assert!((row(&hazy, near) - row(&clear, near)).abs() < 0.5);
}
