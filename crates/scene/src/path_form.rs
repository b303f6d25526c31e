//! How a lead robot's path is written.

use crate::{
    Goal, Path, SpeedProfile, Travel,
    names::POSE,
    table_file::{ROWS_FILE, check_rising},
    text::{
        Couple, Flag, Form, Node, Reporter, Triple,
        form::Number,
        integer, keys,
        keys::one_of,
        kinds::{Kind, Kinds},
        list, number, table,
        words::Words,
    },
};
use serde_json::{Value as Json, json};
use vocabulary::{math, wrap};

/// Time of a row.
pub(crate) const TIME: Number = number("s").from(0.0);
/// Speed of a lead robot.
pub(crate) const SPEED: Number = number("m/s").from(0.0).up_to(100.0);
/// Change of a speed.
const SPEED_CHANGE: Number = number("m/s").from(-100.0).up_to(100.0);
/// Turn rate of a lead robot.
pub(crate) const TURN_RATE: Number = number("rad/s").from(-1000.0).up_to(1000.0);
/// Rate inside a sine.
const RATE: Number = number("rad/s").from(-1000.0).up_to(1000.0);
/// Most rows of a table or points of a curve.
pub(crate) const MOST_ROWS: usize = 100_000;

keys! {
    /// Straight on, or round and round.
    struct ConstantKeys {
        /// Speed, m/s.
        speed: f64 = SPEED, or(1.0);
        /// Turn rate, rad/s, left positive.
        turn_rate: f64 = TURN_RATE, or(0.0);
    }
}

keys! {
    /// mean + amplitude · sin(rate · t) for speed and turn rate.
    struct SinusoidKeys {
        /// Mean speed, m/s.
        speed: f64 = SPEED, or(1.0);
        /// Amplitude of the speed, m/s; at most the mean.
        speed_amplitude: f64 = SPEED_CHANGE, or(0.0);
        /// Rate of the speed, rad/s.
        speed_rate: f64 = RATE, or(0.0);
        /// Mean turn rate, rad/s, left positive.
        turn_rate: f64 = TURN_RATE, or(0.0);
        /// Amplitude of the turn rate, rad/s.
        turn_rate_amplitude: f64 = TURN_RATE, or(0.0);
        /// Rate of the turn rate, rad/s.
        turn_rate_rate: f64 = RATE, or(0.0);
    }
}

keys! {
    /// A circle, by its radius or by the turn rate.
    struct CircleKeys {
        /// Speed, m/s.
        speed: f64 = number("m/s").above(0.0).up_to(100.0), or(1.0);
        /// Radius, m; or give `turn_rate`.
        radius: f64 = number("m").above(0.0), optional;
        /// Turn rate, rad/s, left positive; or give `radius`.
        turn_rate: f64 = TURN_RATE, optional;
        /// Which way round, with a radius; left where it is not said.
        direction: f64 = DIRECTION, optional;
    }
}

/// Sign of the turn rate.
const DIRECTION: Words<f64> = Words(&[("left", 1.0, "Counter-clockwise."), ("right", -1.0, "Clockwise.")]);

keys! {
    /// Figure eights, over and over, by the length of a whole one or by the time it takes.
    struct FigureEightKeys {
        /// Speed, m/s.
        speed: f64 = number("m/s").above(0.0).up_to(100.0), or(1.0);
        /// Length of one whole eight, m; or give `period`.
        length: f64 = number("m").above(0.0), optional;
        /// Time for one whole eight, s; or give `length`.
        period: f64 = number("s").above(0.0), optional;
    }
}

keys! {
    /// A smooth curve through points.
    struct WaypointsKeys {
        /// World coordinates [x, y], m; the robot starts at the first.
        points: Vec<[f64; 2]> = list(Couple(number("m"), number("m")), 2, MOST_ROWS), required;
        /// Whether the curve returns to its first point and goes on.
        closed: bool = Flag, or(false);
        /// Speed along the curve.
        speed: SpeedProfile = SpeedForm, or(SpeedProfile::Constant(1.0));
    }
}

keys! {
    /// Speed and turn rate from a table, smooth in between without overshoot, held after its last row.
    struct TableKeys {
        /// CSV file with columns t (s), v (m/s), omega (rad/s), beside the scene; or give `rows`.
        file: Vec<[f64; 3]> = ROWS_FILE, optional;
        /// Rows of [time in s, speed in m/s, turn rate in rad/s], time rising from 0; or give `file`.
        rows: Vec<[f64; 3]> = list(Triple(TIME, SPEED, TURN_RATE), 1, MOST_ROWS), optional;
    }
}

