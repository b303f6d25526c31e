//! What a sensor makes of an ideal picture: distortion, blur, noise, eight bits.

mod exposure;
mod glass;
mod noise;

pub use exposure::gather;
pub use noise::{NoiseStream, Purpose, noise_stream};

use glass::{Glass, between};
use vocabulary::{CameraModel, Grey, Region, RobotInfo, RobotState, Shot, math};

/// A lens and the sensor behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optics {
    /// Where things are seen.
    pub camera_model: CameraModel,
    /// Standard deviation of the blur, pixels.
    pub blur: f64,
    /// Standard deviation of a pixel's noise, share of full scale.
    pub noise: f64,
}

impl Default for Optics {
    /// The default lens, blurred by 0.7 pixels, with a noise of three grey levels.
    fn default() -> Self {
        Self { camera_model: CameraModel::default(), blur: 0.7, noise: 3.0 / 255.0 }
    }
}

/// What part of the ideal pinhole picture a region of the sensor's picture is made from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IdealPicture {
    /// What to draw; starts at (0, 0).
    pub region: Region,
    /// Principal point in it, pixels: the lens's, counted from the region's corner, which may be outside the frame.
    pub centre: [f64; 2],
    /// Pixel of the ideal picture of the whole frame that is pixel (0, 0) of this one.
    pub corner: [i32; 2],
}

impl IdealPicture {
    /// What is drawn of it for the camera of robot number `robot`; `exposure` is the factor on the light.
    pub fn shot(&self, robot: usize, info: &RobotInfo, state: &RobotState, exposure: f64) -> Shot {
        let Self { region, centre, .. } = *self;
        let world_from_camera = info.camera_mount.world_from_camera(state);
        Shot { robot, world_from_camera, focal: info.camera_model.focal, centre, region, exposure }
    }
}

/// Makes a sensor's pictures out of ideal ones.
#[derive(Debug, Clone)]
pub struct ImageSensor {
    optics: Optics,
    glass: Option<Glass>,
    /// Weights of the blur from the middle out.
    kernel: Vec<f32>,
    light: Vec<f32>,
    rows: Vec<f32>,
    noise: Vec<f32>,
}

/// Blur that is wider is cut to this, pixels.
const WIDEST_BLUR: f64 = 4.0;

impl ImageSensor {
    /// Prepares for pictures through `optics`; blur and noise that are negative or no numbers count as none.
    pub fn new(optics: Optics) -> Self {
        let sigma = if optics.blur > 0.0 { optics.blur.min(WIDEST_BLUR) } else { 0.0 };
        let reach = (3.0 * sigma).ceil() as usize;
        let bell = |k: usize| if k == 0 { 1.0 } else { math::exp(-0.5 * math::powi(k as f64 / sigma, 2)) };
        let sum = 2.0 * (0..=reach).map(bell).sum::<f64>() - 1.0;
        Self {
            optics,
            glass: optics.camera_model.distorts().then(|| Glass::new(&optics.camera_model)),
            kernel: (0..=reach).map(|k| (bell(k) / sum) as f32).collect(),
            light: vec![],
            rows: vec![],
            noise: vec![],
        }
    }

    /// The optics it was made with.
    pub fn optics(&self) -> &Optics {
        &self.optics
    }

    /// What part of the ideal picture `region` of the sensor's picture is made from.
    pub fn source(&self, region: Region) -> IdealPicture {
        let [mut low, mut high] = self.drawn_in(region);
        if let Some(glass) = &self.glass {
            let mut ideal = [[i32::MAX; 2], [i32::MIN; 2]];
            let mut see = |x: i32, y: i32| {
                let offset = glass.offset(x, y);
                for (k, at) in [x, y].into_iter().enumerate() {
                    let at = at as f32 + offset[k];
                    ideal[0][k] = ideal[0][k].min(at.floor() as i32 - 2);
                    ideal[1][k] = ideal[1][k].max(at.ceil() as i32 + 3);
                }
            };
            // The mapping is smooth: what a rectangle becomes is bounded by what its sides become.
            for x in low[0]..high[0] {
                see(x, low[1]);
                see(x, high[1] - 1);
            }
            for y in low[1]..high[1] {
                see(low[0], y);
                see(high[0] - 1, y);
            }
            [low, high] = ideal;
        }
        let size = [0, 1].map(|k| high[k].saturating_sub(low[k]).max(1) as u32);
        let centre = [0, 1].map(|k| self.optics.camera_model.centre[k] - f64::from(low[k]));
        IdealPicture { region: Region { x: 0, y: 0, width: size[0], height: size[1] }, centre, corner: low }
    }

