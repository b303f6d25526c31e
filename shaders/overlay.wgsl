// Flat shapes in front of the picture: panels, curves and marks, with smooth edges of their own.

struct Screen {
    // Pixels of the picture.
    size: vec2<f32>,
    spare: vec2<f32>,
}

@group(0) @binding(0) var<uniform> screen: Screen;

struct OverlayVertex {
    // Pixels from the upper left.
    @location(0) position: vec2<f32>,
    // Where this corner is in the shape, in pixels from its middle.
    @location(1) offset: vec2<f32>,
    // Half the shape's sides in pixels, and the radius of its corners.
    @location(2) half_size: vec3<f32>,
    @location(3) colour: vec4<f32>,
}

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) offset: vec2<f32>,
    @location(1) @interpolate(flat) half_size: vec3<f32>,
    @location(2) @interpolate(flat) colour: vec4<f32>,
}

@vertex
fn vertex(in: OverlayVertex) -> Varying {
    let at = in.position / screen.size * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    return Varying(vec4<f32>(at, 0.0, 1.0), in.offset, in.half_size, in.colour);
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let beyond = abs(in.offset) - in.half_size.xy + in.half_size.z;
    let away = length(max(beyond, vec2<f32>(0.0))) + min(max(beyond.x, beyond.y), 0.0) - in.half_size.z;
    return vec4<f32>(in.colour.rgb, in.colour.a * clamp(0.5 - away, 0.0, 1.0));
}
