//! One follower's camera: what its pictures show in truth, and what we find in them.

use crate::dataset::forms::{LabelledTag, camera, carrier, found, frame};
use crate::dataset::view::{FaceView, region_around, walls_hide};
use perception::detect::{Detector, Locus, Tag, identify, recognise, sharpen};
use perception::imaging::{ImageSensor, Optics, Purpose, noise_stream};
use perception::pose::{PoseEstimate, Prior, Rig, locate};
use perception::sensors::SensorConfig;
use serde_json::{Value, json};
use vocabulary::{Edge, FACES, FleetInfo, Grey, Pose, Region, RobotState, Shell, Snapshot, math, wrap};

/// Standard deviation of a corner's coordinates as found in pictures, besides what its finder reports, pixels; what
/// cameras that steer by them assume.
pub(crate) const CORNER_NOISE: f64 = 0.02;

/// Along each side of a tag, how many points are tried for being hidden.
const POINTS: u32 = 5;

/// A follower's camera.
pub(crate) struct FollowerCamera {
    pub(crate) edge: Edge,
    pub(crate) sensor: ImageSensor,
    detector: Locus,
    /// How far bodies are expected to tilt against each other, rad.
    tilt: f64,
    /// Whether the leader is looked for in the whole picture.
    whole: bool,
}

/// A picture and the moment it shows.
pub(crate) struct LabelledPicture<'a> {
    pub(crate) file: String,
    pub(crate) picture: &'a Grey,
    pub(crate) snapshot: &'a Snapshot,
}

impl FollowerCamera {
    pub(crate) fn new(edge: Edge, optics: Optics, tilt: f64, whole: bool) -> Self {
        Self { edge, sensor: ImageSensor::new(optics), detector: Locus::new(), tilt, whole }
    }

    pub(crate) fn describe(&self, fleet: &FleetInfo) -> Value {
        let [leader, robot] = [self.edge.leader, self.edge.follower].map(|k| fleet.robots[k].name.as_str());
        camera(robot, leader, &self.sensor.optics().camera_model)
    }

    /// The sensor's picture of `light`, the `number`th of this camera.
    pub(crate) fn expose(&mut self, light: &Grey, seed: u64, number: u64) -> Grey {
        let mut random = noise_stream(seed, self.edge.follower, number, Purpose::Pixels);
        let mut picture = Grey::default();
        let whole = Region::whole(&self.sensor.optics().camera_model);
        self.sensor.expose(light, whole, &mut random, &mut picture);
        picture
    }

    /// Every tag that is turned towards the camera and lies in its picture.
    pub(crate) fn labels(
        &self,
        fleet: &FleetInfo,
        sensor_config: &SensorConfig,
        snapshot: &Snapshot,
    ) -> Vec<LabelledTag> {
        let follower = self.edge.follower;
        let camera_model = &self.sensor.optics().camera_model;
        let world_from_camera =
            fleet.robots[follower].camera_mount.world_from_camera(&snapshot.robots[follower]);
        let camera_from_world = world_from_camera.inverse();
        let own = fleet.robots[follower].shell;
        let own_from_world = snapshot.robots[follower].world_from_body().inverse();
        let mut labels = Vec::new();
        for (robot, (member, state)) in fleet.robots.iter().zip(&snapshot.robots).enumerate() {
            let Some((shell, first)) = member.shell.and_then(|s| Some((s, s.first_tag?))) else { continue };
            if robot == follower {
                continue;
            }
            let world_from_body = state.world_from_body();
            let camera_from_body = camera_from_world.after(&world_from_body);
            for (face, id) in (0..FACES).zip(first..) {
                let Some(view) = FaceView::of(&shell, camera_model, &camera_from_body, face) else {
                    continue;
                };
                let world_from_tag = world_from_body.after(&shell.body_from_face(face));
                let hides = |x: f64, y: f64| {
                    let (from, to) = (world_from_camera.translation, world_from_tag.apply([x, y, 0.0]));
                    let walls = own.is_some_and(|shell| {
                        walls_hide(&shell, own_from_world.apply(from), own_from_world.apply(to))
                    });
                    walls || sensor_config.scenery().hides(snapshot, [follower, robot], from, to).is_some()
                };
                let h = shell.half_tag();
                let hidden = [[-h, h], [h, h], [h, -h], [-h, -h]].map(|[x, y]| hides(x, y));
                let at = |k: u32| h * (2.0 * f64::from(k) / f64::from(POINTS - 1) - 1.0);
                let grid = (0..POINTS).flat_map(|row| (0..POINTS).map(move |column| (at(column), at(row))));
                let count = grid.filter(|(x, y)| hides(*x, *y)).count();
                let readable = view.readable(camera_model);
                let hidden_share = count as f64 / f64::from(POINTS * POINTS);
                labels.push(LabelledTag { id, robot, face, view, readable, hidden, hidden_share });
            }
        }
        labels
    }

