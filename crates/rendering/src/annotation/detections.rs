//! The result of a follower's last camera image, drawn over its view: tags, region, and the leader's shell where
//! the estimate has it.

use crate::annotation::labels::{Ink, LabelPlacer, Window};
use crate::camera::viewpoint::Tile;
use crate::palette::{Rgb, hex, with_alpha};
use crate::picture_context::PictureContext;
use glam::Vec2;
use vocabulary::math;
use vocabulary::{
    CameraModel, Edge, FACES, MeasurementRecord, Outcome, Relative, Rigid, RobotInfo, Shell, Word, tag_code,
    wrap,
};

/// Older measurements are not drawn, s.
const FORGOTTEN: f64 = 2.0;

const USED: Rgb = hex(0x0048_e08a);
const DOUBTED: Rgb = hex(0x00ff_c24a);
const MISSED: Rgb = hex(0x00ff_6a5a);
const REGION: Rgb = hex(0x00ff_ffff);
const AXES: [Rgb; 3] = [hex(0x00ff_5a4a), hex(0x0048_e08a), hex(0x005a_a0ff)];

fn colour(outcome: Outcome) -> Rgb {
    match outcome {
        Outcome::Used => USED,
        Outcome::Rejected | Outcome::Ambiguous => DOUBTED,
        Outcome::Missed | Outcome::Dropped => MISSED,
    }
}

/// Draws in pixels of a camera's picture.
struct DetectionOverlay<'a, 'b, 'c> {
    words: &'a mut LabelPlacer<'b>,
    window: Window<'c>,
    camera_model: CameraModel,
    /// How far the camera has turned to the left of its leader since the measurement, rad.
    turn: f64,
    width: f32,
}

/// Where a direction (x/z right, y/z down) is for a camera that has turned to the left; `None` behind it.
fn turned([x, y]: [f64; 2], turn: f64) -> Option<[f64; 2]> {
    let (sin, cos) = math::sin_cos(turn);
    let ahead = cos - x * sin;
    (ahead > 0.02).then(|| [(x * cos + sin) / ahead, y / ahead])
}

/// How far the camera has turned to the left of its leader since a measurement, rad: the detection of then is drawn over
/// the view of now.
fn turn_since(context: &PictureContext<'_>, edge: &Edge, frame: &MeasurementRecord) -> f64 {
    let robots = &context.record.snapshot.robots;
    let (Some(own), Some(leader), Some(member)) =
        (robots.get(edge.follower), robots.get(edge.leader), context.fleet.robots.get(edge.follower))
    else {
        return 0.0;
    };
    let bearing = |relative: &Relative, pan: f64| {
        let (sin, cos) = math::sin_cos(relative.view_angle);
        let ahead = -relative.distance * cos - member.camera_mount.forward;
        math::atan2(-relative.distance * sin, ahead) - pan
    };
    let now = Relative::between(leader.motion.pose, own.motion.pose);
    wrap(bearing(&frame.truth, frame.pan) - bearing(&now, own.camera_pan))
}

