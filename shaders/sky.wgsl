// The sky above the horizon, with the sun's glow.

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Ray {
    return screen_corner(index, clamp(frame.up.w, -1.0, 1.0), 1.0);
}

@fragment
fn fragment(ray: Ray) -> @location(0) vec4<f32> {
    return vec4<f32>(tone(sky_light(normalize(ray.direction))), 1.0);
}
