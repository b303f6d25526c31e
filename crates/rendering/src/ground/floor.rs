//! The floor: the plane or the terrain, and the tops of the fixed ramps and platforms on it.

use crate::gpu::props::turn;
use glam::{DQuat, DVec2, DVec3};
use std::sync::Arc;
use vocabulary::{FleetInfo, Mobility, Prop, Solid, Terrain};

/// A block narrower than this is a wall or a kerb, m.
const LEAST_WIDTH: f64 = 1.0;
/// A block whose top is higher than this over the ground is an obstacle, m.
const MOST_HEIGHT: f64 = 1.0;

/// The ground of a fleet with its decks.
#[derive(Debug, Clone, Default)]
pub(crate) struct Floor {
    pub(crate) terrain: Option<Arc<Terrain>>,
    pub(crate) drivables: Vec<DrivableSurface>,
    /// Lowest and highest of it, m.
    pub(crate) range: [f64; 2],
}

/// The top of a prop that robots can drive on.
#[derive(Debug, Clone)]
pub(crate) struct DrivableSurface {
    /// The index of its prop in the fleet.
    pub(crate) prop: usize,
    /// Outline from above, counter-clockwise.
    outline: [DVec2; 4],
    low: DVec2,
    high: DVec2,
    /// A point of its plane, and out of it.
    point: DVec3,
    normal: DVec3,
    solid: Solid,
    turn: DQuat,
}

impl Floor {
    pub(crate) fn new(fleet: &FleetInfo) -> Self {
        let mut floor = Self { terrain: fleet.terrain.clone(), ..Self::default() };
        let drivables =
            fleet.props.iter().enumerate().filter_map(|(k, prop)| DrivableSurface::new(k, prop, &floor));
        floor.drivables = drivables.collect();
        let ground = floor.terrain.iter().flat_map(|terrain| terrain.heights.iter().copied());
        let tops =
            floor.drivables.iter().flat_map(|drivable| drivable.outline.map(|place| drivable.height(place)));
        let wider = |[low, high]: [f64; 2], z: f64| [low.min(z), high.max(z)];
        floor.range = ground.chain(tops).filter(|z| z.is_finite()).fold([0.0; 2], wider);
        floor
    }

    /// Whether it is nothing but the plane z = 0.
    pub(crate) fn is_plane(&self) -> bool {
        self.terrain.is_none() && self.drivables.is_empty()
    }

    /// What is smaller than this is not told apart, m.
    pub(crate) fn grain(&self) -> f64 {
        let cell = self.terrain.as_ref().map_or(0.4, |terrain| terrain.cell);
        0.25 * cell.clamp(0.02, 0.4)
    }

    /// Height of the ground itself, m.
    pub(crate) fn ground(&self, place: DVec2) -> f64 {
        self.terrain.as_ref().map_or(0.0, |terrain| terrain.at(place.x, place.y).height)
    }

    /// Height of what a robot at a place would stand on, m.
    pub(crate) fn height(&self, place: DVec2) -> f64 {
        let drivables = self.drivables.iter().filter(|drivable| drivable.holds(place));
        drivables.map(|drivable| drivable.height(place)).fold(self.ground(place), f64::max)
    }

    /// That height and the normal there.
    pub(crate) fn surface(&self, place: DVec2) -> (f64, DVec3) {
        let ground = self.terrain.as_ref().map_or((0.0, DVec3::Z), |terrain| {
            let surface = terrain.at(place.x, place.y);
            (surface.height, DVec3::from_array(surface.normal))
        });
        let drivables = self.drivables.iter().filter(|drivable| drivable.holds(place));
        drivables.fold(ground, |best, drivable| {
            let height = drivable.height(place);
            if height > best.0 { (height, drivable.normal) } else { best }
        })
    }

    /// The deck of a prop, by the prop's index; `None` if it is not a deck.
    pub(crate) fn is_drivable(&self, prop: usize) -> bool {
        self.drivables.binary_search_by_key(&prop, |drivable| drivable.prop).is_ok()
    }
}

impl DrivableSurface {
    fn new(index: usize, prop: &Prop, floor: &Floor) -> Option<Self> {
        let (size, rise) = match prop.solid {
            Solid::Wedge { size } => (size, 0.0),
            Solid::Block { size } => (size, size[2]),
            Solid::Cylinder { .. } | Solid::Cone { .. } => return None,
        };
        let foot = DVec3::from_array(prop.placement.position);
        let turn = turn(&prop.placement);
        if prop.mobility != Mobility::Fixed || !foot.is_finite() || !turn.is_finite() {
            return None;
        }
        let [length, width, height] = size;
        let corners = [(-0.5, -0.5, rise), (0.5, -0.5, height), (0.5, 0.5, height), (-0.5, 0.5, rise)]
            .map(|(x, y, z)| foot + turn * DVec3::new(x * length, y * width, z));
        let point = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
        let low = length.min(width) >= LEAST_WIDTH && point.z - floor.ground(point.truncate()) < MOST_HEIGHT;
        let broad = low || !matches!(prop.solid, Solid::Block { .. });
        let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalize_or_zero();
        let outline = corners.map(DVec3::truncate);
        let low = outline.into_iter().fold(DVec2::INFINITY, DVec2::min);
        let high = outline.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        // A prop on its side or upside down is no deck.
        let lies = normal.z > 0.5;
        (broad && lies).then_some(Self {
            prop: index,
            outline,
            low,
            high,
            point,
            normal,
            solid: prop.solid,
            turn,
        })
    }

    /// Whether it may reach into a rectangle.
    pub(crate) fn near(&self, low: DVec2, high: DVec2) -> bool {
        low.cmplt(self.high).all() && high.cmpgt(self.low).all()
    }