impl DetectionOverlay<'_, '_, '_> {
    /// Where a direction of the measurement (x/z right, y/z down) appears, pixels of the whole picture.
    fn at(&self, direction: [f64; 2]) -> Option<Vec2> {
        turned(direction, self.turn).map(|[x, y]| self.window.direction(x, -y))
    }

    fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb, alpha: f32) {
        let (Some(from), Some(to)) = (self.at(from), self.at(to)) else { return };
        if let Some((a, b)) = clipped(from, to, &self.window.tile) {
            self.words.shapes.line(a, b, self.width, with_alpha(colour, alpha));
        }
    }

    /// A closed line through pixels of the sensor.
    fn outline(&mut self, corners: &[[f64; 2]], colour: Rgb, alpha: f32) {
        for (k, a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            let (a, b) = (self.camera_model.direction(*a), self.camera_model.direction(b));
            self.line(a, b, colour, alpha);
        }
    }

    /// A line between points in the camera's frame, m.
    fn space(&mut self, from: [f64; 3], to: [f64; 3], colour: Rgb, alpha: f32) {
        let seen = |[x, y, z]: [f64; 3]| (z > 0.02).then(|| [x / z, y / z]);
        if let (Some(a), Some(b)) = (seen(from), seen(to)) {
            self.line(a, b, colour, alpha);
        }
    }

    fn shell(&mut self, camera_from_body: &Rigid, shell: &Shell, colour: Rgb) {
        let half = 0.5 * shell.face_height / math::cos(shell.lean).max(0.1);
        for face in 0..FACES {
            let frame = camera_from_body.after(&shell.body_from_face(face));
            let (low, high) = (shell.half_width(-half), shell.half_width(half));
            let corners = [[-low, -half], [low, -half], [high, half], [-high, half]];
            let corners = corners.map(|[x, y]| frame.apply([x, y, 0.0]));
            let (at, out) = (frame.translation, frame.turn([0.0, 0.0, 1.0]));
            let hidden = (0..3).map(|k| at[k] * out[k]).sum::<f64>() > 0.0;
            for k in 0..4 {
                self.space(corners[k], corners[(k + 1) % 4], colour, if hidden { 0.22 } else { 0.8 });
            }
        }
        let middle = [shell.forward, 0.0, shell.height];
        let from = camera_from_body.apply(middle);
        for (k, axis) in AXES.into_iter().enumerate() {
            let mut tip = middle;
            tip[k] += 1.4 * shell.apothem;
            self.space(from, camera_from_body.apply(tip), axis, 1.0);
        }
    }
}

/// The part of a line that lies in a tile.
fn clipped(a: Vec2, b: Vec2, tile: &Tile) -> Option<(Vec2, Vec2)> {
    let low = Vec2::new(tile.x as f32, tile.y as f32);
    let high = low + Vec2::new(tile.width as f32, tile.height as f32);
    let along = b - a;
    let (mut from, mut to) = (0.0_f32, 1.0_f32);
    for k in 0..2 {
        if along[k].abs() < 1e-6 {
            if a[k] < low[k] || a[k] > high[k] {
                return None;
            }
            continue;
        }
        let (p, q) = ((low[k] - a[k]) / along[k], (high[k] - a[k]) / along[k]);
        (from, to) = (from.max(p.min(q)), to.min(p.max(q)));
    }
    (from < to).then(|| (a + along * from, a + along * to))
}

/// The estimated body of the leader, in the frame of the follower's camera at the measurement.
fn estimated(frame: &MeasurementRecord, follower: &RobotInfo) -> Rigid {
    let relative = frame.measurement.relative;
    let (sin, cos) = math::sin_cos(relative.view_angle);
    let at = [-relative.distance * cos, -relative.distance * sin, 0.0];
    let leader = Rigid::turned(at, relative.view_angle - relative.bearing, 0.0, 0.0);
    follower.camera_mount.body_from_camera(frame.pan).inverse().after(&leader)
}

/// Whose camera a view is through, and what it found.
pub(crate) fn camera_words(
    words: &mut LabelPlacer<'_>,
    context: &PictureContext<'_>,
    window: Window<'_>,
    robot: usize,
) {
    let Some(member) = context.fleet.robots.get(robot) else { return };
    if context.style.detections {
        detections(words, context, window, robot);
    }
    let tile = window.tile;
    let at = [tile.x as f32 + words.scaled(10.0), tile.y as f32 + tile.height as f32 - words.scaled(12.0)];
    words.write(format!("camera: {}", member.name), at, 12.0, true, Ink::LIGHT);
}

