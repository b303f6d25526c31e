//! What lies on the ground in one view: contact patches, marks, ribbons, rings, arrows and edges.

pub(crate) mod annotations;
mod barriers;
pub(crate) mod contacts;
pub(crate) mod shadows;

use crate::Viewpoint;
use crate::annotation::plans::plans;
use crate::camera::Camera;
use crate::gpu::passes::decal::{DecalForm, DecalLayer, DecalVertex};
use crate::ground::floor::Floor;
use crate::ground::projection::{Eye, ProjectionTarget, project};
use crate::ground::simplify::thinned;
use crate::ground::trail::{RIBBON, Trail, free_places, set_points};
use crate::palette::{self, Rgb};
use crate::picture_context::PictureContext;
use glam::{DVec2, DVec3};
use vocabulary::{Body, Pose};

/// Half the width of the thinnest line, pixels: what is thinner falls between the middles of pixels and crumbles.
const LEAST: f64 = 1.0;
/// A line seen at a low angle is widened on the ground to this many times the width it has elsewhere, not more.
const WIDEST: f64 = 6.0;
/// Half the width of a ribbon, m.
const RIBBON_HALF: f64 = 0.03;
/// Radius of the ring at a set point, m.
pub(crate) const RING: f64 = 0.25;
/// How far to either side of a follower the line is drawn on which it shall be, m.
const ARC: f64 = 1.2;
/// Position errors above this are shown by an arrow, m.
const ARROW_ABOVE: f64 = 0.05;

/// Step for measuring the size of a pixel, m.
pub(crate) const STEP: f64 = 0.05;
/// Lines of quick pictures are this near to where they belong, pixels.
const UNSEEN: f64 = 0.4;

const RUBBER: Rgb = [0.05, 0.05, 0.055];

/// Collects corners; points are world coordinates on the ground.
pub(crate) struct DecalBuilder<'a> {
    pub(crate) corners: Vec<DecalVertex>,
    pub(crate) camera: &'a Camera,
    height: f64,
    /// Pixels of a line that is one wide at scale 1.
    pub(crate) stage_scale: f64,
    pub(crate) origin: DVec3,
    floor: &'a Floor,
    /// Whether lines may have fewer points.
    quick: bool,
}

