//! The stage of a scene: its robots, props and ground as the world takes them.

use crate::drivable::{PathMotion, Undrivable, undrivable};
use crate::error::BuildError;
use crate::goals::{Goals, PlannedMotion};
use formation::lead::{
    AnalyticTrajectory, Hermite, SpeedSchedule, SplinePath, SplinePathError, TabulatedTrajectory,
};
use scene::{Compensation, Path, PropMotion, Role, Scene, SpeedProfile, VehicleKind};
use std::sync::Arc;
use vocabulary::{Limits, Mobility, Placement, Pose, Prop, ScalarTrajectory, Trajectory};
use world::wheeled::tyre::Tyre;
use world::{Drivetrain, Handling, PropBody, RobotSetup, Unicycle, Wheeled, WorldSetup};

/// All that is on stage.
pub(crate) fn stage(scene: &Scene, goals: &Goals) -> Result<WorldSetup, BuildError> {
    let mut actors = Vec::with_capacity(scene.robots.len());
    for index in 0..scene.robots.len() {
        actors.push(actor(scene, index, goals.motion_of(index))?);
    }
    Ok(WorldSetup {
        actors,
        props: scene.props.iter().map(|prop| body(scene, prop)).collect::<Result<_, _>>()?,
        terrain: scene.ground.terrain.clone(),
        step: scene.physics.step,
    })
}

fn actor(
    scene: &Scene,
    index: usize,
    planned: Option<&Arc<PlannedMotion>>,
) -> Result<RobotSetup, BuildError> {
    let robot = &scene.robots[index];
    let (mut pose, mut speed, mut lead) = (robot.pose, 0.0, None);
    match &robot.role {
        Role::Lead { path } => {
            let (motion, start) = match planned {
                Some(motion) => (PathMotion::Free(motion.clone()), None),
                None => course(path)
                    .map_err(|source| BuildError::SplinePath { robot: robot.name.clone(), source })?,
            };
            check_drivable(scene, index, &motion)?;
            pose = start.unwrap_or(pose);
            lead = Some(motion.trajectory());
        }
        Role::Follow(follow) => speed = follow.speed,
    }
    let Handling { limits, wheels } = handling(scene, robot);
    let unicycle = Unicycle { pose, speed, limits, body: robot.vehicle.body(), lead };
    Ok(RobotSetup { robot: unicycle, wheels })
}

/// Holds the motion of a lead robot against its limits, and against those that it has after each change.
fn check_drivable(scene: &Scene, index: usize, motion: &PathMotion) -> Result<(), BuildError> {
    let robot = &scene.robots[index];
    let changed = scene.changes.iter().map(|change| (change.at, change.then.robots[index].vehicle.limits()));
    let mut limits: Vec<_> = [(0.0, robot.vehicle.limits())].into_iter().chain(changed).collect();
    limits.dedup_by(|later, earlier| later.1 == earlier.1);
    for (k, (from, bounds)) in limits.iter().enumerate() {
        let end = limits.get(k + 1).map_or(scene.time.duration, |next| next.0).min(scene.time.duration);
        if let Some(found) = undrivable(motion, bounds, [*from, end]).filter(|_| *from <= end) {
            return Err(found.of(&robot.name));
        }
    }
    Ok(())
}

/// Limits and driver of a robot.
pub(crate) fn handling(scene: &Scene, robot: &scene::Robot) -> Handling {
    let vehicle = &robot.vehicle;
    let wheels = vehicle.kind.has_wheels().then(|| Arc::new(wheeled(vehicle)));
    let limits = robot.limits();
    // Who leads by commands stops where its motion does.
    let chases = matches!(robot.role, Role::Lead { .. }) && robot.safety.acts(true);
    let stands = chases || joins_standing(scene, &robot.name);
    Handling { limits: if stands { Limits { speed_min: 0.0, ..limits } } else { limits }, wheels }
}

/// Whether a robot that leads at the start follows later, and then stands with its leader.
fn joins_standing(scene: &Scene, name: &str) -> bool {
    scene.joining().iter().any(|(robot, follow)| *robot == name && follow.law.standing)
}

