//! A fleet with all that follows from it for every picture.

use crate::gpu::robot_models::RobotModels;
use crate::ground::floor::Floor;
use crate::palette::{Rgb, robot_colours};
use vocabulary::FleetInfo;

/// A fleet, its colours and models, and the floor on which it drives.
#[derive(Debug)]
pub(crate) struct FleetModel {
    pub(crate) fleet: FleetInfo,
    pub(crate) colours: Vec<Rgb>,
    pub(crate) robots: RobotModels,
    pub(crate) floor: Floor,
}

impl FleetModel {
    pub(crate) fn new(fleet: &FleetInfo) -> Self {
        Self {
            fleet: fleet.clone(),
            colours: robot_colours(fleet),
            robots: RobotModels::new(fleet),
            floor: Floor::new(fleet),
        }
    }
}
