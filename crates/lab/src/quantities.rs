//! Curves over time, computed from records, for plots and exports.

use crate::app_state::AppState;
use crate::session::history::History;
use formation::energy::{ObserverError, observer_energy, tracking_energy};
use formation::relative::Geometry;
use scene::Follow;
use std::collections::BTreeSet;
use std::fmt::Write;
use studies::certify::{WitnessRow, rows};
use vocabulary::math;
use vocabulary::{Edge, EdgeState, LawKind, SafetyState, Snapshot, StepRecord};

/// A plotted quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlotQuantity {
    /// Distance error, m.
    DistanceError,
    /// Bearing error, degrees.
    BearingError,
    /// Applied acceleration, m/s².
    Acceleration,
    /// Applied turn rate, rad/s.
    TurnRate,
    /// Forward speed, m/s.
    Speed,
    /// Error of the observed distance rate, m/s.
    DistanceRateError,
    /// Error of the observed bearing rate, degrees/s.
    BearingRateError,
    /// ½‖r‖², logarithm to the base of 10.
    TrackingEnergy,
    /// W of the observer, logarithm to the base of 10.
    ObserverEnergy,
    /// Least clearance between bodies, m.
    Clearance,
    /// Margin of β above the bound of Lemma 4.1, m/s².
    RobustMargin,
    /// V of eq 29: ½‖r‖² and P.
    Lyapunov,
    /// Least slack of a robot's barriers, m/s.
    Slack,
    /// How far a safety filter moved the command, m/s².
    Moved,
}

impl PlotQuantity {
    /// All quantities in the order of declaration, with their axis label and table column.
    const TABLE: [(Self, &'static str, &'static str); 14] = [
        (Self::DistanceError, "error of ℓ (m)", "distance_error_m"),
        (Self::BearingError, "error of ψ (°)", "bearing_error_deg"),
        (Self::Acceleration, "dv/dt (m/s²)", "acceleration_m_s2"),
        (Self::TurnRate, "ω (rad/s)", "turn_rate_rad_s"),
        (Self::Speed, "v (m/s)", "speed_m_s"),
        (Self::DistanceRateError, "dℓ/dt − ŝ₂ (m/s)", "distance_rate_error_m_s"),
        (Self::BearingRateError, "dψ/dt − ŝ₂ (°/s)", "bearing_rate_error_deg_s"),
        (Self::TrackingEnergy, "½‖r‖²", "log10_tracking_energy"),
        (Self::ObserverEnergy, "W", "log10_observer_energy"),
        (Self::Clearance, "clearance (m)", "clearance_m"),
        (Self::RobustMargin, "β margin (m/s²)", "beta_margin_m_s2"),
        (Self::Lyapunov, "V (eq 29)", "lyapunov_v"),
        (Self::Slack, "slack (m/s)", "least_slack_m_s"),
        (Self::Moved, "moved (m/s²)", "moved_m_s2"),
    ];

    /// All of them, in order.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::TABLE.into_iter().map(|(quantity, ..)| quantity)
    }

    /// The label of its axis: symbol and unit.
    pub fn axis(self) -> &'static str {
        Self::TABLE[self as usize].1
    }

    /// The name of its table column.
    pub fn column(self) -> &'static str {
        Self::TABLE[self as usize].2
    }

    /// Whether values are logarithms to the base of 10.
    pub fn logarithmic(self) -> bool {
        matches!(self, Self::TrackingEnergy | Self::ObserverEnergy)
    }

    /// Whether few samples may be far from all others.
    pub fn is_spiky(self) -> bool {
        !matches!(self, Self::DistanceError | Self::BearingError | Self::Clearance)
    }

    /// Whether its curve keeps every spike: on a linear axis the plot names the largest. The quantities of certificates are
    /// made of so many numbers that they have no more samples than are drawn.
    fn keeps_spikes(self) -> bool {
        self.is_spiky() && !self.logarithmic() && !matches!(self, Self::RobustMargin | Self::Lyapunov)
    }
}

/// A curve of one robot on one branch.
#[derive(Debug, Clone, PartialEq)]
pub struct QuantityCurve {
    /// The branch.
    pub branch: usize,
    /// The robot; `None` for a quantity of the whole formation.
    pub robot: Option<usize>,
    /// Time in s, value.
    pub points: Vec<[f64; 2]>,
}

/// The smallest energy that is shown; smaller values are rounding errors.
const FLOOR: f64 = 1e-18;
/// The smallest margin of β that is shown, m/s².
const LEAST_MARGIN: f64 = -20.0;