fn wheeled(vehicle: &scene::Vehicle) -> Wheeled {
    let drivetrain = match vehicle.kind {
        VehicleKind::Differential => Drivetrain::Differential,
        _ => Drivetrain::Steered {
            angle_max: vehicle.steering_max,
            rate: vehicle.steering_rate,
            lag: vehicle.steering_lag,
        },
    };
    Wheeled {
        body: vehicle.body(),
        limits: vehicle.limits(),
        mass: vehicle.mass,
        mass_height: vehicle.mass_height,
        mass_forward: vehicle.mass_forward,
        inertia_scale: vehicle.inertia_scale,
        clearance: vehicle.clearance,
        spring: vehicle.spring,
        damping: vehicle.damping,
        travel: vehicle.travel,
        tyre: Tyre {
            friction: vehicle.friction,
            cornering: vehicle.cornering,
            relaxation: vehicle.relaxation,
            rolling: vehicle.rolling,
        },
        drag: vehicle.drag,
        drivetrain,
        drive_force: vehicle.drive_force,
        drive_lag: vehicle.drive_lag,
        brake_force: vehicle.brake_force,
        brake_lag: vehicle.brake_lag,
        compensation: vehicle.compensation == Compensation::Lead,
        speed_gain: vehicle.speed_gain,
        turn_gain: vehicle.turn_gain,
    }
}

/// A guided prop turns by no more than this in a physics step, rad.
const TURN_A_STEP: f64 = 0.1;

fn body(scene: &Scene, prop: &scene::PropSpec) -> Result<PropBody, BuildError> {
    let (mobility, mass, path) = match &prop.motion {
        PropMotion::Fixed => (Mobility::Fixed, 1.0, None),
        PropMotion::Loose { mass } => (Mobility::Loose, *mass, None),
        PropMotion::Guided { path } => {
            let (motion, start) =
                course(path).map_err(|source| BuildError::SplinePath { robot: prop.name.clone(), source })?;
            let turn_rate_max = TURN_A_STEP / scene.physics.step;
            let limits = Limits { speed_max: f64::INFINITY, turn_rate_max, ..Limits::PAPER };
            if let Some(found) = undrivable(&motion, &limits, [0.0, scene.time.duration]) {
                return Err(Undrivable { step: Some(scene.physics.step), ..found }.of(&prop.name));
            }
            (Mobility::Guided, 1.0, Some((motion.trajectory(), start)))
        }
    };
    let start = path.as_ref().and_then(|(_, start)| *start).unwrap_or(prop.pose);
    Ok(PropBody {
        prop: Prop {
            name: prop.name.clone(),
            solid: prop.solid,
            placement: Placement::upright(start, prop.elevation),
            mobility,
        },
        mass,
        path: path.map(|(trajectory, _)| trajectory),
        friction: prop.friction,
        restitution: prop.restitution,
    })
}

/// The motion along a path, and where it has to start if the path says so.
pub(crate) fn course(path: &Path) -> Result<(PathMotion, Option<Pose>), SplinePathError> {
    let trajectory: Arc<dyn Trajectory> = match path {
        Path::Constant { speed, turn_rate } | Path::Circle { speed, turn_rate } => {
            Arc::new(AnalyticTrajectory::constant(*speed, *turn_rate))
        }
        Path::Sinusoid {
            speed,
            speed_amplitude,
            speed_rate,
            turn_rate,
            turn_rate_amplitude,
            turn_rate_rate,
        } => {
            let wave = |mean: &f64, amplitude: &f64, rate: &f64| ScalarTrajectory::Sinusoid {
                mean: *mean,
                amplitude: *amplitude,
                rate: *rate,
            };
            Arc::new(AnalyticTrajectory {
                speed: wave(speed, speed_amplitude, speed_rate),
                turn_rate: wave(turn_rate, turn_rate_amplitude, turn_rate_rate),
            })
        }
        Path::FigureEight { speed, length } => {
            Arc::new(AnalyticTrajectory::figure_eight(*speed, length / speed))
        }
        Path::Waypoints { points, closed, speed } => {
            let way = SplinePath::new(points, *closed, pace(speed))?;
            let start = way.start();
            return Ok((PathMotion::SplinePath(Arc::new(way)), Some(start)));
        }
        // A checked table has rows; one without would stand still.
        Path::Table { rows } => TabulatedTrajectory::new(rows).map_or_else(
            || Arc::new(AnalyticTrajectory::constant(0.0, 0.0)) as Arc<dyn Trajectory>,
            |t| Arc::new(t),
        ),
        // Ways to goals are planned before; whoever has none stays.
        Path::Goal { .. } | Path::Tour { .. } => Arc::new(AnalyticTrajectory::constant(0.0, 0.0)),
    };
    Ok((PathMotion::Free(trajectory), None))
}

fn pace(speed: &SpeedProfile) -> SpeedSchedule {
    // Checked profiles have rows.
    let through = |rows: &[[f64; 2]]| Hermite::new(rows.to_vec()).unwrap_or_else(|| Hermite::constant(0.0));
    match speed {
        SpeedProfile::Constant(v) => SpeedSchedule::over_time(Hermite::constant(*v)),
        SpeedProfile::Time(rows) => SpeedSchedule::over_time(through(rows)),
        SpeedProfile::Distance(rows) => SpeedSchedule::over_distance(through(rows)),
    }
}
