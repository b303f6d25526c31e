//! Going back, changing something and running on is exact: the same samples, bit for bit, as one run that never stopped.

use crate::common::{THREE, checked, run, scene, with};
use lab::session::branches::{Branches, script};

/// A law from Rust, with a memory.
const MODULE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../laws/tests/modules/integral.wasm");

/// Samples between two saved states at first.
const MARK: u64 = 100;

/// A branch that can be changed by editing the text of its scene.
struct Hand {
    base: String,
    text: String,
    all: Branches,
    branch: usize,
}

impl Hand {
    fn new(text: &str) -> Self {
        let all = Branches::open(scene(text), |_| ()).expect("a run");
        Self { base: text.to_owned(), text: text.to_owned(), all, branch: 0 }
    }

    fn sample(&self) -> u64 {
        self.all.list()[self.branch].simulation().sample()
    }

    fn digest(&self) -> String {
        self.all.list()[self.branch].digest()
    }

    fn to(&mut self, sample: u64) {
        while self.sample() < sample {
            self.all.advance(self.branch).expect("a moment");
        }
    }

    fn set(&mut self, sets: &[(&str, &str)]) {
        self.text = with(&self.text, sets);
        self.all.change(self.branch, &checked(&self.text)).expect("a change");
    }

    /// A branch off `from` with the text that holds there.
    fn fork(&mut self, from: usize, sample: u64, text: &str) {
        self.branch = self.all.fork(from, sample, "fork".to_owned()).expect("a branch");
        text.clone_into(&mut self.text);
        assert_eq!(self.sample(), sample);
    }

    /// The scene with the changes runs as the branch ran.
    fn check_script(&self, what: &str) {
        let branch = &self.all.list()[self.branch];
        let duration = (self.sample() - 1) as f64 * branch.simulation().period();
        let text =
            script(&self.base, &scene(&self.base).changes, &branch.changes, duration).expect("a script");
        assert_eq!(run(&text), (self.sample(), self.digest()), "{what}\n{text}");
    }
}

/// Every way of running.
fn ways() -> Vec<(&'static str, String)> {
    let three = |sets: &[(&str, &str)]| with(THREE, sets);
    vec![
        ("sampled", THREE.to_owned()),
        ("measured", three(&[("time.mode", "measured"), ("observer.epsilon", "0.05")])),
        ("continuous", three(&[("time.mode", "continuous"), ("observer.epsilon", "0.01")])),
        ("noise", three(&[("sensing", "{ kind = \"noise\", latency = 0.05, drop = 0.2 }")])),
        ("tags", three(&[("sensing", "{ kind = \"geometric\" }")])),
        ("unscented", three(&[("sensing", "{ kind = \"noise\" }"), ("observer.kind", "unscented")])),
        ("a law with a memory", three(&[("law.file", "integral")])),
        ("a module with a memory", three(&[("law.file", MODULE)])),
        ("cars", include_str!("../../../../scenes/cars-line-three.toml").to_owned()),
        ("kinds", include_str!("../../../../scenes/cars-mixed.toml").to_owned()),
        ("a rough field", include_str!("../../../../scenes/cars-rough.toml").to_owned()),
        ("props", include_str!("../../../../scenes/cars-crash.toml").to_owned()),
        ("moving set points", include_str!("../../../../scenes/moving-set-point.toml").to_owned()),
        ("a V", include_str!("../../../../scenes/seven-v.toml").to_owned()),
        ("own changes", own_changes()),
    ]
}

/// A scene that changes by itself, early.
fn own_changes() -> String {
    format!(
        "{THREE}\n[[changes]]\nat = 0.8\nset = [\"law.k=5\", \"robots.left.distance=1.7\"]\n\n\
         [[changes]]\nat = 1.6\nset = [\"robots.left.bearing=150 deg\"]\n"
    )
}

