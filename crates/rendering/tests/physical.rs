//! What pictures show of a physical world: props, hills, contacts, and bodies of other measures.

#[path = "stage/course.rs"]
mod course;
mod stage;

use course::{CAR, ROVER, TRUCK, enlarge, furnish, grounded, hills, overturn, prop, props, touch};
use rendering::{AdapterChoice, Gpu, PictureSpec, Renderer, Style, Trail, ViewLayout, Viewpoint};
use stage::{Path, Play};
use std::sync::{Arc, OnceLock};
use vocabulary::math;
use vocabulary::{Body, FleetInfo, Mobility, Picture, Solid, StepRecord, Terrain};

const SIZE: (u32, u32) = (640, 360);

fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    let wanted = || AdapterChoice::from(std::env::var("ECHELON_ADAPTER").unwrap_or_default().as_str());
    GPU.get_or_init(|| Gpu::open(&wanted()).expect("tests of pictures need a graphics adapter"))
}

/// The picture of a moment whose past is that moment alone.
fn snap(fleet: &FleetInfo, record: &StepRecord, view: Viewpoint, style: &Style) -> Picture {
    let mut trail = Trail::new(fleet);
    trail.push(record);
    shot(fleet, &trail, record, view, style)
}

fn shot(fleet: &FleetInfo, trail: &Trail, record: &StepRecord, view: Viewpoint, style: &Style) -> Picture {
    let mut renderer = Renderer::new(gpu(), fleet, SIZE.0, SIZE.1, 4).unwrap();
    renderer.draw(PictureSpec::new(trail, record, &ViewLayout::single(view), style)).unwrap()
}

/// Straight down on the x-y plane from 9 m over `ground`.
fn plan(ground: f64) -> Viewpoint {
    Viewpoint::Fixed { eye: [6.0, 0.0, 9.0 + ground], target: [6.0, 0.0, ground], field_of_view: 0.6 }
}

/// The pixel of a point on the ground in [`plan`], whose picture has +x up and +y to the left.
fn pixel(x: f64, y: f64) -> (u32, u32) {
    let scale = 0.5 * f64::from(SIZE.1) / (math::tan(0.3_f64) * 9.0);
    let at = |middle: u32, shift: f64| (0.5 * f64::from(middle) - shift * scale).round() as u32;
    (at(SIZE.0, y), at(SIZE.1, x - 6.0))
}

/// Mean colour of the pixels around a place.
fn mean(picture: &Picture, (x, y): (u32, u32), reach: u32) -> [f64; 3] {
    let places = (x - reach..=x + reach).flat_map(|x| (y - reach..=y + reach).map(move |y| (x, y)));
    let colours: Vec<_> = places.filter_map(|(x, y)| picture.rgb(x, y)).collect();
    [0, 1, 2].map(|k| colours.iter().map(|c| f64::from(c[k])).sum::<f64>() / colours.len() as f64)
}

/// Pixels that fulfil a condition.
fn count(picture: &Picture, like: impl Fn([i32; 3]) -> bool) -> usize {
    let colours = picture.rgba.chunks_exact(4).map(|p| [p[0], p[1], p[2]].map(i32::from));
    colours.filter(|c| like(*c)).count()
}

/// Pixels that differ by more than `more` in a channel.
fn differ(a: &Picture, b: &Picture, more: u8) -> usize {
    let pairs = a.rgba.chunks_exact(4).zip(b.rgba.chunks_exact(4));
    pairs.filter(|(p, q)| (0..3).any(|k| p[k].abs_diff(q[k]) > more)).count()
}

fn orange([r, g, b]: [i32; 3]) -> bool {
    r > 150 && g < r * 3 / 4 && b < r / 3
}

fn blue([r, g, b]: [i32; 3]) -> bool {
    b > 90 && g > r && 3 * r < 2 * b
}

