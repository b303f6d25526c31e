//! Custom laws in scenes: where their text comes from, what is checked of it, and how it is changed while a run goes.

use scene::{Law, LawSource, Scene, SceneText};
use std::fs;
use vocabulary::LawKind;

/// `laws/rust/examples/integral.rs`, built.
const MODULE: &[u8] = include_bytes!("../../laws/tests/modules/integral.wasm");
const THREE: &str = include_str!("../../../scenes/circle-three.toml");

/// A law with two parameters and a memory.
const LAW: &str = "# Proportional\nknows rates\nparameter k = 2 [1/s] in 0.5 .. 8 \"gain\"\nparameter c = 1 [m/s] in 0 .. 3 \"pace\"
memory n = 0\nn = n + 1\ncommand = k * (c - own.speed), 0\n";

/// The scene of three with lines added to it and overrides.
fn parse(lines: &str, set: &[&str]) -> Result<Scene, String> {
    let set: Vec<_> = set.iter().map(|set| set.parse().expect("an override")).collect();
    let loaded = Scene::parse(&format!("{THREE}\n{lines}"), "t.toml", &set);
    loaded.map(|loaded| loaded.scene).map_err(|faults| faults.to_string())
}

fn law<'a>(scene: &'a Scene, name: &str) -> &'a Law {
    let mut followers = scene.followers();
    &followers.find(|(follower, _)| *follower == name).expect("a follower").1.law
}

/// A law table with the text of a law.
fn table(law: &str) -> String {
    format!("[law]\ntext = '''\n{law}'''\n")
}

#[test]
fn a_law_comes_from_a_file_beside_the_scene_from_the_program_or_stands_in_the_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("t.toml");
    fs::write(folder.path().join("mine.law"), LAW).expect("a file");
    fs::write(&path, format!("{THREE}\n[law]\nfile = \"mine.law\"\nparameters = {{ k = 4 }}\n"))
        .expect("a file");
    let loaded = Scene::load(&path, &[]).expect("a scene");
    assert_eq!(loaded.files, [path, folder.path().join("mine.law")]);
    let own = law(&loaded.scene, "follower-1");
    assert_eq!(own.custom().map(|law| law.source().clone()), Some(LawSource::File("mine.law".to_owned())));
    assert_eq!((own.values(), own.built_in(), own.leaders()), (vec![4.0, 1.0], None, 1));

    let shipped = parse("[law]\nfile = \"robust-state\"\n", &[]).expect("a scene");
    let name = law(&shipped, "follower-1").custom().map(|law| law.name().to_owned());
    assert_eq!(name.as_deref(), Some("robust-state"));

    let within = parse(&table(LAW), &["law.parameters.c=2"]).expect("a scene");
    assert_eq!(law(&within, "follower-2").values(), [2.0, 2.0]);
}

#[test]
fn a_scene_is_written_with_the_text_of_its_laws_and_reads_back() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("mine.law"), LAW).expect("a file");
    let text = format!("{THREE}\n[law]\nfile = \"mine.law\"\nparameters = {{ k = 4 }}\n");
    let scene = Scene::parse(&text, folder.path().join("t.toml"), &[]).expect("a scene").scene;
    let alone = Scene::parse(&scene.to_toml(), "elsewhere.toml", &[]).expect("the same scene").scene;
    assert_eq!(
        law(&alone, "follower-1").custom().map(|law| law.text().map(str::to_owned)),
        Some(Some(LAW.trim().to_owned()))
    );
    assert_eq!(law(&alone, "follower-1").values(), [4.0, 1.0]);
    let mut edited = SceneText::parse(&text).expect("TOML");
    edited.embed_laws(&scene);
    let embedded = Scene::parse(&edited.text(), "elsewhere.toml", &[]).expect("the same scene");
    assert_eq!((embedded.files.len(), &embedded.scene), (1, &alone));
}