/// The curves of a quantity on all branches, the shown branch last; each of at most about `most` points.
pub fn curves(app_state: &AppState, quantity: PlotQuantity, most: usize) -> Vec<QuantityCurve> {
    let Some(history) = &app_state.history else { return Vec::new() };
    let mut all = Vec::new();
    // The past that branches share is drawn once.
    for (branch, span) in branches(app_state, history) {
        if quantity == PlotQuantity::Clearance {
            let points = history.rooms(branch, span);
            all.push(QuantityCurve { branch, robot: None, points });
            continue;
        }
        let whole = quantity.keeps_spikes();
        let records = history.between(branch, span, if whole { usize::MAX } else { most });
        if let Some(value) = filtered(quantity) {
            all.extend(filter_curves(branch, &records, value, most));
            continue;
        }
        for (edge, ends) in history.fleet().edges.iter().enumerate() {
            let Some((_, _, follow)) = app_state.follower(edge) else { continue };
            let point = |m: &&StepRecord| {
                let ends = m.edge(history.fleet(), edge)?;
                Some([m.snapshot.time, value(quantity, m, edge, ends, follow)?])
            };
            let points = certified(quantity, &records, edge, *ends, follow)
                .unwrap_or_else(|| records.iter().filter_map(point).collect());
            let points = if whole { with_extremes(&points, most) } else { points };
            all.push(QuantityCurve { branch, robot: Some(ends.follower), points });
        }
        if quantity == PlotQuantity::Speed {
            for (robot, _) in history.fleet().robots.iter().enumerate().filter(|(_, member)| member.leads) {
                let speed =
                    |m: &&StepRecord| Some([m.snapshot.time, m.snapshot.robots.get(robot)?.motion.speed]);
                let points = with_extremes(&records.iter().filter_map(speed).collect::<Vec<_>>(), most);
                all.push(QuantityCurve { branch, robot: Some(robot), points });
            }
        }
    }
    all
}

/// A quantity of a safety filter; `None` for other quantities.
fn filtered(quantity: PlotQuantity) -> Option<fn(&SafetyState) -> Option<f64>> {
    match quantity {
        PlotQuantity::Slack => Some(SafetyState::least_slack),
        PlotQuantity::Moved => Some(|state| Some(state.moved)),
        _ => None,
    }
}

/// Curves of a quantity of every robot that has a filter; a new one after every stretch in which it has no value.
fn filter_curves(
    branch: usize,
    records: &[&StepRecord],
    value: fn(&SafetyState) -> Option<f64>,
    most: usize,
) -> Vec<QuantityCurve> {
    let robots: BTreeSet<usize> =
        records.iter().flat_map(|record| &record.safety).map(|state| state.robot).collect();
    let mut all = Vec::new();
    for robot in robots {
        let point = |record: &&StepRecord| {
            let state = record.safety.iter().find(|state| state.robot == robot)?;
            Some([record.snapshot.time, value(state)?])
        };
        let points: Vec<_> = records.iter().map(point).collect();
        all.extend(stretches(branch, robot, &points, most));
    }
    all
}

/// Names and units of what the custom law of the selected follower carries and shows at the shown time.
pub fn signal_names(app_state: &AppState) -> Vec<(String, String)> {
    let robot = app_state.tuned_follower().map(|(_, robot, ..)| robot);
    let record = app_state.record();
    let law = record.and_then(|record| record.laws.iter().find(|law| Some(law.robot) == robot).cloned());
    law.map_or_else(Vec::new, |law| {
        law.quantities.iter().map(|own| (own.name.clone(), own.unit.clone())).collect()
    })
}

/// The curves of what custom laws call `name`, robot by robot, on all branches.
pub fn signal_curves(app_state: &AppState, name: &str, most: usize) -> Vec<QuantityCurve> {
    let Some(history) = &app_state.history else { return Vec::new() };
    let mut all = Vec::new();
    for (branch, span) in branches(app_state, history) {
        let records = history.between(branch, span, usize::MAX);
        let robots: BTreeSet<usize> =
            records.iter().flat_map(|record| &record.laws).map(|law| law.robot).collect();
        for robot in robots {
            let point = |record: &&StepRecord| {
                let law = record.laws.iter().find(|law| law.robot == robot)?;
                law.value(name).filter(|value| value.is_finite()).map(|value| [record.snapshot.time, value])
            };
            let points: Vec<_> = records.iter().map(point).collect();
            all.extend(stretches(branch, robot, &points, most));
        }
    }
    all
}

/// About `most` of the points of a curve, the least and the largest value of every stretch among them.
fn with_extremes(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    // Whole multiples of the step, so that curves do not jitter as they grow.
    let step = (2 * points.len()).div_ceil(most.max(2)).next_power_of_two();
    if step <= 2 {
        return points.to_vec();
    }
    let ends = |stretch: &[[f64; 2]]| {
        let by = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let mut ends = [stretch.iter().min_by(by), stretch.iter().max_by(by)];
        ends.sort_by(|a, b| a.map_or(0.0, |p| p[0]).total_cmp(&b.map_or(0.0, |p| p[0])));
        ends.into_iter().flatten().copied().collect::<Vec<_>>()
    };
    let mut kept: Vec<_> = points.chunks(step).flat_map(ends).collect();
    kept.dedup();
    // The curve reaches to where it is now.
    kept.extend(points.last().filter(|last| kept.last() != Some(last)));
    kept
}

