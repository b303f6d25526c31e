// Robots: paint, glass, rubber and the shell in sun and sky light.

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) local: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) albedo: vec3<f32>,
    // x: gloss, y: light of its own, z, w: place on the roof.
    @location(3) surface: vec4<f32>,
    // x: number or −1, y: opacity, z: height of the ground below.
    @location(4) @interpolate(flat) marks: vec3<f32>,
}

@group(2) @binding(0) var digits: texture_2d<f32>;
@group(2) @binding(1) var digit_sampler: sampler;

// Linear colour and gloss of each material, in the order of the models.
fn stuff(material: u32, paint: vec3<f32>, leads: bool) -> vec4<f32> {
    switch material {
        case 0u, 8u: { return vec4<f32>(paint, 1.0); }
        case 1u: { return vec4<f32>(0.022, 0.022, 0.025, 0.35); }
        case 2u: { return vec4<f32>(0.012, 0.016, 0.022, 1.6); }
        case 3u: { return vec4<f32>(0.77, 0.75, 0.71, 0.12); }
        case 4u: { return vec4<f32>(0.95, 0.93, 0.85, 0.8); }
        case 5u: { return vec4<f32>(0.62, 0.012, 0.012, 0.8); }
        case 6u: { return vec4<f32>(0.020, 0.020, 0.021, 0.08); }
        case 7u: { return vec4<f32>(0.52, 0.53, 0.55, 0.7); }
        case 9u: {
            if leads { return vec4<f32>(0.77, 0.45, 0.05, 0.9); }
            return vec4<f32>(paint * 0.45, 1.0);
        }
        default: { return vec4<f32>(0.42, 0.42, 0.42, 0.05); }
    }
}

fn placed(in: Corner, instance: Instance) -> Varying {
    var out: Varying;
    out.local = place(instance, in.position);
    out.clip = frame.clip_from_local * vec4<f32>(out.local, 1.0);
    out.normal = turn(instance, in.normal);
    let leads = instance.marks.y > 0.5;
    let made = stuff(in.material, instance.colour.rgb, leads);
    out.albedo = made.rgb;
    let own = select(select(0.0, 0.55, in.material == 5u), 0.9, in.material == 4u);
    out.surface = vec4<f32>(made.a, own, in.uv);
    out.marks = vec3<f32>(select(-1.0, instance.marks.x, in.material == 8u), instance.colour.a, instance.marks.z);
    return out;
}

@vertex
fn vertex(in: Corner, instance: Instance) -> Varying {
    return placed(in, instance);
}

// Ink of the number on the roof at `uv`, 0 to 1.
fn numeral(number: f32, uv: vec2<f32>, pixel: vec2<f32>) -> f32 {
    let count = select(select(1.0, 2.0, number > 9.5), 3.0, number > 99.5);
    // A digit is 0.62 as wide as high; three of them must share the roof.
    let height = min(0.82, 0.96 / (0.62 * count));
    let x = (uv.x - 0.5) / (0.62 * height) + 0.5 * count;
    let y = (uv.y - 0.5) / height + 0.5;
    let place = clamp(floor(x), 0.0, count - 1.0);
    let digit = floor(number / pow(10.0, count - 1.0 - place) + 0.001) % 10.0;
    let inside = x >= 0.0 && x < count && y >= 0.0 && y < 1.0;
    let at = vec2<f32>((digit + clamp(x - place, 0.02, 0.98)) * 0.1, clamp(y, 0.01, 0.99));
    // A digit is 64 texels high.
    let level = log2(max(max(pixel.x, pixel.y) * 64.0 / height, 1.0));
    let ink = textureSampleLevel(digits, digit_sampler, at, level).r;
    return select(0.0, ink, inside);
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let normal = normalize(in.normal);
    let to_eye = normalize(mix(-frame.forward.xyz, frame.eye.xyz - in.local, frame.eye.w));
    let distance = length(frame.eye.xyz - in.local) * frame.eye.w;
    var albedo = in.albedo;
    let pixel = abs(dpdx(in.surface.zw)) + abs(dpdy(in.surface.zw));
    if in.marks.x >= 0.0 {
        let ink = numeral(in.marks.x, in.surface.zw, pixel * 0.7);
        // Dark on light paint, light on dark paint.
        let bright = dot(albedo, vec3<f32>(0.21, 0.72, 0.07));
        albedo = mix(albedo, select(vec3<f32>(0.80), vec3<f32>(0.015), bright > 0.16), ink);
    }
    let facing = dot(normal, frame.sun.xyz);
    var sun = 0.0;
    if facing > 0.0 {
        sun = facing * sunlight_quick(in.local + normal * 0.012);
    }
    // Near the ground less of the sky is in sight.
    let open = 0.45 + 0.55 * clamp((in.local.z - in.marks.z) * 5.0, 0.0, 1.0);
    let diffuse = albedo * (SUN_LIGHT * sun + ambient(normal) * open);
    let grazing = 1.0 - max(dot(normal, to_eye), 0.0);
    let fresnel = 0.035 + 0.5 * grazing * grazing * grazing * grazing;
    let mirrored = reflect(-to_eye, normal);
    let seen = mix(BOUNCE * 0.8, sky_light(mirrored), smoothstep(-0.15, 0.15, mirrored.z));
    let halfway = max(dot(normal, normalize(to_eye + frame.sun.xyz)), 0.0);
    let h4 = halfway * halfway * halfway * halfway;
    let h16 = h4 * h4 * h4 * h4;
    let spark = h16 * h16 * h16 * h16 * 1.4 * select(0.0, 1.0, sun > 0.0) * sun;
    let shine = in.surface.x * (seen * fresnel * open + SUN_LIGHT * spark);
    let light = diffuse + shine + albedo * in.surface.y;
    return vec4<f32>(mix(developed(light), far_air(), haze(distance)), in.marks.y);
}

