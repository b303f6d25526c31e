//! One file per pass: its shader, its data, its pipeline and its draw. Here is what they share.

pub(crate) mod asphalt;
pub(crate) mod backdrop;
pub(crate) mod decal;
pub(crate) mod frame;
mod halo;
pub(crate) mod instanced;
pub(crate) mod layer;
pub(crate) mod overlay;
pub(crate) mod prop;
pub(crate) mod robot;
pub(crate) mod shadow;
pub(crate) mod tag;
pub(crate) mod terrain;
pub(crate) mod text;
pub(crate) mod texture;

#[cfg(test)]
mod tests;

use crate::Gpu;
use crate::gpu::resources::{flat_texture, rows, sampled};
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, BindingType, Buffer, BufferUsages, Extent3d, TextureFormat,
    TextureUsages, TextureViewDescriptor, VertexAttribute, VertexBufferLayout, VertexStepMode,
};

/// Light of the sky on flat ground, of one colour.
macro_rules! grey_sky {
    () => {
        0.41
    };
}
/// Light of a sun straight above it.
macro_rules! grey_sun {
    () => {
        2.063
    };
}
pub(crate) const GREY_SKY: f64 = grey_sky!();
pub(crate) const GREY_SUN: f64 = grey_sun!();

/// Shaders in a row, after the light that they share with the code that lays out shadows.
macro_rules! shader {
    ($($name:literal),*) => {
        concat!("const GREY_SKY = ", $crate::gpu::passes::grey_sky!(), ";\nconst GREY_SUN = ", $crate::gpu::passes::grey_sun!(), ";\n", $(include_str!(concat!("../../../../../shaders/", $name, ".wgsl"))),*)
    };
}
pub(crate) use {grey_sky, grey_sun, shader};

/// The source of what is developed for a screen, and of the same for a monochrome camera; the frame comes first.
macro_rules! developed {
    ($($name:literal),*) => {
        [
            shader!("common/frame", "common/display", $($name),*),
            shader!("common/frame", "common/mono", $($name),*),
        ]
    };
}
pub(crate) use developed;

/// Every shader as it is compiled, by name: for validation without an adapter.
#[cfg(test)]
pub(crate) const SHADERS: [(&str, &[&str]); 10] = [
    ("shadow", &[shadow::SHADER]),
    ("robot", &robot::SHADERS),
    ("tag", &tag::SHADERS),
    ("ground", &backdrop::GROUND),
    ("terrain", &terrain::SHADERS),
    ("decal", &decal::SHADERS),
    ("prop", &prop::SHADERS),
    ("sky", &backdrop::SKY),
    ("texture", &[texture::SHADER]),
    ("overlay", &[overlay::SHADER]),
];

pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// What a pass draws into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Canvas {
    pub(crate) format: TextureFormat,
    pub(crate) samples: u32,
    /// Whether it takes light instead of what a screen shows.
    pub(crate) mono: bool,
}

impl Canvas {
    /// Which of two sources draws on it.
    pub(crate) fn of(self, sources: [&'static str; 2]) -> &'static str {
        sources[usize::from(self.mono)]
    }

    /// The same with one sample a pixel.
    pub(crate) fn flat(self) -> Self {
        Self { samples: 1, ..self }
    }
}

/// How a pipeline treats colour and depth.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recipe<'a> {
    pub(crate) label: &'a str,
    pub(crate) source: &'a str,
    pub(crate) vertex: &'a str,
    /// The fragment stage's entry point.
    pub(crate) entry: &'a str,
    pub(crate) groups: &'a [&'a BindGroupLayout],
    pub(crate) buffers: &'a [VertexBufferLayout<'a>],
    pub(crate) topology: wgpu::PrimitiveTopology,
    pub(crate) cull: bool,
    /// Colour target, its samples and blending; depth alone without.
    pub(crate) colour: Option<(Canvas, Option<wgpu::BlendState>)>,
    /// What of the colour is written where there is a target; a pass may only want its depth.
    pub(crate) write: wgpu::ColorWrites,
    /// Opacity is the share of a pixel's samples that are covered, whatever the order of what is drawn.
    pub(crate) coverage: bool,
    /// Depth comparison and whether depth is written.
    pub(crate) depth: Option<(wgpu::CompareFunction, bool)>,
    pub(crate) bias: wgpu::DepthBiasState,
}

impl Default for Recipe<'_> {
    fn default() -> Self {
        Self {
            label: "",
            source: "",
            vertex: "vertex",
            entry: "fragment",
            groups: &[],
            buffers: &[],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: false,
            colour: None,
            write: wgpu::ColorWrites::ALL,
            coverage: false,
            depth: None,
            bias: wgpu::DepthBiasState::default(),
        }
    }
}

