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
pub(crate) use shell::{camera, faces};
pub(crate) use solid::solids;
pub(crate) use wheel::wheel;

/// Material of a surface; the shader's table has the same order.
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

/// How much of a robot is modelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Detail {
    /// What robots need to see of each other, in half as many triangles: for pictures by the hundred.
    Coarse,
    /// Without what is lost in a crowd.
    Plain,
    Full,
}

impl Detail {
    /// In order.
    pub(crate) const ALL: [Self; 3] = [Self::Coarse, Self::Plain, Self::Full];

    /// What shows of robots that are up to so many pixels high: plainer models are drawn up to three times as fast.
    pub(crate) fn at(height: f64) -> Self {
        match height {
            ..24.0 => Self::Coarse,
            ..64.0 => Self::Plain,
            _ => Self::Full,
        }
    }
}

/// Body, shell and mast of a robot, all that moves as one.
pub(crate) fn body(detail: Detail, build: &Build) -> Mesh {
    let mut mesh = Mesh::default();
    body::build(&mut mesh, detail, build);
    shell::build(&mut mesh, detail, build);
    mesh
}

/// The outline of a robot, with few faces: what a ghost needs.
pub(crate) fn ghost(build: &Build) -> Mesh {
    let mut mesh = Mesh::default();
    body::outline(&mut mesh, Detail::Plain);
    build.fit(&mut mesh);
    shell::outline(&mut mesh, build);
    mesh
}