fn straight() -> (FleetInfo, StepRecord) {
    let play = Play::new(3, Path::Straight);
    (play.fleet.clone(), play.at(12.0))
}

fn ground(height: f64) -> Arc<Terrain> {
    let heights = vec![height; 4];
    Arc::new(Terrain { origin: [-30.0, -30.0], cell: 60.0, columns: 2, rows: 2, heights, grip: vec![] })
}

#[test]
fn props_stand_where_they_are_and_cast_shadows() {
    let (mut fleet, record) = straight();
    let empty = snap(&fleet, &record, plan(0.0), &Style::bare());
    let cone = Solid::Cone { radius: 0.2, height: 0.5 };
    let block = Solid::Block { size: [0.5, 0.5, 0.5] };
    fleet.props = vec![
        prop(cone, Mobility::Loose, 5.0, 2.0, 0.0),
        prop(block, Mobility::Fixed, 5.0, -2.5, 0.0),
        prop(block, Mobility::Guided, 6.5, 2.5, 0.0),
    ];
    // A moment without placements shows props where they start.
    let picture = snap(&fleet, &record, plan(0.0), &Style::bare());
    let [r, g, b] = mean(&picture, pixel(5.1, 1.9), 3);
    assert!(r > 1.5 * g && r > 2.0 * b, "{r} {g} {b}");
    let [r, g, b] = mean(&picture, pixel(6.5, 2.5), 3);
    assert!(r > 1.4 * g && r > 1.3 * b, "{r} {g} {b}");
    let [r, _, b] = mean(&picture, pixel(5.0, -2.5), 3);
    assert!(r > b + 8.0 && r > 150.0, "warm concrete: {r} {b}");
    // The sun stands over +y and a little −x: the shadow falls towards −y.
    let shade = pixel(5.2, -3.05);
    let (before, after) = (mean(&empty, shade, 2)[1], mean(&picture, shade, 2)[1]);
    assert!(after < 0.65 * before, "{before} {after}");
    let open = pixel(5.0, -1.6);
    assert!((mean(&empty, open, 2)[1] - mean(&picture, open, 2)[1]).abs() < 2.0);
}

#[test]
fn a_prop_moves_with_the_moment() {
    let (mut fleet, mut record) = straight();
    let crate_of = Solid::Block { size: [0.5; 3] };
    fleet.props = vec![prop(crate_of, Mobility::Loose, 5.0, 2.0, 0.0)];
    let first = snap(&fleet, &record, plan(0.0), &Style::bare());
    record.snapshot.props = vec![prop(crate_of, Mobility::Loose, 5.0, -2.0, 0.7).placement];
    let then = snap(&fleet, &record, plan(0.0), &Style::bare());
    let warm = |picture: &Picture, y: f64| {
        let [r, _, b] = mean(picture, pixel(5.0, y), 3);
        r - b
    };
    assert!(warm(&first, 2.0) > 40.0 && warm(&first, -2.0) < 15.0);
    assert!(warm(&then, 2.0) < 15.0 && warm(&then, -2.0) > 40.0);
}

#[test]
fn a_prop_shades_the_robot_behind_it() {
    let (mut fleet, record) = straight();
    let pose = record.snapshot.robots[0].motion.pose;
    let brightness = |fleet: &FleetInfo| {
        mean(&snap(fleet, &record, plan(0.0), &Style::bare()), pixel(pose.x + 0.1, pose.y), 6)[1]
    };
    let before = brightness(&fleet);
    let wall = Solid::Block { size: [1.5, 0.1, 0.9] };
    fleet.props = vec![prop(wall, Mobility::Fixed, pose.x, pose.y + 0.5, 0.0)];
    let after = brightness(&fleet);
    assert!(after < 0.8 * before, "{before} {after}");
}

