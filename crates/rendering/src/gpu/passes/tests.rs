//! Shaders without a device: they are valid, and their structures are those of Rust, byte for byte.

use super::instanced::{Instance, LAYOUTS};
use super::{SHADERS, decal, frame, overlay, terrain};
use crate::gpu::model::Vertex;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::mem::offset_of;

fn module(name: &str) -> naga::Module {
    let (_, sources) = SHADERS.iter().find(|(n, _)| *n == name).unwrap();
    let mut modules: Vec<_> = sources.iter().map(|source| parsed(name, source)).collect();
    modules.pop().unwrap()
}

fn parsed(name: &str, source: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(source);
    let module = module.unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(source)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    if let Err(error) = validator.validate(&module) {
        panic!("{name}: {}", error.emit_to_string(source));
    }
    module
}

/// Size and offsets of a structure in a shader.
fn shape(module: &naga::Module, name: &str) -> (u32, Vec<u32>) {
    let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no structure") };
    (*span, members.iter().map(|m| m.offset).collect())
}

/// Scalars of each vertex attribute of a structure, by location.
fn attributes(module: &naga::Module, name: &str) -> Vec<(u32, u32)> {
    let (_, found) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, .. } = &found.inner else { panic!("{name} is no structure") };
    let bytes = |m: &naga::StructMember| module.types[m.ty].inner.size(module.to_ctx());
    let location = |m: &naga::StructMember| match m.binding {
        Some(naga::Binding::Location { location, .. }) => location,
        _ => panic!("{name} has a member without location"),
    };
    members.iter().map(|m| (location(m), bytes(m))).collect()
}

/// The attributes fit the shader's, lie one after the other, and end where the structure ends.
fn agree(module: &naga::Module, name: &str, ours: &[wgpu::VertexAttribute], size: usize) {
    let theirs = attributes(module, name);
    let listed: Vec<_> = ours.iter().map(|a| (a.shader_location, a.format.size() as u32)).collect();
    assert_eq!(listed, theirs, "{name}");
    let mut end = 0;
    for attribute in ours {
        assert_eq!(attribute.offset, end, "{name}");
        end += attribute.format.size();
    }
    assert_eq!(end, size as u64, "{name}");
}

#[test]
fn every_shader_is_valid() {
    for (name, _) in SHADERS {
        let module = module(name);
        assert!(module.entry_points.iter().any(|e| e.name == "vertex"), "{name}");
    }
}

#[test]
fn the_frame_is_the_shaders_frame() {
    let (size, offsets) = shape(&module("ground"), "Frame");
    assert_eq!(size as usize, size_of::<frame::FrameUniforms>());
    let ours = [
        offset_of!(frame::FrameUniforms, clip_from_local),
        offset_of!(frame::FrameUniforms, shadow_from_local),
        offset_of!(frame::FrameUniforms, eye),
        offset_of!(frame::FrameUniforms, right),
        offset_of!(frame::FrameUniforms, up),
        offset_of!(frame::FrameUniforms, forward),
        offset_of!(frame::FrameUniforms, sun),
        offset_of!(frame::FrameUniforms, ground),
        offset_of!(frame::FrameUniforms, terrain),
        offset_of!(frame::FrameUniforms, spare),
    ];
    assert_eq!(offsets.iter().map(|o| *o as usize).collect::<Vec<_>>(), ours);
    // Views share a buffer at offsets that every adapter accepts.
    assert_eq!(size % 256, 0);
}

#[test]
fn vertices_are_the_shaders_vertices() {
    let robots = module("robot");
    let [corner, instance] = LAYOUTS;
    agree(&robots, "Corner", corner.attributes, size_of::<Vertex>());
    agree(&robots, "Instance", instance.attributes, size_of::<Instance>());
    let tags = module("tag");
    agree(&tags, "Corner", corner.attributes, size_of::<Vertex>());
    agree(&tags, "Instance", instance.attributes, size_of::<Instance>());
    let props = module("prop");
    agree(&props, "Corner", corner.attributes, size_of::<Vertex>());
    agree(&props, "Instance", instance.attributes, size_of::<Instance>());
    agree(
        &module("terrain"),
        "TerrainVertex",
        &terrain::TerrainPass::ATTRIBUTES,
        size_of::<terrain::TerrainVertex>(),
    );
    agree(&module("decal"), "DecalVertex", &decal::DecalPass::ATTRIBUTES, size_of::<decal::DecalVertex>());
    agree(
        &module("overlay"),
        "OverlayVertex",
        &overlay::OverlayPass::ATTRIBUTES,
        size_of::<overlay::OverlayVertex>(),
    );
}