    /// All that is written about a picture.
    pub(crate) fn note(
        &mut self,
        fleet: &FleetInfo,
        labels: &[LabelledTag],
        taken: &LabelledPicture<'_>,
    ) -> Value {
        let (follower, snapshot) = (self.edge.follower, taken.snapshot);
        let (member, state) = (&fleet.robots[follower], &snapshot.robots[follower]);
        json!({
            "file": taken.file, "time": snapshot.time, "robot": member.name,
            "world_from_camera": frame(&member.camera_mount.world_from_camera(state)),
            "body_from_camera": frame(&member.camera_mount.body_from_camera(state.camera_pan)),
            "tags": labels.iter().map(|label| label.as_json(fleet)).collect::<Vec<_>>(),
            "detected": self.detected(fleet, taken.picture),
            "leader": self.leader(fleet, taken),
        })
    }

    /// Our detector's tags in the whole picture, whoever carries them.
    fn detected(&mut self, fleet: &FleetInfo, picture: &Grey) -> Vec<Value> {
        let optics = *self.sensor.optics();
        let mut tags: Vec<Tag> = vec![];
        self.detector.detect(picture, &mut tags);
        self.detector.detect_in_shade(picture, &mut tags);
        sharpen(picture, Region::whole(&optics.camera_model), &optics, &mut tags);
        let shells = fleet.robots.iter().filter_map(|member| member.shell);
        let accepted: Vec<_> = shells
            .flat_map(|shell| identify(&tags, &shell).into_iter().map(move |seen| (shell, seen)))
            .collect();
        let known = |tag: &Tag| {
            accepted
                .iter()
                .any(|(shell, seen)| shell.face_of(tag.id) == Some(seen.face) && seen.corners == tag.corners)
        };
        tags.iter().map(|tag| found(fleet, tag, carrier(fleet, tag.id).is_some() && known(tag))).collect()
    }

    /// Where the leader is in the follower's frame, and where we think it is.
    fn leader(&mut self, fleet: &FleetInfo, taken: &LabelledPicture<'_>) -> Value {
        let Edge { leader, follower } = self.edge;
        let [ahead, own] = [leader, follower].map(|robot| taken.snapshot.robots[robot]);
        let truth = relative_pose(&ahead.motion.pose, &own.motion.pose);
        let name = fleet.robots[leader].name.as_str();
        let mut note = json!({ "robot": name, "truth": placed(&truth), "faces": [], "estimate": null });
        let Some(shell) = fleet.robots[leader].shell else { return note };
        let camera_mount = fleet.robots[follower].camera_mount;
        let camera_model = self.sensor.optics().camera_model;
        let rig =
            Rig { shell, camera_model, body_from_camera: camera_mount.body_from_camera(own.camera_pan) };
        let region = self.region(&shell, &rig, &own, &ahead);
        let part = cut(taken.picture, region);
        let optics = *self.sensor.optics();
        let faces = recognise(&mut self.detector, &part, region, &optics, &shell, FACES);
        note["faces"] = faces
            .iter()
            .map(|seen| json!({ "face": seen.face, "corners": seen.corners, "deviation": seen.deviation }))
            .collect();
        note["region"] = json!([region.x, region.y, region.width, region.height]);
        let prior = Prior { tilt: self.tilt, height: 0.0 };
        if let Some(estimate) = locate(&rig, &faces, CORNER_NOISE, &prior, None) {
            note["estimate"] = estimated(&estimate, &truth);
        }
        note
    }

