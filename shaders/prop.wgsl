// Props: concrete, timber, cardboard and traffic cones in sun and sky light. Patterns are computed from the place on
// the thing in metres, so that they do not stretch with it.

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) local: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // On the thing, m, and its normal there.
    @location(2) spot: vec3<f32>,
    @location(3) side: vec3<f32>,
    // x: solid, y: mobility, z: height of the ground below.
    @location(4) @interpolate(flat) marks: vec4<f32>,
    @location(5) @interpolate(flat) size: vec3<f32>,
    @location(6) @interpolate(flat) colour: vec4<f32>,
}

const BLOCK = 0.0;
const CYLINDER = 1.0;
const CONE = 2.0;

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

fn concrete(base: vec3<f32>, at: vec4<f32>, grainy: f32, pixel: vec2<f32>, top: bool) -> vec3<f32> {
    // A pale edge where corners have worn, panels of a metre and a half.
    let inset = 0.5 * at.zw - abs(at.xy);
    let edge = 1.0 - smoothstep(0.0, 0.018 + max(pixel.x, pixel.y), min(inset.x, inset.y));
    var colour = base * (0.80 + 0.40 * grainy);
    if !top {
        colour *= 1.0 - 0.38 * seams(at.x, 1.5, 0.014, pixel.x);
        // Dirt where it meets the ground.
        colour *= 0.78 + 0.22 * smoothstep(0.0, 0.22 * at.w + 0.02, at.y + 0.5 * at.w);
    }
    return mix(colour, base * 1.25, 0.55 * edge);
}

fn timber(base: vec3<f32>, at: vec4<f32>, grainy: f32, pixel: vec2<f32>) -> vec3<f32> {
    let least = min(at.z, at.w);
    let inset = 0.5 * at.zw - abs(at.xy);
    let rim = min(inset.x, inset.y);
    let wide = max(pixel.x, pixel.y);
    let plank = least / 4.0;
    var colour = base * (0.82 + 0.36 * grainy);
    colour *= 0.90 + 0.20 * fract(sin(floor(at.y / plank + 0.5) * 12.9898) * 43758.5453);
    colour *= 1.0 - 0.62 * seams(at.y, plank, 0.05 * plank, pixel.y);
    // A frame of lighter battens, and the shade below it.
    let batten = 0.13 * least;
    let framed = clamp((batten - rim) / max(wide, 1e-4) + 0.5, 0.0, 1.0);
    colour *= 1.0 - 0.45 * band(rim, batten, batten * 1.22, wide);
    return mix(colour, base * (1.12 + 0.25 * grainy), framed);
}

fn painted(in: Varying, grainy: f32) -> vec3<f32> {
    let base = in.colour.rgb;
    let spot = in.spot;
    let pixel = max(abs(dpdx(spot)), abs(dpdy(spot)));
    let at = face(spot, in.size, in.side);
    let area = max(abs(dpdx(at.xy)), abs(dpdy(at.xy)));
    let high = spot.z / in.size.z;
    let fine = pixel.z / in.size.z;
    let guided = in.marks.y > 1.5;
    if in.marks.x == CONE {
        let white = max(band(high, 0.36, 0.56, fine), 0.0);
        return mix(base, vec3<f32>(0.80), white) * (0.92 + 0.16 * grainy);
    }
    if in.marks.x == CYLINDER {
        let ring = max(band(high, 0.80, 0.90, fine), 0.6 * band(high, -1.0, 0.08, fine)) * (1.0 - step(0.7, in.side.z));
        let ink = select(base * 0.42, vec3<f32>(0.80), guided);
        return mix(base * (0.86 + 0.28 * grainy), ink, ring);
    }
    if in.marks.x == BLOCK {
        if guided {
            let stripe = band(abs(at.y) / max(at.w, 1e-4), 0.0, 0.07, area.y / max(at.w, 1e-4));
            return mix(base * (0.92 + 0.16 * grainy), vec3<f32>(0.80), stripe * (1.0 - step(0.7, in.side.z)));
        }
        if in.marks.y > 0.5 {
            return timber(base, at, grainy, area);
        }
        return concrete(base, at, grainy, area, in.side.z > 0.7);
    }
    // A ramp: chevrons on its slope point up, its sides show the layers of the board.
    var colour = base * (0.84 + 0.32 * grainy);
    if in.side.z > 0.05 {
        let every = clamp(0.34 * in.size.y, 0.05, 0.6);
        let along = spot.x + abs(spot.y) - 0.5 * in.size.x;
        let stripe = seams(along, every, 0.34 * every, pixel.x + pixel.y);
        let inset = 0.5 * in.size.y - abs(spot.y);
        let inner = clamp((inset - 0.09 * in.size.y) / max(pixel.y, 1e-4) + 0.5, 0.0, 1.0);
        colour = mix(colour, base * 0.22, stripe * inner * 0.85);
    } else {
        colour *= 0.82 - 0.30 * seams(spot.z, 0.08, 0.012, pixel.z);
    }
    return colour;
}

struct Painted {
    @location(0) colour: vec4<f32>,
    @builtin(sample_mask) samples: u32,
}

// Which of four samples a prop covers that stands between the eye and the robots; with one sample a pixel, which
// pixels.
fn veil(clip: vec4<f32>, depth: f32) -> u32 {
    let share = clamp((depth - frame.spare.x) * 2.0, 0.0, 1.0);
    let count = 1u + u32(share * 3.0 + 0.5);
    let first = (u32(clip.x) & 1u) + 2u * (u32(clip.y) & 1u);
    let bits = ((1u << count) - 1u) << first;
    return (bits | (bits >> 4u)) & 15u;
}

@fragment
fn fragment(in: Varying) -> Painted {
    let samples = veil(in.clip, dot(in.local - frame.eye.xyz, frame.forward.xyz));
    let normal = normalize(in.normal);
    let at = face(in.spot, in.size, in.side);
    let grainy = textureSample(asphalt, asphalt_sampler, at.xy * vec2<f32>(0.9, select(0.9, 0.16, in.marks.y == 1.0))).r;
    let albedo = painted(in, grainy);
    let distance = length(frame.eye.xyz - in.local) * frame.eye.w;
    let facing = dot(normal, frame.sun.xyz);
    var sun = 0.0;
    if facing > 0.0 {
        sun = facing * sunlight_quick(in.local + normal * 0.025);
    }
    // The foot sees less of the sky.
    let open = 0.55 + 0.45 * clamp((in.local.z - in.marks.z) * 2.5, 0.0, 1.0);
    let light = albedo * (SUN_LIGHT * sun + ambient(normal) * open);
    return Painted(vec4<f32>(mix(tone(light), HAZE, haze(distance)), 1.0), samples);
}
