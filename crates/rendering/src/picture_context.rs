//! The data that all parts of a picture share.

use crate::annotation::labels::detail;
use crate::compose::{local_origin, shadowed, towards_sun};
use crate::fleet_model::FleetModel;
use crate::gpu::robot_models::RobotModels;
use crate::ground::floor::Floor;
use crate::palette::Rgb;
use crate::{Style, Trail};
use glam::{DVec2, DVec3};
use vocabulary::{FleetInfo, StepRecord};

/// The record of a picture with everything that all its views share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PictureContext<'a> {
    pub(crate) fleet: &'a FleetInfo,
    pub(crate) floor: &'a Floor,
    pub(crate) colours: &'a [Rgb],
    pub(crate) robot_models: &'a RobotModels,
    pub(crate) trail: &'a Trail,
    pub(crate) record: &'a StepRecord,
    pub(crate) style: &'a Style,
    pub(crate) origin: DVec3,
    /// Direction to the sun.
    pub(crate) sun: DVec3,
    /// How many times as large as the default body the largest is.
    pub(crate) size: f64,
    /// Middle and radius of what the shadow map covers, m.
    pub(crate) shadowed: (DVec2, f64),
    /// How clearly edges, labels, rings and ghosts show: 1 for small formations, 0 for large ones.
    pub(crate) detail: f32,
}

impl<'a> PictureContext<'a> {
    pub(crate) fn new(
        model: &'a FleetModel,
        trail: &'a Trail,
        record: &'a StepRecord,
        style: &'a Style,
    ) -> Self {
        let FleetModel { fleet, colours, robots, floor } = model;
        Self {
            fleet,
            floor,
            colours,
            robot_models: robots,
            trail,
            record,
            style,
            origin: local_origin(record),
            sun: towards_sun(&fleet.light),
            size: trail.smoothed.formation().size,
            shadowed: shadowed(fleet, record),
            detail: detail(fleet.robots.len()),
        }
    }

    /// The point of the floor at (x, y), m.
    pub(crate) fn on_floor(&self, x: f64, y: f64) -> DVec3 {
        DVec3::new(x, y, self.floor.height(DVec2::new(x, y)))
    }
}
