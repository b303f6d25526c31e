//! Curves over time: what is plotted and what is exported, made of moments in one place.

use crate::desk::Desk;
use crate::session::history::History;
use formation::energy::{ObserverError, observer_energy, tracking_energy};
use formation::relative::Geometry;
use scene::{Follow, LawKind};
use std::fmt::Write;
use studies::certify::{Row, rows};
use vocabulary::{Edge, EdgeState, Snapshot, StepRecord};

/// What a plot shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Error of the distance, m.
    DistanceError,
    /// Error of the bearing, degrees.
    BearingError,
    /// Acceleration that was applied, m/s².
    Acceleration,
    /// Turn rate that was applied, rad/s.
    TurnRate,
    /// Forward speed, m/s.
    Speed,
    /// What the observer is off in the rate of the distance, m/s.
    DistanceRateError,
    /// What the observer is off in the rate of the bearing, degrees/s.
    BearingRateError,
    /// ½‖r‖², logarithm to the base of 10.
    TrackingEnergy,
    /// W of the observer, logarithm to the base of 10.
    ObserverEnergy,
    /// Least room between bodies, m.
    Clearance,
    /// By how much β is above what Lemma 4.1 asks for, m/s².
    RobustMargin,
    /// V of eq 29: ½‖r‖² and P.
    Lyapunov,
}

impl Quantity {
    /// All of them, in the order of the panels.
    pub const ALL: [Self; 12] = [
        Self::DistanceError,
        Self::BearingError,
        Self::Acceleration,
        Self::TurnRate,
        Self::Speed,
        Self::DistanceRateError,
        Self::BearingRateError,
        Self::TrackingEnergy,
        Self::ObserverEnergy,
        Self::Clearance,
        Self::RobustMargin,
        Self::Lyapunov,
    ];

    /// For an axis: symbol and unit.
    pub fn axis(self) -> &'static str {
        match self {
            Self::DistanceError => "error of ℓ (m)",
            Self::BearingError => "error of ψ (°)",
            Self::Acceleration => "dv/dt (m/s²)",
            Self::TurnRate => "ω (rad/s)",
            Self::Speed => "v (m/s)",
            Self::DistanceRateError => "dℓ/dt − ŝ₂ (m/s)",
            Self::BearingRateError => "dψ/dt − ŝ₂ (°/s)",
            Self::TrackingEnergy => "½‖r‖²",
            Self::ObserverEnergy => "W",
            Self::Clearance => "room (m)",
            Self::RobustMargin => "margin of β (m/s²)",
            Self::Lyapunov => "V (eq 29)",
        }
    }

    /// For a column of a table.
    pub fn column(self) -> &'static str {
        match self {
            Self::DistanceError => "distance_error_m",
            Self::BearingError => "bearing_error_deg",
            Self::Acceleration => "acceleration_m_s2",
            Self::TurnRate => "turn_rate_rad_s",
            Self::Speed => "speed_m_s",
            Self::DistanceRateError => "distance_rate_error_m_s",
            Self::BearingRateError => "bearing_rate_error_deg_s",
            Self::TrackingEnergy => "log10_tracking_energy",
            Self::ObserverEnergy => "log10_observer_energy",
            Self::Clearance => "clearance_m",
            Self::RobustMargin => "beta_margin_m_s2",
            Self::Lyapunov => "lyapunov_v",
        }
    }

    /// Whether values are logarithms to the base of 10.
    pub fn logarithmic(self) -> bool {
        matches!(self, Self::TrackingEnergy | Self::ObserverEnergy)
    }
}

/// A curve of one robot on one branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The branch.
    pub branch: usize,
    /// The robot; `None` for what belongs to all.
    pub robot: Option<usize>,
    /// Time in s, value.
    pub points: Vec<[f64; 2]>,
}

/// The smallest energy that is shown: rounding is below it.
const FLOOR: f64 = 1e-18;
/// The least margin of β that is shown, m/s².
const LEAST_MARGIN: f64 = -20.0;