/// All decals of one view on a tile `height` pixels high, layer by layer, in the order in which they are drawn.
pub(crate) fn build_decals(
    context: &PictureContext<'_>,
    view: &Viewpoint,
    camera: &Camera,
    height: f64,
) -> [(DecalLayer, Vec<DecalVertex>); 5] {
    let laid = |onto: ProjectionTarget, fill: &dyn Fn(&mut DecalBuilder<'_>)| {
        let mut builder = DecalBuilder::new(context, camera, height);
        fill(&mut builder);
        builder.laid(onto)
    };
    let painted = |fill: &dyn Fn(&mut DecalBuilder<'_>)| laid(ProjectionTarget::Floor, fill);
    let style = context.style;
    // Decks are shaded by themselves.
    let shadows = laid(ProjectionTarget::Ground, &|builder| {
        if style.shadows {
            builder.shadows(context);
        }
    });
    let mut feet = laid(ProjectionTarget::Ground, &|builder| builder.drivable_feet(context));
    feet.append(&mut painted(&|builder| {
        builder.feet(context);
        builder.dots(context);
    }));
    let mut over = painted(&|builder| {
        if style.set_points {
            builder.errors(context);
        }
    });
    if style.contacts {
        let mut flashes = DecalBuilder::new(context, camera, height);
        flashes.flashes(context);
        over.append(&mut flashes.corners);
    }
    let lines = painted(&|builder| builder.lines(context, view));
    let annotations = painted(&|builder| {
        if style.plans {
            builder.annotations(&plans(context), context.size);
        }
        builder.annotations(&style.annotations, context.size);
    });
    [
        (DecalLayer::Paint, lines),
        (DecalLayer::Annotations, annotations),
        (DecalLayer::Shadow, shadows),
        (DecalLayer::Paint, feet),
        (DecalLayer::Over, over),
    ]
}

/// Shadows and the dark at the foot of things alone, for any number of cameras on robots.
pub(crate) fn shade(context: &PictureContext<'_>, camera: &Camera) -> [(DecalLayer, Vec<DecalVertex>); 2] {
    let laid = |onto: ProjectionTarget, fill: &dyn Fn(&mut DecalBuilder<'_>)| {
        let mut builder = DecalBuilder::new(context, camera, 480.0);
        fill(&mut builder);
        project(builder.corners, context.floor, onto, context.origin, None)
    };
    let shadows = laid(ProjectionTarget::Ground, &|builder| builder.shadows(context));
    let mut feet = laid(ProjectionTarget::Ground, &|builder| builder.drivable_feet(context));
    feet.append(&mut laid(ProjectionTarget::Floor, &|builder| builder.feet(context)));
    [(DecalLayer::Shadow, shadows), (DecalLayer::Paint, feet)]
}

impl<'a> DecalBuilder<'a> {
    fn new(context: &PictureContext<'a>, camera: &'a Camera, height: f64) -> Self {
        Self {
            corners: Vec::new(),
            camera,
            height,
            // In a part of a picture that is small beside its words, lines are thin as well.
            stage_scale: context.style.scale * (height / (720.0 * context.style.scale)).clamp(0.6, 1.0),
            origin: context.origin,
            floor: context.floor,
            quick: context.style.interactive,
        }
    }
}

impl DecalBuilder<'_> {
    /// Paint, over which shadows fall.
    fn lines(&mut self, context: &PictureContext<'_>, view: &Viewpoint) {
        let style = context.style;
        if style.contacts {
            self.scuffs(context);
        }
        // In a crowd the marks of all would cover the road, and cost more than the robots.
        if style.marks && context.detail > 0.5 {
            self.marks(context);
        }
        if style.ribbons {
            self.ribbons(context);
        }
        if style.set_points {
            self.set_points(context);
        }
        // From close behind a robot the lines would cover the road.
        if style.edges && !matches!(view, Viewpoint::SnakeEye) {
            self.edges(context);
        }
        if style.barriers {
            self.barriers(context);
        }
    }

    /// The corners as they lie on the floor.
    fn laid(self, onto: ProjectionTarget) -> Vec<DecalVertex> {
        let slack = if self.quick { 3.0 } else { 1.0 };
        let eye = self.camera.perspective.then_some(Eye { at: self.camera.eye, slack });
        project(self.corners, self.floor, onto, self.origin, eye)
    }

    /// Size of a pixel at a point, m.
    pub(crate) fn pixel_at(&self, point: DVec3) -> f64 {
        self.camera.metres_per_pixel(point, self.height)
    }

    /// The point of the floor at a place.
    pub(crate) fn on(&self, place: DVec2) -> DVec3 {
        place.extend(self.floor.height(place))
    }

    /// Size of a pixel on the ground at a place, m.
    pub(crate) fn pixel(&self, place: DVec2) -> f64 {
        self.pixel_at(self.on(place))
    }

    pub(crate) fn corner(
        &self,
        at: DVec2,
        form: DecalForm,
        shape: [f32; 2],
        colour: Rgb,
        alpha: f32,
    ) -> DecalVertex {
        DecalVertex::new(at.extend(0.0) - self.origin, form, shape, palette::with_alpha(colour, alpha))
    }

    /// A disc around `middle`, or what is formed of one.
    pub(crate) fn disc(&mut self, middle: DVec2, radius: f64, form: DecalForm, colour: Rgb, alpha: f32) {
        self.patch(middle, DVec2::X * radius, DVec2::Y * radius, form, colour, alpha);
    }

    /// A parallelogram around `middle`.
    pub(crate) fn patch(
        &mut self,
        middle: DVec2,
        along: DVec2,
        across: DVec2,
        form: DecalForm,
        colour: Rgb,
        alpha: f32,
    ) {
        let at = |u: f32, v: f32| {
            let place = middle + along * f64::from(v) + across * f64::from(u);
            self.corner(place, form, [u, v], colour, alpha)
        };
        let quad = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
        self.corners.extend([0, 1, 2, 0, 2, 3].map(|k| quad[k]));
    }

    pub(crate) fn line(&mut self, from: DVec2, to: DVec2, width: f64, colour: Rgb, alpha: f32) {
        let along = 0.5 * (to - from);
        if along.length() < 1e-6 {
            return;
        }
        let middle = 0.5 * (from + to);
        let across = along.perp().normalize();
        let least = LEAST.max(1.1 * self.stage_scale);
        let half = (0.5 * width).max(least * self.pixel_across(middle, across));
        self.patch(middle, along, across * half, DecalForm::Solid, colour, alpha);
    }

    /// How far it is on the ground along `side`, which is across a line, from one side of a pixel to the other across the
    /// line in the picture, m: more where the line is foreshortened, up to a limit.
    pub(crate) fn pixel_across(&self, at: DVec2, side: DVec2) -> f64 {
        let pixel = self.pixel(at);
        // What is across a line on the ground is aslant in the picture: only its part across counts there.
        let (aside, ahead) = (self.apart(at, side), self.apart(at, -side.perp()));
        let pixels = |(aside, ahead): (DVec2, DVec2)| aside.perp_dot(ahead.normalize_or(DVec2::X)).abs();
        let across = aside.zip(ahead).map_or(pixel, |both| STEP / pixels(both).max(1e-9));
        across.clamp(pixel, WIDEST * pixel)
    }

    /// Where the end of a step of [`STEP`] along `direction` appears, from its start, pixels.
    pub(crate) fn apart(&self, place: DVec2, direction: DVec2) -> Option<DVec2> {
        let [a, b] = [place, place + direction * STEP].map(|p| self.camera.project(self.on(p)));
        let aspect = self.camera.half.x / self.camera.half.y;
        Some((b? - a?) * DVec2::new(aspect, 1.0) * (0.5 * self.height))
    }

    /// A band through `points`, each with its opacity; half its width is `half` m, but `least` pixels.
    fn band(&mut self, points: &[(DVec2, f32)], half: f64, least: f64, shift: f64, colour: Rgb) {
        // On hills they would be cut into the same pieces again.
        let few = (self.quick && self.floor.is_plane())
            .then(|| thinned(points, |place| UNSEEN * self.pixel(place)));
        let points = few.as_deref().unwrap_or(points);
        let side = |k: usize| {
            let (before, after) = (points[k.saturating_sub(1)].0, points[(k + 1).min(points.len() - 1)].0);
            (after - before).normalize_or(DVec2::X).perp()
        };
        // Wide enough to be seen from afar; what is thinner is drawn wider and fainter.
        let width = |k: usize, on: DVec3| {
            let pixel = self.pixel_at(on);
            let thin = half < LEAST * WIDEST * pixel;
            let across = if thin { self.pixel_across(points[k].0, side(k)) } else { pixel };
            let wanted = half.max(least * self.stage_scale * across);
            let drawn = wanted.max(LEAST * across);
            (drawn, (2.0 * wanted / drawn).min(1.0) as f32)
        };
        let uneven = !self.floor.is_plane();
        let mut added = Vec::with_capacity(6 * points.len());
        let mut before: Option<(DVec2, u8, (f64, f32))> = None;
        for (k, (place, _)) in points.iter().enumerate() {
            let on = self.on(*place);
            let drawn = width(k, on);
            let reach = shift.abs() + drawn.0;
            // On hills it may rise into the picture between two points.
            let step = before.map_or(0.0, |(from, ..)| if uneven { from.distance(*place) } else { 0.0 });
            let beyond = self.camera.beyond(on, reach + step);
            if let Some((.., other)) = before.filter(|(_, sides, _)| sides & beyond == 0) {
                let edge = |k: usize, (half, share): (f64, f32), u: f32| {
                    let place = points[k].0 + side(k) * (shift + half * f64::from(u));
                    self.corner(place, DecalForm::Solid, [u, 0.0], colour, share * points[k].1)
                };
                let quad = [
                    edge(k - 1, other, -1.0),
                    edge(k - 1, other, 1.0),
                    edge(k, drawn, 1.0),
                    edge(k, drawn, -1.0),
                ];
                added.extend([0, 1, 2, 0, 2, 3].map(|c| quad[c]));
            }
            before = Some((*place, beyond, drawn));
        }
        self.corners.extend(added);
    }

    fn marks(&mut self, context: &PictureContext<'_>) {
        let entries = &context.trail.marks.entries;
        for (robot, member) in context.fleet.robots.iter().enumerate() {
            let points: Vec<_> = entries
                .iter()
                .filter_map(|(_, rows)| rows.get(robot))
                .map(|mark| (flat(&mark.pose), 0.13 + 0.42 * mark.slide))
                .chain(context.record.snapshot.robots.get(robot).map(|r| (flat(&r.motion.pose), 0.13)))
                .collect();
            if points.len() > 1 {
                for side in [-0.5, 0.5] {
                    self.band(
                        &points,
                        0.013 / 0.045 * tyre(&member.body),
                        0.0,
                        side * member.body.track,
                        RUBBER,
                    );
                }
            }
        }
    }

    /// Dots under robots that are only a few pixels long, so that a crowd keeps its colours.
    fn dots(&mut self, context: &PictureContext<'_>) {
        let robots = context.record.snapshot.robots.iter().zip(&context.fleet.robots).zip(context.colours);
        for ((robot, member), colour) in robots {
            let middle = flat(&robot.motion.pose);
            let pixel = self.pixel(middle) * self.stage_scale;
            let alpha = ((26.0 - member.body.length / pixel) / 10.0).clamp(0.0, 0.95) as f32;
            if alpha > 0.0 {
                let colour = if member.leads { palette::GOLD } else { *colour };
                self.disc(middle, 6.5 * pixel, DecalForm::Ring(0.0), colour, alpha);
            }
        }
    }

    fn ribbons(&mut self, context: &PictureContext<'_>) {
        let now = context.record.snapshot.time;
        for (robot, state) in context.record.snapshot.robots.iter().enumerate() {
            let colour = context.colours[robot];
            let leads = context.fleet.robots[robot].leads;
            let mut points = ribbon(context.trail, robot, now);
            if state.is_present() {
                points.push((flat(&state.motion.pose), 0.9));
            }
            self.band(&points, RIBBON_HALF * context.size, 0.9, 0.0, colour);
            if leads {
                // Near-black alone would be lost on asphalt.
                self.band(&points, 0.009 * context.size, 0.35, 0.0, palette::GOLD);
            }
        }
    }

    fn set_points(&mut self, context: &PictureContext<'_>) {
        let goals = set_points(context.fleet, context.record);
        for (index, (edge, goal)) in context.fleet.edges.iter().zip(goals).enumerate() {
            let Some(goal) = goal.map(DVec2::from_array) else { continue };
            let colour = context.colours[edge.follower];
            if context.fleet.free(index) != [false; 2] {
                self.free_places(context, index, goal, colour);
                continue;
            }
            let reach = RING * context.size;
            self.disc(goal, reach, DecalForm::Ring(0.0), colour, 0.16 * context.detail);
            self.ring(goal, reach, colour, 0.35 + 0.6 * context.detail);
        }
    }

    /// The part near `goal` of all places that a set point allows of which a part is left free: an arc around the leader, or
    /// a ray from it.
    fn free_places(&mut self, context: &PictureContext<'_>, edge: usize, goal: DVec2, colour: Rgb) {
        let Some(places) = free_places(context.fleet, context.record, edge) else { return };
        let strength = (0.35 + 0.6 * context.detail) * 0.9;
        let reach = ARC * context.size;
        let fade = |place: DVec2| ((1.0 - place.distance(goal) / reach) / 0.4).clamp(0.0, 1.0) as f32;
        let places = places.into_iter().map(DVec2::from_array);
        let near: Vec<_> = places.map(|place| (place, strength * fade(place))).collect();
        for part in near.split(|(_, alpha)| *alpha <= 0.0).filter(|part| part.len() > 1) {
            self.band(part, 0.02 * context.size, 1.2, 0.0, colour);
        }
    }

    fn errors(&mut self, context: &PictureContext<'_>) {
        let goals = set_points(context.fleet, context.record);
        for (index, (edge, goal)) in context.fleet.edges.iter().zip(goals).enumerate() {
            let free = context.fleet.free(index) != [false; 2];
            let robot = context.record.snapshot.robots.get(edge.follower);
            let (Some(goal), Some(robot)) = (goal.map(DVec2::from_array), robot) else { continue };
            let from = flat(&robot.motion.pose);
            // Comes and goes gently, so that nothing flickers around the threshold.
            let strength = ((from.distance(goal) - ARROW_ABOVE * context.size) / (0.03 * context.size))
                .clamp(0.0, 1.0) as f32;
            if strength > 0.0 {
                let colour = context.colours[edge.follower];
                if !free {
                    self.ring(goal, RING * context.size, colour, 0.55 * strength * context.detail);
                }
                let alpha = strength * context.detail.max(0.3);
                let pixel = self.stage_scale * self.pixel(goal);
                // A dark rim tells it from a shell of the same colour.
                self.arrow([from, goal], context.size, 1.4 * pixel, palette::INK, 0.75 * alpha);
                self.arrow([from, goal], context.size, 0.0, colour, alpha);
            }
        }
    }

    fn ring(&mut self, middle: DVec2, reach: f64, colour: Rgb, alpha: f32) {
        let thin = (3.6 * self.pixel(middle)).max(0.096 * reach);
        let hole = (1.0 - thin / reach).clamp(0.0, 1.0) as f32;
        self.disc(middle, reach, DecalForm::Ring(hole), colour, alpha);
    }

    /// An arrow, larger by `rim` m on all sides.
    pub(crate) fn arrow(&mut self, [from, to]: [DVec2; 2], size: f64, rim: f64, colour: Rgb, alpha: f32) {
        let along = to - from;
        let ahead = along.normalize_or(DVec2::X);
        let across = ahead.perp();
        let head = (0.17 * size).min(0.6 * along.length());
        let foot = to - ahead * head;
        // From afar the rim would leave nothing of the colour.
        let pixel = self.stage_scale * self.pixel(to);
        let half = (0.018 * size).max(1.7 * pixel) + rim;
        let (start, end) = (from - ahead * rim, foot - ahead * rim);
        self.patch(0.5 * (start + end), 0.5 * (end - start), across * half, DecalForm::Solid, colour, alpha);
        let wide = 0.5 * head + 1.6 * rim;
        let tip = [to + ahead * (2.2 * rim), end + across * wide, end - across * wide];
        let corners = tip.map(|place| self.corner(place, DecalForm::Solid, [0.0; 2], colour, alpha));
        self.corners.extend(corners);
    }

    fn edges(&mut self, context: &PictureContext<'_>) {
        if context.detail <= 0.0 {
            return;
        }
        let at = |k: usize| context.record.snapshot.robots.get(k).map(|r| flat(&r.motion.pose));
        for (_, edge, _) in context.record.pairs(context.fleet) {
            if let (Some(leader), Some(follower)) = (at(edge.leader), at(edge.follower)) {
                self.line(leader, follower, 0.016, palette::PAPER, 0.92 * context.detail);
            }
        }
    }
}

