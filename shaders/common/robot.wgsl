// A corner of a model, and one of its copies on stage.

struct Corner {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) material: u32,
}

struct Instance {
    // Rows of local_from_model.
    @location(4) row_x: vec4<f32>,
    @location(5) row_y: vec4<f32>,
    @location(6) row_z: vec4<f32>,
    // Linear colour of the paint, and opacity.
    @location(7) colour: vec4<f32>,
    // x: number on the roof, negative for none; y: 1 for lead robots; z: height of the ground below;
    // w: tag of the first face of the shell, negative for none.
    @location(8) marks: vec4<f32>,
}

fn place(instance: Instance, position: vec3<f32>) -> vec3<f32> {
    let p = vec4<f32>(position, 1.0);
    return vec3<f32>(dot(instance.row_x, p), dot(instance.row_y, p), dot(instance.row_z, p));
}

fn turn(instance: Instance, normal: vec3<f32>) -> vec3<f32> {
    let n = vec3<f32>(dot(instance.row_x.xyz, normal), dot(instance.row_y.xyz, normal), dot(instance.row_z.xyz, normal));
    return normalize(n);
}
