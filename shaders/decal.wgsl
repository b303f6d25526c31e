// Paint on the ground: tyre marks, ribbons, rings, arrows, edges, and over them shadows and contact patches.

struct DecalVertex {
    // Relative to the local origin, m.
    @location(0) position: vec3<f32>,
    // x: kind; y: inner radius of a ring or softness of a blob.
    @location(1) kind: vec2<f32>,
    // Across and along the shape, −1 to 1.
    @location(2) shape: vec2<f32>,
    // Display-encoded colour and opacity.
    @location(3) colour: vec4<f32>,
}

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) local: vec3<f32>,
    @location(1) kind: vec2<f32>,
    @location(2) shape: vec2<f32>,
    @location(3) colour: vec4<f32>,
}

@vertex
fn vertex(in: DecalVertex) -> Varying {
    var clip = frame.clip_from_local * vec4<f32>(in.position, 1.0);
    if frame.spare.y > 0.5 {
        // On hills and decks depth is tested: a little nearer than the floor in which it lies.
        let away = in.position - frame.eye.xyz;
        let pull = 0.012 + 0.004 * length(away) * frame.eye.w;
        let near = frame.clip_from_local * vec4<f32>(in.position - normalize(mix(frame.forward.xyz, away, frame.eye.w)) * pull, 1.0);
        clip.z = near.z / near.w * clip.w;
    }
    return Varying(clip, in.position, in.kind, in.shape, in.colour);
}

fn coverage(kind: vec2<f32>, shape: vec2<f32>, pixel: vec2<f32>) -> f32 {
    // 0: solid between the long sides, 1: ring, 2: soft blob, 3: soft box.
    if kind.x < 0.5 {
        return clamp((1.0 - abs(shape.x)) / max(pixel.x, 1e-4), 0.0, 1.0);
    }
    let radius = length(shape);
    if kind.x < 1.5 {
        let soft = max(max(pixel.x, pixel.y), 1e-4);
        return clamp((1.0 - radius) / soft, 0.0, 1.0) * clamp((radius - kind.y) / soft, 0.0, 1.0);
    }
    if kind.x < 2.5 {
        let inside = max(1.0 - radius, 0.0);
        return inside * inside * (3.0 - 2.0 * inside);
    }
    let edge = clamp((1.0 - abs(shape)) / (1.0 - kind.y), vec2<f32>(0.0), vec2<f32>(1.0));
    let eased = edge * edge * (3.0 - 2.0 * edge);
    return eased.x * eased.y;
}

fn hazy(in: Varying, cover: f32) -> vec4<f32> {
    let distance = length(frame.eye.xyz - in.local) * frame.eye.w;
    return vec4<f32>(in.colour.rgb, in.colour.a * cover * (1.0 - haze(distance)));
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let across = dpdx(in.shape);
    let down = dpdy(in.shape);
    let pixel = sqrt(across * across + down * down);
    return covering(hazy(in, coverage(in.kind, in.shape, pixel)));
}

fn unit_share(at: f32, full: f32, pixel: f32) -> f32 {
    let off = abs(fract(at) - 0.5) * 2.0;
    return clamp((full - off) / max(2.0 * pixel, 1e-4) + 0.5, 0.0, 1.0);
}

// What is drawn to explain has forms of its own. 4: dashes, 5: stripes over a tint, 6: glow around a circle.
@fragment
fn sketch(in: Varying) -> @location(0) vec4<f32> {
    let across = dpdx(in.shape);
    let down = dpdy(in.shape);
    let pixel = sqrt(across * across + down * down);
    var cover = coverage(in.kind, in.shape, pixel);
    if in.kind.x > 5.5 {
        let near = max(1.0 - abs(length(in.shape) - in.kind.y) / (1.0 - in.kind.y), 0.0);
        cover = near * near;
    } else if in.kind.x > 4.5 {
        // Stripes finer than pixels are a tint.
        let clear = clamp(2.0 - 4.0 * pixel.x, 0.0, 1.0);
        cover = mix(0.35, 1.0, mix(in.kind.y, unit_share(in.shape.x, in.kind.y, pixel.x), clear));
    } else if in.kind.x > 3.5 {
        let side = clamp((1.0 - abs(in.shape.x)) / max(pixel.x, 1e-4), 0.0, 1.0);
        cover = side * unit_share(in.shape.y, in.kind.y, pixel.y);
    }
    return covering(hazy(in, cover));
}

// Apart from the others: processors would look at the shadow map for every decal.
@fragment
fn shadow(in: Varying) -> @location(0) vec4<f32> {
    return shading(hazy(in, 1.0 - sunlight(in.local)));
}

// The same with edges of one softness.
@fragment
fn shadow_quick(in: Varying) -> @location(0) vec4<f32> {
    return shading(hazy(in, 1.0 - soft(shadow_place(in.local), frame.sun.w)));
}