impl Recipe<'_> {
    pub(crate) fn build(&self, gpu: &Gpu) -> wgpu::RenderPipeline {
        let device = &gpu.device;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.label),
            source: wgpu::ShaderSource::Wgsl(self.source.into()),
        });
        let groups: Vec<_> = self.groups.iter().copied().map(Some).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.label),
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        let buffers: Vec<_> = self.buffers.iter().cloned().map(Some).collect();
        let targets: Vec<_> = self
            .colour
            .map(|(canvas, blend)| wgpu::ColorTargetState {
                format: canvas.format,
                blend,
                write_mask: self.write,
            })
            .into_iter()
            .map(Some)
            .collect();
        let fragment = wgpu::FragmentState {
            module: &module,
            entry_point: Some(self.entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(self.vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                cull_mode: self.cull.then_some(wgpu::Face::Back),
                ..Default::default()
            },
            depth_stencil: self.depth.map(|(compare, write)| wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(write),
                depth_compare: Some(compare),
                stencil: wgpu::StencilState::default(),
                bias: self.bias,
            }),
            multisample: wgpu::MultisampleState {
                count: self.colour.map_or(1, |(canvas, _)| canvas.samples),
                alpha_to_coverage_enabled: self.coverage,
                ..Default::default()
            },
            fragment: self.colour.is_some().then_some(fragment),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A buffer that is filled anew for every picture and grows as needed.
#[derive(Debug)]
pub(crate) struct StreamBuffer {
    buffer: Buffer,
    usage: BufferUsages,
    label: &'static str,
}

impl StreamBuffer {
    pub(crate) fn new(gpu: &Gpu, label: &'static str, usage: BufferUsages) -> Self {
        let usage = usage | BufferUsages::COPY_DST;
        Self { buffer: gpu.buffer(label, 4096, usage), usage, label }
    }

    /// One that never changes.
    pub(crate) fn constant(gpu: &Gpu, label: &'static str, usage: BufferUsages, bytes: &[u8]) -> Self {
        let mut stream = Self::new(gpu, label, usage);
        stream.fill(gpu, bytes);
        stream
    }

    pub(crate) fn fill(&mut self, gpu: &Gpu, bytes: &[u8]) {
        let size = bytes.len() as u64;
        if size > self.buffer.size() {
            self.buffer = gpu.buffer(self.label, size.next_power_of_two(), self.usage);
        }
        if size > 0 {
            gpu.queue.write_buffer(&self.buffer, 0, bytes);
        }
    }

    pub(crate) fn slice(&self) -> wgpu::BufferSlice<'_> {
        self.buffer.slice(..)
    }
}

/// A buffer of vertices of type `T`.
pub(crate) const fn vertices<T>(attributes: &[VertexAttribute]) -> VertexBufferLayout<'_> {
    VertexBufferLayout { array_stride: size_of::<T>() as u64, step_mode: VertexStepMode::Vertex, attributes }
}

/// Layout and bind group of textures with their sampler: the first is binding 0, the sampler 1, others follow.
pub(crate) fn textured(
    gpu: &Gpu,
    label: &str,
    textures: &[&wgpu::Texture],
    sampler: &wgpu::SamplerDescriptor<'_>,
) -> (BindGroupLayout, BindGroup) {
    let mut types = vec![sampled(wgpu::TextureSampleType::Float { filterable: true }); textures.len()];
    types.insert(1, BindingType::Sampler(wgpu::SamplerBindingType::Filtering));
    let layout = gpu.layout(label, wgpu::ShaderStages::FRAGMENT, &types);
    let sampler = gpu.device.create_sampler(sampler);
    let views: Vec<_> = textures.iter().map(|t| t.create_view(&TextureViewDescriptor::default())).collect();
    let mut resources: Vec<_> = views.iter().map(BindingResource::TextureView).collect();
    resources.insert(1, BindingResource::Sampler(&sampler));
    let group = gpu.group(label, &layout, resources);
    (layout, group)
}

/// A texture of one byte a texel with the given mip levels, each half as large as the one before.
pub(crate) fn mipped(gpu: &Gpu, label: &str, size: [u32; 2], levels: &[Vec<u8>]) -> wgpu::Texture {
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        mip_level_count: levels.len() as u32,
        ..flat_texture(label, size, TextureFormat::R8Unorm, usage)
    });
    for (level, texels) in (0..).zip(levels) {
        let [width, height] = size.map(|side| (side >> level).max(1));
        let copy = wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() };
        let extent = Extent3d { width, height, depth_or_array_layers: 1 };
        gpu.queue.write_texture(copy, texels, rows(width), extent);
    }
    texture
}

/// The levels below `first`, each texel the mean of four; down to one texel on the shorter side.
pub(crate) fn shrink(first: Vec<u8>, width: u32, height: u32) -> Vec<Vec<u8>> {
    let mut levels = vec![first];
    let (mut w, mut h) = (width as usize, height as usize);
    while w > 1 && h > 1 {
        let above = &levels[levels.len() - 1];
        let texel = |k: usize| {
            let (x, y) = (2 * (k % (w / 2)), 2 * (k / (w / 2)));
            let at = |dx: usize, dy: usize| u32::from(above[(y + dy) * w + x + dx]);
            ((at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1) + 2) / 4) as u8
        };
        let level = (0..(w / 2) * (h / 2)).map(texel).collect();
        levels.push(level);
        (w, h) = (w / 2, h / 2);
    }
    levels
}
