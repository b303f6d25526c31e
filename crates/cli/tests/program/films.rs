//! Storyboards, presets, stills: films worth showing.

use crate::common::{echelon, files, scene, told};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Two robots for two seconds, and what a test puts behind it.
fn write_scene(folder: &Path, film: &str) {
    let head = "schema = 1\ntitle = \"Two\"\ntime = { duration = 2.0 }\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\n\
        path = { kind = \"constant\", speed = 1.0 }\n[[robots]]\nname = \"b\"\npose = [-2, -1, 0]\nspeed = 0.8\n\
        leader = \"a\"\ndistance = 2.0\nbearing = \"-135 deg\"\n";
    fs::write(folder.join("two.toml"), format!("{head}{film}")).expect("written");
}

const BOARD: &str = "[film]\ntitle = 0.5\nend = 1.0\nfps = 10\n[[film.shots]]\nto = 0.5\nview = \"snake\"\n\
    set_points = true\n[[film.shots]]\nfrom = 1.0\nto = 1.5\nview = \"snake+top\"\nspeed = 0.5\n\
    plots = [\"speed\"]\nline = \"slowly\"\n";

#[test]
fn a_storyboard_is_followed_and_the_same_film_is_the_same_file() {
    let folder = tempfile::tempdir().expect("a folder");
    write_scene(folder.path(), BOARD);
    let args = ["film", "two.toml", "--size", "128x72", "--samples", "1", "-q", "-o", "frames"];
    let (code, _, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    // Half a second of title, half a second of run, half a second at half speed, a second of end card.
    let frames = files(&folder.path().join("frames"));
    assert_eq!(frames.len(), 5 + 5 + 10 + 10);
    let picture = |k: usize| fs::read(&frames[k]).expect("a picture");
    // Cards stand still once they are there; the run between them moves.
    assert!(picture(28) == picture(29) && picture(4) != picture(0) && picture(7) != picture(8));
    let mut films = vec![];
    for name in ["a.mp4", "b.mp4"] {
        let args = ["film", "two.toml", "--size", "64x36", "--samples", "1", "-q", "-o", name];
        assert_eq!(told(&echelon(folder.path(), &args)).0, 0);
        films.push(fs::read(folder.path().join(name)).expect("a film"));
    }
    assert_eq!(films[0], films[1]);
    // Nothing is left of what was kept in case of an interruption.
    assert!(files(folder.path()).iter().all(|path| !path.to_string_lossy().contains("journal")));
}

/// A run that is stopped by a contact has no picture after that, and its card at once.
#[test]
fn a_film_ends_with_its_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let (run, film) = ("physics = { on_contact = \"stop\" }\n", "[film]\nend = 0.5\nfps = 20\n");
    let wall =
        "[[props]]\nname = \"wall\"\nshape = \"block\"\nsize = [0.2, 2.0, 0.5]\npose = [1.2, 0.0, 0.0]\n";
    for (board, cards) in [("[film]\nfps = 20\n", 0), (film, 10)] {
        write_scene(folder.path(), &format!("[vehicle]\nkind = \"car\"\n{wall}{board}"));
        let text = fs::read_to_string(folder.path().join("two.toml")).expect("a scene");
        fs::write(folder.path().join("two.toml"), text.replacen("time =", &format!("{run}time ="), 1))
            .expect("written");
        let args = ["film", "two.toml", "--size", "128x72", "--samples", "1", "-o", "frames"];
        let (code, _, err) = told(&echelon(folder.path(), &args));
        assert!(code == 0 && err.contains("the run ended at"), "{err}");
        let frames = files(&folder.path().join("frames"));
        // Half a metre at a metre a second, of two seconds.
        assert!((6..24).contains(&(frames.len() - cards)), "{}", frames.len());
        let picture = |k: usize| fs::read(&frames[k]).expect("a picture");
        let last = frames.len() - cards - 1;
        assert!(picture(last) != picture(last - 1), "it stands still at the end");
        fs::remove_dir_all(folder.path().join("frames")).expect("removed");
    }
}

