//! What viewers draw, in Foxglove's own schemas: frames, bodies, set points, edges, ribbons, pictures.
//!
//! What stands still or moves with a frame is written once, on `/stage`; frames and lines follow about thirty times a
//! second, whole ribbons once a second. None of it is read back.

use super::pictures::Photo;
use super::solids;
use super::writer::{Channels, Stamp};
use crate::Error;
use foxglove::Encode;
use foxglove::messages::{
    CameraCalibration, Color, CompressedImage, FrameTransform, FrameTransforms, LinePrimitive, Point3,
    PoseInFrame, Quaternion, SceneEntity, SceneUpdate, Timestamp, Vector3, line_primitive::Type,
};
use std::collections::VecDeque;
use vocabulary::colours::robot_colours;
use vocabulary::{FleetInfo, Rigid, RobotState, Snapshot, StepRecord, math};

/// Drawings a second; fewer where there are many robots.
const RATE: f64 = 30.0;
/// Robots that are drawn at the full rate.
const FEW: usize = 20;
/// Length of ribbons, s, and their points.
const RIBBON: f64 = 12.0;
const RIBBON_POINTS: usize = 96;
/// Heights over the ground at which lines are drawn, m.
const LIFT: f64 = 0.02;

/// Makes drawings of moments.
pub(super) struct Drawing {
    fleet: FleetInfo,
    tf: u16,
    formation: u16,
    ribbons: u16,
    poses: Vec<u16>,
    /// Of robots whose cameras measure: calibration and pictures.
    cameras: Vec<Option<[u16; 2]>>,
    colours: Vec<Color>,
    frames: Vec<[String; 2]>,
    /// Frames of set points, per edge.
    goals: Vec<String>,
    next: f64,
    next_ribbon: f64,
    /// When ribbons were drawn last.
    drawn: f64,
    /// Where the robots were, and when.
    past: VecDeque<(f64, Vec<Point3>)>,
    buffer: Vec<u8>,
}

/// Adds a channel for messages of one of Foxglove's schemas.
fn channel<T: Encode>(topic: &str, to: &mut Channels) -> Result<u16, Error> {
    match T::get_schema() {
        Some(schema) => to.add(topic, &schema.name, &schema.data, 0),
        None => to.add(topic, "", &[], 0),
    }
}

fn put<T: Encode>(channel: u16, stamp: Stamp, message: &T, to: &mut Channels) -> Result<(), Error> {
    to.put(channel, stamp, |out| {
        // A growing buffer takes every message.
        let _ = message.encode(out);
    })
}

fn at(stamp: Stamp) -> Timestamp {
    let nanoseconds = stamp.nanoseconds();
    Timestamp::new((nanoseconds / 1_000_000_000) as u32, (nanoseconds % 1_000_000_000) as u32)
}

pub(super) fn point([x, y, z]: [f64; 3]) -> Point3 {
    Point3 { x, y, z }
}

impl Drawing {
    /// Adds channels to `to`, and draws what is never drawn again.
    pub(super) fn begin(fleet: &FleetInfo, to: &mut Channels) -> Result<Self, Error> {
        let colours: Vec<Color> =
            robot_colours(fleet).into_iter().map(|rgb| solids::colour(rgb, 1.0)).collect();
        let stage = channel::<SceneUpdate>("/stage", to)?;
        let entities = solids::entities(fleet, &colours);
        put(stage, Stamp::default(), &SceneUpdate { deletions: vec![], entities }, to)?;
        let mut drawing = Self {
            tf: channel::<FrameTransforms>("/tf", to)?,
            formation: channel::<SceneUpdate>("/scene", to)?,
            ribbons: channel::<SceneUpdate>("/ribbons", to)?,
            poses: vec![],
            cameras: vec![],
            frames: vec![],
            goals: solids::goal_frames(fleet),
            next: 0.0,
            next_ribbon: 0.0,
            drawn: 0.0,
            past: VecDeque::new(),
            buffer: vec![],
            colours,
            fleet: fleet.clone(),
        };
        for (index, member) in fleet.robots.iter().enumerate() {
            let frame = solids::robot_frame(member);
            drawing.poses.push(channel::<PoseInFrame>(&format!("/{frame}/pose"), to)?);
            let measurements = fleet.has_sensors && fleet.edges.iter().any(|edge| edge.follower == index);
            let camera = format!("{frame}/camera");
            drawing.cameras.push(if measurements {
                let calibration = channel::<CameraCalibration>(&format!("/{camera}/calibration"), to)?;
                Some([calibration, channel::<CompressedImage>(&format!("/{camera}/image"), to)?])
            } else {
                None
            });
            drawing.frames.push([frame, camera]);
        }
        Ok(drawing)
    }