/// Branches, the shown one last, each with the span of time that it does not share with the one it left, s.
fn branches(app_state: &AppState, history: &History) -> Vec<(usize, [f64; 2])> {
    let others = (0..history.branches()).filter(|branch| *branch != app_state.branch);
    let span = |branch: usize| {
        let own = app_state.branches.get(branch).filter(|_| branch != app_state.branch);
        (branch, [own.and_then(|own| own.parent).map_or(0.0, |(_, time)| time), f64::INFINITY])
    };
    others.chain([app_state.branch]).map(span).collect()
}

/// A curve for every stretch in which there is a value; all together have about `most` points.
fn stretches(
    branch: usize,
    robot: usize,
    points: &[Option<[f64; 2]>],
    most: usize,
) -> impl Iterator<Item = QuantityCurve> {
    let all = points.split(Option::is_none).filter(|stretch| !stretch.is_empty());
    let count = points.len();
    all.map(move |stretch| {
        let own: Vec<[f64; 2]> = stretch.iter().flatten().copied().collect();
        let share = (most * own.len()).div_ceil(count);
        QuantityCurve { branch, robot: Some(robot), points: with_extremes(&own, share) }
    })
}

/// Curves of quantities that depend on the whole run and need all records. `None` for other quantities.
fn certified(
    quantity: PlotQuantity,
    records: &[&StepRecord],
    index: usize,
    edge: Edge,
    follow: &Follow,
) -> Option<Vec<[f64; 2]>> {
    let value: fn(&WitnessRow) -> f64 = match quantity {
        // The first samples would flatten everything after them.
        PlotQuantity::RobustMargin => |row| row.margin.max(LEAST_MARGIN),
        PlotQuantity::Lyapunov => |row| row.v,
        _ => return None,
    };
    let rows = if is_robust(follow) { rows(records, index, edge, follow) } else { vec![] };
    Some(rows.iter().map(|row| [row.time, value(row)]).filter(|p| p[1].is_finite()).collect())
}

/// Whether a follower's law has a switching term.
fn is_robust(follow: &Follow) -> bool {
    follow.law.built_in().is_some_and(|kind| kind != LawKind::FullState)
}

/// A quantity of an edge in a record; `None` if it is not defined.
fn value(
    quantity: PlotQuantity,
    record: &StepRecord,
    index: usize,
    edge: Edge,
    follow: &Follow,
) -> Option<f64> {
    let state = record.edges.get(index)?;
    let rates = || true_rates(&record.snapshot, edge, state, follow.law.distance_min);
    let observes = follow.law.observes();
    let value = match quantity {
        PlotQuantity::DistanceError => state.error[0],
        PlotQuantity::BearingError => state.error[1].to_degrees(),
        PlotQuantity::Acceleration => state.applied.acceleration,
        PlotQuantity::TurnRate => state.applied.turn_rate,
        PlotQuantity::Speed => record.snapshot.robots.get(edge.follower)?.motion.speed,
        PlotQuantity::DistanceRateError => rates()?[0] - state.rates[0],
        PlotQuantity::BearingRateError => (rates()?[1] - state.rates[1]).to_degrees(),
        PlotQuantity::TrackingEnergy => {
            let rates = rates()?;
            math::log10(tracking_energy(state.error, [-rates[0], -rates[1]], follow.law.k).max(FLOOR))
        }
        PlotQuantity::ObserverEnergy if observes => {
            let rates = rates()?;
            let seen = [state.relative.distance, state.relative.bearing];
            let error = ObserverError {
                output: [seen[0] - state.estimate[0], seen[1] - state.estimate[1]],
                rates: [rates[0] - state.rates[0], rates[1] - state.rates[1]],
                epsilon: follow.observer.epsilon,
                alpha1: follow.observer.alpha1,
                alpha2: follow.observer.alpha2,
            };
            math::log10(observer_energy(&error).max(FLOOR))
        }
        PlotQuantity::ObserverEnergy
        | PlotQuantity::Clearance
        | PlotQuantity::RobustMargin
        | PlotQuantity::Lyapunov
        | PlotQuantity::Slack
        | PlotQuantity::Moved => {
            return None;
        }
    };
    value.is_finite().then_some(value)
}

