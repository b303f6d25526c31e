// The outside of shells: white paper with a tag printed on every face.

// Codes of the tags: the low 32 bits and the high four.
@group(2) @binding(0) var codes: texture_2d<u32>;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) local: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // Column and row on the tag.
    @location(2) cell: vec2<f32>,
    // Height of the ground below.
    @location(3) @interpolate(flat) ground: f32,
    // The code, and in bit 8 of its high part whether there is one.
    @location(4) @interpolate(flat) code: vec2<u32>,
}

@vertex
fn vertex(in: Corner, instance: Instance) -> Varying {
    var out: Varying;
    out.local = place(instance, in.position);
    out.clip = frame.clip_from_local * vec4<f32>(out.local, 1.0);
    out.normal = turn(instance, in.normal);
    out.cell = in.uv;
    out.ground = instance.marks.z;
    out.code = vec2<u32>(0u);
    if instance.marks.w > -0.5 {
        // Faces have the tags that follow that of the first.
        let id = i32(instance.marks.w + 0.5) + i32(in.material);
        out.code = textureLoad(codes, vec2<i32>(id, 0), 0).xy | vec2<u32>(0u, 256u);
    }
    return out;
}

// Share of a pixel short of a straight edge `away` from its middle: its footprint, seen along the edge, is the sum of two
// boxes `wide` across.
fn before(away: vec2<f32>, wide: vec2<f32>, thin: vec2<f32>) -> vec2<f32> {
    let t = abs(away);
    let reach = 0.5 * (wide + thin);
    let slope = 0.5 + t / wide;
    let rest = max(reach - t, vec2<f32>(0.0));
    let tail = 1.0 - rest * rest / (2.0 * wide * max(thin, 1e-6 * wide));
    let inside = select(tail, slope, t <= 0.5 * (wide - thin));
    return select(1.0 - inside, inside, away > vec2<f32>(0.0));
}

fn black(code: vec2<u32>, column: i32, row: i32) -> bool {
    if column == 1 || column == 8 || row == 1 || row == 8 {
        return true;
    }
    let bit = u32(6 * (row - 2) + column - 2);
    return ((select(code.x, code.y, bit > 31u) >> (bit & 31u)) & 1u) == 0u;
}

// Share of a pixel that is ink: exact along straight edges however they run, whatever the size of the cells.
fn ink(at: vec2<f32>, code: vec2<u32>, across: vec2<f32>, down: vec2<f32>) -> f32 {
    let wide = max(max(abs(across), abs(down)), vec2<f32>(1e-6));
    let thin = min(abs(across), abs(down));
    let reach = 0.5 * (wide + thin);
    let low = vec2<i32>(clamp(floor(at - reach), vec2<f32>(1.0), vec2<f32>(9.0)));
    let high = vec2<i32>(clamp(floor(at + reach), vec2<f32>(0.0), vec2<f32>(8.0)));
    var sum = 0.0;
    if (code.y & 256u) == 0u {
        return 0.0;
    }
    for (var row = low.y; row <= high.y; row++) {
        let y = vec2<f32>(0.0, f32(row));
        let over = before(y.yy + vec2<f32>(0.0, 1.0) - at.yy, wide.yy, thin.yy);
        var line = 0.0;
        for (var column = low.x; column <= high.x; column++) {
            let x = f32(column) - at.x;
            let share = before(vec2<f32>(x, x + 1.0), wide.xx, thin.xx);
            line += select(0.0, share.y - share.x, black(code, column, row));
        }
        sum += line * (over.y - over.x);
    }
    return sum;
}

const PAPER = vec3<f32>(0.77, 0.75, 0.71);
const INK = vec3<f32>(0.026, 0.026, 0.028);

// Paper is dull: nothing is mirrored that could move an edge.
@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let printed = ink(in.cell, in.code, dpdx(in.cell), dpdy(in.cell));
    let normal = normalize(in.normal);
    let distance = length(frame.eye.xyz - in.local) * frame.eye.w;
    let sun = max(dot(normal, frame.sun.xyz), 0.0) * sunlight_quick(in.local + normal * 0.012);
    let open = 0.45 + 0.55 * clamp((in.local.z - in.ground) * 5.0, 0.0, 1.0);
    let light = mix(PAPER, INK, printed) * (SUN_LIGHT * sun + ambient(normal) * open);
    return vec4<f32>(mix(developed(light), far_air(), haze(distance)), 1.0);
}
