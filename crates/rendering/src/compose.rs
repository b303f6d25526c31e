//! From a moment to what its picture consists of: origin, light, frames and words.

use crate::Viewpoint;
use crate::annotation::events::events;
use crate::annotation::inset::{clearness, inset};
use crate::annotation::labels::{LabelPlacer, Window, ring_boxes, robot_boxes, view_words};
use crate::annotation::overlays::{line_place, show};
use crate::annotation::text_shaper::TextShaper;
use crate::camera::Camera;
use crate::gpu::passes::backdrop::TILE;
use crate::gpu::passes::frame::FrameUniforms;
use crate::gpu::passes::shadow::{ShadowPass, SunView, sun_view};
use crate::ground::floor::DrivableSurface;
use crate::ground::trail::sizes;
use crate::picture_context::PictureContext;
use crate::picture_plan::{Area, PicturePlan, overlap};
use glam::{DVec2, DVec3};
use vocabulary::math;
use vocabulary::{FleetInfo, Light, RobotInfo, RobotState, StepRecord};

/// A multiple of the ground's tile near the robots, so that single precision is enough around it.
pub(crate) fn local_origin(record: &StepRecord) -> DVec3 {
    let places = record.snapshot.robots.iter().map(|r| r.motion.pose);
    let first = places.clone().find(|p| p.x.is_finite() && p.y.is_finite()).unwrap_or_default();
    let snap = |x: f64| (x / TILE).round() * TILE;
    DVec3::new(snap(first.x), snap(first.y), 0.0)
}

/// Lowest sun that is drawn, rad: below, shadows would leave their map.
const LOWEST_SUN: f64 = 0.05;

/// Direction to the sun.
pub(crate) fn towards_sun(light: &Light) -> DVec3 {
    let (sin, cos) = math::sin_cos(light.sun_elevation.clamp(LOWEST_SUN, std::f64::consts::FRAC_PI_2));
    let (across, along) = math::sin_cos(light.sun_azimuth);
    DVec3::new(along * cos, across * cos, sin)
}

/// Shadows are cast by props up to this far from the formation, m: farther, a texel would be as wide as a wheel.
const PROPS_WITHIN: f64 = 13.0;

/// Middle and radius of what the shadow map has to cover: all robots, and the props around them.
pub(crate) fn shadowed(fleet: &FleetInfo, record: &StepRecord) -> (DVec2, f64) {
    let (middle, radius) = robots_within(fleet, record).unwrap_or((DVec3::ZERO, 1.0));
    let mut reach = radius;
    for (k, prop) in fleet.props.iter().enumerate() {
        let place = record.snapshot.props.get(k).unwrap_or(&prop.placement).position;
        let away = middle.distance(DVec3::from_array(place))
            + math::hypot(prop.solid.reach(), prop.solid.extent()[2]);
        let away = away.min(PROPS_WITHIN.max(radius));
        // A prop that is too far for the map widens it to its limit only where it comes near.
        if away.is_finite() && middle.distance(DVec3::from_array(place)) < PROPS_WITHIN + radius {
            reach = reach.max(away);
        }
    }
    (middle.truncate(), reach)
}

/// Middle and radius of a ball around all robots; beyond 40 m a shadow is below a texel, wherever the robots are.
fn robots_within(fleet: &FleetInfo, record: &StepRecord) -> Option<(DVec3, f64)> {
    let places = || {
        let states = record.snapshot.robots.iter().map(|r| (r.motion.pose, r.attitude.height));
        states.map(|(p, height)| DVec3::new(p.x, p.y, 0.1 + height)).filter(|p| p.is_finite())
    };
    let low = places().fold(DVec3::INFINITY, DVec3::min);
    let high = places().fold(DVec3::NEG_INFINITY, DVec3::max);
    let size = sizes(fleet).max(1.0);
    low.is_finite().then(|| ((low + high) * 0.5, (0.5 * low.distance(high) + 0.8 * size).min(40.0)))
}

/// The sun's view of all robots and the props around them, for the shadow map.
pub(crate) fn sun_over(context: &PictureContext<'_>) -> SunView {
    match robots_within(context.fleet, context.record) {
        Some((middle, _)) => sun_view(context.sun, middle - context.origin, context.shadowed.1),
        None => sun_view(context.sun, DVec3::ZERO, 1.0),
    }
}

/// Depth up to which props are transparent: just short of the nearest robot in the picture. Where the user
/// has placed the eye, or in views from above, they stay opaque.
fn veiled(camera: &Camera, context: &PictureContext<'_>, view: &Viewpoint) -> f64 {
    if matches!(view, Viewpoint::Top | Viewpoint::Camera(_) | Viewpoint::Fixed { .. }) {
        return f64::NEG_INFINITY;
    }
    let nearest = |index: usize, state: &RobotState| {
        if matches!(view, Viewpoint::Follow(robot) if *robot != index) {
            return f64::INFINITY;
        }
        let pose = state.motion.pose;
        let place = DVec3::new(pose.x, pose.y, state.attitude.height);
        let seen = camera.project(place).is_some_and(|p| p.abs().max_element() < 1.0);
        if seen { camera.view_from_world(place).z } else { f64::INFINITY }
    };
    let robots = context.record.snapshot.robots.iter().enumerate();
    robots.map(|(k, robot)| nearest(k, robot)).fold(f64::INFINITY, f64::min) - 0.9 * context.size
}

