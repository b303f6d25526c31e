//! A checked scene, turned into the parts that run it.

use crate::caption::caption;
use crate::error::{BuildError, EPSILON_MIN};
use crate::parameters::{ParameterSet, ScheduledChange};
use crate::setup::Setup;
use crate::stage::{handling, stage};
use formation::{EdgeLaw, Formation, Graph, Heading, PathFilter, SetPointTrajectory, TrackerParameters};
use perception::sensors::{CameraSettings, NoiseModel, Sensor, SensorConfig, SensorKind};
use scene::{Follow, OnContact, Role, Scene, SensingKind, SwitchingKind, Vision};
use std::sync::Arc;
use vocabulary::{Edge, FleetInfo, HeadingReference, Light, RobotInfo, TimeMode};
use world::WorldSetup;

/// Puts the run of `scene` together.
///
/// # Errors
/// [`BuildError`], naming the robots.
pub fn build(scene: &Scene) -> Result<Setup, BuildError> {
    let names: Vec<&str> = scene.robots.iter().map(|r| &*r.name).collect();
    let followers: Vec<(&str, &Follow)> = scene.followers().collect();
    let pairs: Vec<(&str, &str)> = followers.iter().map(|(name, follow)| (&*follow.leader, *name)).collect();
    let graph = Graph::new(&names, &pairs)?;
    check_continuous(scene, &followers)?;

    let stage = stage(scene)?;
    let leading = stage.actors.iter().enumerate();
    let leads = leading.filter_map(|(index, actor)| Some((index, actor.robot.lead.clone()?))).collect();
    let limits = stage.actors.iter().map(|actor| actor.robot.limits).collect();
    let edges = graph.edges().to_vec();
    let laws = followers.iter().map(|(_, follow)| edge_law(follow)).collect();
    let member = |robot: &scene::Robot| RobotInfo {
        name: robot.name.clone(),
        leads: matches!(robot.role, Role::Lead { .. }),
        body: robot.vehicle.body(),
        shell: Some(scene.vision.shell(robot)),
        camera_mount: scene.vision.camera_mount(robot),
        camera_model: scene.vision.camera_model(),
    };
    let members: Vec<RobotInfo> = scene.robots.iter().map(member).collect();
    Ok(Setup {
        sensor_config: sensor_config(scene, &followers, &edges, &members, &stage),
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
            has_sensors: followers.iter().any(|(_, follow)| follow.sensing.kind != SensingKind::Truth),
            props: stage.props.iter().map(|prop| prop.prop.clone()).collect(),
            terrain: stage.terrain.clone(),
        },
        formation: Formation::new(graph, laws, limits, leads, scene.time.period),
        stage,
        observer_starts: followers.iter().map(|(_, follow)| follow.observer.start).collect(),
        mode: scene.time.mode,
        stop_at_contact: scene.physics.on_contact != OnContact::Record,
        period: scene.time.period,
        duration: scene.time.duration,
        changes: scene.changes.iter().map(turn).collect::<Result<_, _>>()?,
    })
}

/// What `change` puts in place.
fn turn(change: &scene::Change) -> Result<ScheduledChange, BuildError> {
    let robots = &change.then.robots;
    let followers: Vec<(&str, &Follow)> = change.then.followers().collect();
    check_continuous(&change.then, &followers)?;
    let parameters = ParameterSet {
        laws: followers.iter().map(|(_, follow)| edge_law(follow)).collect(),
        handling: robots.iter().map(handling).collect(),
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
    for (name, follow) in followers.iter().filter(|(_, f)| f.law.kind == vocabulary::LawKind::OutputFeedback)
    {
        let [a, b] = follow.observer.epsilon;
        if a.min(b) < EPSILON_MIN {
            return Err(BuildError::Stiff { robot: (*name).to_owned(), epsilon: a.min(b) });
        }
    }
    Ok(())
}

/// The law, observer and set point of a follower, as the loop uses them.
pub fn edge_law(follow: &Follow) -> EdgeLaw {
    let (law, observer) = (&follow.law, observer(follow));
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
        observer,
        tracker: tracker_parameters(follow, observer),
        set_point: SetPointTrajectory { distance: follow.distance.clone(), bearing: follow.bearing.clone() },
        standing: law.standing,
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
