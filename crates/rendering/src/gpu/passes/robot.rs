//! Robots and their ghosts: a few models, drawn as often as there are copies.

use super::frame::FrameGroups;
use super::instanced::{Instance, InstancedMeshes, LAYOUTS};
use super::{Canvas, Recipe, developed, mipped, shader, shrink, textured};
use crate::Gpu;
use crate::annotation::text_shaper::digits;
use crate::gpu::model::{self, Build, Detail};
use glam::Vec3;
use std::ops::Range;
use wgpu::RenderPass;

pub(crate) const SHADERS: [&str; 2] = developed!("common/light", "common/robot", "robot");

/// Copies of robots that share their measures.
#[derive(Debug, Clone, Default)]
pub(crate) struct Squad {
    pub(crate) bodies: Vec<Instance>,
    pub(crate) wheels: Vec<Instance>,
    pub(crate) ghosts: Vec<Instance>,
}

/// Copies that are drawn together.
#[derive(Debug, Clone, Default)]
pub(crate) struct RobotInstances {
    /// Where they begin among all that are on the device.
    pub(crate) first: u32,
    pub(crate) squads: Vec<Squad>,
    pub(crate) cameras: Vec<Instance>,
}

impl RobotInstances {
    /// In the order in which they lie on the device.
    fn copies(&self) -> impl Iterator<Item = &Instance> {
        self.solid().chain(self.squads.iter().flat_map(|s| &s.ghosts))
    }

    /// What casts shadows.
    pub(crate) fn solid(&self) -> impl Iterator<Item = &Instance> {
        let robots = self.squads.iter().flat_map(|s| [&s.bodies, &s.wheels]);
        robots.chain([&self.cameras]).flatten()
    }
}

/// Where the meshes of a build are, those of what is solid for each detail.
#[derive(Debug)]
struct MeshRanges {
    body: [Range<u32>; 3],
    wheel: [Range<u32>; 3],
    faces: Range<u32>,
    ghost: Range<u32>,
}

/// Models on the device, and the copies of this picture.
#[derive(Debug)]
pub(crate) struct Models {
    meshes: InstancedMeshes,
    kits: Vec<MeshRanges>,
    camera: [Range<u32>; 3],
    /// Opposite corners of a box that holds a robot, for each build, in the frame of its body, m.
    pub(crate) bounds: Vec<[Vec3; 2]>,
}

impl Models {
    /// One set of models for each build.
    pub(crate) fn new(gpu: &Gpu, builds: &[Build]) -> Self {
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        let mut add = |mesh: &model::Mesh| mesh.weld(&mut vertices, &mut indices);
        let wheels = [false, true].map(|lugs| Detail::ALL.map(|detail| add(&model::wheel(detail, lugs))));
        let camera = Detail::ALL.map(|detail| add(&model::camera(detail)));
        let (mut kits, mut bounds) = (Vec::new(), Vec::new());
        for build in builds {
            let bodies = Detail::ALL.map(|detail| model::body(detail, build));
            let [faces, ghost] = [model::faces(build), model::ghost(build)];
            bounds.push(build.bounds(bodies.iter().chain([&faces, &ghost])));
            kits.push(MeshRanges {
                body: bodies.each_ref().map(&mut add),
                wheel: wheels[usize::from(build.lugs())].clone(),
                faces: add(&faces),
                ghost: add(&ghost),
            });
        }
        Self { meshes: InstancedMeshes::new(gpu, &vertices, &indices), kits, camera, bounds }
    }