/// Draws the last measurement of each edge of a robot over the view of its camera.
fn detections(words: &mut LabelPlacer<'_>, context: &PictureContext<'_>, window: Window<'_>, robot: usize) {
    let now = context.record.snapshot.time;
    let mut row = 0.0;
    for (index, edge, _) in context.record.pairs(context.fleet).filter(|(_, edge, _)| edge.follower == robot)
    {
        let news = context.record.frames.iter().rev().find(|frame| frame.edge == index);
        let Some(frame) = news.or_else(|| context.trail.measurement(index)) else { continue };
        let (Some(follower), Some(leader)) =
            (context.fleet.robots.get(robot), context.fleet.robots.get(edge.leader))
        else {
            continue;
        };
        if !(0.0..FORGOTTEN).contains(&(now - frame.measurement.stamp)) {
            continue;
        }
        let ink = colour(frame.outcome);
        // Thin in a small picture, where thick lines would cover what they tell of.
        let width = words.scaled(1.6 * (window.tile.width as f32 / words.scaled(640.0)).clamp(0.55, 1.0));
        let mut overlay = DetectionOverlay {
            words,
            window,
            camera_model: follower.camera_model,
            turn: turn_since(context, &edge, frame),
            width,
        };
        region(&mut overlay, frame);
        if let (true, Some(shell)) = (frame.outcome.seen(), &leader.shell) {
            overlay.shell(&estimated(frame, follower), shell, ink);
        }
        overlay.width *= 1.2;
        for corners in frame.tags.iter().flatten() {
            overlay.outline(corners, ink, 1.0);
        }
        ids(&mut overlay, frame, leader, ink);
        report(words, window.tile, &leader.name, frame, &mut row);
    }
}

fn region(overlay: &mut DetectionOverlay<'_, '_, '_>, frame: &MeasurementRecord) {
    let r = frame.region;
    if r.width == 0 || r.height == 0 {
        return;
    }
    let [left, top] = [r.x, r.y].map(|x| f64::from(x) - 0.5);
    let (right, bottom) = (left + f64::from(r.width), top + f64::from(r.height));
    overlay.width *= 0.6;
    overlay.outline(&[[left, top], [right, top], [right, bottom], [left, bottom]], REGION, 0.55);
    overlay.width /= 0.6;
}

/// The numbers of the tags, in their middles.
fn ids(overlay: &mut DetectionOverlay<'_, '_, '_>, frame: &MeasurementRecord, leader: &RobotInfo, ink: Rgb) {
    let Some(first) = leader.shell.and_then(|shell| shell.first_tag) else { return };
    for (face, corners) in frame.tags.iter().enumerate() {
        let Some(corners) = corners else { continue };
        let id = first + face as u16;
        if tag_code(id).is_none() {
            continue;
        }
        let middle = [0, 1].map(|k| corners.iter().map(|c| c[k]).sum::<f64>() / 4.0);
        let place = |pixel| overlay.at(overlay.camera_model.direction(pixel));
        let (Some(at), Some(corner)) = (place(middle), place(corners[0])) else { continue };
        if at.distance(corner) < overlay.words.scaled(18.0) {
            continue;
        }
        let text = id.to_string();
        let words = &mut *overlay.words;
        let half = 0.5 * words.width(&text, 13.0, true);
        let ink = Ink { colour: ink, ..Ink::LIGHT };
        words.write(text, [at.x - half, at.y], 13.0, true, ink);
    }
}

