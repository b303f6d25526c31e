//! The cast as a message, so that a log alone can be drawn.

use super::record::{Fields, Record};
use std::sync::Arc;
use vocabulary::{
    Body, CameraModel, CameraMount, Edge, FleetInfo, Light, Mobility, Placement, Prop, RobotInfo, Shell,
    Solid, Terrain,
};

/// [`FleetInfo`] with a list of fields.
#[derive(Default)]
pub(super) struct FleetRecord(pub(super) FleetInfo);

struct Actor(RobotInfo);
struct EdgeRecord(Edge);
struct Scenery(Prop);
struct Land(Terrain);
struct Tags(Shell);

impl Default for Actor {
    fn default() -> Self {
        Self(RobotInfo::new("", false, Body::default()))
    }
}

impl Default for EdgeRecord {
    fn default() -> Self {
        Self(Edge { leader: 0, follower: 0 })
    }
}

impl Default for Scenery {
    fn default() -> Self {
        Self(Prop {
            name: String::new(),
            solid: Solid::Block { size: [0.0; 3] },
            placement: Placement::default(),
            mobility: Mobility::Fixed,
        })
    }
}

impl Default for Land {
    fn default() -> Self {
        let (heights, grip) = (vec![], vec![]);
        Self(Terrain { origin: [0.0; 2], cell: 0.0, columns: 0, rows: 0, heights, grip })
    }
}

impl Default for Tags {
    fn default() -> Self {
        Self(Shell::PAPER)
    }
}

/// A whole number of another type than the wire's.
fn whole<F: Fields, T>(f: &mut F, name: &'static str, value: &mut T) -> Option<()>
where
    T: Copy + TryInto<u64> + TryFrom<u64>,
{
    let mut wide = (*value).try_into().ok()?;
    f.count(name, &mut wide)?;
    *value = T::try_from(wide).ok()?;
    Some(())
}

impl Record for FleetRecord {
    const NAME: &'static str = "Fleet";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let fleet = &mut self.0;
        f.text("title", &mut fleet.title)?;
        f.text("caption", &mut fleet.caption)?;
        f.number("duration_s", &mut fleet.duration)?;
        let Light { sun_elevation, sun_azimuth, haze_from } = &mut fleet.light;
        f.number("sun_elevation_rad", sun_elevation)?;
        f.number("sun_azimuth_rad", sun_azimuth)?;
        f.number("haze_from_m", haze_from)?;
        f.flag("has_sensors", &mut fleet.has_sensors)?;
        let mut members = std::mem::take(&mut fleet.robots).into_iter().map(Actor).collect();
        let mut edges = fleet.edges.iter().copied().map(EdgeRecord).collect();
        let mut props = std::mem::take(&mut fleet.props).into_iter().map(Scenery).collect();
        let mut land = fleet.terrain.iter().map(|land| Land(Terrain::clone(land))).collect();
        let told = f
            .each("robots", &mut members)
            .and_then(|()| f.each("edges", &mut edges))
            .and_then(|()| f.each("props", &mut props))
            .and_then(|()| f.each("terrain", &mut land));
        fleet.robots = members.into_iter().map(|Actor(member)| member).collect();
        fleet.edges = edges.into_iter().map(|EdgeRecord(edge)| edge).collect();
        fleet.props = props.into_iter().map(|Scenery(prop)| prop).collect();
        fleet.terrain = land.into_iter().next().map(|Land(land)| Arc::new(land));
        told
    }
}

impl Record for Actor {
    const NAME: &'static str = "Robot";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let RobotInfo { name, leads, body, shell, camera_mount, camera_model } = &mut self.0;
        f.text("name", name)?;
        f.flag("leads", leads)?;
        let Body { length, width, height, wheelbase, track, wheel_radius } = body;
        f.number("length_m", length)?;
        f.number("width_m", width)?;
        f.number("height_m", height)?;
        f.number("wheelbase_m", wheelbase)?;
        f.number("track_m", track)?;
        f.number("wheel_radius_m", wheel_radius)?;
        let mut shells = shell.iter().copied().map(Tags).collect();
        f.each("shell", &mut shells)?;
        *shell = shells.first().map(|Tags(shell)| *shell);
        let CameraMount { forward, height } = camera_mount;
        f.number("camera_forward_m", forward)?;
        f.number("camera_height_m", height)?;
        let CameraModel { width, height, focal, centre, distortion } = camera_model;
        whole(f, "picture_width_px", width)?;
        whole(f, "picture_height_px", height)?;
        f.number("focal_px", focal)?;
        f.numbers("centre_px", centre)?;
        f.numbers("distortion", distortion)
    }
}

