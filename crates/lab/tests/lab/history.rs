//! Looking back: what is shown of the past is what was shown then, and hours of it fit into memory.

use crate::common::{THREE, scene, with};
use lab::session::history::History;
use rendering::Trail;
use simulation::Simulation;
use std::sync::Arc;
use vocabulary::{FleetInfo, StepRecord};

/// The first samples of a scene.
fn records(text: &str, samples: usize) -> (Arc<FleetInfo>, f64, Vec<StepRecord>) {
    let mut run = Simulation::new(simulation::build(&scene(text)).expect("a run"));
    run.extend_to(1e6);
    let records = (0..samples).map(|_| run.next_record().expect("a moment").clone()).collect();
    (Arc::new(run.fleet().clone()), run.period(), records)
}

fn history(text: &str, samples: usize) -> (History, Vec<StepRecord>) {
    let (fleet, period, records) = records(text, samples);
    let mut history = History::new(fleet, period);
    for record in &records {
        history.push(0, record.clone());
    }
    (history, records)
}

/// All that a trail remembers.
fn all_of(trail: Option<&Trail>) -> String {
    format!("{:?}", trail.expect("a trail"))
}

fn time(record: &StepRecord) -> f64 {
    record.snapshot.time
}

#[test]
fn the_past_is_what_it_was() {
    let (mut back, records) = history(THREE, 1300);
    let (fleet, period) = (Arc::clone(back.fleet()), back.period());
    // There and back, by much and by little, across what is kept of trails.
    let samples = [900, 150, 151, 152, 1299, 640, 650, 400, 401, 0, 1, 199, 200, 201, 1298];
    for sample in samples {
        let at = time(&records[sample]);
        back.prepare_trail(0, at);
        assert_eq!(*back.at(0, at).expect("a moment"), records[sample]);
        let mut then = History::new(Arc::clone(&fleet), period);
        for record in &records[..=sample] {
            then.push(0, record.clone());
        }
        assert_eq!(all_of(back.trail(0, at)), all_of(then.trail(0, at)), "the trail at sample {sample}");
        assert_eq!((then.end(0), then.sample(at)), (at, sample as u64));
    }
    let [a, b] = [100, 101].map(|sample| time(&records[sample]));
    assert_eq!(
        *back.at(0, 0.5 * (a + b)).expect("a moment"),
        records[100],
        "between samples: the one before"
    );
    assert_eq!(*back.at(0, 1e9).expect("a moment"), records[1299], "after the end: the end");
    assert_eq!(*back.at(0, -1.0).expect("a moment"), records[0], "before the start: the start");
}

#[test]
fn branches_share_the_past_and_not_the_future() {
    let (mut history, records) = history(THREE, 700);
    history.fork(0, 451);
    assert_eq!((history.branches(), history.end(1)), (2, time(&records[450])));
    assert_eq!(all_of(history.trail(1, 1e9)), {
        let mut then = History::new(Arc::clone(history.fleet()), history.period());
        records[..=450].iter().for_each(|record| then.push(0, record.clone()));
        all_of(then.trail(0, 1e9))
    });
    // Where it begins it is told once more.
    history.push(1, records[450].clone());
    assert_eq!(history.since(1, [4.485, 9.0]).len(), 2);
    for sample in [0, 3, 449, 450] {
        let [one, other] = [0, 1].map(|branch| history.at(branch, time(&records[sample])).expect("a moment"));
        assert!(Arc::ptr_eq(&one, &other), "sample {sample} is kept once");
    }
    let (_, _, others) = self::records(&with(THREE, &[("law.k", "1.0")]), 700);
    for record in &others[451..] {
        history.push(1, record.clone());
    }
    let at = time(&records[600]);
    assert_eq!(*history.at(0, at).expect("a moment"), records[600]);
    assert_eq!(*history.at(1, at).expect("a moment"), others[600]);
    assert_ne!(records[600], others[600]);
    history.prepare_trail(1, at);
    let of_branch = all_of(history.trail(1, at));
    assert!(history.trail(0, at).is_none(), "what was prepared for one branch is not shown for another");
    history.prepare_trail(0, at);
    assert_ne!(all_of(history.trail(0, at)), of_branch);
    // Nobody minds questions about branches that are not there.
    history.prepare_trail(7, at);
    history.push(7, records[0].clone());
    history.fork(7, 3);
    assert!(
        history.at(7, at).is_none() && history.since(7, [0.0, 9.0]).is_empty() && history.branches() == 2
    );
}