#[test]
fn a_storyboard_that_does_not_fit_its_run_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    for (film, wanted) in [
        ("[[film.shots]]\nto = 3.0\n", "is beyond the end of the run at 2 s"),
        ("[[film.shots]]\nto = 1.0\n[[film.shots]]\nfrom = 0.5\nto = 2.0\n", "before the one before it ends"),
        ("[[film.shots]]\nfrom = 1.0\nto = 1.0\n", "has no length"),
        ("[[film.shots]]\nview = \"camera:c\"\n", "there is no robot called `c`"),
        ("[[film.shots]]\nview = \"snake+tpo\"\n", "did you mean `top`"),
        ("[[film.shots]]\nplots = [\"sped\"]\n", "did you mean `speed`"),
        ("[[film.shots]]\nspeed = 0\n", "0.01"),
    ] {
        write_scene(folder.path(), film);
        let (code, _, err) = told(&echelon(folder.path(), &["film", "two.toml", "-o", "f.mp4"]));
        assert!(code == 2 && err.contains(wanted), "{film}: {err}");
    }
    write_scene(folder.path(), "[[film.shots]]\nwithout = [\"ribons\"]\n");
    let (code, _, err) =
        told(&echelon(folder.path(), &["film", "two.toml", "--size", "64x36", "-o", "f.mp4"]));
    assert!(code == 2 && err.contains("did you mean \"ribbons\""), "{err}");
    assert!(!folder.path().join("f.mp4").exists());
    // A run is not a film.
    write_scene(folder.path(), "[[film.shots]]\nto = 3.0\n");
    assert_eq!(told(&echelon(folder.path(), &["run", "two.toml", "--no-record", "-q"])).0, 0);
    assert_eq!(told(&echelon(folder.path(), &["check", "two.toml"])).0, 2);
    // The way out that the message names.
    write_scene(folder.path(), BOARD);
    let shorter =
        ["film", "two.toml", "--set", "time.duration=0.5", "--size", "64x36", "--samples", "1", "-q"];
    assert_eq!(told(&echelon(folder.path(), &shorter)).0, 2);
    let args = [&shorter[..], &["--set", "film.shots=[]", "-o", "f.mp4"]].concat();
    let (code, _, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
}

#[test]
fn presets_bring_their_own_measures() {
    let folder = tempfile::tempdir().expect("a folder");
    write_scene(folder.path(), "");
    for (preset, frames) in [("talk", 5 + 3 + 8), ("paper", 4), ("social", 4 + 4 + 6)] {
        let args = [
            "film",
            "two.toml",
            "--preset",
            preset,
            "--size",
            "72x128",
            "--fps",
            "2",
            "--samples",
            "1",
            "--json",
        ];
        let (code, out, err) = told(&echelon(folder.path(), &args));
        assert_eq!(code, 0, "{err}");
        let value: Value = serde_json::from_str(&out).expect("JSON");
        assert_eq!(value["frames"], frames, "{preset}");
    }
    let both = ["film", "two.toml", "--preset", "talk", "--view", "top"];
    assert_eq!(told(&echelon(folder.path(), &both)).0, 2);
}

#[test]
fn stills_are_a_sheet_and_a_strobe_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    write_scene(folder.path(), "");
    let args = ["stills", "two.toml", "--count", "5", "--columns", "3", "--size", "64x36", "-q", "-o", "out"];
    let (code, _, err) = told(&echelon(folder.path(), &args));
    assert_eq!(code, 0, "{err}");
    let size = |name: &str| {
        let bytes = fs::read(folder.path().join("out").join(name)).expect("a picture");
        let word = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
        [word(16), word(20)]
    };
    assert_eq!((size("two-sheet.png"), size("two-strobe.png")), ([3 * 72 + 8, 2 * 44 + 8], [64, 36]));
    fs::write(folder.path().join("file"), "x").expect("written");
    let (code, _, err) = told(&echelon(folder.path(), &["stills", "two.toml", "-o", "file"]));
    assert!(code == 2 && err.contains("is a file"), "{err}");
}

#[test]
fn the_shipped_storyboard_covers_its_run() {
    let (code, out, err) = told(&echelon(Path::new("."), &["check", "--resolved", &scene("change-places")]));
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("to = 32.0") && out.contains("speed = 0.5"), "{out}");
}

/// "1 frames of 64×36" is no English.
#[test]
fn one_frame_is_one_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    write_scene(folder.path(), "");
    let args =
        ["film", "two.toml", "--size", "64x36", "--samples", "1", "--set", "time.duration=0.5", "--fps", "2"];
    let (code, out, err) = told(&echelon(folder.path(), &args));
    assert!(code == 0 && out.contains("two.mp4: 0.50 s, 1 frame of 64×36 at 2 a second"), "{out}{err}");
    assert!(err.contains("Filming two, 1 frame, to two.mp4"), "{err}");
}

/// The help and the book name every ending that is taken.
#[test]
fn endings_are_documented_as_they_are_taken() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/films.md");
    let page = fs::read_to_string(page).expect("a page");
    let (_, help, _) = told(&echelon(Path::new("."), &["film", "--help"]));
    for ending in film::FilmKind::BUILT_IN.iter().chain(&film::FilmKind::BY_FFMPEG) {
        assert!(page.contains(&format!("`.{ending}`")), "{ending} is not in docs/films.md");
        assert!(help.contains(&format!(".{ending}")), "{ending} is not in: {help}");
    }
}
