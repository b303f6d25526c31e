//! What plans know of what is around a formation: what stands there, and what goes along a known path.

use crate::stage::course;
use planning::{Boundary, Convex, FormationModel, InputError, Map, MovingThing, TrackPoint};
use scene::{PropMotion, PropSpec, Scene};
use std::sync::Arc;
use vocabulary::{Body, EntityId, Limits, Placement, Pose, Solid, math};
use world::{Unicycle, Unicycles, World};

/// All props of a scene as planning takes them.
#[derive(Debug, Clone, Default)]
pub(super) struct KnownThings {
    pub(super) things: Vec<Thing>,
}

/// A prop.
#[derive(Debug, Clone)]
pub(super) struct Thing {
    /// About the middle of its foot.
    pub(super) body: Convex,
    /// Where it starts.
    pub(super) pose: Pose,
    /// Whether plans know of it from the start.
    pub(super) known: bool,
    /// Whether it hangs over all robots.
    pub(super) overhead: bool,
    /// Whether it can be pushed.
    pub(super) loose: bool,
    /// Where it goes, if it has a path.
    pub(super) moving: Option<MovingThing>,
}

/// What a formation may go around, m, besides its own size.
const AROUND: f64 = 10.0;
/// Points of the tracks of things are so far apart, s.
const TRACK_STEP: f64 = 0.1;

impl KnownThings {
    pub(super) fn of(scene: &Scene) -> Result<Self, InputError> {
        let height = scene.robots.iter().map(|robot| robot.vehicle.body().height).fold(0.0, f64::max);
        let thing = |prop: &PropSpec| {
            let body = outline(&prop.solid)?;
            let moving = match &prop.motion {
                PropMotion::Guided { .. } => Some(MovingThing::new(body.clone(), track(scene, prop))?),
                _ => None,
            };
            Ok(Thing {
                body,
                pose: prop.pose,
                known: prop.known,
                overhead: prop.elevation >= height,
                loose: matches!(prop.motion, PropMotion::Loose { .. }),
                moving,
            })
        };
        Ok(Self { things: scene.props.iter().map(thing).collect::<Result<_, _>>()? })
    }

    /// What is known to stand at the start.
    pub(super) fn standing_at_first(&self) -> Vec<(EntityId, Convex)> {
        let things = self.things.iter().enumerate();
        things
            .filter(|(_, thing)| thing.known && !thing.overhead && thing.moving.is_none())
            .map(|(index, thing)| (EntityId::Prop(index), thing.body.moved(thing.pose)))
            .collect()
    }

    /// What is known to go along a path.
    pub(super) fn moving(&self, known: impl Fn(usize) -> bool) -> Vec<(EntityId, MovingThing)> {
        let things = self.things.iter().enumerate();
        things
            .filter(|(index, thing)| known(*index) && !thing.overhead)
            .filter_map(|(index, thing)| Some((EntityId::Prop(index), thing.moving.clone()?)))
            .collect()
    }
}

/// A map of what stands, and whose its obstacles are. The ground is what a formation may need around `places` and all of that.
pub(super) fn map(
    standing: &[(EntityId, Convex)],
    places: impl Iterator<Item = [f64; 2]>,
    model: &FormationModel,
    clearance: f64,
) -> Result<Map, InputError> {
    let around = AROUND
        + (0..model.levels())
            .flat_map(|level| model.places(level))
            .fold(0.0, |most: f64, place| most.max(math::hypot(place[0], place[1])));
    let things = standing.iter().flat_map(|(_, thing)| {
        let ([x, y], reach) = (thing.centre(), thing.reach());
        [[x - reach, y - reach], [x + reach, y + reach]]
    });
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for place in places.chain(things) {
        for k in 0..2 {
            low[k] = low[k].min(place[k] - around);
            high[k] = high[k].max(place[k] + around);
        }
    }
    let ground = Convex::polygon(&[low, [high[0], low[1]], high, [low[0], high[1]]])?;
    Map::new(ground, standing.iter().map(|(_, thing)| thing.clone()).collect(), clearance)
}

/// Whose a boundary of such a map is; `None` for its edge.
pub(super) fn owner(standing: &[(EntityId, Convex)], boundary: &Boundary) -> Option<EntityId> {
    match boundary {
        Boundary::Obstacle(index) => standing.get(*index).map(|(whose, _)| *whose),
        Boundary::Ground(_) => None,
    }
}

/// What a solid takes up, about the middle of its foot.
fn outline(solid: &Solid) -> Result<Convex, InputError> {
    match *solid {
        Solid::Cylinder { radius, .. } | Solid::Cone { radius, .. } => Convex::disc([0.0; 2], radius),
        Solid::Block { size } | Solid::Wedge { size } => {
            Convex::rectangle(Pose::default(), [0.5 * size[0], 0.5 * size[1]])
        }
    }
}

/// Where a placement is, seen from above.
pub(super) fn above(placement: &Placement) -> Pose {
    let [x, y, _] = placement.position;
    let [qx, qy, qz, qw] = placement.rotation;
    let heading = math::atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz));
    Pose::new(x, y, heading)
}

/// Where a guided prop goes in the run. A path that makes no curve is told elsewhere.
fn track(scene: &Scene, prop: &PropSpec) -> Vec<TrackPoint> {
    let stays = vec![TrackPoint { time: 0.0, pose: prop.pose }];
    let PropMotion::Guided { path } = &prop.motion else { return stays };
    let Ok((motion, start)) = course(path) else { return stays };
    let mut ideal = Unicycles::new(vec![Unicycle {
        pose: start.unwrap_or(prop.pose),
        speed: 0.0,
        limits: Limits { speed_max: f64::INFINITY, ..Limits::PAPER },
        body: Body::default(),
        lead: Some(Arc::clone(&motion.trajectory())),
    }]);
    let steps = (scene.time.duration / TRACK_STEP).ceil() as usize;
    let mut points = vec![];
    for k in 0..=steps {
        if k > 0 {
            ideal.advance(TRACK_STEP);
        }
        points.push(TrackPoint { time: TRACK_STEP * k as f64, pose: ideal.snapshot().robots[0].motion.pose });
    }
    points
}
