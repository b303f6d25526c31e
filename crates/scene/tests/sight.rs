//! What followers see: read, completed, and refused where it cannot be.

use scene::{Role, Scene, SensingKind};
use std::path::Path;
use vocabulary::ObserverKind;

/// Two robots, the second a follower; `more` goes to the top, `follower` into its table.
fn text(more: &str, follower: &str, bearing: &str) -> String {
    format!(
        "schema = 1\ntitle = \"t\"\n{more}\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\n\
         path = {{ kind = \"constant\", speed = 1.0 }}\n[[robots]]\nname = \"b\"\npose = [-2, -1, 0]\nleader = \"a\"\n\
         distance = 2.0\nbearing = \"{bearing}\"\n{follower}\n"
    )
}

fn read(text: &str) -> Result<Scene, String> {
    Scene::parse(text, Path::new("t.toml"), &[])
        .map(|loaded| loaded.scene)
        .map_err(|faults| faults.to_string())
}

fn refused(text: &str, parts: &[&str]) {
    let faults = read(text).expect_err(text);
    for part in parts {
        assert!(faults.contains(part), "`{part}` is not in: {faults}");
    }
}

#[test]
fn sensing_is_a_word_or_a_table_and_each_robots_own() {
    let scene =
        read(&text("[sensing]\nkind = \"camera\"\nrate = 25.0\n", "sensing = \"geometric\"", "-135 deg"));
    let scene = scene.expect("a good scene");
    let Role::Follow(follow) = &scene.robots[1].role else { panic!("`b` follows") };
    assert_eq!((follow.sensing.kind, follow.sensing.rate), (SensingKind::Geometric, 25.0));
    assert_eq!((scene.robots[0].number, scene.robots[1].number), (0, 1));
    let again = read(&scene.to_toml()).expect("what was written");
    assert_eq!(again, scene);
}

#[test]
fn epsilon_follows_from_noise_unless_it_is_said() {
    let adaptive = |more: &str| {
        let scene = read(&text(more, "", "-135 deg")).expect("a good scene");
        let Role::Follow(follow) = &scene.robots[1].role else { panic!("`b` follows") };
        assert_eq!(follow.observer.kind, ObserverKind::HighGain);
        follow.observer.adaptive
    };
    assert!(adaptive(""));
    assert!(!adaptive("[observer]\nepsilon = 0.001\n"));
    assert!(adaptive("[observer]\nepsilon = 0.001\nadaptive = true\n"));
}

#[test]
fn numbers_that_are_not_given_are_the_lowest_that_are_free() {
    let scene = read(&text("", "number = 0", "-135 deg")).expect("a good scene");
    assert_eq!((scene.robots[0].number, scene.robots[1].number), (1, 0));
}

const CAMERA: &str = "[sensing]\nkind = \"camera\"\n";

#[test]
fn a_tag_belongs_to_one_shell() {
    let twice = text("", "number = 3", "-135 deg").replace("name = \"a\"\n", "name = \"a\"\nnumber = 3\n");
    refused(&twice, &["`number` 3 is that of `a`", "tags 15 to 19", "t.toml:"]);
}

#[test]
fn absurd_cameras_are_refused_with_their_range() {
    let with = |line: &str| text(&format!("{CAMERA}[vision]\n{line}\n"), "", "-135 deg");
    refused(&with("field_of_view = \"179 deg\""), &["from 5 deg to 150 deg"]);
    refused(&with("resolution = [8, 480]"), &["32 to 4096"]);
    refused(&with("resolution = [640, 100000]"), &["32 to 4096"]);
    refused(&with("exposure = 0.0"), &["exposure", "above 0"]);
    refused(&with("shutter = 3.0"), &["shutter", "0.1"]);
    refused(&text("[sensing]\nkind = \"camera\"\nrate = 0.0\n", "", "-135 deg"), &["rate", "0.1"]);
    refused(&text("[sensing]\nkind = \"eyes\"\n", "", "-135 deg"), &["`truth`", "`camera`"]);
}

