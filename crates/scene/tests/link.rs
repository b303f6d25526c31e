//! Links: what is written can be read, what is read means the same scene, and nothing that is no link does any harm.

use proptest::prelude::*;
use scene::{
    Link, LinkError, LinkOrigin, LinkProof, Override, SHIPPED, Scene, SceneText, TimedOverride, shipped,
};

fn link(text: &str) -> Link {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn fault(text: &str) -> String {
    match text.parse::<Link>().and_then(|link| link.open().map(drop)) {
        Ok(()) => panic!("{text} is a link"),
        Err(error) => error.to_string(),
    }
}

const SHORT: &str =
    "#circle-three?law.k=3&@2.5:law.k=4&t=7.5&view=snake%2Btop&selected=follower-1&v=0.1.0&d=1a2b3c4d";

#[test]
fn a_scene_that_begins_with_a_comment_is_no_link() {
    for meant in [SHORT, "  #seven-v\n", "https://example.org/lab#seven-v"] {
        assert!(Link::is_meant(meant), "{meant}");
    }
    for shipped in SHIPPED {
        assert!(!Link::is_meant(shipped.text), "{}", shipped.name);
    }
}

#[test]
fn a_link_is_read_with_or_without_what_stands_before_it() {
    let read = link(SHORT);
    assert_eq!(read.name(), "circle-three");
    assert_eq!(read.set, ["law.k=3".parse::<Override>().expect("an override")]);
    assert_eq!(read.changes[0].at, 2.5);
    assert_eq!((read.time, read.view.as_deref()), (Some(7.5), Some("snake+top")));
    let proof = LinkProof { version: "0.1.0".to_owned(), digits: "1a2b3c4d".to_owned() };
    assert_eq!((read.selected.as_deref(), &read.proof), (Some("follower-1"), &Some(proof)));
    for before in ["", "https://example.org/lab/index.html?lang=en", "  file:///x"] {
        assert_eq!(link(&format!("{before}{SHORT}\n")), read);
    }
    assert_eq!(link(&SHORT[1..]), read);
    assert_eq!(read.to_string(), SHORT);
    // By hand, escapes may be left out where they mean nothing else.
    assert_eq!(link(&SHORT.replace("%2B", "+")), read);
}

#[test]
fn a_link_opens_to_the_scene_with_all_that_it_sets() {
    let opened = link("#circle-three?law.k=3&robots.follower-1.bearing=-120%20deg&@2.5:law.k=4&t=7.5")
        .open()
        .expect("a scene");
    let (_, follow) = opened.scene.followers().next().expect("a follower");
    assert_eq!(
        (follow.law.k, follow.leaders.first.bearing.clone()),
        ([3.0, 3.0], Some(vocabulary::ScalarTrajectory::Constant(-120_f64.to_radians())))
    );
    assert_eq!((opened.scene.changes.len(), opened.scene.changes[0].at), (1, 2.5));
    // Changes make it another run than the one that is expected.
    assert_eq!(opened.scene.expect, scene::Expect::default());
    let again = Scene::parse(&opened.text, &opened.home, &[]).expect("a scene");
    assert_eq!(again.scene, opened.scene);
    let plain = link("#circle-three").open().expect("a scene");
    assert_eq!(plain.text, shipped("circle-three").expect("a scene").text);
    // A run lasts until the time that is looked at.
    assert_eq!(link("#circle-three?t=90").open().expect("a scene").scene.time.duration, 90.0);
}

#[test]
fn later_changes_join_those_of_the_scene() {
    let name = SHIPPED
        .iter()
        .find(|shipped| shipped.text.contains("[[changes]]"))
        .expect("a scene with changes")
        .name;
    let own = link(&format!("#{name}")).open().expect("a scene").scene;
    let joined = link(&format!("#{name}?@0.125:law.k=1.25")).open().expect("a scene");
    assert_eq!(joined.scene.changes.len(), own.changes.len() + 1);
    assert_eq!(joined.scene.changes[0].at, 0.125);
    let found = Link::to_text(&joined.text, name).expect("a link");
    assert!(matches!(found.origin, LinkOrigin::Shipped(_)), "{found}");
    assert_eq!(found.open().expect("a scene").scene, joined.scene);
}

/// The text of a shipped scene with values set in it.
fn edited(name: &str, sets: &[(&str, &str)]) -> String {
    let mut text = SceneText::parse(shipped(name).expect("a scene").text).expect("TOML");
    for (path, value) in sets {
        text.set(path, value).expect("a place");
    }
    text.text()
}

#[test]
fn a_text_is_told_by_what_is_set_where_that_will_do() {
    for (name, sets, wanted) in [
        ("circle-three", &[][..], "#circle-three"),
        (
            "circle-three",
            &[("observer.epsilon", "0.01"), ("law.k", "[3.0, 4.5]")],
            "#circle-three?law.k=%5B3,4.5%5D&observer.epsilon=0.01",
        ),
        (
            "circle-three",
            &[("robots.follower-1.bearing", "\"-120 deg\"")],
            "#circle-three?robots.follower-1.bearing=-120%20deg",
        ),
        ("circle-three", &[("title", "\"3\"")], "#circle-three?title=%223%22"),
        ("cars-yard", &[("physics.step", "0.004")], "#cars-yard?physics.step=0.004"),
    ] {
        let found = Link::to_text(&edited(name, sets), name).expect("a link");
        assert_eq!(found.to_string(), wanted);
    }
    // What cannot be set is carried.
    let mut text = SceneText::parse(shipped("circle-three").expect("a scene").text).expect("TOML");
    text.add_table(
        "props",
        "name = \"pillar\"\nshape = \"cylinder\"\nradius = 0.1\nheight = 1.0\npose = [9, 9, 0]\n",
    )
    .expect("added");
    let found = Link::to_text(&text.text(), "circle-three").expect("a link");
    assert_eq!(found.origin, LinkOrigin::Text(text.text()));
    assert!(found.to_string().starts_with("#~"));
    assert_eq!(link(&found.to_string()), found);
    // Its name is of no use to others.
    assert_eq!(Link::to_text(&text.text(), "mine").expect("a link"), found);
}

/// Every shipped scene, packed, comes out as it was.
#[test]
fn scenes_are_packed_and_unpacked() {
    for shipped in SHIPPED {
        let packed = Link::to(LinkOrigin::Text(shipped.text.to_owned()));
        let text = packed.to_string();
        assert!(
            text.len() < shipped.text.len()
                && text[2..].chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c))
        );
        assert_eq!(link(&text), packed, "{}", shipped.name);
    }
}

