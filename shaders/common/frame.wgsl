// What every pass knows of a view. Positions are relative to a local origin near the formation, so that
// single precision is enough wherever in the world the robots are.
struct Frame {
    clip_from_local: mat4x4<f32>,
    shadow_from_local: mat4x4<f32>,
    // Eye; w is 1 for perspective, 0 for a parallel projection.
    eye: vec4<f32>,
    // Axes of the view, the first two scaled to half the picture, the last towards its middle and one deep. The horizon
    // is at the normalised height up.w, rises by right.w per half width, and has the sky above it where forward.w is 1,
    // below where −1.
    right: vec4<f32>,
    up: vec4<f32>,
    forward: vec4<f32>,
    // Towards the sun; w is the penumbra in texels of the shadow map, 0 without shadows.
    sun: vec4<f32>,
    // x: 1 over the distance at which haze begins, 1/m; y: exposure of a sensor; z: strength of the grid;
    // w: spare.
    ground: vec4<f32>,
    // The terrain's origin; w is 1 where there is a terrain.
    terrain: vec4<f32>,
    // x: depth up to which props are seen through, so that they do not hide the robots; y: 1 where the depth of
    // paint is tested; z: how far from a surface its light is looked up.
    spare: vec4<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;