#[test]
fn going_back_and_running_on_is_the_same_run() {
    for (way, text) in ways() {
        let mut hand = Hand::new(&text);
        let mut records = vec![];
        let end = 2 * MARK + 30;
        for _ in 0..end {
            records.push(hand.all.advance(0).expect("a moment").clone());
        }
        for sample in [0, 1, MARK - 1, MARK, MARK + 1, 2 * MARK + 7, end] {
            hand.fork(0, sample, &text);
            while hand.sample() < end {
                let at = hand.sample() as usize;
                let record = hand.all.advance(hand.branch).expect("a moment");
                assert_eq!(*record, records[at], "{way}: sample {at} after going back to {sample}");
            }
            assert_eq!(hand.digest(), hand.all.list()[0].digest(), "{way}: from {sample}");
        }
    }
}

#[test]
fn going_back_in_a_long_run_is_exact_though_few_states_are_kept() {
    let text =
        with(THREE, &[("time.period", "0.05"), ("observer.epsilon", "0.1"), ("time.mode", "measured")]);
    let mut hand = Hand::new(&text);
    let end = 2500;
    hand.to(end);
    for (from, sample) in [(0, 1), (0, 41), (0, 1000), (0, 1999), (0, end), (3, 1500), (4, 20)] {
        hand.fork(from, sample, &text);
        hand.to(end);
        assert_eq!(hand.digest(), hand.all.list()[0].digest(), "from {sample} of {from}");
    }
}

/// A change, by its name and what it sets.
type Set<'a> = (&'a str, &'a [(&'a str, &'a str)]);

#[test]
fn a_run_with_changes_is_that_of_the_scene_with_changes() {
    let sets: [Set<'_>; 7] = [
        ("a set point", &[("robots.left.distance", "1.8"), ("robots.left.bearing", "\"150 deg\"")]),
        ("gains", &[("law.k", "[4.0, 2.5]"), ("law.beta", "3.0")]),
        ("the gain of one", &[("robots.right.law.k", "2.0")]),
        ("the observer", &[("observer.epsilon", "0.03")]),
        ("the law", &[("law.kind", "robust-state")]),
        ("the law again", &[("law.kind", "output-feedback"), ("observer.alpha1", "3.0")]),
        ("limits", &[("vehicle.speed_max", "1.4"), ("vehicle.turn_rate_max", "2.0")]),
    ];
    let plain = with(THREE, &[("observer.epsilon", "0.05")]);
    // Who looks for himself is not told the rates.
    let looking: Set<'_> = ("the slope", &[("law.slope", "12.0")]);
    for (way, sets_of_way) in [
        ("sampled", vec![]),
        ("measured", vec![("time.mode", "measured")]),
        ("continuous", vec![("time.mode", "continuous")]),
        ("noise", vec![("sensing", "{ kind = \"noise\", latency = 0.05 }")]),
        ("cars", vec![("vehicle", "car")]),
    ] {
        let mut hand = Hand::new(&with(&plain, &sets_of_way));
        let mut before = hand.digest();
        for (number, (what, sets)) in sets.iter().enumerate() {
            hand.to(20 + 23 * number as u64);
            assert_ne!(hand.digest(), before);
            before = hand.digest();
            let (what, sets) = if way == "noise" && *what == "the law" { &looking } else { &(*what, *sets) };
            hand.set(sets);
            hand.to(hand.sample() + 17);
            hand.check_script(&format!("{way}: {what}"));
        }
        assert_eq!(hand.all.list()[0].changes.len(), sets.len());
    }
}

#[test]
fn changes_while_the_run_stands_are_one() {
    let mut hand = Hand::new(THREE);
    hand.to(50);
    for k in ["4.0", "5.0", "6.0"] {
        hand.set(&[("law.k", k)]);
    }
    hand.set(&[("robots.left.distance", "1.5")]);
    assert_eq!(hand.all.list()[0].changes.len(), 1);
    assert_eq!(hand.all.list()[0].changes[0].sample, 50);
    hand.to(90);
    // There and back again is no change.
    hand.set(&[("law.k", "9.0")]);
    hand.set(&[("law.k", "6.0")]);
    assert_eq!(hand.all.list()[0].changes.len(), 1);
    hand.to(140);
    hand.check_script("standing");
}