#[test]
fn a_level_terrain_looks_like_the_plain_from_as_high_above() {
    let play = Play::new(3, Path::named("circle"));
    let mut fleet = play.fleet.clone();
    let style = Style::without(&["caption", "names"]).unwrap();
    let flat = shot(&fleet, &play.trail(6.0), &play.at(6.0), plan(0.0), &style);
    let view = |ground: f64| Viewpoint::Fixed {
        eye: [-3.0, -2.0, 2.0 + ground],
        target: [3.0, 1.0, ground],
        field_of_view: 0.7,
    };
    let oblique = shot(&fleet, &play.trail(6.0), &play.at(6.0), view(0.0), &style);
    fleet.terrain = Some(ground(1.5));
    let mut trail = Trail::new(&fleet);
    let mut last = StepRecord::default();
    for k in 0..=180 {
        last = grounded(&fleet, play.at(f64::from(k) / 30.0));
        trail.push(&last);
    }
    assert_eq!(last.snapshot.robots[0].attitude.height, 1.5);
    // The plain is a plane and the terrain a mesh: a few edges fall differently.
    let most = (SIZE.0 * SIZE.1 / 100) as usize;
    for (view, before) in [(plan(1.5), flat), (view(1.5), oblique)] {
        let raised = shot(&fleet, &trail, &last, view, &style);
        let found = differ(&before, &raised, 24);
        assert!(found < most, "{found}");
    }
}

#[test]
fn a_hill_hides_what_is_behind_it() {
    let (mut fleet, record) = straight();
    let hidden = record.snapshot.robots[2].motion.pose;
    let view = || Viewpoint::Fixed {
        eye: [hidden.x - 6.0, hidden.y, 0.5],
        target: [hidden.x, hidden.y, 0.1],
        field_of_view: 0.4,
    };
    let style = Style::without(&["labels", "names"]).unwrap();
    let plain = count(&snap(&fleet, &record, view(), &style), blue);
    let side = 41;
    let heights = (0..side * side).map(|k| {
        let (x, y) = ((k % side) as f64 * 0.5 - 10.0, (k / side) as f64 * 0.5 - 10.0);
        2.0 * math::exp(-(math::powi(x + 3.0, 2) + y * y) / 1.5)
    });
    let origin = [hidden.x - 10.0, hidden.y - 10.0];
    let heights = heights.collect();
    fleet.terrain =
        Some(Arc::new(Terrain { origin, cell: 0.5, columns: side, rows: side, heights, grip: vec![] }));
    let behind = count(&snap(&fleet, &record, view(), &style), blue);
    assert!(plain > 300 && behind * 10 < plain, "{plain} {behind}");
}

#[test]
fn ice_is_blue() {
    let (mut fleet, record) = straight();
    let mut terrain = (*ground(0.0)).clone();
    fleet.terrain = Some(Arc::new(terrain.clone()));
    let dry = mean(&snap(&fleet, &record, plan(0.0), &Style::bare()), pixel(5.0, 3.0), 8);
    terrain.grip = vec![0.1; 4];
    fleet.terrain = Some(Arc::new(terrain));
    let icy = mean(&snap(&fleet, &record, plan(0.0), &Style::bare()), pixel(5.0, 3.0), 8);
    assert!(icy[2] - icy[0] > 15.0 && dry[2] - dry[0] < 8.0, "{dry:?} {icy:?}");
}

#[test]
fn a_contact_flashes_and_leaves_a_mark() {
    let (fleet, mut record) = straight();
    let style = Style { contacts: true, ..Style::bare() };
    let place = (5.0, 2.0);
    record.contacts = vec![touch(0, 12.0, [place.0, place.1, 0.1])];
    let mut trail = Trail::new(&fleet);
    trail.push(&record);
    record.contacts.clear();
    let mut after = |wait: f64| {
        record.snapshot.time = 12.0 + wait;
        mean(&shot(&fleet, &trail, &record, plan(0.0), &style), pixel(place.0, place.1), 1)[1]
    };
    let (flash, later, last) = (after(0.1), after(1.0), after(500.0));
    let ground = mean(&snap(&fleet, &record, plan(0.0), &Style::bare()), pixel(place.0, place.1), 1)[1];
    assert!(flash > 190.0 && flash > 1.6 * ground, "{flash} {ground}");
    assert!(later < 0.7 * ground && (later - last).abs() < 1.0, "{ground} {later} {last}");
}

