//! A run by robots that do anything, recorded.

use recording::log::Roll;
use recording::{Manifest, Recorder, RunOptions, Status};
use std::path::Path;
use std::sync::Arc;
use vocabulary::Judging;
use vocabulary::{
    BarrierState, Body, Condition, Constraint, Contact, Edge, EdgeState, EntityId, EventKind, EventRecord,
    FleetInfo, LawQuantity, LawState, MeasurementRecord, Mobility, Outcome, Placement, PlannedPath,
    PlannedPoint, Pose, Prop, Refusal, RobotInfo, RobotState, SafetyState, Shell, Snapshot, Solid,
    StepRecord, Terrain, TourGoal, TrackingState, Word,
};

/// Numbers without rule, special ones among them (SplitMix64).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn whole(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    pub(crate) fn below(&mut self, end: usize) -> usize {
        (self.whole() % end as u64) as usize
    }

    fn next(&mut self) -> f64 {
        const SPECIAL: [f64; 6] =
            [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::MIN_POSITIVE / 3.0, f64::MAX];
        match self.below(8) {
            0 => SPECIAL[self.below(6)],
            _ => f64::from_bits(self.whole() & !(1 << 62)),
        }
    }

    fn many<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.next())
    }
}

pub(crate) fn fleet() -> FleetInfo {
    let member = |name: &str, leads| RobotInfo {
        shell: Some(Shell::PAPER.tagged(3)),
        ..RobotInfo::new(name, leads, Body::default())
    };
    let solids = [
        Solid::Block { size: [1.0, 0.5, 0.3] },
        Solid::Wedge { size: [2.0, 1.0, 0.2] },
        Solid::Cylinder { radius: 0.2, height: 1.0 },
        Solid::Cone { radius: 0.1, height: 0.4 },
    ];
    let prop = |(k, solid): (usize, Solid)| Prop {
        name: format!("thing-{k}"),
        solid,
        placement: Placement { position: [k as f64, 0.0, 0.1], ..Placement::default() },
        mobility: [Mobility::Fixed, Mobility::Loose, Mobility::Guided][k % 3],
    };
    let heights = (0..12).map(f64::from).collect();
    FleetInfo {
        title: "a title — with signs".into(),
        caption: "K = 5".into(),
        duration: 30.0,
        robots: vec![
            member("ann", true),
            RobotInfo { shell: None, ..member("bob", false) },
            member("cy", false),
        ],
        edges: vec![Edge { leader: 0, follower: 1 }, Edge { leader: 1, follower: 2 }],
        free: vec![[false, true], [false, false]],
        has_sensors: true,
        has_safety: true,
        has_laws: true,
        has_events: true,
        has_plans: true,
        props: solids.into_iter().enumerate().map(prop).collect(),
        terrain: Some(Arc::new(Terrain {
            origin: [-1.0, 2.0],
            cell: 0.5,
            columns: 4,
            rows: 3,
            heights,
            grip: vec![],
        })),
        ..FleetInfo::default()
    }
}

pub(crate) fn step_record(fleet: &FleetInfo, k: u32, n: &mut Numbers) -> StepRecord {
    let mut robot = RobotState::default();
    let robots = fleet.robots.iter().map(|_| {
        [robot.motion.pose.x, robot.motion.pose.y, robot.motion.pose.heading] = n.many();
        [robot.motion.speed, robot.motion.acceleration, robot.motion.turn_rate] = n.many();
        [robot.attitude.height, robot.attitude.roll, robot.attitude.pitch, robot.camera_pan] = n.many();
        for wheel in &mut robot.wheels {
            [wheel.rotation, wheel.steering, wheel.compression] = n.many();
        }
        robot.condition =
            [Condition::Able, Condition::Overturned, Condition::Stuck, Condition::Fallen][n.below(4)];
        robot
    });
    let robots = robots.collect();
    let edge = |n: &mut Numbers| {
        let mut edge =
            EdgeState { set_point: n.many(), error: n.many(), rates: n.many(), ..EdgeState::default() };
        [edge.relative.distance, edge.relative.bearing, edge.relative.view_angle] = n.many();
        [edge.seen.distance, edge.seen.bearing, edge.seen.view_angle, edge.age] = n.many();
        [edge.asked.acceleration, edge.asked.turn_rate] = n.many();
        [edge.applied.acceleration, edge.applied.turn_rate] = n.many();
        edge.estimate = n.many();
        edge.behind = n.next();
        edge.sight = [
            TrackingState::Truth,
            TrackingState::Waiting,
            TrackingState::Tracking,
            TrackingState::Coasting,
            TrackingState::Lost,
        ][n.below(5)];
        (edge.limited, edge.too_close) = (n.below(2) == 1, n.below(2) == 1);
        edge
    };
    let contact = |n: &mut Numbers| Contact {
        number: n.whole(),
        things: [
            EntityId::Robot(n.below(3)),
            [EntityId::Prop(2), EntityId::Ground, EntityId::Robot(1)][n.below(3)],
        ],
        begin: n.next(),
        end: n.next(),
        open: n.below(2) == 1,
        place: n.many(),
        normal: n.many(),
        impulse: n.next(),
    };
    let measurement = |n: &mut Numbers| {
        let mut frame = MeasurementRecord {
            edge: n.below(2),
            arrival: n.next(),
            pan: n.next(),
            ..MeasurementRecord::default()
        };
        frame.measurement.stamp = n.next();
        frame.measurement.deviation = n.many();
        [frame.measurement.relative.distance, frame.truth.bearing] = n.many();
        frame.outcome =
            [Outcome::Used, Outcome::Rejected, Outcome::Ambiguous, Outcome::Missed, Outcome::Dropped]
                [n.below(5)];
        for tag in &mut frame.tags {
            *tag = (n.below(2) == 1).then(|| std::array::from_fn(|_| n.many()));
        }
        frame.region.x = n.below(1 << 31) as u32;
        frame.region.height = u32::MAX;
        frame
    };
    // Some props stand for a while.
    let props = fleet.props.iter().enumerate().map(|(i, prop)| {
        if i % 2 == 0 || k.is_multiple_of(7) {
            prop.placement
        } else {
            Placement { position: n.many(), rotation: n.many() }
        }
    });
    StepRecord {
        snapshot: Snapshot { time: f64::from(k) * 0.01 + 1e-13, robots, props: props.collect() },
        edges: (0..2).map(|_| edge(n)).collect(),
        contacts: (0..n.below(3)).map(|_| contact(n)).collect(),
        // Measurements are told in the order of their edges.
        frames: {
            let mut measurements: Vec<MeasurementRecord> = (0..n.below(3)).map(|_| measurement(n)).collect();
            measurements.sort_by_key(|measurement| measurement.edge);
            measurements
        },
        safety: (0..n.below(4)).map(|robot| filtered(robot, n)).collect(),
        laws: (0..n.below(3)).map(|robot| law(robot, n)).collect(),
        leaders: vec![[None, Some(0)][n.below(2)], [None, Some(1), Some(2)][n.below(3)]],
        events: (0..n.below(3)).map(|_| event(n)).collect(),
        plans: (0..n.below(2)).map(|_| Arc::new(plan(n))).collect(),
    }
}

