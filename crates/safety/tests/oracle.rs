//! The filter against a third-party solver on random cases: optimum, feasibility, least slack, and conflicts.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use safety::{Filter, HalfPlane, Wish};
use vocabulary::{Command, Constraint, SafetyState};

/// Random numbers of SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }
}

/// min ½ x'Px + q'x over rows · x ≥ bound; P is diagonal.
fn solve(p: &[f64], q: &[f64], rows: &[(Vec<f64>, f64)]) -> Option<Vec<f64>> {
    let n = q.len();
    let diagonal: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| if i == j { p[i] } else { 0.0 }).collect()).collect();
    let a: Vec<Vec<f64>> = rows.iter().map(|(row, _)| row.iter().map(|x| -x).collect()).collect();
    let b: Vec<f64> = rows.iter().map(|(_, bound)| -bound).collect();
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-11)
        .tol_gap_rel(1e-11)
        .tol_feas(1e-11)
        .build()
        .expect("settings");
    let (p, a) = (CscMatrix::from(&diagonal), CscMatrix::from(&a));
    let mut solver =
        DefaultSolver::new(&p, q, &a, &b, &[NonnegativeConeT(b.len())], settings).expect("a problem");
    solver.solve();
    let solved = matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
    solved.then(|| solver.solution.x.clone())
}

/// The least δ ≥ 0 that leaves a command to `soft` rows lowered by δ and to `hard` ones.
fn least_slack(hard: &[HalfPlane], soft: &[HalfPlane]) -> Option<f64> {
    let row = |plane: &HalfPlane, give: f64| (vec![plane.normal[0], plane.normal[1], give], plane.bound);
    let rows: Vec<_> = hard
        .iter()
        .map(|plane| row(plane, 0.0))
        .chain(soft.iter().map(|plane| row(plane, 1.0)))
        .chain([(vec![0.0, 0.0, 1.0], 0.0)])
        .collect();
    solve(&[0.0; 3], &[0.0, 0.0, 1.0], &rows).map(|x| x[2])
}

/// The least (a − a₀)² + w² (ω − ω₀)² over the rows.
fn least_cost(goal: [f64; 2], weight: f64, rows: &[HalfPlane]) -> Option<f64> {
    let w = weight * weight;
    let rows: Vec<_> = rows.iter().map(|plane| (plane.normal.to_vec(), plane.bound)).collect();
    let x = solve(&[2.0, 2.0 * w], &[-2.0 * goal[0], -2.0 * w * goal[1]], &rows)?;
    Some(cost(goal, weight, [x[0], x[1]]))
}

fn cost(goal: [f64; 2], weight: f64, u: [f64; 2]) -> f64 {
    let (a, w) = (u[0] - goal[0], weight * (u[1] - goal[1]));
    a * a + w * w
}

fn relaxed(rows: &[HalfPlane], by: f64) -> Vec<HalfPlane> {
    rows.iter().map(|row| HalfPlane { bound: row.bound - by, ..*row }).collect()
}

/// A wish, its limits as rows, and the rows of both classes.
fn case(random: &mut Random) -> (Wish, Vec<HalfPlane>, [Vec<HalfPlane>; 2]) {
    let wish = Wish {
        command: Command { acceleration: random.within(-5.0, 5.0), turn_rate: random.within(-7.0, 7.0) },
        acceleration: [-random.within(0.5, 4.0), random.within(0.5, 3.0)],
        turn_rate: random.within(0.5, 6.0),
        speed: random.within(0.0, 1.6),
    };
    let limit = |normal, bound, constraint| HalfPlane { normal, bound, constraint, ..HalfPlane::default() };
    let limits = vec![
        limit([1.0, 0.0], wish.acceleration[0], Constraint::Braking),
        limit([-1.0, 0.0], -wish.acceleration[1], Constraint::Driving),
        limit([0.0, 1.0], -wish.turn_rate, Constraint::RightTurn),
        limit([0.0, -1.0], -wish.turn_rate, Constraint::LeftTurn),
    ];
    let views = [Constraint::ViewDistance, Constraint::ViewLeft, Constraint::ViewRight];
    let mut rows = |count: usize, name: &dyn Fn(usize) -> Constraint| -> Vec<HalfPlane> {
        (0..count)
            .map(|k| {
                let angle = random.within(0.0, std::f64::consts::TAU);
                let normal =
                    [vocabulary::math::cos(angle), random.within(0.2, 1.0) * vocabulary::math::sin(angle)];
                HalfPlane {
                    normal,
                    bound: random.within(-4.0, 1.2),
                    constraint: name(k),
                    ..HalfPlane::default()
                }
            })
            .collect()
    };
    let collisions = rows(7, &|k| Constraint::Robot(k));
    let views = rows(3, &|k| views[k]);
    let count = (random.next() * 8.0) as usize;
    (wish, limits, [collisions[..count].to_vec(), views])
}

