//! `echelon capture` and `echelon film`: the files they make.

use crate::common::{echelon, files, scene, told};
use serde_json::Value;
use std::fs;
use std::path::Path;

#[test]
fn capture_writes_one_picture_per_time_and_view_words_are_obeyed() {
    let folder = tempfile::tempdir().expect("a folder");
    let args = [
        "capture",
        &scene("circle-three"),
        "--at",
        "5,0",
        "--size",
        "320x180",
        "-o",
        "shots",
        "--view",
        "snake+top",
    ];
    let (code, out, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    let names: Vec<String> = files(&folder.path().join("shots"))
        .iter()
        .map(|p| p.file_name().expect("a name").to_string_lossy().into())
        .collect();
    assert_eq!(names, ["circle-three-000.000.png", "circle-three-005.000.png"]);
    assert_eq!(out.lines().count(), 2);
    let bytes = fs::read(folder.path().join("shots/circle-three-000.000.png")).expect("a picture");
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    // Width and height stand at a fixed place in the first chunk.
    assert_eq!((&bytes[16..20], &bytes[20..24]), (&320_u32.to_be_bytes()[..], &180_u32.to_be_bytes()[..]));
}

#[test]
fn times_a_hair_apart_are_files_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    let args =
        ["capture", &scene("circle-three"), "--at", "1,1.00001,2", "--size", "64x36", "-q", "-o", "shots"];
    let (code, _, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    assert_eq!(files(&folder.path().join("shots")).len(), 3);
}

#[test]
fn the_same_picture_twice_is_the_same_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut pictures = vec![];
    for out in ["a", "b"] {
        let args = ["capture", &scene("seven-v"), "--at", "3", "--size", "256x144", "-q", "-o", out];
        assert_eq!(told(&echelon(folder.path(), &args)).0, 0);
        pictures.push(fs::read(folder.path().join(out).join("seven-v-003.000.png")).expect("a picture"));
    }
    assert_eq!(pictures[0], pictures[1]);
}

#[test]
fn a_film_has_one_frame_per_tick_of_simulation_time() {
    let folder = tempfile::tempdir().expect("a folder");
    let short = ["--set", "time.duration=0.5", "--size", "160x90", "--json"];
    for (out, fps, frames) in [("film.mp4", "20", 10), ("film.gif", "10", 5), ("frames", "6", 3)] {
        let scene = scene("circle-three");
        let args = [&["film", &*scene, "-o", out, "--fps", fps], &short[..]].concat();
        let (code, text, err) = told(&echelon(folder.path(), &args));
        assert_eq!(code, 0, "{out}: {err}");
        let report: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(report["frames"], frames);
        assert!(folder.path().join(out).exists(), "{out} is missing");
    }
    assert_eq!(files(&folder.path().join("frames")).len(), 3);
    assert_eq!(&fs::read(folder.path().join("film.mp4")).expect("a film")[4..8], b"ftyp");
    assert_eq!(&fs::read(folder.path().join("film.gif")).expect("a film")[..6], b"GIF89a");
}

#[test]
fn notes_name_the_flag_that_they_are_about() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("circle-three");
    let small = ["capture", &*scene, "--size", "64x64", "--at"];
    for (more, note) in [
        (&["0,0.1,0.1"][..], "--at names 3 times for 2 pictures: those that are the same share one\n"),
        (&["0,0,0", "-q"], ""),
        (
            &["0", "--inset-camera", "follower-1"],
            "--inset-camera shows the picture of that robot without detections: no follower has a sensor in this scene; \
             try sensing.kind=camera\n",
        ),
        (
            &["0", "--overlay", "--view", "camera:follower-1"],
            "--overlay has no detections to show: no follower",
        ),
    ] {
        let (code, _, err) = told(&echelon(folder.path(), &[&small[..], more].concat()));
        let lines = err.lines().filter(|line| !line.starts_with("replaced ")).collect::<Vec<_>>().join("\n");
        assert!(code == 0 && lines.starts_with(note.trim_end()), "{err}");
        assert_eq!(lines.is_empty(), note.is_empty(), "{err}");
    }
}

