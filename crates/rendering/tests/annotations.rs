//! What is drawn on the ground to explain: where it says, in its colours, under the robots, and nothing else changes.

#[expect(dead_code, reason = "shared with other tests")]
mod stage;

use rendering::{
    AdapterChoice, AnnotationArrow, AnnotationStroke, Annotations, Ghost, Gpu, PictureSpec, Renderer, Ring,
    ShadedArea, StrokePoint, Style, ViewLayout, Viewpoint,
};
use stage::{Path, Play};
use std::sync::{Arc, OnceLock};
use vocabulary::math;
use vocabulary::{Picture, Pose, Terrain};

const SIZE: (u32, u32) = (640, 360);
const RED: [f32; 3] = [1.0, 0.1, 0.1];
const GREEN: [f32; 3] = [0.1, 0.9, 0.2];

fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    let wanted = || AdapterChoice::from(std::env::var("ECHELON_ADAPTER").unwrap_or_default().as_str());
    GPU.get_or_init(|| Gpu::open(&wanted()).expect("tests of pictures need a graphics adapter"))
}

fn draw(play: &Play, view: Viewpoint, annotations: Annotations) -> Picture {
    let mut renderer = Renderer::new(gpu(), &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    let style = Style { annotations, ..Style::bare() };
    renderer
        .draw(PictureSpec::new(&play.trail(2.0), &play.at(2.0), &ViewLayout::single(view), &style))
        .unwrap()
}

/// Straight down on the x-y plane, 9 m high, with +x up and +y to the left.
fn plan() -> Viewpoint {
    Viewpoint::Fixed { eye: [0.0, 0.0, 9.0], target: [0.0, 0.0, 0.0], field_of_view: 0.6 }
}

fn pixel([x, y]: [f64; 2]) -> [f64; 2] {
    let scale = 0.5 * f64::from(SIZE.1) / (math::tan(0.3_f64) * 9.0);
    [0.5 * f64::from(SIZE.0) - y * scale, 0.5 * f64::from(SIZE.1) - x * scale]
}

/// How much more of one channel than of another a place has, at most within `reach` pixels.
fn excess(picture: &Picture, at: [f64; 2], reach: i64, [more, less]: [usize; 2]) -> i32 {
    let [x, y] = pixel(at).map(|p| p.floor() as i64);
    let near = (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (x + i, y + j)));
    let colours = near.filter_map(|(x, y)| picture.rgb(u32::try_from(x).ok()?, u32::try_from(y).ok()?));
    colours.map(|c| i32::from(c[more]) - i32::from(c[less])).max().unwrap_or(0)
}

const REDDER: [usize; 2] = [0, 1];
const GREENER: [usize; 2] = [1, 0];

fn spot(at: [f64; 2], colour: [f32; 3], alpha: f32) -> StrokePoint {
    StrokePoint { at, colour, alpha }
}

fn across(dashed: bool) -> Annotations {
    let spots = vec![
        spot([-2.0, 2.5], RED, 1.0),
        spot([-2.0, 0.0], RED, 1.0),
        spot([-2.0, -0.1], GREEN, 1.0),
        spot([-2.0, -2.5], GREEN, 1.0),
    ];
    Annotations {
        strokes: vec![AnnotationStroke { dashed, ..AnnotationStroke::new(spots) }],
        ..Annotations::default()
    }
}

#[test]
fn a_stroke_is_thin_and_has_the_colours_of_its_spots() {
    let play = Play::new(3, Path::Straight);
    let picture = draw(&play, plan(), across(false));
    assert!(excess(&picture, [-2.0, 1.5], 1, REDDER) > 120);
    assert!(excess(&picture, [-2.0, -1.5], 1, GREENER) > 120);
    assert!(excess(&picture, [-2.0, 2.7], 1, REDDER) < 20, "beyond its end");
    // Across it, few pixels are coloured.
    let [x, y] = pixel([-2.0, 1.5]).map(|p| p as u32);
    let red = |y: u32| picture.rgb(x, y).is_some_and(|c| i32::from(c[0]) - i32::from(c[1]) > 40);
    let wide = (y - 12..y + 12).filter(|y| red(*y)).count();
    assert!((1..=4).contains(&wide), "{wide} pixels wide");
}

