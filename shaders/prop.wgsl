// Props: concrete, timber, cardboard and traffic cones in sun and sky light. Patterns are computed from the place on
// the thing in metres, so that they do not stretch with it.

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) local: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // On the thing, m, and its normal there.
    @location(2) spot: vec3<f32>,
    @location(3) side: vec3<f32>,
    // x: 1 for what moves by itself; z: height of the ground below.
    @location(4) @interpolate(flat) marks: vec4<f32>,
    @location(5) @interpolate(flat) size: vec3<f32>,
    @location(6) @interpolate(flat) colour: vec4<f32>,
}

@vertex
fn vertex(in: Corner, instance: Instance) -> Varying {
    var out: Varying;
    let rows = mat3x3<f32>(instance.row_x.xyz, instance.row_y.xyz, instance.row_z.xyz);
    let columns = transpose(rows);
    let size = max(vec3<f32>(length(columns[0]), length(columns[1]), length(columns[2])), vec3<f32>(1e-4));
    out.local = place(instance, in.position);
    out.clip = frame.clip_from_local * vec4<f32>(out.local, 1.0);
    // Scaled along its axes: normals go by the inverse.
    out.normal = turn(instance, in.normal / (size * size));
    out.spot = in.position * size;
    out.side = in.normal;
    out.marks = instance.marks;
    out.size = size;
    out.colour = instance.colour;
    return out;
}

// Coverage of a band from `low` to `high`, smoothed over a pixel.
fn band(at: f32, low: f32, high: f32, pixel: f32) -> f32 {
    let soft = max(pixel, 1e-4);
    return clamp((at - low) / soft + 0.5, 0.0, 1.0) * clamp((high - at) / soft + 0.5, 0.0, 1.0);
}

// Seams `width` wide every `every`.
fn seams(at: f32, every: f32, width: f32, pixel: f32) -> f32 {
    let away = abs(fract(at / every + 0.5) - 0.5) * every;
    let faded = clamp(every / max(pixel, 1e-4) * 0.5 - 1.0, 0.0, 1.0);
    return clamp((0.5 * width - away) / max(pixel, 1e-4) + 0.5, 0.0, 1.0) * faded * min(width / max(pixel, 1e-4), 1.0);
}

// Place and size on the face of a box that looks along `side`: across and up.
fn face(spot: vec3<f32>, size: vec3<f32>, side: vec3<f32>) -> vec4<f32> {
    let away = abs(side);
    let middle = spot - vec3<f32>(0.0, 0.0, 0.5 * size.z);
    if away.z > 0.7 {
        return vec4<f32>(middle.xy, size.xy);
    }
    if away.x > away.y {
        return vec4<f32>(middle.yz, size.yz);
    }
    return vec4<f32>(middle.xz, size.xz);
}

// What a place on a prop is, found out once for all patterns.
struct Spot {
    // Place and size on its face.
    at: vec4<f32>,
    // Size of a pixel across and up the face, and over the height of the prop.
    pixel: vec2<f32>,
    rise: f32,
    // Share of the height.
    high: f32,
    grainy: f32,
    upward: bool,
}

fn spotted(in: Varying, stretch: f32) -> Spot {
    var spot: Spot;
    spot.at = face(in.spot, in.size, in.side);
    spot.pixel = max(abs(dpdx(spot.at.xy)), abs(dpdy(spot.at.xy)));
    spot.high = in.spot.z / in.size.z;
    spot.rise = max(abs(dpdx(spot.high)), abs(dpdy(spot.high)));
    spot.grainy = textureSample(asphalt, asphalt_sampler, spot.at.xy * vec2<f32>(0.9, stretch)).r;
    spot.upward = in.side.z > 0.7;
    return spot;
}

// Opacity at a depth: a prop between the eye and the robots must not hide them.
fn veil(depth: f32) -> f32 {
    return mix(0.2, 1.0, smoothstep(0.0, 0.6, depth - frame.spare.x));
}

fn lighted(in: Varying, albedo: vec3<f32>) -> vec4<f32> {
    let normal = normalize(in.normal);
    let away = in.local - frame.eye.xyz;
    let facing = dot(normal, frame.sun.xyz);
    let sun = max(facing, 0.0) * sunlight_quick(in.local + normal * 0.025);
    // The foot sees less of the sky.
    let open = 0.55 + 0.45 * clamp((in.local.z - in.marks.z) * 2.5, 0.0, 1.0);
    let light = developed(albedo * (SUN_LIGHT * sun + ambient(normal) * open));
    let colour = mix(light, far_air(), haze(length(away) * frame.eye.w));
    return vec4<f32>(colour, veil(dot(away, frame.forward.xyz)));
}