/// Width of a tyre, m.
fn tyre(body: &Body) -> f64 {
    let radius = body.wheel_radius;
    // The default tyre leaves a mark of 26 mm.
    (radius / 0.045 * 0.045).min((body.width - body.track) / 0.04 * 0.045).max(0.2 * radius)
}

pub(crate) fn flat(pose: &Pose) -> DVec2 {
    DVec2::new(pose.x, pose.y)
}

/// Points of a ribbon with their opacity, from old to new, without the robot's own place.
fn ribbon(trail: &Trail, robot: usize, now: f64) -> Vec<(DVec2, f32)> {
    let alpha = |time: f64| {
        let age = ((now - time) / RIBBON).clamp(0.0, 1.0) as f32;
        // The last tenth fades away, so that the end is not a cut.
        (0.9 - 0.75 * age) * ((1.0 - age) / 0.1).min(1.0)
    };
    let row = |k: usize| {
        trail.ribbons.get(k).and_then(|row| row.poses.get(robot).map(|pose| (row.time, flat(pose))))
    };
    let mut points = Vec::with_capacity(trail.ribbons.len() + 1);
    for k in 0..trail.ribbons.len() {
        let Some((time, place)) = row(k) else { continue };
        if time > now {
            break;
        }
        points.push((place, alpha(time)));
    }
    points
}
