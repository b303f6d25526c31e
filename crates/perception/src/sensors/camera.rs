//! Pictures: which part to take, what the sensor makes of the light, and the tags in it.

use super::{Exposure, SensorConfig, pan};
use crate::detect::{Locus, recognise};
use crate::imaging::{ImageSensor, Optics, Purpose, gather, noise_stream};
use crate::pose::{Rig, SeenFace};
use vocabulary::{CameraModel, CameraRenderer, FACES, Grey, Region, Rigid, Shot, Snapshot};

/// How cameras turn and take pictures; the lens and the mount are each robot's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraSettings {
    /// Standard deviation of the blur, pixels.
    pub blur: f64,
    /// Standard deviation of a pixel's noise, share of full scale.
    pub noise: f64,
    /// Factor on the light.
    pub exposure: f64,
    /// Time over which a picture gathers light, s.
    pub shutter: f64,
    /// Fastest turn on the mast, rad/s.
    pub pan_rate: f64,
    /// Farthest turn from straight ahead, rad.
    pub pan_max: f64,
    /// Whether every measurement takes in the whole picture.
    pub whole_frames: bool,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self {
            blur: 0.7,
            noise: 3.0 / 255.0,
            exposure: 1.0,
            shutter: 0.0,
            pan_rate: std::f64::consts::TAU,
            pan_max: 170_f64.to_radians(),
            whole_frames: false,
        }
    }
}

/// What was found in one picture.
pub(super) struct CameraDetection {
    pub(super) region: Region,
    pub(super) faces: Vec<SeenFace>,
}

/// What turns light into tags, kept from picture to picture; it remembers nothing that a result depends on.
#[derive(Default)]
pub(super) struct CameraPipeline {
    /// One for each thread.
    benches: Vec<DetectorBench>,
}

/// Where one picture after the other is developed.
#[derive(Default)]
struct DetectorBench {
    /// By lens: robots may have different ones.
    sensors: Vec<ImageSensor>,
    detector: Locus,
    picture: Grey,
}

impl Clone for CameraPipeline {
    /// An empty one does as well.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl CameraPipeline {
    /// As many benches as threads can work on `pictures` at once, at least one.
    fn benches(&mut self, pictures: usize) -> &mut [DetectorBench] {
        let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let wanted = threads.min(pictures).max(1);
        while self.benches.len() < wanted {
            self.benches.push(DetectorBench::default());
        }
        &mut self.benches[..wanted]
    }
}

impl DetectorBench {
    /// The sensor behind a lens.
    fn sensor(&mut self, camera_model: &CameraModel, model: &CameraSettings) -> &mut ImageSensor {
        let optics = Optics { camera_model: *camera_model, blur: model.blur, noise: model.noise };
        let known = self.sensors.iter().position(|sensor| *sensor.optics() == optics);
        let index = known.unwrap_or_else(|| {
            self.sensors.push(ImageSensor::new(optics));
            self.sensors.len() - 1
        });
        &mut self.sensors[index]
    }

    /// The tags of the leader in one picture, from the light that fell on the sensor.
    fn develop(
        &mut self,
        model: &CameraSettings,
        sensor_config: &SensorConfig,
        exposure: &Exposure<'_>,
        region: Region,
        light: &Grey,
    ) -> CameraDetection {
        let mut random =
            noise_stream(sensor_config.seed, exposure.follower, exposure.number, Purpose::Pixels);
        let mut picture = std::mem::take(&mut self.picture);
        let sensor = self.sensor(&sensor_config.robots[exposure.follower].camera_model, model);
        sensor.expose(light, region, &mut random, &mut picture);
        let optics = *sensor.optics();
        let faces = sensor_config.rig(exposure).map_or_else(Vec::new, |rig| {
            let expected = readable(&rig, exposure).unwrap_or(FACES);
            recognise(&mut self.detector, &picture, region, &optics, &rig.shell, expected)
        });
        self.picture = picture;
        CameraDetection { region, faces }
    }
}

/// What is looked at reaches this share of the shell's size beyond where it is expected, and this many pixels.
const MARGIN: (f64, f64) = (0.12, 12.0);
/// Sides of regions are whole multiples of this, so that few sizes occur.
const GRID: u32 = 16;

