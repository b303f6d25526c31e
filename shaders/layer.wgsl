// Robots drawn apart, with several samples a pixel, laid over the ground.

@group(0) @binding(0) var layer: texture_2d<f32>;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    // Column and row, texels.
    @location(0) texel: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let share = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    let clip = vec4<f32>(share.x * 2.0 - 1.0, 1.0 - share.y * 2.0, 0.0, 1.0);
    return Varying(clip, share * vec2<f32>(textureDimensions(layer)));
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    return textureLoad(layer, vec2<i32>(in.texel), 0);
}
