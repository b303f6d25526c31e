//! How a body of given measures is put together from the models of the default one.

use super::{Mesh, shell, wheel};
use glam::Vec3;
use vocabulary::math;
use vocabulary::{Body, RobotInfo, Shell};

/// Measures of the model.
const HALF_HULL: f32 = 0.08;
const HULL_LOW: f32 = 0.034;
const BELT: f32 = 0.132;
const OVERHANG: f32 = 0.075;

/// Where the parts of a robot go; robots alike in all but their tags share one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Build {
    pub(crate) body: Body,
    /// Scale of the wheels' model: tall, wide, tall.
    pub(crate) wheel: Vec3,
    /// Where the camera's head turns, and its size.
    pub(crate) camera: Vec3,
    pub(crate) head: f32,
    /// Blank; none on robots that carry nothing.
    pub(super) shell: Option<Shell>,
    /// Whether the hull stands over its wheels instead of between arches.
    pub(super) high: bool,
}

impl Build {
    pub(crate) fn new(member: &RobotInfo) -> Self {
        let body = sane(&member.body);
        let radius = body.wheel_radius as f32;
        let tall = radius / wheel::RADIUS;
        // Tyres fill what the body is wider than its track.
        let wide = ((body.width - body.track) / 0.04) as f32;
        let shell = member.shell.filter(sound).map(|shell| Shell { first_tag: None, ..shell });
        let within = |x: f64| if x.is_finite() { x.clamp(-40.0, 40.0) as f32 } else { 0.0 };
        Self {
            body,
            wheel: Vec3::new(tall, wide.clamp(0.45 * tall, 1.7 * tall), tall),
            camera: Vec3::new(within(member.camera_mount.forward), 0.0, within(member.camera_mount.height)),
            head: shell::size(&shell.unwrap_or_else(|| Shell::fitting(&body))) as f32,
            shell,
            high: f64::from(radius) > 0.24 * body.height,
        }
    }

    /// The default body is drawn exactly as it was modelled.
    pub(super) fn standard(&self) -> bool {
        self.body == Body::default()
    }

    /// Whether the tyres are made for rough ground.
    pub(crate) fn lugs(&self) -> bool {
        self.high && self.wheel.y > 1.4 * self.wheel.x
    }

    /// Scale across of the arches.
    pub(super) fn arch(&self) -> f32 {
        if self.standard() { 1.0 } else { self.body.width as f32 / 0.24 }
    }

    /// Highest point over the ground, m.
    pub(crate) fn top(&self) -> f64 {
        let rim = |s: &Shell| s.height + 0.5 * s.face_height + 0.012 * shell::size(s);
        let shell = self.shell.as_ref().map_or(0.0, rim);
        f64::from(self.camera.z + 0.04 * self.head).max(self.body.height).max(shell)
    }

    /// Where the hubs of its wheels are: in front and at the rear, left before right.
    pub(crate) fn hubs(&self) -> [Vec3; 4] {
        let Body { wheelbase, track, wheel_radius, .. } = self.body;
        [(1.0, 0.5), (1.0, -0.5), (0.0, 0.5), (0.0, -0.5)].map(|(forward, left)| {
            Vec3::new((forward * wheelbase) as f32, (left * track) as f32, wheel_radius as f32)
        })
    }

    /// Opposite corners of a box that holds its meshes, its wheels however they steer and its camera wherever it looks, with
    /// some room for springs, in the frame of the body, m.
    pub(crate) fn bounds<'a>(&self, meshes: impl Iterator<Item = &'a Mesh>) -> [Vec3; 2] {
        let wheel = self.wheel.length() * wheel::RADIUS;
        let ball = |middle: Vec3, reach: f32| [middle - reach, middle + reach];
        let hubs = self.hubs().map(|hub| ball(hub, wheel));
        let parts = meshes.filter_map(Mesh::bounds).chain(hubs).chain([ball(self.camera, 0.04 * self.head)]);
        let [low, high] =
            parts.fold([Vec3::ZERO; 2], |[low, high], [from, to]| [low.min(from), high.max(to)]);
        let room = 0.04 * low.distance(high);
        [low - room, high + room]
    }

    /// Middle and radius of a ball that holds all of it, in the frame of the body, m.
    pub(crate) fn ball(&self) -> ([f64; 3], f64) {
        let half = 0.5 * self.top();
        let aside = math::hypot(self.around().max(0.8 * self.body.length), 0.5 * self.body.width);
        ([0.15 * self.body.length, 0.0, half], 1.1 * math::hypot(half, aside))
    }

    /// How far the outline reaches around a point 0.15 of the length ahead of the reference point, m.
    pub(crate) fn around(&self) -> f64 {
        let off = |forward: f64| (forward - 0.15 * self.body.length).abs();
        let shell = self.shell.map_or(0.0, |s| 0.21 * shell::size(&s) + off(s.forward));
        let camera = off(f64::from(self.camera.x)) + 0.04 * f64::from(self.head);
        (0.62 * self.body.length).max(shell).max(camera)
    }

    /// Moves what was modelled for the default hull to where it is on this one.
    pub(super) fn fit(&self, mesh: &mut Mesh) {
        if self.standard() {
            return;
        }
        for vertex in &mut mesh.vertices {
            vertex.position = self.place(Vec3::from_array(vertex.position)).to_array();
        }
        mesh.face();
    }

    fn place(&self, p: Vec3) -> Vec3 {
        let body = self.body;
        let [wheelbase, overhang] = [body.wheelbase, 0.5 * (body.length - body.wheelbase)].map(|x| x as f32);
        let x = if p.x < 0.0 {
            p.x * overhang / OVERHANG
        } else if p.x > 0.27 {
            wheelbase + (p.x - 0.27) * overhang / OVERHANG
        } else {
            p.x * wheelbase / 0.27
        };
        let z = self.rise(p.z);
        Vec3::new(x, p.y * self.spread(z), z)
    }

    fn rise(&self, z: f32) -> f32 {
        let (radius, height, roof) = (self.body.wheel_radius as f32, self.body.height as f32, 0.216);
        let knots = if self.high {
            let top = 2.0 * radius + 0.15 * radius;
            [
                [HULL_LOW, 1.2 * radius],
                [BELT, (top + 0.35 * (height - top)).max(1.6 * radius)],
                [roof, height],
            ]
        } else {
            [[0.0, 0.0], [wheel::RADIUS, radius], [roof, height]]
        };
        let [a, b, c] = knots;
        let [from, to] = if z < b[0] { [a, b] } else { [b, c] };
        from[1] + (z - from[0]) * (to[1] - from[1]) / (to[0] - from[0])
    }

    /// Scale across: between big wheels there is less room than above them.
    fn spread(&self, z: f32) -> f32 {
        let width = self.body.width as f32 / 0.24;
        if !self.high {
            return width;
        }
        let tyre = self.wheel.y * 0.018;
        let room = (0.5 * self.body.track as f32 - 1.45 * tyre).max(0.2 * self.body.width as f32);
        let (narrow, wide) = (room / HALF_HULL, 0.30 * self.body.width as f32 / HALF_HULL);
        let diameter = 2.0 * self.body.wheel_radius as f32;
        let share = ((z - 0.85 * diameter) / (0.35 * diameter)).clamp(0.0, 1.0);
        narrow + (wide.max(narrow) - narrow) * share
    }
}

