//! Texts as glyphs, by a real layout library: how wide they are, where they wrap, and what the fonts lack.

use glyphon::cosmic_text::{Align, Ellipsize, EllipsizeHeightLimit, FeatureTag, FontFeatures};
use glyphon::{
    Attrs, Buffer, Color, Family, FontSystem, LayoutRun, Metrics, Shaping, SwashCache, Weight, Wrap, fontdb,
};
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// Inter, medium: the face of everything that is written.
pub const FONT: &[u8] = include_bytes!("../../fonts/Inter-Medium.otf");
const BOLD: &[u8] = include_bytes!("../../fonts/Inter-SemiBold.otf");

/// Pictures after which a text that is not drawn any more is forgotten.
const KEPT: u64 = 60;

/// Room for a text of several lines: what does not fit ends in "…".
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Block {
    /// Pixels across.
    pub(crate) width: f32,
    /// Most lines.
    pub(crate) rows: usize,
    /// Whether lines stand in the middle of the width, not at its left.
    pub(crate) centred: bool,
}

/// How much room a text takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measure {
    /// Of its longest line, pixels.
    pub(crate) width: f32,
    /// Its lines.
    pub(crate) rows: usize,
}

type Key = (String, u32, bool, Option<(u32, usize, bool)>);

#[derive(Debug)]
struct ShapedText {
    buffer: Buffer,
    measure: Measure,
    used: u64,
}

/// Texts that are shaped.
#[derive(Debug, Default)]
pub(crate) struct Shaped {
    texts: HashMap<Key, ShapedText>,
}

impl Shaped {
    pub(crate) fn find(&self, text: &str, size: f32, bold: bool, block: Option<Block>) -> Option<&Buffer> {
        self.texts.get(&key(text, size, bold, block)).map(|shape| &shape.buffer)
    }
}

/// Fonts, and what was shaped with them.
#[derive(Debug)]
pub(crate) struct TextShaper {
    /// Only what is embedded, so that a picture looks the same on every machine.
    own: FontSystem,
    /// The same and those of the machine, once a text needs a letter that the embedded fonts lack. Its embedded fonts have the
    /// same numbers, so that text shaped with either can be drawn with it.
    all: Option<FontSystem>,
    shaped: Shaped,
    pictures: u64,
}

impl TextShaper {
    pub(crate) fn new() -> Self {
        Self { own: fonts(false), all: None, shaped: Shaped::default(), pictures: 0 }
    }

    /// Width and lines of a text; without a block it has one line.
    pub(crate) fn measure(&mut self, text: &str, size: f32, bold: bool, block: Option<Block>) -> Measure {
        let (own, all, used) = (&mut self.own, &mut self.all, self.pictures);
        let entry = self.shaped.texts.entry(key(text, size, bold, block)).or_insert_with(|| {
            let mut buffer = shape(own, text, Font { size, bold }, block, &BTreeSet::new());
            // An ellipsis may have left the missing characters out.
            let lacks: BTreeSet<char> = lacking(&buffer).collect();
            if !lacks.is_empty() {
                buffer =
                    shape(all.get_or_insert_with(|| fonts(true)), text, Font { size, bold }, block, &lacks);
            }
            let width = buffer.layout_runs().map(|run| run.line_w).fold(0.0, f32::max);
            let measure = Measure { width, rows: buffer.layout_runs().count().max(1) };
            ShapedText { buffer, measure, used }
        });
        entry.used = used;
        entry.measure
    }

    /// What of some texts no font has.
    pub(crate) fn lacks<'a>(&mut self, texts: impl Iterator<Item = &'a str>) -> BTreeSet<char> {
        let mut lacks = BTreeSet::new();
        for text in texts {
            self.measure(text, 13.0, false, None);
            if let Some(buffer) = self.shaped.find(text, 13.0, false, None) {
                lacks.extend(lacking(buffer));
            }
        }
        lacks
    }

    /// Begins another picture: what was not drawn for long is forgotten.
    pub(crate) fn forget(&mut self) {
        self.pictures += 1;
        let now = self.pictures;
        self.shaped.texts.retain(|_, shape| now - shape.used < KEPT);
    }

    /// Fonts to draw with, and what to draw.
    pub(crate) fn parts(&mut self) -> (&mut FontSystem, &Shaped) {
        (self.all.as_mut().unwrap_or(&mut self.own), &self.shaped)
    }
}

