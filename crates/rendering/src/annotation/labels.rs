//! Words in the picture: caption, time, names, edges and coordinates, placed so that none covers another.

use crate::annotation::detections::camera_words;
use crate::annotation::text_shaper::{Block, Measure, TextShaper, line_height};
use crate::camera::Camera;
use crate::gpu::model::Build;
use crate::gpu::passes::overlay::Shapes;
use crate::gpu::passes::text::TextLine;
use crate::ground::decal_builder::RING;
use crate::ground::trail::set_points;
use crate::palette::{self, Rgb};
use crate::picture_context::PictureContext;
use crate::picture_plan::{Area, overlap};
use crate::{Viewpoint, camera::viewpoint::Tile};
use glam::{DVec2, DVec3, Vec2};
use vocabulary::math;
use vocabulary::{Condition, EntityId, RobotInfo, RobotState, SafetyState};

/// Distance of words from the picture's edge at scale 1, pixels.
pub(crate) const MARGIN: f32 = 24.0;

/// Collects lines of text and refuses what would overlap.
pub(crate) struct LabelPlacer<'a> {
    pub(crate) lines: Vec<TextLine>,
    pub(crate) shapes: Shapes,
    /// Where names, edges and coordinates were written.
    pub(crate) labels: Vec<Area>,
    taken: Vec<Area>,
    letters: &'a mut TextShaper,
    scale: f32,
}

/// Where one view is in the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window<'a> {
    pub(crate) camera: &'a Camera,
    pub(crate) tile: Tile,
}

impl Window<'_> {
    /// Where a world point appears in pixels of the whole picture; `None` outside the tile.
    pub(crate) fn pixel(&self, point: DVec3) -> Option<Vec2> {
        let seen = self.camera.project(point)?;
        if seen.x.abs() < 1.0 && seen.y.abs() < 1.0 { self.anywhere(point) } else { None }
    }

    /// Where a direction is seen, by its tangents to the right and up of straight ahead.
    pub(crate) fn direction(&self, right: f64, up: f64) -> Vec2 {
        let seen = (DVec2::new(right, up) - self.camera.shift) / self.camera.half;
        self.place(seen).as_vec2()
    }

    fn place(&self, seen: DVec2) -> DVec2 {
        let x = f64::from(self.tile.x) + (seen.x + 1.0) * 0.5 * f64::from(self.tile.width);
        let y = f64::from(self.tile.y) + (1.0 - seen.y) * 0.5 * f64::from(self.tile.height);
        DVec2::new(x, y)
    }

    /// The same, also beside the tile; `None` behind the eye.
    fn anywhere(&self, point: DVec3) -> Option<Vec2> {
        let seen = self.camera.project(point)?;
        Some(self.place(seen).as_vec2())
    }
}

impl<'a> LabelPlacer<'a> {
    pub(crate) fn new(letters: &'a mut TextShaper, scale: f64) -> Self {
        Self {
            lines: Vec::new(),
            shapes: Shapes::default(),
            labels: Vec::new(),
            taken: Vec::new(),
            letters,
            scale: scale as f32,
        }
    }

    /// Keeps words away from a rectangle.
    pub(crate) fn reserve(&mut self, area: Area) {
        self.taken.push(area);
    }

    /// A thin frame around a tile, from which words keep away.
    pub(crate) fn framed(&mut self, tile: Tile) {
        let [x, y, width, height] = tile.area();
        let thick = self.scaled(1.5);
        let [a, b] = [Vec2::new(x, y), Vec2::new(x + width, y + height)];
        let (c, d) = (Vec2::new(b.x, a.y), Vec2::new(a.x, b.y));
        for (from, to) in [(a, c), (c, b), (b, d), (d, a)] {
            self.shapes.line(from, to, thick, palette::with_alpha(palette::PAPER, 0.95));
        }
        self.reserve(tile.area());
    }

    pub(crate) fn scaled(&self, size: f32) -> f32 {
        size * self.scale
    }

    pub(crate) fn width(&mut self, text: &str, size: f32, bold: bool) -> f32 {
        self.measure(text, size, bold, None).width
    }

    pub(crate) fn measure(&mut self, text: &str, size: f32, bold: bool, block: Option<Block>) -> Measure {
        let size = self.scaled(size);
        self.letters.measure(text, size, bold, block)
    }

    /// Writes a line whose left end and middle are at `at`, whatever is there.
    pub(crate) fn write(&mut self, text: String, at: [f32; 2], size: f32, bold: bool, ink: Ink) {
        self.write_block(text, at, size, bold, ink, None);
    }

