//! From where a picture is taken, and how several such views share it.

use crate::Error;
use crate::error::nearest;
use glam::DVec2;
use std::f64::consts::FRAC_PI_2;
use vocabulary::math;

/// Where a view is seen from.
#[derive(Debug, Clone, PartialEq)]
pub enum Viewpoint {
    /// Behind and above the formation, along the lead robot's smoothed heading.
    Snake,
    /// Just above the ground behind the last robot.
    SnakeEye,
    /// Straight down, x to the right, without perspective.
    Top,
    /// Slowly around the formation.
    Orbit,
    /// Close behind one robot, by its index.
    Follow(usize),
    /// Through the camera of one robot, by its index.
    Camera(usize),
    /// From a fixed place.
    Fixed {
        /// Where the eye is, m, world frame.
        eye: [f64; 3],
        /// What it looks at, m, world frame.
        target: [f64; 3],
        /// Vertical field of view, rad.
        field_of_view: f64,
    },
    /// On the way from one view to another, at a share of it from 0 to 1; neither is through a camera on a robot.
    Between(Box<Viewpoint>, Box<Viewpoint>, f64),
}

/// A camera that the user moves: it looks at a target from a distance and never rolls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeCamera {
    /// What it looks at, m, world frame.
    pub target: [f64; 3],
    /// Heading, rad from x towards y.
    pub heading: f64,
    /// Pitch, rad: downwards is positive, π/2 is straight down.
    pub pitch: f64,
    /// From the eye to the target, m.
    pub distance: f64,
    /// Vertical field of view, rad.
    pub field_of_view: f64,
}

impl FreeCamera {
    /// A field of view that suits most, rad.
    pub const FIELD_OF_VIEW: f64 = 0.66;
    /// Limits of the pitch, rad: from nearly level to straight down.
    pub const PITCHES: [f64; 2] = [0.05, FRAC_PI_2];
    /// Limits of the distance, m: from farther away the robots would not be visible.
    pub const DISTANCES: [f64; 2] = [0.3, 400.0];

    /// The view through it. Where the floor is in the way, the eye is drawn above it.
    pub fn view(&self) -> Viewpoint {
        // Not quite straight down, where the heading would be undefined.
        let pitch = self.pitch.clamp(1e-6 - FRAC_PI_2, FRAC_PI_2 - 1e-6);
        let away = [
            math::cos(self.heading) * math::cos(pitch),
            math::sin(self.heading) * math::cos(pitch),
            -math::sin(pitch),
        ];
        Viewpoint::Fixed {
            eye: std::array::from_fn(|k| self.target[k] - self.distance * away[k]),
            target: self.target,
            field_of_view: self.field_of_view,
        }
    }

    /// Turned by these angles, rad, within [`Self::PITCHES`].
    #[must_use]
    pub fn turned(self, heading: f64, pitch: f64) -> Self {
        let [low, high] = Self::PITCHES;
        Self { heading: self.heading + heading, pitch: (self.pitch + pitch).clamp(low, high), ..self }
    }

    /// Moved nearer or farther by a factor, within [`Self::DISTANCES`]; `about` (m, world frame) stays where it appears.
    #[must_use]
    pub fn zoomed(self, factor: f64, about: Option<[f64; 3]>) -> Self {
        let [low, high] = Self::DISTANCES;
        let distance = (self.distance * factor).clamp(low, high);
        let share = distance / self.distance;
        let about = about.unwrap_or(self.target);
        let target = std::array::from_fn(|k| about[k] + (self.target[k] - about[k]) * share);
        Self { target, distance, ..self }
    }
}

const PLAIN: [&str; 5] = ["snake", "snake-eye", "top", "orbit", "fixed"];

