//! What words and panels take of a picture, decided before its cameras are: these then keep robots out of there.

use crate::Style;
use crate::annotation::inset::panel;
use crate::annotation::labels::{Ink, LabelPlacer, MARGIN};
use crate::annotation::overlays::line_room;
use crate::annotation::text_shaper::{Block, TextShaper, line_height};
use crate::camera::free_space::FreeSpace;
use crate::camera::viewpoint::{Tile, ViewLayout, Viewpoint, corner};
use crate::palette;
use vocabulary::FleetInfo;

/// A rectangle of the picture: left, top, width, height; pixels.
pub(crate) type Area = [f32; 4];

pub(crate) fn overlap(a: &Area, b: &Area) -> bool {
    a[0] < b[0] + b[2] && b[0] < a[0] + a[2] && a[1] < b[1] + b[3] && b[1] < a[1] + a[3]
}

/// Most lines of a title, and of the caption under it.
const ROWS: usize = 2;
/// Between words and the robots' part of the picture, at scale 1, pixels.
const APART: f32 = 14.0;

/// Title or caption.
#[derive(Debug, Clone)]
struct Heading {
    text: String,
    size: f32,
    bold: bool,
    block: Block,
    area: Area,
}

/// The views of a picture, and everything in it that has its place before a camera is chosen.
#[derive(Debug, Clone)]
pub(crate) struct PicturePlan {
    pub(crate) views: Vec<Viewpoint>,
    pub(crate) tiles: Vec<Tile>,
    /// How many of the views, the last, lie over others.
    pub(crate) upper: usize,
    /// The part of the picture that is left for the views, pixels.
    pub(crate) left: [u32; 2],
    headings: Vec<Heading>,
    clock: Option<Area>,
    /// Where errors are plotted.
    pub(crate) panel: Option<Area>,
    /// What no robot shall be under.
    taken: Vec<Area>,
    scale: f32,
}

impl PicturePlan {
    pub(crate) fn new(
        letters: &mut TextShaper,
        fleet: &FleetInfo,
        layout: &ViewLayout,
        style: &Style,
        size: [u32; 2],
    ) -> Self {
        let left = style.show.left_over(size);
        let (mut views, mut tiles, mut upper) = (layout.views.clone(), layout.tiles(left[0], left[1]), 0);
        let member = style.picture_in_picture.and_then(|robot| fleet.robots.get(robot).map(|m| (robot, m)));
        if let (Some((robot, member)), Some(first)) = (member, tiles.first()) {
            let aspect =
                f64::from(member.camera_model.width.max(1)) / f64::from(member.camera_model.height.max(1));
            tiles.push(corner(first, aspect, 24.0 * style.scale));
            views.push(Viewpoint::Camera(robot));
            upper = 1;
        }
        let mut words = LabelPlacer::new(letters, style.scale);
        let onboard = |view: &Viewpoint| matches!(view, Viewpoint::Camera(_));
        let titled = !views.iter().all(onboard);
        let small = tiles.get(tiles.len() - upper).map(Tile::area);
        let mut plan = Self {
            headings: Vec::new(),
            clock: None,
            panel: None,
            taken: small.into_iter().collect(),
            views,
            tiles,
            upper,
            left,
            scale: style.scale as f32,
        };
        if titled && style.caption {
            let free = plan.free_width(&words);
            plan.headings = headings(&mut words, fleet, free);
        }
        if titled && style.clock {
            plan.clock = Some(clock(&mut words, fleet, left));
        }
        let line = line_room(&mut words, &style.show, left.map(|side| side as f32));
        let below = plan.views.len() - upper;
        // In a quarter of a picture it would cover a whole view.
        let charted = style.show.plots.is_empty()
            && below <= 2
            && !plan.views.first().is_some_and(onboard)
            && !fleet.edges.is_empty();
        let place = plan.tiles.first().filter(|_| charted).and_then(|tile| panel(&words, *tile));
        plan.panel = place.filter(|_| style.inset);
        let kept = place.filter(|_| style.inset || style.show.room.panel);
        plan.taken.extend(plan.headings.iter().map(|heading| heading.area));
        plan.taken.extend(plan.clock.into_iter().chain(kept).chain(line));
        plan
    }

