// Ground and sky are rectangles of the screen; their rays meet the world in the fragment shader.

struct Ray {
    @builtin(position) clip: vec4<f32>,
    @location(0) start: vec3<f32>,
    @location(1) direction: vec3<f32>,
}

// Corner `index` of what lies over the horizon or below it, at the far end of depth; the horizon is lowered by `dip`.
fn screen_corner(index: u32, over: bool, dip: f32) -> Ray {
    let x = f32(i32(index & 1u) * 2 - 1);
    // A horizon that leans leaves the screen on its way; one that is level is kept on it.
    let reach = select(100.0, 1.0, frame.right.w == 0.0);
    let up = frame.forward.w;
    let edge = clamp(frame.up.w + frame.right.w * x - dip * up, -reach, reach);
    let end = select(-reach, reach, over) * up;
    let y = select(edge, end, over == ((index & 2u) != 0u));
    let across = frame.right.xyz * x + frame.up.xyz * y;
    var ray: Ray;
    ray.clip = vec4<f32>(x, y, 1.0, 1.0);
    ray.start = frame.eye.xyz + across * (1.0 - frame.eye.w);
    ray.direction = frame.forward.xyz + across * frame.eye.w;
    return ray;
}