/// Numbers and outcome of a measurement in two lines at the foot of a tile.
fn report(words: &mut LabelPlacer<'_>, tile: Tile, leader: &str, frame: &MeasurementRecord, row: &mut f32) {
    let told = Ink { colour: colour(frame.outcome), ..Ink::LIGHT };
    let left = tile.x as f32 + words.scaled(10.0);
    let mut line = |words: &mut LabelPlacer<'_>, text: String, bold: bool, ink: Ink| {
        let y = tile.y as f32 + tile.height as f32 - words.scaled(30.0 + 16.0 * *row);
        let size =
            if words.width(&text, 12.0, bold) > tile.width as f32 - words.scaled(20.0) { 9.0 } else { 12.0 };
        // In a picture that is smaller still it would run out of it.
        if words.width(&text, size, bold) > tile.width as f32 - words.scaled(12.0) {
            return;
        }
        words.write(text, [left, y], size, bold, ink);
        *row += 1.0;
    };
    if frame.outcome.seen() {
        let (r, [d, b, v]) = (frame.measurement.relative, frame.measurement.deviation);
        let angle = |x: f64, s: f64| {
            format!("{:.1}° ± {:.3}°", x.to_degrees(), s.to_degrees()).replace('-', "\u{2212}")
        };
        let numbers = format!(
            "ℓ {:.3} m ± {:.1} mm   ψ {}   γ {}",
            r.distance,
            1e3 * d,
            angle(r.bearing, b),
            angle(r.view_angle, v)
        );
        line(words, numbers, false, Ink::LIGHT);
    }
    let faces = match frame.faces() {
        0 => String::new(),
        1 => ", 1 face".to_owned(),
        n => format!(", {n} faces"),
    };
    line(words, format!("{leader}: {}{faces}", frame.outcome.word()), true, told);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::onboard::onboard;
    use crate::fleet_model::FleetModel;
    use crate::{Style, Trail};
    use glam::DVec3;
    use vocabulary::{Body, FleetInfo, Pose, RobotState, Snapshot, StepRecord};

    /// A leader that drives past, and a follower that drives and turns while its camera pans, at a time.
    fn record(time: f64, [turn, panning, passing]: [f64; 3]) -> StepRecord {
        let mut robots = vec![RobotState::default(); 2];
        robots[0].motion.pose = Pose::new(2.0, 0.5 + passing * (time - 0.5), 0.3);
        robots[1].motion.pose = Pose::new(0.4 * (time - 0.5), 0.0, turn * (time - 0.5));
        robots[1].camera_pan = 0.1 + panning * (time - 0.5);
        StepRecord { snapshot: Snapshot { time, robots, ..Snapshot::default() }, ..StepRecord::default() }
    }

    #[test]
    fn a_look_is_drawn_over_the_leader_though_the_camera_turns() {
        let member = |name: &str, leads: bool| RobotInfo::new(name, leads, Body::default());
        let edge = Edge { leader: 0, follower: 1 };
        let fleet = FleetInfo {
            robots: vec![member("a", true), member("b", false)],
            edges: vec![edge],
            ..FleetInfo::default()
        };
        let (model, trail, style) = (FleetModel::new(&fleet), Trail::new(&fleet), Style::default());
        for rates in [[0.0; 3], [0.0, 1.5, 0.0], [1.0, -1.5, 0.0], [0.8, 0.0, 0.0], [0.3, 0.2, 0.8]] {
            let (then, now) = (record(0.45, rates), record(0.5, rates));
            let context = PictureContext::new(&model, &trail, &now, &style);
            // The leader's middle, as the camera saw it at the measurement.
            let [leader, own] = [0, 1].map(|k| then.snapshot.robots[k]);
            let Pose { x, y, .. } = leader.motion.pose;
            let [x, y, z] = fleet.robots[1].camera_mount.world_from_camera(&own).inverse().apply([x, y, 0.2]);
            let frame = MeasurementRecord {
                truth: Relative::between(leader.motion.pose, own.motion.pose),
                pan: own.camera_pan,
                ..MeasurementRecord::default()
            };
            let camera = onboard(&now.snapshot, &fleet, 1, 4.0 / 3.0);
            let window = Window { camera: &camera, tile: Tile { x: 0, y: 0, width: 640, height: 480 } };
            let [right, down] = turned([x / z, y / z], turn_since(&context, &edge, &frame)).unwrap();
            let drawn = window.direction(right, -down);
            let Pose { x, y, .. } = now.snapshot.robots[0].motion.pose;
            let seen = window.pixel(DVec3::new(x, y, 0.2)).unwrap();
            // It has come a few millimetres nearer or gone as far away.
            assert!(drawn.distance(seen) < 1.0, "{rates:?}: {drawn} is not {seen}");
        }
    }
}