#[test]
fn a_flash_shows_through_what_is_in_front() {
    let (mut fleet, mut record) = straight();
    fleet.props = vec![prop(Solid::Block { size: [1.0, 1.0, 1.0] }, Mobility::Fixed, 5.0, 2.0, 0.0)];
    let style = Style { contacts: true, ..Style::bare() };
    let quiet = snap(&fleet, &record, plan(0.0), &style);
    record.contacts = vec![touch(0, 11.95, [5.0, 2.0, 0.1])];
    let loud = snap(&fleet, &record, plan(0.0), &style);
    assert!(differ(&quiet, &loud, 20) > 60);
}

#[test]
fn what_stands_before_the_robots_is_seen_through() {
    let (mut fleet, record) = straight();
    let warm = |[r, g, b]: [i32; 3]| r > g + 12 && g > b + 12;
    let clear = snap(&fleet, &record, Viewpoint::Snake, &Style::bare());
    let plain = count(&clear, warm);
    let last = record.snapshot.robots[1].motion.pose;
    fleet.props = vec![prop(Solid::Block { size: [0.1, 9.0, 1.2] }, Mobility::Fixed, last.x - 1.4, 0.0, 0.0)];
    let veiled = snap(&fleet, &record, Viewpoint::Snake, &Style::bare());
    let hidden = differ(&veiled, &clear, 12);
    assert!(hidden > 5_000, "the wall is there: {hidden}");
    let found = count(&veiled, warm);
    assert!(plain > 150 && found * 3 > plain, "{plain} {found}");
}

/// A moment of the straight play on a platform under all robots, 0.3 m high.
fn on_a_platform() -> (FleetInfo, StepRecord) {
    let (mut fleet, mut record) = straight();
    fleet.props = vec![prop(Solid::Block { size: [24.0, 12.0, 0.3] }, Mobility::Fixed, 6.0, 0.0, 0.0)];
    record.snapshot.robots.iter_mut().for_each(|r| r.attitude.height = 0.3);
    (fleet, record)
}

#[test]
fn a_ribbon_lies_on_the_ramp_under_it() {
    let play = Play::new(3, Path::Straight);
    let (mut fleet, record) = (play.fleet.clone(), play.at(12.0));
    let style = Style { ribbons: true, ..Style::bare() };
    let painted = |fleet: &FleetInfo| shot(fleet, &play.trail(12.0), &record, plan(0.0), &style);
    let plain = count(&painted(&fleet), blue);
    let place = record.snapshot.robots[2].motion.pose;
    let (middle, size) = (place.x - 1.4, [2.0, 1.6, 0.3]);
    fleet.props = vec![prop(Solid::Wedge { size }, Mobility::Fixed, middle, place.y, 0.0)];
    let picture = painted(&fleet);
    for x in [-0.8, -0.4, 0.0, 0.4, 0.8] {
        // What is higher is nearer to the eye, which is over (6, 0).
        let near = 9.0 / (9.0 - size[2] * (x / size[0] + 0.5));
        let at =
            |aside: f64| mean(&picture, pixel(6.0 + (middle + x - 6.0) * near, (place.y + aside) * near), 0);
        let [[r, _, b], [bare_r, _, bare_b]] = [at(0.0), at(0.3)];
        assert!(b > r + 30.0 && bare_b < bare_r, "{x}: {r} {b}, beside it {bare_r} {bare_b}");
    }
    let found = count(&picture, blue);
    assert!(found * 10 > plain * 8, "{found} of {plain}");
    // Nobody drives on a wall: what is under it is hidden.
    fleet.props = vec![prop(Solid::Block { size: [2.0, 1.6, 1.2] }, Mobility::Fixed, middle, place.y, 0.0)];
    let hidden = count(&painted(&fleet), blue);
    assert!(hidden * 2 < plain, "{hidden} of {plain}");
}

