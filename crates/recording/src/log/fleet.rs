//! The fleet as a message, so that a log alone can be drawn.

use super::record::{FieldValue, Fields, Record};
use std::sync::Arc;
use vocabulary::{
    Body, CameraModel, CameraMount, Edge, FleetInfo, Light, Prop, RobotInfo, Shell, Solid, Terrain,
};

impl Record for FleetInfo {
    const NAME: &'static str = "Fleet";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        f.text("title", &mut self.title)?;
        f.text("caption", &mut self.caption)?;
        f.number("duration_s", &mut self.duration)?;
        let Light { sun_elevation, sun_azimuth, haze_from } = &mut self.light;
        f.number("sun_elevation_rad", sun_elevation)?;
        f.number("sun_azimuth_rad", sun_azimuth)?;
        f.number("haze_from_m", haze_from)?;
        f.flag("has_sensors", &mut self.has_sensors)?;
        f.each("robots", &mut self.robots)?;
        f.each("edges", &mut self.edges)?;
        f.each("props", &mut self.props)?;
        let mut terrain = self.terrain.iter().map(|terrain| Terrain::clone(terrain)).collect();
        f.each("terrain", &mut terrain)?;
        self.terrain = terrain.into_iter().next().map(Arc::new);
        f.flag("has_safety", &mut self.has_safety)?;
        f.flag("has_events", &mut self.has_events)?;
        f.flag("has_laws", &mut self.has_laws)?;
        let mut free = self
            .free
            .iter()
            .map(|[distance, bearing]| FreeParts { distance: *distance, bearing: *bearing })
            .collect();
        f.each("free", &mut free)?;
        self.free = free.into_iter().map(|free| [free.distance, free.bearing]).collect();
        f.flag("has_plans", &mut self.has_plans)?;
        Some(())
    }
}

/// What is left free of the set point of an edge.
#[derive(Default)]
struct FreeParts {
    distance: bool,
    bearing: bool,
}

impl Record for FreeParts {
    const NAME: &'static str = "FreeParts";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        f.flag("distance", &mut self.distance)?;
        f.flag("bearing", &mut self.bearing)
    }
}

impl Record for RobotInfo {
    const NAME: &'static str = "Robot";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let Self { name, leads, body, shell, camera_mount, camera_model } = self;
        f.text("name", name)?;
        f.flag("leads", leads)?;
        let Body { length, width, height, wheelbase, track, wheel_radius } = body;
        f.number("length_m", length)?;
        f.number("width_m", width)?;
        f.number("height_m", height)?;
        f.number("wheelbase_m", wheelbase)?;
        f.number("track_m", track)?;
        f.number("wheel_radius_m", wheel_radius)?;
        let mut shells = shell.iter().copied().collect();
        f.each("shell", &mut shells)?;
        *shell = shells.first().copied();
        let CameraMount { forward, height } = camera_mount;
        f.number("camera_forward_m", forward)?;
        f.number("camera_height_m", height)?;
        let CameraModel { width, height, focal, centre, distortion } = camera_model;
        f.count("picture_width_px", width)?;
        f.count("picture_height_px", height)?;
        f.number("focal_px", focal)?;
        f.numbers("centre_px", centre)?;
        f.numbers("distortion", distortion)
    }
}

impl Record for Shell {
    const NAME: &'static str = "Shell";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let Self { apothem, face_height, lean, cell, forward, height, first_tag } = self;
        f.number("apothem_m", apothem)?;
        f.number("face_height_m", face_height)?;
        f.number("lean_rad", lean)?;
        f.number("cell_m", cell)?;
        f.number("forward_m", forward)?;
        f.number("height_m", height)?;
        let (mut tagged, mut first) = (first_tag.is_some(), first_tag.unwrap_or_default());
        f.flag("tagged", &mut tagged)?;
        f.count("first_tag", &mut first)?;
        *first_tag = tagged.then_some(first);
        Some(())
    }
}

impl Record for Edge {
    const NAME: &'static str = "Edge";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        f.count("leader", &mut self.leader)?;
        f.count("follower", &mut self.follower)
    }
}

impl Record for Prop {
    const NAME: &'static str = "Prop";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        f.text("name", &mut self.name)?;
        let (mut form, mut size) = match self.solid {
            Solid::Block { size } => (0, size),
            Solid::Cylinder { radius, height } => (1, [radius, radius, height]),
            Solid::Cone { radius, height } => (2, [radius, radius, height]),
            Solid::Wedge { size } => (3, size),
        };
        f.field("form", FieldValue::Choice(&mut form, &["block", "cylinder", "cone", "wedge"]))?;
        // Length, width, height; of round things the radius twice.
        f.numbers("size_m", &mut size)?;
        let [radius, _, height] = size;
        self.solid = match form {
            0 => Solid::Block { size },
            1 => Solid::Cylinder { radius, height },
            2 => Solid::Cone { radius, height },
            _ => Solid::Wedge { size },
        };
        f.numbers("position_m", &mut self.placement.position)?;
        f.numbers("rotation_xyzw", &mut self.placement.rotation)?;
        f.word("mobility", &mut self.mobility)
    }
}

impl Record for Terrain {
    const NAME: &'static str = "Terrain";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        f.numbers("origin_m", &mut self.origin)?;
        f.number("cell_m", &mut self.cell)?;
        f.count("columns", &mut self.columns)?;
        f.count("rows", &mut self.rows)?;
        f.field("heights_m", FieldValue::Series(&mut self.heights))?;
        f.field("grip", FieldValue::Series(&mut self.grip))
    }
}

/// Whether nothing in a fleet that was read leads out of it.
pub(super) fn sound(fleet: &FleetInfo) -> bool {
    let there = |robot: usize| robot < fleet.robots.len();
    let edges = fleet.edges.iter().all(|edge| there(edge.leader) && there(edge.follower));
    let terrain = fleet.terrain.as_ref().is_none_or(|terrain| {
        let points = terrain.columns.checked_mul(terrain.rows);
        let filled = |values: &[f64]| points == Some(values.len()) && values.iter().all(|v| v.is_finite());
        terrain.columns >= 2
            && terrain.rows >= 2
            && terrain.cell > 0.0
            && filled(&terrain.heights)
            && (terrain.grip.is_empty() || filled(&terrain.grip))
    });
    edges && terrain
}