/// The curves of a quantity in a span of time, of all branches, the one that is looked at last.
pub fn curves(desk: &Desk, quantity: Quantity, span: [f64; 2], most: usize) -> Vec<Curve> {
    let Some(history) = &desk.history else { return Vec::new() };
    let mut order: Vec<usize> = (0..history.branches()).filter(|b| *b != desk.branch).collect();
    order.push(desk.branch);
    let mut all = Vec::new();
    for branch in order {
        // What a branch shares with the one that is looked at is drawn once.
        let own = desk.branches.get(branch).and_then(|b| b.parent).map_or(span[0], |(_, time)| time);
        let from = if branch == desk.branch { span[0] } else { own.max(span[0]) };
        if quantity == Quantity::Clearance {
            let points = history.rooms(branch, [from, span[1]]);
            all.push(Curve { branch, robot: None, points });
            continue;
        }
        let records = history.between(branch, [from, span[1]], most);
        for (edge, ends) in history.fleet().edges.iter().enumerate() {
            let Some((_, _, follow)) = desk.follower(edge) else { continue };
            if let Some(points) = certified(quantity, &records, (edge, *ends), follow) {
                all.push(Curve { branch, robot: Some(ends.follower), points });
                continue;
            }
            let point = |m: &&StepRecord| Some([m.snapshot.time, value(quantity, m, (edge, *ends), follow)?]);
            let points = records.iter().filter_map(point).collect();
            all.push(Curve { branch, robot: Some(ends.follower), points });
        }
        if quantity == Quantity::Speed {
            for (robot, _) in history.fleet().robots.iter().enumerate().filter(|(_, member)| member.leads) {
                let speed =
                    |m: &&StepRecord| Some([m.snapshot.time, m.snapshot.robots.get(robot)?.motion.speed]);
                all.push(Curve {
                    branch,
                    robot: Some(robot),
                    points: records.iter().filter_map(speed).collect(),
                });
            }
        }
    }
    all
}

/// Quantities that go by how a run came to be: they need all moments. `None` for others.
fn certified(
    quantity: Quantity,
    records: &[&StepRecord],
    edge: (usize, Edge),
    follow: &Follow,
) -> Option<Vec<[f64; 2]>> {
    let value: fn(&Row) -> f64 = match quantity {
        // What the first samples ask for would flatten all that follows.
        Quantity::RobustMargin => |row| row.margin.max(LEAST_MARGIN),
        Quantity::Lyapunov => |row| row.v,
        _ => return None,
    };
    let rows =
        if follow.law.kind == LawKind::FullState { vec![] } else { rows(records, edge.0, edge.1, follow) };
    Some(rows.iter().map(|row| [row.time, value(row)]).filter(|p| p[1].is_finite()).collect())
}

/// A quantity of an edge at a moment; `None` where there is none.
fn value(
    quantity: Quantity,
    record: &StepRecord,
    (index, edge): (usize, Edge),
    follow: &Follow,
) -> Option<f64> {
    let state = record.edges.get(index)?;
    let rates = || true_rates(&record.snapshot, edge, state, follow.law.distance_min);
    let observes = follow.law.kind == LawKind::OutputFeedback;
    let value = match quantity {
        Quantity::DistanceError => state.error[0],
        Quantity::BearingError => state.error[1].to_degrees(),
        Quantity::Acceleration => state.applied.acceleration,
        Quantity::TurnRate => state.applied.turn_rate,
        Quantity::Speed => record.snapshot.robots.get(edge.follower)?.motion.speed,
        Quantity::DistanceRateError => rates()?[0] - state.rates[0],
        Quantity::BearingRateError => (rates()?[1] - state.rates[1]).to_degrees(),
        Quantity::TrackingEnergy => {
            let rates = rates()?;
            tracking_energy(state.error, [-rates[0], -rates[1]], follow.law.k).max(FLOOR).log10()
        }
        Quantity::ObserverEnergy if observes => {
            let rates = rates()?;
            let seen = [state.relative.distance, state.relative.bearing];
            let error = ObserverError {
                output: [seen[0] - state.estimate[0], seen[1] - state.estimate[1]],
                rates: [rates[0] - state.rates[0], rates[1] - state.rates[1]],
                epsilon: follow.observer.epsilon,
                alpha1: follow.observer.alpha1,
                alpha2: follow.observer.alpha2,
            };
            observer_energy(&error).max(FLOOR).log10()
        }
        Quantity::ObserverEnergy | Quantity::Clearance | Quantity::RobustMargin | Quantity::Lyapunov => {
            return None;
        }
    };
    value.is_finite().then_some(value)
}