impl Record for Tags {
    const NAME: &'static str = "Shell";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let Shell { apothem, face_height, lean, cell, forward, height, first_tag } = &mut self.0;
        f.number("apothem_m", apothem)?;
        f.number("face_height_m", face_height)?;
        f.number("lean_rad", lean)?;
        f.number("cell_m", cell)?;
        f.number("forward_m", forward)?;
        f.number("height_m", height)?;
        let (mut tagged, mut first) = (first_tag.is_some(), first_tag.unwrap_or_default());
        f.flag("tagged", &mut tagged)?;
        whole(f, "first_tag", &mut first)?;
        *first_tag = tagged.then_some(first);
        Some(())
    }
}

impl Record for EdgeRecord {
    const NAME: &'static str = "Edge";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        whole(f, "leader", &mut self.0.leader)?;
        whole(f, "follower", &mut self.0.follower)
    }
}

#[derive(Clone, Copy, PartialEq)]
enum SolidForm {
    Block,
    Cylinder,
    Cone,
    Wedge,
}

const FORMS: [(SolidForm, &str); 4] = [
    (SolidForm::Block, "block"),
    (SolidForm::Cylinder, "cylinder"),
    (SolidForm::Cone, "cone"),
    (SolidForm::Wedge, "wedge"),
];

const MOBILITIES: [(Mobility, &str); 3] =
    [(Mobility::Fixed, "fixed"), (Mobility::Loose, "loose"), (Mobility::Guided, "guided")];

impl Record for Scenery {
    const NAME: &'static str = "Prop";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let Prop { name, solid, placement, mobility } = &mut self.0;
        f.text("name", name)?;
        let (mut form, mut size) = match *solid {
            Solid::Block { size } => (SolidForm::Block, size),
            Solid::Wedge { size } => (SolidForm::Wedge, size),
            Solid::Cylinder { radius, height } => (SolidForm::Cylinder, [radius, radius, height]),
            Solid::Cone { radius, height } => (SolidForm::Cone, [radius, radius, height]),
        };
        f.choice("form", &mut form, &FORMS)?;
        // Length, width, height; of round things the radius twice.
        f.numbers("size_m", &mut size)?;
        let [radius, _, height] = size;
        *solid = match form {
            SolidForm::Block => Solid::Block { size },
            SolidForm::Wedge => Solid::Wedge { size },
            SolidForm::Cylinder => Solid::Cylinder { radius, height },
            SolidForm::Cone => Solid::Cone { radius, height },
        };
        f.numbers("position_m", &mut placement.position)?;
        f.numbers("rotation_xyzw", &mut placement.rotation)?;
        f.choice("mobility", mobility, &MOBILITIES)
    }
}

impl Record for Land {
    const NAME: &'static str = "Terrain";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let Terrain { origin, cell, columns, rows, heights, grip } = &mut self.0;
        f.numbers("origin_m", origin)?;
        f.number("cell_m", cell)?;
        whole(f, "columns", columns)?;
        whole(f, "rows", rows)?;
        f.series("heights_m", heights)?;
        f.series("grip", grip)
    }
}

/// Whether nothing in a cast that was read leads out of it.
pub(super) fn sound(fleet: &FleetInfo) -> bool {
    let there = |robot: usize| robot < fleet.robots.len();
    let edges = fleet.edges.iter().all(|edge| there(edge.leader) && there(edge.follower));
    let land = fleet.terrain.as_ref().is_none_or(|land| {
        let points = land.columns.checked_mul(land.rows);
        let filled = |values: &[f64]| points == Some(values.len()) && values.iter().all(|v| v.is_finite());
        land.columns >= 2
            && land.rows >= 2
            && land.cell > 0.0
            && filled(&land.heights)
            && (land.grip.is_empty() || filled(&land.grip))
    });
    edges && land
}
