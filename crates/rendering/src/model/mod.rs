//! The robots' shapes, modelled in code: x forward, y left, z up, m, the origin on the ground under the rear axle.

mod body;
mod build;
mod chassis;
mod mesh;
mod shell;
mod solid;
mod wheel;

pub(crate) use build::{Build, size};
pub(crate) use mesh::{Mesh, Vertex};
pub(crate) use solid::solids;

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
pub(crate) fn body(plain: bool, build: &Build) -> Mesh {
    let mut mesh = Mesh::default();
    body::build(&mut mesh, plain, build);
    shell::build(&mut mesh, plain, build);
    mesh
}

/// The outline of a robot, with few faces: what a ghost needs.
pub(crate) fn ghost(build: &Build) -> Mesh {
    let mut mesh = Mesh::default();
    body::outline(&mut mesh);
    build.fit(&mut mesh);
    shell::outline(&mut mesh, build);
    mesh
}

/// A wheel around its hub, the outer face to the left; with `lugs` for rough ground.
pub(crate) fn wheel(plain: bool, lugs: bool) -> Mesh {
    wheel::wheel(plain, lugs)
}

/// The camera's head around its pan axis.
pub(crate) fn camera() -> Mesh {
    shell::camera()
}

/// The outside of the faces that carry tags; the body leaves them out.
pub(crate) fn faces(build: &Build) -> Mesh {
    shell::faces(build)
}
