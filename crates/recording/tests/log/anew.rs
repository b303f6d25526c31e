//! Logs that another program wrote anew.

use crate::common::{record, same};
use recording::Status;
use recording::log::{FILE, Log};
use std::fs;
use std::path::Path;
use vocabulary::StepRecord;

/// How another program writes a log anew.
#[derive(Default, Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is something that other programs do")]
struct Anew {
    /// No chunks, or chunks of zstd.
    bare: bool,
    /// Topic by topic instead of by time.
    by_topic: bool,
    /// Attachments and metadata are left out, as `mcap filter` does unless told otherwise.
    attachments: bool,
    /// What stands beside channels is left out.
    plain_channels: bool,
    /// A topic that is left out.
    without: Option<&'static str>,
    /// The writer that is named.
    writer: &'static str,
    /// Times that are kept, ns; all if empty. What stands at time 0 besides samples is kept.
    span: Option<[u64; 2]>,
}

fn rewrite(from: &Path, to: &Path, how: Anew) {
    let bytes = fs::read(from).expect("a log");
    let options = mcap::WriteOptions::library(mcap::WriteOptions::new(), how.writer)
        .compression(Some(mcap::Compression::Zstd))
        .use_chunks(!how.bare)
        .chunk_size(Some(5000));
    let mut writer = options.create(fs::File::create(to).expect("a file")).expect("a writer");
    let mut messages: Vec<mcap::Message<'_>> =
        mcap::MessageStream::new(&bytes).expect("messages").map(|m| m.expect("a message")).collect();
    messages.retain(|m| how.without.is_none_or(|topic| m.channel.topic != topic));
    if let Some([from, to]) = how.span {
        messages.retain(|m| m.channel.topic == "/fleet" || (from..=to).contains(&m.log_time));
    }
    if how.by_topic {
        messages.sort_by(|a, b| a.channel.topic.cmp(&b.channel.topic));
    }
    for mut message in messages {
        // Numbers of messages are lost, too.
        message.sequence = 0;
        if how.plain_channels {
            let channel = std::sync::Arc::make_mut(&mut message.channel);
            channel.metadata.clear();
        }
        writer.write(&message).expect("written");
    }
    if !how.attachments {
        for index in mcap::Summary::read(&bytes).expect("a summary").expect("one").attachment_indexes {
            let attachment = mcap::read::attachment(&bytes, &index).expect("an attachment");
            writer.attach(&attachment).expect("attached");
        }
        for index in mcap::Summary::read(&bytes).expect("a summary").expect("one").metadata_indexes {
            let metadata = mcap::read::metadata(&bytes, &index).expect("metadata");
            writer.write_metadata(&metadata).expect("written");
        }
    }
    writer.finish().expect("finished");
}

/// Sorted, unpacked, repacked, its channels numbered anew: every moment comes back bit for bit.
#[test]
fn what_another_program_wrote_anew_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let (records, manifest) = record(folder.path(), 250, Status::Complete);
    let original = folder.path().join(FILE);
    assert_eq!(Log::open(&original).expect("a log").remark(), None);
    let copy = folder.path().join("copy.mcap");
    let other = Anew { writer: "mcap go v1.7", ..Anew::default() };
    for how in [
        other,
        Anew { bare: true, ..other },
        Anew { plain_channels: true, ..other },
        Anew { by_topic: true, ..other },
        // Whoever copies the head of a file says that we wrote it.
        Anew { writer: "echelon 0.1.0", ..other },
        Anew { writer: "echelon 0.1.0", bare: true, ..other },
    ] {
        rewrite(&original, &copy, how);
        let log = Log::open(&copy).expect("a log");
        assert_eq!((log.manifest(), log.scene()), (&manifest, "schema = 1\ntitle = \"x\"\n"));
        assert!(log.remark().is_some_and(|remark| remark.contains(how.writer)), "{:?}", log.remark());
        let read: Vec<StepRecord> = log.records().map(|m| m.expect("a moment")).collect();
        assert_eq!(read.len(), records.len());
        for (read, record) in read.iter().zip(&records) {
            assert!(same_but_for_order(read, record, how.by_topic));
        }
        assert_eq!(log.path(), copy);
    }
}

/// Frames of one moment stand in the order of their topics where the file does.
fn same_but_for_order(a: &StepRecord, b: &StepRecord, by_topic: bool) -> bool {
    let sorted = |record: &StepRecord| {
        let mut record = record.clone();
        record.frames.sort_by_key(|frame| if by_topic { frame.edge } else { 0 });
        record
    };
    same(&sorted(a), &sorted(b))
}

/// What was left out is told, and what is there can be looked at.
#[test]
fn what_another_program_left_out_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let (records, _) = record(folder.path(), 250, Status::Complete);
    let (original, copy) = (folder.path().join(FILE), folder.path().join("copy.mcap"));
    let other = Anew { writer: "mcap go v1.7", ..Anew::default() };
    rewrite(&original, &copy, Anew { attachments: true, ..other });
    let log = Log::open(&copy).expect("a log");
    let remark = log.remark().expect("a remark");
    assert!(remark.contains("its scene and its manifest"), "{remark}");
    assert_eq!((log.scene(), log.manifest().digest.as_ref(), log.manifest().samples), ("", None, 250));
    assert_eq!(log.manifest().robots, ["ann", "bob", "cy"]);
    assert_eq!(log.records().flatten().count(), records.len());
    rewrite(&original, &copy, Anew { without: Some("/robot/bob/state"), ..other });
    let remark = Log::open(&copy).expect("a log").remark().map(str::to_owned).expect("a remark");
    assert!(remark.contains("of its 250 samples the first 0 are whole"), "{remark}");
    // A part says which part it is, and has no digest of the whole.
    let span = Some([1_000_000_000, 2_000_000_000]);
    rewrite(&original, &copy, Anew { span, ..other });
    let log = Log::open(&copy).expect("a log");
    let remark = log.remark().expect("a remark");
    assert!(remark.contains("of 2.49 s it holds 1.00 to 2.00 s"), "{remark}");
    assert!((log.begins() - 1.0).abs() < 1e-9, "{}", log.begins());
    assert_eq!((log.manifest().samples, log.manifest().digest.as_ref()), (201, None));
    let first = log.records().next().expect("one").expect("whole");
    assert_eq!(first.snapshot.time, log.begins());
    rewrite(&original, &copy, Anew { without: Some("/fleet"), ..other });
    let refused = Log::open(&copy).expect_err("no cast").to_string();
    assert!(refused.contains("no log of Echelon") && refused.contains("/fleet"), "{refused}");
    // Cut off, it reads up to there.
    rewrite(&original, &copy, Anew { bare: true, ..other });
    let bytes = fs::read(&copy).expect("a log");
    fs::write(&copy, &bytes[..bytes.len() / 2]).expect("written");
    let log = Log::open(&copy).expect("a log");
    let count = log.records().flatten().count();
    assert!(count > 80 && count < 170, "{count}");
}
