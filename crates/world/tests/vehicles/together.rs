//! Vehicles among each other and among props.

use crate::common::{Run, actor, differential, flat, truck, unicycle};
use proptest::prelude::*;
use std::f64::consts::PI;
use vocabulary::math;
use vocabulary::{Command, Contact, EntityId, Mobility, Placement, Pose, Prop, Snapshot, Solid};
use world::{Physical, PropBody, Wheeled, World, WorldSetup};

const FORWARD: Command = Command { acceleration: 0.0, turn_rate: 0.0 };

fn prop(solid: Solid, pose: Pose, mass: Option<f64>) -> PropBody {
    let mobility = if mass.is_some() { Mobility::Loose } else { Mobility::Fixed };
    let placement = Placement::upright(pose, 0.0);
    PropBody {
        prop: Prop { name: "prop".into(), solid, placement, mobility },
        mass: mass.unwrap_or(1.0),
        path: None,
        friction: 0.6,
        restitution: 0.1,
    }
}

/// Contacts that were told, once each.
fn told(run: &mut Run, command: Command, time: f64) -> Vec<Contact> {
    let mut ended = Vec::new();
    let commands = vec![command; run.world.snapshot().robots.len()];
    for _ in 0..(time * 100.0) as usize {
        run.world.apply(&commands);
        run.world.advance(0.01);
        ended.extend(run.world.contacts().iter().filter(|c| !c.open).copied());
    }
    ended.extend(run.world.contacts().iter().filter(|c| c.open).copied());
    ended
}

/// A head-on collision: one contact, and its impulse is the change of momentum of each.
#[test]
fn a_head_on_collision_balances_momentum() {
    let glide = Wheeled { drive_force: 1e-9, brake_force: 1e-9, drag: 0.0, ..truck() };
    let still = Wheeled { tyre: world::wheeled::tyre::Tyre { rolling: 0.0, ..glide.tyre }, ..glide };
    let mut run = Run::new(flat(vec![
        actor(&still, Pose::default(), 1.5),
        actor(&still, Pose::new(2.0, 0.0, PI), 1.5),
    ]));
    let contacts = told(&mut run, FORWARD, 1.5);
    assert_eq!(contacts.len(), 1, "{contacts:?}");
    let speeds = run.world.snapshot().robots.iter().map(|r| r.motion.speed).collect::<Vec<_>>();
    let change = still.mass * (1.5 - speeds[0]);
    assert!((contacts[0].impulse / change - 1.0).abs() < 0.10, "{} N s, not {change}", contacts[0].impulse);
    assert_eq!(contacts[0].things, [EntityId::Robot(0), EntityId::Robot(1)]);
    assert!(contacts[0].normal[0] > 0.99 && (contacts[0].place[0] - 1.0).abs() < 0.2, "{contacts:?}");
    assert!((speeds[0] - speeds[1]).abs() < 0.05, "{speeds:?}");
}

/// Nothing else pushes: what one loses the other gains.
#[test]
fn free_contacts_conserve_momentum() {
    let slick = world::wheeled::tyre::Tyre { friction: 1e-9, ..truck().tyre };
    let ice = Wheeled { tyre: slick, drag: 0.0, ..truck() };
    let mut run = Run::new(flat(vec![
        actor(&ice, Pose::default(), 2.0),
        actor(&Wheeled { mass: 2.0, ..ice.clone() }, Pose::new(1.5, 0.1, 0.3), 0.0),
    ]));
    let momentum = |snapshot: &Snapshot, before: &Snapshot| {
        let velocity = |k: usize| {
            // Of the centre of mass, by differences of its place.
            let place = |s: &Snapshot| s.robots[k].motion.pose.world_from_body(0.15, 0.0);
            let (now, then) = (place(snapshot), place(before));
            [(now[0] - then[0]) / 0.01, (now[1] - then[1]) / 0.01]
        };
        let (p, q) = (velocity(0), velocity(1));
        [5.01 * p[0] + 2.0 * q[0], 5.01 * p[1] + 2.0 * q[1]]
    };
    let mut before = run.world.snapshot().clone();
    let mut contacts = 0;
    for _ in 0..150 {
        run.world.apply(&[FORWARD; 2]);
        run.world.advance(0.01);
        let [px, py] = momentum(run.world.snapshot(), &before);
        // Pitching moves the centre of mass a little against the pose's point.
        if run.world.snapshot().time > 0.9 {
            assert!((px - 10.02).abs() < 0.2 && py.abs() < 0.2, "{px} {py} at {}", before.time);
        }
        contacts += run.world.contacts().len();
        before = run.world.snapshot().clone();
    }
    assert!(contacts > 0);
}