    fn region(&self, shell: &Shell, rig: &Rig, own: &RobotState, ahead: &RobotState) -> Region {
        if self.whole {
            return Region::whole(&rig.camera_model);
        }
        let world_from_camera = own.world_from_body().after(&rig.body_from_camera);
        region_around(shell, &rig.camera_model, &world_from_camera.inverse().after(&ahead.world_from_body()))
    }
}

/// `pose` in the frame of `of`; both are on the plane.
pub(crate) fn relative_pose(pose: &Pose, of: &Pose) -> Pose {
    let (sin, cos) = math::sin_cos(of.heading);
    let (dx, dy) = (pose.x - of.x, pose.y - of.y);
    Pose::new(dx * cos + dy * sin, dy * cos - dx * sin, wrap(pose.heading - of.heading))
}

fn placed(pose: &Pose) -> Value {
    json!({
        "x": pose.x, "y": pose.y, "heading": pose.heading,
        "range": math::hypot(pose.x, pose.y), "bearing": math::atan2(pose.y, pose.x),
    })
}

/// By how much a pose is off in range (m), bearing and heading (rad).
pub(crate) fn errors(found: &Pose, truth: &Pose) -> [f64; 3] {
    [
        math::hypot(found.x, found.y) - math::hypot(truth.x, truth.y),
        wrap(math::atan2(found.y, found.x) - math::atan2(truth.y, truth.x)),
        wrap(found.heading - truth.heading),
    ]
}

fn estimated(estimate: &PoseEstimate, truth: &Pose) -> Value {
    let [range, bearing, heading] = errors(&estimate.pose, truth);
    let mut value = placed(&estimate.pose);
    value["errors"] = json!({ "range": range, "bearing": bearing, "heading": heading });
    value["covariance"] = json!(estimate.covariance);
    value["residual"] = json!(estimate.residual);
    value["ambiguous"] = json!(estimate.ambiguous);
    value["raw_posit"] = estimate.raw.map_or(Value::Null, |pose| placed(&pose));
    value
}

/// A part of a picture; what lies outside of it is left out.
fn cut(picture: &Grey, region: Region) -> Grey {
    let across = picture.width as usize;
    let (from, until) = (region.x as usize, (region.x + region.width) as usize);
    let rows = picture.values.chunks_exact(across.max(1));
    let rows = rows.skip(region.y as usize).take(region.height as usize);
    let values = rows.flat_map(|row| row.get(from..until).unwrap_or_default()).copied().collect();
    Grey { width: region.width, height: region.height, values }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn poses_are_told_in_the_followers_frame() {
        let pose = relative_pose(&Pose::new(1.0, 4.0, 0.3), &Pose::new(1.0, 2.0, FRAC_PI_2));
        assert!((pose.x - 2.0).abs() < 1e-12 && pose.y.abs() < 1e-12, "{pose:?}");
        assert!((pose.heading - (0.3 - FRAC_PI_2)).abs() < 1e-12);
        let [range, bearing, heading] = errors(&Pose::new(0.0, 2.1, 0.1), &Pose::new(2.0, 0.0, 0.3));
        assert!((range - 0.1).abs() < 1e-12 && (bearing - FRAC_PI_2).abs() < 1e-12);
        assert!((heading + 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_cut_has_the_pixels_it_should() {
        let picture = Grey { width: 4, height: 3, values: (0..12).collect() };
        let part = cut(&picture, Region { x: 1, y: 1, width: 2, height: 2 });
        assert_eq!(part, Grey { width: 2, height: 2, values: vec![5, 6, 9, 10] });
        assert!(cut(&picture, Region { x: 3, y: 2, width: 2, height: 2 }).values.is_empty());
    }
}