impl Viewpoint {
    /// The view called `text` of a scene whose robots are called `names`: `snake`, `snake-eye`, `top`, `orbit`,
    /// `follow:NAME`, `camera:NAME`, `fixed` or `fixed:ex,ey,ez,tx,ty,tz[,degrees]`.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the valid forms and the nearest of them, [`Error::FixedView`] for numbers that give no camera.
    pub fn parse(text: &str, names: &[String]) -> Result<Self, Error> {
        let text = text.trim();
        if let Some(numbers) = text.strip_prefix("fixed:") {
            return fixed(numbers).map_err(|fault| Error::FixedView {
                given: text.to_owned(),
                fault,
                degrees: FIELDS_OF_VIEW,
            });
        }
        let view = match text {
            "snake" => Some(Self::Snake),
            "snake-eye" => Some(Self::SnakeEye),
            "top" => Some(Self::Top),
            "orbit" => Some(Self::Orbit),
            "fixed" => Some(Self::Fixed { eye: [-8.0, -8.0, 6.0], target: [0.0; 3], field_of_view: 0.7 }),
            _ => {
                let named = |kind: &str| {
                    let name = text.strip_prefix(kind)?.trim();
                    names.iter().position(|n| n == name)
                };
                named("follow:").map(Self::Follow).or(named("camera:").map(Self::Camera))
            }
        };
        view.ok_or_else(|| unknown(text, names))
    }
}

/// Smallest and largest vertical field of view of `fixed:`, degrees.
const FIELDS_OF_VIEW: [f64; 2] = [5.0, 120.0];

/// The view of `fixed:` with some numbers; else what is wrong with them.
fn fixed(numbers: &str) -> Result<Viewpoint, String> {
    const NAMES: [&str; 7] = ["ex", "ey", "ez", "tx", "ty", "tz", "degrees"];
    let words: Vec<&str> = numbers.split(',').map(str::trim).collect();
    let mut n = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 40.0];
    if !(6..=NAMES.len()).contains(&words.len()) {
        return Err(format!("it takes 6 or 7 numbers, not {}", words.len()));
    }
    for ((name, word), value) in NAMES.iter().zip(words).zip(&mut n) {
        let number = word.parse().ok().filter(|x: &f64| x.is_finite());
        *value = number.ok_or_else(|| format!("`{name}` is no number: {word:?}"))?;
    }
    let [ex, ey, ez, tx, ty, tz, degrees] = n;
    let [least, most] = FIELDS_OF_VIEW;
    if !(least..=most).contains(&degrees) {
        return Err(format!("`degrees` is {degrees}"));
    }
    let (eye, target) = ([ex, ey, ez], [tx, ty, tz]);
    if eye.iter().zip(target).all(|(a, b)| (a - b).abs() <= 1e-6) {
        return Err("eye and target are in the same place".to_owned());
    }
    Ok(Viewpoint::Fixed { eye, target, field_of_view: degrees.to_radians() })
}

fn unknown(given: &str, names: &[String]) -> Error {
    let bound = |kind: &str| names.iter().map(|n| format!("{kind}:{n}")).collect::<Vec<_>>();
    let (follow, camera) = (bound("follow"), bound("camera"));
    let both = || follow.iter().chain(&camera).map(String::as_str);
    let valid = PLAIN.iter().copied().chain(both());
    let few = |all: &[String]| {
        let more = if all.len() > 6 { ", …" } else { "" };
        format!("{}{more}", all[..all.len().min(6)].join(", "))
    };
    Error::Unknown {
        what: "view",
        given: given.to_owned(),
        nearest: nearest(given, valid),
        valid: format!(
            "{}:ex,ey,ez,tx,ty,tz[,degrees], {}, {}, and several joined by '+'",
            PLAIN.join(", "),
            few(&follow),
            few(&camera)
        ),
    }
}

/// One to four views in one picture.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewLayout {
    /// From left to right, then down.
    pub views: Vec<Viewpoint>,
}

/// A rectangle of pixels of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tile {
    /// Left edge.
    pub x: u32,
    /// Top edge.
    pub y: u32,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}

impl Tile {
    /// Left, top, width and height, pixels.
    pub(crate) fn area(&self) -> [f32; 4] {
        [self.x, self.y, self.width, self.height].map(|n| n as f32)
    }

