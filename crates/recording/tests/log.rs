//! Logs come back bit for bit, whole or cut off, and what is no log is one clear error.

use recording::log::{FILE, Log, Roll, compare};
use recording::{Digest, Error, Judging, Manifest, Recorder, RunOptions, Status};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use vocabulary::{
    Body, Cast, Condition, Contact, Edge, EdgeState, Frame, Member, Mobility, Moment, Outcome, Placement,
    Prop, RobotState, Shell, Sight, Snapshot, Solid, Terrain, Thing,
};

/// Numbers without rule, special ones among them (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn whole(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    fn below(&mut self, end: usize) -> usize {
        (self.whole() % end as u64) as usize
    }

    fn next(&mut self) -> f64 {
        const SPECIAL: [f64; 6] =
            [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::MIN_POSITIVE / 3.0, f64::MAX];
        match self.below(8) {
            0 => SPECIAL[self.below(6)],
            _ => f64::from_bits(self.whole() & !(1 << 62)),
        }
    }

    fn many<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.next())
    }
}

fn cast() -> Cast {
    let member = |name: &str, leads| Member {
        shell: Some(Shell::PAPER.tagged(3)),
        ..Member::new(name, leads, Body::default())
    };
    let solids = [
        Solid::Block { size: [1.0, 0.5, 0.3] },
        Solid::Wedge { size: [2.0, 1.0, 0.2] },
        Solid::Cylinder { radius: 0.2, height: 1.0 },
        Solid::Cone { radius: 0.1, height: 0.4 },
    ];
    let prop = |(k, solid): (usize, Solid)| Prop {
        name: format!("thing-{k}"),
        solid,
        placement: Placement { position: [k as f64, 0.0, 0.1], ..Placement::default() },
        mobility: [Mobility::Fixed, Mobility::Loose, Mobility::Guided][k % 3],
    };
    let heights = (0..12).map(f64::from).collect();
    Cast {
        title: "a title — with signs".into(),
        caption: "K = 5".into(),
        duration: 30.0,
        members: vec![
            member("ann", true),
            Member { shell: None, ..member("bob", false) },
            member("cy", false),
        ],
        edges: vec![Edge { leader: 0, follower: 1 }, Edge { leader: 1, follower: 2 }],
        looks: true,
        props: solids.into_iter().enumerate().map(prop).collect(),
        terrain: Some(Arc::new(Terrain {
            origin: [-1.0, 2.0],
            cell: 0.5,
            columns: 4,
            rows: 3,
            heights,
            grip: vec![],
        })),
        ..Cast::default()
    }
}

fn moment(cast: &Cast, k: u32, n: &mut Numbers) -> Moment {
    let mut robot = RobotState::default();
    let robots = cast.members.iter().map(|_| {
        [robot.motion.pose.x, robot.motion.pose.y, robot.motion.pose.heading] = n.many();
        [robot.motion.speed, robot.motion.acceleration, robot.motion.turn_rate] = n.many();
        [robot.attitude.height, robot.attitude.roll, robot.attitude.pitch, robot.camera_pan] = n.many();
        for wheel in &mut robot.wheels {
            [wheel.rotation, wheel.steering, wheel.compression] = n.many();
        }
        robot.condition =
            [Condition::Able, Condition::Overturned, Condition::Stuck, Condition::Fallen][n.below(4)];
        robot
    });
    let robots = robots.collect();
    let edge = |n: &mut Numbers| {
        let mut edge =
            EdgeState { set_point: n.many(), error: n.many(), rates: n.many(), ..EdgeState::default() };
        [edge.relative.distance, edge.relative.bearing, edge.relative.view_angle] = n.many();
        [edge.seen.distance, edge.seen.bearing, edge.seen.view_angle, edge.age] = n.many();
        [edge.asked.acceleration, edge.asked.turn_rate] = n.many();
        [edge.applied.acceleration, edge.applied.turn_rate] = n.many();
        edge.estimate = n.many();
        edge.sight =
            [Sight::Truth, Sight::Waiting, Sight::Tracking, Sight::Coasting, Sight::Lost][n.below(5)];
        (edge.limited, edge.too_close) = (n.below(2) == 1, n.below(2) == 1);
        edge
    };
    let contact = |n: &mut Numbers| Contact {
        number: n.whole(),
        things: [Thing::Robot(n.below(3)), [Thing::Prop(2), Thing::Ground, Thing::Robot(1)][n.below(3)]],
        begin: n.next(),
        end: n.next(),
        open: n.below(2) == 1,
        place: n.many(),
        normal: n.many(),
        impulse: n.next(),
    };
    let look = |n: &mut Numbers| {
        let mut frame = Frame { edge: n.below(2), arrival: n.next(), pan: n.next(), ..Frame::default() };
        frame.sighting.stamp = n.next();
        frame.sighting.deviation = n.many();
        [frame.sighting.relative.distance, frame.truth.bearing] = n.many();
        frame.outcome =
            [Outcome::Used, Outcome::Rejected, Outcome::Ambiguous, Outcome::Missed, Outcome::Dropped]
                [n.below(5)];
        for tag in &mut frame.tags {
            *tag = (n.below(2) == 1).then(|| std::array::from_fn(|_| n.many()));
        }
        frame.region.x = n.below(1 << 31) as u32;
        frame.region.height = u32::MAX;
        frame
    };
    // Some props stand for a while.
    let props = cast.props.iter().enumerate().map(|(i, prop)| {
        if i % 2 == 0 || k.is_multiple_of(7) {
            prop.placement
        } else {
            Placement { position: n.many(), rotation: n.many() }
        }
    });
    Moment {
        snapshot: Snapshot { time: f64::from(k) * 0.01 + 1e-13, robots, props: props.collect() },
        edges: (0..2).map(|_| edge(n)).collect(),
        contacts: (0..n.below(3)).map(|_| contact(n)).collect(),
        // Looks are told in the order of their edges.
        frames: {
            let mut looks: Vec<Frame> = (0..n.below(3)).map(|_| look(n)).collect();
            looks.sort_by_key(|look| look.edge);
            looks
        },
    }
}

