//! How a camera maps directions to pixels.

use crate::math;

/// A pinhole camera with Brown-Conrady distortion. The middle of the top left pixel is (0, 0), x to the right, y down; in
/// the camera's frame x is to the right, y down and z ahead, as OpenCV has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraModel {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Focal length, pixels.
    pub focal: f64,
    /// Principal point, pixels.
    pub centre: [f64; 2],
    /// k1, k2, p1, p2, k3; all zero for a perfect pinhole.
    pub distortion: [f64; 5],
}

impl Default for CameraModel {
    /// 640 by 480 pixels, 50° across.
    fn default() -> Self {
        Self::pinhole(640, 480, 50_f64.to_radians())
    }
}

impl CameraModel {
    /// Without distortion, its axis through the middle of the picture; `field_of_view` across, rad.
    pub fn pinhole(width: u32, height: u32, field_of_view: f64) -> Self {
        Self {
            width,
            height,
            focal: 0.5 * f64::from(width) / math::tan(0.5 * field_of_view),
            centre: [0.5 * (f64::from(width) - 1.0), 0.5 * (f64::from(height) - 1.0)],
            distortion: [0.0; 5],
        }
    }

    /// Whether it distorts.
    pub fn distorts(&self) -> bool {
        self.distortion.iter().any(|k| *k != 0.0)
    }

    /// Where a point of the camera's frame (m) is seen, pixels; `None` behind the camera.
    pub fn project(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
        (z > 1e-6).then(|| self.pixel(self.distorted([x / z, y / z])))
    }

    /// The pixel of a distorted direction (x/z, y/z).
    fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.centre[0] + self.focal * x, self.centre[1] + self.focal * y]
    }

    /// What the glass makes of a direction (x/z, y/z).
    pub fn distorted(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ]
    }

    /// The direction (x/z, y/z) that is seen at a pixel: the distortion undone by Newton's method.
    pub fn direction(&self, pixel: [f64; 2]) -> [f64; 2] {
        let seen = [0, 1].map(|k| (pixel[k] - self.centre[k]) / self.focal);
        if !self.distorts() {
            return seen;
        }
        let mut guess = seen;
        for _ in 0..20 {
            let at = self.distorted(guess);
            let off = [seen[0] - at[0], seen[1] - at[1]];
            let [[a, b], [c, d]] = self.slope(guess);
            let det = a * d - b * c;
            // Beyond where the mapping folds over there is no way back.
            if det.abs() < 1e-9 {
                break;
            }
            let step = [(d * off[0] - b * off[1]) / det, (a * off[1] - c * off[0]) / det];
            guess = [guess[0] + step[0], guess[1] + step[1]];
            if step[0].abs().max(step[1].abs()) < 1e-14 {
                break;
            }
        }
        guess
    }

    /// Derivative of [`CameraModel::distorted`], rows for its two components.
    pub fn slope(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let swell = 2.0 * (k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3));
        let mixed = swell * x * y + 2.0 * p1 * x + 2.0 * p2 * y;
        [
            [radial + swell * x * x + 2.0 * p1 * y + 6.0 * p2 * x, mixed],
            [mixed, radial + swell * y * y + 6.0 * p1 * y + 2.0 * p2 * x],
        ]
    }

    /// Whether a pixel lies at least `margin` pixels inside the picture.
    pub fn holds(&self, [x, y]: [f64; 2], margin: f64) -> bool {
        let within = |at: f64, size: u32| at >= margin - 0.5 && at <= f64::from(size) - 0.5 - margin;
        within(x, self.width) && within(y, self.height)
    }
}

/// A rectangle of a camera's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Region {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Region {
    /// All of a picture.
    pub fn whole(camera_model: &CameraModel) -> Self {
        Self { x: 0, y: 0, width: camera_model.width, height: camera_model.height }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_camera_has_the_focal_length_that_is_written_about_it() {
        let camera_model = CameraModel::pinhole(640, 480, 50_f64.to_radians());
        assert!((camera_model.focal - 686.2).abs() < 0.1);
        assert_eq!(camera_model.project([0.0, 0.0, 2.0]), Some([319.5, 239.5]));
        assert_eq!(camera_model.project([0.0, 0.0, -2.0]), None);
    }

    #[test]
    fn distortion_is_undone() {
        let camera_model = CameraModel {
            distortion: [-0.28, 0.09, 1e-3, -7e-4, -0.01],
            ..CameraModel::pinhole(640, 480, 60_f64.to_radians())
        };
        for (u, v) in (0..8).flat_map(|u| (0..6).map(move |v| (f64::from(u) * 91.0, f64::from(v) * 95.0))) {
            let [x, y] = camera_model.direction([u, v]);
            let back = camera_model.project([x, y, 1.0]).expect("in front");
            assert!((back[0] - u).abs() < 1e-9 && (back[1] - v).abs() < 1e-9, "{u} {v}: {back:?}");
        }
    }

    #[test]
    fn the_slope_is_the_derivative() {
        let camera_model =
            CameraModel { distortion: [-0.3, 0.1, 2e-3, -1e-3, 0.02], ..CameraModel::pinhole(640, 480, 1.0) };
        let (at, h) = ([0.31, -0.22], 1e-6);
        let slope = camera_model.slope(at);
        for (k, [dx, dy]) in [[h, 0.0], [0.0, h]].into_iter().enumerate() {
            let moved = |sign: f64| camera_model.distorted([at[0] + sign * dx, at[1] + sign * dy]);
            let (a, b) = (moved(1.0), moved(-1.0));
            for (row, (a, b)) in slope.iter().zip(a.into_iter().zip(b)) {
                assert!((row[k] - (a - b) / (2.0 * h)).abs() < 1e-8);
            }
        }
    }
}