    /// Writes a text that may have several lines where it has a block; the middle of its first is at `at`.
    pub(crate) fn write_block(
        &mut self,
        text: String,
        at: [f32; 2],
        size: f32,
        bold: bool,
        ink: Ink,
        block: Option<Block>,
    ) {
        let size = self.scaled(size);
        let Ink { colour, alpha, halo } = ink;
        self.lines.push(TextLine { text, at, size, bold, block, colour, alpha, halo });
    }

    /// Writes a centred line at the first of `places` that is free and inside `within`.
    fn try_write(
        &mut self,
        text: &str,
        places: &[Vec2],
        size: f32,
        within: &Tile,
        bold: bool,
        ink: Ink,
    ) -> bool {
        let width = self.width(text, size, bold);
        let height = line_height(self.scaled(size));
        for place in places {
            let area = [place.x - 0.5 * width - 4.0, place.y - 0.5 * height, width + 8.0, height];
            if inside(&area, within) && !self.taken.iter().any(|other| overlap(&area, other)) {
                self.taken.push(area);
                self.labels.push(area);
                self.write(text.to_owned(), [place.x - 0.5 * width, place.y], size, bold, ink);
                return true;
            }
        }
        false
    }
}

/// Colour, opacity and halo of text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ink {
    pub(crate) colour: Rgb,
    pub(crate) alpha: f32,
    pub(crate) halo: (f32, Rgb),
}

impl Ink {
    pub(crate) const DARK: Self = Self { colour: palette::INK, alpha: 0.92, halo: (0.0, palette::PAPER) };
    pub(crate) const ON_PANEL: Self = Self { colour: palette::INK, alpha: 0.9, halo: (0.0, palette::PAPER) };
    pub(crate) const LIGHT: Self = Self { colour: palette::PAPER, alpha: 1.0, halo: (0.66, palette::INK) };

    pub(crate) const ALARM: Self = Self { colour: palette::ALARM, alpha: 1.0, halo: (0.8, palette::INK) };

    pub(crate) fn faded(self, alpha: f32) -> Self {
        Self { alpha: self.alpha * alpha, ..self }
    }
}

fn inside(area: &Area, tile: &Tile) -> bool {
    let [left, top] = [tile.x as f32, tile.y as f32];
    area[0] > left + 2.0
        && area[1] > top + 2.0
        && area[0] + area[2] < left + tile.width as f32 - 2.0
        && area[1] + area[3] < top + tile.height as f32 - 2.0
}

/// Names, edges, scale bar and coordinates of one view.
pub(crate) fn view_words(
    words: &mut LabelPlacer<'_>,
    context: &PictureContext<'_>,
    window: Window<'_>,
    view: &Viewpoint,
) {
    if let Viewpoint::Camera(robot) = view {
        return camera_words(words, context, window, *robot);
    }
    reserve_robots(words, context, window);
    if matches!(view, Viewpoint::Top) && context.style.grid {
        scale_bar(words, window);
    }
    if context.style.names {
        names(words, context, window);
    }
    if context.style.labels && context.detail > 0.0 && !matches!(view, Viewpoint::SnakeEye) {
        edges(words, context, window);
    }
    if context.style.grid {
        coordinates(words, context, window);
    }
}

/// The middle of a robot, and how many times as large as the default body it is.
fn middle(robot: &RobotState, member: &RobotInfo) -> (DVec3, f64) {
    let size = crate::gpu::model::size(&member.body);
    let [x, y] = robot.motion.pose.world_from_body(0.12 * size, 0.0);
    // Over its ground point, or under it where it lies on its roof.
    let upright = math::cos(robot.attitude.roll) * math::cos(robot.attitude.pitch);
    (DVec3::new(x, y, robot.attitude.height + 0.15 * size * upright), size)
}

fn reserve_robots(words: &mut LabelPlacer<'_>, context: &PictureContext<'_>, window: Window<'_>) {
    for (robot, member) in context.record.snapshot.robots.iter().zip(&context.fleet.robots) {
        let (middle, size) = middle(robot, member);
        if let Some(at) = window.pixel(middle) {
            let pixel = window.camera.metres_per_pixel(middle, f64::from(window.tile.height));
            let metre = (size / pixel) as f32;
            words.reserve([at.x - 0.20 * metre, at.y - 0.20 * metre, 0.40 * metre, 0.40 * metre]);
        }
    }
}

