//! Paths of lead robots and guided props: what can be driven is driven as it is written, the rest is refused.

use scene::Scene;
use simulation::{Fault, Simulation, build};
use vocabulary::math;

fn scene(path: &str, more: &str) -> Scene {
    let text = format!(
        "schema = 1\ntitle = \"t\"\ntime = {{ duration = 12.0 }}\n[[robots]]\nname = \"ann\"\npose = [0, 0, 0]\n\
         path = {path}\n{more}"
    );
    Scene::parse(&text, "paths.toml", &[]).unwrap_or_else(|faults| panic!("{faults}")).scene
}

fn refusal(path: &str, more: &str) -> String {
    build(&scene(path, more)).err().map_or_else(String::new, |error| error.to_string())
}

/// Two legs of 4 m with a turn by so many degrees between them.
fn turn(degrees: f64) -> [[f64; 2]; 3] {
    let back = (180.0 - degrees).to_radians();
    [[0.0, 0.0], [4.0, 0.0], [4.0 - 4.0 * math::cos(back), 4.0 * math::sin(back)]]
}

fn waypoints(points: &[[f64; 2]]) -> String {
    format!("{{ kind = \"waypoints\", points = {points:?}, speed = 1.0 }}")
}

#[test]
fn a_way_that_turns_back_is_refused_with_its_point_and_what_helps() {
    let told = refusal(&waypoints(&[[0.0, 0.0], [4.0, 0.0], [0.0, 0.0]]), "");
    assert!(told.contains("`ann`") && told.contains("point 2, [4, 0]"), "{told}");
    assert!(told.contains("turns back on the spot") && told.contains("a radius of 0 m there"), "{told}");
    assert!(told.contains("needs at least 0.087 m; add points that lead round"), "{told}");
    let patrol = [[0.0, 0.0], [4.0, 0.0], [0.0, 0.0], [4.0, 0.0], [0.0, 0.0]];
    let told = refusal(&waypoints(&patrol), "");
    assert!(told.contains("turns back on the spot") && told.contains("a radius of 0 m there"), "{told}");
    let told = refusal(&waypoints(&turn(170.0)), "");
    assert!(told.contains("move the points apart, or add points that lead round"), "{told}");
    assert!(told.contains("point 2, [4, 0]") && told.contains("allows 11.5 rad/s"), "{told}");
    assert!(told.contains("or go at no more than 0.1"), "{told}");
    let closed =
        r#"{ kind = "waypoints", closed = true, points = [[0, 0], [4, 0], [8, 0], [4, 0]], speed = 1.0 }"#;
    let told = refusal(closed, "");
    assert!(told.contains("point 3, [8, 0] it turns back"), "{told}");
    // Slow enough it can be driven; but not once it has become fast.
    let paced = |speed: &str| waypoints(&turn(170.0)).replace("speed = 1.0", &format!("speed = {speed}"));
    assert_eq!(refusal(&paced("{ distance = [[0, 1.0], [3.9, 0.1], [4.1, 0.1], [5, 1.0]] }"), ""), "");
    assert!(refusal(&paced("{ time = [[0, 0.1], [5, 1.5]] }"), "").contains("point 2"));
}