#[test]
fn doctor_names_the_adapter_it_would_draw_with() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, text, err) = told(&echelon(folder.path(), &["doctor", "--json"]));
    assert_eq!(code, 0, "{err}");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    assert!(!report["adapters"].as_array().expect("a list").is_empty());
    assert!(report["opened"].is_string());
}

/// The scene file and the pictures know the same views.
#[test]
fn every_view_a_scene_may_name_can_be_drawn() {
    let schema = scene::schema();
    let views = find_views(&schema).expect("the schema lists the views");
    assert!(views.len() >= 5, "{views:?}");
    let names = ["ann".to_owned()];
    for view in views {
        rendering::Viewpoint::parse(&view, &names).unwrap_or_else(|e| panic!("{view}: {e}"));
    }
}

/// The list of words that has `snake-eye` in it.
fn find_views(value: &Value) -> Option<Vec<String>> {
    match value {
        Value::Array(items) if items.iter().any(|i| i == "snake-eye") => {
            Some(items.iter().filter_map(|i| i.as_str().map(str::to_owned)).collect())
        }
        Value::Array(items) => items.iter().find_map(find_views),
        Value::Object(map) => map.values().find_map(find_views),
        _ => None,
    }
}

/// Views and elements of pictures stood in errors alone. The help and the book name those that the program takes.
#[test]
fn views_and_elements_are_documented_as_they_are_taken() {
    let folder = tempfile::tempdir().expect("a folder");
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/start.md");
    let page = fs::read_to_string(page).expect("a page");
    let (_, table) = page.split_once("| element | what it is |").expect("a table of elements");
    let rows = table.lines().skip(2).map_while(|row| row.strip_prefix("| `")?.split('`').next());
    assert_eq!(rows.collect::<Vec<_>>(), rendering::Style::ELEMENTS);
    let (_, help, _) = told(&echelon(folder.path(), &["capture", "--help"]));
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    let elements = rendering::Style::ELEMENTS.join(", ");
    assert!(help.contains(&format!("any of {elements} ")), "{help}");
    // The error is made of the list that is taken.
    let names = ["ROBOT".to_owned()];
    let error = rendering::Viewpoint::parse("nowhere", &names).expect_err("no view").to_string();
    let (_, views) = error.split_once("views are ").expect("a list");
    let (views, _) = views.rsplit_once(", and several").expect("its end");
    let mut views: Vec<&str> = views.split(", ").collect();
    assert!(views.len() == 7 && views.contains(&"fixed:ex,ey,ez,tx,ty,tz[,degrees]"), "{error}");
    views.push("fixed");
    for view in views {
        assert!(help.contains(view), "{view} is not in: {help}");
        assert!(page.contains(&format!("`{view}`")), "{view} is not in docs/start.md");
        let example = view.replace("ex,ey,ez,tx,ty,tz[,degrees]", "0,-12,6,0,3,0,30");
        rendering::Viewpoint::parse(&example, &names).expect(view);
    }
}

/// Keyboards write é as one character or as two: a name is found in views by both, as everywhere.
#[test]
fn names_in_views_are_found_however_their_accents_are_typed() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "schema = 1\ntitle = \"t\"\ntime = { duration = 1.0 }\n[[robots]]\nname = \"\u{e9}\"\npose = [0, 0, 0]\n\
                path = { kind = \"constant\", speed = 1.0 }\n";
    fs::write(folder.path().join("accent.toml"), text).expect("written");
    // A folder that is called like a scene hides no scene.
    fs::create_dir(folder.path().join("line-three")).expect("made");
    let (code, _, err) = told(&echelon(folder.path(), &["check", "line-three"]));
    assert_eq!(code, 0, "{err}");
    for view in ["follow:\u{e9}", "follow:e\u{301}"] {
        let args = ["capture", "accent.toml", "--at", "0", "--size", "64x64", "--view", view];
        let (code, _, err) = told(&echelon(folder.path(), &args));
        assert_eq!(code, 0, "{view}: {err}");
    }
    let (code, _, err) = told(&echelon(folder.path(), &["capture", "accent.toml", "--adapter", ""]));
    assert!(code == 2 && err.contains("--adapter"), "{code}: {err}");
}