fn key(text: &str, size: f32, bold: bool, block: Option<Block>) -> Key {
    (text.to_owned(), size.to_bits(), bold, block.map(|b| (b.width.to_bits(), b.rows, b.centred)))
}

/// The embedded fonts, and those of the machine after them.
fn fonts(all: bool) -> FontSystem {
    let mut database = fontdb::Database::new();
    for font in [FONT, BOLD] {
        database.load_font_source(fontdb::Source::Binary(Arc::new(font)));
    }
    if all {
        database.load_system_fonts();
    }
    FontSystem::new_with_locale_and_db("en-US".to_owned(), database)
}

/// Height in pixels and weight of a text.
#[derive(Debug, Clone, Copy)]
struct Font {
    size: f32,
    bold: bool,
}

/// Glyphs of a text; words with characters that `lacks` are written in other fonts.
fn shape(
    fonts: &mut FontSystem,
    text: &str,
    font: Font,
    block: Option<Block>,
    lacks: &BTreeSet<char>,
) -> Buffer {
    let Some(Block { width, rows, centred }) = block else {
        let line = text.split(['\n', '\r']).collect::<Vec<_>>().join(" ");
        return laid(fonts, &line, font, lacks, None, None);
    };
    let width = Some(width.max(1.0));
    let wrapped = laid(fonts, text, font, lacks, width, None);
    // Each line by itself, since a line that is wrapped keeps the space before it, and the last with all that is left.
    let ends = |run: &LayoutRun<'_>| {
        let from = run.glyphs.iter().map(|glyph| glyph.start).min().unwrap_or(0);
        let to = run.glyphs.iter().map(|glyph| glyph.end).max().unwrap_or(0);
        run.text.get(from..to).unwrap_or_default().trim().to_owned()
    };
    let mut lines: Vec<_> =
        wrapped.layout_runs().map(|run| ends(&run)).filter(|line| !line.is_empty()).collect();
    let rest = lines.split_off(lines.len().min(rows.saturating_sub(1)));
    lines.extend((!rest.is_empty()).then(|| rest.join(" ")));
    let align = if centred { Align::Center } else { Align::Left };
    laid(fonts, &lines.join("\n"), font, lacks, width, Some(align))
}

/// A text laid out in lines of some width; lines that are aligned end in "…" where they are too long.
fn laid(
    fonts: &mut FontSystem,
    text: &str,
    Font { size, bold }: Font,
    lacks: &BTreeSet<char>,
    width: Option<f32>,
    align: Option<Align>,
) -> Buffer {
    let mut features = FontFeatures::new();
    // Tabular figures: numbers keep their width while they count.
    features.enable(FeatureTag::new(b"tnum"));
    let weight = if bold { Weight::SEMIBOLD } else { Weight::MEDIUM };
    let attributes = Attrs::new().family(Family::Name("Inter")).weight(weight).font_features(features);
    let mut buffer = Buffer::new(fonts, Metrics::new(size, line_height(size)));
    buffer.set_size(width, None);
    buffer.set_wrap(Wrap::WordOrGlyph);
    if align.is_some() {
        buffer.set_ellipsize(Ellipsize::End(EllipsizeHeightLimit::Lines(1)));
    }
    // Few families have weights between the usual two, and whole words keep letters joined that are written so.
    let usual = if bold { Weight::BOLD } else { Weight::NORMAL };
    let other = Attrs::new().family(Family::SansSerif).weight(usual);
    let word = |word| {
        let foreign = str::chars(word).any(|c| lacks.contains(&c));
        (word, if foreign { other.clone() } else { attributes.clone() })
    };
    let words = text.split_inclusive(char::is_whitespace).map(word);
    buffer.set_rich_text(words, &attributes, Shaping::Advanced, align);
    buffer.shape_until_scroll(fonts, false);
    buffer
}

