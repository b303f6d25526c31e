// The sky above the horizon, with the sun's glow.

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Ray {
    // A terrain may end a little below the horizon; the gap is haze.
    return screen_corner(index, true, select(0.0, 0.25, frame.terrain.w > 0.5));
}

@fragment
fn fragment(ray: Ray) -> @location(0) vec4<f32> {
    let direction = normalize(ray.direction);
    let height = max(direction.z, 0.0);
    // Most of the change is near the horizon, where the air is thickest.
    let clear = 1.0 - exp(-height * 5.5);
    let glow = max(dot(direction, frame.sun.xyz), 0.0);
    return vec4<f32>(far_sky(clear, glow * glow * glow * glow), 1.0);
}
