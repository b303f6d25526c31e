//! The robots' shapes, modelled in code: x forward, y left, z up, m, the origin on the ground under the rear axle.

mod body;
mod mesh;
mod shell;
mod wheel;

pub(crate) use mesh::{Mesh, Vertex};
pub(crate) use wheel::RADIUS as WHEEL_RADIUS;

/// What a surface is made of; the shader's table has the same order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Material {
    Paint = 0,
    Plastic = 1,
    Glass = 2,
    Shell = 3,
    Headlight = 4,
    TailLight = 5,
    Tyre = 6,
    Metal = 7,
    Roof = 8,
    Stripe = 9,
    Lining = 10,
}

/// Body, shell and mast of a robot, all that moves as one; `plain` leaves out what is lost in a crowd.
pub(crate) fn body(plain: bool) -> Mesh {
    let mut mesh = Mesh::default();
    body::build(&mut mesh, plain);
    shell::build(&mut mesh, plain);
    mesh
}

/// The outline of a robot, with few faces: what a ghost needs.
pub(crate) fn ghost() -> Mesh {
    let mut mesh = Mesh::default();
    body::outline(&mut mesh);
    shell::outline(&mut mesh);
    mesh
}

/// A wheel around its hub, the outer face to the left.
pub(crate) fn wheel(plain: bool) -> Mesh {
    wheel::wheel(plain)
}

/// The camera's head around its pan axis.
pub(crate) fn camera() -> Mesh {
    shell::camera()
}

/// Where the camera's head sits, in the frame of the body.
pub(crate) const CAMERA: [f32; 3] = [0.105, 0.0, 0.30];
