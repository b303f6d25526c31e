// The outside of shells: white paper with a tag printed on every face.

// Codes of the tags: the low 32 bits and the high four.
@group(2) @binding(0) var codes: texture_2d<u32>;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) shadow: vec3<f32>,
    // Column and row on the tag.
    @location(1) cell: vec2<f32>,
    // Light of the sky on a face, which is as good as even over it, and share of haze.
    @location(2) sky: vec4<f32>,
    // How much a face looks into the sun.
    @location(3) @interpolate(flat) facing: f32,
    // The code, and in bit 8 of its high part whether there is one.
    @location(4) @interpolate(flat) code: vec2<u32>,
}

@vertex
fn vertex(in: Corner, instance: Instance) -> Varying {
    var out: Varying;
    let local = place(instance, in.position);
    let normal = turn(instance, in.normal);
    out.clip = frame.clip_from_local * vec4<f32>(local, 1.0);
    out.shadow = shadow_place(local + normal * frame.spare.z);
    out.cell = in.uv;
    let open = 0.45 + 0.55 * clamp((local.z - instance.marks.z) * 5.0, 0.0, 1.0);
    out.sky = vec4<f32>(ambient(normal) * open, haze(length(frame.eye.xyz - local) * frame.eye.w));
    out.facing = max(dot(normal, frame.sun.xyz), 0.0);
    out.code = vec2<u32>(0u);
    if instance.marks.w > -0.5 {
        // Faces have the tags that follow that of the first.
        let id = i32(instance.marks.w + 0.5) + i32(in.material);
        out.code = textureLoad(codes, vec2<i32>(id, 0), 0).xy | vec2<u32>(0u, 256u);
    }
    return out;
}

// A pixel's footprint along one side of the cells: the sum of two boxes, as an edge across that side meets it.
struct Footprint {
    reach: f32,
    // Up to here from the middle its density is even.
    even: f32,
    density: f32,
    // Of the tails.
    bend: f32,
}

fn footprint(a: f32, b: f32) -> Footprint {
    let wide = max(max(abs(a), abs(b)), 1e-6);
    let thin = max(min(abs(a), abs(b)), 1e-6 * wide);
    return Footprint(0.5 * (wide + thin), 0.5 * (wide - thin), 1.0 / wide, 0.5 / (wide * thin));
}

// Share of a footprint that is short of an edge `away` from its middle.
fn short(away: f32, pixel: Footprint) -> f32 {
    let t = abs(away);
    let rest = max(pixel.reach - t, 0.0);
    let share = select(0.5 - rest * rest * pixel.bend, t * pixel.density, t <= pixel.even);
    return 0.5 + select(-share, share, away > 0.0);
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
    let wide = footprint(across.x, down.x);
    let high = footprint(across.y, down.y);
    let reach = vec2<f32>(wide.reach, high.reach);
    let first = vec2<i32>(clamp(floor(at - reach), vec2<f32>(1.0), vec2<f32>(9.0)));
    let none = (code.y & 256u) == 0u;
    let last = select(vec2<i32>(clamp(floor(at + reach), vec2<f32>(0.0), vec2<f32>(8.0))), vec2<i32>(0), none);
    var sum = 0.0;
    var over = short(f32(first.y) - at.y, high);
    for (var row = first.y; row <= last.y; row++) {
        let under = short(f32(row + 1) - at.y, high);
        var line = 0.0;
        var left = short(f32(first.x) - at.x, wide);
        for (var column = first.x; column <= last.x; column++) {
            let right = short(f32(column + 1) - at.x, wide);
            line += select(0.0, right - left, black(code, column, row));
            left = right;
        }
        sum += line * (under - over);
        over = under;
    }
    return sum;
}

const PAPER = vec3<f32>(0.77, 0.75, 0.71);
const INK = vec3<f32>(0.026, 0.026, 0.028);

// Paper is dull: nothing is mirrored that could move an edge.
@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let printed = ink(in.cell, in.code, dpdx(in.cell), dpdy(in.cell));
    let light = mix(PAPER, INK, printed) * (in.sky.rgb + SUN_LIGHT * (in.facing * soft(in.shadow, 0.6 * frame.sun.w)));
    return vec4<f32>(mix(developed(light), far_air(), in.sky.a), 1.0);
}