/// What keeps a robot from driving, in a word.
fn trouble(condition: Condition) -> Option<&'static str> {
    match condition {
        Condition::Able | Condition::Removed => None,
        Condition::Failed => Some("failed"),
        Condition::Overturned => Some("overturned"),
        Condition::Stuck => Some("stuck"),
        Condition::Fallen => Some("fallen"),
    }
}

/// A command that a filter moves by less than this shows nothing, m/s²: names that flicker cannot be read.
const HELD: f64 = 0.05;

/// What the filter of a robot did, where pictures show it.
fn filtered<'a>(context: &PictureContext<'a>, robot: usize) -> Option<&'a SafetyState> {
    let states = context.style.barriers.then_some(&context.record.safety)?;
    states.iter().find(|state| state.robot == robot)
}

/// What the filter of a robot keeps it off, by name.
fn held_by(context: &PictureContext<'_>, state: &SafetyState) -> Option<String> {
    if state.moved <= HELD {
        return None;
    }
    let acting = state.acting.iter().find(|constraint| !constraint.is_limit())?;
    if !acting.is_view() {
        return Some(format!("off {}", acting.name(context.fleet)));
    }
    let edge = context.fleet.edges.iter().find(|edge| edge.follower == state.robot)?;
    Some(format!("keeps {} in view", context.fleet.name(EntityId::Robot(edge.leader))))
}

fn names(words: &mut LabelPlacer<'_>, context: &PictureContext<'_>, window: Window<'_>) {
    let crowded = context.fleet.robots.len() > 24;
    // Who is in trouble is named first, while there is room.
    for alarming in [true, false] {
        for index in 0..context.fleet.robots.len().min(context.record.snapshot.robots.len()) {
            if !context.record.snapshot.robots[index].is_present() {
                continue;
            }
            let trouble = trouble_of(context, index);
            // In a crowd only those who are in trouble are named.
            if trouble.is_some() == alarming && (alarming || !crowded) {
                name(words, context, window, index, trouble);
            }
        }
    }
}

/// What keeps a robot from driving, or from doing anything that is safe, in words.
fn trouble_of(context: &PictureContext<'_>, index: usize) -> Option<String> {
    let condition = context.record.snapshot.robots[index].condition;
    let conflict = || filtered(context, index)?.conflict_words(context.fleet);
    trouble(condition).map(str::to_owned).or_else(conflict)
}

fn name(
    words: &mut LabelPlacer<'_>,
    context: &PictureContext<'_>,
    window: Window<'_>,
    index: usize,
    trouble: Option<String>,
) {
    let (robot, member) = (&context.record.snapshot.robots[index], &context.fleet.robots[index]);
    let (middle, size) = middle(robot, member);
    let Some(at) = window.pixel(middle) else { return };
    let alarming = trouble.is_some();
    let said = trouble.or_else(|| held_by(context, filtered(context, index)?));
    let ink = if alarming { Ink::ALARM } else { Ink::LIGHT.faded(context.detail.max(0.6)) };
    let pixel = window.camera.metres_per_pixel(middle, f64::from(window.tile.height));
    let metre = (size / pixel) as f32;
    let away = 0.27 * metre + words.scaled(9.0);
    // Where there is no room for all of it, the name alone.
    let whole = said.map(|said| format!("{} · {said}", member.name));
    for text in whole.into_iter().chain([member.name.clone()]) {
        let width = words.width(&text, 13.0, true);
        let side = 0.25 * metre + 0.5 * width + words.scaled(8.0);
        let near = [Vec2::new(0.0, -away), Vec2::new(0.0, away), Vec2::new(side, 0.0), Vec2::new(-side, 0.0)];
        // Trouble is told farther off, too, and to either side, rather than not at all.
        let lines: u8 = if alarming { 6 } else { 0 };
        let far = (0..3 * lines).flat_map(|k| {
            let (line, shift) = (f32::from(k / 3), [0.0, 0.5, -0.5][usize::from(k % 3)] * width);
            let off = away + line * words.scaled(17.0);
            [Vec2::new(shift, -off), Vec2::new(shift, off)]
        });
        let places: Vec<_> = near.into_iter().chain(far).map(|place| at + place).collect();
        if words.try_write(&text, &places, 13.0, &window.tile, true, ink) {
            return;
        }
    }
}