#[test]
fn a_module_is_told_by_its_bytes_and_stands_in_the_scene_packed() {
    let folder = tempfile::tempdir().expect("a folder");
    let home = folder.path().join("t.toml");
    fs::write(folder.path().join("mine.law"), MODULE).expect("a file");
    let text = format!("{THREE}\n[law]\nfile = \"mine.law\"\nparameters = {{ T = 2.0 }}\n");
    let scene = Scene::parse(&text, &home, &[]).expect("a scene").scene;
    let own = law(&scene, "follower-1");
    assert_eq!((own.values(), own.custom().and_then(|law| law.text())), (vec![5.0, 5.0, 2.0], None));
    let written = scene.to_toml();
    let alone = Scene::parse(&written, "elsewhere.toml", &[]).expect("the same scene").scene;
    let within = law(&alone, "follower-1");
    assert_eq!(
        within.custom().map(|law| (law.name(), law.source().clone())),
        Some(("law.module", LawSource::Scene))
    );
    assert_eq!((within.values(), alone.to_toml()), (vec![5.0, 5.0, 2.0], written));
    let mut edited = SceneText::parse(&text).expect("TOML");
    edited.embed_laws(&scene);
    let embedded = Scene::parse(&edited.text(), "elsewhere.toml", &[]).expect("the same scene");
    assert_eq!((embedded.files.len(), &embedded.scene), (1, &alone));
    // From one law to the other while a run goes, in words.
    let plain = parse("", &[]).expect("a scene");
    let sets = plain.sets_to(&scene).expect("a change");
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    assert!(sets.iter().any(|set| set.starts_with("robots.follower-1.law.module=")), "{sets:?}");
    assert_eq!(parse("", &sets).expect("a scene").robots, alone.robots);
    // What is set last chooses.
    let set = ["law.kind=full-state", "law.parameters={}"].map(|set| set.parse().expect("an override"));
    let kind = Scene::parse(&edited.text(), "t.toml", &set).expect("a scene").scene;
    assert_eq!(law(&kind, "follower-1").built_in(), Some(LawKind::FullState));
}

#[test]
fn every_mistake_of_a_module_is_told_where_it_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    // A module with nothing in it.
    fs::write(folder.path().join("mine.wasm"), b"\0asm\x01\0\0\0").expect("a file");
    let text = format!("{THREE}\n[law]\nfile = \"mine.wasm\"\n");
    let told = Scene::parse(&text, folder.path().join("t.toml"), &[]).expect_err("no law").to_string();
    for words in [
        "mine.wasm: it exports no `memory`",
        "mine.wasm: it exports no function `decide`",
        "file = \"mine.wasm\"",
    ] {
        assert!(told.contains(words), "{told}");
    }
    let told = scene::load_law(&folder.path().join("mine.wasm")).expect_err("no law").to_string();
    assert!(told.contains("mine.wasm: it exports no `memory`"), "{told}");
    for (packed, words) in [
        ("%%", "`module` has characters that nothing packed has: it is a module, packed"),
        ("S0xK", "`module` is cut off"),
        ("S0xKTgEA", "`module` unpacks to what is no WebAssembly module"),
    ] {
        let told = parse(&format!("[law]\nmodule = \"{packed}\"\n"), &[]).expect_err("no module");
        assert!(told.contains(words), "{told}");
    }
}

#[test]
fn what_is_set_last_or_nearest_to_the_robot_chooses_the_law() {
    let both = table(LAW);
    let kinds = |set: &[&str]| {
        let scene = parse(&both, set).expect("a scene");
        ["follower-1", "follower-2"].map(|name| law(&scene, name).built_in())
    };
    assert_eq!(kinds(&[]), [None, None]);
    assert_eq!(kinds(&["law.kind=full-state"]), [Some(LawKind::FullState); 2]);
    let one = "robots.follower-1.law.kind=full-state";
    assert_eq!(kinds(&[one]), [Some(LawKind::FullState), None]);
    assert_eq!(kinds(&[one, "robots.follower-1.law.file=integral"]), [None, None]);
    // Parameters belong to a law: one of its own begins with its defaults.
    let scene =
        parse(&both, &["law.parameters.k=4", "robots.follower-1.law.file=integral"]).expect("a scene");
    assert_eq!(law(&scene, "follower-1").values(), [5.0, 5.0, 1.0]);
    let scene =
        parse(&both, &["law.parameters.k=4", "robots.follower-1.law.parameters.c=0.5"]).expect("a scene");
    assert_eq!(law(&scene, "follower-1").values(), [4.0, 0.5]);
    // The text of a scene follows the same rule.
    let mut text = SceneText::parse(&format!("{THREE}\n{both}")).expect("TOML");
    text.set("law.file", "integral").expect("an edit");
    assert!(!text.text().contains("Proportional") && text.text().contains("file = \"integral\""));
    text.set("law.text", LAW).expect("an edit");
    assert!(
        !text.text().contains("file = ") && text.text().contains("\nparameter k = 2 [1/s]"),
        "{}",
        text.text()
    );
}