#[test]
fn dashes_have_gaps() {
    let play = Play::new(3, Path::Straight);
    let [whole, dashed] = [false, true].map(|dashed| draw(&play, plan(), across(dashed)));
    let count = |picture: &Picture| {
        (10..240).filter(|k| excess(picture, [-2.0, 0.01 * f64::from(*k)], 0, REDDER) > 60).count()
    };
    let (all, some) = (count(&whole), count(&dashed));
    assert!(all > 200 && some > all * 4 / 10 && some < all * 8 / 10, "{some} of {all}");
}

#[test]
fn a_stroke_fades_and_keeps_its_width_when_it_is_far() {
    let play = Play::new(1, Path::Straight);
    let places: Vec<_> = (0..=40).map(|k| [-2.0, 2.5 - 0.125 * f64::from(k)]).collect();
    let stroke = AnnotationStroke::fading(&places, RED, 1.0);
    let picture = draw(&play, plan(), Annotations { strokes: vec![stroke], ..Annotations::default() });
    let at = |y: f64| excess(&picture, [-2.0, y], 1, REDDER);
    assert!(at(2.0) > at(-1.5) + 40 && at(-1.5) > 30 && at(-2.45) < 30);
    // Ten times as high, still as wide.
    let far = Viewpoint::Fixed { eye: [0.0, 0.0, 90.0], target: [0.0; 3], field_of_view: 0.6 };
    let places = [[-20.0, 25.0], [-20.0, -25.0]].map(|at| spot(at, RED, 1.0));
    let annotations =
        Annotations { strokes: vec![AnnotationStroke::new(places.to_vec())], ..Annotations::default() };
    let picture = draw(&play, far, annotations);
    assert!(excess(&picture, [-2.0, 1.5], 1, REDDER) > 100);
}

/// Seen at a low angle a line that runs aslant is as wide as any other.
#[test]
fn a_stroke_is_as_wide_aslant() {
    let play = Play::new(1, Path::Straight);
    let view = || Viewpoint::Fixed { eye: [-8.0, 0.0, 2.2], target: [0.0, 0.0, 0.0], field_of_view: 0.5 };
    for [from, to] in [[[-1.0, 1.5], [-1.0, -1.5]], [[0.5, 1.5], [-1.5, -1.5]], [[-1.5, 1.5], [0.5, -1.5]]] {
        let spots = vec![spot(from, RED, 1.0), spot(to, RED, 1.0)];
        let picture = draw(
            &play,
            view(),
            Annotations { strokes: vec![AnnotationStroke::new(spots)], ..Annotations::default() },
        );
        let red = |x: u32, y: u32| {
            let [r, g, _] = picture.rgb(x, y).unwrap().map(i32::from);
            r - g > 70
        };
        // All of them are nearly level in the picture.
        let columns = (SIZE.0 * 2 / 5..SIZE.0 * 3 / 5).filter(|x| x.abs_diff(SIZE.0 / 2) > 20);
        let wide: Vec<_> = columns.map(|x| (0..SIZE.1).filter(|y| red(x, *y)).count()).collect();
        let mean = wide.iter().sum::<usize>() as f64 / wide.len() as f64;
        assert!((1.4..3.2).contains(&mean), "{from:?}: {mean}");
    }
}

#[test]
fn what_is_not_finite_is_left_out() {
    let play = Play::new(3, Path::Straight);
    let mut annotations = across(false);
    annotations.strokes[0].spots[1].at[0] = f64::NAN;
    annotations.rings.push(Ring::new([f64::NAN, 0.0], 0.3, RED).selected());
    annotations.rings.push(Ring::new([0.0, 0.0], f64::INFINITY, RED).selected());
    annotations.arrows.push(AnnotationArrow {
        from: [0.0; 2],
        to: [f64::INFINITY; 2],
        gaps: [0.0; 2],
        colour: RED,
        alpha: 1.0,
    });
    annotations.ghosts.push(Ghost { robot: 9, pose: Pose::default(), alpha: 1.0 });
    annotations.ghosts.push(Ghost { robot: 1, pose: Pose::new(f64::NAN, 0.0, 0.0), alpha: 1.0 });
    annotations.areas.push(ShadedArea { corners: vec![spot([f64::NAN; 2], RED, 1.0); 4], hatched: true });
    let picture = draw(&play, plan(), annotations);
    assert!(excess(&picture, [-2.0, -1.5], 1, GREENER) > 120);
    assert!(excess(&picture, [-2.0, 1.5], 1, REDDER) < 20);
}