/// Keys of a path to goals: its own, and how it goes there.
macro_rules! goal_keys {
    ($(#[doc = $about:literal])* struct $name:ident { $($own:tt)* }) => {
        keys! {
            $(#[doc = $about])*
            struct $name {
                $($own)*
                /// Speed of the lead where nothing slows it, m/s.
                speed: f64 = TRAVEL_SPEED, or(0.8);
                /// How it gains speed and brakes, m/s².
                acceleration: f64 = TRAVEL_ACCELERATION, or(0.3);
                /// How far all robots stay off what stands there, m; what their safety filters keep free if left out, at least 0.25.
                clearance: f64 = CLEARANCE, optional;
                /// Of several formations those of higher priority plan first, and the others yield to them.
                priority: u32 = integer::<u32>(0, 1000), or(0);
                /// How long it waits for a way that is not there, s.
                patience: f64 = PATIENCE, or(30.0);
            }
        }

        impl $name {
            fn travel(&self) -> Option<Travel> {
                let (speed, acceleration) = (self.speed.as_ref()?.value, self.acceleration.as_ref()?.value);
                let (priority, patience) = (self.priority.as_ref()?.value, self.patience.as_ref()?.value);
                let clearance = self.clearance.as_ref().map(|found| found.value);
                Some(Travel { speed, acceleration, clearance, priority, patience })
            }
        }
    };
}

goal_keys! {
    /// To a goal, by a way that is planned for the whole formation; there it stays.
    struct GoalKeys {
        /// Where to: [x, y] in m, or [x, y, heading].
        pose: Goal = GoalForm, required;
    }
}

goal_keys! {
    /// To one goal after the other, by ways that are planned for the whole formation.
    struct TourKeys {
        /// Where to, one after the other: each [x, y] in m, or [x, y, heading].
        goals: Vec<Goal> = list(GoalForm, 1, MOST_GOALS), required;
        /// How long it stays at each, s.
        pause: f64 = TIME, or(0.0);
        /// How often it goes through all of them.
        rounds: u32 = integer::<u32>(1, 1000), or(1);
    }
}

/// Speed to goals.
const TRAVEL_SPEED: Number = number("m/s").above(0.0).up_to(100.0);
/// Acceleration to goals.
const TRAVEL_ACCELERATION: Number = number("m/s²").above(0.0).up_to(100.0);
/// How far to stay off things.
const CLEARANCE: Number = number("m").from(0.0).up_to(100.0);
/// How long to wait for a way.
const PATIENCE: Number = number("s").from(0.0).up_to(10_000.0);
/// Most goals of a tour.
const MOST_GOALS: usize = 100;

/// [x, y], or [x, y, heading].
struct GoalForm;

impl Form for GoalForm {
    type Out = Goal;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Goal> {
        if node.as_list().is_some_and(|items| items.len() == 2) {
            let position = Couple(number("m"), number("m")).read(node, reporter)?;
            return Some(Goal { position, heading: None });
        }
        let [x, y, heading] = POSE.read(node, reporter)?;
        Some(Goal { position: [x, y], heading: Some(wrap(heading)) })
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [Couple(number("m"), number("m")).schema(), POSE.schema()] })
    }
}

/// A constant speed, { distance = [[m, m/s], …] } or { time = [[s, m/s], …] }.
struct SpeedForm;

keys! {
    /// A speed that changes along the way, smooth between its rows.
    struct SpeedKeys {
        /// Rows of [distance travelled in m, speed in m/s], rising from 0; or give `time`.
        distance: Vec<[f64; 2]> = list(Couple(number("m").from(0.0), SPEED), 1, MOST_ROWS), optional;
        /// Rows of [time in s, speed in m/s], rising from 0; or give `distance`.
        time: Vec<[f64; 2]> = list(Couple(TIME, SPEED), 1, MOST_ROWS), optional;
    }
}

impl Form for SpeedForm {
    type Out = SpeedProfile;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<SpeedProfile> {
        if node.as_number().is_some() {
            return SPEED.read(node, reporter).map(SpeedProfile::Constant);
        }
        let keys = table::<SpeedKeys>().read(node, reporter)?;
        let (rows, along_time) = one_of(node, ["distance", "time"], [keys.distance, keys.time], reporter)?;
        check_rising(rows.value.iter().map(|row| row[0]), rows.span, reporter);
        // Travel stops for good where a profile over distance stands at 0.
        if !along_time && rows.value.iter().any(|row| row[1] == 0.0) {
            reporter.report(
                rows.span,
                "a speed over distance must stay above 0: the robot would never leave that point",
            );
        }
        Some(if along_time { SpeedProfile::Time(rows.value) } else { SpeedProfile::Distance(rows.value) })
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [SPEED.schema(), table::<SpeedKeys>().schema()] })
    }
}

