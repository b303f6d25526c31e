//! Sweeps of the present scene: their runs are those of the program, and what they show holds until the scene is another.

use crate::common::{Rig, THREE, app_state, with};
use lab::action::Action;
use lab::app_state::AppState;
use lab::app_state::sweep_plan::{SweepPlan, SweepSide};
use lab::app_state::sweep_state::SweepProgress;
use lab::session::sweeper::Sweeper;
use scene::Study;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::Duration;
use sweeps::{ChartQuantity, Experiment, Progressed, RunRow, run_all};

/// Three robots that measure with noise, for a second.
pub(crate) fn short() -> String {
    with(
        THREE,
        &[("time.duration", "1.0"), ("sensing.kind", "noise"), ("expect.final_distance_error", "0.2")],
    )
}

/// A key over a range.
pub(crate) fn side(key: &str, [from, to]: [f64; 2], count: u32) -> SweepSide {
    SweepSide { key: key.to_owned(), from, to, count, logarithmic: false, degrees: false }
}

/// A sweep of these sides.
pub(crate) fn plan(sides: &[SweepSide], seeds: u32) -> SweepPlan {
    SweepPlan { sides: sides.to_vec(), seeds, quantity: ChartQuantity::Met }
}

/// Makes a sweep to its end, as the window does.
pub(crate) fn sweep(app_state: &mut AppState, plan: &SweepPlan) {
    sweep_until(app_state, plan, u64::MAX);
}

/// Makes a sweep until so many rows have come.
pub(crate) fn sweep_until(app_state: &mut AppState, plan: &SweepPlan, rows: u64) {
    let (wake, wakes) = channel();
    let mut sweeper = Sweeper::new(move || wake.send(()).unwrap_or(()));
    app_state.act(&Action::StartSweep(plan.clone()));
    let under_way = |app_state: &AppState| {
        let sweep = &app_state.sweep;
        let running = matches!(sweep.progress, SweepProgress::Checking | SweepProgress::Running);
        running && sweep.result.as_ref().is_none_or(|result| result.done < rows)
    };
    while under_way(app_state) {
        for request in app_state.sweep.requests.drain(..) {
            sweeper.request(&request);
        }
        match sweeper.next_event() {
            Some(event) => app_state.handle_sweep_event(event),
            None => wakes.recv_timeout(Duration::from_mins(1)).expect("an event"),
        }
    }
}

