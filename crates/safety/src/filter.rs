//! The filter: limits cut by barriers class by class, and a wish projected onto what is left.

use crate::half_plane::{HalfPlane, cross};
use crate::polygon::Polygon;
use vocabulary::{BarrierState, Command, Constraint, SafetyState};

/// What a robot is to do, and what it can.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// Decided by its law.
    pub command: Command,
    /// [least, most] acceleration, m/s².
    pub acceleration: [f64; 2],
    /// Largest |turn rate|, rad/s.
    pub turn_rate: f64,
    /// Its speed, m/s: a turn rate counts as what it does to the velocity.
    pub speed: f64,
}

/// The filter's workspace, which one robot after the other may use.
#[derive(Debug, Clone, Default)]
pub struct Filter {
    /// Limits, then the barriers that cut them; bounds as they were relaxed.
    rows: Vec<HalfPlane>,
    polygon: Polygon,
    start: Polygon,
}

/// A turn rate counts as if the robot drove at this speed at least, m/s.
const SLOWEST: f64 = 0.25;
/// Rounding: what a class that gives way gives more than it needs to, in the unit of its rows.
const GIVE: f64 = 1e-9;
/// Conflicts that are solved in a class before it gives way by more than it needs to; two or three are usual.
const MOST_CONFLICTS: usize = 64;

impl Filter {
    /// Writes into `out` the command nearest to the wish that keeps within the limits and all of `collisions` and
    /// `views`. Where there is none, the views give way, and where that is not enough the collisions, each class by the
    /// least common slack that leaves a command.
    pub fn apply(
        &mut self,
        wish: &Wish,
        collisions: &[HalfPlane],
        views: &[HalfPlane],
        out: &mut SafetyState,
    ) {
        let limits = [wish.acceleration, [-wish.turn_rate, wish.turn_rate]];
        self.rows.clear();
        self.rows.extend(limits_of(limits));
        self.polygon.set_box(limits);
        out.wished = wish.command;
        out.acting.clear();
        out.conflict.clear();
        out.barriers.clear();
        for (class, rows) in [collisions, views].into_iter().enumerate() {
            let first = self.rows.len();
            self.rows.extend(rows.iter().filter(|row| !row.holds_in(limits)));
            out.relaxed[class] = self.cut_class(first, &mut out.conflict);
        }
        let weight = wish.speed.abs().max(SLOWEST);
        let asked = [wish.command.acceleration, wish.command.turn_rate];
        let (u, moved, edges) = self.polygon.project(asked, weight);
        out.applied = Command { acceleration: u[0], turn_rate: u[1] };
        out.moved = moved;
        out.acting.extend(edges.into_iter().flatten().map(|edge| self.rows[edge].constraint));
        tell_barriers([collisions, views], limits, u, &mut out.barriers);
    }

    /// Cuts the polygon by the rows from `first` on, relaxed by their least common slack, which is returned; `conflict` is
    /// what needs it, unless it tells of another class.
    fn cut_class(&mut self, first: usize, conflict: &mut Vec<Constraint>) -> f64 {
        let Self { rows, polygon, start } = self;
        start.copy_from(polygon);
        let (mut relax, mut give) = (0.0, GIVE);
        // A conflict of collisions is told before one of the view.
        let told = conflict.is_empty();
        for _ in 0..MOST_CONFLICTS {
            let mut cuts = (first..rows.len()).map(|row| (row, polygon.cut(&rows[row], relax, row)));
            let Some((row, edges)) = cuts.find_map(|(row, cut)| cut.err().map(|edges| (row, edges))) else {
                break;
            };
            let Conflict { needed, rows: among } = Conflict::of([row, edges[0], edges[1]], rows, first);
            // Each conflict needs more than the last, so that the last one tells what all together need.
            if needed + GIVE > relax {
                relax = needed + GIVE;
                if told {
                    conflict.clear();
                    conflict.extend(among.into_iter().flatten().map(|row| rows[row].constraint));
                }
            } else {
                // Rounding has hidden the conflict.
                relax += give;
                give *= 4.0;
            }
            polygon.copy_from(start);
        }
        for row in &mut rows[first..] {
            row.bound -= relax;
        }
        relax
    }
}

/// The barriers that forbid some command within the limits, the tightest first, and the room that `u` leaves of them.
fn tell_barriers(
    classes: [&[HalfPlane]; 2],
    limits: [[f64; 2]; 2],
    u: [f64; 2],
    barriers: &mut Vec<BarrierState>,
) {
    let cutting = classes.into_iter().flatten().filter(|row| !row.holds_in(limits));
    barriers.extend(cutting.map(|row| BarrierState {
        constraint: row.constraint,
        value: row.value,
        slack: row.slack(u),
        direction: row.direction,
    }));
    barriers.sort_by(|a, b| a.slack.total_cmp(&b.slack).then_with(|| a.constraint.cmp(&b.constraint)));
}

/// The sides of a box as half-planes, in the order of [`Polygon::set_box`].
fn limits_of([[a0, a1], [w0, w1]]: [[f64; 2]; 2]) -> [HalfPlane; 4] {
    [
        ([1.0, 0.0], a0, Constraint::Braking),
        ([0.0, 1.0], w0, Constraint::RightTurn),
        ([-1.0, 0.0], -a1, Constraint::Driving),
        ([0.0, -1.0], -w1, Constraint::LeftTurn),
    ]
    .map(|(normal, bound, constraint)| HalfPlane {
        normal,
        bound,
        constraint,
        value: 0.0,
        direction: 0.0,
    })
}

/// Up to three constraints that leave no command between them.
struct Conflict {
    /// What those of them that may give way have to give, so that they leave one.
    needed: f64,
    rows: [Option<usize>; 3],
}

impl Conflict {
    /// The conflict of three constraints, of which those from `first` on may give way.
    ///
    /// By Farkas' lemma there are weights λ ≥ 0 with Σ λ n = 0 and Σ λ b > 0. In the plane these are the cross products of
    /// the other two normals, and the slack that ends the conflict is Σ λ b over the weights of those that give way. A
    /// constraint without weight takes no part in it.
    fn of(among: [usize; 3], rows: &[HalfPlane], first: usize) -> Self {
        let normals = among.map(|row| rows[row].normal);
        let lever = |i: usize| cross(normals[(i + 1) % 3], normals[(i + 2) % 3]);
        let mut weights = [lever(0), lever(1), lever(2)];
        let sum: f64 = weights.iter().sum();
        if sum < 0.0 {
            weights = weights.map(|weight| -weight);
        }
        let size = weights.iter().fold(0.0, |most: f64, weight| most.max(weight.abs()));
        let share = |test: &dyn Fn(usize) -> f64| -> f64 { (0..3).map(|i| weights[i] * test(i)).sum() };
        let giving = share(&|i| if among[i] >= first { 1.0 } else { 0.0 });
        let needed = share(&|i| rows[among[i]].bound) / giving;
        let rows = [0, 1, 2].map(|i| (weights[i] > 1e-9 * size).then_some(among[i]));
        Self { needed: if needed.is_finite() { needed } else { 0.0 }, rows }
    }
}