fn options() -> RunOptions {
    RunOptions {
        csv: false,
        no_log: false,
        roll: Roll::default(),
        force: false,
        scene: "schema = 1\ntitle = \"x\"\n".into(),
        program: "test 1".into(),
        commit: Some("abc".into()),
        seed: u64::MAX,
        period: 0.01,
        judging: Judging { settling_band: [0.02; 2], settled_after: 0.0 },
    }
}

/// Records `count` moments in `folder`; they, and what the manifest says.
fn record(folder: &Path, count: u32, status: Status) -> (Vec<Moment>, Manifest) {
    let (cast, mut numbers) = (cast(), Numbers(7));
    let moments: Vec<Moment> = (0..count).map(|k| moment(&cast, k, &mut numbers)).collect();
    let mut recorder = Recorder::create(folder, &cast, options()).expect("a recorder");
    for moment in &moments {
        recorder.push(moment).expect("recorded");
    }
    (moments, recorder.finish(status).expect("finished").0)
}

/// Bit for bit but for payloads of NaN, of which there are none: `{:?}` tells −0 from 0 and prints all digits.
fn same(a: &Moment, b: &Moment) -> bool {
    a == b && format!("{a:?}") == format!("{b:?}")
}

#[test]
fn everything_comes_back_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let (moments, manifest) = record(folder.path(), 450, Status::Complete);
    let log = Log::open(&folder.path().join(FILE)).expect("a log");
    assert!(log.whole());
    assert_eq!((log.cast(), log.manifest()), (&cast(), &manifest));
    assert_eq!(log.scene(), options().scene);
    let back: Vec<Moment> = log.moments().map(|moment| moment.expect("sound")).collect();
    assert_eq!(back.len(), moments.len());
    for (a, b) in back.iter().zip(&moments) {
        assert!(same(a, b), "{a:?}\n{b:?}");
    }
    let mut digest = Digest::default();
    for moment in &back {
        digest.push(moment);
    }
    assert_eq!(Some(digest.text()), manifest.digest);
}

#[test]
fn any_time_is_found_without_reading_what_lies_before() {
    let folder = tempfile::tempdir().expect("a folder");
    let (moments, _) = record(folder.path(), 450, Status::Complete);
    let log = Log::open(&folder.path().join(FILE)).expect("a log");
    for (time, want) in
        [(-1.0, 0), (0.0, 0), (0.015, 1), (0.995, 99), (1.0, 99), (2.5, 249), (3.997, 399), (99.0, 449)]
    {
        let at = log.at(time).expect("sound").expect("a moment");
        assert!(same(&at, &moments[want]), "{time} s gives {}", at.snapshot.time);
        let on: Vec<Moment> = log.moments_from(time).map(|moment| moment.expect("sound")).collect();
        let first = moments.iter().position(|moment| moment.snapshot.time >= time).unwrap_or(moments.len());
        assert_eq!(on.len(), moments.len() - first, "from {time} s");
    }
}

/// Cut anywhere, a log is an error or the beginning of the run, and most of it.
#[test]
fn a_log_reads_up_to_its_last_whole_chunk() {
    let folder = tempfile::tempdir().expect("a folder");
    let (moments, _) = record(folder.path(), 450, Status::Complete);
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
                assert!(message.contains("cut off") || message.contains("is no log"), "{message}");
                continue;
            }
            Err(other) => panic!("{other}"),
        };
        let back: Vec<Moment> = log.moments().map(|moment| moment.expect("sound")).collect();
        assert!(back.iter().zip(&moments).all(|(a, b)| same(a, b)));
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
    let (moments, _) = record(folder.path(), 120, Status::Complete);
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
                let back: Result<Vec<Moment>, Error> = log.moments().collect();
                match back {
                    Ok(back) => assert!(back.iter().zip(&moments).all(|(a, b)| same(a, b)), "byte {place}"),
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
    assert!(refused(&path).contains("is no log"));
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
    assert!(refused(&path).contains("layout 99; this program reads layout 1"));
    foreign(&[("format", "1")]);
    assert!(refused(&path).contains("no log of Echelon: it has no topic /cast"));
}