/// Why a sweep was refused.
fn refusal(app_state: &mut AppState, sides: &[SweepSide]) -> String {
    sweep(app_state, &plan(sides, 1));
    assert!(app_state.sweep.result.is_none());
    match &app_state.sweep.progress {
        SweepProgress::Refused(why) => why.clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn runs_are_those_of_the_program() {
    let mut app_state = app_state(&short(), 1);
    let sides = [side("law.k", [1.0, 8.0], 3), side("observer.epsilon", [0.01, 0.1], 2)];
    sweep(&mut app_state, &plan(&sides, 2));
    assert_eq!(app_state.sweep.progress, SweepProgress::Complete);
    let result = app_state.sweep.result.as_ref().expect("a result");
    let mut rows: Vec<RunRow> = (0..6).flat_map(|cell| result.rows(cell).to_vec()).collect();
    rows.sort_by_key(|row| row.point.index);

    // As `echelon sweep SCENE --vary law.k=1..8/3 --vary observer.epsilon=0.01..0.1/2 --seeds 2` makes them.
    let parameter = |key: &str, values: &str| scene::StudyParameter {
        key: key.to_owned(),
        values: values.parse().expect("values"),
    };
    let parameters = vec![parameter("law.k", "1..8/3"), parameter("observer.epsilon", "0.01..0.1/2")];
    let study = Study { parameters, seeds: 2, ..Study::of_scene("t.toml", "t") };
    let experiment = Experiment::of_text(study, &short(), PathBuf::from("t.toml")).expect("an experiment");
    let mut wanted = vec![];
    let take = |progressed| {
        wanted.extend(match progressed {
            Progressed::Ended(row) => Some(RunRow { wall_time: 0.0, ..row }),
            Progressed::Waited => None,
        });
        Ok::<bool, ()>(true)
    };
    run_all(&experiment, 0..12, 2, &|| 0.0, take).expect("runs");
    wanted.sort_by_key(|row| row.point.index);
    // What is no number equals nothing, but is written alike.
    assert_eq!(format!("{rows:?}"), format!("{wanted:?}"));
    let digests: std::collections::BTreeSet<&String> = rows.iter().map(|row| &row.digest).collect();
    assert_eq!(digests.len(), 12, "every run is another");
    for (cell, summary) in result.cells.iter().enumerate() {
        let met = rows[2 * cell..2 * cell + 2].iter().filter(|row| row.met).count() as u64;
        assert_eq!((summary.cell, summary.runs, summary.met), (cell as u64, 2, met));
    }
}

#[test]
fn what_a_sweep_shows_holds_until_the_scene_is_another() {
    let mut app_state = app_state(&short(), 1);
    sweep(&mut app_state, &plan(&[side("law.k", [1.0, 8.0], 2)], 1));
    assert_eq!(app_state.sweep_outdated(), None);
    let set = |key: &str, value: &str| Action::Set {
        what: "Changed".to_owned(),
        values: vec![(key.to_owned(), value.to_owned())],
    };
    // What is swept, and what is seen alone, makes no other runs.
    for (key, value) in [("law.k", "4.5"), ("title", "\"Another\""), ("seed", "9")] {
        app_state.act(&set(key, value));
        assert_eq!(app_state.sweep_outdated(), None, "{key}");
    }
    app_state.act(&set("law.beta", "2.5"));
    let what = app_state.sweep_outdated().expect("another scene");
    assert_eq!(what, "robots.left.law.beta = 2.5");
    app_state.act(&Action::Undo);
    assert_eq!(app_state.sweep_outdated(), None);
    app_state.act(&set("expect.final_distance_error", "0.1"));
    assert_eq!(app_state.sweep_outdated().as_deref(), Some("expect"));
    sweep(&mut app_state, &plan(&[side("law.k", [1.0, 8.0], 2)], 1));
    assert_eq!(app_state.sweep_outdated(), None);
}

#[test]
fn what_cannot_be_swept_is_said_with_what_can() {
    let gain = || side("law.k", [1.0, 8.0], 2);
    let mut plain = app_state(&short(), 1);
    assert!(refusal(&mut plain, &[SweepSide { to: 0.5, ..gain() }]).contains("does not rise"));
    let why = refusal(&mut plain, &[SweepSide { from: -1.0, ..gain() }]);
    assert!(why.contains("`law.k` cannot be -1"), "{why}");
    assert_eq!(why.lines().count(), 1, "{why}");
    let why = refusal(&mut plain, &[side("law.kk", [1.0, 2.0], 2)]);
    assert!(why.contains("law.kk"), "{why}");
    assert!(refusal(&mut plain, &[gain(), gain()]).contains("law.k"));
    let wide = SweepSide { count: 1000, ..gain() };
    assert!(
        refusal(&mut plain, &[wide.clone(), side("law.beta", [1.0, 2.0], 1000)]).contains("20000 at most")
    );
    let mut sees = app_state(&with(&short(), &[("sensing.kind", "camera")]), 0);
    let why = refusal(&mut sees, &[gain()]);
    assert!(why.contains("sensing.kind=geometric"), "{why}");
    // Nothing to sweep is no fault.
    AppState::new().act(&Action::StartSweep(plan(&[gain()], 1)));
}

#[test]
fn a_sweep_that_is_stopped_keeps_its_rows_and_another_scene_forgets_them() {
    let mut app_state = app_state(&short(), 1);
    sweep_until(&mut app_state, &plan(&[side("law.k", [1.0, 8.0], 300)], 1), 2);
    app_state.act(&Action::StopSweep);
    assert_eq!((&app_state.sweep.progress, app_state.sweep.requests.len()), (&SweepProgress::Stopped, 1));
    let result = app_state.sweep.result.as_ref().expect("a result");
    assert_eq!((result.done, result.runs()), (2, 300));
    // The plan stays where the same scene is read again.
    app_state.open(short(), None, Path::new("t.toml")).expect("a scene");
    assert!(app_state.sweep.result.is_some() && app_state.sweep.plan.is_some());
    app_state.open(short(), None, Path::new("u.toml")).expect("a scene");
    assert!(app_state.sweep.result.is_none() && app_state.sweep.plan.is_none());
    assert_eq!(app_state.sweep.progress, SweepProgress::Idle);
}

#[test]
fn a_cell_is_gone_to_as_any_edit_is_made() {
    let mut rig = Rig::new(&short());
    rig.steps(20);
    let go = Action::Set {
        what: "From the sweep: law.k = 4.5".to_owned(),
        values: vec![("law.k".to_owned(), "4.5".to_owned())],
    };
    rig.act(&[go]);
    rig.steps(5);
    let told = rig.told(0);
    assert_eq!(told.changes.len(), 1, "the run goes on, with the value from the next sample");
    assert!(rig.text().contains("k = 4.5 # not too stiff"), "{}", rig.text());
    rig.act(&[Action::Undo]);
    assert!(rig.text().contains("k = 3.0 # not too stiff"));
}

#[test]
fn the_command_makes_the_same_sweep() {
    let mut shipped = AppState::new();
    let text = scene::shipped("circle-three").expect("a scene").text;
    shipped.open(text.to_owned(), None, Path::new("circle-three.toml")).expect("a scene");
    let angle = SweepSide { degrees: true, ..side("robots.follower-1.bearing", [-135.0, -90.0], 4) };
    let epsilon = SweepSide { logarithmic: true, ..side("observer.epsilon", [0.0001, 0.01], 9) };
    let both = plan(&[epsilon, angle], 3);
    let command = shipped.sweep_command(&both).expect("a command");
    let line = "echelon sweep circle-three --vary observer.epsilon=log:0.0001..0.01/9 \
        --vary 'robots.follower-1.bearing=-135..-90 deg/4' --seeds 3";
    assert_eq!((&*command.text, command.same), (line, true));
    // What no file has stands in the line; what is swept does not.
    let set = |values: &[(&str, &str)]| Action::Set {
        what: "Changed".to_owned(),
        values: values.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect(),
    };
    shipped.act(&set(&[("law.k", "4.0"), ("observer.epsilon", "0.002")]));
    let command = shipped.sweep_command(&both).expect("a command");
    assert!(command.same && command.text.contains("--set 'robots.follower-1.law.k="), "{command:?}");
    assert!(!command.text.contains(".epsilon=["), "{command:?}");
    shipped.act(&set(&[("time.duration", "3.0")]));
    assert!(!shipped.sweep_command(&both).expect("a command").same, "it has to be saved first");
    assert!(!app_state(THREE, 0).sweep_command(&both).expect("a command").same, "it stands in no file");
}
