// Depth of the robots as the sun sees them.

@vertex
fn vertex(in: Corner, instance: Instance) -> @builtin(position) vec4<f32> {
    return frame.shadow_from_local * vec4<f32>(place(instance, in.position), 1.0);
}