#[test]
fn moments_since_a_time_are_each_given_once() {
    let (history, records) = history(THREE, 200);
    let [a, b] = [50, 80].map(|sample| time(&records[sample]));
    let some: Vec<f64> = history.since(0, [a, b]).iter().map(|record| time(record)).collect();
    assert_eq!(some, records[51..=80].iter().map(time).collect::<Vec<_>>());
    assert_eq!(history.since(0, [-1.0, 0.0]).len(), 1, "the first, too");
    assert!(history.since(0, [b, b]).is_empty());
}

#[test]
fn room_is_measured_ten_times_a_second() {
    let (history, _) = history(THREE, 500);
    let rooms = history.rooms(0, [1.0, 3.0]);
    assert!((20..=21).contains(&rooms.len()), "{}", rooms.len());
    // Bodies of 0.42 m by 0.24 m, the middles 1.4 to 2 m apart.
    assert!(
        rooms.iter().all(|[time, room]| (1.0..=3.0).contains(time) && (0.8..2.0).contains(room)),
        "{rooms:?}"
    );
}

/// A run of `count` samples in which nothing has to be computed.
fn long(count: usize) -> (History, StepRecord) {
    let (fleet, period, records) = records(THREE, 1);
    let mut history = History::new(fleet, period);
    let mut record = records[0].clone();
    for sample in 0..count {
        record.snapshot.time = sample as f64 * period;
        record.snapshot.robots[0].motion.pose.x = sample as f64;
        history.push(0, record.clone());
    }
    (history, record)
}

#[test]
fn hours_fit_into_memory() {
    let (mut history, last) = long(100_000);
    let kept = history.since(0, [-1.0, f64::INFINITY]);
    assert!((9_000..=20_000).contains(&kept.len()), "{} moments are kept", kept.len());
    let steps: Vec<f64> = kept.windows(2).map(|pair| time(&pair[1]) - time(&pair[0])).collect();
    assert!(steps.iter().all(|step| (step - steps[0]).abs() < 1e-6), "they are evenly far apart");
    assert_eq!(time(&kept[0]), 0.0);
    // In between, robots are in between; the present is exact.
    for sample in [0.0, 1.0, 4_321.0, 77_777.0, 99_998.0, 99_999.0] {
        let x = history.at(0, sample * 0.01).expect("a moment").snapshot.robots[0].motion.pose.x;
        assert!((x - sample).abs() < 1e-6, "{x} at sample {sample}");
    }
    assert_eq!(**history.head(0).expect("a moment"), last);
    history.prepare_trail(0, 500.0);
    let end = history.trail(0, 500.0).and_then(Trail::time).expect("a trail");
    assert!((end - 500.0).abs() < 0.1, "{end} s");
}

/// A branch that leaves between two records that are kept begins with the moment that the run gives it.
#[test]
fn a_branch_of_a_thinned_past_begins_where_it_leaves() {
    let (mut history, mut record) = long(50_000);
    let sample = 33_334;
    record.snapshot.time = (sample - 1) as f64 * 0.01;
    assert_ne!(history.since(0, [record.snapshot.time - 0.005, record.snapshot.time + 0.005]).len(), 1);
    history.fork(0, sample);
    history.push(1, record.clone());
    assert_eq!(history.head(1).map(|head| time(head)), Some(record.snapshot.time));
    let before = all_of(history.trail(1, 1e9));
    history.push(1, record.clone());
    assert_eq!(all_of(history.trail(1, 1e9)), before, "what is known already changes nothing");
    let times: Vec<f64> = history.since(1, [-1.0, 1e9]).iter().map(|record| time(record)).collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
}

#[test]
fn curves_do_not_tremble_as_they_grow() {
    let (fleet, period, all) = records(THREE, 900);
    let mut history = History::new(fleet, period);
    let mut before: Vec<f64> = vec![];
    for record in &all {
        history.push(0, record.clone());
        let times: Vec<f64> = history.between(0, [0.0, f64::INFINITY], 100).iter().map(|m| time(m)).collect();
        assert!(times.len() <= 101, "{} points", times.len());
        assert_eq!(times.last(), Some(&time(record)), "the present is always there");
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "no moment twice: {times:?}");
        // Old points stay, or every second goes; only the present moves.
        let old = &before[..before.len().saturating_sub(1)];
        let stay = old.iter().filter(|time| times.contains(time)).count();
        assert!(stay == old.len() || (stay == old.len().div_ceil(2) && times.len() < old.len()), "{times:?}");
        before = times;
    }
    // A window that slides over the past shows the same records of it.
    let window = |from: f64| history.between(0, [from, from + 4.0], 100);
    let inside = |from: f64| -> Vec<f64> {
        let times = window(from).into_iter().map(time);
        times.filter(|time| (2.5..4.5).contains(time)).collect()
    };
    assert!(inside(2.0).len() > 20);
    assert_eq!(inside(2.0), inside(2.37));
}