    /// Draws a moment, if it is time.
    pub(super) fn record(
        &mut self,
        stamp: Stamp,
        record: &StepRecord,
        to: &mut Channels,
    ) -> Result<(), Error> {
        if stamp.time < self.next - 1e-6 {
            return Ok(());
        }
        let crowd = (self.fleet.robots.len() as f64 / FEW as f64).max(1.0);
        self.next += crowd / RATE;
        if self.next <= stamp.time {
            self.next = stamp.time + crowd / RATE;
        }
        let transforms = self.transforms(stamp, record);
        for (channel, (transform, frame)) in self.poses.iter().zip(transforms.iter().zip(&self.frames)) {
            debug_assert_eq!(transform.child_frame_id, frame[0]);
            let pose = PoseInFrame {
                timestamp: transform.timestamp,
                frame_id: solids::WORLD.to_owned(),
                pose: Some(foxglove::messages::Pose {
                    position: transform.translation,
                    orientation: transform.rotation,
                }),
            };
            put(*channel, stamp, &pose, to)?;
        }
        put(self.tf, stamp, &FrameTransforms { transforms }, to)?;
        let lifted = |robot: &RobotState| {
            let pose = robot.motion.pose;
            point([pose.x, pose.y, robot.attitude.height + LIFT])
        };
        let now: Vec<Point3> = record.snapshot.robots.iter().map(lifted).collect();
        if stamp.time >= self.next_ribbon - 1e-6 {
            self.next_ribbon = stamp.time + crowd.min(3.0);
            self.drawn = stamp.time;
            put(self.ribbons, stamp, &self.draw_ribbons(stamp, &now), to)?;
        }
        put(self.formation, stamp, &self.lines(stamp, record, &now), to)?;
        let spacing = RIBBON / RIBBON_POINTS as f64;
        if self.past.back().is_none_or(|(time, _)| stamp.time >= time + spacing - 1e-6) {
            self.past.push_back((stamp.time, now));
            while self.past.front().is_some_and(|(time, _)| *time < stamp.time - RIBBON) {
                self.past.pop_front();
            }
        }
        Ok(())
    }

    /// Robots first, in their order; then cameras, set points and props that can move.
    fn transforms(&self, stamp: Stamp, record: &StepRecord) -> Vec<FrameTransform> {
        let time = Some(at(stamp));
        let placed = |parent: &str, child: &str, [x, y, z]: [f64; 3], turn: Quaternion| FrameTransform {
            timestamp: time,
            parent_frame_id: parent.to_owned(),
            child_frame_id: child.to_owned(),
            translation: Some(Vector3 { x, y, z }),
            rotation: Some(turn),
        };
        let transform = |parent: &str, child: &str, frame: &Rigid| {
            placed(parent, child, frame.translation, quaternion(frame))
        };
        let Snapshot { robots, props, .. } = &record.snapshot;
        let seen = robots.iter().zip(&self.frames);
        let mut all: Vec<FrameTransform> =
            seen.map(|(robot, [name, _])| transform(solids::WORLD, name, &robot.world_from_body())).collect();
        for (index, (robot, member)) in robots.iter().zip(&self.fleet.robots).enumerate() {
            if let (Some(Some(_)), Some([name, camera])) = (self.cameras.get(index), self.frames.get(index)) {
                all.push(transform(name, camera, &member.camera_mount.body_from_camera(robot.camera_pan)));
            }
        }
        for ((edge, state), goal) in self.fleet.edges.iter().zip(&record.edges).zip(&self.goals) {
            let Some(leader) = robots.get(edge.leader) else { continue };
            let [distance, bearing] = state.set_point;
            let pose = leader.motion.pose;
            let [x, y] = pose.world_from_body(distance * math::cos(bearing), distance * math::sin(bearing));
            let z = self.fleet.surface(x, y).height + LIFT;
            all.push(transform(solids::WORLD, goal, &Rigid::turned([x, y, z], pose.heading, 0.0, 0.0)));
        }
        for (prop, place) in self.fleet.props.iter().zip(props) {
            if solids::moves(prop) {
                let [x, y, z, w] = place.rotation;
                let (frame, turn) = (solids::prop_frame(prop), Quaternion { x, y, z, w });
                all.push(placed(solids::WORLD, &frame, place.position, turn));
            }
        }
        all
    }

    /// Edges, and where robots have been since ribbons were drawn last.
    fn lines(&self, stamp: Stamp, record: &StepRecord, now: &[Point3]) -> SceneUpdate {
        let mut edges = LinePrimitive {
            r#type: Type::LineList.into(),
            thickness: 1.5,
            scale_invariant: true,
            color: Some(solids::colour([0.07, 0.09, 0.11], 0.7)),
            ..LinePrimitive::default()
        };
        let robots = &record.snapshot.robots;
        for edge in &self.fleet.edges {
            let middle = |robot: usize| {
                let (state, member) = (robots.get(robot)?, self.fleet.robots.get(robot)?);
                Some(point(state.world_from_body().apply([0.0, 0.0, 0.5 * member.body.height])))
            };
            edges.points.extend([edge.leader, edge.follower].into_iter().filter_map(middle));
        }
        let first = self.past.partition_point(|(time, _)| *time < self.drawn).saturating_sub(1);
        let recent = || self.past.iter().skip(first).map(|(_, points)| &**points).chain([now]);
        let mut entities = vec![entity(stamp, "edges", vec![edges])];
        let strips = (0..now.len()).map(|robot| self.strip(robot, recent()));
        entities.push(entity(stamp, "tails", strips.collect()));
        SceneUpdate { deletions: vec![], entities }
    }

