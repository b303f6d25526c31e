// A texture laid over what is drawn, a texel a pixel.

@group(0) @binding(0) var picture: texture_2d<f32>;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    // Column and row, texels.
    @location(0) texel: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Varying {
    let share = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    let clip = vec4<f32>(share.x * 2.0 - 1.0, 1.0 - share.y * 2.0, 0.0, 1.0);
    return Varying(clip, share * vec2<f32>(textureDimensions(picture)));
}

fn texel_of(in: Varying) -> vec4<f32> {
    return textureLoad(picture, vec2<i32>(in.texel), 0);
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    return texel_of(in);
}

// For a target that encodes what is written into it.
@fragment
fn decoded(in: Varying) -> @location(0) vec4<f32> {
    let shown = texel_of(in);
    let low = shown.rgb / 12.92;
    let high = pow((shown.rgb + 0.055) / 1.055, vec3<f32>(2.4));
    return vec4<f32>(select(high, low, shown.rgb < vec3<f32>(0.04045)), shown.a);
}
