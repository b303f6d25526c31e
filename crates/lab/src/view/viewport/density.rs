//! How many pixels the moving 3D view has: on a page that a processor draws, fewer where frames take long.

use rendering::Gpu;

/// Where frames take longer than this on the mean, the density is lowered, s.
const SLOW: f32 = 0.05;
/// So many frames make a mean.
const FRAMES: u32 = 12;
/// A frame counts at most so long, s: a single hitch is no reason.
const HITCH: f32 = 0.2;
/// The densities: pixels of the picture per pixel of the screen, in one direction.
const STEPS: [f64; 3] = [1.0, 0.75, 0.6];

/// The density of the moving view.
#[derive(Debug)]
pub(super) struct Density {
    /// Whether it may be lowered.
    adapts: bool,
    step: usize,
    /// Frames since the last mean, and how long they took together, s.
    frames: u32,
    together: f32,
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
        Self { adapts, step: 0, frames: 0, together: 0.0, size: [0; 2] }
    }

    /// Takes note of a frame that took so long, s, in a view of this size.
    pub(super) fn frame(&mut self, took: f32, moves: bool, size: [u32; 2]) {
        if self.size != size {
            *self = Self { size, ..Self::new(self.adapts) };
        }
        // Where nothing moves, frames come when something happens.
        if !self.adapts || !moves {
            return;
        }
        self.frames += 1;
        self.together += took.min(HITCH);
        if self.frames == FRAMES {
            let slow = self.together > SLOW * FRAMES as f32;
            self.step = (self.step + usize::from(slow)).min(STEPS.len() - 1);
            (self.frames, self.together) = (0, 0.0);
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
    fn frames_that_are_slow_on_the_mean_cost_pixels() {
        let mut density = Density::new(true);
        let mut frames = |took: &[f32], count: usize, moves: bool| {
            took.iter().cycle().take(count).for_each(|took| density.frame(*took, moves, [800, 400]));
            density.size([800, 400])
        };
        // One hitch among frames that are quick enough, and frames of a picture that stands, cost nothing.
        assert_eq!(frames(&[3.0], 1, true), [800, 400]);
        assert_eq!(frames(&[0.033], 11, true), [800, 400]);
        assert_eq!(frames(&[0.3], 40, false), [800, 400]);
        // A browser that shows every third or fourth picture of the screen is too slow by a sixth.
        assert_eq!(frames(&[0.05, 0.067], 12, true), [600, 300]);
        assert_eq!(frames(&[0.1], 60, true), [480, 240]);
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
