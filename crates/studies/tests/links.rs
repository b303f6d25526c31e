//! Links that were given away keep working: those of `links.txt` lead to their scenes, and to the same runs where this version
//! made them.

use scene::{Link, LinkOrigin, LinkProof, SHIPPED, Shipped, shipped};
use std::path::Path;
use studies::SceneRun;
use studies::link::{LinkComparison, digest_at};

/// Time that the links lead to, s.
const TIME: f64 = 0.8;

/// A link to a shipped scene with something set, something changed on the way, a view and a robot.
fn link(shipped: &'static Shipped) -> Link {
    let scene = Link::to(LinkOrigin::Shipped(shipped)).open().expect("a scene").scene;
    let mut parts = vec![format!("seed={}", scene.seed + 1)];
    if shipped.name.starts_with("vision-") {
        // Pictures are another machine's own.
        parts.push("sensing.kind=geometric".to_owned());
    }
    if let Some((name, _)) = scene.followers().next() {
        parts.push(format!("@0.25:robots.{name}.distance=2.25&@0.5:law.k=%5B1.5,2%5D&selected={name}"));
    }
    let text = format!("#{}?{}&t={TIME}&view=snake%2Btop", shipped.name, parts.join("&"));
    text.parse().expect("a link")
}

fn run(link: &Link) -> String {
    let scene = link.open().expect("a scene").scene;
    let mut run = SceneRun::new(scene).expect("a run");
    digest_at(&mut run, link.time.expect("a time"), |_| true).expect("a digest")
}

/// `UPDATE_LINKS=1` writes those of this version anew.
#[test]
fn links_of_this_version_and_before_keep_working() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/links.txt");
    let own = format!("v={}", env!("CARGO_PKG_VERSION"));
    if std::env::var_os("UPDATE_LINKS").is_some() {
        let before = std::fs::read_to_string(&path).unwrap_or_default();
        let before = before.lines().filter(|line| !line.contains(&own)).map(str::to_owned);
        let packed = Link::to(LinkOrigin::Text(shipped("line-three").expect("a scene").text.to_owned()));
        let made = SHIPPED.iter().map(link).chain([Link { time: Some(TIME), ..packed }]);
        let proven = made.map(|link| {
            let proof = LinkProof::of(&run(&link));
            Link { proof: Some(proof), ..link }.to_string()
        });
        let lines: Vec<String> = before.chain(proven).collect();
        std::fs::write(&path, lines.join("\n") + "\n").expect("links.txt");
    }
    let text = std::fs::read_to_string(&path).expect("links.txt");
    let links: Vec<Link> = text.lines().map(|line| line.parse().expect("a link")).collect();
    for shipped in SHIPPED {
        assert!(links.iter().any(|link| link.name() == shipped.name), "no link to {}", shipped.name);
    }
    std::thread::scope(|scope| {
        for part in links.chunks(links.len().div_ceil(2)) {
            scope.spawn(move || {
                for link in part {
                    let compared = LinkComparison::new(link, run(link), false).expect("a time");
                    let own =
                        link.proof.as_ref().is_some_and(|proof| proof.version == env!("CARGO_PKG_VERSION"));
                    assert!(!own || compared.same() == Some(true), "{link}: {}", compared.words());
                }
            });
        }
    });
}
