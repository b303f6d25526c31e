// Ground that is not flat: the asphalt of the flat ground, shaded by its slopes, glossy and pale where it is slippery.

struct TerrainVertex {
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
fn vertex(in: TerrainVertex) -> Varying {
    let local = in.position + frame.terrain.xyz;
    return Varying(frame.clip_from_local * vec4<f32>(local, 1.0), local, in.normal, in.grip);
}

// What the ground is made of at a place, and the light on it, hazed.
struct Bare {
    albedo: f32,
    facing: f32,
    light: vec3<f32>,
    haze: f32,
}

fn bare(in: Varying, normal: vec3<f32>) -> Bare {
    var ground: Bare;
    let footprint = max(abs(dpdx(in.local.xy)), abs(dpdy(in.local.xy)));
    ground.albedo = marked(in.local.xy, footprint);
    ground.facing = max(dot(normal, frame.sun.xyz), 0.0);
    // Slopes see less of the sky.
    let sky = GREY_SKY * (0.5 + 0.5 * normal.z);
    ground.light = developed_grey(ground.albedo * (sky + GREY_SUN * ground.facing));
    ground.haze = haze(length(frame.eye.xyz - in.local) * frame.eye.w);
    return ground;
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let ground = bare(in, normalize(in.normal));
    return vec4<f32>(mix(ground.light, far_air(), ground.haze), 1.0);
}

const ICE = vec3<f32>(0.50, 0.62, 0.74);

// Slippery ground: bluish, even, and it mirrors the sky the flatter one looks.
@fragment
fn slick(in: Varying) -> @location(0) vec4<f32> {
    let normal = normalize(in.normal);
    let ground = bare(in, normal);
    let to_eye = normalize(mix(-frame.forward.xyz, frame.eye.xyz - in.local, frame.eye.w));
    let body = ICE * (0.34 + 1.1 * ground.albedo);
    let grazing = 1.0 - max(dot(normal, to_eye), 0.0);
    let mirror = 0.06 + 0.55 * grazing * grazing * grazing * grazing;
    let halfway = max(dot(normal, normalize(to_eye + frame.sun.xyz)), 0.0);
    let spark = pow(halfway, 90.0) * 0.8 * step(0.001, ground.facing);
    let diffuse = body * (SUN_LIGHT * ground.facing + ambient(normal)) * (1.0 - mirror);
    let ice = developed(diffuse + sky_light(reflect(-to_eye, normal)) * mirror + SUN_LIGHT * spark);
    let share = smoothstep(0.0, 0.75, 1.0 - in.grip);
    return vec4<f32>(mix(mix(ground.light, ice, share), far_air(), ground.haze), 1.0);
}