#[test]
fn a_change_at_the_very_start_holds_from_the_start() {
    let mut hand = Hand::new(THREE);
    hand.set(&[("law.k", "6.0")]);
    hand.to(60);
    let changed = with(THREE, &[("law.k", "6.0"), ("time.duration", "0.59")]);
    assert_eq!(run(&changed).1, hand.digest());
    hand.check_script("at the start");
}

#[test]
fn a_change_that_is_refused_changes_nothing() {
    let mut hand = Hand::new(THREE);
    hand.to(30);
    hand.set(&[("law.k", "5.0")]);
    let other = checked(&with(&hand.text, &[("robots.left.pose", "[-3.0, 1.0, 0.0]")]));
    let refusal = hand.all.change(0, &other).expect_err("where it starts is past");
    assert!(refusal.contains("pose"), "{refusal}");
    assert_eq!(hand.all.list()[0].changes.len(), 1, "what was changed before stays changed");
    hand.to(80);
    hand.check_script("after a refusal");
}

#[test]
fn changes_before_a_fork_are_shared_and_later_ones_are_not() {
    let mut hand = Hand::new(THREE);
    hand.to(120);
    hand.set(&[("law.k", "5.0")]);
    let first = hand.text.clone();
    hand.to(250);
    hand.set(&[("robots.left.distance", "1.6")]);
    hand.to(300);
    let trunk = hand.digest();
    // Before, at, and after the first change; at and after the second.
    for (sample, text, shared) in
        [(90, THREE, 0), (120, THREE, 0), (121, &first, 1), (200, &first, 1), (250, &first, 1), (251, "", 2)]
    {
        hand.fork(0, sample, if text.is_empty() { &first } else { text });
        assert_eq!(hand.all.list()[hand.branch].changes.len(), shared, "at {sample}");
        hand.to(sample + 10);
        if !text.is_empty() {
            hand.set(&[("observer.epsilon", "0.03")]);
            assert_eq!(hand.all.list()[hand.branch].changes.len(), shared + 1, "at {sample}");
        }
        hand.to(300);
        hand.check_script(&format!("a branch from {sample}"));
        assert_eq!(hand.digest() == trunk, text.is_empty(), "from {sample}");
    }
    // A branch of a branch.
    let of = hand.all.list().iter().position(|branch| branch.parent == Some((0, 200))).expect("a branch");
    let text = with(&first, &[("observer.epsilon", "0.03")]);
    hand.fork(of, 220, &text);
    hand.to(240);
    hand.set(&[("robots.right.bearing", "\"-150 deg\"")]);
    hand.to(280);
    hand.check_script("a branch of a branch");
    assert_eq!(hand.all.list()[0].digest(), trunk, "branches leave the trunk alone");
}

/// What the scene itself has planned still comes, and what was tuned stays tuned.
#[test]
fn changes_by_hand_and_changes_of_the_scene_add_up() {
    for when in [30, 80, 100, 170] {
        let mut hand = Hand::new(&own_changes());
        hand.to(when);
        hand.set(&[("robots.right.distance", "1.6"), ("law.k", "2.0")]);
        hand.to(when + 5);
        hand.set(&[("robots.right.law.beta", "1.0")]);
        hand.to(220);
        hand.check_script(&format!("by hand at {when}"));
        // The same again in a branch that leaves in between.
        let text = hand.text.clone();
        hand.fork(0, when + 20, &text);
        hand.to(220);
        assert_eq!(hand.digest(), hand.all.list()[0].digest(), "by hand at {when}, in a branch");
    }
}

/// Tuning that is taken back leaves a scene's own changes as they were.
#[test]
fn what_is_taken_back_is_as_if_it_had_not_been() {
    let plain = own_changes();
    let mut untouched = Hand::new(&plain);
    untouched.to(220);
    let mut hand = Hand::new(&plain);
    for sample in [40, 80, 120] {
        hand.to(sample);
        hand.set(&[("law.k", "7.0"), ("robots.right.distance", "1.5")]);
        hand.set(&[("law.k", "3.0 "), ("robots.right.distance", "2.0")]);
        assert!(hand.all.list()[0].changes.is_empty(), "at {sample}");
    }
    hand.to(220);
    assert_eq!(hand.digest(), untouched.digest());
    hand.check_script("untouched");
}