#[test]
fn every_kind_of_path_is_held_against_the_limits() {
    let car = "vehicle = \"car\"\n";
    for (path, more, told) in [
        (r#"{ kind = "figure-eight", speed = 1.0, length = 0.3 }"#, "", "50.4 rad/s"),
        (r#"{ kind = "figure-eight", speed = 1.0, length = 5.0 }"#, car, "`steering_max`"),
        (
            r#"{ kind = "sinusoid", speed = 1.0, turn_rate_amplitude = 2.0, turn_rate_rate = 1.0 }"#,
            car,
            "rad/s",
        ),
        (r#"{ kind = "table", rows = [[0, 1.0, 0.0], [2, 1.0, 1.9]] }"#, car, "`steering_max`"),
        (r#"{ kind = "constant", speed = 3.9, turn_rate = 2.0 }"#, car, "tyres"),
    ] {
        let found = refusal(path, more);
        assert!(found.contains("`ann`") && found.contains(told), "{path}: {found:?}");
    }
    assert_eq!(refusal(r#"{ kind = "figure-eight", speed = 1.0, length = 12.0 }"#, car), "");
}

#[test]
fn limits_that_change_on_the_way_count_from_then_on() {
    let change =
        |at: f64| format!("[[changes]]\nat = {at}\nset = [\"robots.ann.vehicle.turn_rate_max=0.5\"]\n");
    let path = waypoints(&turn(90.0));
    assert_eq!(refusal(&path, ""), "");
    assert_eq!(refusal(&path, &change(8.0)), "", "the turn is over");
    assert!(refusal(&path, &change(2.0)).contains("allows 0.5 rad/s"));
}

#[test]
fn guided_props_turn_as_the_physics_can_follow() {
    let prop = |path: &str| {
        format!("[[props]]\nname = \"shuttle\"\nshape = \"block\"\nsize = [0.3, 0.3, 0.3]\npath = {path}\n")
    };
    let straight = r#"{ kind = "constant" }"#;
    let told = refusal(straight, &prop(&waypoints(&[[9.0, 5.0], [4.0, 5.0], [9.0, 5.0]])));
    assert!(told.contains("`shuttle`") && told.contains("point 2, [4, 5]"), "{told}");
    let aside = |degrees: f64| waypoints(&turn(degrees).map(|[x, y]| [x, y + 5.0]));
    let told = refusal(straight, &prop(&aside(175.0)));
    assert!(told.contains("a physics step of 0.005 s allows 20 rad/s"), "{told}");
    assert_eq!(refusal(straight, &prop(&aside(150.0))), "");
}

/// With a limit that allows it, the sharpest turns are driven: way-points are passed within a centimetre.
#[test]
fn sharp_turns_are_driven_through_their_points() {
    for degrees in [90.0, 150.0, 170.0, 176.0] {
        let points = turn(degrees);
        let limits = "vehicle = { kind = \"unicycle\", turn_rate_max = 1000.0 }\n";
        let mut run = Simulation::new(build(&scene(&waypoints(&points), limits)).expect("a run"));
        let mut nearest = [f64::INFINITY; 3];
        while let Some(record) = run.next_record() {
            let pose = record.snapshot.robots[0].motion.pose;
            for (near, [x, y]) in nearest.iter_mut().zip(points) {
                // Between two samples it goes 1 cm.
                *near = near.min((math::hypot(pose.x - x, pose.y - y) - 0.005).max(0.0));
            }
        }
        assert!(nearest.iter().all(|near| *near < 0.01), "{degrees}°: {nearest:?} m");
    }
}

/// A law so stiff that it overflows: the run stops before such a number gets anywhere.
#[test]
fn a_number_that_is_not_finite_ends_the_run_and_is_named() {
    let follower = "[[robots]]\nname = \"bob\"\npose = [-1, 0, 0]\nleader = \"ann\"\ndistance = 2.0\nbearing = 2.5\n\
                    vehicle = { speed_min = 1e-300 }\nlaw = { k = 1e6, beta = 1e6 }\n";
    let mut run = Simulation::new(build(&scene(r#"{ kind = "constant" }"#, follower)).expect("a run"));
    while let Some(record) = run.next_record() {
        assert!(record.edges[0].asked.turn_rate.is_finite());
    }
    assert!(run.record().edges[0].asked.turn_rate.is_finite(), "nobody gets to see it");
    let Some(Fault::NotFinite(what)) = run.fault() else { panic!("{:?}", run.fault()) };
    assert!(what.to_string().starts_with("the command asked for of `ann` → `bob`"), "{what}");
}
