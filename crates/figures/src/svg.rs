//! SVG text: shapes, numbers, words.

use std::fmt::Write;

/// sRGB, 0 to 1 a channel.
pub type Rgb = [f32; 3];

/// Families that look alike enough where Inter is not installed.
const FONT: &str = "Inter, Helvetica, Arial, sans-serif";

/// A picture that grows.
#[derive(Default)]
pub(crate) struct Svg(String);

/// Where a text begins.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Svg {
    /// A path with any attributes.
    pub(crate) fn path(&mut self, d: &str, attributes: &str) {
        let _ = writeln!(self.0, "<path d=\"{d}\" {attributes}/>");
    }

    pub(crate) fn line(&mut self, from: [f64; 2], to: [f64; 2], attributes: &str) {
        let d = format!("M{}L{}", point(from), point(to));
        self.path(&d, attributes);
    }

    pub(crate) fn rect(&mut self, [x, y]: [f64; 2], [w, h]: [f64; 2], attributes: &str) {
        let (x, y, w, h) = (number(x), number(y), number(w), number(h));
        let _ = writeln!(self.0, "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" {attributes}/>");
    }

    pub(crate) fn text(&mut self, [x, y]: [f64; 2], text: &str, anchor: Anchor, attributes: &str) {
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let (x, y, text) = (number(x), number(y), escape(text));
        let _ = writeln!(self.0, "<text x=\"{x}\" y=\"{y}\"{anchor} {attributes}>{text}</text>");
    }

    /// The whole picture, `width` by `height` in points of print.
    pub(crate) fn finish(self, title: &str, [width, height]: [f64; 2]) -> String {
        let millimetres = |points: f64| number(points * 25.4 / 72.0);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\" \
             font-family=\"{FONT}\" font-size=\"7\" fill=\"#1e1e22\">\n<title>{}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
            millimetres(width),
            millimetres(height),
            number(width),
            number(height),
            escape(title),
            self.0
        )
    }
}

/// Two coordinates of a path.
pub(crate) fn point([x, y]: [f64; 2]) -> String {
    format!("{} {}", number(x), number(y))
}

/// A path through points.
pub(crate) fn polyline(points: &[[f64; 2]]) -> String {
    let step = |(k, p): (usize, &[f64; 2])| format!("{}{}", if k == 0 { 'M' } else { 'L' }, point(*p));
    points.iter().enumerate().map(step).collect()
}

/// Two decimals, a hundredth of a point of print, without zeros at the end.
pub(crate) fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A text as XML takes it; characters that XML has no place for are left out.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || ['\u{fffe}', '\u{ffff}'].contains(&c) => {}
            c => out.push(c),
        }
    }
    out
}

/// What share of a white sheet's light a colour on paper may give back at most.
const LIGHTEST: f32 = 0.3;

/// A colour as `#rrggbb`, dark enough for a thin line on paper.
pub(crate) fn ink(colour: Rgb) -> String {
    let clean = colour.map(|c| if c.is_finite() { c.clamp(0.0, 1.0) } else { 0.0 });
    let linear = clean.map(|c| c.powf(2.2));
    let light = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    let factor = (LIGHTEST / light.max(1e-6)).min(1.0).powf(1.0 / 2.2);
    let [r, g, b] = clean.map(|c| (c * factor * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// About as wide as a text of `size` points is set, a little more rather than less.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let of = |c: char| match c {
        'i' | 'l' | 'j' | '.' | ',' | ':' | ';' | '|' | '\'' | ' ' | 'I' => 0.3,
        'f' | 't' | 'r' | '(' | ')' | '-' | '°' => 0.4,
        'm' | 'w' | 'M' | 'W' => 0.9,
        c if c.is_uppercase() => 0.71,
        _ => 0.62,
    };
    text.chars().map(of).sum::<f64>() * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            ["0", "1.5", "-2", "0", "0.33"],
            [0.0, 1.5, -2.0, -0.001, 1.0 / 3.0].map(number).each_ref().map(|s| &**s)
        );
    }

    #[test]
    fn light_colours_are_darkened_and_dark_ones_kept() {
        assert_eq!(ink([0.0, 0.0, 0.0]), "#000000");
        assert_eq!(ink([0.0, 0.447, 0.698]), "#0072b2");
        assert_ne!(ink([0.94, 0.89, 0.26]), "#f0e342");
        assert_eq!(ink([f32::NAN, 2.0, -1.0]).len(), 7);
    }
}
