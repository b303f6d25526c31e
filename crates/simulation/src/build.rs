//! A checked scene, turned into the parts that run it.

use crate::caption::caption;
use crate::error::{BuildError, EPSILON_MIN};
use crate::events::event_plan;
use crate::filing::edge_laws;
use crate::goals::{Goals, PlanPurpose, goals, wishes};
use crate::parameters::{ParameterSet, ScheduledChange};
use crate::safety::SafetyConfig;
use crate::setup::Setup;
use crate::stage::{handling, stage};
use formation::{
    Custom, EdgeLaw, Formation, Graph, Heading, PathFilter, SetPointTrajectory, TrackerParameters,
};
use perception::proximity::{ProximityConfig, ProximitySensor};
use perception::sensors::{CameraSettings, NoiseModel, Sensor, SensorConfig, SensorKind};
use scene::{Follow, Leader, OnContact, Role, Scene, SensingKind, SwitchingKind, Vision};
use std::sync::Arc;
use vocabulary::{Edge, FleetInfo, HeadingReference, Light, RobotInfo, ScalarTrajectory, TimeMode};
use world::{Unicycle, WorldSetup};

/// Puts the run of `scene` together.
///
/// # Errors
/// [`BuildError`], naming the robots.
pub fn build(scene: &Scene) -> Result<Setup, BuildError> {
    build_for(scene, PlanPurpose::Driving)
}

/// Puts the run of a scene together that another run changes to as it goes on
/// ([`apply_parameters`](crate::Simulation::apply_parameters)). That one plans from where it is, so here only the first way to
/// every goal is looked for, to know that there is one.
///
/// # Errors
/// Those of [`build`].
pub fn build_change(scene: &Scene) -> Result<Setup, BuildError> {
    build_for(scene, PlanPurpose::Checking)
}

fn build_for(scene: &Scene, purpose: PlanPurpose) -> Result<Setup, BuildError> {
    let graph = graph_of(scene)?;
    let joining = scene.joining();
    // One entry per edge, in the order of the graph's.
    let later = joining.iter().map(|(name, follow)| (*name, follow));
    let followers: Vec<(&str, &Follow)> =
        scene.edges().map(|(name, follow, _)| (name, follow)).chain(later).collect();
    check_continuous(scene, &followers)?;

    let laws = edge_laws(scene);
    let goals = goals(scene, &graph, &laws, purpose)?;
    let mut stage = stage(scene, &goals)?;
    let leading = stage.actors.iter().enumerate();
    let leads = leading.filter_map(|(index, actor)| Some((index, actor.robot.lead.clone()?))).collect();
    let limits = stage.actors.iter().map(|actor| actor.robot.limits).collect();
    let chased = chased(scene, &mut stage);
    let edges = graph.edges().to_vec();
    let changes = scene.changes.iter().map(turn).collect::<Result<_, _>>()?;
    let member = |robot: &scene::Robot| RobotInfo {
        name: robot.name.clone(),
        leads: matches!(robot.role, Role::Lead { .. }),
        body: robot.vehicle.body(),
        shell: Some(scene.vision.shell(robot)),
        camera_mount: scene.vision.camera_mount(robot),
        camera_model: scene.vision.camera_model(),
    };
    let members: Vec<RobotInfo> = scene.robots.iter().map(member).collect();
    let has_laws = scenes_of(scene).any(|scene| {
        scene.followers().any(|(_, follow)| follow.law.custom().is_some())
            || scene.joining().iter().any(|(_, follow)| follow.law.custom().is_some())
    });
    Ok(Setup {
        sensor_config: sensor_config(scene, &followers, &edges, &members, &stage),
        safety_config: safety_config(scene, &members, &stage),
        chased,
        events: Arc::new(event_plan(scene)?),
        filters: filters(&scene.robots),
        fleet: FleetInfo {
            title: scene.title.clone(),
            caption: caption(scene),
            duration: scene.time.duration,
            light: Light {
                sun_elevation: scene.environment.sun_elevation,
                sun_azimuth: scene.environment.sun_azimuth,
                haze_from: scene.environment.haze_from,
            },
            robots: members,
            edges,
            free: if laws.iter().any(|law| law.free != [false; 2]) {
                laws.iter().map(|law| law.free).collect()
            } else {
                vec![]
            },
            has_sensors: followers.iter().any(|(_, follow)| follow.sensing.kind != SensingKind::Truth),
            has_laws,
            has_events: !scene.events.is_empty() || scene.hand_over.held_up.is_some()
                // A law that breaks off is an event, and so is what becomes of a plan.
                || has_laws
                || !goals.is_empty(),
            has_safety: scene.robots.iter().any(|robot| robot.proximity.range.is_some()),
            has_plans: !goals.is_empty(),
            props: stage.props.iter().map(|prop| prop.prop.clone()).collect(),
            terrain: stage.terrain.clone(),
        },
        formation: Formation::new(graph, laws, limits, leads, scene.time.period)
            .with_seed(scene.seed)
            .in_continuous_time(scene.time.mode == TimeMode::Continuous),
        goals,
        stage,
        observer_starts: followers.iter().map(|(_, follow)| follow.observer.start).collect(),
        mode: scene.time.mode,
        stop_at_contact: scene.physics.on_contact != OnContact::Record,
        period: scene.time.period,
        duration: scene.time.duration,
        changes,
    })
}

