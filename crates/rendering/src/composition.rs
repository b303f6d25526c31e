//! Where things are in a picture, without drawing it: what words and panels cover, and what they should not.

use crate::annotation::labels::{Window, ring_boxes, robot_boxes};
use crate::annotation::text_shaper::TextShaper;
use crate::compose::words;
use crate::fleet_model::FleetModel;
use crate::picture_context::PictureContext;
use crate::picture_plan::{PicturePlan, overlap};
use crate::renderer::cameras;
use crate::{PictureSpec, Tile, Viewpoint};
use vocabulary::FleetInfo;

/// Rectangles of a picture: left, top, width and height in pixels from its upper left corner.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Composition {
    /// The views, those that lie over others last.
    pub views: Vec<[f32; 4]>,
    /// The chart of errors, a film's line, and views in corners.
    pub panels: Vec<[f32; 4]>,
    /// Title, caption and time.
    pub captions: Vec<[f32; 4]>,
    /// Names, edges and coordinates.
    pub labels: Vec<[f32; 4]>,
    /// Robots as far as a view shows them; not those of views through cameras.
    pub robots: Vec<[f32; 4]>,
    /// The rings at set points, likewise.
    pub set_points: Vec<[f32; 4]>,
}

impl Composition {
    /// That of the picture that a renderer of `fleet` draws at a size.
    pub fn new(fleet: &FleetInfo, spec: PictureSpec<'_>, size: [u32; 2]) -> Self {
        let mut letters = TextShaper::new();
        let model = FleetModel::new(fleet);
        let plan = PicturePlan::new(&mut letters, fleet, spec.layout, spec.style, size);
        let context = PictureContext::new(&model, spec.trail, spec.record, spec.style);
        let cameras = cameras(&plan, &context);
        let windows: Vec<_> =
            cameras.iter().zip(&plan.tiles).map(|(camera, tile)| Window { camera, tile: *tile }).collect();
        let (words, panels) = words(&mut letters, &context, &plan, &windows, size);
        let views: Vec<_> = plan.tiles.iter().map(Tile::area).collect();
        let mut composition = Self {
            panels: [&panels, &views[views.len() - plan.upper..]].concat(),
            captions: plan.captions().collect(),
            labels: words.labels,
            ..Self::default()
        };
        for (view, window) in plan.views.iter().zip(&windows) {
            if !matches!(view, Viewpoint::Camera(_)) {
                let seen =
                    |boxes: Vec<[f32; 4]>| boxes.into_iter().filter(|b| overlap(b, &window.tile.area()));
                composition.robots.extend(seen(robot_boxes(&context, *window)));
                composition.set_points.extend(seen(ring_boxes(&context, *window)));
            }
        }
        Self { views, ..composition }
    }
}