#[test]
fn nobody_tunnels_at_ten_metres_a_second() {
    let fast = Wheeled { limits: vocabulary::Limits { speed_max: 12.0, ..truck().limits }, ..truck() };
    let wall = prop(Solid::Block { size: [0.02, 4.0, 0.5] }, Pose::new(2.0, 0.0, 0.0), None);
    let mut run =
        Run::new(WorldSetup { props: vec![wall], ..flat(vec![actor(&fast, Pose::default(), 10.0)]) });
    let contacts = told(&mut run, FORWARD, 1.0);
    let places = contacts.iter().map(|contact| contact.place[0]);
    assert!(places.clone().count() > 0 && places.clone().all(|x| (x - 1.99).abs() < 0.06), "{contacts:?}");
    let ended = run.motion().pose.x;
    assert!(ended < 1.75, "it came to {ended} m");
}

#[test]
fn a_crate_is_pushed_and_a_ramp_is_climbed() {
    let ramp = prop(Solid::Wedge { size: [2.0, 1.5, 0.25] }, Pose::new(2.0, 0.0, 0.0), None);
    let mut run =
        Run::new(WorldSetup { props: vec![ramp], ..flat(vec![actor(&truck(), Pose::default(), 1.0)]) });
    run.hold(FORWARD, 2.3, |_| {});
    let robot = &run.world.snapshot().robots[0];
    let slope = math::atan(0.25_f64 / 2.0);
    assert!((robot.attitude.pitch + slope).abs() < 0.05, "{:?} {:?}", robot.attitude, robot.motion);
    assert!((robot.attitude.height - (robot.motion.pose.x - 1.0) * 0.125).abs() < 0.02, "{robot:?}");
    let crate_ = prop(Solid::Block { size: [0.3, 0.3, 0.3] }, Pose::new(1.5, 0.0, 0.0), Some(1.0));
    let mut run =
        Run::new(WorldSetup { props: vec![crate_], ..flat(vec![actor(&truck(), Pose::default(), 1.0)]) });
    let contacts = told(&mut run, FORWARD, 2.5);
    assert!(run.world.snapshot().props[0].position[0] > 1.9, "{:?}", run.world.snapshot().props);
    assert_eq!(contacts[0].things, [EntityId::Robot(0), EntityId::Prop(0)]);
}

/// As the pieces of a ramp, which lie side by side.
#[test]
fn things_that_never_move_have_no_contacts() {
    let block = |x: f64| prop(Solid::Block { size: [1.0, 1.0, 0.3] }, Pose::new(x, 0.0, 0.0), None);
    let mut run = Run::new(WorldSetup {
        props: vec![block(5.0), block(6.0)],
        ..flat(vec![actor(&truck(), Pose::default(), 1.0)])
    });
    let contacts = told(&mut run, FORWARD, 0.5);
    assert!(contacts.is_empty(), "{contacts:?}");
}

/// Unicycles have no mass, but their contacts are found.
#[test]
fn unicycles_touch_too() {
    let pillar = prop(Solid::Cylinder { radius: 0.1, height: 1.0 }, Pose::new(1.5, 0.0, 0.0), None);
    let actors = vec![unicycle(Pose::default(), 1.0), unicycle(Pose::new(3.0, 0.0, PI), 0.5)];
    let mut run = Run::new(WorldSetup { props: vec![pillar], ..flat(actors) });
    let contacts = told(&mut run, FORWARD, 2.5);
    let with = |things: [EntityId; 2]| contacts.iter().filter(|c| c.things == things).count();
    assert_eq!(with([EntityId::Robot(0), EntityId::Prop(0)]), 1, "{contacts:?}");
    assert_eq!(with([EntityId::Robot(0), EntityId::Robot(1)]), 1, "{contacts:?}");
    let first = contacts.iter().find(|c| c.things == [EntityId::Robot(0), EntityId::Prop(0)]).unwrap();
    assert!((first.begin - (1.4 - 0.395)).abs() < 0.02, "{first:?}");
}

