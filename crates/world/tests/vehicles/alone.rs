//! One vehicle by itself.

use crate::common::{Run, actor, differential, flat, truck};
use vocabulary::math;
use vocabulary::{Command, Condition, GRAVITY, Pose};
use world::wheeled::Drivetrain;
use world::{Wheeled, World};

const FORWARD: Command = Command { acceleration: 0.0, turn_rate: 0.0 };

fn alone(vehicle: &Wheeled, speed: f64) -> Run {
    Run::new(flat(vec![actor(vehicle, Pose::default(), speed)]))
}

/// One that nobody drives: no motor, no brake.
fn idle() -> Wheeled {
    Wheeled { drive_force: 1e-9, brake_force: 1e-9, ..truck() }
}

#[test]
fn rest_stays_at_rest_for_a_minute() {
    for mut vehicle in [truck(), differential()] {
        vehicle.limits.speed_min = 0.0;
        let mut run = alone(&vehicle, 0.0);
        run.hold(FORWARD, 60.0, |snapshot| {
            let robot = &snapshot.robots[0];
            let drift =
                math::hypot(robot.motion.pose.x, robot.motion.pose.y).max(robot.attitude.height.abs());
            assert!(drift < 1e-3, "{drift} m after {} s", snapshot.time);
        });
        assert!(run.motion().pose.heading.abs() < 1e-4);
    }
}

/// Also off the world's axes, where a controller of wheels once braked in the wrong direction (rapier issues 925, 946).
#[test]
fn coasting_and_braking_follow_their_closed_forms_at_any_heading() {
    for heading in [0.0, 1.0, -2.5] {
        let coasting = Wheeled { drag: 0.0, ..idle() };
        let mut run = Run::new(flat(vec![actor(&coasting, Pose::new(0.0, 0.0, heading), 2.0)]));
        run.hold(FORWARD, 4.0, |_| {});
        let (lost, wanted) = (2.0 - run.motion().speed, coasting.tyre.rolling * GRAVITY * 4.0);
        assert!((lost / wanted - 1.0).abs() < 0.03, "coasting lost {lost} of {wanted} m/s");

        let vehicle = Wheeled { drag: 0.0, brake_lag: 1e-4, brake_force: 20.0, ..truck() };
        let mut run = Run::new(flat(vec![actor(&vehicle, Pose::new(0.0, 0.0, heading), 3.0)]));
        run.hold(Command { acceleration: -100.0, turn_rate: 0.0 }, 2.0, |_| {});
        let deceleration = 20.0 / vehicle.mass + vehicle.tyre.rolling * GRAVITY;
        let (pose, wanted) = (run.motion().pose, 4.5 / deceleration);
        let (ahead, aside) = (
            pose.x * math::cos(heading) + pose.y * math::sin(heading),
            pose.y * math::cos(heading) - pose.x * math::sin(heading),
        );
        assert!((ahead / wanted - 1.0).abs() < 0.03, "stopped after {ahead} m, not {wanted} m");
        assert!(aside.abs() < 1e-3 && run.motion().speed.abs() < 1e-3);
    }
}

#[test]
fn wheels_roll_as_far_as_the_vehicle_drives() {
    let mut run = alone(&truck(), 1.0);
    run.hold(FORWARD, 2.0, |_| {});
    let rolled = run.world.snapshot().robots[0].wheels[2].rotation * truck().body.wheel_radius;
    assert!((rolled / run.motion().pose.x - 1.0).abs() < 0.01);
}

/// The path of a steered vehicle at 0.5 m/s is that of the kinematic bicycle.
#[test]
fn slow_turns_are_those_of_the_kinematic_bicycle() {
    let angle: f64 = 0.3;
    let vehicle = Wheeled { turn_gain: 0.0, ..truck() };
    let turn_rate = 0.5 * math::tan(angle) / vehicle.body.wheelbase;
    let mut run = alone(&vehicle, 0.5);
    run.hold(Command { acceleration: 0.0, turn_rate }, 3.0, |_| {});
    let (mut turned, mut driven, start) = (0.0, 0.0, run.world.snapshot().time);
    run.hold(Command { acceleration: 0.0, turn_rate }, 6.0, |snapshot| {
        turned += snapshot.robots[0].motion.turn_rate * 0.01;
        driven += snapshot.robots[0].motion.speed * 0.01;
        // Steered by the inverse bicycle: tan δ = L ω/v holds the curvature.
        assert!((snapshot.robots[0].wheels[0].steering - angle).abs() < 0.1);
    });
    assert!(start > 2.9 && driven > 2.5);
    let curvature = turned / driven;
    let wanted = math::tan(angle) / vehicle.body.wheelbase;
    println!("slow: curvature {curvature}, bicycle {wanted}");
    assert!((curvature / wanted - 1.0).abs() < 0.02, "curvature {curvature}, bicycle {wanted}");
}

