// Ground and sky are rectangles of the screen; their rays meet the world in the fragment shader.

struct Ray {
    @builtin(position) clip: vec4<f32>,
    @location(0) start: vec3<f32>,
    @location(1) direction: vec3<f32>,
}

// Corner `index` of the rectangle between two normalised heights, at the far end of depth.
fn screen_corner(index: u32, low: f32, high: f32) -> Ray {
    let x = f32(i32(index & 1u) * 2 - 1);
    let y = select(low, high, (index & 2u) != 0u);
    let across = frame.right.xyz * x + frame.up.xyz * y;
    var ray: Ray;
    ray.clip = vec4<f32>(x, y, 1.0, 1.0);
    ray.start = frame.eye.xyz + across * (1.0 - frame.eye.w);
    ray.direction = frame.forward.xyz + across * frame.eye.w;
    return ray;
}
