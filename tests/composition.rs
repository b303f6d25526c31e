//! What pictures of the scenes cover: words and panels lie where no robot, set point or label is, in every view and size.

use rendering::{
    Composition, CurvePanel, Overlays, PictureSpec, ReservedSpace, Style, Subtitle, Trail, ViewLayout,
};
use scene::Scene;
use simulation::{Simulation, build};
use std::path::Path;
use vocabulary::{FleetInfo, StepRecord};

const SIZES: [(u32, u32); 7] =
    [(480, 270), (640, 360), (640, 480), (960, 540), (1280, 720), (1080, 1920), (2560, 1440)];
const VIEWS: [&str; 4] = ["snake", "top", "snake+top", "orbit"];

/// A scene's cast, and its moments with what was before them, one every `every` samples.
fn shown(name: &str, seconds: f64, every: usize) -> (FleetInfo, Vec<(Trail, StepRecord)>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name).with_extension("toml");
    // The run is the same up to then; pictures of cameras would only take time.
    let sees = if name.starts_with("vision") { "sensing.kind=geometric" } else { "seed=1" };
    let loaded = Scene::load(path, &[sees.parse().expect("an override")]).expect("a scene");
    let mut run = Simulation::new(build(&loaded.scene).expect("a formation"));
    let fleet = run.fleet().clone();
    let (mut trail, mut all, mut sample) = (Trail::new(&fleet), Vec::new(), 0);
    while let Some(record) = run.next_record() {
        trail.push(record);
        if sample % every == 0 {
            all.push((trail.clone(), record.clone()));
        }
        sample += 1;
        if record.snapshot.time >= seconds {
            break;
        }
    }
    (fleet, all)
}

fn composed(
    fleet: &FleetInfo,
    at: &(Trail, StepRecord),
    view: &str,
    style: &Style,
    size: (u32, u32),
) -> Composition {
    let names: Vec<String> = fleet.robots.iter().map(|m| m.name.clone()).collect();
    let style = Style { scale: Style::scale_for(size.0, size.1), ..style.clone() };
    Composition::new(
        fleet,
        PictureSpec::new(&at.0, &at.1, &ViewLayout::parse(view, &names).expect("a view"), &style),
        size.into(),
    )
}

fn overlap(a: &[f32; 4], b: &[f32; 4]) -> bool {
    a[0] < b[0] + b[2] && b[0] < a[0] + a[2] && a[1] < b[1] + b[3] && b[1] < a[1] + a[3]
}

/// Everything that is wrong with a picture of `robots` robots and `edges` edges.
fn faults(composition: &Composition, (robots, edges): (usize, usize)) -> Vec<String> {
    let Composition { views, panels, captions, labels, robots: bodies, set_points } = composition;
    // A view in a corner is through a camera, and is one of the panels.
    let views: Vec<_> = views.iter().filter(|view| !panels.contains(view)).collect();
    let mut faults = Vec::new();
    let seen = [("robot", bodies), ("set point", set_points), ("label", labels)];
    for (what, boxes) in seen {
        for cover in panels.iter().chain(captions) {
            let hidden = boxes.iter().filter(|b| overlap(b, cover)).count();
            if hidden > 0 {
                faults.push(format!("{hidden} of {} {what}s under {cover:?}", boxes.len()));
            }
        }
    }
    if (bodies.len(), set_points.len()) != (views.len() * robots, views.len() * edges) {
        faults.push(format!("{} robots and {} set points are in it", bodies.len(), set_points.len()));
    }
    // All of them, and not only a corner of one.
    let whole = |b: &&[f32; 4]| {
        let inside = |v: &&[f32; 4]| {
            b[0] >= v[0] && b[1] >= v[1] && b[0] + b[2] <= v[0] + v[2] && b[1] + b[3] <= v[1] + v[3]
        };
        views.iter().any(inside)
    };
    let cut = bodies.iter().chain(set_points).filter(|b| !whole(b)).count();
    if cut > 0 {
        faults.push(format!("{cut} are cut by the picture's edge"));
    }
    for (k, caption) in captions.iter().enumerate() {
        let (width, height) =
            views.iter().fold((0.0_f32, 0.0_f32), |(w, h), v| (w.max(v[0] + v[2]), h.max(v[1] + v[3])));
        let inside =
            caption[0] >= 0.0 && caption[0] + caption[2] <= width && caption[1] + caption[3] <= height;
        if !inside || captions[..k].iter().any(|other| overlap(other, caption)) {
            faults.push(format!("caption {k} is at {caption:?}"));
        }
    }
    faults
}