fn edges(words: &mut LabelPlacer<'_>, context: &PictureContext<'_>, window: Window<'_>) {
    let place = |k: usize| {
        let pose = context.record.snapshot.robots.get(k)?.motion.pose;
        window.pixel(context.on_floor(pose.x, pose.y))
    };
    for (_, edge, state) in context.record.pairs(context.fleet) {
        let (Some(a), Some(b)) = (place(edge.leader), place(edge.follower)) else { continue };
        // Against the heading that set points are written against.
        let degrees = vocabulary::wrap(state.relative.bearing + state.behind).to_degrees().round();
        let sign = if degrees < 0.0 { "\u{2212}" } else { "" };
        let place = format!("{:.2} m  {sign}{:.0}°", state.relative.distance, degrees.abs());
        // How far it has filed in.
        let filed = state.narrowing > 0.005;
        let text = if filed { format!("{place}  λ {:.2}", state.narrowing) } else { place };
        // Beside the middle, on the side away from the formation first.
        let across = (b - a).perp().normalize_or(Vec2::Y);
        let outward = if across.y < 0.0 { across } else { -across };
        let reach = 0.5 * words.width(&text, 13.0, false) * outward.x.abs() + words.scaled(13.0);
        let middle = (a + b) * 0.5;
        let near = (b - a) * 0.14;
        let places = [
            middle + outward * reach,
            middle - outward * reach,
            middle + near + outward * reach,
            middle - near + outward * reach,
            middle + near - outward * reach,
        ];
        let ink = Ink::LIGHT.faded(context.detail);
        words.try_write(&text, &places, 13.0, &window.tile, false, ink);
    }
}

/// A length that reads well, near to `wanted`.
fn round_length(wanted: f64) -> f64 {
    let power = math::powf(10.0_f64, math::log10(wanted).floor());
    [5.0, 2.0, 1.0].into_iter().map(|n| n * power).find(|n| *n <= wanted).unwrap_or(power)
}

fn scale_bar(words: &mut LabelPlacer<'_>, window: Window<'_>) {
    let tile = window.tile;
    let metre = 1.0 / window.camera.metres_per_pixel(DVec3::ZERO, f64::from(tile.height)) as f32;
    let length = round_length(0.22 * f64::from(tile.width) / f64::from(metre));
    let pixels = length as f32 * metre;
    let margin = words.scaled(MARGIN);
    let right = tile.x as f32 + tile.width as f32 - margin;
    let y = tile.y as f32 + margin + words.scaled(22.0);
    let (thick, tick) = (words.scaled(2.0), words.scaled(5.0));
    let colour = [1.0, 1.0, 1.0, 0.9];
    words.shapes.line(Vec2::new(right - pixels, y), Vec2::new(right, y), thick, colour);
    for x in [right - pixels, right] {
        words.shapes.line(Vec2::new(x, y - tick), Vec2::new(x, y + tick), thick, colour);
    }
    let text = if length < 1.0 { format!("{:.0} cm", length * 100.0) } else { format!("{length} m") };
    let half = words.scaled(11.0);
    words.reserve([right - pixels, y - 2.0 * half, pixels, 3.0 * half]);
    let width = words.width(&text, 13.0, false);
    words.write(text, [right - 0.5 * (pixels + width), y - half], 13.0, false, Ink::LIGHT);
}

/// The rectangle of the picture that holds each robot, mast and shell included.
pub(crate) fn robot_boxes(context: &PictureContext<'_>, window: Window<'_>) -> Vec<Area> {
    let robots = context.record.snapshot.robots.iter().zip(&context.fleet.robots);
    let area = |(robot, member): (&RobotState, &RobotInfo)| {
        let body = member.body;
        let (middle, reach) = (0.5 * body.wheelbase, 0.5 * body.length + 0.05);
        let side = 0.5 * body.width + 0.06;
        let half = 0.5 * Build::new(member).top();
        around((0..8).map(|k| {
            let sign = |bit: usize| if k & bit == 0 { -1.0 } else { 1.0 };
            let [x, y] = robot.motion.pose.world_from_body(middle + sign(1) * reach, sign(2) * side);
            window.anywhere(DVec3::new(x, y, robot.attitude.height + half + sign(4) * half))
        }))
    };
    robots.filter(|(robot, _)| robot.is_present()).filter_map(area).collect()
}

/// The rectangles of the picture that hold the rings at set points.
pub(crate) fn ring_boxes(context: &PictureContext<'_>, window: Window<'_>) -> Vec<Area> {
    let reach = RING * context.size;
    let ring = |[x, y]: [f64; 2]| {
        around((0..8).map(|k| {
            let (sin, cos) = math::sin_cos(std::f64::consts::FRAC_PI_4 * f64::from(k));
            window.anywhere(context.on_floor(x + reach * cos, y + reach * sin))
        }))
    };
    set_points(context.fleet, context.record).into_iter().flatten().filter_map(ring).collect()
}

