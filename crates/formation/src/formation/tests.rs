//! Tests of formations: who decides when, on what, and what custom laws carry.

use super::*;
use crate::law::Switching;
use crate::lead::AnalyticTrajectory;
use crate::observer::Observer;
use crate::path_heading::Heading;
use laws::{CustomLaw, Declaration, Fault, Knowledge, Parameter, Quantity, Scale, Unit};
use vocabulary::{LawKind, Relative};

fn chain(kind: LawKind) -> Formation {
    let graph = Graph::new(&["a", "b", "c"], &[("a", "b"), ("b", "c")]).expect("a chain");
    let law = Law {
        kind,
        gain: [5.0; 2],
        robust_gain: [5.0; 2],
        switching: Switching::Tanh([24.53; 2]),
        distance_min: 0.1,
        heading: Heading::Leader,
    };
    let observer = Observer { epsilon: [1e-3; 2], alpha1: [2.0; 2], alpha2: [1.0; 2], distance_min: 0.1 };
    let edge = EdgeLaw {
        law,
        custom: None,
        batch: None,
        observer,
        tracker: None,
        set_point: SetPointTrajectory::constant(2.0, -2.3),
        free: [false; 2],
        standing: false,
        narrowing: None,
    };
    let limits = Limits::PAPER;
    let lead: Arc<dyn Trajectory> = Arc::new(AnalyticTrajectory::constant(1.0, 0.3));
    Formation::new(graph, vec![edge.clone(), edge], vec![limits; 3], vec![(0, lead)], 0.01)
}

fn observation(distance: f64) -> Observation {
    let relative = Relative { distance, bearing: -2.29, view_angle: -2.29 };
    Observation { relative, own_speed: 1.0, leader_speed: Some(1.0), ..Observation::default() }
}

#[test]
fn full_state_feedback_differentiates_its_leaders_command_from_the_third_sample_on() {
    let formation = chain(LawKind::FullState);
    let mut state = formation.start(vec![Estimate::default(); 2]);
    let mut turn_rates = vec![];
    for (k, distance) in [1.97, 1.98, 2.0].into_iter().enumerate() {
        let expected = if k < 2 { 0.0 } else { (turn_rates[1] - turn_rates[0]) / 0.01 };
        formation.decide(k as f64 * 0.01, &[observation(distance), observation(2.0)], &mut state);
        assert_eq!(state.drives[1].turn_acceleration, expected, "sample {k}");
        turn_rates.push(state.commands[1].turn_rate);
    }
    assert_ne!(turn_rates[0], turn_rates[1]);
}

#[test]
fn a_lead_robot_is_told_its_prescribed_motion() {
    let formation = chain(LawKind::RobustState);
    let mut state = formation.start(vec![Estimate::default(); 2]);
    formation.decide(0.0, &[observation(2.0); 2], &mut state);
    assert_eq!(state.commands[0], Command { acceleration: 0.0, turn_rate: 0.3 });
}

#[test]
fn followers_go_by_what_their_leader_was_told_after_a_filter() {
    let formation = chain(LawKind::FullState);
    let free = Command { acceleration: 0.0, turn_rate: 0.3 };
    let told = Command { acceleration: -0.7, turn_rate: 0.9 };
    let mut states = [0, 1].map(|_| formation.start(vec![Estimate::default(); 2]));
    let seen = [observation(2.0); 2];
    let mut asked = vec![];
    formation.decide(0.0, &seen, &mut states[0]);
    formation.decide_through(0.0, &seen, &mut states[1], &mut |robot, command| {
        asked.push((robot, command));
        if robot == 0 { told } else { command }
    });
    assert_eq!(asked[0], (0, free));
    assert_eq!((states[1].commands[0], states[1].drives[0].turn_rate), (told, 0.9));
    assert_ne!(states[0].commands[1], states[1].commands[1]);
    // The memory that full state feedback differentiates holds what was told.
    for k in 1..3 {
        let mut turn = |robot: usize, command| match robot {
            0 => Command { turn_rate: 0.9 + 0.1 * f64::from(k), ..told },
            _ => command,
        };
        formation.decide_through(0.0, &seen, &mut states[1], &mut turn);
    }
    formation.decide_through(0.0, &seen, &mut states[1], &mut |robot, c| if robot == 0 { told } else { c });
    assert!((states[1].drives[0].turn_acceleration - 10.0).abs() < 1e-9);
}

#[test]
fn output_feedback_takes_its_rates_from_the_observer_and_reports_limits() {
    let formation = chain(LawKind::OutputFeedback);
    let estimate = Estimate { output: [2.0, -2.0], rates: [100.0, -50.0] };
    let mut state = formation.start(vec![estimate; 2]);
    let near = observation(0.05);
    formation.decide(0.0, &[near, near], &mut state);
    assert_eq!(state.decisions[0].rates, [100.0, -50.0]);
    assert!(state.decisions[0].limited && state.decisions[0].too_close);
    assert!(state.commands[1].turn_rate.abs() <= 11.5);
}

