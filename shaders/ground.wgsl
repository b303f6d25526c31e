// The ground: asphalt and metre lines in full sun; shadows are painted over it.

@group(2) @binding(0) var asphalt: texture_2d<f32>;
@group(2) @binding(1) var asphalt_sampler: sampler;
@group(2) @binding(2) var patches: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Ray {
    return screen_corner(index, -1.0, clamp(frame.up.w, -1.0, 1.0));
}

// Sky on flat ground and a sun straight above it, as numbers, and the tint that their grey has when displayed.
const GREY_SKY = 0.41;
const GREY_SUN = 2.063;
const GREY_TINT = vec3<f32>(1.012, 1.0, 0.985);

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

@fragment
fn fragment(ray: Ray) -> @location(0) vec4<f32> {
    // Also the depth of the point, since the ray's direction is one deep.
    let reach = -ray.start.z / min(ray.direction.z, -1e-5);
    let local = ray.start.xy + ray.direction.xy * reach;
    let footprint = max(abs(dpdx(local)), abs(dpdy(local)));
    // A little sharper than the rule, which goes by the longer side of the footprint.
    let fine = textureSampleBias(asphalt, asphalt_sampler, local * 0.5, -0.8).r;
    let broad = textureSampleLevel(patches, asphalt_sampler, local.yx * 0.05, 0.0).r;
    let grain = 0.155 * (0.42 + 1.16 * fine) * (0.74 + 0.52 * broad);
    let density = 1.0 / max(footprint, vec2<f32>(1e-5));
    let painted = max(lines(local, density, 1.0, 0.014) * 0.34, lines(local, density, 5.0, 0.030) * 0.66);
    let albedo = mix(grain, 0.66, painted * frame.ground.z);
    return vec4<f32>(mix(tone_grey(albedo * (GREY_SKY + GREY_SUN * frame.sun.z)) * GREY_TINT, HAZE, haze(reach * frame.eye.w)), 1.0);
}