/// Dynamic single-track model with the same tyres, integrated here by itself: side speed u and turn rate r at the centre
/// of mass, fed with the speed and steering angle that the vehicle had.
#[test]
fn fast_turns_are_those_of_a_single_track_model() {
    let vehicle = Wheeled { turn_gain: 0.0, ..truck() };
    let (m, i) = (vehicle.mass, vehicle.inertia()[2]);
    let l = vehicle.body.wheelbase;
    let (a, b) = (l * (1.0 - vehicle.mass_forward), l * vehicle.mass_forward);
    let axle = |share: f64| vehicle.tyre.cornering * m * GRAVITY * share;
    let (front, rear) = (axle(b / l), axle(a / l));
    let mut run = alone(&vehicle, 3.0);
    let (mut u, mut r, mut worst) = (0.0, 0.0, 0.0_f64);
    let mut heading = 0.0;
    let command = Command { acceleration: 0.0, turn_rate: 0.9 };
    run.hold(command, 3.0, |snapshot| {
        let robot = &snapshot.robots[0];
        let steering = 0.5 * (robot.wheels[0].steering + robot.wheels[1].steering);
        let v = robot.motion.speed;
        for _ in 0..100 {
            let (slip_front, slip_rear) =
                (math::atan((u + a * r) / v) - steering, math::atan((u - b * r) / v));
            let (side_front, side_rear) = (-front * slip_front, -rear * slip_rear);
            u += 1e-4 * ((side_front + side_rear) / m - v * r);
            r += 1e-4 * (a * side_front - b * side_rear) / i;
        }
        heading += r * 0.01;
        worst = worst.max((robot.motion.pose.heading - heading).abs());
    });
    let settled = run.motion().turn_rate;
    assert!((settled / r - 1.0).abs() < 0.02, "turn rate {settled}, single track {r}");
    assert!(worst < 0.02 * heading.abs().max(1.0), "{worst} rad of {heading}");
}

#[test]
fn a_differential_drive_turns_on_the_spot_and_drives_curves() {
    let mut run = alone(&differential(), 0.0);
    run.hold(Command { acceleration: 0.0, turn_rate: 1.0 }, 3.0, |_| {});
    assert!((run.motion().turn_rate - 1.0).abs() < 0.05, "{:?}", run.motion());
    assert!(math::hypot(run.motion().pose.x, run.motion().pose.y) < 0.05, "{:?}", run.motion());
    let mut run = alone(&differential(), 0.5);
    run.hold(Command { acceleration: 0.2, turn_rate: 0.4 }, 3.0, |_| {});
    assert!(
        (run.motion().speed - 1.1).abs() < 0.05 && (run.motion().turn_rate - 0.4).abs() < 0.03,
        "{:?}",
        run.motion()
    );
}

#[test]
fn the_driver_gives_what_the_law_asked_for() {
    let mut run = alone(&truck(), 0.5);
    run.hold(Command { acceleration: 0.5, turn_rate: 0.0 }, 2.0, |_| {});
    assert!((run.motion().speed - 1.5).abs() < 0.03, "{:?}", run.motion());
    run.hold(Command { acceleration: 0.0, turn_rate: 0.8 }, 2.0, |_| {});
    assert!(
        (run.motion().turn_rate - 0.8).abs() < 0.03 && (run.motion().speed - 1.5).abs() < 0.05,
        "{:?}",
        run.motion()
    );
}

/// Compensation leads the lags: the turn rate is there sooner.
#[test]
fn compensated_actuators_answer_sooner() {
    let sooner = |compensation: bool| {
        let mut run = alone(&Wheeled { compensation, turn_gain: 0.0, ..truck() }, 1.0);
        let mut rise = 0.0;
        run.hold(Command { acceleration: 0.0, turn_rate: 0.5 }, 1.0, |snapshot| {
            if rise == 0.0 && snapshot.robots[0].motion.turn_rate > 0.4 {
                rise = snapshot.time;
            }
        });
        rise
    };
    let (plain, led) = (sooner(false), sooner(true));
    assert!(led > 0.0 && led < 0.75 * plain, "{led} s against {plain} s");
}

#[test]
fn steering_keeps_its_range_and_its_rate() {
    let Drivetrain::Steered { angle_max, rate, .. } = truck().drivetrain else { unreachable!() };
    let mut run = alone(&truck(), 1.0);
    let mut last = 0.0;
    run.hold(Command { acceleration: 0.0, turn_rate: 100.0 }, 1.0, |snapshot| {
        let [left, right, ..] = snapshot.robots[0].wheels;
        let middle = math::atan(2.0 / (1.0 / math::tan(left.steering) + 1.0 / math::tan(right.steering)));
        assert!(middle <= angle_max + 1e-9 && (middle - last) <= rate * 0.01 + 1e-3, "{middle} after {last}");
        assert!(left.steering >= right.steering, "the inner wheel turns more");
        last = middle;
    });
    assert!(last > 0.98 * angle_max);
}

#[test]
fn an_overturned_and_a_stuck_robot_are_named() {
    let top_heavy = Wheeled {
        mass_height: 0.3,
        tyre: world::wheeled::tyre::Tyre { friction: 2.5, ..truck().tyre },
        ..truck()
    };
    let mut wild = top_heavy.limits;
    wild.lateral_acceleration_max = f64::INFINITY;
    let mut run = alone(&Wheeled { limits: wild, ..top_heavy }, 4.0);
    run.hold(Command { acceleration: 0.0, turn_rate: 8.0 }, 3.0, |_| {});
    assert_eq!(run.world.snapshot().robots[0].condition, Condition::Overturned);
    let weak = Wheeled { drive_force: 0.5, ..truck() };
    let mut run = alone(&weak, 0.0);
    run.hold(Command { acceleration: 1.0, turn_rate: 0.0 }, 3.0, |_| {});
    assert_eq!(run.world.snapshot().robots[0].condition, Condition::Stuck);
}

/// A law that brakes on and on does not stop a follower: it keeps to its slowest speed, and can still turn.
#[test]
fn a_follower_never_stands_still() {
    let mut vehicle = truck();
    vehicle.limits.speed_min = 0.2;
    let mut run = alone(&vehicle, 1.0);
    run.hold(Command { acceleration: -4.0, turn_rate: 3.0 }, 3.0, |snapshot| {
        let motion = &snapshot.robots[0].motion;
        assert!(motion.speed > 0.1, "{} m/s after {} s", motion.speed, snapshot.time);
    });
    assert!((run.motion().speed - 0.2).abs() < 0.02 && run.motion().turn_rate > 0.3, "{:?}", run.motion());
}
