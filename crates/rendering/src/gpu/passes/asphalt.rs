//! Asphalt: two tiling textures made at the start, shared by all that shows stone.

use super::{mipped, shrink, textured};
use crate::Gpu;

const SIZE: u32 = 512;
const PATCHES: u32 = 128;

/// The textures as the shaders read them.
#[derive(Debug)]
pub(crate) struct Asphalt {
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) group: wgpu::BindGroup,
}

impl Asphalt {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let texture = mipped(gpu, "asphalt", [SIZE, SIZE], &shrink(asphalt(), SIZE, SIZE));
        let patches = mipped(gpu, "patches", [PATCHES, PATCHES], &[patches()]);
        let repeat = wgpu::AddressMode::Repeat;
        let sampler = wgpu::SamplerDescriptor {
            address_mode_u: repeat,
            address_mode_v: repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            // Grain alike at all levels hides the steps between them, and half the reads are saved.
            mipmap_filter: wgpu::MipmapFilterMode::Nearest,
            ..Default::default()
        };
        let (layout, group) = textured(gpu, "asphalt", &[&texture, &patches], &sampler);
        Self { layout, group }
    }
}

/// Grain of the stones; one tile is 2 m.
fn asphalt() -> Vec<u8> {
    let texel = |k: u32| {
        let (x, y) = (k % SIZE, k / SIZE);
        let noise = |cell, salt| noise(x, y, SIZE, cell, salt);
        let grain = 0.30 * noise(2, 1) + 0.30 * noise(4, 2) + 0.22 * noise(16, 3);
        let speck = chance(x / 2, y / 2, 4);
        // A few stones are bright, a few holes are dark.
        let stone = match speck {
            0.0..0.02 => -0.24,
            _ if speck > 0.985 => 0.42,
            _ => 0.0,
        };
        let fine = grain + 0.18 * chance(x, y, 5) + stone;
        (fine.clamp(0.0, 1.0) * 255.0) as u8
    };
    (0..SIZE * SIZE).map(texel).collect()
}

/// Broad patches; one tile is 20 m.
fn patches() -> Vec<u8> {
    let texel = |k: u32| {
        let noise = |cell, salt| noise(k % PATCHES, k / PATCHES, PATCHES, cell, salt);
        ((0.46 * noise(32, 6) + 0.32 * noise(8, 7) + 0.22 * noise(2, 8)) * 255.0) as u8
    };
    (0..PATCHES * PATCHES).map(texel).collect()
}

/// A number from 0 to 1 that depends on a place alone; it repeats with the tile.
fn chance(x: u32, y: u32, salt: u32) -> f32 {
    let mut h = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ salt.wrapping_mul(0xc2b2_ae3d);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    ((h ^ (h >> 15)) & 0xffff) as f32 / 65_535.0
}

/// Value noise with cells of `cell` texels that repeats after `size`.
fn noise(x: u32, y: u32, size: u32, cell: u32, salt: u32) -> f32 {
    let cells = size / cell;
    let (i, j) = (x / cell, y / cell);
    let ease = |t: f32| t * t * (3.0 - 2.0 * t);
    let u = ease((x % cell) as f32 / cell as f32);
    let v = ease((y % cell) as f32 / cell as f32);
    let at = |di: u32, dj: u32| chance((i + di) % cells, (j + dj) % cells, salt);
    let low = at(0, 0) + (at(1, 0) - at(0, 0)) * u;
    let high = at(0, 1) + (at(1, 1) - at(0, 1)) * u;
    low + (high - low) * v
}