#[test]
fn a_camera_inside_its_own_shell_sees_nothing() {
    let inside = text(&format!("{CAMERA}[vision]\ncamera_height = 0.2\n"), "", "-135 deg");
    refused(&inside, &["the camera of `b` is inside its own shell", "camera_height", "0.280 m"]);
    let before =
        text(&format!("{CAMERA}[vision]\ncamera_height = 0.2\ncamera_forward = 0.25\n"), "", "-135 deg");
    read(&before).expect("in front of it is fine");
}

#[test]
fn tags_fit_their_faces() {
    let large = text(&format!("{CAMERA}[vision]\ntag_cell = 0.03\n"), "", "-135 deg");
    refused(&large, &["`tag_cell` 0.03 m", "0.240 m", "too large"]);
}

#[test]
fn a_leader_that_can_never_be_seen_is_told_before_the_run() {
    refused(&text(CAMERA, "", "10 deg"), &["`b` can never see its leader", "10 deg", "|bearing|"]);
    let far = text(CAMERA, "", "180 deg").replace("distance = 2.0", "distance = 9.0");
    refused(&far, &["`b` can never see its leader", "9 m", "shell_scale"]);
    let larger = text(&format!("{CAMERA}[vision]\nshell_scale = 2.5\n"), "", "180 deg");
    read(&larger.replace("distance = 2.0", "distance = 9.0")).expect("a larger shell is seen");
}

#[test]
fn measurements_that_lose_the_leader_between_them_are_refused() {
    let late = text("[sensing]\nkind = \"camera\"\nlatency = 0.6\n", "", "-135 deg");
    refused(&late, &["`b` would lose its leader", "0.633 s", "`hold` is 0.5 s"]);
    refused(&text("[sensing]\nkind = \"noise\"\nrate = 1.0\n", "", "-135 deg"), &["`hold`"]);
}

#[test]
fn a_leader_beyond_the_cameras_reach_is_told_before_the_run() {
    let with = |line: &str| text(&format!("{CAMERA}[vision]\n{line}\n"), "", "-135 deg");
    refused(&with("pan_max = \"10 deg\""), &["45 deg off straight ahead", "`pan_max` of 10 deg"]);
    refused(&with("field_of_view = \"5 deg\""), &["more than the picture has", "`field_of_view`"]);
    refused(&text(CAMERA, "", "-135 deg").replace("distance = 2.0", "distance = 6.5"), &["1.75"]);
}

#[test]
fn there_are_tags_for_so_many_robots_only() {
    let crowd = |kind: &str| {
        format!(
            "schema = 1\ntitle = \"t\"\n[sensing]\nkind = \"{kind}\"\n[[groups]]\nshape = \"v\"\ncount = 120\n\
             path = {{ kind = \"constant\", speed = 1.0 }}\n"
        )
    };
    refused(&crowd("geometric"), &["117 robots only"]);
    read(&crowd("noise")).expect("noise needs no tags");
}

#[test]
fn laws_that_have_to_know_more_and_continuous_time_are_refused() {
    refused(
        &text(&format!("{CAMERA}[law]\nkind = \"full-state\"\n"), "", "-135 deg"),
        &["`full-state`", "output-feedback"],
    );
    refused(
        &text(&format!("{CAMERA}[time]\nmode = \"continuous\"\n"), "", "-135 deg"),
        &["continuous", "`b`", "sampled"],
    );
}

#[test]
fn a_frame_rate_need_not_fit_the_period() {
    read(&text("[sensing]\nkind = \"camera\"\nrate = 29.97\n", "", "-135 deg")).expect("any rate will do");
}

#[test]
fn expectations_on_looks_are_read() {
    let more =
        "[expect]\nsettled_after = 1.0\nsettled_rms_at_most = [0.03, \"1.5 deg\"]\nin_view_at_least = 0.99\n";
    let scene = read(&text(more, "", "-135 deg")).expect("a good scene");
    assert_eq!(scene.expect.in_view_at_least, Some(0.99));
    refused(
        &text("[expect]\nsettled_rms_at_most = [0.03, 0.01]\n", "", "-135 deg"),
        &["`settled_after` is missing"],
    );
}
