//! A finished texture, laid into a pass.

use super::{Recipe, shader};
use crate::Gpu;
use crate::gpu::passes::Canvas;
use crate::gpu::resources::sampled;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, BlendState, RenderPass, RenderPipeline, ShaderStages,
    TextureFormat, TextureSampleType, TextureView,
};

pub(crate) const SHADER: &str = shader!("texture");

/// Draws a texture over the whole viewport of a pass, each texel as it is: where the viewport has the texture's size, a texel
/// a pixel. Cheaper on processors than a shader that filters.
#[derive(Debug)]
pub struct TexturePass {
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
}

/// A texture as [`TexturePass`] reads it.
#[derive(Debug, Clone)]
pub struct TextureBinding(BindGroup);

impl TexturePass {
    /// For passes into one target of a format with one sample a pixel and no depth, which it covers; the texture's values are
    /// display-encoded.
    pub fn new(gpu: &Gpu, format: TextureFormat) -> Self {
        let recipe = Recipe {
            entry: if format.is_srgb() { "decoded" } else { "fragment" },
            colour: Some((Canvas { format, samples: 1, mono: false }, None)),
            ..Recipe::default()
        };
        Self::over(gpu, recipe)
    }

    /// The same for a viewport of another size than the texture's: texels are blended between their centres.
    pub fn stretching(gpu: &Gpu, format: TextureFormat) -> Self {
        let recipe = Recipe {
            entry: if format.is_srgb() { "stretched_decoded" } else { "stretched" },
            colour: Some((Canvas { format, samples: 1, mono: false }, None)),
            ..Recipe::default()
        };
        Self::over(gpu, recipe)
    }

    /// For passes with depth, in which what is there shows through it.
    pub(super) fn layer(gpu: &Gpu, canvas: Canvas) -> Self {
        let recipe = Recipe {
            colour: Some((canvas, Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING))),
            depth: Some((wgpu::CompareFunction::Always, false)),
            ..Recipe::default()
        };
        Self::over(gpu, recipe)
    }

    fn over(gpu: &Gpu, recipe: Recipe<'_>) -> Self {
        let texels = sampled(TextureSampleType::Float { filterable: false });
        let layout = gpu.layout("texture", ShaderStages::VERTEX_FRAGMENT, &[texels]);
        let pipeline = Recipe {
            label: "texture",
            source: SHADER,
            groups: &[&layout],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..recipe
        }
        .build(gpu);
        Self { layout, pipeline }
    }

    /// A texture made ready.
    pub fn bind(&self, gpu: &Gpu, view: &TextureView) -> TextureBinding {
        TextureBinding(gpu.group("texture", &self.layout, vec![BindingResource::TextureView(view)]))
    }

    /// Draws it over the viewport that is set.
    pub fn draw(&self, pass: &mut RenderPass<'_>, texture: &TextureBinding) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &texture.0, &[]);
        pass.draw(0..4, 0..1);
    }
}
