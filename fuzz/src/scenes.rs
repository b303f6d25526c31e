//! Scene text, changes of the command line, CSV tables, storyboards.

use scene::{Override, Scene, shipped};
use simulation::Simulation;
use std::path::Path;

/// Robots up to which a scene that is accepted is also driven.
const FEW: usize = 12;
/// Samples that are driven.
const SAMPLES: usize = 3;

/// Any text is a scene, or is refused in words; a scene is written out to text that is the same scene, and can begin to run.
pub fn scene_text(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    check(&text, &[]);
}

/// Any `--set` is refused in words or changes the scene; one a line.
pub fn overrides(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let set: Vec<Override> = text.lines().filter_map(|line| line.parse().ok()).collect();
    let base = shipped("change-places").map_or("", |shipped| shipped.text);
    check(base, &set);
}

/// Any CSV file is a table of a lead's path (first byte even) or of heights, or is refused in words.
pub fn csv_table(data: &[u8]) {
    let Some((first, table)) = data.split_first() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("table.csv"), table).expect("written");
    let (path, ground) = match first % 2 {
        0 => ("kind = \"table\", file = \"table.csv\"", ""),
        _ => ("kind = \"constant\", speed = 1.0", "[ground]\nkind = \"table\"\nfile = \"table.csv\"\n"),
    };
    let text = format!(
        "schema = 1\ntitle = \"t\"\n[time]\nduration = 1.0\n{ground}[[robots]]\nname = \"a\"\npose = [0.0, 0.0, 0.0]\n\
         path = {{ {path} }}\n"
    );
    if let Err(faults) = Scene::parse(&text, folder.path().join("scene.toml"), &[]) {
        in_words(&faults.to_string());
    }
}

/// Any text behind `[film]` is a storyboard, or is refused in words.
pub fn storyboard(data: &[u8]) {
    let base = shipped("circle-three").map_or("", |shipped| shipped.text);
    let text = format!("{base}\n[film]\n{}", String::from_utf8_lossy(data));
    check(&text, &[]);
}

fn check(text: &str, set: &[Override]) {
    let scene = match Scene::parse(text, Path::new("scene.toml"), set) {
        Ok(loaded) => loaded.scene,
        Err(faults) => return in_words(&faults.to_string()),
    };
    if let Some(words) = scene.film.beyond(scene.time.duration) {
        in_words(&words);
    }
    let written = scene.to_toml();
    let again = Scene::parse(&written, Path::new("scene.toml"), &[]);
    let again =
        again.unwrap_or_else(|faults| panic!("what was written out is no scene:\n{faults}\n{written}")).scene;
    assert!(again == scene, "what was written out is another scene:\n{written}");
    if scene.robots.len() > FEW || scene.props.len() > FEW {
        return;
    }
    match simulation::build(&scene) {
        Ok(setup) => {
            let mut simulation = Simulation::new(setup);
            for _ in 0..SAMPLES {
                if simulation.next_record().is_none() {
                    break;
                }
            }
        }
        Err(error) => in_words(&error.to_string()),
    }
}

/// A message that somebody can read.
pub(crate) fn in_words(text: &str) {
    assert!(!text.is_empty() && text.len() < 100_000, "{} bytes of message", text.len());
    assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text:?}");
}
