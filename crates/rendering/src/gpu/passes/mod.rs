//! One file per pass: its shader, its data, its pipeline and its draw. Here is what they share.

pub(crate) mod asphalt;
pub(crate) mod decal;
pub(crate) mod frame;
pub(crate) mod ground;
pub(crate) mod overlay;
pub(crate) mod prop;
pub(crate) mod robot;
pub(crate) mod shadow;
pub(crate) mod sky;
pub(crate) mod tag;
pub(crate) mod terrain;
pub(crate) mod text;

#[cfg(test)]
mod tests;

use wgpu::{BindGroupLayout, Buffer, BufferUsages, Device, Queue, TextureFormat};

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
pub(crate) const SHADERS: [(&str, &[&str]); 9] = [
    ("shadow", &[shadow::SHADER]),
    ("robot", &robot::SHADERS),
    ("tag", &tag::SHADERS),
    ("ground", &ground::SHADERS),
    ("terrain", &terrain::SHADERS),
    ("decal", &decal::SHADERS),
    ("prop", &prop::SHADERS),
    ("sky", &sky::SHADERS),
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
    pub(crate) buffers: &'a [wgpu::VertexBufferLayout<'a>],
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
    pub(crate) fn build(&self, device: &Device) -> wgpu::RenderPipeline {
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
    pub(crate) fn new(device: &Device, label: &'static str, usage: BufferUsages) -> Self {
        let usage = usage | BufferUsages::COPY_DST;
        Self { buffer: Self::make(device, label, usage, 4096), usage, label }
    }

    pub(crate) fn fill(&mut self, device: &Device, queue: &Queue, bytes: &[u8]) {
        let size = bytes.len() as u64;
        if size > self.buffer.size() {
            self.buffer = Self::make(device, self.label, self.usage, size.next_power_of_two());
        }
        if size > 0 {
            queue.write_buffer(&self.buffer, 0, bytes);
        }
    }

    pub(crate) fn slice(&self) -> wgpu::BufferSlice<'_> {
        self.buffer.slice(..)
    }

    fn make(device: &Device, label: &str, usage: BufferUsages, size: u64) -> Buffer {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        })
    }
}

/// A buffer that never changes.
pub(crate) fn constant(
    device: &Device,
    queue: &Queue,
    label: &'static str,
    usage: BufferUsages,
    bytes: &[u8],
) -> StreamBuffer {
    let mut stream = StreamBuffer::new(device, label, usage);
    stream.fill(device, queue, bytes);
    stream
}

/// Layout and bind group of textures with their sampler: the first is binding 0, the sampler 1, others follow.
pub(crate) fn textured(
    device: &Device,
    label: &str,
    textures: &[&wgpu::Texture],
    sampler: &wgpu::SamplerDescriptor<'_>,
) -> (BindGroupLayout, wgpu::BindGroup) {
    let place = |k: usize| if k == 0 { 0 } else { k as u32 + 1 };
    let slot = |binding: u32, ty: wgpu::BindingType| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let image = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let mut slots = vec![slot(1, wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering))];
    slots.extend((0..textures.len()).map(|k| slot(place(k), image)));
    let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &slots };
    let layout = device.create_bind_group_layout(&descriptor);
    let sampler = device.create_sampler(sampler);
    let views: Vec<_> =
        textures.iter().map(|t| t.create_view(&wgpu::TextureViewDescriptor::default())).collect();
    let mut entries =
        vec![wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) }];
    entries.extend(views.iter().enumerate().map(|(k, view)| wgpu::BindGroupEntry {
        binding: place(k),
        resource: wgpu::BindingResource::TextureView(view),
    }));
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout: &layout,
        entries: &entries,
    });
    (layout, group)
}

/// A texture of one byte a texel with the given mip levels, each half as large as the one before.
pub(crate) fn mipped(
    device: &Device,
    queue: &Queue,
    label: &str,
    size: [u32; 2],
    levels: &[Vec<u8>],
) -> wgpu::Texture {
    let extent = |level: u32| wgpu::Extent3d {
        width: (size[0] >> level).max(1),
        height: (size[1] >> level).max(1),
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: extent(0),
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::R8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (level, texels) in (0..).zip(levels) {
        let extent = extent(level);
        let copy = wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() };
        let rows = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(extent.width),
            rows_per_image: None,
        };
        queue.write_texture(copy, texels, rows, extent);
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