    /// The whole pixels of a part of it, given by its lower left and its upper right, each −1 to 1 across and up, with one
    /// more on all sides; `None` where it has none.
    pub(crate) fn part(&self, [low, high]: [DVec2; 2]) -> Option<Self> {
        let span = |from: f64, to: f64, size: u32| {
            let pixel = |share: f64| (0.5 + 0.5 * share) * f64::from(size);
            let first = (pixel(from).floor() - 1.0).clamp(0.0, f64::from(size)) as u32;
            let end = (pixel(to).ceil() + 1.0).clamp(0.0, f64::from(size)) as u32;
            (end > first).then(|| (first, end - first))
        };
        let (left, width) = span(low.x, high.x, self.width)?;
        let (top, height) = span(-high.y, -low.y, self.height)?;
        Some(Self { x: self.x + left, y: self.y + top, width, height })
    }
}

impl ViewLayout {
    /// A single view.
    pub fn single(view: Viewpoint) -> Self {
        Self { views: vec![view] }
    }

    /// Views joined by '+', at most four.
    ///
    /// # Errors
    /// [`Error::Unknown`] for the first that is unknown, [`Error::TooManyViews`] for more than four.
    pub fn parse(text: &str, names: &[String]) -> Result<Self, Error> {
        let views =
            text.split('+').map(|part| Viewpoint::parse(part, names)).collect::<Result<Vec<_>, _>>()?;
        if views.len() > 4 {
            return Err(Error::TooManyViews(views.len()));
        }
        Ok(Self { views })
    }

    /// The tile of each view in a picture of `width` by `height`: side by side for two, or one above the other where it is
    /// higher than wide; else two by two.
    pub fn tiles(&self, width: u32, height: u32) -> Vec<Tile> {
        let upright = self.views.len() == 2 && height > width;
        let columns = if self.views.len() > 1 && !upright { 2 } else { 1 };
        let rows = if self.views.len() > 2 || upright { 2 } else { 1 };
        let cut = |k: u32, parts: u32, whole: u32| k * whole / parts;
        let tile = |k: u32| {
            // The third of three takes the whole lower row.
            let wide = self.views.len() == 3 && k == 2;
            let (column, row) = (k % columns, k / columns);
            let x = cut(column, columns, width);
            let right = if wide { width } else { cut(column + 1, columns, width) };
            let y = cut(row, rows, height);
            Tile { x, y, width: right - x, height: cut(row + 1, rows, height) - y }
        };
        (0..self.views.len() as u32).map(tile).collect()
    }
}

