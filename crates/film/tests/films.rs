//! Films: their boxes, their timing, and what is left behind when something goes wrong.

use film::{Error, Film, FilmKind};
use std::path::Path;
use vocabulary::Picture;

fn picture(width: u32, height: u32, k: u32) -> Picture {
    let pixel = |n: u32| [(n % width * 3 + k * 5) as u8, (n / width * 2) as u8, (k * 9) as u8, 255];
    Picture { width, height, rgba: (0..width * height).flat_map(pixel).collect() }
}

fn write_film(path: &Path, kind: FilmKind, frames: u32, rate: f64) -> Result<(), Error> {
    let mut film = Film::create(path, kind, 128, 96, rate)?;
    for k in 0..frames {
        film.push(picture(128, 96, k))?;
    }
    film.finish()
}

/// The content of the box at a path of names.
fn find<'a>(bytes: &'a [u8], path: &[&[u8; 4]]) -> Option<&'a [u8]> {
    let Some((name, rest)) = path.split_first() else { return Some(bytes) };
    let mut at = 0;
    while at + 8 <= bytes.len() {
        let size = word(bytes, at) as usize;
        if size < 8 {
            return None;
        }
        if &bytes[at + 4..at + 8] == *name {
            return find(&bytes[at + 8..at + size], rest);
        }
        at += size;
    }
    None
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn leftovers(folder: &Path) -> Vec<String> {
    let names = std::fs::read_dir(folder).unwrap();
    names.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn an_mp4_has_every_frame_at_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    write_film(&path, FilmKind::Mp4, 50, 25.0).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let media = find(&bytes, &[b"moov", b"trak", b"mdia"]).unwrap();
    let header = find(media, &[b"mdhd"]).unwrap();
    // Version, two times of 64 bits, clock, duration of 64 bits.
    let (clock, duration) = (word(header, 20), word(header, 28));
    assert_eq!((clock, duration), (25_000, 50_000));
    let table = find(media, &[b"minf", b"stbl"]).unwrap();
    let times = find(table, &[b"stts"]).unwrap();
    assert_eq!([word(times, 4), word(times, 8), word(times, 12)], [1, 50, 1000]);
    let sizes = find(table, &[b"stsz"]).unwrap();
    assert_eq!(word(sizes, 8), 50);
    let keys = find(table, &[b"stss"]).unwrap();
    assert_eq!((word(keys, 8), word(keys, 4)), (1, 1));
    // The frames lie where the index says, to the last byte of the file.
    let at = word(find(table, &[b"co64"]).unwrap(), 12) as usize;
    let total: usize = (0..50).map(|k| word(sizes, 12 + 4 * k) as usize).sum();
    assert_eq!(at + total, bytes.len());
    let first = word(&bytes, at) as usize;
    assert!(first + 4 <= word(sizes, 12) as usize && bytes[at + 4] & 31 == 5);
    assert_eq!(leftovers(folder.path()), ["a.mp4"]);
}

#[test]
fn the_parameter_sets_are_in_the_index() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    write_film(&path, FilmKind::Mp4, 3, 30.0).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let description = find(&bytes, &[b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsd"]).unwrap();
    let start = description.windows(4).position(|w| w == b"avcC").unwrap() + 4;
    let parameters = &description[start..];
    assert_eq!((parameters[0], parameters[5], parameters[8] & 31), (1, 0xe1, 7));
    assert_eq!(parameters[1], parameters[9]);
    // Primaries, transfer and matrix of BT.709, video range.
    let colours = description.windows(4).position(|w| w == b"nclx").unwrap() + 4;
    assert_eq!(description[colours..colours + 7], [0, 1, 0, 1, 0, 1, 0]);
}

#[test]
fn a_gif_keeps_time_on_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gif");
    write_film(&path, FilmKind::Gif, 31, 30.0).unwrap();
    let mut decoder = gif_decoder(&path);
    let (mut frames, mut hundredths) = (0, 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        frames += 1;
        hundredths += u32::from(frame.delay);
    }
    assert_eq!((frames, hundredths), (31, 103));
}