    /// Makes `picture` of `region` out of the ideal picture of its [`ImageSensor::source`]. Leaves it empty if the ideal
    /// picture is not of that size.
    pub fn expose(&mut self, ideal: &Grey, region: Region, stream: &mut NoiseStream, picture: &mut Grey) {
        let source = self.source(region);
        let (width, height) = (ideal.width as usize, ideal.height as usize);
        picture.values.clear();
        (picture.width, picture.height) = (0, 0);
        let sizes = (source.region.width, source.region.height);
        if (ideal.width, ideal.height) != sizes || ideal.values.len() != width * height {
            return;
        }
        let [low, high] = self.drawn_in(region);
        let [across, down] = [0, 1].map(|k| (high[k] - low[k]).max(0) as usize);
        self.light.clear();
        if let Some(glass) = &self.glass {
            for y in low[1]..high[1] {
                self.light.extend((low[0]..high[0]).map(|x| {
                    let [dx, dy] = glass.offset(x, y);
                    let (u, v) = ((x - source.corner[0]) as f32 + dx, (y - source.corner[1]) as f32 + dy);
                    between(&ideal.values, width, height, u, v)
                }));
            }
        } else {
            self.light.extend(ideal.values.iter().map(|v| f32::from(*v)));
        }
        self.blur(across, down);
        let (columns, rows) = (region.width as usize, region.height as usize);
        let grain = (255.0 * self.optics.noise.clamp(0.0, 1.0)) as f32;
        self.noise.resize(columns, 0.0);
        for row in self.rows.chunks_exact(columns.max(1)).take(rows) {
            if grain > 0.0 {
                stream.normals(&mut self.noise);
            }
            picture.values.extend(
                row.iter().zip(&self.noise).map(|(light, noise)| (light + grain * noise + 0.5) as u8),
            );
        }
        (picture.width, picture.height) = (region.width, region.height);
    }

    /// Corners of what a region's blur draws in, in the distorted picture: first pixel, and one past the last.
    fn drawn_in(&self, region: Region) -> [[i32; 2]; 2] {
        let reach = self.reach() as i32;
        // No picture is larger; sums stay within what numbers hold.
        let pixel = |k: u32| k.min(1 << 20) as i32;
        let (x, y) = (pixel(region.x), pixel(region.y));
        [[x - reach, y - reach], [x + pixel(region.width) + reach, y + pixel(region.height) + reach]]
    }

    fn reach(&self) -> usize {
        self.kernel.len().saturating_sub(1)
    }

    /// Blurs `light`, `across` by `down` pixels, into `rows`, smaller by the kernel's reach on every side.
    fn blur(&mut self, across: usize, down: usize) {
        let reach = self.reach();
        let (columns, lines) = (across.saturating_sub(2 * reach), down.saturating_sub(2 * reach));
        self.rows.clear();
        self.rows.resize(columns * lines, 0.0);
        let mut upright = vec![0.0_f32; across];
        for (line, out) in self.rows.chunks_exact_mut(columns.max(1)).enumerate() {
            upright.fill(0.0);
            for k in 0..=2 * reach {
                let start = (line + k) * across;
                let weight = self.kernel[k.abs_diff(reach)];
                for (sum, light) in upright.iter_mut().zip(self.light.iter().skip(start)) {
                    *sum += weight * light;
                }
            }
            for k in 0..=2 * reach {
                let weight = self.kernel[k.abs_diff(reach)];
                for (sum, light) in out.iter_mut().zip(upright.iter().skip(k)) {
                    *sum += weight * light;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
