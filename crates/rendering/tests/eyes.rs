//! What cameras on robots see: edges of tags where geometry has them, light as it is, and the same bytes every time.
//!
//! These need an adapter; `apt-get install mesa-vulkan-drivers` brings one that draws on the processor.

use rendering::{AdapterChoice, Gpu, GpuCameraRenderer};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;
use vocabulary::math;
use vocabulary::{
    Attitude, Body, CameraModel, CameraRenderer, Edge, FACES, FleetInfo, Grey, Light, Motion, Placement,
    Pose, Prop, Region, Rigid, RobotInfo, RobotState, Shell, Shot, Snapshot, Solid, tag_cell,
};

fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    let wanted = || AdapterChoice::from(std::env::var("ECHELON_ADAPTER").unwrap_or_default().as_str());
    GPU.get_or_init(|| Gpu::open(&wanted()).expect("tests of pictures need a graphics adapter"))
}

/// A robot that is looked at and one that looks.
fn fleet(shell: Shell) -> FleetInfo {
    let mut leader = RobotInfo::new("leader", true, Body::default());
    leader.shell = Some(shell.tagged(7));
    let members = vec![leader, RobotInfo::new("follower", false, Body::default())];
    let light = Light { sun_elevation: 0.6, sun_azimuth: 3.0, ..Light::default() };
    FleetInfo { robots: members, edges: vec![Edge { leader: 0, follower: 1 }], light, ..FleetInfo::default() }
}

fn state(x: f64, y: f64, heading: f64, attitude: Attitude) -> RobotState {
    let motion = Motion { pose: Pose::new(x, y, heading), ..Motion::default() };
    RobotState { motion, attitude, ..RobotState::default() }
}

/// The follower `distance` behind the leader, who is turned by `turn`; both far from the origin and leaning.
fn stage(distance: f64, turn: f64) -> Snapshot {
    let lean = |roll, pitch| Attitude { height: 0.0, roll, pitch };
    let leader = state(512.3, -77.1, turn, lean(0.04, -0.03));
    let follower = state(512.3 - distance, -77.07, 0.02, lean(-0.06, 0.02));
    Snapshot { time: 0.0, robots: vec![leader, follower], props: vec![] }
}

fn shot(fleet: &FleetInfo, snapshot: &Snapshot, camera_model: &CameraModel) -> Shot {
    Shot {
        robot: 1,
        world_from_camera: fleet.robots[1].camera_mount.world_from_camera(&snapshot.robots[1]),
        focal: camera_model.focal,
        centre: camera_model.centre,
        region: Region::whole(camera_model),
        exposure: 1.0,
    }
}

fn look(fleet: &FleetInfo, snapshot: &Snapshot, shots: &[Shot]) -> Vec<Grey> {
    let mut eyes = GpuCameraRenderer::new(gpu(), fleet).unwrap();
    let mut pictures = Vec::new();
    eyes.render(snapshot, shots, &mut pictures).unwrap();
    pictures
}

/// Brightness at a place, interpolated.
fn at(picture: &Grey, [x, y]: [f64; 2]) -> Option<f64> {
    let (w, h) = (f64::from(picture.width), f64::from(picture.height));
    if !(x >= 0.0 && y >= 0.0 && x < w - 1.0 && y < h - 1.0) {
        return None;
    }
    let (i, j) = (x.floor() as usize, y.floor() as usize);
    let value = |i: usize, j: usize| f64::from(picture.values[j * picture.width as usize + i]);
    let (u, v) = (x.fract(), y.fract());
    let row = |j| value(i, j) * (1.0 - u) + value(i + 1, j) * u;
    Some(row(j) * (1.0 - v) + row(j + 1) * v)
}

/// How far the step from bright to dark lies beyond `place` along `inward`, pixels.
fn step(picture: &Grey, place: [f64; 2], inward: [f64; 2], reach: f64) -> Option<f64> {
    let fine = 0.05;
    let count = (2.0 * reach / fine).round() as i32;
    let along = |s: f64| at(picture, [place[0] + s * inward[0], place[1] + s * inward[1]]);
    let trajectory: Vec<f64> =
        (0..=count).map(|k| along(f64::from(k) * fine - reach)).collect::<Option<_>>()?;
    let end = (1.0 / fine) as usize;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (white, black) = (mean(&trajectory[..end]), mean(&trajectory[trajectory.len() - end..]));
    (white - black > 40.0).then(|| {
        let bright: f64 = trajectory.iter().map(|v| (v - black) / (white - black)).sum::<f64>() * fine;
        bright - 0.5 * fine - reach
    })
}

