// Asphalt with metre lines on it, for ground that is flat and for ground that is not.

@group(2) @binding(0) var asphalt: texture_2d<f32>;
@group(2) @binding(1) var asphalt_sampler: sampler;
@group(2) @binding(2) var patches: texture_2d<f32>;

// GREY_SKY and GREY_SUN, the light of the sky on flat ground and of a sun straight above it, stand in `gpu/passes/mod.rs`.

// Coverage of lines `width` m wide every `every` m, where a metre has `density` pixels along each axis.
// Lines thinner than a pixel are drawn a pixel wide and fainter, so that they fade instead of shimmering.
fn lines(at: vec2<f32>, density: vec2<f32>, every: f32, width: f32) -> f32 {
    let away = abs(fract(at * (1.0 / every) - 0.5) - 0.5) * every;
    let strength = min(density * width, vec2<f32>(1.0));
    let edge = max(density * (0.5 * width), vec2<f32>(0.5)) + 0.5;
    // Beyond half a line to a pixel only the mean is left.
    let resolved = clamp(density * every - 1.0, vec2<f32>(0.0), vec2<f32>(1.0));
    let drawn = clamp(edge - away * density, vec2<f32>(0.0), vec2<f32>(1.0)) * strength * resolved;
    return max(drawn.x, drawn.y);
}

// Reflectance of the bare ground at a place.
fn grain(at: vec2<f32>) -> f32 {
    // A little sharper than the rule, which goes by the longer side of the footprint.
    let fine = textureSampleBias(asphalt, asphalt_sampler, at * 0.5, -0.8).r;
    if !FINE {
        return 0.155 * (0.42 + 1.16 * fine);
    }
    let broad = textureSampleLevel(patches, asphalt_sampler, at.yx * 0.05, 0.0).r;
    return 0.155 * (0.42 + 1.16 * fine) * (0.74 + 0.52 * broad);
}

// The same with the lines on it, where a pixel covers `footprint` m.
fn marked(at: vec2<f32>, footprint: vec2<f32>) -> f32 {
    if !FINE {
        return grain(at);
    }
    let density = 1.0 / max(footprint, vec2<f32>(1e-5));
    let painted = max(lines(at, density, 1.0, 0.014) * 0.34, lines(at, density, 5.0, 0.030) * 0.66);
    return mix(grain(at), 0.66, painted * frame.ground.z);
}
