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

// The texels around a place, by how near their centres are.
fn blended(in: Varying) -> vec4<f32> {
    let place = in.texel - 0.5;
    let corner = vec2<i32>(floor(place));
    let share = fract(place);
    let most = vec2<i32>(textureDimensions(picture)) - 1;
    let first = max(corner, vec2<i32>(0));
    let last = min(corner + 1, most);
    let upper = mix(textureLoad(picture, first, 0), textureLoad(picture, vec2<i32>(last.x, first.y), 0), share.x);
    let lower = mix(textureLoad(picture, vec2<i32>(first.x, last.y), 0), textureLoad(picture, last, 0), share.x);
    return mix(upper, lower, share.y);
}

// For targets that encode what is written into them.
fn linear_of(shown: vec4<f32>) -> vec4<f32> {
    let low = shown.rgb / 12.92;
    let high = pow((shown.rgb + 0.055) / 1.055, vec3<f32>(2.4));
    return vec4<f32>(select(high, low, shown.rgb < vec3<f32>(0.04045)), shown.a);
}

@fragment
fn decoded(in: Varying) -> @location(0) vec4<f32> {
    return linear_of(texel_of(in));
}

@fragment
fn stretched(in: Varying) -> @location(0) vec4<f32> {
    return blended(in);
}

@fragment
fn stretched_decoded(in: Varying) -> @location(0) vec4<f32> {
    return linear_of(blended(in));
}