/// The plans of a scene once more, with what the searches for them looked at.
///
/// # Errors
/// Those of [`build`].
pub fn recorded_plans(scene: &Scene) -> Result<Goals, BuildError> {
    goals(scene, &graph_of(scene)?, &edge_laws(scene), PlanPurpose::Drawing)
}

/// Who follows whom, and who joins later.
fn graph_of(scene: &Scene) -> Result<Graph, BuildError> {
    let names: Vec<&str> = scene.robots.iter().map(|r| &*r.name).collect();
    let pairs: Vec<(&str, &str)> = scene.edges().map(|(name, _, leader)| (&*leader.name, name)).collect();
    let mut graph = Graph::new(&names, &pairs)?;
    for (name, follow) in scene.joining() {
        let ends = [&*follow.leaders.first.name, name].map(|name| scene.index_of(name));
        if let [Some(leader), Some(follower)] = ends {
            graph.add_waiting(Edge { leader, follower });
        }
    }
    Ok(graph)
}

/// A scene as it begins, and as each of its changes leaves it.
fn scenes_of(scene: &Scene) -> impl Iterator<Item = &Scene> {
    std::iter::once(scene).chain(scene.changes.iter().map(|change| &*change.then))
}

/// What `change` puts in place.
fn turn(change: &scene::Change) -> Result<ScheduledChange, BuildError> {
    let robots = &change.then.robots;
    let joining = change.then.joining();
    let later = joining.iter().map(|(name, follow)| (*name, follow));
    let followers: Vec<(&str, &Follow)> = change.then.followers().chain(later).collect();
    check_continuous(&change.then, &followers)?;
    let parameters = ParameterSet {
        laws: edge_laws(&change.then),
        handling: change.then.robots.iter().map(|robot| handling(&change.then, robot)).collect(),
        filters: filters(robots),
        wishes: wishes(robots),
    };
    Ok(ScheduledChange { at: change.at, parameters })
}

/// Refuses what continuous time cannot run.
fn check_continuous(scene: &Scene, followers: &[(&str, &Follow)]) -> Result<(), BuildError> {
    if scene.time.mode != TimeMode::Continuous {
        return Ok(());
    }
    // The filtered heading is a memory that goes from sample to sample.
    if let Some((name, _)) = followers.iter().find(|(_, follow)| follow.law.heading == HeadingReference::Path)
    {
        return Err(BuildError::PathHeading { robot: (*name).to_owned() });
    }
    for (name, follow) in followers {
        if let Some(law) = follow.law.custom().filter(|law| !law.declaration().continuous) {
            return Err(BuildError::SampledLaw { robot: (*name).to_owned(), law: law.name().to_owned() });
        }
    }
    for (name, follow) in followers.iter().filter(|(_, f)| f.law.observes()) {
        let [a, b] = follow.observer.epsilon;
        if a.min(b) < EPSILON_MIN {
            return Err(BuildError::Stiff { robot: (*name).to_owned(), epsilon: a.min(b) });
        }
    }
    Ok(())
}

/// The law and observer of a follower, and its set point behind one of its leaders, as the loop uses them. What is left free
/// of that has the values `now`, [distance in m, bearing in rad].
pub fn edge_law(follow: &Follow, leader: &Leader, now: [f64; 2]) -> EdgeLaw {
    let (law, observer) = (&follow.law, observer(follow));
    let channel = |wanted: &Option<ScalarTrajectory>, now: f64| {
        wanted.clone().unwrap_or(ScalarTrajectory::Constant(now))
    };
    EdgeLaw {
        law: formation::Law {
            kind: law.kind,
            gain: law.k,
            robust_gain: law.beta,
            switching: match law.switching {
                SwitchingKind::Tanh => formation::Switching::Tanh(law.slope),
                SwitchingKind::Sign => formation::Switching::Sign,
            },
            distance_min: law.distance_min,
            heading: match law.heading {
                HeadingReference::Leader => Heading::Leader,
                HeadingReference::Path => {
                    Heading::Path(PathFilter { length: law.heading_length, lag: law.heading_lag })
                }
            },
        },
        custom: law.custom().map(|custom| Custom::new(custom.law(), law.told_values())),
        batch: None,
        observer,
        tracker: tracker_parameters(follow, observer),
        set_point: SetPointTrajectory {
            distance: channel(&leader.distance, now[0]),
            bearing: channel(&leader.bearing, now[1]),
        },
        free: [leader.distance.is_none(), leader.bearing.is_none()],
        standing: law.standing,
        narrowing: None,
    }
}

fn observer(follow: &Follow) -> formation::Observer {
    let scene::Observer { epsilon, alpha1, alpha2, .. } = follow.observer;
    formation::Observer { epsilon, alpha1, alpha2, distance_min: follow.law.distance_min }
}

