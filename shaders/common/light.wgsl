// Light shared by all surfaces: sun, sky, haze and shadow.

const SUN_LIGHT = vec3<f32>(2.30, 2.06, 1.72);
const ZENITH = vec3<f32>(0.15, 0.38, 0.86);
const HORIZON = vec3<f32>(0.98, 1.13, 1.28);
const BOUNCE = vec3<f32>(0.26, 0.25, 0.235);

@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;

// Colour of the sky towards `direction` (unit length).
fn sky_light(direction: vec3<f32>) -> vec3<f32> {
    let height = max(direction.z, 0.0);
    let climb = 1.0 - (1.0 - height) * (1.0 - height);
    let towards = max(dot(direction, frame.sun.xyz), 0.0);
    let glow = towards * towards * towards * towards;
    return mix(HORIZON, ZENITH, sqrt(climb)) + vec3<f32>(0.22, 0.16, 0.08) * glow * glow;
}

// Light from sky and ground on a surface facing `normal`.
fn ambient(normal: vec3<f32>) -> vec3<f32> {
    let sky = mix(HORIZON, ZENITH, 0.55) * 0.56;
    return mix(BOUNCE, sky, 0.5 + 0.5 * normal.z);
}

// Share of haze in front of something `distance` m away.
fn haze(distance: f32) -> f32 {
    let beyond = max(distance * frame.ground.x - 1.0, 0.0) * 0.42;
    return beyond * beyond / (1.0 + beyond * beyond) * 0.4 + beyond / (1.0 + beyond) * 0.6;
}

fn lit(at: vec3<f32>, x: f32, y: f32) -> f32 {
    return textureSampleCompareLevel(shadow_map, shadow_sampler, at.xy + vec2<f32>(x, y), at.z);
}

// The same place in the shadow map and its depth there; outside the map, depth is negative.
fn shadow_place(local: vec3<f32>) -> vec3<f32> {
    let clip = frame.shadow_from_local * vec4<f32>(local, 1.0);
    let outside = frame.sun.w == 0.0 || any(abs(clip.xy) > vec2<f32>(0.99));
    return vec3<f32>(clip.x * 0.5 + 0.5, 0.5 - clip.y * 0.5, select(clip.z, -1.0, outside));
}

// Share of the sun that reaches a point, 1 in the open, with edges soft enough for curved bodies.
fn sunlight_quick(local: vec3<f32>) -> f32 {
    let at = shadow_place(local);
    if !FINE {
        return lit(at, 0.0, 0.0);
    }
    return soft(at, frame.sun.w * 0.6);
}

// The same at a place in the shadow map, over `r` on all sides.
fn soft(at: vec3<f32>, r: f32) -> f32 {
    return 0.25 * (lit(at, -r, -r) + lit(at, r, -r) + lit(at, -r, r) + lit(at, r, r));
}

// The same with the wide, smooth edges that a flat ground shows.
fn sunlight(local: vec3<f32>) -> f32 {
    let at = shadow_place(local);
    // No less than a pixel: where robots are small their shadows would flicker.
    let footprint = abs(dpdx(at.xy)) + abs(dpdy(at.xy));
    let r = max(frame.sun.w, min(0.5 * max(footprint.x, footprint.y), 4.0 * frame.sun.w));
    let corners = lit(at, -r, -r) + lit(at, r, -r) + lit(at, -r, r) + lit(at, r, r);
    let h = r * 0.5;
    let sides = lit(at, -r, 0.0) + lit(at, r, 0.0) + lit(at, 0.0, -r) + lit(at, 0.0, r);
    let inner = lit(at, -h, -h) + lit(at, h, -h) + lit(at, -h, h) + lit(at, h, h);
    return (corners * 0.5 + sides * 0.75 + inner * 1.25 + lit(at, 0.0, 0.0) * 1.5) / 11.5;
}
