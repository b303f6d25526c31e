//! Pictures of a shell with tags, cast ray by ray: 8 by 8 of them to a pixel, in linear light.
use perception::imaging::{IdealPicture, ImageSensor, NoiseStream, Optics, Purpose, noise_stream};
use perception::pose::Rig;
use vocabulary::math;
use vocabulary::{
    Body, CameraModel, CameraMount, FACES, Grey, Pose, Region, Rigid, Shell, TAG_CELLS, tag_cell, wrap,
};

const RAYS: usize = 8;

/// A leader to be looked at.
pub(crate) struct Scene {
    pub(crate) rig: Rig,
    pub(crate) pose: Pose,
    /// Leader's body in the camera.
    pub(crate) camera_from_body: Rigid,
    /// Faces turned towards the camera by less than 65°, entirely in the picture.
    pub(crate) visible: Vec<usize>,
    /// Light that falls on the faces.
    light: [f64; FACES],
    /// Edges and waves of the background.
    clutter: Vec<[f64; 5]>,
}

pub(crate) struct Scenes {
    stream: NoiseStream,
    pub(crate) camera_model: CameraModel,
}

impl Scenes {
    pub(crate) fn seeded(seed: u64) -> Self {
        Self { stream: noise_stream(seed, 0, 0, Purpose::Setup), camera_model: CameraModel::default() }
    }

    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.stream.uniform()
    }

    /// A leader `distance` m away with a heading under which some face shows, the camera turned towards it but for 6°.
    pub(crate) fn next(&mut self, distance: f64) -> Scene {
        let bearing = self.uniform(-0.6, 0.6);
        let pan = bearing + self.uniform(-0.1, 0.1);
        // ψ from 30° to 180°, either side.
        let behind = self.uniform(30_f64.to_radians(), std::f64::consts::PI);
        let behind = if self.stream.uniform() < 0.5 { behind } else { -behind };
        let heading = wrap(bearing + std::f64::consts::PI - behind);
        let pose = Pose::new(distance * math::cos(bearing), distance * math::sin(bearing), heading);
        let robot = (self.stream.uniform() * 117.0) as usize;
        let rig = Rig {
            shell: Shell::PAPER.tagged(robot),
            camera_model: self.camera_model,
            body_from_camera: CameraMount::fitting(&Body::default()).body_from_camera(pan),
        };
        let light = std::array::from_fn(|_| self.uniform(0.55, 1.0));
        let clutter = (0..12)
            .map(|_| {
                [
                    self.uniform(0.0, 640.0),
                    self.uniform(0.0, 480.0),
                    self.uniform(4.0, 60.0),
                    self.uniform(4.0, 60.0),
                    self.uniform(0.1, 0.75),
                ]
            })
            .collect();
        Scene::new(rig, pose, light, clutter)
    }
}

impl Scene {
    pub(crate) fn new(rig: Rig, pose: Pose, light: [f64; FACES], clutter: Vec<[f64; 5]>) -> Self {
        let body = Rigid::turned([pose.x, pose.y, 0.0], pose.heading, 0.0, 0.0);
        let camera_from_body = rig.body_from_camera.inverse().after(&body);
        let mut scene = Self { rig, pose, camera_from_body, visible: vec![], light, clutter };
        scene.visible = (0..FACES).filter(|face| scene.shows(*face)).collect();
        scene
    }

    fn shows(&self, face: usize) -> bool {
        let tag = self.camera_from_body.after(&self.rig.shell.body_from_face(face));
        let (out, at) = (tag.turn([0.0, 0.0, 1.0]), tag.translation);
        let range = at.iter().map(|x| x * x).sum::<f64>().sqrt();
        let cosine = -(0..3).map(|k| out[k] * at[k]).sum::<f64>() / range;
        let inside = |p: [f64; 2]| self.rig.camera_model.holds(p, 8.0);
        cosine > math::cos(65_f64.to_radians())
            && self.corners(face).is_some_and(|c| c.into_iter().all(inside))
    }

    /// Where the corners of a face's tag are, pixels.
    pub(crate) fn corners(&self, face: usize) -> Option<[[f64; 2]; 4]> {
        let at = self
            .rig
            .shell
            .tag_corners(face)
            .map(|c| self.rig.camera_model.project(self.camera_from_body.apply(c)));
        let [Some(a), Some(b), Some(c), Some(d)] = at else { return None };
        Some([a, b, c, d])
    }

    /// The part of the picture a tracker would look at: where the shell is, a fifth of its size around it.
    pub(crate) fn region(&self) -> Region {
        let [low, high] = self.extent();
        let more = 0.2 * (high[0] - low[0]).max(high[1] - low[1]) + 6.0;
        let size = [self.rig.camera_model.width, self.rig.camera_model.height];
        let from = [0, 1].map(|k| (low[k] - more).clamp(0.0, f64::from(size[k] - 32)) as u32);
        let until = [0, 1].map(|k| (high[k] + more).clamp(0.0, f64::from(size[k])) as u32);
        let span = [0, 1].map(|k| until[k].saturating_sub(from[k]).max(32));
        Region { x: from[0], y: from[1], width: span[0], height: span[1] }
    }