fn gif_decoder(path: &Path) -> gif::Decoder<std::fs::File> {
    gif::Decoder::new(std::fs::File::open(path).unwrap()).unwrap()
}

#[test]
fn a_sequence_is_a_folder_of_numbered_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frames");
    write_film(&path, FilmKind::PngSequence, 3, 30.0).unwrap();
    let mut names = leftovers(&path);
    names.sort();
    assert_eq!(names, ["frame-00000.png", "frame-00001.png", "frame-00002.png"]);
    let error = write_film(&path, FilmKind::PngSequence, 1, 30.0).unwrap_err();
    assert!(error.is_usage() && error.to_string().contains("holds other files"), "{error}");
}

#[test]
fn an_abandoned_film_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (name, kind) in [("a.mp4", FilmKind::Mp4), ("a.gif", FilmKind::Gif), ("a", FilmKind::PngSequence)] {
        let mut film = Film::create(&folder.path().join(name), kind, 64, 64, 30.0).unwrap();
        film.push(picture(64, 64, 0)).unwrap();
        drop(film);
        assert_eq!(leftovers(folder.path()), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn what_cannot_be_filmed_is_refused_with_the_fix() {
    let path = Path::new("/nowhere/a.mp4");
    let odd = Film::create(path, FilmKind::Mp4, 641, 360, 30.0).unwrap_err();
    assert!(odd.is_usage() && odd.to_string().contains("use 640×360"), "{odd}");
    for (size, rate) in [((0, 2), 30.0), ((640, 10_000), 30.0), ((640, 360), 0.0), ((640, 360), f64::NAN)] {
        let error = Film::create(path, FilmKind::Mp4, size.0, size.1, rate).unwrap_err();
        assert!(error.is_usage(), "{error}");
    }
    // Browsers show what is faster at 10 frames a second.
    assert!(
        Film::create(Path::new("/nowhere/a.gif"), FilmKind::Gif, 640, 360, 50.0)
            .is_err_and(|e| !e.is_usage())
    );
    let fast = Film::create(Path::new("/nowhere/a.gif"), FilmKind::Gif, 640, 360, 60.0).unwrap_err();
    assert!(fast.is_usage() && fast.to_string().contains("at most 50"), "{fast}");
    for kind in [FilmKind::Mp4, FilmKind::Gif, FilmKind::PngSequence] {
        let error = Film::create(path, kind, 640, 360, 30.0).unwrap_err();
        assert!(!error.is_usage() && error.to_string().contains("/nowhere/a.mp4"), "{error}");
    }
    let folder = tempfile::tempdir().unwrap();
    let mut film = Film::create(&folder.path().join("a.mp4"), FilmKind::Mp4, 64, 64, 30.0).unwrap();
    assert!(matches!(film.push(picture(32, 64, 0)), Err(Error::Mismatch { .. })));
    assert!(film.finish().is_err());
}

#[test]
fn a_png_keeps_its_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    film::png::write(&path, &picture(40, 30, 2), &[("Scene", "three in a row")]).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert!(bytes.windows(14).any(|w| w == b"three in a row"));
    let read = image::open(&path).unwrap().to_rgba8();
    assert_eq!(read.into_raw(), picture(40, 30, 2).rgba);
    let error = film::png::write(Path::new("/nowhere/a.png"), &picture(40, 30, 2), &[]).unwrap_err();
    assert!(!error.is_usage());
}

/// The first `to` frames of a film that another program may go on with; how many were there.
fn kept(path: &Path, made_of: &str, to: u32) -> (Film, u64) {
    let (mut film, done) = Film::resume(path, 128, 96, 10.0, made_of).unwrap();
    for k in done as u32..to {
        film.push(picture(128, 96, k)).unwrap();
    }
    (film, done)
}

#[test]
fn an_interrupted_film_goes_on_and_is_the_same_in_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    write_film(&path("whole.mp4"), FilmKind::Mp4, 70, 10.0).unwrap();
    let whole = std::fs::read(path("whole.mp4")).unwrap();

    // A program that is killed leaves whole groups of two seconds.
    drop(kept(&path("a.mp4"), "the same", 47).0);
    assert!(!path("a.mp4").exists());
    assert_eq!((Film::kept(&path("a.mp4"), 10.0), Film::kept(&path("b.mp4"), 10.0)), (40, 0));
    let (second, done) = kept(&path("a.mp4"), "the same", 70);
    assert_eq!(done, 40);
    second.finish().unwrap();
    assert!(std::fs::read(path("a.mp4")).unwrap() == whole, "the film differs");

    // One that is asked to stop leaves a film, too.
    kept(&path("b.mp4"), "the same", 25).0.pause().unwrap();
    let paused = std::fs::read(path("b.mp4")).unwrap();
    assert_eq!(
        find(&paused, &[b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsz"]).map(|b| word(b, 8)),
        Some(25)
    );
    let (second, done) = kept(&path("b.mp4"), "the same", 70);
    assert_eq!(done, 20);
    second.finish().unwrap();
    assert!(std::fs::read(path("b.mp4")).unwrap() == whole, "the film differs");
    let mut left = leftovers(folder.path());
    left.sort();
    assert_eq!(left, ["a.mp4", "b.mp4", "whole.mp4"]);
}

#[test]
fn a_film_of_something_else_begins_anew_and_two_programs_keep_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    drop(kept(&path, "one", 30).0);
    let (other, done) = kept(&path, "another", 5);
    assert_eq!(done, 0);
    let second = Film::resume(&path, 128, 96, 10.0, "another");
    assert!(matches!(second, Err(Error::Output(output::Error::Busy(busy))) if busy == path));
    drop(other);
    // Less than a group is nothing to go on with.
    assert_eq!(leftovers(folder.path()), Vec::<String>::new());
    // What is no journal is none of ours.
    std::fs::write(folder.path().join(".a.mp4.journal"), [0xff, 0xfe, 0, 1]).unwrap();
    assert_eq!(kept(&path, "one", 5).1, 0);
}

/// `.mp4` alone made a folder, and `x.png` a film that ffmpeg refused in its own words.
#[test]
fn endings_that_no_film_has_are_refused_with_those_that_films_have() {
    let kind = |name: &str, ffmpeg| FilmKind::of(Path::new(name), ffmpeg);
    for (name, wanted) in [
        ("a.mp4", FilmKind::Mp4),
        ("a.M4V", FilmKind::Mp4),
        ("a.gif", FilmKind::Gif),
        ("a", FilmKind::PngSequence),
        (".frames", FilmKind::PngSequence),
        ("a.webm", FilmKind::Ffmpeg),
        ("a.b.mkv", FilmKind::Ffmpeg),
    ] {
        assert_eq!(kind(name, false).unwrap(), wanted, "{name}");
    }
    for name in ["a.mp4", "a.gif", "a.mov"] {
        assert_eq!(kind(name, true).unwrap(), FilmKind::Ffmpeg, "{name}");
    }
    for (name, ffmpeg) in [
        ("a.png", false),
        ("a.xyz", false),
        ("a.", false),
        (".mp4", false),
        ("in/.gif", false),
        (".webm", false),
        ("a", true),
    ] {
        let error = kind(name, ffmpeg).unwrap_err();
        let text = error.to_string();
        assert!(error.is_usage() && text.starts_with(&format!("{name} is no name of a film")), "{text}");
        for ending in FilmKind::BUILT_IN.iter().chain(&FilmKind::BY_FFMPEG) {
            assert!(text.contains(&format!(".{ending}")), "{ending}: {text}");
        }
        assert_eq!(text.contains("folder of PNG frames"), !ffmpeg, "{text}");
    }
}