#[test]
fn what_all_followers_get_is_said_once() {
    let each = |robot: &str| TimedOverride {
        at: 1.5,
        set: format!("robots.{robot}.law.k=[4.0, 4.0]").parse().expect("an override"),
    };
    let long = Link { changes: ["follower-1", "follower-2"].map(each).to_vec(), ..link("#circle-three") };
    let short = long.clone().shortened();
    assert_eq!(short.to_string(), "#circle-three?@1.5:law.k=%5B4,4%5D");
    assert_eq!(short.open().expect("a scene").scene, long.open().expect("a scene").scene);
    // Where one has a value of its own, the common one does not reach it.
    let own = Link { set: vec!["robots.follower-1.law.k=2".parse().expect("an override")], ..long };
    assert_eq!(own.clone().shortened().changes.len(), 2);
}

#[test]
fn faults_are_told_in_words() {
    for (text, said) in [
        ("", "names no scene"),
        ("#", "names no scene"),
        ("https://example.org/", "no `#`"),
        ("#circle-tree", "did you mean `circle-three`"),
        ("#circle-three?speed", "`speed` is no part of a link: write key=value"),
        ("#circle-three?warp=3", "`warp`, which is unknown"),
        ("#circle-three?law.kk=3", "unknown key"),
        ("#circle-three?law.k=-3", "law.k"),
        ("#circle-three?robots.nobody.distance=3", "nobody"),
        ("#circle-three?@law.k=3", "@TIME:key=value"),
        ("#circle-three?@-1:law.k=3", "a time from 0 to"),
        ("#circle-three?@1:seed=3", "cannot change while a run goes"),
        ("#circle-three?t=soon", "a time from 0 to"),
        ("#circle-three?t=1&t=2", "two of `t`"),
        ("#circle-three?t=NaN", "a time from 0 to"),
        ("#circle-three?t=1e300", "a time from 0 to"),
        ("#circle-three?selected=nobody", "selects `nobody`"),
        ("#circle-three?title=a%zzb", "%25"),
        ("#circle-three?title=%ff", "stands for no character"),
        ("#circle-three?v=1&d=1a2b3c4d", "a version such as"),
        ("#circle-three?v=0.1.0&d=1a2b3c4z", "8 hexadecimal digits"),
        ("#~", "cut off"),
        ("#~!!!!", "damaged"),
        ("#~____", "damaged"),
        ("#peaking?robots.0.path.kind=table&robots.0.path.file=x.csv", "x.csv"),
    ] {
        let fault = fault(text);
        assert!(fault.contains(said), "{text}: {fault}");
    }
}