#[derive(Default)]
struct Count {
    feasible: usize,
    infeasible: [usize; 2],
    conflicts: [usize; 4],
}

#[test]
fn ten_thousand_random_cases_agree_with_a_solver() {
    let (mut random, mut filter, mut state) = (Random(7), Filter::default(), SafetyState::default());
    let mut count = Count::default();
    for number in 0..10_000 {
        let (wish, limits, [collisions, views]) = case(&mut random);
        filter.apply(&wish, &collisions, &views, &mut state);
        let u = [state.applied.acceleration, state.applied.turn_rate];
        let goal = [wish.command.acceleration, wish.command.turn_rate];
        let weight = wish.speed.max(0.25);

        let first = least_slack(&limits, &collisions).expect("a slack of the collisions");
        assert!((state.relaxed[0] - first).abs() < 1e-6, "case {number}: {} and {first}", state.relaxed[0]);
        let hard: Vec<_> = limits.iter().copied().chain(relaxed(&collisions, state.relaxed[0])).collect();
        // A region as small as rounding is no matter for an interior-point method: it may be a little larger.
        let more = if state.relaxed[0] > 0.0 { 1e-7 } else { 0.0 };
        let near: Vec<_> =
            limits.iter().copied().chain(relaxed(&collisions, state.relaxed[0] + more)).collect();
        let second = least_slack(&near, &views).expect("a slack of the views");
        // In a sharp corner that little more is a lot more for the views.
        let tolerance = if state.relaxed[0] > 0.0 { 1e-3 } else { 1e-6 };
        assert!(state.relaxed[1] > second - 1e-6, "case {number}: {} and {second}", state.relaxed[1]);
        assert!(state.relaxed[1] < second + tolerance, "case {number}: {} and {second}", state.relaxed[1]);

        let rows: Vec<_> = hard.iter().copied().chain(relaxed(&views, state.relaxed[1])).collect();
        let worst = rows.iter().map(|row| row.slack(u)).fold(f64::INFINITY, f64::min);
        assert!(worst > -1e-7, "case {number}: a row is violated by {worst}");
        let found = cost(goal, weight, u);
        assert!((found.sqrt() - state.moved).abs() < 1e-9 * (1.0 + found), "case {number}");
        // What had to give way leaves a point, which is made large enough for the solver; else the optimum is sharp.
        let (margin, tolerance) = if state.relaxed == [0.0; 2] { (0.0, 1e-6) } else { (1e-6, 2e-3) };
        let least = least_cost(goal, weight, &relaxed(&rows, margin)).expect("an optimum");
        assert!((found - least).abs() < tolerance * (1.0 + found), "case {number}: {found} and {least}");

        match state.relaxed {
            [0.0, 0.0] => count.feasible += 1,
            [_, 0.0] => count.infeasible[0] += 1,
            _ => count.infeasible[1] += 1,
        }
        let of_views = state.relaxed[0] <= 0.0;
        if state.relaxed == [0.0; 2] {
            assert!(state.conflict.is_empty(), "case {number}");
            continue;
        }
        // The constraints in conflict leave no command; without any one of them they do.
        count.conflicts[state.conflict.len().min(3)] += 1;
        let all: Vec<_> = limits.iter().chain(&collisions).chain(&views).copied().collect();
        let among: Vec<HalfPlane> = state
            .conflict
            .iter()
            .map(|constraint| *all.iter().find(|row| row.constraint == *constraint).expect("a row"))
            .collect();
        let giving = least_slack(&[], &among).expect("a slack");
        assert!(giving > 1e-9, "case {number}: {:?} leave a command", state.conflict);
        // Two half-planes have a point in common unless they face each other.
        let [first, second] = [among[0].normal, among[1].normal];
        let parallel = (first[0] * second[1] - first[1] * second[0]).abs() < 1e-12;
        assert_eq!(among.len(), if parallel { 2 } else { 3 }, "case {number}: {:?}", state.conflict);
        for left_out in (0..among.len()).filter(|_| among.len() == 3) {
            let (a, b) = (among[(left_out + 1) % 3].normal, among[(left_out + 2) % 3].normal);
            let apart = (a[0] * b[1] - a[1] * b[0]).abs();
            assert!(apart > 1e-12, "case {number}: {:?} without {left_out}", state.conflict);
        }
        assert!(state.conflict.iter().any(|c| c.is_view() == of_views && !c.is_limit()), "case {number}");
    }
    assert!(count.feasible > 2000 && count.infeasible.iter().all(|n| *n > 500), "{:?}", count.infeasible);
    assert!(count.conflicts[3] > 1000, "{:?}", count.conflicts);
}