#[test]
fn rings_areas_and_arrows_are_where_they_say() {
    let play = Play::new(1, Path::Straight);
    let ring = Ring::new([-1.0, -2.0], 0.5, GREEN);
    let triangle = [[-2.0, 3.0], [-2.0, 1.0], [0.0, 3.0]].map(|at| spot(at, RED, 0.5)).to_vec();
    let arrow =
        AnnotationArrow { from: [1.0, 2.0], to: [1.0, -2.0], gaps: [0.5; 2], colour: RED, alpha: 1.0 };
    let annotations = Annotations {
        rings: vec![ring],
        areas: vec![ShadedArea { corners: triangle, hatched: false }],
        arrows: vec![arrow],
        ..Annotations::default()
    };
    let picture = draw(&play, plan(), annotations.clone());
    assert!(
        excess(&picture, [-0.52, -2.0], 2, GREENER) > 100 && excess(&picture, [-1.0, -2.0], 3, GREENER) < 20
    );
    assert!(excess(&picture, [-1.6, 2.4], 1, REDDER) > 50 && excess(&picture, [-0.4, 1.4], 1, REDDER) < 20);
    assert!(excess(&picture, [1.0, 0.0], 1, REDDER) > 150 && excess(&picture, [1.0, -1.8], 1, REDDER) < 20);
    // Selected, it has a middle and shines beyond itself.
    let lit = draw(&play, plan(), Annotations { rings: vec![ring.selected()], ..annotations });
    assert!(excess(&lit, [-1.0, -2.0], 1, GREENER) > 60);
    assert!(excess(&lit, [-0.43, -2.0], 0, GREENER) > excess(&picture, [-0.43, -2.0], 0, GREENER) + 8);
}

#[test]
fn robots_stand_on_annotations() {
    let play = Play::new(3, Path::Straight);
    let pose = play.at(2.0).snapshot.robots[0].motion.pose;
    let view =
        Viewpoint::Fixed { eye: [pose.x, pose.y, 5.0], target: [pose.x, pose.y, 0.0], field_of_view: 0.6 };
    let ring = Ring { fill: 1.0, ..Ring::new([pose.x, pose.y], 0.8, RED) };
    let picture = draw(&play, view, Annotations { rings: vec![ring], ..Annotations::default() });
    let red = |x: u32, y: u32| {
        let [r, g, _] = picture.rgb(x, y).unwrap().map(i32::from);
        r - g > 60
    };
    // Its body is near-black; beside it the ground is red.
    assert!(!red(SIZE.0 / 2, SIZE.1 / 2 - 15) && red(SIZE.0 / 2 + 55, SIZE.1 / 2));
}

#[test]
fn ghosts_stand_where_they_are_put() {
    let play = Play::new(3, Path::Straight);
    let ghost = Ghost { robot: 1, pose: Pose::new(-1.0, -2.0, 1.0), alpha: 0.6 };
    let plain = draw(&play, plan(), Annotations::default());
    let picture = draw(&play, plan(), Annotations { ghosts: vec![ghost], ..Annotations::default() });
    let [x, y] = pixel([-1.0, -2.0]).map(|p| p as u32);
    let near = |x: u32, y: u32| {
        x.abs_diff(pixel([-1.0, -2.0])[0] as u32) < 40 && y.abs_diff(pixel([-1.0, -2.0])[1] as u32) < 40
    };
    let all = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    let changed: Vec<_> = all.filter(|(x, y)| plain.rgb(*x, *y) != picture.rgb(*x, *y)).collect();
    assert!(changed.len() > 100 && changed.iter().all(|(x, y)| near(*x, *y)), "{} at {x} {y}", changed.len());
}

/// All that annotations can have, around the robots.
fn everything() -> Annotations {
    let corners = vec![spot([-3.0, -3.0], RED, 1.0), spot([3.0, -3.0], RED, 1.0), spot([0.0, 3.0], RED, 1.0)];
    Annotations {
        areas: vec![ShadedArea { corners, hatched: true }],
        rings: vec![Ring::new([0.0; 2], 1.0, GREEN).selected()],
        ghosts: vec![Ghost { robot: 0, pose: Pose::new(1.0, 1.0, 0.0), alpha: 0.5 }],
        arrows: vec![AnnotationArrow {
            from: [-2.0, 0.0],
            to: [2.0, 0.0],
            gaps: [0.0; 2],
            colour: RED,
            alpha: 1.0,
        }],
        ..across(true)
    }
}

