//! Props and patterns: shapes, places, names, and room for everybody.

use scene::{Override, Path, PropMotion, PropSpec, Scene};
use std::f64::consts::FRAC_PI_2;
use vocabulary::Solid;
use vocabulary::math;

/// A scene with a robot at the origin and these props; the first line of `keys` is line 7.
fn text(keys: &str) -> String {
    format!(
        "schema = 1\ntitle = \"t\"\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\npath = {{ kind = \"constant\" }}\n{keys}\n"
    )
}

#[track_caller]
fn load(keys: &str, change: Option<&str>) -> Scene {
    let changes: Vec<Override> = change.iter().map(|change| change.parse().unwrap()).collect();
    let scene = Scene::parse(&text(keys), "t.toml", &changes).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let again = Scene::parse(&scene.to_toml(), "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    assert_eq!(scene, again);
    scene
}

#[track_caller]
fn props(keys: &str) -> Vec<PropSpec> {
    load(keys, None).props
}

#[test]
fn every_shape() {
    let props = props(
        "[[props]]\nname = \"box\"\nshape = \"block\"\nsize = [1, 2, 3]\npose = [4, 5, \"90 deg\"]\nmass = 2.5
        [[props]]\nname = \"ramp\"\nshape = \"ramp\"\nsize = [2, 1, 0.3]\npose = [8, 0, 0]\nfriction = 0.8
        [[props]]\nname = \"post\"\nshape = \"cylinder\"\nradius = 0.2\nheight = 1\npose = [0, 5, 0]\nelevation = 0.5
        [[props]]\nname = \"cone\"\nshape = \"cone\"\nradius = 0.1\nheight = 0.3\npose = [0, -5, 0]\nrestitution = 0.4
        [[props]]\nname = \"wall\"\nshape = \"wall\"\nfrom = [10, 0]\nto = [10, 6]\nheight = 0.8
        [[props]]\nname = \"bus\"\nshape = \"block\"\nsize = [3, 1, 1]\npose = [0, 20, 0]\npath = { kind = \"circle\", radius = 5 }",
    );
    let solids: Vec<_> = props.iter().map(|prop| prop.solid).collect();
    assert_eq!(
        solids,
        [
            Solid::Block { size: [1.0, 2.0, 3.0] },
            Solid::Wedge { size: [2.0, 1.0, 0.3] },
            Solid::Cylinder { radius: 0.2, height: 1.0 },
            Solid::Cone { radius: 0.1, height: 0.3 },
            Solid::Block { size: [6.0, 0.1, 0.8] },
            Solid::Block { size: [3.0, 1.0, 1.0] },
        ]
    );
    assert_eq!((&props[0].motion, props[0].pose.heading), (&PropMotion::Loose { mass: 2.5 }, FRAC_PI_2));
    assert_eq!((&props[1].motion, props[1].friction, props[1].restitution), (&PropMotion::Fixed, 0.8, 0.1));
    assert_eq!((props[2].elevation, props[3].restitution, props[3].elevation), (0.5, 0.4, 0.0));
    let wall = props[4].pose;
    assert_eq!((wall.x, wall.y, wall.heading), (10.0, 3.0, FRAC_PI_2));
    assert!(matches!(&props[5].motion, PropMotion::Guided { path: Path::Circle { .. } }));
}

#[test]
fn slaloms_corridors_and_gates() {
    let cones = props(
        "[[patterns]]\nname = \"c\"\nkind = \"slalom\"\ncount = 3\nspacing = 2\noffset = 0.5\npose = [1, 1, \"90 deg\"]\nmass = 0.4",
    );
    let places: Vec<_> =
        cones.iter().map(|p| [p.pose.x, p.pose.y].map(|at| (at * 1e6).round() / 1e6)).collect();
    assert_eq!(places, [[0.5, 1.0], [1.5, 3.0], [0.5, 5.0]]);
    assert_eq!(cones.iter().map(|cone| &*cone.name).collect::<Vec<_>>(), ["c-1", "c-2", "c-3"]);
    assert!(cones.iter().all(|cone| cone.motion == PropMotion::Loose { mass: 0.4 }));

    let walls =
        props("[[patterns]]\nname = \"w\"\nkind = \"corridor\"\nlength = 6\nwidth = 2\npose = [1, 0, 0]");
    let places: Vec<_> = walls.iter().map(|wall| [wall.pose.x, wall.pose.y]).collect();
    assert_eq!(places, [[4.0, 1.05], [4.0, -1.05]]);
    assert_eq!(walls[0].solid, Solid::Block { size: [6.0, 0.1, 0.5] });

    let gate =
        props("[[patterns]]\nname = \"g\"\nkind = \"gate\"\nwidth = 2\nradius = 0.2\npose = [5, 0, 0]");
    assert_eq!(
        gate.iter().map(|post| [post.pose.x, post.pose.y]).collect::<Vec<_>>(),
        [[5.0, 1.2], [5.0, -1.2]]
    );
}

const FIELD: &str = "[[patterns]]\nname = \"f\"\nkind = \"field\"\ncount = 30\nregion = [-5, -5, 5, 5]\nkeep_clear = 0.4\n\
                     prop = { shape = \"cylinder\", radius = 0.2, height = 1 }";

#[test]
fn a_field_keeps_clear_and_depends_on_its_seed() {
    let field = props(FIELD);
    assert_eq!(field.len(), 30);
    for (index, a) in field.iter().enumerate() {
        // The robot's middle, and half its diagonal.
        let robot = math::hypot(a.pose.x - 0.135, a.pose.y) - 0.24;
        assert!(robot > 0.6 - 0.01, "{} stands before the robot", a.name);
        for b in &field[..index] {
            assert!(
                math::hypot(a.pose.x - b.pose.x, a.pose.y - b.pose.y) >= 0.8,
                "{} and {}",
                a.name,
                b.name
            );
        }
    }
    assert_ne!(field, load(FIELD, Some("seed=7")).props);
    let own = format!("{FIELD}\nseed = 3");
    assert_eq!(props(&own), load(&own, Some("seed=7")).props);
}

#[test]
fn props_stand_on_the_ground() {
    let ground = "[ground]\nkind = \"table\"\ncell = 1\norigin = [-10, -10]\nheights = [[0, 20], [0, 20]]\n";
    let ground = ground.replace("cell = 1", "cell = 20").replace("20]", "2]");
    let crates = |more: &str| {
        format!(
            "{ground}[[props]]\nname = \"c\"\nshape = \"block\"\nsize = [1, 1, 1]\npose = [5, 0, 0]\n{more}"
        )
    };
    let elevation = |more: &str| props(&crates(more))[0].elevation;
    assert!((elevation("") - 1.5).abs() < 1e-12);
    assert!((elevation("mass = 1") - 1.55).abs() < 1e-12, "what is loose stands on its highest corner");
    assert_eq!(elevation("elevation = -0.2"), -0.2);
}

#[test]
fn props_that_cannot_be() {
    let block = "[[props]]\nname = \"b\"\nshape = \"block\"\nsize = [1, 1, 1]\npose = [5, 0, 0]";
    for (keys, line, words) in [
        (
            "[[props]]\nname = \"b\"\nshape = \"blocks\"",
            9,
            &["`shape` must be one of", "did you mean `block`?"][..],
        ),
        ("[[props]]\nname = \"b\"\npose = [0, 0, 0]", 7, &["`shape` is missing"]),
        (
            "[[props]]\nname = \"b\"\nshape = \"cone\"\nradius = 1\npose = [0, 9, 0]",
            7,
            &["`height` is missing"],
        ),
        (
            "[[props]]\nname = \"b\"\nshape = \"cone\"\nradius = 1\nheight = 1\nsize = [1, 1, 1]\npose = [0, 9, 0]",
            12,
            &["unknown key `size`"],
        ),
        ("[[props]]\nname = \"b\"\nshape = \"cone\"\nradius = 1\nheight = 1", 7, &["`pose` is missing"]),
        ("[[props]]\nname = \"b\"\nshape = \"wall\"\nfrom = [1, 1]\nto = [1, 1]", 11, &["0.001 m long"]),
        (
            "[[props]]\nname = \"b\"\nshape = \"wall\"\nfrom = [4, 1]\nto = [4, 2]\npose = [0, 0, 0]",
            12,
            &["has no `pose`"],
        ),
        (&format!("{block}\nmass = 0"), 12, &["`mass`", "above 0"]),
        (&format!("{block}\nmass = 1\npath = {{ kind = \"constant\" }}"), 12, &["follows that"]),
        (&format!("{block}\n{block}"), 13, &["two props called `b`"]),
        (&block.replace("\"b\"", "\"a\""), 8, &["a robot and a prop called `a`"]),
        (&block.replace("[5, 0, 0]", "[0.6, 0, 0]"), 8, &["`a` and `b` overlap where they start"]),
        (&block.replace("block", "ramp").replace("[5, 0, 0]", "[0.6, 0, 0]"), 8, &["`a` and `b` overlap"]),
        (
            "[[robots]]\nname = \"b\"\npose = [0.3, 0.2, 0]\npath.kind = \"constant\"",
            9,
            &["`a` and `b` overlap"],
        ),
        ("[[patterns]]\nname = \"p\"\nkind = \"gat\"\nwidth = 1", 9, &["did you mean `gate`?"]),
        ("[[patterns]]\nname = \"p\"\nkind = \"corridor\"\nwidth = 1", 7, &["`length` is missing"]),
        (&FIELD.replace("-5, -5", "5, -5"), 11, &["each `from` below its `to`"]),
        (&FIELD.replace("[-5, -5, 5, 5]", "[1, 1, 3, 3]"), 10, &["there is room for", "0.4 m clear"]),
        (&FIELD.replace("cylinder", "wall"), 13, &["`shape` must be one of"]),
        (&format!("{block}\nmass = 1\nelevation = -5"), 8, &["`b` starts in the ground", "or left out"]),
        ("[physics]\nstep = 0.05", 8, &["`step`", "from 0.0001 to 0.02"]),
        ("[physics]\non_contact = \"explode\"", 8, &["`record`, `stop`, `fail`"]),
        (&format!("[time]\nmode = \"continuous\"\n{block}"), 8, &["for unicycles", "`b` is in their way"]),
        (
            "[time]\nmode = \"continuous\"\n[ground]\nkind = \"rough\"\nregion = [0, 0, 5, 5]",
            8,
            &["for unicycles", "`ground` is not"],
        ),
        ("vehicle = \"car\"\n[time]\nmode = \"continuous\"", 9, &["for unicycles", "`a` has wheels"]),
        ("[expect]\nsettled_error_at_most = [0.1, 0.1]", 8, &["`settled_after` is missing"]),
        ("[expect]\nsettled_after = 3", 8, &["needs `settled_error_at_most`"]),
        ("[expect]\ncontact_impulse_within = [2, 1]", 8, &["2 is more than 1"]),
    ] {
        let diagnostics = Scene::parse(&text(keys), "t.toml", &[]).expect_err(keys);
        let [fault] = diagnostics.all() else { panic!("one fault expected for {keys}: {diagnostics}") };
        assert_eq!(fault.line, line, "{keys}: {fault}");
        for word in words {
            assert!(fault.message.contains(word), "`{word}` is not in: {}", fault.message);
        }
    }
}

#[test]
fn what_is_above_or_below_does_not_overlap() {
    let bridge =
        "[[props]]\nname = \"b\"\nshape = \"block\"\nsize = [1, 1, 0.1]\npose = [0, 0, 0]\nelevation = ";
    assert_eq!(props(&format!("{bridge}0.5")).len(), 1);
    assert_eq!(props(&format!("{bridge}-0.1")).len(), 1);
    assert!(Scene::parse(&text(&format!("{bridge}0.1")), "t.toml", &[]).is_err());
}
