//! Logs as this program writes them.

use crate::common::{Numbers, fleet, options, record, same};
use metrics::Digest;
use recording::log::{FILE, Log, compare};
use recording::{Error, Recorder, RunOptions, Status};
use std::fs;
use std::path::Path;
use vocabulary::StepRecord;

#[test]
fn everything_comes_back_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let (records, manifest) = record(folder.path(), 450, Status::Complete);
    let log = Log::open(&folder.path().join(FILE)).expect("a log");
    assert!(log.whole());
    assert_eq!((log.fleet(), log.manifest()), (&fleet(), &manifest));
    assert_eq!(log.scene(), options().scene);
    let back: Vec<StepRecord> = log.records().map(|record| record.expect("sound")).collect();
    assert_eq!(back.len(), records.len());
    for (a, b) in back.iter().zip(&records) {
        assert!(same(a, b), "{a:?}\n{b:?}");
    }
    let mut digest = Digest::default();
    for record in &back {
        digest.push(record);
    }
    assert_eq!(Some(digest.text()), manifest.digest);
}

#[test]
fn any_time_is_found_without_reading_what_lies_before() {
    let folder = tempfile::tempdir().expect("a folder");
    let (records, _) = record(folder.path(), 450, Status::Complete);
    let log = Log::open(&folder.path().join(FILE)).expect("a log");
    for (time, want) in
        [(-1.0, 0), (0.0, 0), (0.015, 1), (0.995, 99), (1.0, 99), (2.5, 249), (3.997, 399), (99.0, 449)]
    {
        let at = log.at(time).expect("sound").expect("a moment");
        assert!(same(&at, &records[want]), "{time} s gives {}", at.snapshot.time);
        let on: Vec<StepRecord> = log.records_from(time).map(|record| record.expect("sound")).collect();
        let first = records.iter().position(|record| record.snapshot.time >= time).unwrap_or(records.len());
        assert_eq!(on.len(), records.len() - first, "from {time} s");
    }
}

/// Cut anywhere, a log is an error or the beginning of the run, and most of it.
#[test]
fn a_log_reads_up_to_its_last_whole_chunk() {
    let folder = tempfile::tempdir().expect("a folder");
    let (records, _) = record(folder.path(), 450, Status::Complete);
    let bytes = fs::read(folder.path().join(FILE)).expect("a log");
    let path = folder.path().join("cut.mcap");
    let mut lengths = std::collections::BTreeSet::new();
    let mut cuts: Vec<usize> = (0..bytes.len()).step_by(bytes.len() / 97).collect();
    cuts.extend([0, 1, 7, 8, 9, 16, 17, bytes.len() - 1, bytes.len()]);
    for cut in cuts {
        fs::write(&path, &bytes[..cut]).expect("written");
        let log = match Log::open(&path) {
            Ok(log) => log,
            Err(Error::Log { message, .. }) => {
                assert!(message.contains("cut off") || message.contains("is not a log"), "{message}");
                continue;
            }
            Err(other) => panic!("{other}"),
        };
        let back: Vec<StepRecord> = log.records().map(|record| record.expect("sound")).collect();
        assert!(back.iter().zip(&records).all(|(a, b)| same(a, b)));
        if log.manifest().status == Status::Running {
            assert_eq!(log.manifest().samples, back.len() as u64);
        }
        lengths.insert(back.len());
    }
    assert!(lengths.len() >= 4 && lengths.contains(&450), "{lengths:?}");
    let chunks: Vec<usize> = lengths.into_iter().collect();
    assert!(chunks.windows(2).all(|pair| pair[1] - pair[0] <= 101), "{chunks:?}");
}

/// A changed byte is an error, or was of no matter: never a panic, never other moments.
#[test]
fn damage_is_told_or_does_not_matter() {
    let folder = tempfile::tempdir().expect("a folder");
    let (records, _) = record(folder.path(), 120, Status::Complete);
    let mut bytes = fs::read(folder.path().join(FILE)).expect("a log");
    let path = folder.path().join("damaged.mcap");
    let (mut numbers, mut told) = (Numbers(3), 0);
    for _ in 0..200 {
        let (place, bit) = (numbers.below(bytes.len()), numbers.below(8));
        bytes[place] ^= 1 << bit;
        fs::write(&path, &bytes).expect("written");
        match Log::open(&path) {
            Err(error) => {
                assert!(error.to_string().contains("damaged.mcap"), "{error}");
                told += 1;
            }
            Ok(log) => {
                let back: Result<Vec<StepRecord>, Error> = log.records().collect();
                match back {
                    Ok(back) => assert!(back.iter().zip(&records).all(|(a, b)| same(a, b)), "byte {place}"),
                    Err(_) => told += 1,
                }
            }
        }
        bytes[place] ^= 1 << bit;
    }
    assert!(told > 20, "{told} of 200 were noticed");
}