fn plan(n: &mut Numbers) -> PlannedPath {
    let robots: Vec<usize> = (0..=n.below(3)).collect();
    let point = |n: &mut Numbers| PlannedPoint {
        time: n.next(),
        speed: n.next(),
        narrowing: n.next(),
        poses: robots.iter().map(|_| Pose { x: n.next(), y: n.next(), heading: n.next() }).collect(),
    };
    let points = (0..n.below(4)).map(|_| point(n)).collect();
    PlannedPath { robots, points }
}

fn event(n: &mut Numbers) -> EventRecord {
    EventRecord {
        kind: EventKind::WORDS[n.below(EventKind::WORDS.len())].1,
        robot: n.below(3),
        leader: [None, Some(0), Some(2)][n.below(3)],
        refusal: Refusal::WORDS[n.below(Refusal::WORDS.len())].1,
        obstacle: [None, Some(EntityId::Robot(0)), Some(EntityId::Prop(1))][n.below(3)],
        measured: n.many(),
        goal: [None, Some(TourGoal { goal: 0, round: None }), Some(TourGoal { goal: 3, round: Some(0) })]
            [n.below(3)],
        event: [None, Some(0), Some(7)][n.below(3)],
    }
}

fn law(robot: usize, n: &mut Numbers) -> LawState {
    let all = [("sum", "m s"), ("count", ""), ("e.x", "rad/s")];
    let all = all.map(|(name, unit)| LawQuantity { name: name.to_owned(), unit: unit.to_owned() });
    let count = n.below(4);
    LawState {
        robot,
        quantities: all[..count].into(),
        values: (0..count).map(|_| n.next()).collect(),
        fault: ["", "my.law:3:7: `e` is not a number"][n.below(2)].to_owned(),
    }
}

fn filtered(robot: usize, n: &mut Numbers) -> SafetyState {
    let constraint = |n: &mut Numbers| {
        Constraint::of_code([n.below(Constraint::KINDS.len()), n.below(2)]).expect("a constraint")
    };
    let some = |n: &mut Numbers| (0..n.below(3)).map(|_| constraint(n)).collect();
    let mut state =
        SafetyState { robot, moved: n.next(), relaxed: n.many(), acting: some(n), ..SafetyState::default() };
    [state.wished.acceleration, state.wished.turn_rate] = n.many();
    [state.applied.acceleration, state.applied.turn_rate] = n.many();
    state.conflict = some(n);
    let barrier = |n: &mut Numbers| BarrierState {
        constraint: constraint(n),
        value: n.next(),
        slack: n.next(),
        direction: n.next(),
    };
    state.barriers = (0..n.below(4)).map(|_| barrier(n)).collect();
    state
}

pub(crate) fn options() -> RunOptions {
    RunOptions {
        csv: false,
        no_log: false,
        roll: Roll::default(),
        force: false,
        scene: "schema = 1\ntitle = \"x\"\n".into(),
        program: "test 1".into(),
        commit: Some("abc".into()),
        seed: u64::MAX,
        period: 0.01,
        judging: Judging { settling_band: [0.02; 2], settled_after: 0.0 },
    }
}

/// Records `count` moments in `folder`; they, and what the manifest says.
pub(crate) fn record(folder: &Path, count: u32, status: Status) -> (Vec<StepRecord>, Manifest) {
    let (fleet, mut numbers) = (fleet(), Numbers(7));
    let records: Vec<StepRecord> = (0..count).map(|k| step_record(&fleet, k, &mut numbers)).collect();
    let mut recorder = Recorder::create(folder, &fleet, options()).expect("a recorder");
    for record in &records {
        recorder.push(record).expect("recorded");
    }
    (records, recorder.finish(status).expect("finished").0)
}

/// Bit for bit but for payloads of NaN, of which there are none: `{:?}` tells −0 from 0 and prints all digits.
pub(crate) fn same(a: &StepRecord, b: &StepRecord) -> bool {
    a == b && format!("{a:?}") == format!("{b:?}")
}
