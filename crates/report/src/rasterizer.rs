//! SVG to PNG and PDF, with the fonts that are handed in and no others: the same bytes on every machine.

use resvg::{tiny_skia, usvg};
use std::sync::Arc;
use thiserror::Error;

/// A figure that could not be made into a file.
#[derive(Debug, Error)]
pub enum RasterizerError {
    /// The SVG is not well-formed.
    #[error("a figure cannot be read: {0}")]
    Svg(String),
    /// The picture would have no pixels, or too many.
    #[error("a figure of {width}×{height} pixels cannot be drawn")]
    Size {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The PNG could not be encoded.
    #[error("a figure cannot be written as PNG: {0}")]
    Png(String),
    /// The PDF could not be made.
    #[error("a figure cannot be written as PDF: {0}")]
    Pdf(String),
}

/// Turns figures (SVG) into PNG and PDF.
#[derive(Debug, Clone)]
pub struct Rasterizer(Arc<usvg::fontdb::Database>);

/// Pixels of SVG in an inch.
const PIXELS: f32 = 96.0;

impl Rasterizer {
    /// With these fonts (OpenType) and no others.
    pub fn new(fonts: &[&'static [u8]]) -> Self {
        let mut all = usvg::fontdb::Database::new();
        for font in fonts {
            all.load_font_data(font.to_vec());
        }
        Self(Arc::new(all))
    }

    fn read(&self, svg: &str) -> Result<usvg::Tree, RasterizerError> {
        let options =
            usvg::Options { font_family: "Inter".to_owned(), fontdb: self.0.clone(), ..Default::default() };
        usvg::Tree::from_str(svg, &options).map_err(|e| RasterizerError::Svg(e.to_string()))
    }

    /// A figure as the bytes of a PNG file of `dpi` pixels an inch.
    ///
    /// # Errors
    /// [`RasterizerError`] for what is no SVG, or too large.
    pub fn png(&self, svg: &str, dpi: f32) -> Result<Vec<u8>, RasterizerError> {
        let tree = self.read(svg)?;
        let scale = dpi / PIXELS;
        let [width, height] =
            [tree.size().width(), tree.size().height()].map(|side| (side * scale).round() as u32);
        let none = || RasterizerError::Size { width, height };
        let mut pixmap = tiny_skia::Pixmap::new(width, height).ok_or_else(none)?;
        resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
        let rgba: Vec<u8> = pixmap
            .pixels()
            .iter()
            .map(tiny_skia::PremultipliedColorU8::demultiply)
            .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()])
            .collect();
        encoded(&rgba, width, height, dpi).map_err(|e| RasterizerError::Png(e.to_string()))
    }

    /// A figure as the bytes of a PDF file of its size, fonts embedded.
    ///
    /// # Errors
    /// [`RasterizerError`] for what is no SVG.
    pub fn pdf(&self, svg: &str) -> Result<Vec<u8>, RasterizerError> {
        let tree = self.read(svg)?;
        // Lengths have become pixels of SVG; a page is measured in points.
        let page = svg2pdf::PageOptions { dpi: PIXELS };
        svg2pdf::to_pdf(&tree, svg2pdf::ConversionOptions::default(), page)
            .map_err(|e| RasterizerError::Pdf(e.to_string()))
    }
}

/// A PNG file of straight RGBA that says its pixels an inch, so that it is as large on paper as the SVG.
fn encoded(rgba: &[u8], width: u32, height: u32, dpi: f32) -> Result<Vec<u8>, png::EncodingError> {
    let per_metre = (dpi / 0.0254).round() as u32;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rgba)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_has_its_size_in_both() {
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"85mm\" height=\"42.5mm\" viewBox=\"0 0 2 1\">\
                   <rect width=\"2\" height=\"1\"/></svg>";
        let rasterizer = Rasterizer::new(&[]);
        let png = rasterizer.png(svg, 300.0).expect("a picture");
        let side = |at: usize| u32::from_be_bytes([png[at], png[at + 1], png[at + 2], png[at + 3]]);
        assert_eq!([side(16), side(20)], [1004, 502]);
        assert_eq!(&png[37..41], b"pHYs");
        assert_eq!(side(41), 11811);
        let pdf = rasterizer.pdf(svg).expect("a page");
        assert!(pdf.starts_with(b"%PDF"));
        assert!(String::from_utf8_lossy(&pdf).contains("240.9"), "85 mm are 240.94 points");
        assert!(matches!(rasterizer.png("<svg", 300.0), Err(RasterizerError::Svg(_))));
        assert!(matches!(rasterizer.png(svg, 0.0), Err(RasterizerError::Size { .. })));
    }
}