/// The rectangle around points of the picture; `None` where one of them is behind the eye.
fn around(mut points: impl Iterator<Item = Option<Vec2>>) -> Option<Area> {
    let [low, high] = points.try_fold([Vec2::INFINITY, Vec2::NEG_INFINITY], |[low, high], point| {
        point.map(|point| [low.min(point), high.max(point)])
    })?;
    let size = high - low;
    size.is_finite().then_some([low.x, low.y, size.x, size.y])
}

/// Coordinates where the strong lines of the ground cross.
fn coordinates(words: &mut LabelPlacer<'_>, context: &PictureContext<'_>, window: Window<'_>) {
    let level = context.trail.smoothed.formation().ground[0];
    let Some(centre) = ground_ahead(window.camera, level) else { return };
    for area in robot_boxes(context, window) {
        // Words lie on the ground: none may stand in front of a robot.
        words.reserve(area);
    }
    let nearest = |x: f64| (x / 5.0).round() * 5.0;
    for i in -4_i32..=4 {
        for j in -4_i32..=4 {
            let (x, y) = (nearest(centre.x) + f64::from(i) * 5.0, nearest(centre.y) + f64::from(j) * 5.0);
            let point = context.on_floor(x, y);
            let pixel = window.camera.metres_per_pixel(point, f64::from(window.tile.height));
            // Fades before the crossings crowd together.
            let alpha = ((0.013 - pixel * context.style.scale) / 0.004).clamp(0.0, 1.0) as f32;
            if let (true, Some(at)) = (alpha > 0.02, window.pixel(point)) {
                let text = format!("{x:.0}, {y:.0}").replace('-', "\u{2212}");
                let half = 0.5 * words.width(&text, 11.0, false);
                let place = at + Vec2::new(half + words.scaled(7.0), -words.scaled(9.0));
                words.try_write(&text, &[place], 11.0, &window.tile, false, Ink::LIGHT.faded(0.8 * alpha));
            }
        }
    }
}

/// Where the lower middle of the picture meets level ground.
fn ground_ahead(camera: &Camera, level: f64) -> Option<DVec3> {
    if !camera.perspective {
        return Some(camera.eye);
    }
    let ray = camera.forward - camera.up * (0.3 * camera.half.y);
    (ray.z < -1e-3).then(|| camera.eye + ray * ((camera.eye.z - level) / -ray.z))
}

/// The detail of a formation of so many robots: all of it up to twelve, none from forty.
pub(crate) fn detail(robots: usize) -> f32 {
    ((40.0 - robots as f32) / 28.0).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet_model::FleetModel;
    use crate::{Style, Trail};
    use vocabulary::{Body, FleetInfo, Pose, Snapshot, StepRecord};

    #[test]
    fn a_robots_box_holds_all_of_it() {
        let member = RobotInfo::new("a", true, Body::default());
        let fleet = FleetInfo { robots: vec![member], ..FleetInfo::default() };
        let mut robot = RobotState::default();
        robot.motion.pose = Pose::new(1.0, 2.0, 0.0);
        let record = StepRecord {
            snapshot: Snapshot { robots: vec![robot], ..Snapshot::default() },
            ..StepRecord::default()
        };
        let (trail, style) = (Trail::new(&fleet), Style::default());
        let model = FleetModel::new(&fleet);
        let context = PictureContext::new(&model, &trail, &record, &style);
        let camera = Camera::looking(DVec3::new(-2.0, 2.0, 1.5), DVec3::new(1.0, 2.0, 0.0), 0.7, 1.0);
        let window = Window { camera: &camera, tile: Tile { x: 100, y: 0, width: 400, height: 400 } };
        let boxes = robot_boxes(&context, window);
        assert_eq!(boxes.len(), 1);
        let [left, top, width, height] = boxes[0];
        assert!(width > 20.0 && width < 150.0 && height > 20.0 && height < 150.0, "{:?}", boxes[0]);
        for (forward, side, up) in [(0.33, 0.12, 0.0), (-0.07, -0.12, 0.1), (0.13, 0.0, 0.33)] {
            let at = window.anywhere(DVec3::new(1.0 + forward, 2.0 + side, up)).unwrap();
            assert!(at.x > left && at.x < left + width && at.y > top && at.y < top + height, "{at}");
        }
    }
}