/// How many times as large as the default body one appears.
pub(crate) fn size(body: &Body) -> f64 {
    let model = Body::default();
    (body.length / model.length).max(body.width / model.width * 0.7).max(body.height / model.height * 0.7)
}

/// Whether a shell can be modelled.
fn sound(shell: &Shell) -> bool {
    let sizes = [shell.apothem, shell.face_height, shell.cell];
    let places = [shell.forward, shell.height];
    sizes.iter().all(|x| (1e-4..=40.0).contains(x))
        && places.iter().all(|x| x.abs() <= 40.0)
        && shell.lean.abs() < 1.2
        && shell.apothem > shell.face_height * math::tan(shell.lean).abs()
}

/// Measures that a model can be made of, whatever was asked for.
fn sane(body: &Body) -> Body {
    let within = |x: f64, other: f64| if x.is_finite() { x.clamp(0.02, 40.0) } else { other };
    let model = Body::default();
    let length = within(body.length, model.length);
    Body {
        length,
        width: within(body.width, model.width),
        height: within(body.height, model.height),
        wheelbase: within(body.wheelbase, model.wheelbase).min(0.98 * length),
        track: within(body.track, model.track),
        wheel_radius: within(body.wheel_radius, model.wheel_radius),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_body_is_as_modelled() {
        let build = Build::new(&RobotInfo::new("a", true, Body::default()));
        assert_eq!(build.wheel, Vec3::ONE);
        assert!(build.camera.distance(Vec3::new(0.105, 0.0, 0.30)) < 1e-6 && build.head == 1.0);
        assert!((build.top() - 0.34).abs() < 1e-6 && (size(&build.body) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn hulls_fill_their_measures_and_leave_room_for_the_wheels() {
        let truck = Body {
            length: 0.49,
            width: 0.39,
            height: 0.32,
            wheelbase: 0.30,
            track: 0.285,
            wheel_radius: 0.0825,
        };
        let car =
            Body { length: 4.5, width: 1.8, height: 1.45, wheelbase: 2.7, track: 1.55, wheel_radius: 0.32 };
        for body in [truck, car] {
            let build = Build::new(&RobotInfo::new("a", true, body));
            let mesh = super::super::ghost(&Build { shell: None, ..build });
            let most = |k: usize| mesh.vertices.iter().map(|v| v.position[k]).fold(f32::MIN, f32::max);
            assert!((most(2) - body.height as f32).abs() < 0.02 * body.height as f32, "{}", most(2));
            assert!(most(1) < 0.5 * body.width as f32);
            let front = 0.5 * (body.wheelbase + body.length) as f32;
            assert!((most(0) - front).abs() < 0.15 * body.length as f32, "{} {front}", most(0));
            let inner = (0.5 * body.track) as f32 - 0.018 * build.wheel.y;
            for vertex in mesh.vertices.iter().filter(|v| v.position[2] < body.wheel_radius as f32 * 1.5) {
                assert!(vertex.position[1].abs() < inner, "{vertex:?}");
            }
        }
        let (truck, car) =
            (Build::new(&RobotInfo::new("a", true, truck)), Build::new(&RobotInfo::new("a", true, car)));
        assert!(truck.head == 1.0 && truck.high && car.head == 4.0 && !car.high);
        assert!((0.036 * truck.wheel.y - 0.1).abs() < 0.01);
    }
}