#[test]
fn nothing_lies_under_panels_and_captions() {
    let mut wrong = Vec::new();
    for (name, seconds, every) in [
        ("seven-v", 8.0, 50),
        ("circle-three", 10.0, 50),
        ("hundred", 4.0, 200),
        ("cars-hundred", 2.0, 100),
        ("cars-seven-v", 20.0, 200),
        ("vision-seven-v", 10.0, 200),
    ] {
        let (fleet, all) = shown(name, seconds, every);
        for (size, view) in SIZES.iter().flat_map(|size| VIEWS.map(|view| (*size, view))) {
            for at in &all {
                let composition = composed(&fleet, at, view, &Style::default(), size);
                assert_eq!(composition.panels.len(), 1, "{name} {view} {size:?}: no panel");
                for fault in faults(&composition, (fleet.robots.len(), fleet.edges.len())) {
                    let time = at.1.snapshot.time;
                    wrong.push(format!("{name} {view} {size:?} at {time:.2}: {fault}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} faults:\n{}", wrong.len(), wrong.join("\n"));
}

/// Films add a line at the bottom, plots beside the view, and small pictures in a corner.
#[test]
fn nothing_lies_under_what_films_add() {
    let line = |rows: usize| Subtitle {
        rows: vec!["robot-2  2.00 m  −135°   ·   robot-3  2.00 m  135°".into(); rows],
        opacity: 1.0,
    };
    let room = |rows: usize| ReservedSpace { panel: true, rows };
    let said = |rows: usize| Overlays { line: Some(line(rows)), room: room(rows), ..Overlays::default() };
    let plotted = Overlays { plots: vec![CurvePanel::default(); 2], room: room(0), ..Overlays::default() };
    let mut wrong = Vec::new();
    for (name, seconds) in [("seven-v", 8.0), ("circle-three", 10.0), ("vision-seven-v", 6.0)] {
        let (fleet, all) = shown(name, seconds, 100);
        let mut check = |view: &str, style: &Style, size: (u32, u32)| {
            for at in &all {
                let composition = composed(&fleet, at, view, style, size);
                for fault in faults(&composition, (fleet.robots.len(), fleet.edges.len())) {
                    wrong.push(format!("{name} {view} {size:?} at {:.2}: {fault}", at.1.snapshot.time));
                }
            }
        };
        for (view, show, size) in [
            ("snake", said(2), (1920, 1080)),
            ("orbit", said(1), (1920, 1080)),
            ("top", said(3), (960, 540)),
            ("snake", plotted.clone(), (1280, 720)),
            ("top", plotted.clone(), (1280, 720)),
            ("snake+top", plotted.clone(), (1080, 1920)),
        ] {
            check(view, &Style { show, ..Style::default() }, size);
        }
        // Through the camera of a robot, in the corner: views beside it keep clear of it.
        let corner = Style { picture_in_picture: Some(1), ..Style::default() };
        for size in SIZES {
            for view in ["snake", "top", "orbit"] {
                check(view, &corner, size);
            }
        }
    }
    assert!(wrong.is_empty(), "{} faults:\n{}", wrong.len(), wrong.join("\n"));
}

/// Views that do not go by the formation have robots everywhere: there the panel goes, and under a card as well.
#[test]
fn the_panel_makes_way_where_a_camera_cannot() {
    let (fleet, all) = shown("seven-v", 8.0, 20);
    let views = ["follow:robot-2", "follow:robot-7", "snake-eye", "fixed:-9,0,6,0,0,0", "fixed:8,8,9,3,-3,0"];
    let (mut there, mut gone) = (0, 0);
    for (size, view) in SIZES.iter().flat_map(|size| views.map(|view| (*size, view))) {
        for at in &all {
            let composition = composed(&fleet, at, view, &Style::default(), size);
            for panel in &composition.panels {
                let all = [&composition.robots, &composition.set_points, &composition.labels];
                let hidden = all.into_iter().flatten().filter(|b| overlap(b, panel)).count();
                assert_eq!(hidden, 0, "{view} {size:?} at {}", at.1.snapshot.time);
            }
            there += composition.panels.len();
            gone += 1 - composition.panels.len();
        }
    }
    assert!(there > 50 && gone > 50, "there {there}, gone {gone}");
    let card = rendering::Card { title: "A V".into(), rows: vec![], opacity: 1.0 };
    let titled = Style { show: Overlays { card: Some(card), ..Overlays::default() }, ..Style::default() };
    assert!(composed(&fleet, &all[0], "snake", &titled, (1280, 720)).panels.is_empty());
}

/// From picture to picture of a film the panel stays where it is, and what is seen moves little.
#[test]
fn panels_stand_and_cameras_are_calm() {
    for (name, seconds) in [("seven-v", 6.0), ("hundred", 1.5), ("cars-seven-v", 6.0)] {
        // 33 pictures a second.
        let (fleet, all) = shown(name, seconds, 3);
        for (view, size) in
            [("snake", (640, 360)), ("snake", (1280, 720)), ("orbit", (960, 540)), ("snake", (1080, 1920))]
        {
            let mut before: Option<Composition> = None;
            for at in &all {
                let now = composed(&fleet, at, view, &Style::default(), size);
                if let Some(before) = before {
                    assert_eq!(
                        (&now.panels, &now.captions),
                        (&before.panels, &before.captions),
                        "{name} {view}"
                    );
                    // The lead robot drives evenly: what makes it jump is the camera.
                    let [a, b] = [&now, &before].map(|c| c.robots[0]);
                    let step = (a[0] - b[0]).hypot(a[1] - b[1]) / size.0 as f32;
                    assert!(step < 0.003, "{name} {view} {size:?}: {step} at {:.2}", at.1.snapshot.time);
                }
                before = Some(now);
            }
        }
    }
}
