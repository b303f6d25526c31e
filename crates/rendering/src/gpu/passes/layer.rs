//! Robots in a layer of their own: several samples a pixel where they are, and one where there is only ground and sky.

use super::Canvas;
use super::texture::{TextureBinding, TexturePass};
use crate::Gpu;
use crate::camera::viewpoint::Tile;
use crate::gpu::passes::robot::RobotInstances;
use crate::gpu::resources::flat_texture;
use crate::gpu::robot_groups::Groups;
use crate::gpu::target::Attachments;
use wgpu::{Color, CommandEncoder, LoadOp, RenderPass, TextureUsages, TextureView, TextureViewDescriptor};

/// Where the robots of one view at a time are drawn, and the pipeline that lays them over the ground.
#[derive(Debug)]
pub(crate) struct LayerPass {
    canvas: Canvas,
    over: TexturePass,
    sheet: Option<Sheet>,
}

/// What is drawn into: transparent where no robot is, so that what covers a share of a pixel has that opacity.
#[derive(Debug)]
struct Sheet {
    attachments: Attachments,
    view: TextureView,
    binding: TextureBinding,
}

impl Sheet {
    fn new(gpu: &Gpu, size: [u32; 2], canvas: Canvas, over: &TexturePass) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let texture = gpu.device.create_texture(&flat_texture("layer", size, canvas.format, usage));
        let view = texture.create_view(&TextureViewDescriptor::default());
        let binding = over.bind(gpu, &view);
        Self { attachments: Attachments::new(gpu, size, canvas), view, binding }
    }

    /// Whether it holds a size without wasting much of its own.
    fn suits(&self, [width, height]: [u32; 2]) -> bool {
        let [w, h] = self.attachments.size;
        w >= width
            && h >= height
            && 2 * u64::from(w) * u64::from(h) <= 3 * u64::from(width) * u64::from(height)
    }
}

impl LayerPass {
    /// Of what is drawn on `canvas`, to be laid over a target of one sample.
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas) -> Self {
        Self { canvas, over: TexturePass::layer(gpu, canvas.flat()), sheet: None }
    }

    /// Makes room for the robots of every view, of which one at a time is drawn.
    pub(crate) fn fit(&mut self, gpu: &Gpu, sizes: impl Iterator<Item = [u32; 2]>) {
        let size = sizes.fold([0, 0], |[w, h], [width, height]| [w.max(width), h.max(height)]);
        if size != [0, 0] && !self.sheet.as_ref().is_some_and(|sheet| sheet.suits(size)) {
            self.sheet = Some(Sheet::new(gpu, size, self.canvas, &self.over));
        }
    }

    /// Draws the groups of a view that fills `tile`.
    pub(crate) fn draw(
        &self,
        encoder: &mut CommandEncoder,
        tile: &Tile,
        groups: &Groups,
        mut draw: impl FnMut(&mut RenderPass<'_>, &RobotInstances),
    ) {
        let Some(sheet) = self.sheet.as_ref().filter(|_| !groups.all.is_empty()) else { return };
        let [x, y, width, height] = tile.area();
        let clear = LoadOp::Clear(Color::TRANSPARENT);
        sheet.attachments.draw(encoder, &sheet.view, clear, |pass| {
            for group in &groups.all {
                let [left, top] = group.shift();
                pass.set_viewport(x - left, y - top, width, height, 0.0, 1.0);
                let Tile { x, y, width, height } = group.slot;
                pass.set_scissor_rect(x, y, width, height);
                draw(pass, &group.crowd);
            }
        });
    }

    /// Lays the groups that were drawn last over a pass, and leaves the pass confined to one of them.
    pub(crate) fn lay(&self, pass: &mut RenderPass<'_>, groups: &Groups) {
        let Some(sheet) = self.sheet.as_ref().filter(|_| !groups.all.is_empty()) else { return };
        let [width, height] = sheet.attachments.size.map(|side| side as f32);
        for group in &groups.all {
            let [left, top] = group.shift();
            pass.set_viewport(left, top, width, height, 0.0, 1.0);
            let Tile { x, y, width, height } = group.crop;
            pass.set_scissor_rect(x, y, width, height);
            self.over.draw(pass, &sheet.binding);
        }
    }
}
