//! The truck of tests, benchmarks and examples; a scene's `vehicle = "car"` is much like it.

use vocabulary::math;
use vocabulary::{Body, Limits};
use world::wheeled::tyre::Tyre;
use world::{Drivetrain, Wheeled};

/// A 1/10 truck.
pub(crate) fn truck() -> Wheeled {
    let body =
        Body { length: 0.49, width: 0.39, height: 0.32, wheelbase: 0.30, track: 0.285, wheel_radius: 0.0825 };
    let angle_max = 28_f64.to_radians();
    Wheeled {
        body,
        limits: Limits {
            speed_min: 0.01,
            speed_max: 4.0,
            turn_rate_max: 8.0,
            acceleration_max: 6.0,
            curvature_max: math::tan(angle_max) / body.wheelbase,
            lateral_acceleration_max: 7.0,
        },
        mass: 5.01,
        mass_height: 0.11,
        mass_forward: 0.5,
        inertia_scale: 1.0,
        clearance: 0.075,
        spring: 700.0,
        damping: 40.0,
        travel: 0.04,
        tyre: Tyre { friction: 0.9, cornering: 12.0, relaxation: 0.06, rolling: 0.03 },
        drag: 0.02,
        drivetrain: Drivetrain::Steered { angle_max, rate: 5.0, lag: 0.08 },
        drive_force: 30.0,
        drive_lag: 0.1,
        brake_force: 35.0,
        brake_lag: 0.05,
        compensation: true,
        speed_gain: 4.0,
        turn_gain: 0.5,
    }
}
