//! Runs with a law for many followers: it stays through changes and copies, and some runs cannot have it.

use laws::{BatchInput, BatchLaw, Fault, Knowledge};
use scene::{Override, Scene};
use simulation::{BatchError, Simulation, build};
use vocabulary::{Command, StepRecord};

/// Accelerates by the sum of its distance errors.
#[derive(Debug, Clone, Default)]
struct Integrating {
    sums: Vec<f64>,
}

impl BatchLaw for Integrating {
    fn name(&self) -> &'static str {
        "integrating"
    }

    fn knows(&self) -> Knowledge {
        Knowledge::Output
    }

    fn decide(&mut self, inputs: &[BatchInput<'_>]) -> Result<Vec<Command>, Fault> {
        self.sums.resize(inputs.len(), 0.0);
        let mut commands = vec![];
        for (sum, one) in self.sums.iter_mut().zip(inputs) {
            let leader = &one.input.leaders[0];
            *sum += leader.relative.distance - leader.wanted.value[0];
            commands.push(Command { acceleration: 0.01 * *sum, turn_rate: 0.0 });
        }
        Ok(commands)
    }

    fn fork(&self) -> Box<dyn BatchLaw> {
        Box::new(self.clone())
    }
}

fn run_of(name: &str, set: &[&str]) -> (Scene, Simulation) {
    let sets: Vec<Override> = set.iter().map(|set| set.parse().expect("an override")).collect();
    let scene = Scene::load(name, &sets).expect("a scene").scene;
    let simulation = Simulation::new(build(&scene).expect("a run"));
    (scene, simulation)
}

/// All records to the end, where the law drives the second follower alone.
fn rest(run: &mut Simulation) -> Vec<StepRecord> {
    let mut records = vec![];
    while let Some(record) = run.next_record() {
        assert_eq!(record.edges[1].asked.turn_rate, 0.0);
        records.push(record.clone());
    }
    records
}

#[test]
fn a_copy_goes_on_with_the_memory_of_its_law() {
    let set = ["time.duration=4", "changes=[{ at = 1.0, set = [\"law.k=3\"] }]"];
    let (_, mut run) = run_of("circle-three", &set);
    run.attach_law(Box::new(Integrating::default()), &[2]).expect("attached");
    assert!(!run.is_over() && run.fleet().caption.contains("integrating"));
    for _ in 0..50 {
        run.next_record().expect("a sample");
    }
    let mut copy = run.save();
    let records = rest(&mut run);
    assert!(records.len() == 351 && records == rest(&mut copy));
    assert!(run.is_over() && copy.is_over());
}

#[test]
fn runs_that_cannot_have_one_say_why() {
    let law = || Box::new(Integrating::default());
    let (_, mut run) = run_of("circle-three", &[]);
    assert_eq!(run.attach_law(law(), &[0]), Err(BatchError::Leads("leader".into())));
    run.next_record().expect("a sample");
    assert_eq!(run.attach_law(law(), &[1]), Err(BatchError::Begun(1)));
    let (_, mut run) = run_of("circle-three", &["time.mode=continuous"]);
    assert_eq!(run.attach_law(law(), &[1]), Err(BatchError::Continuous));
    let (scene, mut run) = run_of("two-leaders", &[]);
    let several = (0..scene.robots.len()).find(|robot| run.fleet().has_several_leaders(*robot));
    let refused = run.attach_law(law(), &[several.expect("a robot")]).expect_err("refused");
    assert!(matches!(refused, BatchError::SeveralLeaders(_)));
}
