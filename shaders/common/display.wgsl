// From light to what a screen shows: a tone curve whose result is display-encoded.

// Far ground and the lowest sky, and the sky overhead.
const HAZE = vec3<f32>(0.835, 0.880, 0.915);
const BLUE = vec3<f32>(0.335, 0.560, 0.835);
// The tint of a grey ground when displayed.
const GREY_TINT = vec3<f32>(1.012, 1.0, 0.985);

// Whether the ground has broad patches, and lines where they are wanted, and shadows on bodies have soft edges.
const FINE = true;

// Filmic curve after Hejl and Burgess-Dawson.
fn developed(light: vec3<f32>) -> vec3<f32> {
    let x = max(light * 0.62 - 0.004, vec3<f32>(0.0));
    return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06);
}

// The same curve for a grey.
fn developed_grey(light: f32) -> vec3<f32> {
    let x = max(light * 0.62 - 0.004, 0.0);
    return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06) * GREY_TINT;
}

// What far things turn into.
fn far_air() -> vec3<f32> {
    return HAZE;
}

// The sky where `clear` of its haze is gone, with the glow of the sun.
fn far_sky(clear: f32, glow: f32) -> vec3<f32> {
    let warm = vec3<f32>(0.20, 0.15, 0.06) * clear * glow;
    return min(mix(HAZE, BLUE, clear) + warm, vec3<f32>(0.99));
}

// Paint, whose colour is display-encoded already.
fn covering(colour: vec4<f32>) -> vec4<f32> {
    return colour;
}

// A cast shadow of some opacity.
fn shading(colour: vec4<f32>) -> vec4<f32> {
    return colour;
}
