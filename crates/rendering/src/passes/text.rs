//! Text from an embedded font, laid out by a real layout library, drawn last on the single-sample picture.

use super::Canvas;
use crate::palette::Rgb;
use glyphon::cosmic_text::{FeatureTag, FontFeatures};
use glyphon::{
    Attrs, Buffer, Cache, Color, ColorMode, Family, FontSystem, Metrics, Resolution, Shaping, SwashCache,
    TextArea, TextAtlas, TextBounds, TextRenderer, Viewport, Weight, fontdb,
};
use std::collections::HashMap;
use std::sync::Arc;
use wgpu::{Device, Queue, TextureFormat};

/// Pictures after which a text that is not drawn any more is forgotten.
const KEPT: u64 = 60;

/// A line of text in a picture.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub(crate) text: String,
    /// Left end and middle of the line, pixels.
    pub(crate) at: [f32; 2],
    /// Size of the font, pixels.
    pub(crate) size: f32,
    pub(crate) bold: bool,
    pub(crate) colour: Rgb,
    pub(crate) alpha: f32,
    /// Opacity of the halo, and its colour.
    pub(crate) halo: (f32, Rgb),
}

struct Shaped {
    buffer: Buffer,
    width: f32,
    used: u64,
}

type Key = (String, u32, bool);

/// Fonts, shaped lines, atlas and pipeline.
pub(crate) struct TextPass {
    fonts: FontSystem,
    glyphs: SwashCache,
    shaped: HashMap<Key, Shaped>,
    viewport: Viewport,
    cache: Cache,
    format: TextureFormat,
    atlas: TextAtlas,
    renderer: TextRenderer,
    pictures: u64,
}

impl std::fmt::Debug for TextPass {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TextPass").field("shaped", &self.shaped.len()).finish_non_exhaustive()
    }
}

/// Inter, medium: the face of everything that is written.
pub const FONT: &[u8] = include_bytes!("../../fonts/Inter-Medium.otf");

fn fonts() -> FontSystem {
    let medium: &'static [u8] = FONT;
    let bold: &'static [u8] = include_bytes!("../../fonts/Inter-SemiBold.otf");
    let mut database = fontdb::Database::new();
    // Only what is embedded, so that a picture looks the same on every machine.
    for font in [medium, bold] {
        database.load_font_source(fontdb::Source::Binary(Arc::new(font)));
    }
    FontSystem::new_with_locale_and_db("en-US".to_owned(), database)
}

fn shape(fonts: &mut FontSystem, text: &str, size: f32, bold: bool) -> (Buffer, f32) {
    let mut features = FontFeatures::new();
    // Tabular figures: numbers keep their width while they count.
    features.enable(FeatureTag::new(b"tnum"));
    let weight = if bold { Weight::SEMIBOLD } else { Weight::MEDIUM };
    let attributes = Attrs::new().family(Family::Name("Inter")).weight(weight).font_features(features);
    let mut buffer = Buffer::new(fonts, Metrics::new(size, line_height(size)));
    buffer.set_size(None, None);
    buffer.set_text(text, &attributes, Shaping::Advanced, None);
    buffer.shape_until_scroll(fonts, false);
    let width = buffer.layout_runs().map(|run| run.line_w).fold(0.0, f32::max);
    (buffer, width)
}

/// An atlas without any glyph, and what draws from it.
fn blank(device: &Device, queue: &Queue, cache: &Cache, format: TextureFormat) -> (TextAtlas, TextRenderer) {
    let mut atlas = TextAtlas::with_color_mode(device, queue, cache, format, ColorMode::Web);
    let renderer = TextRenderer::new(&mut atlas, device, wgpu::MultisampleState::default(), None);
    (atlas, renderer)
}

/// Height of a line of text, pixels.
pub(crate) fn line_height(size: f32) -> f32 {
    (size * 1.25).round()
}

impl TextPass {
    pub(crate) fn new(device: &Device, queue: &Queue, canvas: Canvas) -> Self {
        let cache = Cache::new(device);
        let (atlas, renderer) = blank(device, queue, &cache, canvas.format);
        Self {
            fonts: fonts(),
            glyphs: SwashCache::new(),
            shaped: HashMap::new(),
            viewport: Viewport::new(device, &cache),
            cache,
            format: canvas.format,
            atlas,
            renderer,
            pictures: 0,
        }
    }

    /// Width of a text in pixels.
    pub(crate) fn measure(&mut self, text: &str, size: f32, bold: bool) -> f32 {
        let used = self.pictures;
        let fonts = &mut self.fonts;
        let entry = self.shaped.entry((text.to_owned(), size.to_bits(), bold)).or_insert_with(|| {
            let (buffer, width) = shape(fonts, text, size, bold);
            Shaped { buffer, width, used }
        });
        entry.used = used;
        entry.width
    }