fn tracker_parameters(follow: &Follow, observer: formation::Observer) -> Option<TrackerParameters> {
    (follow.sensing.kind != SensingKind::Truth).then_some(TrackerParameters {
        method: follow.observer.kind,
        observer,
        adaptive: follow.observer.adaptive,
        disturbance: follow.observer.disturbance,
        gate: follow.observer.gate,
        interval: 1.0 / follow.sensing.rate,
        hold: follow.sensing.hold,
    })
}

/// Takes lead robots with a safety filter from their paths, to be driven by commands; what they chase instead.
fn chased(scene: &Scene, stage: &mut WorldSetup) -> Vec<(usize, Unicycle)> {
    let mut chased = vec![];
    for (index, (robot, actor)) in scene.robots.iter().zip(&mut stage.actors).enumerate() {
        if let Some(lead) = actor.robot.lead.clone().filter(|_| robot.safety.acts(true)) {
            chased.push((index, actor.robot.clone()));
            actor.robot.speed = actor.robot.limits.clamp_speed(lead.at(0.0).speed);
            actor.robot.lead = None;
        }
    }
    chased
}

/// The barriers of every robot whose filter is on.
fn filters(robots: &[scene::Robot]) -> Vec<Option<safety::Parameters>> {
    let filter = |robot: &scene::Robot| {
        let (safety, kind) = (&robot.safety, robot.vehicle.kind);
        let length = robot.vehicle.body().length;
        safety.acts(matches!(robot.role, Role::Lead { .. })).then(|| safety::Parameters {
            margin: safety.margin_of(length),
            point_ahead: safety.point_ahead_of(kind, length),
            gain: safety.gain,
            horizon: safety.horizon,
            arena: safety.arena,
            view_distance: safety.view_distance,
            view_angle: safety.view_angle,
        })
    };
    robots.iter().map(filter).collect()
}

/// What safety filters go by; `None` where no robot senses what is near it.
fn safety_config(scene: &Scene, robots: &[RobotInfo], stage: &WorldSetup) -> Option<Arc<SafetyConfig>> {
    let sensor = |robot: &scene::Robot| {
        let proximity = &robot.proximity;
        proximity.range.map(|range| ProximitySensor {
            range,
            interval: proximity.rate.map_or(0.0, |rate| 1.0 / rate),
            distance_noise: proximity.distance_noise,
            bearing_noise: proximity.bearing_noise,
            epsilon: proximity.epsilon,
        })
    };
    let sensors: Vec<_> = scene.robots.iter().map(sensor).collect();
    sensors.iter().any(Option::is_some).then(|| {
        Arc::new(SafetyConfig {
            proximity: ProximityConfig {
                sensors,
                robots: robots.to_vec(),
                props: stage.props.iter().map(|prop| prop.prop.clone()).collect(),
                seed: scene.seed,
            },
            wheels: scene.robots.iter().map(|robot| robot.vehicle.kind.has_wheels()).collect(),
            pan_max: scene.vision.pan_max,
            pan_rate: scene.vision.pan_rate,
        })
    })
}

/// Tilt that is expected of bodies on springs or uneven ground, standard deviation, rad: a truck that brakes hard leans
/// by twice that.
const TILT: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// The sensors of all followers; `None` where all observe the true state.
fn sensor_config(
    scene: &Scene,
    followers: &[(&str, &Follow)],
    edges: &[Edge],
    robots: &[RobotInfo],
    stage: &WorldSetup,
) -> Option<Arc<SensorConfig>> {
    let level = stage.terrain.is_none();
    let sensors = followers.iter().zip(edges).map(|((_, follow), edge)| {
        let sensing = &follow.sensing;
        let firm = |index: usize| !scene.robots[index].vehicle.kind.has_wheels();
        let upright = level && firm(edge.leader) && firm(edge.follower);
        Sensor {
            source: match sensing.kind {
                SensingKind::Truth => SensorKind::Truth,
                SensingKind::Noise => SensorKind::Noise(NoiseModel {
                    deviation: [sensing.distance_noise, sensing.bearing_noise, sensing.view_noise],
                    bias: [sensing.distance_bias, sensing.bearing_bias, sensing.view_bias],
                    correlation: sensing.correlation,
                }),
                SensingKind::Geometric => SensorKind::Geometric { pixel_noise: sensing.pixel_noise },
                SensingKind::Camera => SensorKind::Camera,
            },
            rate: sensing.rate,
            latency: sensing.latency,
            drop: sensing.drop,
            tilt: sensing.tilt.unwrap_or(if upright { 0.0 } else { TILT }),
        }
    });
    let Vision { blur, noise, exposure, shutter, pan_rate, pan_max, whole_frames, .. } = scene.vision;
    let camera = CameraSettings { blur, noise, exposure, shutter, pan_rate, pan_max, whole_frames };
    let sensor_config = SensorConfig {
        edges: edges.to_vec(),
        sensors: sensors.collect(),
        robots: robots.to_vec(),
        props: stage.props.iter().map(|prop| prop.prop.clone()).collect(),
        terrain: stage.terrain.clone(),
        camera,
        seed: scene.seed,
    };
    sensor_config.has_sensors().then(|| Arc::new(sensor_config))
}