/// Sides of black squares lie within 0.03 pixels of where the shell's corners are projected.
#[test]
fn edges_of_tags_are_where_they_are_projected() {
    let camera_model = CameraModel { centre: [612.2, 391.7], ..CameraModel::pinhole(1280, 800, 0.9) };
    let mut compared = 0;
    let poses = [
        (1.3, 0.0),
        (1.5, 0.3),
        (1.2, -0.55),
        (1.7, 0.8),
        (1.4, -1.1),
        (1.25, 0.11),
        (4.6, 0.02),
        (5.1, -0.7),
    ];
    for (k, (distance, turn)) in poses.into_iter().enumerate() {
        let shell = if distance > 4.0 { Shell::PAPER.scaled(4.0).at(0.3, 0.9) } else { Shell::PAPER };
        let fleet = fleet(shell);
        let snapshot = stage(distance, turn);
        let shot = shot(&fleet, &snapshot, &camera_model);
        let picture = &look(&fleet, &snapshot, &[shot])[0];
        let camera_from_body = shot.world_from_camera.inverse().after(&snapshot.robots[0].world_from_body());
        for face in 0..FACES {
            let frame = camera_from_body.after(&shell.body_from_face(face));
            let (from, out) = (frame.translation, frame.turn([0.0, 0.0, 1.0]));
            let facing = -(0..3).map(|k| from[k] * out[k]).sum::<f64>()
                / (0..3).map(|k| from[k] * from[k]).sum::<f64>().sqrt();
            if facing < 0.34 {
                continue;
            }
            let corners = shell.tag_corners(face).map(|corner| camera_from_body.apply(corner));
            let Some(seen) = corners.map(|c| camera_model.project(c)).into_iter().collect::<Option<Vec<_>>>()
            else {
                continue;
            };
            for side in 0..4 {
                let (a, b, c) = (seen[side], seen[(side + 1) % 4], seen[(side + 2) % 4]);
                let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                let length = math::hypot(dx, dy);
                let inward = [-dy / length, dx / length];
                // A cell is an eighth of the square.
                let cell = ((c[0] - b[0]) * inward[0] + (c[1] - b[1]) * inward[1]) / 8.0;
                if cell < 5.5 {
                    continue;
                }
                for half in [0.05, 0.5] {
                    let offs: Vec<f64> = (0..40)
                        .map(|n| half + 0.45 * f64::from(n) / 39.0)
                        .filter_map(|s| step(picture, [a[0] + s * dx, a[1] + s * dy], inward, 3.0))
                        .collect();
                    if offs.len() < 40 {
                        continue;
                    }
                    let off = offs.iter().sum::<f64>() / 40.0;
                    assert!(off.abs() < 0.03, "pose {k}, face {face}, side {side}, {half}: {off:.3} px");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 90, "{compared}");
}

/// Cells are as bright as the tag has them, from near to where a cell is less than a pixel.
#[test]
fn tags_show_their_codes_and_keep_their_mean() {
    let camera_model = CameraModel::pinhole(1280, 800, 0.9);
    let fleet = fleet(Shell::PAPER);
    let mut means = Vec::new();
    for distance in [0.9, 2.0, 5.0, 20.0] {
        let snapshot = stage(distance, 0.0);
        let shot = shot(&fleet, &snapshot, &camera_model);
        let picture = &look(&fleet, &snapshot, &[shot])[0];
        let face = Shell::PAPER.body_from_face(2);
        let camera_from_face =
            shot.world_from_camera.inverse().after(&snapshot.robots[0].world_from_body()).after(&face);
        let brightness = |column: f64, row: f64| {
            let [x, y] = [column - 5.0, 5.0 - row].map(|c| c * Shell::PAPER.cell);
            at(picture, camera_model.project(camera_from_face.apply([x, y, 0.0]))?)
        };
        let cells: Vec<_> = (0..100)
            .map(|k| (k % 10, k / 10))
            .filter_map(|(c, r)| Some((tag_cell(37, c, r)?, brightness(c as f64 + 0.5, r as f64 + 0.5)?)))
            .collect();
        assert_eq!(cells.len(), 100);
        if distance < 3.0 {
            let least = cells.iter().filter(|c| c.0).map(|c| c.1).fold(f64::INFINITY, f64::min);
            let most = cells.iter().filter(|c| !c.0).map(|c| c.1).fold(0.0, f64::max);
            assert!(least > 4.0 * most, "{distance}: {least} {most}");
        }
        means.push(cells.iter().map(|c| c.1).sum::<f64>() / 100.0);
    }
    let most = means.iter().fold(0.0_f64, |a, b| a.max(*b));
    let least = means.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    assert!(least > 0.93 * most, "{means:?}");
}

#[test]
fn light_is_linear_and_paper_in_the_sun_is_bright() {
    let mut fleet = fleet(Shell::PAPER);
    // The sun stands behind the follower and straight before the leader's rear face.
    fleet.light = Light { sun_elevation: 0.175, sun_azimuth: PI, ..Light::default() };
    let snapshot = stage(1.2, 0.0);
    let camera_model = CameraModel::pinhole(640, 480, 0.9);
    let one = shot(&fleet, &snapshot, &camera_model);
    let pictures =
        look(&fleet, &snapshot, &[one, Shot { exposure: 0.5, ..one }, Shot { exposure: 3.0, ..one }]);
    let white = pictures[0].values.iter().copied().max().unwrap();
    let top = f64::from(white) / 255.0;
    assert!((0.70..0.95).contains(&top), "{top}");
    // An edge that runs through a sample of a pixel may fall on either side of it.
    let pairs = pictures[0].values.iter().zip(&pictures[1].values);
    let off = pairs.filter(|(a, b)| (f64::from(**a) * 0.5 - f64::from(**b)).abs() > 1.0).count();
    assert!(off < 150, "{off}");
    assert_eq!(pictures[2].values.iter().copied().max(), Some(255));
}

/// A region shows what is there in the whole picture, also with many shots of all sizes at once.
#[test]
fn regions_are_parts_of_the_whole() {
    let fleet = fleet(Shell::PAPER);
    let snapshot = stage(1.4, 0.3);
    let camera_model = CameraModel::pinhole(640, 480, 0.9);
    let whole = shot(&fleet, &snapshot, &camera_model);
    let parts =
        [(200, 130, 220, 160), (0, 0, 64, 48), (301, 207, 33, 77), (600, 400, 40, 80), (7, 300, 500, 9)];
    let mut shots = vec![whole];
    shots.extend(parts.map(|(x, y, width, height)| Shot { region: Region { x, y, width, height }, ..whole }));
    let pictures = look(&fleet, &snapshot, &shots);
    for (shot, picture) in shots.iter().zip(&pictures) {
        let region = shot.region;
        assert_eq!((picture.width, picture.height), (region.width, region.height));
        assert_eq!(picture.values.len(), (region.width * region.height) as usize);
        let off = picture.values.iter().enumerate().filter(|(k, value)| {
            let (x, y) = (*k as u32 % region.width, *k as u32 / region.width);
            let same = pictures[0].values[((region.y + y) * camera_model.width + region.x + x) as usize];
            same.abs_diff(**value) > 3
        });
        let count = off.count();
        assert!(count * 200 <= picture.values.len(), "{region:?}: {count} pixels differ");
    }
    let mut eyes = GpuCameraRenderer::new(gpu(), &fleet).unwrap();
    let mut again = Vec::new();
    for _ in 0..3 {
        eyes.take(&snapshot, &shots, &mut again).unwrap();
        assert!(again == pictures, "the same world gives the same bytes");
    }
}

#[test]
fn a_wall_hides_the_leader() {
    let mut fleet = fleet(Shell::PAPER);
    let snapshot = stage(2.0, 0.0);
    let camera_model = CameraModel::pinhole(640, 480, 0.9);
    let shot = shot(&fleet, &snapshot, &camera_model);
    let open = look(&fleet, &snapshot, &[shot]);
    let place = Placement::upright(Pose::new(511.2, -77.1, 0.0), 0.0);
    let solid = Solid::Block { size: [0.2, 1.0, 0.6] };
    fleet.props.push(Prop {
        name: "wall".into(),
        solid,
        placement: place,
        mobility: vocabulary::Mobility::Fixed,
    });
    let snapshot = Snapshot { props: vec![place], ..snapshot };
    let behind = look(&fleet, &snapshot, &[shot]);
    let dark = |picture: &Grey| picture.values.iter().filter(|v| **v < 12).count();
    assert!(dark(&open[0]) > 800 && dark(&behind[0]) < 200, "{} {}", dark(&open[0]), dark(&behind[0]));
}

/// However a camera is turned, the sky is where the sky is.
#[test]
fn horizons_may_lean_and_turn_over() {
    let fleet = fleet(Shell::PAPER);
    let snapshot = stage(2.0, 0.0);
    let camera_model = CameraModel::pinhole(320, 240, 0.9);
    for roll in [0.0, 0.3, -0.9, 1.57, FRAC_PI_2, 2.5, PI, -2.0] {
        for pitch in [0.1, -0.2] {
            let looking = Rigid::turned([500.0, -60.0, 1.0], 2.0, pitch, roll);
            let body_from_camera = fleet.robots[1].camera_mount.body_from_camera(0.0);
            let turn = Rigid { translation: [0.0; 3], ..body_from_camera };
            let world_from_camera = looking.after(&turn);
            let shot = Shot { world_from_camera, ..shot(&fleet, &snapshot, &camera_model) };
            let picture = &look(&fleet, &snapshot, &[shot])[0];
            for (u, v) in (0..16).flat_map(|u| (0..12).map(move |v| (20 * u + 3, 20 * v + 3))) {
                let [x, y] = camera_model.direction([f64::from(u), f64::from(v)]);
                let up = world_from_camera.turn([x, y, 1.0])[2];
                let bright = picture.values[(v * 320 + u) as usize];
                // Near the horizon both are haze.
                if up.abs() > 0.08 {
                    assert_eq!(bright > 45, up > 0.0, "roll {roll}, pitch {pitch}, pixel {u} {v}: {bright}");
                }
            }
        }
    }
}

#[test]
fn shells_may_be_blank_or_missing() {
    let camera_model = CameraModel::pinhole(640, 480, 0.9);
    let snapshot = stage(1.4, 0.0);
    let bright = |shell: Option<Shell>| {
        let mut fleet = fleet(Shell::PAPER);
        fleet.robots[0].shell = shell;
        let shot = Shot { exposure: 1.2, ..shot(&fleet, &snapshot, &camera_model) };
        look(&fleet, &snapshot, &[shot])[0].values.iter().filter(|v| **v > 160).count()
    };
    let (tagged, blank, none) =
        (bright(Some(Shell::PAPER.tagged(3))), bright(Some(Shell::PAPER)), bright(None));
    assert!(blank > tagged + 2000 && tagged > none + 2000, "{tagged} {blank} {none}");
}

#[test]
fn what_cannot_be_taken_is_refused() {
    let fleet = fleet(Shell::PAPER);
    let snapshot = stage(2.0, 0.0);
    let camera_model = CameraModel::pinhole(640, 480, 0.9);
    let shot = shot(&fleet, &snapshot, &camera_model);
    let mut eyes = GpuCameraRenderer::new(gpu(), &fleet).unwrap();
    let mut pictures = Vec::new();
    assert!(eyes.render(&Snapshot::default(), &[shot], &mut pictures).is_err());
    for (width, height) in [(0, 10), (1 << 20, 10)] {
        let region = Region { x: 0, y: 0, width, height };
        assert!(eyes.render(&snapshot, &[Shot { region, ..shot }], &mut pictures).is_err());
    }
    assert!(eyes.render(&snapshot, &[], &mut pictures).is_ok() && pictures.is_empty());
    let large = Shot { region: Region { x: 0, y: 0, width: 4096, height: 3000 }, focal: 4000.0, ..shot };
    eyes.render(&snapshot, &[large], &mut pictures).unwrap();
    assert_eq!(pictures[0].values.len(), 4096 * 3000);
}