#[test]
fn a_platform_is_like_higher_ground() {
    let (fleet, record) = on_a_platform();
    let style = Style { ribbons: false, ..Style::without(&["caption", "names", "grid"]).unwrap() };
    let high = snap(&fleet, &record, plan(0.3), &style);
    let (mut flat, record) = straight();
    flat.props = vec![];
    let low = snap(&flat, &record, plan(0.0), &style);
    // Rings and contact patches are where they are on the ground.
    for like in [orange, blue] {
        let (on, under) = (count(&high, like), count(&low, like));
        assert!(under > 20 && on * 10 > under * 9, "{on} {under}");
    }
    let pose = record.snapshot.robots[0].motion.pose;
    let dark = |picture: &Picture| {
        let [near, far] = [0.13, 1.5].map(|y| mean(picture, pixel(pose.x, pose.y + y), 0)[1]);
        near / far
    };
    assert!(dark(&high) < 0.85 && dark(&low) < 0.85, "{} {}", dark(&high), dark(&low));
}

#[test]
fn what_robots_drive_on_is_not_darkened() {
    let (fleet, record) = on_a_platform();
    for view in [Viewpoint::Snake, Viewpoint::SnakeEye, Viewpoint::Follow(1)] {
        let name = format!("{view:?}");
        let picture = snap(&fleet, &record, view, &Style::bare());
        for x in [40, 160, 480, 600] {
            let [r, _, b] = mean(&picture, (x, SIZE.1 - 12), 6);
            assert!(r > 150.0 && r > b + 5.0, "{name} {x}: {r} {b}");
        }
    }
}

#[test]
fn a_platform_before_a_robot_is_seen_through() {
    let (mut fleet, record) = straight();
    let mut yellow = |props: Vec<vocabulary::Prop>, samples: u32| {
        fleet.props = props;
        let mut trail = Trail::new(&fleet);
        trail.push(&record);
        let mut renderer = Renderer::new(gpu(), &fleet, SIZE.0, SIZE.1, samples).unwrap();
        let layout = ViewLayout::single(Viewpoint::Follow(1));
        let picture = renderer.draw(PictureSpec::new(&trail, &record, &layout, &Style::bare())).unwrap();
        assert!(picture.rgba.chunks_exact(4).all(|p| p[3] == 255));
        count(&picture, |[r, g, b]| r > g + 12 && g > b + 25)
    };
    let pose = record.snapshot.robots[1].motion.pose;
    let platform = Solid::Block { size: [1.0, 4.0, 0.9] };
    for samples in [1, 4] {
        let open = yellow(vec![], samples);
        let behind = yellow(vec![prop(platform, Mobility::Fixed, pose.x - 0.9, pose.y, 0.0)], samples);
        assert!(open > 150 && behind * 4 > open, "{open} {behind}");
    }
}

#[test]
fn bodies_of_all_sizes_are_in_the_picture() {
    for (body, scale) in [(TRUCK, 1.0), (ROVER, 1.0), (CAR, 10.0), (Body::default(), 1.0)] {
        let mut play = Play::new(3, Path::Eight);
        furnish(&mut play.fleet, body, false, false);
        // The shell on a car's roof hides much of its paint; it is bodies that are counted.
        for member in play.fleet.robots.iter_mut().filter(|member| member.body.length > 1.2) {
            member.shell = None;
        }
        let mut record = play.at(9.0);
        enlarge(&mut record, scale);
        for view in
            [Viewpoint::Snake, Viewpoint::Top, Viewpoint::Orbit, Viewpoint::SnakeEye, Viewpoint::Follow(1)]
        {
            let name = format!("{view:?}");
            let picture = snap(&play.fleet, &record, view, &Style::bare());
            let found = count(&picture, |[r, g, b]| r > g + 30 && g > b + 40);
            assert!(found > 60, "{name} of {body:?}: {found}");
        }
    }
}

