//! What cameras on robots saw: taken where they are drawn, so that no simulation knows of it.

use std::sync::{Arc, Mutex, PoisonError};
use vocabulary::{CameraModel, CameraRenderer, Grey, Shot, Snapshot, math};

/// Pictures of a camera in a second of simulation, at most.
const RATE: f64 = 5.0;

/// One picture as it fell on a camera's glass.
#[derive(Debug, Clone, PartialEq)]
pub struct Photo {
    /// s from the start of the run.
    pub time: f64,
    /// The robot that carries the camera.
    pub robot: usize,
    /// Principal point in its own pixels, which may be a part of what the camera sees only.
    pub centre: [f64; 2],
    /// Linear in light.
    pub picture: Grey,
}

/// Pictures on their way from the cameras to the log.
#[derive(Debug, Clone, Default)]
pub struct Roll(Arc<Mutex<Vec<Photo>>>);

impl Roll {
    /// Eyes that see what `eyes` see, and leave some of it here.
    pub fn through(&self, eyes: Box<dyn CameraRenderer>) -> Box<dyn CameraRenderer> {
        Box::new(Through { eyes, roll: self.clone(), next: Vec::new() })
    }

    /// All that has come since the last time.
    pub(super) fn take(&self) -> Vec<Photo> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

struct Through {
    eyes: Box<dyn CameraRenderer>,
    roll: Roll,
    /// When the next picture of each robot is due, s.
    next: Vec<f64>,
}

impl CameraRenderer for Through {
    fn render(&mut self, snapshot: &Snapshot, shots: &[Shot], images: &mut Vec<Grey>) -> Result<(), String> {
        self.eyes.render(snapshot, shots, images)?;
        self.next.resize(snapshot.robots.len(), 0.0);
        for (shot, picture) in shots.iter().zip(&*images) {
            let Some(next) = self.next.get_mut(shot.robot).filter(|next| snapshot.time >= **next - 1e-9)
            else {
                continue;
            };
            *next = snapshot.time + 1.0 / RATE;
            let photo = Photo {
                time: snapshot.time,
                robot: shot.robot,
                centre: [
                    shot.centre[0] - f64::from(shot.region.x),
                    shot.centre[1] - f64::from(shot.region.y),
                ],
                picture: picture.clone(),
            };
            self.roll.0.lock().unwrap_or_else(PoisonError::into_inner).push(photo);
        }
        Ok(())
    }
}

impl Photo {
    /// Appends the picture to `out` as PNG, in its place in the whole picture of `camera_model`, black around it, and
    /// as bright as screens want it; `None` where it makes no picture.
    pub(super) fn png(&self, camera_model: &CameraModel, out: &mut Vec<u8>) -> Option<()> {
        let (across, down) = (camera_model.width as usize, camera_model.height as usize);
        let mut pixels = vec![0; across.checked_mul(down)?];
        let corner = [0, 1].map(|k| (camera_model.centre[k] - self.centre[k]).round() as i64);
        let bright: Vec<u8> =
            (0..=255_u8).map(|v| (255.0 * math::powf(f64::from(v) / 255.0, 1.0 / 2.2)) as u8).collect();
        let width = self.picture.width as usize;
        for (row, line) in self.picture.values.chunks_exact(width.max(1)).enumerate() {
            let Some(y) = usize::try_from(corner[1] + row as i64).ok().filter(|y| *y < down) else {
                continue;
            };
            for (column, value) in line.iter().enumerate() {
                if let Some(x) = usize::try_from(corner[0] + column as i64).ok().filter(|x| *x < across) {
                    pixels[y * across + x] = bright[usize::from(*value)];
                }
            }
        }
        let mut encoder = png::Encoder::new(out, camera_model.width, camera_model.height);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        encoder.write_header().ok()?.write_image_data(&pixels).ok()
    }
}