/// Standard deviation of a corner's coordinates as found in pictures, besides what its finder reports, pixels.
pub(super) const CORNER_NOISE: f64 = 0.02;

impl CameraSettings {
    /// Takes the pictures of all exposures of one instant and finds the leaders' tags in them.
    pub(super) fn see(
        &self,
        sensor_config: &SensorConfig,
        exposures: &[&Exposure<'_>],
        period: [&Snapshot; 2],
        eyes: &mut dyn CameraRenderer,
        camera_pipeline: &mut CameraPipeline,
    ) -> Result<Vec<CameraDetection>, String> {
        let regions: Vec<Region> =
            exposures.iter().map(|exposure| self.region(sensor_config, exposure)).collect();
        let benches = camera_pipeline.benches(exposures.len());
        let pictures = self.light(sensor_config, exposures, &regions, period, eyes, &mut benches[0])?;
        let jobs: Vec<_> = exposures.iter().zip(regions.into_iter().zip(&pictures)).collect();
        let threads = benches.len();
        let mut found: Vec<Option<CameraDetection>> = jobs.iter().map(|_| None).collect();
        // Every thread takes every so manieth picture; who develops it makes no difference to what is found.
        std::thread::scope(|scope| {
            let mut work = Vec::new();
            for (first, bench) in benches.iter_mut().enumerate() {
                let own = jobs.iter().enumerate().skip(first).step_by(threads);
                let task = move || -> Vec<(usize, CameraDetection)> {
                    own.map(|(k, (exposure, (region, light)))| {
                        (k, bench.develop(self, sensor_config, exposure, *region, light))
                    })
                    .collect()
                };
                work.push(if first + 1 < threads { Err(scope.spawn(task)) } else { Ok(task()) });
            }
            for done in work {
                let done =
                    done.or_else(|thread| thread.join().map_err(|_| "a thread that looks for tags failed"))?;
                for (k, seen) in done {
                    found[k] = Some(seen);
                }
            }
            Ok::<(), &str>(())
        })?;
        Ok(found.into_iter().flatten().collect())
    }

    /// The light that falls on the sensors: ideal pictures of what each lens needs to see its region.
    fn light(
        &self,
        sensor_config: &SensorConfig,
        exposures: &[&Exposure<'_>],
        regions: &[Region],
        [before, after]: [&Snapshot; 2],
        eyes: &mut dyn CameraRenderer,
        bench: &mut DetectorBench,
    ) -> Result<Vec<Grey>, String> {
        let mut shots = |snapshot: &Snapshot| -> Vec<Shot> {
            let shot = |(exposure, region): (&&Exposure<'_>, &Region)| {
                let (robot, info) = (exposure.follower, &sensor_config.robots[exposure.follower]);
                let source = bench.sensor(&info.camera_model, self).source(*region);
                source.shot(robot, info, &snapshot.robots[robot], self.exposure)
            };
            exposures.iter().zip(regions).map(shot).collect()
        };
        let Some(first) = exposures.first() else { return Ok(Vec::new()) };
        let (now, period) = (first.snapshot, after.time - before.time);
        // At the start of the run nothing has moved yet.
        let shutter = if period > 0.0 { self.shutter } else { 0.0 };
        gather(shutter, |off, pictures| {
            if off == 0.0 {
                eyes.render(now, &shots(now), pictures)?;
                return checked(pictures, exposures.len());
            }
            let mut then = Snapshot::between(before, after, (now.time + off - before.time) / period);
            for (robot, now) in then.robots.iter_mut().zip(&now.robots) {
                robot.camera_pan = now.camera_pan;
            }
            for exposure in exposures {
                if let Some(robot) = then.robots.get_mut(exposure.follower) {
                    robot.camera_pan += exposure.pan_rate * off;
                }
            }
            eyes.render(&then, &shots(&then), pictures)?;
            checked(pictures, exposures.len())
        })
    }

    /// Where the leader is expected to be seen; the whole picture where that is not known.
    fn region(&self, sensor_config: &SensorConfig, exposure: &Exposure<'_>) -> Region {
        let camera_model = &sensor_config.robots[exposure.follower].camera_model;
        let whole = Region::whole(camera_model);
        if self.whole_frames || !exposure.seen {
            return whole;
        }
        let bounds = sensor_config.rig(exposure).and_then(|rig| expected(&rig, exposure));
        bounds.and_then(|bounds| fitted(camera_model, bounds)).unwrap_or(whole)
    }
}

fn checked(pictures: &[Grey], wanted: usize) -> Result<(), String> {
    if pictures.len() == wanted {
        return Ok(());
    }
    Err(format!("{wanted} pictures were to be taken, and {} came", pictures.len()))
}

/// The leader's frame in the camera's, as the follower expects it.
fn camera_from_expected(rig: &Rig, exposure: &Exposure<'_>) -> Option<Rigid> {
    let pose = pan::leader_pose(&exposure.expected?);
    let body_from_leader = Rigid::turned([pose.x, pose.y, 0.0], pose.heading, 0.0, 0.0);
    Some(rig.body_from_camera.inverse().after(&body_from_leader))
}

/// How many faces can surely be read where the leader is expected; `None` where that is not known.
fn readable(rig: &Rig, exposure: &Exposure<'_>) -> Option<usize> {
    let (shell, from_leader) = (rig.shell, camera_from_expected(rig, exposure)?);
    let surely = |face: usize| {
        let camera = from_leader.after(&shell.body_from_face(face)).inverse().translation;
        let away = camera.iter().map(|x| x * x).sum::<f64>().sqrt();
        camera[2] > SURELY.0 * away && rig.camera_model.focal * shell.cell > SURELY.1 * away
    };
    exposure.seen.then(|| (0..FACES).filter(|face| surely(*face)).count().max(1))
}

/// Cosine of the angle from its normal, and pixels a cell, at which a face is surely read.
const SURELY: (f64, f64) = (0.55, 2.0);

/// Smallest and largest column and row of the leader's tags where the follower expects them.
fn expected(rig: &Rig, exposure: &Exposure<'_>) -> Option<[[f64; 2]; 2]> {
    let camera_from_leader = camera_from_expected(rig, exposure)?;
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for corner in (0..FACES).flat_map(|face| rig.shell.tag_corners(face)) {
        let pixel = rig.camera_model.project(camera_from_leader.apply(corner))?;
        for k in 0..2 {
            bounds[0][k] = bounds[0][k].min(pixel[k]);
            bounds[1][k] = bounds[1][k].max(pixel[k]);
        }
    }
    Some(bounds)
}

/// The region around some bounds, with a margin, cut at the edges of the picture; `None` where nothing is left.
fn fitted(camera_model: &CameraModel, [low, high]: [[f64; 2]; 2]) -> Option<Region> {
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let margin = MARGIN.0 * size + MARGIN.1;
    let along = |k: usize, pixels: u32| {
        let first = ((low[k] - margin).max(0.0) as u32).min(pixels);
        let last = ((high[k] + margin).max(0.0) as u32).min(pixels);
        let first = first / GRID * GRID;
        let length = (last.checked_sub(first)?).next_multiple_of(GRID).min(pixels - first);
        (length >= 2 * GRID).then_some((first, length))
    };
    if !size.is_finite() {
        return None;
    }
    let ((x, width), (y, height)) = (along(0, camera_model.width)?, along(1, camera_model.height)?);
    Some(Region { x, y, width, height })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_hold_what_is_expected_and_stay_in_the_picture() {
        let camera_model = CameraModel::default();
        let region = fitted(&camera_model, [[300.0, 200.0], [420.0, 260.0]]).expect("a region");
        let margin = MARGIN.0 * 120.0 + MARGIN.1;
        let ends = [(region.x, region.width, 300.0, 420.0), (region.y, region.height, 200.0, 260.0)];
        for (first, length, low, high) in ends {
            assert!(
                f64::from(first) <= low - margin && f64::from(first + length) >= high + margin,
                "{region:?}"
            );
        }
        assert!(region.width.is_multiple_of(GRID) && region.height.is_multiple_of(GRID));
        let cut = fitted(&camera_model, [[-80.0, 300.0], [60.0, 900.0]]).expect("a region");
        assert!(cut.x == 0 && cut.y + cut.height == camera_model.height);
        assert_eq!(fitted(&camera_model, [[-500.0, 100.0], [-300.0, 200.0]]), None);
        assert_eq!(fitted(&camera_model, [[f64::INFINITY, 0.0], [f64::NEG_INFINITY, 0.0]]), None);
    }
}