/// How another program writes a log anew.
#[derive(Default, Clone, Copy)]
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
    /// The library that is named.
    library: &'static str,
}

fn rewrite(from: &Path, to: &Path, how: Anew) {
    let bytes = fs::read(from).expect("a log");
    let options = mcap::WriteOptions::new()
        .library(how.library)
        .compression(Some(mcap::Compression::Zstd))
        .use_chunks(!how.bare)
        .chunk_size(Some(5000));
    let mut writer = options.create(fs::File::create(to).expect("a file")).expect("a writer");
    let mut messages: Vec<mcap::Message<'_>> =
        mcap::MessageStream::new(&bytes).expect("messages").map(|m| m.expect("a message")).collect();
    messages.retain(|m| how.without.is_none_or(|topic| m.channel.topic != topic));
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
    let (moments, manifest) = record(folder.path(), 250, Status::Complete);
    let original = folder.path().join(FILE);
    assert_eq!(Log::open(&original).expect("a log").remark(), None);
    let copy = folder.path().join("copy.mcap");
    let other = Anew { library: "mcap go v1.7", ..Anew::default() };
    for how in [
        other,
        Anew { bare: true, ..other },
        Anew { plain_channels: true, ..other },
        Anew { by_topic: true, ..other },
        // Whoever copies the head of a file says that we wrote it.
        Anew { library: "echelon 0.1.0", ..other },
        Anew { library: "echelon 0.1.0", bare: true, ..other },
    ] {
        rewrite(&original, &copy, how);
        let log = Log::open(&copy).expect("a log");
        assert_eq!((log.manifest(), log.scene()), (&manifest, "schema = 1\ntitle = \"x\"\n"));
        assert!(log.remark().is_some_and(|remark| remark.contains(how.library)), "{:?}", log.remark());
        let read: Vec<Moment> = log.moments().map(|m| m.expect("a moment")).collect();
        assert_eq!(read.len(), moments.len());
        for (read, moment) in read.iter().zip(&moments) {
            assert!(same_but_for_order(read, moment, how.by_topic));
        }
        assert_eq!(log.path(), copy);
    }
}

/// Frames of one moment stand in the order of their topics where the file does.
fn same_but_for_order(a: &Moment, b: &Moment, by_topic: bool) -> bool {
    let sorted = |moment: &Moment| {
        let mut moment = moment.clone();
        moment.frames.sort_by_key(|frame| if by_topic { frame.edge } else { 0 });
        moment
    };
    same(&sorted(a), &sorted(b))
}

/// What was left out is told, and what is there can be looked at.
#[test]
fn what_another_program_left_out_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let (moments, _) = record(folder.path(), 250, Status::Complete);
    let (original, copy) = (folder.path().join(FILE), folder.path().join("copy.mcap"));
    let other = Anew { library: "mcap go v1.7", ..Anew::default() };
    rewrite(&original, &copy, Anew { attachments: true, ..other });
    let log = Log::open(&copy).expect("a log");
    let remark = log.remark().expect("a remark");
    assert!(remark.contains("its scene and its manifest"), "{remark}");
    assert_eq!((log.scene(), log.manifest().digest.as_ref(), log.manifest().samples), ("", None, 250));
    assert_eq!(log.manifest().robots, ["ann", "bob", "cy"]);
    assert_eq!(log.moments().filter(|m| m.is_ok()).count(), moments.len());
    rewrite(&original, &copy, Anew { without: Some("/robot/bob/state"), ..other });
    let remark = Log::open(&copy).expect("a log").remark().map(str::to_owned).expect("a remark");
    assert!(remark.contains("of its 250 samples the first 0 are whole"), "{remark}");
    rewrite(&original, &copy, Anew { without: Some("/cast"), ..other });
    let refused = Log::open(&copy).expect_err("no cast").to_string();
    assert!(refused.contains("no log of Echelon") && refused.contains("/cast"), "{refused}");
    // Cut off, it reads up to there.
    rewrite(&original, &copy, Anew { bare: true, ..other });
    let bytes = fs::read(&copy).expect("a log");
    fs::write(&copy, &bytes[..bytes.len() / 2]).expect("written");
    let log = Log::open(&copy).expect("a log");
    let count = log.moments().filter(|m| m.is_ok()).count();
    assert!(count > 80 && count < 170, "{count}");
}

#[test]
fn the_first_difference_is_named() {
    let folders = [tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder")];
    let (mut moments, _) = record(folders[0].path(), 150, Status::Complete);
    moments[120].edges[1].applied.turn_rate = 0.5;
    moments[130].edges[1].applied.turn_rate =
        f64::from_bits(moments[130].edges[1].applied.turn_rate.to_bits() ^ 1);
    moments.pop();
    let mut recorder = Recorder::create(folders[1].path(), &cast(), options()).expect("a recorder");
    for moment in &moments {
        recorder.push(moment).expect("recorded");
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
    let recorder = Recorder::create(folder.path(), &cast(), RunOptions { no_log: true, ..options() });
    recorder.expect("a recorder").finish(Status::Complete).expect("finished");
    assert!(!folder.path().join(FILE).exists());
}