#[test]
fn every_mistake_has_its_place_and_says_what_would_be_right() {
    let wrong = LAW.replace("k * (c", "k * (leader.distance").replace("knows rates", "knows rats");
    for (lines, set, words) in [
        (table(&wrong), vec![], vec!["law.text:2:7", "law.text:7:", "rates", "m/s"]),
        (table(LAW), vec!["law.parameters.kk=4"], vec!["no parameter `kk`", "did you mean `k`"]),
        (table(LAW), vec!["law.parameters.k=40"], vec!["`k` must be from 0.5 to 8 1/s", "not 40"]),
        (table(LAW), vec!["law.parameters.k=fast"], vec!["`k` must be a number"]),
        (table(LAW), vec!["sensing.kind=noise"], vec!["law.text", "`knows`"]),
        (String::new(), vec!["law.parameters.k=4"], vec!["`parameters`", "custom law"]),
        (String::new(), vec!["law.file=integrl"], vec!["no such file", "did you mean `integral`"]),
        (table(""), vec![], vec!["law.text", "command"]),
    ] {
        let fault = parse(&lines, &set).expect_err("must be refused");
        for word in words {
            assert!(fault.contains(word), "{set:?}: {fault}");
        }
    }
}

#[test]
fn a_law_may_change_while_a_run_goes() {
    let scene = |set: &[&str]| parse(&table(LAW), set).expect("a scene");
    let faster = LAW.replace("k * (c", "2 * k * (c");
    let text = format!("law.text={faster}");
    for (set, words) in [
        (vec!["law.parameters.k=4"], "law.parameters={ k = 4.0 }"),
        (vec!["law.kind=output-feedback"], "law.kind=output-feedback"),
        (vec!["law.file=integral"], "law.file=integral"),
        (vec![&*text], "law.text=# Proportional\nknows rates"),
    ] {
        let next = scene(&set);
        let sets = scene(&[]).sets_to(&next).expect("a change");
        let begins = format!("robots.follower-1.{words}");
        assert!(sets.iter().any(|set| set.starts_with(&begins)), "{sets:?}");
        // What leads there in words does so when it is read.
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        assert_eq!(scene(&sets).robots, next.robots);
    }
    assert_eq!(scene(&[]).sets_to(&scene(&[])).expect("no change"), Vec::<String>::new());
}

#[test]
fn what_a_custom_law_does_not_use_is_told_once() {
    let lines = "[law]\nfile = \"integral\"\nbeta = [1.0, 1.0]\nslope = [2.0, 2.0]\n";
    assert_eq!(
        parse(lines, &[]).expect("a scene").unused(),
        [
            "`law.beta`, `law.slope` are for the built-in laws; integral does not use them: its own parameters are in \
             `law.parameters`"
        ]
    );
    let scene = parse(&table(LAW), &["law.k=4"]).expect("a scene");
    let told = scene.unused();
    assert_eq!(
        told[0],
        "`law.k` is for the built-in laws; law.text does not use them: its own: `law.parameters.k`"
    );
    // It drives at a pace of its own and reads no set point.
    assert!(
        told[1].starts_with("`follower-1` is given a distance to `leader`, which law.text does not read"),
        "{told:?}"
    );
    assert_eq!(told.len(), 1 + 2 * 2, "{told:?}");
    assert_eq!(parse("[law]\nk = [3.0, 3.0]\n", &[]).expect("a scene").unused(), [""; 0]);
}

#[test]
fn parameters_are_set_in_the_unit_that_they_are_declared_in() {
    let law_text =
        "parameter gap = 50 [mm] in 0 .. 2000\nparameter off = 10 [deg] in -90 .. 90\ncommand = 0, 0\n";
    let scene = parse(&table(law_text), &["law.parameters={ gap = 40, off = 90 }"]).expect("a scene");
    let own = law(&scene, "follower-1");
    assert_eq!(own.values(), [40.0, 90.0]);
    assert_eq!(own.told_values(), [0.04, std::f64::consts::FRAC_PI_2]);
    let fault = parse(&table(law_text), &["law.parameters.off=91"]).expect_err("out of range");
    assert!(fault.contains("`off` must be from -90 to 90 deg, as law.text says, not 91"), "{fault}");
}