/// A law in Rust: it asks for the sum of its leaders' distances and for what it has counted, and breaks off where it
/// counts beyond a bound.
#[derive(Debug)]
struct Counting(Declaration);

impl Counting {
    fn new(leaders: usize) -> Arc<Self> {
        let quantity = |name: &str| Quantity { name: name.to_owned(), unit: Unit::NUMBER };
        let parameter = Parameter {
            name: "bound".to_owned(),
            symbol: "b".to_owned(),
            unit: Unit::NUMBER,
            unit_name: String::new(),
            unit_size: 1.0,
            default: 3.0,
            range: [0.0, 10.0],
            scale: Scale::Linear,
            help: String::new(),
        };
        Arc::new(Self(Declaration {
            leaders,
            knows: Knowledge::Motion,
            parameters: vec![parameter],
            memory: vec![quantity("count")],
            shown: vec![quantity("sample")],
            ..Declaration::default()
        }))
    }
}

impl CustomLaw for Counting {
    fn declaration(&self) -> &Declaration {
        &self.0
    }

    fn start(&self, _: &Input<'_>, _: &[f64], memory: &mut [f64]) -> Result<(), Fault> {
        memory[0] = 1.0;
        Ok(())
    }

    fn decide(
        &self,
        input: &Input<'_>,
        parameters: &[f64],
        memory: &mut [f64],
        shown: &mut [f64],
    ) -> Result<Command, Fault> {
        shown[0] = input.noise.sample as f64;
        memory[0] += 1.0;
        if memory[0] > parameters[0] {
            return Err(Fault { place: None, message: "it has counted too far".to_owned() });
        }
        let acceleration = input.leaders.iter().map(|leader| leader.relative.distance).sum();
        Ok(Command { acceleration, turn_rate: memory[0] })
    }

    fn derive(
        &self,
        input: &Input<'_>,
        parameters: &[f64],
        memory: &[f64],
        rates: &mut [f64],
    ) -> Result<Command, Fault> {
        rates[0] = 1.0;
        self.decide(input, parameters, &mut memory.to_vec(), &mut [0.0])
    }
}

/// c keeps its place by `leaders` with a counting law; the others do as always.
fn counting(leaders: &[&str]) -> Formation {
    let mut formation = chain(LawKind::FullState);
    let pairs: Vec<_> = [("a", "b")].into_iter().chain(leaders.iter().map(|leader| (*leader, "c"))).collect();
    formation.graph = Graph::new(&["a", "b", "c"], &pairs).expect("a graph");
    let edge = formation.edges[1].clone();
    let custom = Some(Custom::new(Counting::new(leaders.len()), vec![3.0]));
    formation.edges.truncate(1);
    formation.edges.extend(leaders.iter().map(|_| EdgeLaw { custom: custom.clone(), ..edge.clone() }));
    formation.edges[leaders.len()].free = [false, true];
    formation.written = formation.edges.iter().map(|edge| edge.set_point.clone()).collect();
    formation
}

#[test]
fn a_custom_law_decides_once_for_all_its_leaders_and_carries_its_memory() {
    let formation = counting(&["a", "b"]);
    let mut state = formation.start(vec![Estimate::default(); 3]);
    let seen = [observation(2.0), observation(0.25), observation(0.5)];
    for k in 0..2 {
        formation.decide(f64::from(k) * 0.01, &seen, &mut state);
    }
    let asked = Command { acceleration: 0.75, turn_rate: 3.0 };
    assert_eq!([1, 2].map(|edge| state.decisions[edge].asked), [asked; 2]);
    assert_eq!(state.commands[2], asked);
    assert_eq!((state.customs[1].memory(), state.customs[1].shown()), (&[3.0][..], &[1.0][..]));
    // Of a set point that is left free nothing is wanted.
    assert_eq!(state.decisions[2].set_point[1], seen[2].relative.bearing);
    assert_ne!(state.decisions[1].set_point[1], seen[1].relative.bearing);
}