#[test]
fn a_link_that_is_cut_off_says_so() {
    for text in [
        "#circle-three?title=a%",
        "#circle-three?title=a%2",
        "#circle-three?t=1&v=0.1.0",
        "#circle-three?t=1&v=0.1.0&d=1a2b3",
    ] {
        assert!(fault(text).contains("cut off"), "{text}");
    }
    let whole =
        Link::to(LinkOrigin::Text(shipped("circle-three").expect("a scene").text.to_owned())).to_string();
    for length in 2..whole.len() - 4 {
        assert!(fault(&whole[..length]).contains("cut off"), "{length} of {}", whole.len());
    }
}

#[test]
fn a_newer_program_is_named_where_something_is_unknown() {
    for text in [
        "#circle-three?warp=9&v=99.1.0&d=1a2b3c4d",
        "#circle-nine?v=99.1.0&d=1a2b3c4d",
        "#circle-three?law.warp=9&v=99.1.0&d=1a2b3c4d",
    ] {
        assert!(fault(text).contains("echelon 99.1.0 made this link"), "{text}");
    }
    assert!(!fault("#circle-three?warp=9&v=0.0.1&d=1a2b3c4d").contains("made this link"));
    assert!(!link("#circle-three?v=0.0.9&d=1a2b3c4d").proof.expect("a proof").newer());
}

#[test]
fn no_link_takes_more_than_its_share() {
    let bomb = Link::to(LinkOrigin::Text(" ".repeat(20_000_000))).to_string();
    assert!(bomb.len() < 100_000 && fault(&bomb).contains("more than 1 MB"));
    assert!(matches!("#x".repeat(600_000).parse::<Link>(), Err(LinkError::Long(1_200_000))));
    assert!(fault(&format!("#circle-three?{}", "law.k=3&".repeat(1000))).contains("more than 300 values"));
}

/// Words of links are no keys of scenes.
#[test]
fn links_and_scenes_share_no_word() {
    let schema = scene::schema();
    let keys = schema["properties"].as_object().expect("keys");
    assert!(keys.contains_key("law"));
    for word in ["t", "view", "selected", "branch", "v", "d"] {
        assert!(!keys.contains_key(word), "{word}");
    }
}

fn paths() -> impl Strategy<Value = String> {
    let first = prop::sample::select(vec!["law", "observer", "robots", "title", "views", "time", "groups"]);
    (first, prop::collection::vec("[a-z0-9_ä-]{1,8}", 0..4))
        .prop_map(|(first, rest)| [vec![first.to_owned()], rest].concat().join("."))
}

fn overrides() -> impl Strategy<Value = Override> {
    (paths(), any::<String>())
        .prop_map(|(path, value)| format!("{path}={value}").parse().expect("an override"))
}

fn composed() -> impl Strategy<Value = String> {
    any::<String>().prop_map(|text| scene::composed(&text))
}

fn links() -> impl Strategy<Value = Link> {
    let origin = prop_oneof![
        prop::sample::select(SHIPPED).prop_map(|shipped| LinkOrigin::Shipped(shipped_again(shipped.name))),
        any::<String>().prop_map(LinkOrigin::Text),
    ];
    let change = (0.0..1e5, overrides()).prop_map(|(at, set)| TimedOverride { at, set });
    let proof = ("[0-9]{1,3}\\.[0-9]{1,3}\\.[0-9]{1,3}", "[0-9a-f]{8}")
        .prop_map(|(version, digits)| LinkProof { version, digits });
    let looks = (
        prop::option::of(0.0..1e5),
        prop::option::of(composed()),
        prop::option::of(composed()),
        prop::option::of(composed()),
    );
    (
        origin,
        prop::collection::vec(overrides(), 0..6),
        prop::collection::vec(change, 0..6),
        looks,
        prop::option::of(proof),
    )
        .prop_map(|(origin, set, changes, (time, view, selected, branch), proof)| Link {
            origin,
            set,
            changes,
            time,
            view,
            selected,
            branch,
            proof,
        })
}

fn shipped_again(name: &str) -> &'static scene::Shipped {
    shipped(name).expect("a shipped scene")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn what_is_written_is_read_again(wanted in links()) {
        let text = wanted.to_string();
        prop_assert!(text.is_ascii() && !text.contains(' '), "{}", text);
        prop_assert_eq!(text.parse::<Link>(), Ok(wanted));
    }

    #[test]
    fn nothing_breaks_the_reader(text in any::<String>(), at in 0..SHORT.len(), piece in "[#?&=%@:~.a-z0-9]{0,12}") {
        let _ = text.parse::<Link>().map(|link| link.open());
        let changed = format!("{}{piece}{}", &SHORT[..at], &SHORT[at..]);
        let _ = changed.parse::<Link>().map(|link| link.open());
    }
}
