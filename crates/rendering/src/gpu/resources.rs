//! Textures, buffers and bind groups of a device, without what is the same for all of them.

use crate::Gpu;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, Buffer, BufferDescriptor, BufferUsages, Extent3d,
    ShaderStages, TexelCopyBufferLayout, TextureDescriptor, TextureDimension, TextureFormat,
    TextureSampleType, TextureUsages, TextureViewDimension,
};

impl Gpu {
    /// A buffer of `size` bytes.
    pub(crate) fn buffer(&self, label: &str, size: u64, usage: BufferUsages) -> Buffer {
        self.device.create_buffer(&BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        })
    }

    /// Layout of a bind group that `stages` see, with bindings from 0 on.
    pub(crate) fn layout(&self, label: &str, stages: ShaderStages, types: &[BindingType]) -> BindGroupLayout {
        let entry = |(binding, ty): (u32, &BindingType)| BindGroupLayoutEntry {
            binding,
            visibility: stages,
            ty: *ty,
            count: None,
        };
        let entries: Vec<_> = (0..).zip(types).map(entry).collect();
        let descriptor = BindGroupLayoutDescriptor { label: Some(label), entries: &entries };
        self.device.create_bind_group_layout(&descriptor)
    }

    /// A bind group of resources in the order of their bindings.
    pub(crate) fn group(
        &self,
        label: &str,
        layout: &BindGroupLayout,
        resources: Vec<BindingResource<'_>>,
    ) -> BindGroup {
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        self.device.create_bind_group(&BindGroupDescriptor { label: Some(label), layout, entries: &entries })
    }
}

/// The binding of a texture that is read by texels of a kind.
pub(crate) fn sampled(sample_type: TextureSampleType) -> BindingType {
    BindingType::Texture { sample_type, view_dimension: TextureViewDimension::D2, multisampled: false }
}

/// A texture in two dimensions, of one level with one sample a texel.
pub(crate) fn flat_texture(
    label: &str,
    [width, height]: [u32; 2],
    format: TextureFormat,
    usage: TextureUsages,
) -> TextureDescriptor<'_> {
    TextureDescriptor {
        label: Some(label),
        size: Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}

/// Texels in rows of `pitch` bytes.
pub(crate) fn rows(pitch: u32) -> TexelCopyBufferLayout {
    TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None }
}