/// ds/dt as it truly is (eq 7).
fn true_rates(snapshot: &Snapshot, edge: Edge, state: &EdgeState, distance_min: f64) -> Option<[f64; 2]> {
    let (leader, follower) =
        (snapshot.robots.get(edge.leader)?.motion, snapshot.robots.get(edge.follower)?.motion);
    let geometry = Geometry::new(&state.relative, distance_min);
    Some(geometry.rates(follower.speed, leader.speed, leader.turn_rate).into())
}

/// Bounds of a quantity, of the follower that is selected, for grey lines.
pub fn bounds(desk: &Desk, quantity: Quantity) -> Vec<f64> {
    let robot = desk.chosen_robot().or_else(|| desk.follower(0).map(|(robot, ..)| robot));
    let vehicle = robot.and_then(|robot| Some(desk.scene_now()?.robots.get(robot)?.vehicle));
    let Some(vehicle) = vehicle else { return Vec::new() };
    let both = |most: f64| vec![-most, most];
    let mut bounds = match quantity {
        Quantity::Acceleration => both(vehicle.acceleration_max),
        Quantity::TurnRate => both(vehicle.turn_rate_max),
        Quantity::Speed => vec![vehicle.speed_min, vehicle.speed_max],
        Quantity::Clearance | Quantity::RobustMargin => vec![0.0],
        _ => Vec::new(),
    };
    bounds.retain(|bound| bound.is_finite());
    bounds
}

/// The curves as a tidy table: branch, robot, quantity, time, value.
pub fn csv(desk: &Desk) -> String {
    let mut text = String::from("branch,robot,quantity,time_s,value\n");
    let quoted = |name: &str| {
        if name.contains([',', '"', '\n']) {
            format!("\"{}\"", name.replace('"', "\"\""))
        } else {
            name.to_owned()
        }
    };
    for quantity in Quantity::ALL {
        for curve in curves(desk, quantity, [0.0, f64::INFINITY], usize::MAX) {
            let branch = desk.branches.get(curve.branch).map_or("", |b| &b.name);
            let fleet = desk.history.as_ref().map(History::fleet);
            let robot = curve.robot.and_then(|robot| fleet?.robots.get(robot)).map_or("", |m| &m.name);
            let head = format!("{},{},{}", quoted(branch), quoted(robot), quantity.column());
            for [time, value] in curve.points {
                // Writing to a text cannot fail.
                let _ = writeln!(text, "{head},{time:.6},{value:e}");
            }
        }
    }
    text
}

/// The curves as a figure for print.
pub fn svg(desk: &Desk) -> String {
    use figures::{Axis, Figure, Guide, Panel, Series};
    let fleet = desk.history.as_ref().map(|history| history.fleet().clone());
    let colours = fleet.as_ref().map(|fleet| rendering::robot_colours(fleet)).unwrap_or_default();
    let shown = [
        Quantity::DistanceError,
        Quantity::BearingError,
        Quantity::Acceleration,
        Quantity::TurnRate,
        Quantity::Speed,
        Quantity::Clearance,
    ];
    let panels = shown.into_iter().map(|quantity| {
        let series = curves(desk, quantity, [0.0, f64::INFINITY], 600).into_iter().map(|curve| {
            let name = curve.robot.and_then(|r| fleet.as_ref()?.robots.get(r)).map_or("all", |m| &m.name);
            let active = curve.branch == desk.branch;
            let branch = desk.branches.get(curve.branch).map_or("", |b| &b.name);
            Series {
                name: if active { name.to_owned() } else { format!("{name}, {branch}") },
                colour: curve.robot.and_then(|r| colours.get(r).copied()).unwrap_or([0.3; 3]),
                stroke: if active { figures::Stroke::Solid } else { figures::Stroke::Dashed },
                points: curve.points,
                ..Series::default()
            }
        });
        let axis = Axis { label: quantity.axis().to_owned(), ..Axis::default() };
        let guides = bounds(desk, quantity).into_iter().map(|at| Guide::Level(at, String::new())).collect();
        Panel { axis, series: series.collect(), guides }
    });
    Figure {
        title: desk.scene().map_or_else(String::new, |scene| scene.title.clone()),
        axis: Axis { label: "time (s)".to_owned(), ..Axis::default() },
        panels: panels.collect(),
        ..Figure::default()
    }
    .svg()
}
