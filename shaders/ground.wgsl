// The ground: asphalt and metre lines in full sun; shadows are painted over it.

@group(2) @binding(0) var asphalt: texture_2d<f32>;
@group(2) @binding(1) var asphalt_sampler: sampler;
@group(2) @binding(2) var patches: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Ray {
    return screen_corner(index, -1.0, clamp(frame.up.w, -1.0, 1.0));
}

// Coverage of lines `width` m wide every `every` m; lines thinner than a pixel fade instead of shimmering.
fn lines(at: vec2<f32>, footprint: vec2<f32>, every: f32, width: f32) -> f32 {
    let coordinate = at / every;
    let pixel = footprint / every;
    let wanted = vec2<f32>(width / every);
    let drawn = clamp(pixel, wanted, vec2<f32>(0.5));
    let away = abs(fract(coordinate - 0.5) - 0.5) * 2.0;
    let soft = max(pixel * 1.5, vec2<f32>(1e-5));
    var cover = smoothstep(drawn + soft, drawn - soft, away) * clamp(wanted / drawn, vec2<f32>(0.0), vec2<f32>(1.0));
    cover = mix(cover, wanted, clamp(pixel * 2.0 - 1.0, vec2<f32>(0.0), vec2<f32>(1.0)));
    return max(cover.x, cover.y);
}

@fragment
fn fragment(ray: Ray) -> @location(0) vec4<f32> {
    let reach = -ray.start.z / min(ray.direction.z, -1e-5);
    let local = ray.start + ray.direction * reach;
    let footprint = max(abs(dpdx(local.xy)), abs(dpdy(local.xy)));
    let tiled = local.xy + frame.ground.xy;
    // Between the longer and the shorter side of the footprint: sharper than the rule, and still calm.
    let level = 0.5 * log2(footprint.x * footprint.y * 65536.0 + 1e-9);
    let fine = textureSampleLevel(asphalt, asphalt_sampler, tiled * 0.5, level).r;
    let broad = textureSampleLevel(patches, asphalt_sampler, tiled.yx * 0.05, 0.0).r;
    let distance = reach * length(ray.direction) * frame.eye.w;
    var albedo = vec3<f32>(0.156, 0.155, 0.153) * (0.42 + 1.16 * fine) * (0.74 + 0.52 * broad);
    let thin = lines(local.xy, footprint, 1.0, 0.014) * 0.30;
    let thick = lines(local.xy, footprint, 5.0, 0.030) * 0.62;
    albedo = mix(albedo, vec3<f32>(0.66, 0.66, 0.65), max(thin, thick) * frame.ground.z);
    let light = albedo * (SUN_LIGHT * frame.sun.z + ambient(vec3<f32>(0.0, 0.0, 1.0)));
    return vec4<f32>(mix(tone(light), HAZE, haze(distance)), 1.0);
}