/// Where a small picture `aspect` times as wide as high lies in the upper right corner of a tile.
pub(crate) fn corner(tile: &Tile, aspect: f64, margin: f64) -> Tile {
    let width = (0.30 * f64::from(tile.width)).max(16.0);
    let height = (width / aspect).min(0.6 * f64::from(tile.height)).max(16.0);
    let width = (height * aspect).min(f64::from(tile.width));
    let margin = margin.min(0.1 * f64::from(tile.width.min(tile.height)));
    let [width, height, margin] = [width, height, margin].map(|x| x.round() as u32);
    let width = width.min(tile.width - margin);
    Tile {
        x: tile.x + tile.width - margin - width,
        y: tile.y + margin,
        width,
        height: height.min(tile.height - margin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_tile_has_the_pixels_that_it_touches_and_one_more() {
        let tile = Tile { x: 100, y: 50, width: 200, height: 100 };
        let part = |low: [f64; 2], high: [f64; 2]| tile.part([low.into(), high.into()]);
        let some = |x, y, width, height| Some(Tile { x, y, width, height });
        assert_eq!(part([-0.5, -0.2], [0.0, 0.6]), some(149, 69, 52, 42));
        assert_eq!(part([-3.0, -9.0], [9.0, 2.0]), Some(tile));
        assert_eq!(part([1.5, 0.0], [1.7, 0.1]), None);
        assert_eq!(part([0.0, -1.7], [0.1, -1.3]), None);
    }

    #[test]
    fn views_are_found_by_name() {
        let names = ["leader".to_owned(), "follower-1".to_owned()];
        assert_eq!(Viewpoint::parse("follow:follower-1", &names).ok(), Some(Viewpoint::Follow(1)));
        assert_eq!(
            ViewLayout::parse("snake+top", &names).ok().map(|l| l.views),
            Some(vec![Viewpoint::Snake, Viewpoint::Top])
        );
        assert!(matches!(Viewpoint::parse("fixed:0,-5,3,0,0,0", &names), Ok(Viewpoint::Fixed { .. })));
        assert_eq!(Viewpoint::parse("camera:leader", &names).ok(), Some(Viewpoint::Camera(0)));
        let error = Viewpoint::parse("camera:nobody", &names).unwrap_err().to_string();
        assert!(error.contains("camera:follower-1"), "{error}");
    }

    #[test]
    fn a_fixed_view_says_which_number_is_wrong() {
        for (numbers, fault) in [
            ("0,0,0,0,0,0", "same place"),
            ("1,2,3", "6 or 7 numbers, not 3"),
            ("1,2,3,4,5,6,7,8", "6 or 7 numbers, not 8"),
            ("1,2,3,4,five,6", "`ty` is no number: \"five\""),
            ("1,2,inf,4,5,6", "`ez` is no number: \"inf\""),
            ("1,2,3,4,5,", "`tz` is no number: \"\""),
            ("1,2,3,4,5,6,150", "`degrees` is 150"),
        ] {
            let error = Viewpoint::parse(&format!("fixed:{numbers}"), &[]).unwrap_err();
            let text = error.to_string();
            assert!(error.is_usage() && text.contains(fault), "{text}");
            assert!(text.contains("ex,ey,ez,tx,ty,tz") && text.contains("5 to 120 degrees"), "{text}");
        }
        let with_field = Viewpoint::parse("fixed: 0, -5, 3, 0, 0, 0, 60", &[]);
        assert!(
            matches!(with_field, Ok(Viewpoint::Fixed { field_of_view, .. }) if field_of_view == 60_f64.to_radians())
        );
    }

    #[test]
    fn an_unknown_view_names_the_nearest() {
        let error = Viewpoint::parse("snaek", &["leader".to_owned()]).unwrap_err();
        assert!(error.is_usage());
        let text = error.to_string();
        assert!(text.contains("did you mean \"snake\"") && text.contains("follow:leader"), "{text}");
    }

    #[test]
    fn a_free_camera_zooms_about_a_place_and_keeps_its_heading() {
        let camera = FreeCamera {
            target: [1.0, 2.0, 0.0],
            heading: 2.0,
            pitch: 0.5,
            distance: 10.0,
            field_of_view: FreeCamera::FIELD_OF_VIEW,
        };
        let near = camera.zoomed(0.5, Some([3.0, 2.0, 0.0]));
        assert!(near.distance == 5.0 && near.target == [2.0, 2.0, 0.0]);
        assert!(camera.zoomed(1e-9, None).distance == 0.3 && camera.zoomed(1e9, None).distance == 400.0);
        let down = camera.turned(0.1, 9.0);
        let Viewpoint::Fixed { eye, target, .. } = down.view() else { panic!("no place") };
        assert!((eye[2] - 10.0).abs() < 1e-9);
        assert!((math::atan2(target[1] - eye[1], target[0] - eye[0]) - 2.1).abs() < 1e-6);
    }

    #[test]
    fn two_views_lie_above_each_other_in_a_high_picture() {
        let layout = ViewLayout { views: vec![Viewpoint::Snake, Viewpoint::Top] };
        let places = |w, h| layout.tiles(w, h).iter().map(|t| [t.x, t.y]).collect::<Vec<_>>();
        assert_eq!(places(1280, 720), [[0, 0], [640, 0]]);
        assert_eq!(places(720, 1280), [[0, 0], [0, 640]]);
    }

    #[test]
    fn tiles_cover_the_picture() {
        for count in 1..=4 {
            let layout = ViewLayout { views: vec![Viewpoint::Top; count] };
            let area: u32 = layout.tiles(1281, 721).iter().map(|t| t.width * t.height).sum();
            assert_eq!(area, 1281 * 721);
        }
    }
}
