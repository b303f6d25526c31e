//! A robot with several leaders: how it gets them by hand, and what panels and drags do with each.

use crate::common::{Rig, THREE, app_state};
use crate::panels::{assert_says, panel, says, texts};
use lab::action::Action;
use lab::app_state::{AppState, Selection};
use lab::panels::{edge, formation};
use lab::view::annotations::{PointerState, annotations};
use vocabulary::math;

/// A diamond: the last of four keeps its distances to the two in the middle.
fn diamond() -> String {
    let back = "\n[[robots]]\nname = \"back\"\npose = [-3.2, 0.2, 0.0]\nspeed = 0.8\nlaw = { file = \"two-distances\" }\n\
        leaders = [{ name = \"left\", distance = 2.0 }, { name = \"right\", distance = 2.0 }]\n";
    THREE.to_owned() + back
}

fn text(app_state: &AppState) -> &str {
    app_state.draft.as_ref().expect("a draft").text()
}

#[test]
fn a_second_leader_comes_with_a_law_for_two() {
    let mut rig = Rig::new(&format!(
        "{THREE}\n[[robots]]\nname = \"back\"\npose = [-3.2, 0.2, 0.0]\nleader = \"left\"\ndistance = 2.0\nbearing = \"-135 deg\"\n"
    ));
    rig.act(&[Action::Connect { leader: 2, follower: 3, adds: true }]);
    assert_eq!(rig.app_state.notice, None);
    let wanted = "leaders = [{ name = \"left\", distance = 1.45 }, { name = \"right\", distance = 1.7 }]";
    assert!(rig.text().contains(wanted) && rig.text().contains("two-distances"), "{}", rig.text());
    let fleet = rig.app_state.history.as_ref().expect("a run").fleet();
    assert_eq!((fleet.edges.len(), fleet.has_several_leaders(3)), (4, true));
    // With one again, its law is the paper's again.
    rig.act(&[Action::Connect { leader: 0, follower: 3, adds: false }]);
    assert_eq!(rig.app_state.notice, None);
    assert!(!rig.text().contains("leaders") && !rig.text().contains("two-distances"), "{}", rig.text());
    rig.act(&[Action::Undo]);
    assert!(rig.text().contains(wanted), "{}", rig.text());
    // For three there is no such law, and nobody follows in a ring through any leader.
    rig.act(&[Action::Connect { leader: 0, follower: 3, adds: true }]);
    let notice = rig.app_state.notice.take().expect("a notice");
    assert!(notice.contains("`back` has 3 leaders, and its law looks at 2"), "{notice}");
    rig.act(&[Action::Connect { leader: 3, follower: 2, adds: false }]);
    let notice = rig.app_state.notice.take().expect("a notice");
    assert!(notice.contains("right → back → right"), "{notice}");
    rig.act(&[Action::RemoveRobot("right".to_owned())]);
    let notice = rig.app_state.notice.take().expect("a notice");
    assert!(notice.contains("right stays: back follows it"), "{notice}");
}

#[test]
fn a_distance_is_set_for_the_leader_that_is_meant() {
    let mut rig = Rig::new(&diamond());
    rig.steps(50);
    rig.act(&[Action::SetPoint { edge: 3, distance: 1.75, bearing: 1.0 }, Action::Release]);
    assert_eq!(rig.app_state.notice, None);
    assert!(rig.text().contains("{ name = \"right\", distance = 1.75 }"), "{}", rig.text());
    assert!(!rig.text().contains("bearing = \"57"), "a free bearing stays free: {}", rig.text());
    assert_eq!(rig.app_state.set_point(3).map(|[distance, _]| distance), Some(1.75));
    let branch = rig.told(rig.app_state.branch);
    assert_eq!(branch.changes.len(), 1, "the run goes on");
    assert_eq!(branch.changes[0].set, ["robots.back.leaders.right.distance=1.75"]);
    // The whole formation scales, each by what is wanted of it.
    rig.act(&[Action::Shape { scale: 2.0, turn: 0.0 }, Action::Release]);
    assert_eq!(rig.app_state.notice, None);
    assert!(rig.text().contains("{ name = \"left\", distance = 4.0 }"), "{}", rig.text());
}

#[test]
fn panels_list_a_robot_once_and_all_its_leaders() {
    let mut state = app_state(&diamond(), 5);
    state.act(&Action::Select(Selection::Robot(3)));
    let bench = panel(state, formation::show);
    assert_eq!(texts(&bench).iter().filter(|text| *text == "back").count(), 1, "{:#?}", texts(&bench));
    assert_says(&bench, &["+ right"]);
    let mut state = app_state(&diamond(), 5);
    state.act(&Action::Select(Selection::Edge(3)));
    assert_eq!((state.chosen_edge(), state.beside(3)), (Some(3), vec![2, 3]));
    let bench = panel(state, edge::show);
    assert_says(&bench, &["left → back", "right → back", "free"]);
    assert!(!says(&bench, "Mirror the other side"));
}

#[test]
fn rings_and_circles_show_where_each_leader_wants_it() {
    let mut state = app_state(&diamond(), 5);
    state.act(&Action::Select(Selection::Edge(3)));
    let record = state.record().expect("a moment");
    let drawn = annotations(&state, &record, &PointerState::default());
    let place = |robot: usize| record.snapshot.robots[robot].motion.pose;
    // Both rings, and both dashed circles around the two leaders.
    assert_eq!(drawn.rings.len(), 2);
    let circles: Vec<_> = drawn.strokes.iter().filter(|stroke| stroke.dashed).collect();
    assert_eq!(circles.len(), 2);
    for (circle, leader) in circles.into_iter().zip([1, 2]) {
        let middle = place(leader);
        for spot in &circle.spots {
            let away = math::hypot(spot.at[0] - middle.x, spot.at[1] - middle.y);
            assert!((away - 2.0).abs() < 1e-9, "{away}");
        }
    }
    assert!(text(&state).contains("leaders = ["));
}