#[test]
fn what_is_no_log_of_ours_says_what_it_is_instead() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("x.mcap");
    let refused = |path: &Path| Log::open(path).expect_err("refused").to_string();
    fs::write(&path, "years of work").expect("written");
    assert!(refused(&path).contains("does not begin as MCAP files do"));
    fs::write(&path, "").expect("written");
    assert!(refused(&path).contains("is not a log"));
    assert!(refused(folder.path()).contains(&*folder.path().display().to_string()));
    assert!(refused(&folder.path().join("nowhere.mcap")).contains("cannot open"));
    let foreign = |metadata: &[(&str, &str)]| {
        let mut writer = mcap::Writer::new(fs::File::create(&path).expect("a file")).expect("a writer");
        if !metadata.is_empty() {
            let metadata = metadata.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
            writer
                .write_metadata(&mcap::write::Metadata { name: "echelon".into(), metadata })
                .expect("written");
        }
        writer.finish().expect("finished");
    };
    foreign(&[]);
    assert!(refused(&path).contains("no log of Echelon"));
    foreign(&[("format", "99")]);
    assert!(refused(&path).contains("layout 99; this program reads layout 2: run its scene again"));
    foreign(&[("format", "1")]);
    assert!(refused(&path).contains("layout 1; this program reads layout 2"));
    foreign(&[("format", "2")]);
    assert!(refused(&path).contains("no log of Echelon: it has no topic /fleet"));
}

#[test]
fn the_first_difference_is_named() {
    let folders = [tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder")];
    let (mut records, _) = record(folders[0].path(), 150, Status::Complete);
    records[120].edges[1].applied.turn_rate = 0.5;
    records[130].edges[1].applied.turn_rate =
        f64::from_bits(records[130].edges[1].applied.turn_rate.to_bits() ^ 1);
    records.pop();
    let mut recorder = Recorder::create(folders[1].path(), &fleet(), options()).expect("a recorder");
    for record in &records {
        recorder.push(record).expect("recorded");
    }
    recorder.finish(Status::Interrupted).expect("finished");
    let [a, b] = folders.each_ref().map(|folder| Log::open(&folder.path().join(FILE)).expect("a log"));
    let found = compare([&a, &b], 0.0, |_| true).expect("sound");
    assert_eq!((found.samples, found.more, found.differing), (149, [1, 0], 2));
    let first = found.first.as_ref().expect("a difference");
    assert_eq!((first.sample, &*first.of, first.quantity), (120, "edge bob → cy", "applied_turn_rate_rad_s"));
    assert_eq!(first.values[1], "0.5");
    assert_eq!(found.peaks.len(), 1);
    assert!(compare([&a, &a], 0.0, |_| true).expect("sound").same());
}

#[test]
fn a_run_without_log_has_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let recorder = Recorder::create(folder.path(), &fleet(), RunOptions { no_log: true, ..options() });
    recorder.expect("a recorder").finish(Status::Complete).expect("finished");
    assert!(!folder.path().join(FILE).exists());
}

/// The library panicked where an attachment ended before its checksum.
#[test]
fn an_attachment_without_its_checksum_is_damage() {
    let folder = tempfile::tempdir().expect("a folder");
    record(folder.path(), 20, Status::Complete);
    let path = folder.path().join(FILE);
    let bytes = fs::read(&path).expect("a log");
    let name = bytes.windows(10).position(|window| window == b"scene.toml").expect("an attachment");
    // Before the name: code, length of the record, two times, length of the name.
    let head = name - 4 - 16 - 9;
    assert_eq!(bytes[head], 9);
    let whole = u64::from_le_bytes(bytes[head + 1..head + 9].try_into().expect("eight bytes"));
    for length in 0..whole {
        let mut cut = bytes[..=head].to_vec();
        cut.extend_from_slice(&length.to_le_bytes());
        cut.extend_from_slice(&bytes[head + 9..][..length as usize]);
        cut.extend_from_slice(&bytes[head + 9..][whole as usize..]);
        fs::write(&path, cut).expect("written");
        let told = Log::open(&path).expect_err("its scene is damaged").to_string();
        assert!(told.contains("its scene or its manifest is missing"), "{length}: {told}");
    }
}
