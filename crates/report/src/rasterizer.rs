//! SVG to PNG and PDF, with the fonts that are handed in and no others: the same bytes on every machine.

use resvg::{tiny_skia, usvg};
use std::sync::Arc;
use thiserror::Error;

/// A sheet that could not be printed.
#[derive(Debug, Error)]
pub enum PressError {
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

/// Prints sheets.
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

    fn read(&self, svg: &str) -> Result<usvg::Tree, PressError> {
        let options =
            usvg::Options { font_family: "Inter".to_owned(), fontdb: self.0.clone(), ..Default::default() };
        usvg::Tree::from_str(svg, &options).map_err(|e| PressError::Svg(e.to_string()))
    }

    /// A sheet as the bytes of a PNG file of `dpi` pixels an inch.
    ///
    /// # Errors
    /// [`PressError`] for what is no SVG, or too large.
    pub fn png(&self, svg: &str, dpi: f32) -> Result<Vec<u8>, PressError> {
        let tree = self.read(svg)?;
        let scale = dpi / PIXELS;
        let [width, height] =
            [tree.size().width(), tree.size().height()].map(|side| (side * scale).round() as u32);
        let none = || PressError::Size { width, height };
        let mut sheet = tiny_skia::Pixmap::new(width, height).ok_or_else(none)?;
        resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut sheet.as_mut());
        let bytes = sheet.encode_png().map_err(|e| PressError::Png(e.to_string()))?;
        Ok(with_density(bytes, dpi))
    }

    /// A sheet as the bytes of a PDF file of its size, fonts embedded.
    ///
    /// # Errors
    /// [`PressError`] for what is no SVG.
    pub fn pdf(&self, svg: &str) -> Result<Vec<u8>, PressError> {
        let tree = self.read(svg)?;
        // Lengths have become pixels of SVG; a page is measured in points.
        let page = svg2pdf::PageOptions { dpi: PIXELS };
        svg2pdf::to_pdf(&tree, svg2pdf::ConversionOptions::default(), page)
            .map_err(|e| PressError::Pdf(e.to_string()))
    }
}

/// The PNG with a chunk that says its pixels an inch, so that it is as large on paper as the SVG.
fn with_density(mut png: Vec<u8>, dpi: f32) -> Vec<u8> {
    /// Signature and header.
    const HEAD: usize = 8 + 25;
    let metre = ((dpi / 0.0254).round() as u32).to_be_bytes();
    let body: Vec<u8> = b"pHYs".iter().chain(&metre).chain(&metre).chain(&[1]).copied().collect();
    let length = (body.len() as u32 - 4).to_be_bytes();
    let chunk: Vec<u8> =
        length.into_iter().chain(body.iter().copied()).chain(crc(&body).to_be_bytes()).collect();
    if png.len() > HEAD {
        png.splice(HEAD..HEAD, chunk);
    }
    png
}

/// The checksum of PNG chunks (CRC-32, ISO 3309).
fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    };
    !bytes.iter().fold(!0, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_png() {
        assert_eq!(crc(b"IEND"), 0xae42_6082);
        assert_eq!(crc(b"123456789"), 0xcbf4_3926);
    }

    #[test]
    fn a_sheet_has_its_size_in_both() {
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"85mm\" height=\"42.5mm\" viewBox=\"0 0 2 1\">\
                   <rect width=\"2\" height=\"1\"/></svg>";
        let press = Rasterizer::new(&[]);
        let png = press.png(svg, 300.0).expect("a picture");
        let side = |at: usize| u32::from_be_bytes([png[at], png[at + 1], png[at + 2], png[at + 3]]);
        assert_eq!([side(16), side(20)], [1004, 502]);
        assert_eq!(&png[37..41], b"pHYs");
        assert_eq!(side(41), 11811);
        let pdf = press.pdf(svg).expect("a page");
        assert!(pdf.starts_with(b"%PDF"));
        assert!(String::from_utf8_lossy(&pdf).contains("240.9"), "85 mm are 240.94 points");
        assert!(matches!(press.png("<svg", 300.0), Err(PressError::Svg(_))));
        assert!(matches!(press.png(svg, 0.0), Err(PressError::Size { .. })));
    }
}