/// In larger formations decks are not checked for hidden robots.
const MOST_LOOKED_FOR: usize = 500;

/// Which decks hide most of a robot. Others stay opaque, since a viewer may want to see the ramp.
pub(crate) fn veiled_decks(camera: &Camera, context: &PictureContext<'_>, view: &Viewpoint) -> Vec<bool> {
    let robots = &context.record.snapshot.robots;
    let drivables = &context.floor.drivables;
    if drivables.is_empty()
        || robots.len() > MOST_LOOKED_FOR
        || matches!(view, Viewpoint::Top | Viewpoint::Camera(_) | Viewpoint::Fixed { .. })
    {
        return vec![false; drivables.len()];
    }
    let looked_for = |k: &usize| !matches!(view, Viewpoint::Follow(robot) if robot != k);
    let all = robots.iter().zip(&context.fleet.robots).enumerate().filter(|(k, _)| looked_for(k));
    let spots: Vec<_> = all.map(|(_, (robot, member))| spots(robot, member)).collect();
    let hides = |drivable: &DrivableSurface| {
        spots
            .iter()
            .any(|of| of.iter().filter(|spot| drivable.hides(camera.eye, **spot)).count() > of.len() / 2)
    };
    drivables.iter().map(hides).collect()
}

/// Five places on a robot, half-way up.
fn spots(robot: &RobotState, member: &RobotInfo) -> [DVec3; 5] {
    let body = &member.body;
    let up = robot.attitude.height + 0.5 * body.height;
    [(0.0, 0.0), (0.4, 0.4), (0.4, -0.4), (-0.4, -0.4), (-0.4, 0.4)].map(|(forward, left)| {
        let ahead = 0.5 * body.wheelbase + forward * body.length;
        let [x, y] = robot.motion.pose.world_from_body(ahead, left * body.width);
        DVec3::new(x, y, up)
    })
}

pub(crate) fn frame(
    camera: &Camera,
    context: &PictureContext<'_>,
    view: &Viewpoint,
    sun: &SunView,
    shadow: &ShadowPass,
) -> FrameUniforms {
    let mut frame = FrameUniforms::new(camera, context.origin, sun.shadow_from_local);
    let [x, y, z] = context.sun.as_vec3().to_array();
    // A large formation is seen from farther away and would drown in it.
    let haze = (context.fleet.light.haze_from.max(0.1) * (0.2 * camera.eye.z).max(1.0)) as f32;
    frame.sun = [x, y, z, if context.style.shadows { shadow.penumbra(sun) } else { 0.0 }];
    if let Some(terrain) = &context.fleet.terrain {
        let [x, y] = terrain.origin;
        frame.terrain = (DVec3::new(x, y, 0.0) - context.origin).as_vec3().extend(1.0).to_array();
    }
    frame.spare[2] = shadow.clearance(sun);
    frame.spare[1] = f32::from(u8::from(!context.floor.is_plane()));
    let veiled = veiled(camera, context, view);
    frame.spare[0] = if veiled.is_finite() { veiled as f32 } else { -1e6 };
    frame.ground = [1.0 / haze, 0.0, f32::from(u8::from(context.style.grid)), 0.0];
    frame
}

/// Below this a panel is not there.
const UNSEEN: f32 = 0.02;

/// Text and flat shapes of the whole picture, and the panels that lie over views: that of errors, and a film's line.
pub(crate) fn words<'a>(
    letters: &'a mut TextShaper,
    context: &PictureContext<'_>,
    plan: &PicturePlan,
    windows: &[Window<'_>],
    size: [u32; 2],
) -> (LabelPlacer<'a>, Vec<Area>) {
    let mut words = LabelPlacer::new(letters, context.style.scale);
    let shown = &context.style.show;
    let left = plan.left;
    let said = shown.line.as_ref().filter(|line| line.opacity > 0.0);
    let said = said.map(|line| (line_place(&mut words, line, left.map(|side| side as f32)), line.opacity));
    if let Some((line, _)) = said {
        words.reserve(line);
    }
    let (lower, over) = windows.split_at(windows.len() - plan.upper);
    for window in over {
        words.framed(window.tile);
    }
    let sky = windows.first().map_or(0.0, |w| 0.5 * (1.0 - w.camera.horizon()) * f64::from(w.tile.height));
    plan.write(&mut words, context.record.snapshot.time, sky as f32);
    events(&mut words, context, plan.clock());
    let mut panels: Vec<_> = said.iter().map(|(line, _)| *line).collect();
    if let (Some(place), Some(first)) = (plan.panel, lower.first()) {
        let hidden = [robot_boxes(context, *first), ring_boxes(context, *first)].concat();
        // An empty panel under a card would only be a stain; and what a film says is worth more.
        let carded = shown.card.as_ref().map_or(0.0, |card| card.opacity);
        let told = said.filter(|(line, _)| overlap(line, &place)).map_or(0.0, |(_, opacity)| opacity);
        let clear = clearness(&words, &place, &hidden) * ((1.0 - carded) * (1.0 - told)) as f32;
        if clear > UNSEEN {
            inset(&mut words, context, place, clear);
            panels.push(place);
        }
    }
    for (view, window) in plan.views.iter().zip(windows) {
        view_words(&mut words, context, *window, view);
    }
    show(&mut words, shown, context.colours, left, size);
    (words, panels)
}
