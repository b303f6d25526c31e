//! How many pixels the moving 3D view has: on a page that a processor draws, fewer where frames take long.

use rendering::Gpu;

/// Frames that take longer than this are slow, s.
const SLOW: f32 = 0.06;
/// So many slow frames one after the other lower the density.
const FRAMES: u32 = 6;
/// The densities: pixels of the picture per pixel of the screen, in one direction.
const STEPS: [f64; 3] = [1.0, 0.75, 0.6];

/// The density of the moving view.
#[derive(Debug)]
pub(super) struct Density {
    /// Whether it may be lowered.
    adapts: bool,
    step: usize,
    /// Slow frames one after the other.
    slow: u32,
    /// Size of the view, pixels of the screen.
    size: [u32; 2],
}

impl Density {
    /// Full, until frames are slow.
    pub(super) fn of(gpu: &Gpu) -> Self {
        // A desktop shows frames as they come; a browser copies every one of them, and has less time.
        Self::new(cfg!(target_family = "wasm") && gpu.info().software)
    }

    fn new(adapts: bool) -> Self {
        Self { adapts, step: 0, slow: 0, size: [0; 2] }
    }

    /// Takes note of a frame that took so long, s, in a view of this size.
    pub(super) fn frame(&mut self, took: f32, moves: bool, size: [u32; 2]) {
        if self.size != size {
            (self.step, self.slow, self.size) = (0, 0, size);
        }
        // Where nothing moves, frames come when something happens.
        let slow = self.adapts && moves && took > SLOW;
        self.slow = if slow { self.slow + 1 } else { 0 };
        if self.slow >= FRAMES && self.step + 1 < STEPS.len() {
            self.step += 1;
            self.slow = 0;
        }
    }

    /// The size of the moving picture of a view of this size, pixels.
    pub(super) fn size(&self, size: [u32; 2]) -> [u32; 2] {
        size.map(|side| ((f64::from(side) * STEPS[self.step]).round() as u32).max(super::SIZES[0].min(side)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_slow_frames_one_after_the_other_cost_pixels() {
        let mut density = Density::new(true);
        let mut frames = |frames: &[f32], moves: bool| {
            for took in frames {
                density.frame(*took, moves, [800, 400]);
            }
            density.size([800, 400])
        };
        assert_eq!(frames(&[0.3, 0.3, 0.3, 0.3, 0.3, 0.02, 0.3], true), [800, 400]);
        assert_eq!(frames(&[0.3; 40], false), [800, 400]);
        assert_eq!(frames(&[0.1; 6], true), [600, 300]);
        assert_eq!(frames(&[0.1; 60], true), [480, 240]);
        density.frame(0.1, true, [400, 400]);
        assert_eq!(density.size([400, 400]), [400, 400]);
    }

    #[test]
    fn a_desktop_keeps_its_pixels() {
        let mut density = Density::new(false);
        (0..60).for_each(|_| density.frame(0.3, true, [800, 400]));
        assert_eq!(density.size([800, 400]), [800, 400]);
    }
}
