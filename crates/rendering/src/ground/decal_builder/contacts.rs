//! Contacts: a flash where things touch, and a mark that stays on the ground.

use crate::gpu::passes::decal::{DecalForm, DecalVertex};
use crate::ground::decal_builder::DecalBuilder;
use crate::palette::{Rgb, with_alpha};
use crate::picture_context::PictureContext;
use glam::{DVec2, DVec3};

/// How long a flash lasts, s.
const FLASH: f64 = 0.4;
const CORE: Rgb = [1.0, 0.97, 0.82];
const GLOW: Rgb = [1.0, 0.62, 0.16];
const SOOT: Rgb = [0.03, 0.03, 0.035];

impl DecalBuilder<'_> {
    /// Crosses on the ground where things touched.
    pub(crate) fn scuffs(&mut self, context: &PictureContext<'_>) {
        for touch in context.trail.touches.iter().filter(|t| t.begin <= context.record.snapshot.time) {
            let middle = DVec3::from_array(touch.place).truncate();
            let size = (0.075 * context.size).max(5.0 * self.stage_scale * self.pixel(middle));
            self.disc(middle, 1.5 * size, DecalForm::Blob, SOOT, 0.55);
            // Turned by its number, so that a row of them does not look printed.
            let turn = DVec2::from_angle(0.6 + 1.7 * touch.number as f64);
            for arm in [turn, turn.perp()] {
                let (along, across) = (arm * size, arm.perp() * (0.17 * size));
                self.patch(middle, along, across, DecalForm::Solid, SOOT, 0.80);
            }
        }
    }

    /// Rings that open and fade, around a star.
    pub(crate) fn flashes(&mut self, context: &PictureContext<'_>) {
        let now = context.record.snapshot.time;
        for touch in &context.trail.touches {
            let age = (now - touch.begin) / FLASH;
            if (0.0..1.0).contains(&age) {
                let least = 9.0 * self.stage_scale * self.pixel_at(DVec3::from_array(touch.place));
                self.flash(DVec3::from_array(touch.place), age, (0.11 * context.size).max(least));
            }
        }
    }

    fn flash(&mut self, middle: DVec3, age: f64, size: f64) {
        let fading = (1.0 - age * age) as f32;
        self.facing(middle, size * (2.2 + age), DecalForm::Blob, GLOW, 0.75 * fading);
        let ring = size * (0.7 + 2.3 * age);
        let hole = 0.74 + 0.18 * age as f32;
        self.facing(middle, ring, DecalForm::Ring(hole), CORE, 0.95 * fading);
        for k in 0..6 {
            let turn = DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / 6.0 + 0.3);
            // Every second ray is short.
            let reach = size * (1.9 - 0.7 * f64::from(k % 2)) * (0.8 + 0.5 * age);
            let across = turn.perp() * (0.16 * size * (1.0 - age));
            let corners = [turn * reach, across, -across];
            let corners = corners.map(|at| self.seen(middle, at, DecalForm::Solid, [0.0; 2], CORE, fading));
            self.corners.extend(corners);
        }
        self.facing(middle, 0.75 * size * (1.0 - 0.6 * age), DecalForm::Blob, CORE, fading);
    }

    /// A shape that faces the eye.
    fn facing(&mut self, middle: DVec3, reach: f64, form: DecalForm, colour: Rgb, alpha: f32) {
        let at = |u: f32, v: f32| {
            let aside = DVec2::new(f64::from(u), f64::from(v)) * reach;
            self.seen(middle, aside, form, [u, v], colour, alpha)
        };
        let quad = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
        self.corners.extend([0, 1, 2, 0, 2, 3].map(|k| quad[k]));
    }

    fn seen(
        &self,
        middle: DVec3,
        aside: DVec2,
        form: DecalForm,
        shape: [f32; 2],
        colour: Rgb,
        alpha: f32,
    ) -> DecalVertex {
        let place = middle + self.camera.right * aside.x + self.camera.up * aside.y - self.origin;
        DecalVertex::new(place, form, shape, with_alpha(colour, alpha))
    }
}
