// The ground: asphalt and metre lines in full sun; shadows are painted over it.

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Ray {
    return screen_corner(index, false, 0.0);
}

@fragment
fn fragment(ray: Ray) -> @location(0) vec4<f32> {
    // Also the depth of the point, since the ray's direction is one deep.
    let reach = -ray.start.z / min(ray.direction.z, -1e-5);
    let local = ray.start.xy + ray.direction.xy * reach;
    let footprint = max(abs(dpdx(local)), abs(dpdy(local)));
    let albedo = marked(local, footprint);
    let light = developed_grey(albedo * (GREY_SKY + GREY_SUN * frame.sun.z));
    return vec4<f32>(mix(light, far_air(), haze(reach * frame.eye.w)), 1.0);
}
