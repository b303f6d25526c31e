// In place of the display: the sensor of a monochrome camera, whose values are proportional to light.

const LUMINANCE = vec3<f32>(0.2126, 0.7152, 0.0722);
// White paper that faces the sun comes to 0.85.
const GAIN = 0.464;
const HAZE_LIGHT = 1.10;
const BLUE_LIGHT = 0.37;

// A camera sees none of what is drawn to explain, and does without what costs time.
const FINE = false;

fn sensed(luminance: f32) -> vec3<f32> {
    return vec3<f32>(luminance * GAIN * frame.ground.y);
}

fn developed(light: vec3<f32>) -> vec3<f32> {
    return sensed(dot(light, LUMINANCE));
}

fn developed_grey(light: f32) -> vec3<f32> {
    return sensed(light);
}

fn far_air() -> vec3<f32> {
    return sensed(HAZE_LIGHT);
}

fn far_sky(clear: f32, glow: f32) -> vec3<f32> {
    return sensed(mix(HAZE_LIGHT, BLUE_LIGHT, clear) + 0.16 * clear * glow);
}

// Only the dark at the foot of things is painted: as dark in light as it looks on a screen.
fn covering(colour: vec4<f32>) -> vec4<f32> {
    let left = 1.0 - colour.a;
    return vec4<f32>(vec3<f32>(0.0), 1.0 - left * left);
}

// Shadows keep the sky's share of the light; on screens they are a little lighter than that.
fn shading(colour: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(vec3<f32>(0.0), colour.a * 1.25);
}