// Every material has its own entry point: processors would work out all patterns for every pixel.
@fragment
fn concrete(in: Varying) -> @location(0) vec4<f32> {
    let spot = spotted(in, 0.9);
    let base = in.colour.rgb;
    // A pale edge where corners have worn, panels of a metre and a half.
    let inset = 0.5 * spot.at.zw - abs(spot.at.xy);
    let edge = 1.0 - smoothstep(0.0, 0.018 + max(spot.pixel.x, spot.pixel.y), min(inset.x, inset.y));
    // Dirt where it meets the ground.
    let dirt = 0.78 + 0.22 * smoothstep(0.0, 0.22 * spot.at.w + 0.02, spot.at.y + 0.5 * spot.at.w);
    let side = (1.0 - 0.38 * seams(spot.at.x, 1.5, 0.014, spot.pixel.x)) * dirt;
    let colour = base * (0.80 + 0.40 * spot.grainy) * select(side, 1.0, spot.upward);
    return lighted(in, mix(colour, base * 1.25, 0.55 * edge));
}

@fragment
fn timber(in: Varying) -> @location(0) vec4<f32> {
    let spot = spotted(in, 0.16);
    let base = in.colour.rgb;
    let least = min(spot.at.z, spot.at.w);
    let inset = 0.5 * spot.at.zw - abs(spot.at.xy);
    let rim = min(inset.x, inset.y);
    let wide = max(spot.pixel.x, spot.pixel.y);
    let plank = least / 4.0;
    var colour = base * (0.82 + 0.36 * spot.grainy);
    // Every plank is of another tree.
    colour *= 0.90 + 0.20 * fract(floor(spot.at.y / plank + 0.5) * 0.618);
    colour *= 1.0 - 0.62 * seams(spot.at.y, plank, 0.05 * plank, spot.pixel.y);
    // A frame of lighter battens, and the shade below it.
    let batten = 0.13 * least;
    let framed = clamp((batten - rim) / max(wide, 1e-4) + 0.5, 0.0, 1.0);
    colour *= 1.0 - 0.45 * band(rim, batten, batten * 1.22, wide);
    return lighted(in, mix(colour, base * (1.12 + 0.25 * spot.grainy), framed));
}

@fragment
fn machine(in: Varying) -> @location(0) vec4<f32> {
    let spot = spotted(in, 0.9);
    let up = max(spot.at.w, 1e-4);
    let stripe = band(abs(spot.at.y) / up, 0.0, 0.07, spot.pixel.y / up) * select(1.0, 0.0, spot.upward);
    return lighted(in, mix(in.colour.rgb * (0.92 + 0.16 * spot.grainy), vec3<f32>(0.80), stripe));
}

@fragment
fn pillar(in: Varying) -> @location(0) vec4<f32> {
    let spot = spotted(in, 0.9);
    let base = in.colour.rgb;
    let bands = max(band(spot.high, 0.80, 0.90, spot.rise), 0.6 * band(spot.high, -1.0, 0.08, spot.rise));
    let ink = select(base * 0.42, vec3<f32>(0.80), in.marks.x > 0.5);
    return lighted(in, mix(base * (0.86 + 0.28 * spot.grainy), ink, bands * select(1.0, 0.0, spot.upward)));
}

@fragment
fn cone(in: Varying) -> @location(0) vec4<f32> {
    let spot = spotted(in, 0.9);
    let white = band(spot.high, 0.36, 0.56, spot.rise);
    return lighted(in, mix(in.colour.rgb, vec3<f32>(0.80), white) * (0.92 + 0.16 * spot.grainy));
}

// Chevrons on the slope point up; the sides show the layers of the board.
@fragment
fn ramp(in: Varying) -> @location(0) vec4<f32> {
    let spot = spotted(in, 0.9);
    let pixel = max(abs(dpdx(in.spot)), abs(dpdy(in.spot)));
    let every = clamp(0.34 * in.size.y, 0.05, 0.6);
    let along = in.spot.x + abs(in.spot.y) - 0.5 * in.size.x;
    let stripe = seams(along, every, 0.34 * every, pixel.x + pixel.y);
    let inset = 0.5 * in.size.y - abs(in.spot.y);
    let inner = clamp((inset - 0.09 * in.size.y) / max(pixel.y, 1e-4) + 0.5, 0.0, 1.0);
    let slope = mix(vec3<f32>(1.0), vec3<f32>(0.30), stripe * inner);
    let layers = vec3<f32>(0.82 - 0.30 * seams(in.spot.z, 0.08, 0.012, pixel.z));
    let board = in.colour.rgb * (0.84 + 0.32 * spot.grainy);
    return lighted(in, board * select(layers, slope, in.side.z > 0.05));
}