fn constant(keys: ConstantKeys, _: &Node, _: &mut Reporter) -> Option<Path> {
    Some(Path::Constant { speed: keys.speed?.value, turn_rate: keys.turn_rate?.value })
}

fn sinusoid(keys: SinusoidKeys, _: &Node, reporter: &mut Reporter) -> Option<Path> {
    let (speed, amplitude) = (keys.speed?.value, keys.speed_amplitude?);
    if amplitude.value.abs() > speed {
        let message =
            format!("`speed_amplitude` must be at most `speed`, {speed} m/s: speeds must not be negative");
        reporter.report(amplitude.span, message);
    }
    Some(Path::Sinusoid {
        speed,
        speed_amplitude: amplitude.value,
        speed_rate: keys.speed_rate?.value,
        turn_rate: keys.turn_rate?.value,
        turn_rate_amplitude: keys.turn_rate_amplitude?.value,
        turn_rate_rate: keys.turn_rate_rate?.value,
    })
}

fn circle(keys: CircleKeys, node: &Node, reporter: &mut Reporter) -> Option<Path> {
    let speed = keys.speed?.value;
    let (size, by_turn_rate) =
        one_of(node, ["radius", "turn_rate"], [keys.radius, keys.turn_rate], reporter)?;
    if by_turn_rate && let Some(direction) = keys.direction {
        reporter
            .report(direction.span, "the sign of `turn_rate` says the direction already; left is positive");
        return None;
    }
    if size.value == 0.0 {
        reporter.report(
            size.span,
            "a circle needs a `turn_rate` other than 0; a straight line is kind `constant`",
        );
        return None;
    }
    let sign = keys.direction.map_or(1.0, |direction| direction.value);
    let turn_rate = if by_turn_rate { size.value } else { sign * speed / size.value };
    Some(Path::Circle { speed, turn_rate })
}

fn figure_eight(keys: FigureEightKeys, node: &Node, reporter: &mut Reporter) -> Option<Path> {
    let speed = keys.speed?.value;
    let (size, by_period) = one_of(node, ["length", "period"], [keys.length, keys.period], reporter)?;
    Some(Path::FigureEight { speed, length: if by_period { speed * size.value } else { size.value } })
}

fn waypoints(keys: WaypointsKeys, _: &Node, reporter: &mut Reporter) -> Option<Path> {
    let (points, closed) = (keys.points?, keys.closed?.value);
    let (span, points) = (points.span, points.value);
    if closed && points.len() < 3 {
        reporter.report(span, "a closed curve needs at least three points");
    }
    let back = if closed { points.first() } else { None };
    let next = points.iter().skip(1).chain(back);
    // Closer than this there is no telling in which direction the curve goes.
    if points.iter().zip(next).any(|(a, b)| math::hypot(a[0] - b[0], a[1] - b[1]) < 1e-3) {
        let hint = if closed && points.first() == points.last() {
            ": a closed curve returns to its first point by itself, so leave out the last point"
        } else {
            ""
        };
        reporter.report(span, format!("neighbouring points of a curve must be at least 0.001 m apart{hint}"));
    }
    Some(Path::Waypoints { points, closed, speed: keys.speed?.value })
}

fn from_table(keys: TableKeys, node: &Node, reporter: &mut Reporter) -> Option<Path> {
    let (rows, from_file) = one_of(node, ["rows", "file"], [keys.rows, keys.file], reporter)?;
    if !from_file {
        check_rising(rows.value.iter().map(|row| row[0]), rows.span, reporter);
    }
    Some(Path::Table { rows: rows.value })
}

fn goal(keys: GoalKeys, _: &Node, _: &mut Reporter) -> Option<Path> {
    Some(Path::Goal { travel: keys.travel()?, pose: keys.pose?.value })
}

fn tour(keys: TourKeys, _: &Node, _: &mut Reporter) -> Option<Path> {
    let (travel, goals) = (keys.travel()?, keys.goals?.value);
    Some(Path::Tour { goals, pause: keys.pause?.value, rounds: keys.rounds?.value, travel })
}

/// A lead robot's path.
pub(crate) const PATH: Kinds<Path> = Kinds {
    key: "kind",
    usual: None,
    all: &[
        &Kind { word: "constant", make: constant },
        &Kind { word: "sinusoid", make: sinusoid },
        &Kind { word: "circle", make: circle },
        &Kind { word: "figure-eight", make: figure_eight },
        &Kind { word: "waypoints", make: waypoints },
        &Kind { word: "table", make: from_table },
        &Kind { word: "goal", make: goal },
        &Kind { word: "tour", make: tour },
    ],
};
