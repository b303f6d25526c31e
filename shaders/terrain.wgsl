// Ground that is not flat: the asphalt of the flat ground, shaded by its slopes, glossy and pale where it is slippery.

struct Point {
    // Relative to the terrain's own origin, m.
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) grip: f32,
}

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) local: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) grip: f32,
}

@vertex
fn vertex(in: Point) -> Varying {
    let local = in.position + frame.terrain.xyz;
    return Varying(frame.clip_from_local * vec4<f32>(local, 1.0), local, in.normal, in.grip);
}

// Dry ground loses this much when it is as slippery as ice.
const ICE = vec3<f32>(0.46, 0.56, 0.66);

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let normal = normalize(in.normal);
    let footprint = max(abs(dpdx(in.local.xy)), abs(dpdy(in.local.xy)));
    let albedo = marked(in.local.xy, footprint);
    let facing = max(dot(normal, frame.sun.xyz), 0.0);
    // Slopes see less of the sky.
    let sky = GREY_SKY * (0.5 + 0.5 * normal.z);
    var light = tone_grey(albedo * (sky + GREY_SUN * facing)) * GREY_TINT;
    let distance = length(frame.eye.xyz - in.local) * frame.eye.w;
    let slick = smoothstep(0.0, 0.75, 1.0 - in.grip);
    if slick > 0.0 {
        light = mix(light, glazed(in.local, normal, albedo, facing), slick);
    }
    return vec4<f32>(mix(light, HAZE, haze(distance)), 1.0);
}

// Ice: bluish, even, and it mirrors the sky the flatter one looks.
fn glazed(local: vec3<f32>, normal: vec3<f32>, albedo: f32, facing: f32) -> vec3<f32> {
    let to_eye = normalize(mix(-frame.forward.xyz, frame.eye.xyz - local, frame.eye.w));
    let body = ICE * (0.30 + 1.1 * albedo);
    let grazing = 1.0 - max(dot(normal, to_eye), 0.0);
    let mirror = 0.06 + 0.55 * grazing * grazing * grazing * grazing;
    let halfway = max(dot(normal, normalize(to_eye + frame.sun.xyz)), 0.0);
    let spark = pow(halfway, 90.0) * 0.8 * step(0.001, facing);
    return tone(body * (SUN_LIGHT * facing + ambient(normal)) * (1.0 - mirror) + sky_light(reflect(-to_eye, normal)) * mirror + SUN_LIGHT * spark);
}