    fn draw_ribbons(&self, stamp: Stamp, now: &[Point3]) -> SceneUpdate {
        let rows = || self.past.iter().map(|(_, points)| &**points).chain([now]);
        let strips = (0..now.len()).map(|robot| self.strip(robot, rows())).collect();
        SceneUpdate { deletions: vec![], entities: vec![entity(stamp, "ribbons", strips)] }
    }

    fn strip<'a>(&self, robot: usize, rows: impl Iterator<Item = &'a [Point3]>) -> LinePrimitive {
        LinePrimitive {
            r#type: Type::LineStrip.into(),
            thickness: 0.06,
            points: rows.filter_map(|points| points.get(robot)).copied().collect(),
            color: self.colours.get(robot).copied(),
            ..LinePrimitive::default()
        }
    }

    /// Writes a picture of a camera, with what is needed to measure in it.
    pub(super) fn photo(&mut self, photo: &Photo, to: &mut Channels) -> Result<(), Error> {
        let Some(Some([calibration, image])) = self.cameras.get(photo.robot) else { return Ok(()) };
        let (Some(member), Some([_, frame])) =
            (self.fleet.robots.get(photo.robot), self.frames.get(photo.robot))
        else {
            return Ok(());
        };
        let stamp = Stamp { number: 0, time: photo.time };
        let camera_model = &member.camera_model;
        let [cx, cy] = camera_model.centre;
        let message = CameraCalibration {
            timestamp: Some(at(stamp)),
            frame_id: frame.clone(),
            width: camera_model.width,
            height: camera_model.height,
            // As light falls on the glass: what the glass does comes after it.
            distortion_model: "plumb_bob".to_owned(),
            d: vec![0.0; 5],
            k: vec![camera_model.focal, 0.0, cx, 0.0, camera_model.focal, cy, 0.0, 0.0, 1.0],
            r: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            p: vec![camera_model.focal, 0.0, cx, 0.0, 0.0, camera_model.focal, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        };
        put(*calibration, stamp, &message, to)?;
        self.buffer.clear();
        if photo.png(camera_model, &mut self.buffer).is_some() {
            let message = CompressedImage {
                timestamp: Some(at(stamp)),
                frame_id: frame.clone(),
                data: self.buffer.clone().into(),
                format: "png".to_owned(),
            };
            put(*image, stamp, &message, to)?;
        }
        Ok(())
    }
}

fn entity(stamp: Stamp, id: &str, lines: Vec<LinePrimitive>) -> SceneEntity {
    SceneEntity {
        timestamp: Some(at(stamp)),
        frame_id: solids::WORLD.to_owned(),
        id: id.to_owned(),
        lines,
        ..SceneEntity::default()
    }
}

/// The turn of a frame as a unit quaternion, by the largest of its squares.
fn quaternion(frame: &Rigid) -> Quaternion {
    let [[a, b, c], [d, e, f], [g, h, i]] = frame.rotation;
    let trace = a + e + i;
    let biggest = trace.max(a).max(e).max(i);
    let (x, y, z, w) = if biggest == trace {
        (h - f, c - g, d - b, 1.0 + trace)
    } else if biggest == a {
        (1.0 + a - e - i, b + d, c + g, h - f)
    } else if biggest == e {
        (b + d, 1.0 + e - a - i, f + h, c - g)
    } else {
        (c + g, f + h, 1.0 + i - a - e, d - b)
    };
    let norm = (x * x + y * y + z * z + w * w).sqrt();
    Quaternion { x: x / norm, y: y / norm, z: z / norm, w: w / norm }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quaternions_turn_as_their_matrices_do() {
        for k in 0..64 {
            let t = f64::from(k);
            let frame = Rigid::turned([0.0; 3], t * 0.71, t * 1.13, t * 2.3);
            let Quaternion { x, y, z, w } = quaternion(&frame);
            let v = [0.3, -1.2, 0.5];
            let cross = |a: [f64; 3], b: [f64; 3]| {
                [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
            };
            let once = cross([x, y, z], v);
            let twice = cross([x, y, z], [0, 1, 2].map(|k| once[k] + w * v[k]));
            for (k, want) in frame.turn(v).into_iter().enumerate() {
                assert!((v[k] + 2.0 * twice[k] - want).abs() < 1e-12, "turn {t}");
            }
        }
    }
}