#[test]
fn a_law_that_breaks_off_leaves_its_follower_braking_until_it_is_changed() {
    let mut formation = counting(&["b"]);
    let mut state = formation.start(vec![Estimate::default(); 2]);
    let mut decide = |formation: &Formation, k: u32| {
        formation.decide(f64::from(k) * 0.01, &[observation(2.0), observation(0.5)], &mut state);
        let law = &state.customs[1];
        (state.commands[2], law.fault().is_some(), law.is_failed(), law.memory()[0])
    };
    decide(&formation, 0);
    decide(&formation, 1);
    let braking = Command { acceleration: (Limits::PAPER.speed_min - 1.0) / 0.5, turn_rate: 0.0 };
    assert_eq!(decide(&formation, 2), (braking, true, true, 3.0));
    assert_eq!(decide(&formation, 3), (braking, false, true, 3.0));
    // With other parameters it goes on where it was; another law with the same memory takes that over.
    let law = Counting::new(1);
    formation.edges[1].custom = Some(Custom::new(law.clone(), vec![4.0]));
    assert_eq!(decide(&formation, 4), (Command { acceleration: 0.5, turn_rate: 4.0 }, false, false, 4.0));
    formation.edges[1].custom = Some(Custom::new(law, vec![9.0]));
    assert_eq!(decide(&formation, 5).3, 5.0);
}

#[test]
fn a_leader_that_is_met_anew_starts_the_memory_anew() {
    let formation = counting(&["b"]);
    let mut state = formation.start(vec![Estimate::default(); 2]);
    let lost = Observation { sight: TrackingState::Lost, ..observation(0.5) };
    for seen in [observation(0.5), lost, observation(0.5)] {
        formation.decide(0.0, &[observation(2.0), seen], &mut state);
    }
    assert_eq!(state.customs[1].memory(), [2.0]);
}

#[test]
fn in_continuous_time_samples_leave_the_memory_as_it_is() {
    let formation = counting(&["b"]).in_continuous_time(true);
    let mut state = formation.start(vec![Estimate::default(); 2]);
    let seen = [observation(2.0), observation(0.5)];
    for _ in 0..5 {
        formation.decide(0.0, &seen, &mut state);
    }
    let mut rates = vec![vec![]; 2];
    formation.evaluate(0.0, &seen, &mut state, &mut rates);
    assert_eq!((state.customs[1].memory(), &rates[1][..]), (&[1.0][..], &[1.0][..]));
}

/// A law for many followers that asks for the turn rate of the leader and counts its calls.
#[derive(Debug, Clone)]
struct Following {
    knows: Knowledge,
    calls: Vec<Vec<(usize, bool)>>,
}

impl BatchLaw for Following {
    fn name(&self) -> &'static str {
        "following"
    }

    fn knows(&self) -> Knowledge {
        self.knows
    }

    fn decide(&mut self, inputs: &[BatchInput<'_>]) -> Result<Vec<Command>, Fault> {
        if self.calls.len() == 4 {
            return Err(Fault { place: None, message: "tired".into() });
        }
        self.calls.push(inputs.iter().map(|one| (one.robot, one.meets)).collect());
        let turn_rate = |one: &BatchInput<'_>| one.input.leaders[0].motion.turn_rate;
        Ok(inputs.iter().map(|one| Command { acceleration: 0.0, turn_rate: turn_rate(one) }).collect())
    }

    fn fork(&self) -> Box<dyn BatchLaw> {
        Box::new(self.clone())
    }
}

#[test]
fn a_law_for_many_followers_is_asked_once_or_leaders_first() {
    let seen = [observation(2.0), observation(2.0)];
    let lost = Observation { sight: TrackingState::Lost, ..observation(2.0) };
    let filter = &mut |_: usize, command: Command| command;
    let ready = |knows| {
        let mut formation = chain(LawKind::OutputFeedback);
        formation.edges.iter_mut().for_each(|edge| edge.batch = Some(knows));
        let state = formation.start(vec![Estimate::default(); 2]);
        (formation, state, Following { knows, calls: vec![] })
    };
    // What leaders do at the same sample goes down the chain.
    let (formation, mut state, mut law) = ready(Knowledge::Motion);
    formation.decide_with(0.0, &seen, &mut state, &mut law, filter).expect("commands");
    assert_eq!(law.calls, [[(1, true)], [(2, true)]]);
    assert!(state.commands.iter().all(|command| command.turn_rate == 0.3));

    let (mut formation, mut state, mut law) = ready(Knowledge::Output);
    formation.decide_with(0.0, &seen, &mut state, &mut law, filter).expect("commands");
    formation.decide_with(0.01, &[seen[0], lost], &mut state, &mut law, filter).expect("commands");
    formation.decide_with(0.02, &seen, &mut state, &mut law, filter).expect("commands");
    // Who has lost its leader is not asked, and meets it anew.
    assert_eq!(law.calls[..2], [vec![(1, true), (2, true)], vec![(1, false)]]);
    assert_eq!(law.calls[2], [(1, false), (2, true)]);
    // The others keep their laws.
    formation.edges[0].batch = None;
    formation.decide_with(0.03, &seen, &mut state, &mut law, filter).expect("commands");
    assert_eq!(law.calls[3], [(2, false)]);
    let fault = formation.decide_with(0.04, &seen, &mut state, &mut law, filter).expect_err("tired");
    assert_eq!(fault.to_string(), "tired");
}