    /// Pixels that a title may take across.
    fn free_width(&self, words: &LabelPlacer<'_>) -> f32 {
        let margin = words.scaled(MARGIN);
        let whole = self.left[0] as f32 - 2.0 * margin;
        let small = self.tiles.get(self.tiles.len() - self.upper).map(|tile| tile.x as f32 - 2.0 * margin);
        // The scale bar of a view from above stands in the corner on the right.
        let right = |tile: &Tile| tile.y == 0 && tile.x + tile.width == self.left[0];
        let bars =
            self.tiles.iter().zip(&self.views).filter(|(tile, view)| **view == Viewpoint::Top && right(tile));
        let bar = bars.map(|(tile, _)| whole - 0.24 * tile.width as f32 - margin).reduce(f32::min);
        let free = whole.min(small.unwrap_or(whole)).min(bar.unwrap_or(whole));
        free.max(0.3 * whole).max(1.0)
    }

    /// What is left for the robots in a tile.
    pub(crate) fn room(&self, index: usize) -> FreeSpace {
        let tile = self.tiles[index];
        // Only what lies over the tile; a small picture in a corner has none of that.
        let lower = index + self.upper < self.tiles.len();
        let own = |taken: &&Area| lower && overlap(taken, &tile.area());
        let taken = self.taken.iter().filter(own);
        let apart = APART * self.scale;
        let grown = taken.map(|[x, y, width, height]| {
            let [left, top] = [x - tile.x as f32 - apart, y - tile.y as f32 - apart];
            [left, top, width + 2.0 * apart, height + 2.0 * apart].map(f64::from)
        });
        FreeSpace::new(
            [f64::from(tile.width), f64::from(tile.height)],
            grown.collect(),
            f64::from(self.scale),
        )
    }

    /// Title, law and time, at the corners of the whole picture; `sky` is how far down the sky reaches, pixels.
    pub(crate) fn write(&self, words: &mut LabelPlacer<'_>, time: f64, sky: f32) {
        for Heading { text, size, bold, block, area } in &self.headings {
            words.reserve(*area);
            let first = area[1] + 0.5 * line_height(words.scaled(*size));
            // Dark on sky and haze, with a rim where these end, and light on the ground.
            let [middle, bottom] = [area[1] + 0.5 * area[3], area[1] + area[3]];
            let rim = if bottom > sky { 0.5 } else { 0.0 };
            let dark = Ink { halo: (rim, palette::PAPER), ..Ink::DARK };
            let ink = if middle < 1.6 * sky { dark } else { Ink::LIGHT };
            words.write_block(text.clone(), [area[0], first], *size, *bold, ink, Some(*block));
        }
        if let Some(area) = self.clock {
            words.reserve(area);
            words.write(time_text(time), [area[0], area[1] + 0.5 * area[3]], CLOCK, true, Ink::LIGHT);
        }
    }

    /// Where the clock is, if it is shown.
    pub(crate) fn clock(&self) -> Option<Area> {
        self.clock
    }

    /// The rectangles of title, caption and clock.
    pub(crate) fn captions(&self) -> impl Iterator<Item = Area> {
        self.headings.iter().map(|heading| heading.area).chain(self.clock)
    }
}

/// Size of the clock's letters at scale 1, pixels.
const CLOCK: f32 = 18.0;

fn time_text(time: f64) -> String {
    format!("t = {time:.2} s")
}

/// Title and caption, one under the other, within `free` pixels.
fn headings(words: &mut LabelPlacer<'_>, fleet: &FleetInfo, free: f32) -> Vec<Heading> {
    let margin = words.scaled(MARGIN);
    let mut top = margin - words.scaled(2.0);
    let mut all = Vec::new();
    for (text, full, bold, below) in [(&fleet.title, 20.0, true, 1.0), (&fleet.caption, 13.0, false, 0.0)] {
        if text.trim().is_empty() {
            continue;
        }
        // Where it is a little too long for a line, in smaller letters; then in two lines.
        let fit = free / words.width(text, full, bold).max(1.0);
        let size = if (0.8..1.0).contains(&fit) { full * 0.995 * fit } else { full };
        let block = Block { width: free, rows: ROWS, centred: false };
        let measure = words.measure(text, size, bold, Some(block));
        let high = line_height(words.scaled(size)) * measure.rows as f32;
        all.push(Heading { text: text.clone(), size, bold, block, area: [margin, top, measure.width, high] });
        top += high + words.scaled(below);
    }
    all
}

/// Where the clock is: wide enough for any time of the run, so that it takes the same room all the time.
fn clock(words: &mut LabelPlacer<'_>, fleet: &FleetInfo, [_, height]: [u32; 2]) -> Area {
    let margin = words.scaled(MARGIN);
    let (width, high) = (words.width(&time_text(fleet.duration), CLOCK, true), words.scaled(28.0));
    [margin, height as f32 - margin - words.scaled(8.0) - 0.5 * high, width, high]
}
