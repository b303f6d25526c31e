//! Props: four solids, drawn as often as there are copies.

use super::asphalt::Asphalt;
use super::frame::FrameGroups;
use super::instanced::{Instance, InstancedMeshes, LAYOUTS};
use super::{Canvas, Recipe, developed, shader};
use crate::Gpu;
use crate::camera::Camera;
use crate::gpu::model::solids;
use glam::DVec3;
use std::ops::Range;
use vocabulary::math;
use wgpu::{BindGroup, RenderPass};

pub(crate) const SHADERS: [&str; 2] = developed!("common/light", "common/robot", "common/asphalt", "prop");

/// How a prop is painted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PropAppearance {
    Concrete,
    Timber,
    Machine,
    Pillar,
    Cone,
    Ramp,
}

impl PropAppearance {
    /// The shader's entry point of each look and the index of its solid, in the order of the copies.
    const ALL: [(&str, usize); 6] =
        [("concrete", 0), ("timber", 0), ("machine", 0), ("pillar", 1), ("cone", 2), ("ramp", 3)];
}

/// Copies that are drawn together.
#[derive(Debug, Default)]
pub(crate) struct PropInstances {
    /// Where they begin among all that are on the device.
    pub(crate) first: u32,
    /// By look.
    pub(crate) others: [Vec<Instance>; PropAppearance::ALL.len()],
    /// What robots drive on, in the order of the floor's decks.
    pub(crate) drivables: Vec<(PropAppearance, Instance)>,
}

impl PropInstances {
    /// In the order in which they lie on the device.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Instance> {
        self.others.iter().flatten().chain(self.drivables.iter().map(|(_, copy)| copy))
    }

    /// Those that a camera may see.
    pub(crate) fn part(&self, camera: &Camera, origin: DVec3) -> Self {
        let seen = |copy: &Instance| {
            let rows = copy.rows.map(|row| row.map(f64::from));
            let place = DVec3::from_array(rows.map(|row| row[3])) + origin;
            // A column is a side, or twice a radius.
            let side = |k: usize| rows.iter().map(|row| row[k] * row[k]).sum::<f64>().sqrt();
            camera.may_see(place, math::hypot(math::hypot(side(0), side(1)), side(2)))
        };
        let others = std::array::from_fn(|k| self.others[k].iter().filter(|c| seen(c)).copied().collect());
        let drivables = self.drivables.iter().filter(|(_, copy)| seen(copy)).copied().collect();
        Self { first: 0, others, drivables }
    }
}

/// What is seen through where it stands before the robots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Veil {
    /// All props.
    All,
    /// All but decks that hide no robot.
    ButDecks,
    /// Nothing: cameras on robots see what stands before them.
    None,
}

/// Solids on the device, their pipeline and the copies of this picture.
#[derive(Debug)]
pub(crate) struct PropPass {
    /// By look: what is seen through where it stands before the robots.
    pipelines: Vec<wgpu::RenderPipeline>,
    /// By look: what never is. Empty without decks.
    firm: Vec<wgpu::RenderPipeline>,
    /// Whether what is seen through leaves samples to what comes later.
    coverage: bool,
    asphalt: BindGroup,
    meshes: InstancedMeshes,
    solids: [Range<u32>; 4],
}