#[test]
fn cameras_on_robots_do_not_see_it() {
    let play = Play::new(3, Path::Straight);
    let view = || Viewpoint::Camera(1);
    assert_eq!(draw(&play, view(), everything()), draw(&play, view(), Annotations::default()));
    assert!(
        draw(&play, Viewpoint::Snake, everything()) != draw(&play, Viewpoint::Snake, Annotations::default())
    );
}

#[test]
fn on_hills_a_stroke_is_hidden_behind_the_hill_and_seen_on_it() {
    let mut play = Play::new(1, Path::Straight);
    // A ridge along y at x = 2, 1 m high and 2 m wide.
    let height = |k: usize| (1.0 - (0.25 * (k % 41) as f64 - 5.0 - 2.0).abs()).max(0.0);
    let heights = (0..41 * 41).map(height).collect();
    let terrain = Terrain { origin: [-5.0; 2], cell: 0.25, columns: 41, rows: 41, heights, grip: vec![] };
    play.fleet.terrain = Some(Arc::new(terrain));
    let view = || Viewpoint::Fixed { eye: [-4.0, 0.5, 1.2], target: [2.0, 0.5, 0.5], field_of_view: 0.7 };
    let line = |x: f64| Annotations {
        strokes: vec![AnnotationStroke {
            metres: 0.1,
            ..AnnotationStroke::new(vec![spot([x, -1.0], RED, 1.0), spot([x, 2.0], RED, 1.0)])
        }],
        ..Annotations::default()
    };
    let plain = draw(&play, view(), Annotations::default());
    let changed = |x: f64| {
        let picture = draw(&play, view(), line(x));
        picture.rgba.chunks(4).zip(plain.rgba.chunks(4)).filter(|(a, b)| a != b).count()
    };
    // On the slope towards the eye, and behind the ridge.
    let (before, behind) = (changed(1.5), changed(3.2));
    assert!(before > 300 && behind == 0, "{before} {behind}");
}

/// What a renderer says of its own picture.
#[test]
fn sightlines_agree_with_the_picture() {
    let play = Play::new(3, Path::Eight);
    let mut renderer = Renderer::new(gpu(), &play.fleet, SIZE.0, SIZE.1, 4).unwrap();
    let (trail, record) = (play.trail(5.0), play.at(5.0));
    let layout = ViewLayout { views: vec![Viewpoint::Snake, Viewpoint::Top, Viewpoint::Orbit] };
    let at = record.snapshot.robots[1].motion.pose.world_from_body(0.13, 0.7);
    let ring = Ring { pixels: 6.0, ..Ring::new(at, 0.0, RED) };
    let style =
        Style { annotations: Annotations { rings: vec![ring], ..Annotations::default() }, ..Style::bare() };
    let picture = renderer.draw(PictureSpec::new(&trail, &record, &layout, &style)).unwrap();
    let sights = renderer.sightlines(PictureSpec::new(&trail, &record, &layout, &style)).unwrap();
    assert_eq!(sights.len(), 3);
    for sight in sights {
        let [x, y] = sight.pixel_of_ground(at).unwrap();
        assert!(sight.holds([x, y]));
        let red = |dx: f64, dy: f64| {
            let [r, g, _] = picture.rgb((x + dx) as u32, (y + dy) as u32).unwrap().map(i32::from);
            r - g
        };
        let around: i32 = [(3.0, 0.0), (-4.0, 0.0)].iter().map(|(x, y)| red(*x, *y)).max().unwrap();
        assert!(around > 50, "{:?} {around}", sight.view);
        let robot = record.snapshot.robots[1].motion.pose.world_from_body(0.13, 0.0);
        let [x, y] = sight.pixel([robot[0], robot[1], 0.05]).unwrap();
        let picked = renderer.pick(&sight, &record, [x, y]);
        assert_eq!(picked.first(), Some(&rendering::Picked::Robot(1)), "{:?}", sight.view);
        // Taken over by a hand, the robot stays where it was.
        let free = ViewLayout { views: vec![sight.free().view()] };
        let whole = renderer.sightlines(PictureSpec::new(&trail, &record, &free, &style)).unwrap();
        let before = [x - f64::from(sight.tile.x), y - f64::from(sight.tile.y)];
        let factor = f64::from(SIZE.1) / f64::from(sight.tile.height);
        let after = whole[0].pixel([robot[0], robot[1], 0.05]).unwrap();
        let shift = (before[1] * factor - after[1]).abs();
        assert!(shift < 2.0, "{:?} {shift}", sight.view);
    }
}