/// Characters for which a font was looked for in vain.
fn lacking(buffer: &Buffer) -> impl Iterator<Item = char> {
    buffer.layout_runs().flat_map(|run| {
        let missing = run.glyphs.iter().filter(|glyph| glyph.glyph_id == 0);
        let texts = missing.filter_map(|glyph| run.text.get(glyph.start..glyph.end));
        // Spaces and marks of direction may have no glyph, and need none.
        texts.flat_map(str::chars).filter(|c| !c.is_whitespace() && !c.is_control())
    })
}

/// Height of a line of text, pixels.
pub(crate) fn line_height(size: f32) -> f32 {
    (size * 1.25).round()
}

/// The digits 0 to 9 side by side, one byte a texel, with width and height: paint for the roofs.
pub(crate) fn digits() -> (Vec<u8>, u32, u32) {
    let (mut fonts, mut glyphs) = (fonts(false), SwashCache::new());
    let (cell, height, size) = (40_usize, 64_usize, 78.0_f32);
    let mut texels = vec![0_u8; cell * 10 * height];
    for digit in 0..10 {
        let mut buffer =
            shape(&mut fonts, &digit.to_string(), Font { size, bold: true }, None, &BTreeSet::new());
        let width = buffer.layout_runs().map(|run| run.line_w).fold(0.0, f32::max);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn block(width: f32, rows: usize) -> Block {
        Block { width, rows, centred: false }
    }

    #[test]
    fn long_texts_wrap_and_end_in_an_ellipsis() {
        let mut letters = TextShaper::new();
        let text = "Seven robots in a V that drive along a figure eight for a minute and a half";
        let whole = letters.measure(text, 20.0, true, None);
        assert_eq!(whole.rows, 1);
        let two = letters.measure(text, 20.0, true, Some(block(0.6 * whole.width, 2)));
        assert!(two.rows == 2 && two.width <= 0.6 * whole.width, "{two:?}");
        let cut = letters.measure(text, 20.0, true, Some(block(0.2 * whole.width, 2)));
        assert!(cut.rows == 2 && cut.width <= 0.2 * whole.width, "{cut:?}");
        // Without spaces, too.
        let letters_only = "X".repeat(200);
        let cut = letters.measure(&letters_only, 20.0, true, Some(block(300.0, 2)));
        assert!(cut.rows == 2 && cut.width <= 300.0, "{cut:?}");
    }

    #[test]
    fn lines_of_a_text_stay_lines() {
        let mut letters = TextShaper::new();
        assert_eq!(letters.measure("One\nTwo", 20.0, true, Some(block(900.0, 2))).rows, 2);
        assert_eq!(letters.measure("One\nTwo\nThree\n\n", 20.0, true, Some(block(900.0, 2))).rows, 2);
        // Where there is one line only, they share it.
        assert_eq!(letters.measure("One\nTwo", 20.0, true, None).rows, 1);
        // A line begins with a word, not with the space before it.
        let starts =
            |buffer: &Buffer| buffer.layout_runs().map(|run| run.text.to_owned()).collect::<Vec<_>>();
        let lines = starts(&shape(
            &mut letters.own,
            "one two three four",
            Font { size: 20.0, bold: false },
            Some(block(90.0, 2)),
            &BTreeSet::new(),
        ));
        assert!(
            lines.len() == 2 && lines[1].starts_with("three") || lines[1].starts_with("two"),
            "{lines:?}"
        );
    }

    #[test]
    fn what_the_embedded_fonts_have_needs_no_others() {
        let mut letters = TextShaper::new();
        for text in ["Šárka Ørsted · β 5 · −135°", "Ωμέγα", "Игорь", "ψ ± 0.1°  ℓ 2.00 m …", ""]
        {
            assert!(letters.lacks(std::iter::once(text)).is_empty(), "{text}");
        }
        assert!(letters.all.is_none());
    }

    #[test]
    fn what_they_lack_is_looked_for_and_told() {
        let mut letters = TextShaper::new();
        // A plane of private use: no font has that.
        let lacks = letters.lacks(["abc", "x\u{f4321}y"].into_iter());
        assert_eq!(lacks.into_iter().collect::<Vec<_>>(), ['\u{f4321}']);
        assert!(letters.all.is_some());
        // What the embedded fonts have stays as it was.
        let before = TextShaper::new().measure("robot-1", 13.0, true, None);
        assert_eq!(letters.measure("robot-1", 13.0, true, None), before);
    }
}