impl PropPass {
    pub(crate) fn new(
        gpu: &Gpu,
        canvas: Canvas,
        groups: &FrameGroups,
        asphalt: &Asphalt,
        veil: Veil,
    ) -> Self {
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        let solids = solids().map(|mesh| mesh.weld(&mut vertices, &mut indices));
        // Seen through where a prop stands before the robots; with one sample a pixel, whatever is farther and comes
        // later is lost behind it.
        let coverage = canvas.samples > 1 && veil != Veil::None;
        let blend = (!coverage && veil != Veil::None).then_some(wgpu::BlendState::ALPHA_BLENDING);
        let recipe = Recipe {
            label: "prop",
            source: canvas.of(SHADERS),
            groups: &[&groups.view_layout, &groups.light_layout, &asphalt.layout],
            buffers: &LAYOUTS,
            cull: true,
            colour: Some((canvas, blend)),
            coverage,
            write: wgpu::ColorWrites::COLOR,
            depth: Some((wgpu::CompareFunction::Less, true)),
            ..Default::default()
        };
        let firm = Recipe { label: "deck", colour: Some((canvas, None)), coverage: false, ..recipe };
        let build = |recipe: Recipe<'_>| {
            PropAppearance::ALL.map(|(entry, _)| Recipe { entry, ..recipe }.build(gpu)).to_vec()
        };
        Self {
            pipelines: build(recipe),
            firm: if veil == Veil::ButDecks { build(firm) } else { Vec::new() },
            coverage,
            asphalt: asphalt.group.clone(),
            meshes: InstancedMeshes::new(gpu, &vertices, &indices),
            solids,
        }
    }

    /// Brings the copies of all pictures to the device and notes where those of each begin.
    pub(crate) fn fill<'a>(&mut self, gpu: &Gpu, pictures: impl Iterator<Item = &'a mut PropInstances>) {
        let mut all: Vec<Instance> = Vec::new();
        for copies in pictures {
            copies.first = all.len() as u32;
            all.extend(copies.all());
        }
        self.meshes.fill(gpu, &all);
    }

    /// What robots drive on, before the paint on it; `veiled` tells which of it hides a robot from the eye.
    pub(crate) fn draw_decks(&self, pass: &mut RenderPass<'_>, copies: &PropInstances, veiled: &[bool]) {
        if copies.drivables.is_empty() {
            return;
        }
        pass.set_bind_group(2, &self.asphalt, &[]);
        self.meshes.bind(pass);
        let seen_through = |k: usize| veiled.get(k).copied().unwrap_or_default();
        self.each_deck(pass, copies, |pass, k| {
            let look = copies.drivables[k].0 as usize;
            let later = seen_through(k) && !self.coverage;
            if !later {
                let seen_through = seen_through(k) || self.firm.is_empty();
                pass.set_pipeline(if seen_through { &self.pipelines[look] } else { &self.firm[look] });
            }
            !later
        });
    }

    /// All others, after the robots.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, copies: &PropInstances, veiled: &[bool]) {
        pass.set_bind_group(2, &self.asphalt, &[]);
        self.meshes.bind(pass);
        self.each_other(pass, copies, |pass, look| pass.set_pipeline(&self.pipelines[look]));
        self.each_deck(pass, copies, |pass, k| {
            let later = !self.coverage && veiled.get(k).copied().unwrap_or_default();
            if later {
                pass.set_pipeline(&self.pipelines[copies.drivables[k].0 as usize]);
            }
            later
        });
    }

    /// All copies with whatever pipeline is set.
    pub(crate) fn draw_solid(&self, pass: &mut RenderPass<'_>, copies: &PropInstances) {
        self.meshes.bind(pass);
        self.each_other(pass, copies, |_, _| ());
        self.each_deck(pass, copies, |_, _| true);
    }

    fn each_other(
        &self,
        pass: &mut RenderPass<'_>,
        copies: &PropInstances,
        prepare: impl Fn(&mut RenderPass<'_>, usize),
    ) {
        let mut first = copies.first;
        for (look, ((_, solid), copies)) in PropAppearance::ALL.iter().zip(&copies.others).enumerate() {
            let last = first + copies.len() as u32;
            if last > first {
                prepare(pass, look);
                pass.draw_indexed(self.solids[*solid].clone(), 0, first..last);
            }
            first = last;
        }
    }

    /// Draws the decks for which `prepare` says so.
    fn each_deck(
        &self,
        pass: &mut RenderPass<'_>,
        copies: &PropInstances,
        prepare: impl Fn(&mut RenderPass<'_>, usize) -> bool,
    ) {
        let first = copies.first as usize + copies.others.iter().map(Vec::len).sum::<usize>();
        for (k, (look, _)) in copies.drivables.iter().enumerate() {
            if prepare(pass, k) {
                let at = (first + k) as u32;
                pass.draw_indexed(self.solids[PropAppearance::ALL[*look as usize].1].clone(), 0, at..at + 1);
            }
        }
    }
}
