//! Where things are in a picture, without drawing it: what words and panels cover, and what they should not.

use crate::annotation::labels::{Window, detail, ring_boxes, robot_boxes};
use crate::annotation::text_shaper::TextShaper;
use crate::compose::{local_origin, shadowed, towards_sun, words};
use crate::ground::floor::Floor;
use crate::palette::robot_colours;
use crate::picture_context::PictureContext;
use crate::picture_plan::{PicturePlan, area, overlap};
use crate::renderer::cameras;
use crate::{Style, Trail, ViewLayout, Viewpoint};
use vocabulary::{FleetInfo, StepRecord};

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
    pub fn new(
        fleet: &FleetInfo,
        trail: &Trail,
        record: &StepRecord,
        layout: &ViewLayout,
        style: &Style,
        size: [u32; 2],
    ) -> Self {
        let mut letters = TextShaper::new();
        let floor = Floor::new(fleet);
        let colours = robot_colours(fleet);
        let plan = PicturePlan::new(&mut letters, fleet, layout, style, size);
        let cameras = cameras(&plan, trail, record, fleet, &floor);
        let context = PictureContext {
            fleet,
            floor: &floor,
            colours: &colours,
            trail,
            record,
            style,
            origin: local_origin(record),
            sun: towards_sun(&fleet.light),
            size: trail.smoothed.formation().size,
            shadowed: shadowed(fleet, record),
            detail: detail(fleet.robots.len()),
        };
        let windows: Vec<_> =
            cameras.iter().zip(&plan.tiles).map(|(camera, tile)| Window { camera, tile: *tile }).collect();
        let (words, panels) = words(&mut letters, &context, &plan, &windows, size);
        let views: Vec<_> = plan.tiles.iter().map(area).collect();
        let mut composition = Self {
            panels: [&panels, &views[views.len() - plan.upper..]].concat(),
            captions: plan.captions().collect(),
            labels: words.labels,
            ..Self::default()
        };
        for (view, window) in plan.views.iter().zip(&windows) {
            if !matches!(view, Viewpoint::Camera(_)) {
                let seen =
                    |boxes: Vec<[f32; 4]>| boxes.into_iter().filter(|b| overlap(b, &area(&window.tile)));
                composition.robots.extend(seen(robot_boxes(&context, *window)));
                composition.set_points.extend(seen(ring_boxes(&context, *window)));
            }
        }
        Self { views, ..composition }
    }
}
