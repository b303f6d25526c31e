//! Props: four solids, drawn as often as there are copies.

use super::asphalt::Asphalt;
use super::frame::FrameGroups;
use super::robot::{Instance, Models};
use super::{Canvas, Recipe, Stream, constant, shader};
use crate::model::solids;
use std::ops::Range;
use wgpu::{Device, Queue};

pub(crate) const SHADER: &str =
    shader!("common/frame", "common/light", "common/robot", "common/asphalt", "prop");

/// How a prop is painted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Look {
    Concrete,
    Timber,
    Machine,
    Pillar,
    Cone,
    Ramp,
}

impl Look {
    /// The shader's entry point of each look and the index of its solid, in the order of the copies.
    const ALL: [(&str, usize); 6] =
        [("concrete", 0), ("timber", 0), ("machine", 0), ("pillar", 1), ("cone", 2), ("ramp", 3)];
}

/// Copies of a picture, by look.
pub(crate) type Copies = [Vec<Instance>; Look::ALL.len()];

/// Solids on the device, their pipeline and the copies of this picture.
#[derive(Debug)]
pub(crate) struct PropPass {
    pipelines: Vec<wgpu::RenderPipeline>,
    vertices: Stream,
    indices: Stream,
    solids: Vec<Range<u32>>,
    instances: Stream,
}

impl PropPass {
    pub(crate) fn new(
        device: &Device,
        queue: &Queue,
        canvas: Canvas,
        groups: &FrameGroups,
        asphalt: &Asphalt,
    ) -> Self {
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        let solids = solids().map(|mesh| {
            let first = indices.len() as u32;
            mesh.weld(&mut vertices, &mut indices);
            first..indices.len() as u32
        });
        let (corners, triangles) = (bytemuck::cast_slice(&vertices), bytemuck::cast_slice(&indices));
        // Seen through where a prop stands before the robots; with one sample a pixel, whatever is farther and comes
        // later is lost behind it.
        let coverage = canvas.samples > 1;
        let blend = (!coverage).then_some(wgpu::BlendState::ALPHA_BLENDING);
        let recipe = Recipe {
            label: "prop",
            source: SHADER,
            groups: &[&groups.view_layout, &groups.light_layout, &asphalt.layout],
            buffers: &Models::LAYOUTS,
            cull: true,
            colour: Some((canvas, blend)),
            coverage,
            depth: Some((wgpu::CompareFunction::Less, true)),
            ..Default::default()
        };
        Self {
            pipelines: Look::ALL.map(|(entry, _)| Recipe { entry, ..recipe }.build(device)).to_vec(),
            vertices: constant(device, queue, "prop corners", wgpu::BufferUsages::VERTEX, corners),
            indices: constant(device, queue, "prop triangles", wgpu::BufferUsages::INDEX, triangles),
            solids: solids.to_vec(),
            instances: Stream::new(device, "props", wgpu::BufferUsages::VERTEX),
        }
    }

    pub(crate) fn fill(&mut self, device: &Device, queue: &Queue, copies: &Copies) {
        let all: Vec<Instance> = copies.iter().flatten().copied().collect();
        self.instances.fill(device, queue, bytemuck::cast_slice(&all));
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, asphalt: &Asphalt, copies: &Copies) {
        pass.set_bind_group(2, &asphalt.group, &[]);
        self.draw_each(pass, copies, |pass, look| pass.set_pipeline(&self.pipelines[look]));
    }

    /// The copies with whatever pipeline is set.
    pub(crate) fn draw_solid(&self, pass: &mut wgpu::RenderPass<'_>, copies: &Copies) {
        self.draw_each(pass, copies, |_, _| ());
    }

    fn draw_each(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        copies: &Copies,
        prepare: impl Fn(&mut wgpu::RenderPass<'_>, usize),
    ) {
        pass.set_vertex_buffer(0, self.vertices.slice());
        pass.set_vertex_buffer(1, self.instances.slice());
        pass.set_index_buffer(self.indices.slice(), wgpu::IndexFormat::Uint32);
        let mut first = 0;
        for (look, ((_, solid), copies)) in Look::ALL.iter().zip(copies).enumerate() {
            let last = first + copies.len() as u32;
            if last > first {
                prepare(pass, look);
                pass.draw_indexed(self.solids[*solid].clone(), 0, first..last);
            }
            first = last;
        }
    }
}
