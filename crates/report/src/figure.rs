//! Figures, tables and films of a report, before they are written.

use crate::claim::FigureClaim;

/// One figure.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportFigure {
    /// File name without its ending.
    pub stem: String,
    /// Its caption, in a sentence or two.
    pub caption: String,
    /// The figure itself.
    pub svg: String,
    /// The numbers behind it.
    pub csv: String,
    /// Its claims.
    pub claims: Vec<FigureClaim>,
    /// A drawn picture (PNG) in place of curves; the SVG then holds it.
    pub picture: Option<Vec<u8>>,
}

impl ReportFigure {
    /// A figure without claims.
    pub fn new(stem: impl Into<String>, caption: impl Into<String>, svg: String, csv: String) -> Self {
        Self { stem: stem.into(), caption: caption.into(), svg, csv, claims: vec![], picture: None }
    }

    /// The figure with these claims.
    #[must_use]
    pub fn with(mut self, claims: Vec<FigureClaim>) -> Self {
        self.claims.extend(claims);
        self
    }
}

/// A film and its caption.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportFilm {
    /// File name.
    pub file: String,
    /// What is seen.
    pub caption: String,
    /// The file.
    pub mp4: Vec<u8>,
}

/// Rows of text under a head.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReportTable {
    /// What it shows.
    pub caption: String,
    /// Names of the columns.
    pub head: Vec<String>,
    /// Cells.
    pub rows: Vec<Vec<String>>,
    /// Whether its cells are words, which are broken into lines, instead of numbers.
    pub words: bool,
}

/// Everything that a report shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// At its head.
    pub title: String,
    /// Under it.
    pub lead: String,
    /// Figures in order.
    pub items: Vec<ReportFigure>,
    /// Films.
    pub films: Vec<ReportFilm>,
    /// Numbers.
    pub tables: Vec<ReportTable>,
    /// What was left out, and why.
    pub left_out: Vec<String>,
    /// What made it: name, version.
    pub versions: Vec<[String; 2]>,
}

impl Report {
    /// All claims in the order of the figures.
    pub fn claims(&self) -> impl Iterator<Item = &FigureClaim> {
        self.items.iter().flat_map(|item| &item.claims)
    }
}