/// The true ds/dt (eq 7).
fn true_rates(snapshot: &Snapshot, edge: Edge, state: &EdgeState, distance_min: f64) -> Option<[f64; 2]> {
    let (leader, follower) =
        (snapshot.robots.get(edge.leader)?.motion, snapshot.robots.get(edge.follower)?.motion);
    let geometry = Geometry::new(&state.relative, distance_min);
    Some(geometry.rates(follower.speed, leader.speed, leader.turn_rate).into())
}

/// Bounds of a quantity for the selected follower, drawn as dashed lines.
pub fn bounds(app_state: &AppState, quantity: PlotQuantity) -> Vec<f64> {
    let robot = app_state.chosen_robot().or_else(|| app_state.follower(0).map(|(robot, ..)| robot));
    let vehicle = robot.and_then(|robot| Some(app_state.scene_now()?.robots.get(robot)?.vehicle));
    let Some(vehicle) = vehicle else { return Vec::new() };
    let both = |most: f64| vec![-most, most];
    let mut bounds = match quantity {
        PlotQuantity::Acceleration => both(vehicle.acceleration_max),
        PlotQuantity::TurnRate => both(vehicle.turn_rate_max),
        PlotQuantity::Speed => vec![vehicle.speed_min, vehicle.speed_max],
        PlotQuantity::Clearance | PlotQuantity::RobustMargin | PlotQuantity::Slack => vec![0.0],
        _ => Vec::new(),
    };
    bounds.retain(|bound| bound.is_finite());
    bounds
}

/// The curves as a tidy table: branch, robot, quantity, time, value.
pub fn csv(app_state: &AppState) -> String {
    let mut text = String::from("branch,robot,quantity,time_s,value\n");
    let quoted = |name: &str| {
        if name.contains([',', '"', '\n']) {
            format!("\"{}\"", name.replace('"', "\"\""))
        } else {
            name.to_owned()
        }
    };
    for quantity in PlotQuantity::all() {
        for curve in curves(app_state, quantity, usize::MAX) {
            let branch = app_state.branches.get(curve.branch).map_or("", |b| &b.name);
            let robot =
                curve.robot.and_then(|robot| app_state.fleet()?.robots.get(robot)).map_or("", |m| &m.name);
            let head = format!("{},{},{}", quoted(branch), quoted(robot), quantity.column());
            for [time, value] in curve.points {
                // Writing to a string cannot fail.
                let _ = writeln!(text, "{head},{time:.6},{value:e}");
            }
        }
    }
    text
}

/// The curves as an SVG figure.
pub fn svg(app_state: &AppState) -> String {
    use figures::{Axis, Figure, Guide, Panel, Series};
    let fleet = app_state.fleet();
    let colours = fleet.map(|fleet| rendering::robot_colours(fleet)).unwrap_or_default();
    let shown = [
        PlotQuantity::DistanceError,
        PlotQuantity::BearingError,
        PlotQuantity::Acceleration,
        PlotQuantity::TurnRate,
        PlotQuantity::Speed,
        PlotQuantity::Clearance,
    ];
    let panels = shown.into_iter().map(|quantity| {
        let series = curves(app_state, quantity, 600).into_iter().map(|curve| {
            let name = curve.robot.and_then(|r| fleet?.robots.get(r)).map_or("all", |m| &m.name);
            let active = curve.branch == app_state.branch;
            let branch = app_state.branches.get(curve.branch).map_or("", |b| &b.name);
            Series {
                name: if active { name.to_owned() } else { format!("{name}, {branch}") },
                colour: curve.robot.and_then(|r| colours.get(r).copied()).unwrap_or([0.3; 3]),
                stroke: if active { figures::Stroke::Solid } else { figures::Stroke::Dashed },
                points: curve.points,
                ..Series::default()
            }
        });
        let axis = Axis { label: quantity.axis().to_owned(), ..Axis::default() };
        let guides =
            bounds(app_state, quantity).into_iter().map(|at| Guide::Level(at, String::new())).collect();
        Panel { axis, series: series.collect(), guides }
    });
    Figure {
        title: app_state.scene().map_or_else(String::new, |scene| scene.title.clone()),
        axis: Axis { label: "time (s)".to_owned(), ..Axis::default() },
        panels: panels.collect(),
        ..Figure::default()
    }
    .svg()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_curve_keeps_its_spikes_and_its_end() {
        let wave = |k: usize| [0.01 * k as f64, if k == 3 { 11.1 } else { (k % 7) as f64 }];
        for count in [0, 1, 150, 1500, 7900, 20_001] {
            let points: Vec<[f64; 2]> = (0..count).map(wave).collect();
            let kept = with_extremes(&points, 400);
            assert!(kept.len() <= 401, "{count}: {}", kept.len());
            assert!(count <= 3 || kept.contains(&wave(3)), "{count}");
            assert_eq!(kept.last(), points.last());
            assert!(kept.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{count}: in the order of time");
        }
    }
}