    /// Makes `lines` ready to draw on a picture of `size` pixels; halos of all lines lie below all text.
    pub(crate) fn fill(
        &mut self,
        device: &Device,
        queue: &Queue,
        size: [u32; 2],
        lines: &[Line],
    ) -> Result<(), glyphon::PrepareError> {
        for line in lines {
            self.measure(&line.text, line.size, line.bold);
        }
        self.pictures += 1;
        let now = self.pictures;
        self.shaped.retain(|_, shaped| now - shaped.used < KEPT);
        self.viewport.update(queue, Resolution { width: size[0], height: size[1] });
        // What the picture before had may make room.
        self.atlas.trim();
        match self.place(device, queue, lines) {
            // In hours of text of ever other sizes it is cut into pieces too small for anything.
            Err(glyphon::PrepareError::AtlasFull) => {
                (self.atlas, self.renderer) = blank(device, queue, &self.cache, self.format);
                self.place(device, queue, lines)
            }
            placed => placed,
        }
    }

    fn place(&mut self, device: &Device, queue: &Queue, lines: &[Line]) -> Result<(), glyphon::PrepareError> {
        let shaped = &self.shaped;
        let find = |line: &Line| shaped.get(&(line.text.clone(), line.size.to_bits(), line.bold));
        let mut areas = Vec::new();
        for line in lines {
            if let Some(shaped) = find(line) {
                halo(&mut areas, line, &shaped.buffer);
            }
        }
        for line in lines {
            if let Some(shaped) = find(line) {
                areas.push(area(line, &shaped.buffer, [0.0, 0.0], line.colour, line.alpha));
            }
        }
        self.renderer.prepare(
            device,
            queue,
            &mut self.fonts,
            &mut self.atlas,
            &self.viewport,
            areas,
            &mut self.glyphs,
        )
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) -> Result<(), glyphon::RenderError> {
        self.renderer.render(&self.atlas, &self.viewport, pass)
    }
}

/// The digits 0 to 9 side by side, one byte a texel, with width and height: paint for the roofs.
pub(crate) fn digits() -> (Vec<u8>, u32, u32) {
    let (mut fonts, mut glyphs) = (fonts(), SwashCache::new());
    let (cell, height, size) = (40_usize, 64_usize, 78.0_f32);
    let mut texels = vec![0_u8; cell * 10 * height];
    for digit in 0..10 {
        let (mut buffer, width) = shape(&mut fonts, &digit.to_string(), size, true);
        let shift = (0.5 * (cell as f32 - width)).round() as i32;
        // The line is taller than the figures: its upper part is space for accents.
        let rise = -(0.5 * (line_height(size) - height as f32)).round() as i32;
        buffer.draw(&mut fonts, &mut glyphs, Color::rgb(255, 255, 255), |x, y, w, h, colour| {
            let inside = |v: i32, most: usize| usize::try_from(v).ok().filter(|v| *v < most);
            if let (1, 1, Some(x), Some(y)) = (w, h, inside(x + shift, cell), inside(y + rise, height)) {
                texels[y * cell * 10 + digit * cell + x] = colour.a();
            }
        });
    }
    (texels, (cell * 10) as u32, height as u32)
}

fn area<'a>(line: &Line, buffer: &'a Buffer, shift: [f32; 2], colour: Rgb, alpha: f32) -> TextArea<'a> {
    let byte = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
    TextArea {
        buffer,
        // Whole pixels keep stems sharp and keep a still picture still.
        left: line.at[0].round() + shift[0],
        top: (line.at[1] - 0.5 * line_height(line.size)).round() + shift[1],
        scale: 1.0,
        bounds: TextBounds::default(),
        default_color: Color::rgba(byte(colour[0]), byte(colour[1]), byte(colour[2]), byte(alpha)),
        custom_glyphs: &[],
    }
}

fn halo<'a>(areas: &mut Vec<TextArea<'a>>, line: &Line, buffer: &'a Buffer) {
    let (strength, colour) = line.halo;
    if strength <= 0.0 {
        return;
    }
    let reach = (line.size / 13.0 * 1.4).max(1.0);
    for k in 0..4 {
        let (sin, cos) = (std::f32::consts::FRAC_PI_4 * (2 * k + 1) as f32).sin_cos();
        areas.push(area(line, buffer, [reach * cos, reach * sin], colour, strength * line.alpha));
    }
}
