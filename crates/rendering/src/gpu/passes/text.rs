//! Text drawn last on the single-sample picture, from glyphs that [`TextShaper`] has shaped.

use super::Canvas;
use super::halo::Halos;
use crate::Gpu;
use crate::annotation::text_shaper::{Block, TextShaper, line_height};
use crate::palette::Rgb;
use glyphon::{
    Buffer, Cache, Color, ColorMode, Metrics, Resolution, SwashCache, TextArea, TextAtlas, TextBounds,
    TextRenderer, Viewport,
};
use wgpu::TextureFormat;

/// A text in a picture.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextLine {
    pub(crate) text: String,
    /// Left end of the text and middle of its first line, pixels.
    pub(crate) at: [f32; 2],
    /// Size of the font, pixels.
    pub(crate) size: f32,
    pub(crate) bold: bool,
    /// Where it may have several lines.
    pub(crate) block: Option<Block>,
    pub(crate) colour: Rgb,
    pub(crate) alpha: f32,
    /// Opacity of the halo, and its colour.
    pub(crate) halo: (f32, Rgb),
}

/// Atlas and pipeline.
pub(crate) struct TextPass {
    glyphs: SwashCache,
    halos: Halos,
    viewport: Viewport,
    cache: Cache,
    format: TextureFormat,
    atlas: TextAtlas,
    renderer: TextRenderer,
}

impl std::fmt::Debug for TextPass {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TextPass").finish_non_exhaustive()
    }
}

/// An atlas without any glyph, and what draws from it.
fn blank(gpu: &Gpu, cache: &Cache, format: TextureFormat) -> (TextAtlas, TextRenderer) {
    let mut atlas = TextAtlas::with_color_mode(&gpu.device, &gpu.queue, cache, format, ColorMode::Web);
    let renderer = TextRenderer::new(&mut atlas, &gpu.device, wgpu::MultisampleState::default(), None);
    (atlas, renderer)
}

impl TextPass {
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas) -> Self {
        let cache = Cache::new(&gpu.device);
        let (atlas, renderer) = blank(gpu, &cache, canvas.format);
        Self {
            glyphs: SwashCache::new(),
            halos: Halos::default(),
            viewport: Viewport::new(&gpu.device, &cache),
            cache,
            format: canvas.format,
            atlas,
            renderer,
        }
    }

    /// Makes `lines` ready to draw on a picture of `size` pixels; halos of all lines lie below all text.
    pub(crate) fn fill(
        &mut self,
        gpu: &Gpu,
        size: [u32; 2],
        lines: &[TextLine],
        letters: &mut TextShaper,
    ) -> Result<(), glyphon::PrepareError> {
        for line in lines {
            letters.measure(&line.text, line.size, line.bold, line.block);
        }
        letters.forget();
        self.viewport.update(&gpu.queue, Resolution { width: size[0], height: size[1] });
        // What the picture before had may make room.
        self.atlas.trim();
        if self.halos.full() {
            self.clear(gpu);
        }
        match self.place(gpu, lines, letters) {
            // In hours of text of ever other sizes it is cut into pieces too small for anything.
            Err(glyphon::PrepareError::AtlasFull) => {
                self.clear(gpu);
                self.place(gpu, lines, letters)
            }
            placed => placed,
        }
    }

    /// Forgets all glyphs.
    fn clear(&mut self, gpu: &Gpu) {
        (self.atlas, self.renderer) = blank(gpu, &self.cache, self.format);
        self.halos = Halos::default();
    }

    fn place(
        &mut self,
        gpu: &Gpu,
        lines: &[TextLine],
        letters: &mut TextShaper,
    ) -> Result<(), glyphon::PrepareError> {
        let (fonts, shaped) = letters.parts();
        let find = |line: &TextLine| shaped.find(&line.text, line.size, line.bold, line.block);
        let found: Vec<_> = lines.iter().filter_map(|line| Some((line, find(line)?))).collect();
        let mut halos = Vec::new();
        for (line, buffer) in &found {
            self.halos.add(fonts, &mut self.glyphs, line, buffer, corner(line), &mut halos);
        }
        let nothing = Buffer::new_empty(Metrics::new(1.0, 1.0));
        let below = TextArea { custom_glyphs: &halos, ..area(&nothing, [0.0; 2], Color::rgb(0, 0, 0)) };
        let above =
            found.iter().map(|(line, buffer)| area(buffer, corner(line), colour(line.colour, line.alpha)));
        self.renderer.prepare_with_custom(
            &gpu.device,
            &gpu.queue,
            fonts,
            &mut self.atlas,
            &self.viewport,
            std::iter::once(below).chain(above),
            &mut self.glyphs,
            |request| self.halos.rasterize(request),
        )
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) -> Result<(), glyphon::RenderError> {
        self.renderer.render(&self.atlas, &self.viewport, pass)
    }
}

/// The upper left corner of a line, in whole pixels: they keep stems sharp and keep a still picture still.
fn corner(line: &TextLine) -> [f32; 2] {
    [line.at[0].round(), (line.at[1] - 0.5 * line_height(line.size)).round()]
}

pub(super) fn colour(colour: Rgb, alpha: f32) -> Color {
    let byte = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
    Color::rgba(byte(colour[0]), byte(colour[1]), byte(colour[2]), byte(alpha))
}

fn area(buffer: &Buffer, [left, top]: [f32; 2], default_color: Color) -> TextArea<'_> {
    TextArea {
        buffer,
        left,
        top,
        scale: 1.0,
        bounds: TextBounds::default(),
        default_color,
        custom_glyphs: &[],
    }
}