    /// Brings the copies of all crowds to the device and notes where each crowd begins.
    pub(crate) fn fill<'a>(&mut self, gpu: &Gpu, crowds: impl Iterator<Item = &'a mut RobotInstances>) {
        let mut all: Vec<Instance> = Vec::new();
        for crowd in crowds {
            crowd.first = all.len() as u32;
            all.extend(crowd.copies());
        }
        self.meshes.fill(gpu, &all);
    }

    /// Bodies, wheels and cameras, without the faces of shells.
    pub(crate) fn draw_solid(&self, pass: &mut RenderPass<'_>, crowd: &RobotInstances, detail: Detail) {
        let level = detail as usize;
        let squads = self.kits.iter().zip(&crowd.squads);
        let parts = squads.flat_map(|(kit, squad)| {
            [(&kit.body[level], squad.bodies.len()), (&kit.wheel[level], squad.wheels.len())]
        });
        self.draw(pass, crowd.first, parts.chain([(&self.camera[level], crowd.cameras.len())]));
    }

    /// The faces of shells.
    pub(crate) fn draw_faces(&self, pass: &mut RenderPass<'_>, crowd: &RobotInstances) {
        let squads = self.kits.iter().zip(&crowd.squads);
        let parts =
            squads.flat_map(|(kit, squad)| [(&kit.faces, squad.bodies.len()), (&NONE, squad.wheels.len())]);
        self.draw(pass, crowd.first, parts);
    }

    fn draw_ghosts(&self, pass: &mut RenderPass<'_>, crowd: &RobotInstances) {
        let solid: usize = crowd.squads.iter().map(|s| s.bodies.len() + s.wheels.len()).sum();
        let first = crowd.first + (solid + crowd.cameras.len()) as u32;
        let squads = self.kits.iter().zip(&crowd.squads);
        self.draw(pass, first, squads.map(|(kit, squad)| (&kit.ghost, squad.ghosts.len())));
    }

    /// Draws meshes with their numbers of copies; the copies follow each other from `first` on.
    fn draw<'a>(
        &self,
        pass: &mut RenderPass<'_>,
        mut first: u32,
        parts: impl Iterator<Item = (&'a Range<u32>, usize)>,
    ) {
        self.meshes.bind(pass);
        for (mesh, copies) in parts {
            let last = first + copies as u32;
            if last > first && !mesh.is_empty() {
                pass.draw_indexed(mesh.clone(), 0, first..last);
            }
            first = last;
        }
    }
}

const NONE: Range<u32> = 0..0;

/// Pipelines for what is solid and what is not.
#[derive(Debug)]
pub(crate) struct RobotPass {
    solid: wgpu::RenderPipeline,
    /// Where they are small.
    small: wgpu::RenderPipeline,
    ghost_depth: wgpu::RenderPipeline,
    ghost: wgpu::RenderPipeline,
    digits: wgpu::BindGroup,
}

impl RobotPass {
    /// The robots' pipelines, the first canvas for their ghosts, and the texture of the numbers on their roofs.
    pub(crate) fn new(gpu: &Gpu, [flat, canvas]: [Canvas; 2], groups: &FrameGroups) -> Self {
        let (texels, width, height) = digits();
        let texture = mipped(gpu, "digits", [width, height], &shrink(texels, width, height)[..4]);
        let sampler = wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        };
        let (layout, digits) = textured(gpu, "digits", &[&texture], &sampler);
        let recipe = Recipe {
            label: "robot",
            source: canvas.of(SHADERS),
            groups: &[&groups.view_layout, &groups.light_layout, &layout],
            buffers: &LAYOUTS,
            cull: true,
            colour: Some((canvas, None)),
            depth: Some((wgpu::CompareFunction::Less, true)),
            ..Default::default()
        };
        let (vertex, entry) = if canvas.mono { ("plain_vertex", "plain") } else { ("small_vertex", "small") };
        let blended = Some((flat, Some(wgpu::BlendState::ALPHA_BLENDING)));
        let equal = Some((wgpu::CompareFunction::LessEqual, false));
        Self {
            solid: recipe.build(gpu),
            small: Recipe { vertex, entry, ..recipe }.build(gpu),
            ghost_depth: Recipe {
                label: "ghost depth",
                entry: "hidden",
                colour: Some((flat, None)),
                write: wgpu::ColorWrites::empty(),
                ..recipe
            }
            .build(gpu),
            ghost: Recipe { label: "ghost", entry: "ghost", colour: blended, depth: equal, ..recipe }
                .build(gpu),
            digits,
        }
    }

    pub(crate) fn draw_solid(
        &self,
        pass: &mut RenderPass<'_>,
        models: &Models,
        crowd: &RobotInstances,
        detail: Detail,
    ) {
        pass.set_pipeline(if detail == Detail::Coarse { &self.small } else { &self.solid });
        pass.set_bind_group(2, &self.digits, &[]);
        models.draw_solid(pass, crowd, detail);
    }

    /// Depth first, so that only the faces in front shine through; that of the robots, too, where they are drawn apart.
    pub(crate) fn draw_ghosts(
        &self,
        pass: &mut RenderPass<'_>,
        models: &Models,
        crowd: &RobotInstances,
        apart: bool,
    ) {
        if crowd.squads.iter().all(|s| s.ghosts.is_empty()) {
            return;
        }
        pass.set_bind_group(2, &self.digits, &[]);
        pass.set_pipeline(&self.ghost_depth);
        if apart {
            models.draw_solid(pass, crowd, Detail::Coarse);
            models.draw_faces(pass, crowd);
        }
        models.draw_ghosts(pass, crowd);
        pass.set_pipeline(&self.ghost);
        models.draw_ghosts(pass, crowd);
    }
}