// Of robots that are small in the picture: all but the shadow at the corners, and no number on the roof, since processors
// would look it up for every pixel.
struct Small {
    @builtin(position) clip: vec4<f32>,
    @location(0) shadow: vec3<f32>,
    // Light of the sky, and share of haze.
    @location(1) sky: vec4<f32>,
    @location(2) sun: vec3<f32>,
}

fn lit_corner(in: Corner, instance: Instance) -> Small {
    let whole = placed(in, instance);
    let away = mix(-frame.forward.xyz, frame.eye.xyz - whole.local, frame.eye.w);
    let open = 0.45 + 0.55 * clamp((whole.local.z - whole.marks.z) * 5.0, 0.0, 1.0);
    let to_eye = normalize(away);
    let grazing = 1.0 - max(dot(whole.normal, to_eye), 0.0);
    let fresnel = 0.035 + 0.5 * grazing * grazing * grazing * grazing;
    let mirrored = reflect(-to_eye, whole.normal);
    let seen = mix(BOUNCE * 0.8, sky_light(mirrored), smoothstep(-0.15, 0.15, mirrored.z));
    let sky = whole.albedo * (ambient(whole.normal) * open + whole.surface.y) + whole.surface.x * fresnel * open * seen;
    let sun = whole.albedo * SUN_LIGHT * max(dot(whole.normal, frame.sun.xyz), 0.0);
    let hazy = haze(length(away) * frame.eye.w);
    return Small(whole.clip, shadow_place(whole.local + whole.normal * frame.spare.z), vec4<f32>(sky, hazy), sun);
}

@vertex
fn small_vertex(in: Corner, instance: Instance) -> Small {
    return lit_corner(in, instance);
}

@fragment
fn small(in: Small) -> @location(0) vec4<f32> {
    let light = developed(in.sky.rgb + in.sun * lit(in.shadow, 0.0, 0.0));
    return vec4<f32>(mix(light, far_air(), in.sky.a), 1.0);
}

// As monochrome cameras see it, whose values are proportional to light.
struct Plain {
    @builtin(position) clip: vec4<f32>,
    @location(0) shadow: vec3<f32>,
    // Of the sky and of the sun.
    @location(1) light: vec2<f32>,
}

@vertex
fn plain_vertex(in: Corner, instance: Instance) -> Plain {
    let whole = lit_corner(in, instance);
    let hazy = whole.sky.a;
    let light = vec2<f32>(mix(developed(whole.sky.rgb).r, far_air().r, hazy), developed(whole.sun).r * (1.0 - hazy));
    return Plain(whole.clip, whole.shadow, light);
}

@fragment
fn plain(in: Plain) -> @location(0) vec4<f32> {
    return vec4<f32>(in.light.x + in.light.y * lit(in.shadow, 0.0, 0.0));
}

// Ghosts are too faint for shadows and mirrors.
@fragment
fn ghost(in: Varying) -> @location(0) vec4<f32> {
    let sun = max(dot(in.normal, frame.sun.xyz), 0.0);
    // None right in front of the eye, where it would veil the picture.
    let near = mix(1.0, clamp((length(frame.eye.xyz - in.local) - 1.2) * 0.6, 0.0, 1.0), frame.eye.w);
    return vec4<f32>(developed(in.albedo * (SUN_LIGHT * sun + ambient(in.normal))), in.marks.y * near);
}

// Depth alone.
@fragment
fn hidden() -> @location(0) vec4<f32> {
    return vec4<f32>(0.0);
}