#[test]
fn robots_on_hills_are_in_the_picture() {
    let mut play = Play::new(3, Path::Eight);
    furnish(&mut play.fleet, TRUCK, true, true);
    assert_eq!(play.fleet.props.len(), props().len());
    let field = hills();
    let raised = Terrain { heights: field.heights.iter().map(|h| h + 30.0).collect(), ..field };
    play.fleet.terrain = Some(Arc::new(raised));
    play.fleet.props.clear();
    let record = grounded(&play.fleet, play.at(9.0));
    assert!(record.snapshot.robots[0].attitude.height > 25.0);
    for view in
        [Viewpoint::Snake, Viewpoint::Top, Viewpoint::Orbit, Viewpoint::SnakeEye, Viewpoint::Follow(1)]
    {
        let name = format!("{view:?}");
        let picture = snap(&play.fleet, &record, view, &Style::bare());
        let found = count(&picture, |[r, g, b]| r > g + 30 && g > b + 40);
        assert!(found > 60, "{name}: {found}");
    }
}

#[test]
fn trouble_is_named() {
    let (fleet, mut record) = straight();
    let style = Style { names: true, ..Style::bare() };
    let alarm = |c: [i32; 3]| c[0] > 200 && (120..190).contains(&c[1]) && c[2] < 170 && c[0] - c[2] > 60;
    let before = count(&snap(&fleet, &record, Viewpoint::Snake, &style), alarm);
    overturn(&fleet, &mut record, 2);
    let after = count(&snap(&fleet, &record, Viewpoint::Snake, &style), alarm);
    assert!(after > before + 40, "{before} {after}");
}

#[test]
fn a_thousand_props_are_drawn() {
    let (mut fleet, record) = straight();
    let cone = Solid::Cone { radius: 0.05, height: 0.15 };
    let place = |k: u32| (f64::from(k % 40) * 0.2 + 2.0, f64::from(k / 40) * 0.2 - 2.5);
    fleet.props = (0..1000).map(|k| prop(cone, Mobility::Loose, place(k).0, place(k).1, 0.0)).collect();
    let picture = snap(&fleet, &record, plan(0.0), &Style::default());
    let found = count(&picture, orange);
    assert!(found > 3_000, "{found}");
}

/// Compares with a picture that was looked at; `ECHELON_BLESS=1` takes the new one instead.
#[test]
fn golden_course() {
    let mut play = Play::new(3, Path::Eight);
    furnish(&mut play.fleet, TRUCK, true, true);
    let mut trail = Trail::new(&play.fleet);
    let mut last = StepRecord::default();
    for k in 0..=150 {
        last = grounded(&play.fleet, play.at(f64::from(k) / 30.0));
        trail.push(&last);
    }
    let mut renderer = Renderer::new(gpu(), &play.fleet, 216, 122, 4).unwrap();
    let style = Style { scale: 0.6, ..Style::default() };
    let picture = renderer
        .draw(PictureSpec::new(&trail, &last, &ViewLayout::single(Viewpoint::Snake), &style))
        .unwrap();
    let file = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden/course.png");
    if std::env::var_os("ECHELON_BLESS").is_some() {
        return film::png::write(&file, &picture, &[]).unwrap();
    }
    let wanted = image::open(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display())).to_rgb8();
    let rgb = picture.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let got = image::RgbImage::from_raw(picture.width, picture.height, rgb).unwrap();
    let likeness = image_compare::rgb_hybrid_compare(&wanted, &got).unwrap().score;
    assert!(likeness > 0.97, "the course is like its golden picture to {likeness:.4}");
}
