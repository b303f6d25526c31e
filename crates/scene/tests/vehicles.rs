//! Vehicles: what each kind has, what is written over it, and what contradicts itself.

use scene::{Compensation, Scene, Vehicle, VehicleKind};
use vocabulary::math;

/// A scene with one robot, `keys` at its top and `own` in the robot's table.
fn text(keys: &str, own: &str) -> String {
    format!(
        "schema = 1\ntitle = \"t\"\n{keys}\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\npath = {{ kind = \"constant\" }}\n{own}\n"
    )
}

#[track_caller]
fn vehicle(keys: &str, own: &str) -> Vehicle {
    let scene = Scene::parse(&text(keys, own), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let again = Scene::parse(&scene.to_toml(), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    assert_eq!(scene, again);
    scene.robots[0].vehicle
}

#[test]
fn each_kind_has_its_own_values_and_they_agree() {
    for kind in VehicleKind::ALL {
        let made = Vehicle::ready_made(kind);
        let word = serde_json::to_value(kind).unwrap();
        assert_eq!(made.kind, kind);
        assert_eq!(vehicle(&format!("vehicle = {word}"), ""), made);
        assert_eq!(vehicle("", &format!("vehicle.kind = {word}")), made);
        assert_eq!(vehicle("", &format!("vehicle.kind = {word}\n[physics]\nstep = 0.01")), made);
        assert_eq!(kind.has_wheels(), made.limits().lateral_acceleration_max.is_finite());
        assert_eq!(kind.steers(), made.limits().curvature_max.is_finite());
    }
    let car = Vehicle::ready_made(VehicleKind::Car);
    assert_eq!((car.mass, car.length, car.wheelbase, car.height), (5.01, 0.49, 0.30, 0.32));
    assert_eq!((car.steering_max, car.compensation), (28f64.to_radians(), Compensation::Lead));
    assert!((car.limits().curvature_max - math::tan(28f64.to_radians()) / 0.3).abs() < 1e-12);
    assert!((car.limits().lateral_acceleration_max - 0.8 * 0.9 * vocabulary::GRAVITY).abs() < 1e-12);
    assert_eq!(car.body().height, 0.32);
    assert_eq!(Vehicle::ready_made(VehicleKind::Unicycle), Vehicle::default());
}

#[test]
fn what_is_written_replaces_value_by_value() {
    let heavy = vehicle("[vehicle]\nkind = \"car\"\nmass = 6.0\nspring = 900", "vehicle.mass = 5.5");
    assert_eq!((heavy.kind, heavy.mass, heavy.spring), (VehicleKind::Car, 5.5, 900.0));
    assert_eq!(Vehicle { mass: 5.01, spring: 700.0, ..heavy }, Vehicle::ready_made(VehicleKind::Car));
    let turn = vehicle("vehicle = { kind = \"car\", steering_max = \"20 deg\" }", "");
    assert!((turn.steering_max - 20f64.to_radians()).abs() < 1e-12);
}

#[test]
fn another_kind_takes_nothing_from_the_scenes_vehicle() {
    let other =
        vehicle("[vehicle]\nkind = \"car\"\nmass = 6.0\nspeed_max = 2.0", "vehicle = \"differential\"");
    assert_eq!(other, Vehicle::ready_made(VehicleKind::Differential));
    let same = vehicle("[vehicle]\nkind = \"car\"\nmass = 6.0", "vehicle = \"car\"");
    assert_eq!(same.mass, 6.0);
}

#[test]
fn groups_have_vehicles_too() {
    let group =
        "[[groups]]\nshape = \"v\"\ncount = 3\nname = \"g\"\nleader = \"a\"\nvehicle = \"car\"\nscatter = 0";
    let scene = Scene::parse(&text("", group), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let kinds: Vec<_> = scene.robots.iter().map(|robot| robot.vehicle.kind).collect();
    assert_eq!(kinds, [VehicleKind::Unicycle, VehicleKind::Car, VehicleKind::Car]);
}

#[test]
fn only_what_means_something_is_written() {
    let toml = |keys| Scene::parse(&text(keys, ""), "t.toml", &[]).unwrap().scene.to_toml();
    let (unicycle, car, differential) =
        (toml(""), toml("vehicle = \"car\""), toml("vehicle = \"differential\""));
    assert!(!unicycle.contains("mass") && !unicycle.contains("steering_max"));
    assert!(car.contains("mass = 5.01") && car.contains("steering_max"));
    assert!(differential.contains("mass = 8.0") && !differential.contains("steering_max"));
}

/// Line of the scene's vehicle in [`text`].
const LINE: usize = 3;

#[test]
fn vehicles_that_cannot_be() {
    for (keys, column, words) in [
        ("vehicle = \"cat\"", 11, &["`vehicle` must be one of `unicycle`", "did you mean `car`?"][..]),
        ("vehicle = 3", 11, &["`vehicle` must be a table"]),
        (
            "vehicle = { mass = 3 }",
            20,
            &["`mass` has no effect", "`unicycle`", "`car`, `full-size-car`, `differential`"],
        ),
        (
            "vehicle = { kind = \"differential\", steering_lag = 0.1 }",
            51,
            &["`steering_lag` has no effect", "`car`"],
        ),
        ("vehicle = { kind = \"car\", mass = 0 }", 34, &["`mass`", "above 0"]),
        ("vehicle = { kind = \"car\", masss = 1 }", 27, &["unknown key", "`mass`?"]),
        (
            "vehicle = { kind = \"car\", steering_max = \"90 deg\" }",
            42,
            &["`steering_max`", "1 deg to 85 deg"],
        ),
        ("vehicle = { kind = \"car\", inertia_scale = 9 }", 43, &["`inertia_scale`", "from 0.2 to 5"]),
        ("vehicle = { kind = \"car\", mass_forward = 1.5 }", 42, &["`mass_forward`", "from 0 to 1"]),
        ("vehicle = { kind = \"car\", compensation = \"lag\" }", 42, &["`none`, `lead`"]),
        ("vehicle = { kind = \"car\", speed_min = 5 }", 39, &["`speed_min` of 5 m/s", "below"]),
        (
            "vehicle = { kind = \"car\", wheel_radius = 0.33 }",
            42,
            &["middle of a wheel", "0.33 m", "`height` of 0.32 m"],
        ),
        (
            "vehicle = { kind = \"car\", height = 0.05, mass_height = 0.01, clearance = 0.01 }",
            36,
            &["middle of a wheel", "0.05 m"],
        ),
        (
            "vehicle = { kind = \"car\", clearance = 0.4 }",
            39,
            &["`clearance` of 0.4 m", "`height` of 0.32 m"],
        ),
        (
            "vehicle = { kind = \"car\", mass_height = 0.5 }",
            41,
            &["`mass_height` of 0.5 m", "`height` of 0.32 m"],
        ),
        (
            "vehicle = { kind = \"car\", wheelbase = 0.7 }",
            39,
            &["`wheelbase` of 0.7 m", "`length` of 0.49 m"],
        ),
        ("vehicle = { kind = \"car\", track = 0.7 }", 35, &["`track` of 0.7 m", "`width` of 0.39 m"]),
        ("vehicle = { kind = \"car\", spring = 50 }", 36, &["do not carry 5.01 kg", "stiffer than 61 N/m"]),
        (
            "vehicle = { kind = \"car\", spring = 60000 }",
            36,
            &["too stiff for a physics step of 0.005 s", "softer than 50100 N/m", "a step below"],
        ),
        (
            "vehicle = { kind = \"car\", damping = 300 }",
            37,
            &["dampers are too stiff", "softer than 250.5 N s/m"],
        ),
        (
            "vehicle = { kind = \"car\", speed_max = 50 }",
            39,
            &["half its `width` of 0.39 m", "0.005 s", "slower than 39.0 m/s"],
        ),
    ] {
        let text = text(keys, "");
        let diagnostics = Scene::parse(&text, "t.toml", &[]).expect_err(keys);
        let [fault] = diagnostics.all() else { panic!("one fault expected for {keys}: {diagnostics}") };
        assert_eq!((fault.line, fault.column), (LINE, column), "{keys}: {fault}");
        for word in words {
            assert!(fault.message.contains(word), "`{word}` is not in: {}", fault.message);
        }
    }
}

#[test]
fn a_step_too_long_for_a_ready_made_vehicle_is_at_fault_itself() {
    let keys = "vehicle = \"differential\"\nphysics = { step = 0.02 }";
    let diagnostics = Scene::parse(&text(keys, ""), "t.toml", &[]).unwrap_err();
    let fault = &diagnostics.all()[0];
    assert_eq!((fault.line, fault.column), (4, 20), "{diagnostics}");
    assert!(fault.message.contains("dampers are too stiff"), "{diagnostics}");
}

#[test]
fn paths_tighter_than_the_wheels_turn() {
    let scene = text("vehicle = \"car\"", "").replace("\"constant\"", "\"circle\", radius = 0.5");
    let diagnostics = Scene::parse(&scene, "t.toml", &[]).unwrap_err();
    assert!(
        diagnostics.to_string().contains("a circle of 0.500 m, and `steering_max` allows 0.564 m"),
        "{diagnostics}"
    );
}

/// Gains that nobody wrote fit the vehicle; those that somebody wrote stay.
#[test]
fn gains_that_are_not_said_fit_the_vehicle() {
    let follower = "\n[[robots]]\nname = \"b\"\npose = [-2, -1, 0]\nspeed = 0.5\nleader = \"a\"\ndistance = 2\nbearing = 2.4";
    let gains = |keys: &str, own: &str| {
        let scene =
            Scene::parse(&text(keys, &format!("{follower}\n{own}")), "t.toml", &[]).expect("a scene").scene;
        let scene::Role::Follow(follow) = &scene.robots[1].role else { panic!("b follows") };
        (follow.law.k[0], follow.law.beta[0], follow.law.slope[0], follow.observer.epsilon[0])
    };
    assert_eq!(gains("", ""), (5.0, 5.0, 24.53, 0.001));
    assert_eq!(gains("vehicle = \"car\"", ""), (3.0, 3.0, 10.0, 0.02));
    assert_eq!(gains("", "vehicle = \"differential\""), (2.0, 1.5, 8.0, 0.02));
    assert_eq!(
        gains("vehicle = \"car\"\nlaw.k = 4", "law.slope = 7\nobserver.epsilon = 0.1"),
        (4.0, 3.0, 7.0, 0.1)
    );
}

/// Of a vehicle whose kind is misspelt nothing is said that depends on the kind.
#[test]
fn a_wrong_kind_is_one_error() {
    for (keys, own) in [
        ("", "vehicle = \"truck\""),
        ("", "vehicle = { kind = \"truck\", wheelbase = 0.3 }"),
        ("[vehicle]\nkind = \"truck\"\nwheelbase = 0.3", ""),
        (
            "",
            "[[groups]]\nshape = \"v\"\ncount = 3\nleader = \"a\"\nspeed = 9\nvehicle = \"truck\"\n[[robots]]\n\
             name = \"b\"\nleader = \"robot-3\"\npose = [-9, 0, 0]\ndistance = 2\nbearing = 3",
        ),
    ] {
        // Too fast for the usual kind; where the group has a kind of its own, its leader is no matter.
        let speed = if own.contains("groups") { "speed = 1" } else { "speed = 9" };
        let text = text(keys, own).replace("\"constant\"", &format!("\"constant\", {speed}"));
        let errors = Scene::parse(&text, "t.toml", &[]).expect_err("a wrong kind").to_string();
        assert_eq!(errors.matches("t.toml:").count(), 1, "{errors}");
        assert!(errors.contains("must be one of `unicycle`"), "{errors}");
    }
}
