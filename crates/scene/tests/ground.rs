//! Ground: reliefs, grip, tables of heights, and a scene that uses everything.

use scene::{Ground, Relief, Scene, schema};
use serde_json::Value as Json;
use std::fs;

fn text(ground: &str) -> String {
    format!(
        "schema = 1\ntitle = \"t\"\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\npath.kind = \"constant\"\n{ground}\n"
    )
}

#[track_caller]
fn ground(keys: &str) -> Ground {
    let scene = Scene::parse(&text(keys), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let again = Scene::parse(&scene.to_toml(), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    assert_eq!(scene, again);
    scene.ground
}

#[test]
fn flat_ground_has_no_terrain_unless_it_grips_otherwise() {
    assert!(ground("").terrain.is_none() && ground("[ground]").terrain.is_none());
    let wet = ground("[ground]\nfriction = 0.5").terrain.unwrap();
    assert_eq!((wet.at(100.0, -40.0).grip, wet.at(3.0, 4.0).height), (0.5, 0.0));
}

#[test]
fn patches_grip_inside_and_nowhere_else() {
    let ice = "[ground]\nkind = \"flat\"\n[[ground.patches]]\nregion = [2, -1, 5, 1]\nfriction = 0.2\n\
               [[ground.patches]]\nregion = [4, 0, 8, 3]\nfriction = 0.6";
    let terrain = ground(ice).terrain.unwrap();
    for (x, y, grip) in [
        (3.0, 0.0, 0.2),
        (2.0, -1.0, 0.2),
        (4.5, 0.5, 0.6),
        (1.85, 0.0, 1.0),
        (-50.0, 0.0, 1.0),
        (50.0, 50.0, 1.0),
    ] {
        assert!((terrain.at(x, y).grip - grip).abs() < 1e-9, "{} at {x}, {y}", terrain.at(x, y).grip);
    }
    let region =
        |more: &str| format!("[ground]\nkind = \"rough\"\nregion = [-3, -3, 3, 3]\nfriction = 0.9\n{more}");
    let rough =
        ground(&region("[[ground.patches]]\nregion = [-1, -1, 1, 1]\nfriction = 0.3")).terrain.unwrap();
    assert!((rough.at(0.0, 0.0).grip - 0.3).abs() < 1e-12 && (rough.at(9.0, 0.0).grip - 0.9).abs() < 1e-12);
}

#[test]
fn rough_ground_and_hills_follow_their_recipe() {
    let keys = "region = [1, -4, 9, 4]\namplitude = 0.05\nwavelength = 2.0";
    let rough = ground(&format!("[ground]\nkind = \"rough\"\n{keys}"));
    let [low, high] = rough.terrain.as_ref().unwrap().range();
    assert!((high.max(-low) - 0.05).abs() < 1e-12);
    let Relief::Rough(noise) = rough.relief else { panic!("rough ground") };
    assert_eq!((noise.seed, noise.cell), (1, 0.1));
    assert_eq!(rough.terrain.as_ref().unwrap().at(0.0, 0.0).height, 0.0);
    let hills = ground(&format!("[ground]\nkind = \"hills\"\n{keys}"));
    assert_ne!(hills.terrain.unwrap().heights, rough.terrain.as_ref().unwrap().heights);
    let other = ground(&format!("[ground]\nkind = \"rough\"\nseed = 8\n{keys}"));
    assert_ne!(other.terrain, rough.terrain);
}

#[test]
fn heights_come_from_files_and_stay_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, table) = (folder.path().join("s.toml"), folder.path().join("h.csv"));
    fs::write(&scene, text("[ground]\nkind = \"table\"\nfile = \"h.csv\"\ncell = 2\norigin = [-2, 1]"))
        .unwrap();
    fs::write(&table, "# metres\n0, 0.5, 1\n0.25,0.75,1.25\n").unwrap();
    let loaded = Scene::load(&scene, &[]).unwrap_or_else(|fault| panic!("{fault}"));
    assert_eq!(loaded.files, [scene.clone(), table.clone()]);
    let terrain = loaded.scene.ground.terrain.clone().unwrap();
    assert_eq!((terrain.columns, terrain.rows, terrain.origin), (3, 2, [-2.0, 1.0]));
    assert_eq!((terrain.at(0.0, 1.0).height, terrain.at(2.0, 3.0).height), (0.5, 1.25));
    let again = Scene::parse(&loaded.scene.to_toml(), "elsewhere.toml", &[]).unwrap();
    assert_eq!(again.scene, loaded.scene);

    for (rows, line, words) in [
        ("0,1,2\n0,,2\n", 2, "row 2, column 2: a hole"),
        ("0,1,2\n0,nan,2\n", 2, "row 2, column 2 must be a number in m from -1000 to 1000, not \"nan\""),
        ("0,1,2\n0,high,2\n", 2, "not \"high\""),
        ("0,1,2\n0,1\n", 2, "row 2 has 2 heights and the first row 3: there is no height from column 3 on"),
        ("0,1,2\n0,1,2,3\n", 2, "more heights from column 4 on"),
        ("0;1;2\n", 1, "not \"0;1;2\"; the file is separated by `;`: use commas"),
        ("0,1,2\n", 1, "two rows of two"),
        ("", 1, "two rows of two"),
    ] {
        fs::write(&table, rows).unwrap();
        let diagnostics = Scene::load(&scene, &[]).unwrap_err();
        let [fault] = diagnostics.all() else { panic!("one fault expected: {diagnostics}") };
        assert_eq!((fault.origin.as_str(), fault.line), (table.to_str().unwrap(), line), "{fault}");
        assert!(fault.message.contains(words), "{fault}");
    }
}