/// A crate pushed against a pillar: three contacts, one of them between props.
#[test]
fn props_that_meet_are_told_too() {
    let box_ = prop(Solid::Block { size: [0.3, 0.3, 0.3] }, Pose::new(1.0, 0.0, 0.0), Some(0.5));
    let pillar = prop(Solid::Cylinder { radius: 0.2, height: 1.0 }, Pose::new(1.8, 0.0, 0.0), None);
    let mut run = Run::new(WorldSetup {
        props: vec![box_, pillar],
        ..flat(vec![actor(&truck(), Pose::default(), 1.0)])
    });
    let contacts = told(&mut run, FORWARD, 2.0);
    let between =
        contacts.iter().find(|c| c.things == [EntityId::Prop(0), EntityId::Prop(1)]).expect("the crate hits");
    assert!(
        between.impulse > 0.1 && !between.of_robot() && (between.place[0] - 1.6).abs() < 0.03,
        "{between:?}"
    );
    assert!(contacts.iter().all(|c| c.things[1] != EntityId::Ground), "{contacts:?}");
}

#[derive(Debug)]
struct Circle;

impl vocabulary::Trajectory for Circle {
    fn at(&self, _: f64) -> vocabulary::MotionInput {
        vocabulary::MotionInput { speed: 0.9, turn_rate: 0.3, ..vocabulary::MotionInput::default() }
    }
}

/// A guided prop goes its way to the end, and nothing stops it.
#[test]
fn a_guided_prop_keeps_going() {
    let mut cart = prop(Solid::Block { size: [0.8, 0.5, 0.6] }, Pose::new(0.0, -3.0, 0.0), None);
    cart.prop.mobility = Mobility::Guided;
    cart.path = Some(std::sync::Arc::new(Circle));
    let mut run =
        Run::new(WorldSetup { props: vec![cart], ..flat(vec![actor(&truck(), Pose::default(), 0.0)]) });
    let quarter = std::f64::consts::FRAC_PI_2 / 0.3;
    for _ in 0..(quarter / 0.01).round() as usize {
        run.world.apply(&[FORWARD]);
        run.world.advance(0.01);
    }
    let placement = run.world.snapshot().props[0];
    assert!(
        (placement.position[0] - 3.0).abs() < 0.01 && placement.position[1].abs() < 0.01,
        "{placement:?}"
    );
    assert!(
        (2.0 * math::atan2(placement.rotation[2], placement.rotation[3]) - std::f64::consts::FRAC_PI_2).abs()
            < 0.01
    );
}

fn crowd(count: usize) -> WorldSetup {
    let kinds = [truck(), differential()];
    let place = |k: usize| Pose::new((k % 12) as f64 * 0.9, (k / 12) as f64 * 0.9, k as f64);
    flat((0..count).map(|k| actor(&kinds[k % 2], place(k), 1.0)).collect())
}

fn trajectory(world: &mut dyn World, from: usize, steps: usize) -> Vec<[u64; 4]> {
    let mut bits = Vec::new();
    for step in from..from + steps {
        let wave = |k: usize| math::sin(k as f64 + step as f64 * 0.02);
        let count = world.snapshot().robots.len();
        let commands: Vec<Command> =
            (0..count).map(|k| Command { acceleration: wave(k), turn_rate: 3.0 * wave(k + 7) }).collect();
        world.apply(&commands);
        world.advance(0.01);
        bits.extend(world.snapshot().robots.iter().map(|r| {
            let m = &r.motion;
            [m.pose.x.to_bits(), m.pose.y.to_bits(), m.pose.heading.to_bits(), r.attitude.height.to_bits()]
        }));
    }
    bits
}

/// A crowd with contacts: the same bits on one thread and on four, and after a save in the middle of it.
#[test]
fn the_future_does_not_depend_on_threads_or_saves() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| trajectory(&mut Physical::new(crowd(100)), 0, 150))
    };
    let (one, four) = (run(1), run(4));
    assert!(one == four);
    let mut world = Physical::new(crowd(100));
    let mut bits = trajectory(&mut world, 0, 80);
    assert!(!world.contacts().is_empty(), "the save should fall among contacts");
    let mut saved = world.save();
    bits.extend(trajectory(saved.as_mut(), 80, 70));
    assert!(bits == one);
    assert!(trajectory(&mut world, 80, 70) == one[8000..]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]
    /// Whatever is commanded and wherever they start, nothing breaks and nobody sinks.
    #[test]
    fn random_crowds_stay_finite_and_above_the_ground(seed in 0_u64..1 << 40) {
        let mut world = Physical::new(crowd(24));
        for step in 0..200_u64 {
            let chance = |k: u64| ((seed.wrapping_mul(k + 1).wrapping_add(step / 10 * 7919)) % 2001) as f64 / 1000.0 - 1.0;
            let commands: Vec<Command> = (0..24).map(|k| Command {
                acceleration: 20.0 * chance(k), turn_rate: 20.0 * chance(k + 99),
            }).collect();
            world.apply(&commands);
            world.advance(0.01);
        }
        for robot in &world.snapshot().robots {
            prop_assert!(robot.motion.pose.x.is_finite() && robot.motion.speed.is_finite());
            prop_assert!(robot.attitude.height > -0.1, "{:?}", robot.attitude);
        }
    }
}