    /// Its sides: a point of each, and across it inwards.
    pub(crate) fn sides(&self) -> [(DVec2, DVec2); 4] {
        std::array::from_fn(|k| (self.outline[k], (self.outline[(k + 1) % 4] - self.outline[k]).perp()))
    }

    fn holds(&self, place: DVec2) -> bool {
        self.near(place, place) && self.sides().iter().all(|(at, inward)| (place - *at).dot(*inward) >= 0.0)
    }

    /// Height of its plane at a place, m.
    pub(crate) fn height(&self, place: DVec2) -> f64 {
        self.point.z - (place - self.point.truncate()).dot(self.normal.truncate()) / self.normal.z
    }

    /// Whether its prop stands between an eye and a point.
    pub(crate) fn hides(&self, eye: DVec3, point: DVec3) -> bool {
        let [length, width, height] = self.solid.extent();
        let back = self.turn.inverse();
        // The middle of the foot in the frame of the prop is the origin; the middle of the top is above it.
        let rise = if matches!(self.solid, Solid::Wedge { .. }) { 0.5 * height } else { height };
        let own = |at: DVec3| back * (at - self.point) + DVec3::Z * rise;
        let (from, to) = (own(eye), own(point));
        let top = |p: DVec3| match self.solid {
            Solid::Wedge { .. } => p.z - height * (p.x / length + 0.5),
            _ => p.z - height,
        };
        let faces: [&dyn Fn(DVec3) -> f64; 6] = [
            &|p| p.x - 0.5 * length,
            &|p| -p.x - 0.5 * length,
            &|p| p.y - 0.5 * width,
            &|p| -p.y - 0.5 * width,
            &|p| -p.z,
            &top,
        ];
        // The share of the way on which all faces are behind.
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for face in faces {
            let (a, b) = (face(from), face(to));
            if a > 0.0 && b > 0.0 {
                return false;
            }
            if a * b < 0.0 {
                let share = a / (a - b);
                if a > 0.0 { enter = enter.max(share) } else { leave = leave.min(share) }
            }
        }
        leave - enter > 1e-3
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Placement, Pose};

    fn prop(solid: Solid, mobility: Mobility, pose: [f64; 3], foot: f64) -> Prop {
        let [x, y, heading] = pose;
        let placement = Placement::upright(Pose::new(x, y, heading), foot);
        Prop { name: String::new(), solid, placement, mobility }
    }

    fn floor(props: Vec<Prop>) -> Floor {
        Floor::new(&FleetInfo { props, ..FleetInfo::default() })
    }

    #[test]
    fn ramps_and_platforms_carry_robots() {
        let wedge = Solid::Wedge { size: [2.0, 1.0, 0.4] };
        let turned = std::f64::consts::FRAC_PI_2;
        let floor = floor(vec![
            prop(wedge, Mobility::Fixed, [3.0, 0.0, turned], 0.0),
            prop(Solid::Block { size: [2.0, 1.5, 0.4] }, Mobility::Fixed, [3.0, 2.0, 0.0], 0.0),
        ]);
        let at = |x, y| floor.height(DVec2::new(x, y));
        // The ramp rises along +y.
        assert!((at(3.0, 0.5) - 0.3).abs() < 1e-9 && (at(3.4, -0.5) - 0.1).abs() < 1e-9);
        assert!(at(3.6, 0.5).abs() < 1e-9 && (at(3.9, 1.5) - 0.4).abs() < 1e-9);
        let (height, normal) = floor.surface(DVec2::new(3.0, 0.0));
        assert!((height - 0.2).abs() < 1e-9 && (normal.y / normal.z + 0.2).abs() < 1e-9);
    }

    #[test]
    fn what_is_narrow_high_loose_or_upside_down_carries_nobody() {
        let block = |x, y, z| Solid::Block { size: [x, y, z] };
        let mut fallen = prop(Solid::Wedge { size: [2.0; 3] }, Mobility::Fixed, [0.0; 3], 0.0);
        fallen.placement.rotation = [1.0, 0.0, 0.0, 0.0];
        let floor = floor(vec![
            prop(block(4.0, 0.2, 0.5), Mobility::Fixed, [0.0; 3], 0.0),
            prop(block(4.0, 4.0, 1.2), Mobility::Fixed, [0.0; 3], 0.0),
            prop(block(4.0, 4.0, 0.3), Mobility::Loose, [0.0; 3], 0.0),
            prop(block(4.0, 4.0, 0.3), Mobility::Guided, [0.0; 3], 0.0),
            prop(Solid::Cylinder { radius: 2.0, height: 0.2 }, Mobility::Fixed, [0.0; 3], 0.0),
            fallen,
        ]);
        assert!(floor.is_plane());
    }

    #[test]
    fn a_deck_hides_what_is_behind_it_and_not_what_is_on_it() {
        let wedge = Solid::Wedge { size: [2.0, 1.0, 0.6] };
        let floor = floor(vec![prop(wedge, Mobility::Fixed, [0.0; 3], 0.5)]);
        let hides = |eye: [f64; 3], to: [f64; 3]| floor.drivables[0].hides(eye.into(), to.into());
        assert!(hides([-3.0, 0.0, 0.8], [2.0, 0.0, 0.8]));
        assert!(!hides([-3.0, 0.0, 1.8], [0.8, 0.0, 1.2]));
        assert!(!hides([-3.0, 0.0, 0.8], [2.0, 2.0, 0.8]));
        assert!(!hides([-3.0, 0.0, 0.8], [-2.0, 0.0, 0.8]));
        assert!(hides([3.0, 0.0, 0.7], [-0.5, 0.0, 0.8]));
    }
}