#[test]
fn grounds_that_cannot_be() {
    let rough = "[ground]\nkind = \"rough\"\nregion = [0, 0, 5, 5]";
    let table = "[ground]\nkind = \"table\"\ncell = 1";
    for (keys, line, words) in [
        ("[ground]\nkind = \"rouhg\"", 8, "did you mean `rough`?"),
        ("[ground]\nkind = \"rough\"", 7, "`region` is missing"),
        ("[ground]\namplitude = 1", 8, "unknown key `amplitude`"),
        (&format!("{rough}\ncell = 0.5"), 10, "at most a quarter of `wavelength`"),
        (&rough.replace("5, 5", "5000, 5000"), 9, "50001 × 50001 points"),
        (
            &format!("{rough}\n[[ground.patches]]\nregion = [1, 1, 6, 2]\nfriction = 0.5"),
            11,
            "must lie inside the ground",
        ),
        (
            &format!("{rough}\n[[ground.patches]]\nregion = [1, 1, 1.01, 2]\nfriction = 0.5"),
            11,
            "as wide and long as a `cell`",
        ),
        (&format!("{rough}\n[[ground.patches]]\nregion = [1, 1, 2, 2]"), 10, "`friction` is missing"),
        (table, 7, "either `heights` or `file`"),
        (&format!("{table}\nheights = [[0, 1], [0]]"), 10, "row 2 has 1 height and the first row 2"),
        (&format!("{table}\nheights = [[0, 1], [0, nan]]"), 10, "`heights` must be a number in m"),
        (&format!("{table}\nheights = [[0, 1]]"), 10, "two rows of two"),
        (&format!("{table}\nfile = \"nowhere.csv\""), 10, "no such file"),
        (
            "[ground]\n[[ground.patches]]\nregion = [0, 0, 1, 1]\nfriction = 1\n[[ground.patches]]\nregion = [900, 900, 901, 901]\nfriction = 1",
            9,
            "take a larger `cell`",
        ),
    ] {
        let diagnostics = Scene::parse(&text(keys), "t.toml", &[]).expect_err(keys);
        let [fault] = diagnostics.all() else { panic!("one fault expected for {keys}: {diagnostics}") };
        assert_eq!(fault.line, line, "{keys}: {fault}");
        assert!(fault.message.contains(words), "{fault}");
    }
}

/// A scene with every table and most keys there are.
const EVERYTHING: &str = include_str!("everything.toml");

/// TOML as JSON; what JSON cannot say is left to the largest number.
fn json(text: &str) -> Json {
    let text = text.replace(" = inf", " = 1e300");
    serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap()
}

#[test]
fn a_scene_with_everything_survives_being_written_and_fits_the_schema() {
    let scene = Scene::parse(EVERYTHING, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let text = scene.to_toml();
    let again = Scene::parse(&text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}\n{text}")).scene;
    assert_eq!(scene, again);
    assert_eq!(text, again.to_toml());
    assert_eq!((scene.robots.len(), scene.props.len()), (5, 3 + 5 + 12));
    let validator = jsonschema::validator_for(&schema()).unwrap();
    for text in [EVERYTHING, &text] {
        let faults: Vec<_> = validator
            .iter_errors(&json(text))
            .map(|fault| format!("{}: {fault}", fault.instance_path()))
            .collect();
        assert!(faults.is_empty(), "{faults:?}");
    }
}

#[test]
fn the_schema_knows_the_physical_world() {
    let schema = schema();
    let top = &schema["properties"];
    for key in ["physics", "ground", "props", "patterns", "vehicle"] {
        assert!(top[key]["description"].is_string(), "{key}");
    }
    let vehicle = &top["vehicle"]["anyOf"][1]["properties"];
    let about = vehicle["mass"]["description"].as_str().unwrap();
    assert!(about.contains("car 5.01, full-size-car 1500.0, differential 8.0"), "{about}");
    let expect = &top["expect"]["properties"];
    for key in ["contacts_exactly", "contact_impulse_within", "all_able", "settled_after", "lift_at_most"] {
        assert!(expect[key].is_object(), "{key}");
    }
    let shapes = top["props"]["items"]["oneOf"].as_array().unwrap();
    assert_eq!(shapes.len(), 5);
    assert!(shapes.iter().all(|shape| shape["properties"]["restitution"].is_object()));
}
