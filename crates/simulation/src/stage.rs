//! The stage of a scene: its robots, props and ground as the world takes them.

use crate::error::BuildError;
use formation::Course;
use formation::lead::{Courses, Hermite, Pace, Table, Way, WayError};
use scene::{Compensation, Path, PropMotion, Role, Scene, SpeedProfile, VehicleKind};
use std::sync::Arc;
use vocabulary::{Mobility, Placement, Pose, Profile, Prop};
use world::wheeled::tyre::Tyre;
use world::{Actor, Drivetrain, Handling, PropBody, Stage, Unicycle, Wheeled};

/// All that is on stage.
pub(crate) fn stage(scene: &Scene) -> Result<Stage, BuildError> {
    Ok(Stage {
        actors: scene.robots.iter().map(actor).collect::<Result<_, _>>()?,
        props: scene.props.iter().map(prop).collect::<Result<_, _>>()?,
        terrain: scene.ground.terrain.clone(),
        step: scene.physics.step,
    })
}

fn actor(robot: &scene::Robot) -> Result<Actor, BuildError> {
    let (mut pose, mut speed, mut lead) = (robot.pose, 0.0, None);
    match &robot.role {
        Role::Lead { path } => {
            let (profile, start) =
                course(path).map_err(|source| BuildError::Way { robot: robot.name.clone(), source })?;
            pose = start.unwrap_or(pose);
            lead = Some(profile);
        }
        Role::Follow(follow) => speed = follow.speed,
    }
    let Handling { limits, wheels } = handling(&robot.vehicle);
    let unicycle = Unicycle { pose, speed, limits, body: robot.vehicle.body(), lead };
    Ok(Actor { robot: unicycle, wheels })
}

/// Limits and driver of a vehicle.
pub(crate) fn handling(vehicle: &scene::Vehicle) -> Handling {
    let wheels = vehicle.kind.has_wheels().then(|| Arc::new(wheeled(vehicle)));
    Handling { limits: vehicle.limits(), wheels }
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

fn prop(prop: &scene::Prop) -> Result<PropBody, BuildError> {
    let (mobility, mass, path) = match &prop.motion {
        PropMotion::Fixed => (Mobility::Fixed, 1.0, None),
        PropMotion::Loose { mass } => (Mobility::Loose, *mass, None),
        PropMotion::Guided { path } => {
            let found =
                course(path).map_err(|source| BuildError::Way { robot: prop.name.clone(), source })?;
            (Mobility::Guided, 1.0, Some(found))
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
        path: path.map(|(profile, _)| profile),
        friction: prop.friction,
        restitution: prop.restitution,
    })
}

/// The motion along a path, and where it has to start if the path says so.
fn course(path: &Path) -> Result<(Arc<dyn Profile>, Option<Pose>), WayError> {
    let profile: Arc<dyn Profile> = match path {
        Path::Constant { speed, turn_rate } | Path::Circle { speed, turn_rate } => {
            Arc::new(Courses::constant(*speed, *turn_rate))
        }
        Path::Sinusoid {
            speed,
            speed_amplitude,
            speed_rate,
            turn_rate,
            turn_rate_amplitude,
            turn_rate_rate,
        } => {
            let wave = |mean: &f64, amplitude: &f64, rate: &f64| Course::Sinusoid {
                mean: *mean,
                amplitude: *amplitude,
                rate: *rate,
            };
            Arc::new(Courses {
                speed: wave(speed, speed_amplitude, speed_rate),
                turn_rate: wave(turn_rate, turn_rate_amplitude, turn_rate_rate),
            })
        }
        Path::FigureEight { speed, length } => Arc::new(Courses::figure_eight(*speed, length / speed)),
        Path::Waypoints { points, closed, speed } => {
            let way = Way::new(points, *closed, pace(speed))?;
            let start = way.start();
            return Ok((Arc::new(way), Some(start)));
        }
        // A checked table has rows; one without would stand still.
        Path::Table { rows } => Table::new(rows)
            .map_or_else(|| Arc::new(Courses::constant(0.0, 0.0)) as Arc<dyn Profile>, |t| Arc::new(t)),
    };
    Ok((profile, None))
}

fn pace(speed: &SpeedProfile) -> Pace {
    // Checked profiles have rows.
    let through = |rows: &[[f64; 2]]| Hermite::new(rows.to_vec()).unwrap_or_else(|| Hermite::constant(0.0));
    match speed {
        SpeedProfile::Constant(v) => Pace::over_time(Hermite::constant(*v)),
        SpeedProfile::Time(rows) => Pace::over_time(through(rows)),
        SpeedProfile::Distance(rows) => Pace::over_distance(through(rows)),
    }
}