    /// Bounds of the shell in the picture, pixels.
    fn extent(&self) -> [[f64; 2]; 2] {
        let mut out = [[f64::INFINITY; 2], [-f64::INFINITY; 2]];
        for face in 0..FACES {
            let frame = self.camera_from_body.after(&self.rig.shell.body_from_face(face));
            for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                let [x, y] = [x * 0.085, y * 0.083];
                let Some(p) = self.rig.camera_model.project(frame.apply([x, y, 0.0])) else { continue };
                for k in 0..2 {
                    out[0][k] = out[0][k].min(p[k]);
                    out[1][k] = out[1][k].max(p[k]);
                }
            }
        }
        out
    }

    /// Light of the background at a pixel of the ideal picture.
    fn behind(&self, x: f64, y: f64) -> f64 {
        let ground = if y > 200.0 { 0.45 } else { 0.6 };
        let waves =
            0.05 * math::sin(0.21 * x + 0.4 * math::sin(0.05 * y)) + 0.04 * math::cos(0.13 * y + 0.07 * x);
        let on = |c: &&[f64; 5]| (x - c[0]).abs() < c[2] && (y - c[1]).abs() < c[3];
        self.clutter.iter().find(on).map_or(ground + waves, |c| c[4])
    }

    /// The ideal picture a sensor needs.
    pub(crate) fn ideal(&self, source: &IdealPicture) -> Grey {
        let shell = &self.rig.shell;
        let frames: Vec<_> = (0..FACES)
            .map(|face| self.camera_from_body.after(&shell.body_from_face(face)).inverse())
            .collect();
        let half_face = 0.5 * shell.face_height / math::cos(shell.lean);
        let focal = self.rig.camera_model.focal;
        let fleet = |x: f64, y: f64| -> Option<f64> {
            let ray = [(x - source.centre[0]) / focal, (y - source.centre[1]) / focal, 1.0];
            for (face, frame) in frames.iter().enumerate() {
                let (from, along) = (frame.translation, frame.turn(ray));
                if from[2] <= 0.0 || along[2] >= 0.0 {
                    continue;
                }
                let t = -from[2] / along[2];
                let (u, v) = (from[0] + t * along[0], from[1] + t * along[1]);
                if v.abs() > half_face || u.abs() > shell.half_width(v) {
                    continue;
                }
                let middle = 0.5 * TAG_CELLS as f64;
                let (column, row) = (u / shell.cell + middle, middle - v / shell.cell);
                let tag = shell.first_tag.map_or(0, |first| first + face as u16);
                let white = (column >= 0.0 && row >= 0.0)
                    .then(|| tag_cell(tag, column as usize, row as usize))
                    .flatten()
                    .filter(|_| column < TAG_CELLS as f64 && row < TAG_CELLS as f64);
                return Some(self.light[face] * white.map_or(0.35, |white| if white { 0.85 } else { 0.04 }));
            }
            None
        };
        let Region { width, height, .. } = source.region;
        let [low, high] = self.extent();
        // A distorting lens moves the shell in the ideal picture by less than this.
        let around = if self.rig.camera_model.distorts() { 60.0 } else { 3.0 };
        let value = |k: u32| {
            let (x, y) = (f64::from(k % width), f64::from(k / width));
            let (fx, fy) = (x + f64::from(source.corner[0]), y + f64::from(source.corner[1]));
            let near = fx > low[0] - around
                && fx < high[0] + around
                && fy > low[1] - around
                && fy < high[1] + around;
            let back = self.behind(fx, fy);
            if !near {
                return (255.0 * back + 0.5) as u8;
            }
            let mut sum = 0.0;
            for ray in 0..RAYS * RAYS {
                let at = |k: usize| (k as f64 + 0.5) / RAYS as f64 - 0.5;
                sum += fleet(x + at(ray % RAYS), y + at(ray / RAYS)).unwrap_or(back);
            }
            (255.0 * sum / (RAYS * RAYS) as f64 + 0.5) as u8
        };
        Grey { width, height, values: (0..width * height).map(value).collect() }
    }

    /// What a sensor makes of it.
    pub(crate) fn picture(&self, sensor: &mut ImageSensor, region: Region, frame: u64) -> Grey {
        let ideal = self.ideal(&sensor.source(region));
        let mut picture = Grey::default();
        sensor.expose(&ideal, region, &mut noise_stream(1, 0, frame, Purpose::Pixels), &mut picture);
        picture
    }
}

pub(crate) fn sensor(camera_model: CameraModel) -> ImageSensor {
    ImageSensor::new(Optics { camera_model, ..Optics::default() })
}