/// At a steady speed, m/s.
#[derive(Debug)]
struct Steady(f64);

impl vocabulary::Trajectory for Steady {
    fn at(&self, _: f64) -> vocabulary::MotionInput {
        vocabulary::MotionInput { speed: self.0, ..vocabulary::MotionInput::default() }
    }
}

/// Whatever its speed, what goes its own way pushes what is in its way before it, and does not pass through.
#[test]
fn a_fast_guided_block_meets_a_loose_one() {
    let block = Solid::Block { size: [0.3, 0.3, 0.3] };
    for speed in [1.0, 10.0, 40.0, 100.0] {
        let mut guided = prop(block, Pose::default(), None);
        guided.prop.mobility = Mobility::Guided;
        guided.path = Some(std::sync::Arc::new(Steady(speed)));
        let loose = prop(block, Pose::new(2.0, 0.0, 0.0), Some(1.0));
        let mut world = Physical::new(WorldSetup { props: vec![guided, loose], ..flat(vec![]) });
        let mut touched = 0;
        for _ in 0..(300.0 / speed) as usize {
            world.apply(&[]);
            world.advance(0.01);
            touched = touched.max(world.contacts().len());
            let [from, to] = [0, 1].map(|k| world.snapshot().props[k].position[0]);
            assert!(to - from > 0.15, "at {speed} m/s the block at {from} m has passed the one at {to} m");
        }
        assert!(touched > 0, "at {speed} m/s");
    }
}

/// The arm of a turnstile sweeps away what it meets.
#[test]
fn a_fast_turning_arm_meets_a_loose_block() {
    #[derive(Debug)]
    struct Turns;
    impl vocabulary::Trajectory for Turns {
        fn at(&self, _: f64) -> vocabulary::MotionInput {
            vocabulary::MotionInput { turn_rate: 20.0, ..vocabulary::MotionInput::default() }
        }
    }
    let mut arm = prop(Solid::Block { size: [8.0, 0.05, 0.5] }, Pose::default(), None);
    arm.prop.mobility = Mobility::Guided;
    arm.path = Some(std::sync::Arc::new(Turns));
    let block = prop(Solid::Block { size: [0.1, 0.1, 0.1] }, Pose::new(0.0, 3.5, 0.0), Some(1.0));
    let mut world = Physical::new(WorldSetup { props: vec![arm, block], ..flat(vec![]) });
    for _ in 0..15 {
        world.apply(&[]);
        world.advance(0.01);
    }
    // The arm turns by 3 rad in this time: past the block, which has gone with it.
    let [x, y, _] = world.snapshot().props[1].position;
    assert!(x < -1.0 && math::hypot(x, y) > 3.0, "{x} {y}");
}

/// The ground bears as far out as anything can start.
#[test]
fn a_thousand_kilometres_out_things_stand_and_drive_as_at_home() {
    let far = [-1e6, 1e6];
    let crate_ =
        prop(Solid::Block { size: [0.3, 0.3, 0.3] }, Pose::new(far[0], far[1] + 2.0, 0.3), Some(1.0));
    let car = actor(&truck(), Pose::new(far[0], far[1], 0.0), 1.0);
    let mut run = Run { world: Physical::new(WorldSetup { props: vec![crate_], ..flat(vec![car]) }) };
    run.hold(FORWARD, 5.0, |_| {});
    let snapshot = run.world.snapshot();
    let [x, y, z] = snapshot.props[0].position;
    assert!((x - far[0]).abs() < 1e-3 && (y - far[1] - 2.0).abs() < 1e-3 && z.abs() < 1e-3, "{x} {y} {z}");
    assert_eq!(snapshot.robots[0].condition, vocabulary::Condition::Able);
    assert!((run.motion().pose.x - far[0] - 5.0).abs() < 0.1, "{}", run.motion().pose.x - far[0]);
}
