//! What a distorting lens makes of an ideal picture.

use vocabulary::CameraModel;

/// Pixels between places where the distortion is undone exactly; straight lines between them err by 0.003 pixels in the
/// corner of a strongly distorted (k1 = −0.3) picture of the default size.
const SPACING: usize = 4;

/// Pixels around the picture that are mapped too: what blur draws in.
const AROUND: usize = 16;

/// Where pixels of the distorted picture are in the ideal one.
#[derive(Debug, Clone)]
pub(super) struct Glass {
    columns: usize,
    rows: usize,
    nodes: Vec<[f32; 2]>,
}

impl Glass {
    pub(super) fn new(camera_model: &CameraModel) -> Self {
        let count = |size: u32| (size as usize + 2 * AROUND) / SPACING + 2;
        let (columns, rows) = (count(camera_model.width), count(camera_model.height));
        let at = |k: usize| (k * SPACING) as f64 - AROUND as f64;
        // Beyond any picture: keeps places where the lens cannot be undone from growing the ideal picture without end.
        let most = [2.0 * f64::from(camera_model.width), 2.0 * f64::from(camera_model.height)];
        let node = |k: usize| {
            let pixel = [at(k % columns), at(k / columns)];
            let direction = camera_model.direction(pixel);
            [0, 1].map(|k| {
                let ideal = camera_model.centre[k] + camera_model.focal * direction[k];
                let near = if ideal.is_finite() { ideal } else { pixel[k] };
                // From the pixel itself, so that f32 has digits to spare.
                (near.clamp(-most[k], 2.0 * most[k]) - pixel[k]) as f32
            })
        };
        Self { columns, rows, nodes: (0..columns * rows).map(node).collect() }
    }

    /// By how much the ideal pixel lies further than the distorted pixel (x, y).
    pub(super) fn offset(&self, x: i32, y: i32) -> [f32; 2] {
        let split = |at: i32, count: usize| {
            let from = (at + AROUND as i32).max(0) as usize;
            let cell = (from / SPACING).min(count - 2);
            (cell, (from - cell * SPACING) as f32 / SPACING as f32)
        };
        let ((column, u), (row, v)) = (split(x, self.columns), split(y, self.rows));
        let pair = |row: usize| {
            let start = row * self.columns + column;
            self.nodes.get(start..start + 2).map_or([[0.0; 2]; 2], |pair| [pair[0], pair[1]])
        };
        let ([a, b], [c, d]) = (pair(row), pair(row + 1));
        [0, 1].map(|k| {
            let (top, bottom) = (a[k] + u * (b[k] - a[k]), c[k] + u * (d[k] - c[k]));
            top + v * (bottom - top)
        })
    }
}

/// A picture's light between its pixels: bicubic after Catmull and Rom; its rim goes on beyond it.
pub(super) fn between(values: &[u8], width: usize, height: usize, x: f32, y: f32) -> f32 {
    // Rounding down without a call: places are not far outside the picture.
    let whole = |x: f32| (x + 1024.0) as i32 - 1024;
    let (left, top) = (whole(x), whole(y));
    let (across, down) = (weights(x - left as f32), weights(y - top as f32));
    let line = |row: &[u8], columns: [usize; 4]| {
        let value = |k: usize| across[k] * row.get(columns[k]).map_or(0.0, |v| f32::from(*v));
        value(0) + value(1) + value(2) + value(3)
    };
    let inside = left >= 1 && top >= 1 && left + 3 <= width as i32 && top + 3 <= height as i32;
    let mut sum = 0.0;
    if inside {
        let start = (top as usize - 1) * width + left as usize - 1;
        for (k, weight) in down.iter().enumerate() {
            let from = start + k * width;
            let Some(&[a, b, c, d]) = values.get(from..from + 4) else { return 0.0 };
            let [a, b, c, d] = [a, b, c, d].map(f32::from);
            sum += weight * (across[0] * a + across[1] * b + across[2] * c + across[3] * d);
        }
        return sum;
    }
    let index = |from: i32, k: usize, size: usize| (from + k as i32 - 1).clamp(0, size as i32 - 1) as usize;
    let columns = [0, 1, 2, 3].map(|k| index(left, k, width));
    for (k, weight) in down.iter().enumerate() {
        let start = index(top, k, height) * width;
        sum += weight * values.get(start..start + width).map_or(0.0, |row| line(row, columns));
    }
    sum
}

fn weights(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (-t3 + 2.0 * t2 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (-3.0 * t3 + 4.0 * t2 + t),
        0.5 * (t3 - t2),
    ]
}
