//! The picture of the crates in the architecture page, drawn from `cargo metadata`: `scripts/architecture` writes it.

use crate::{dependencies, root};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Width and height of a box, and the gaps between boxes, pixels.
const BOX: [f64; 2] = [112.0, 34.0];
const GAP: [f64; 2] = [26.0, 44.0];
const MARGIN: f64 = 16.0;

type Uses = BTreeMap<String, BTreeSet<String>>;

/// Our crates and which of them each uses; tests and fuzz targets use nearly all and are left out.
fn ours() -> Uses {
    let all = dependencies(false);
    let drawn: BTreeSet<String> =
        all.keys().filter(|name| !["tests", "fuzz"].contains(&name.as_str())).cloned().collect();
    let among = |uses: &BTreeSet<String>| uses.intersection(&drawn).cloned().collect();
    all.iter()
        .filter(|(name, _)| drawn.contains(*name))
        .map(|(name, uses)| (name.clone(), among(uses)))
        .collect()
}

/// All that `name` uses, directly or through others.
fn reach(uses: &Uses, name: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![name.to_owned()];
    while let Some(next) = open.pop() {
        for used in uses.get(&next).into_iter().flatten() {
            if found.insert(used.clone()) {
                open.push(used.clone());
            }
        }
    }
    found
}

/// Arrows that do not follow from others.
fn needed(uses: &Uses) -> Vec<[String; 2]> {
    let mut arrows = vec![];
    for (name, direct) in uses {
        for used in direct {
            let follows = direct.iter().any(|other| other != used && reach(uses, other).contains(used));
            if !follows {
                arrows.push([name.clone(), used.clone()]);
            }
        }
    }
    arrows
}

/// How many crates lie at most between each crate and the ground.
fn levels(uses: &Uses) -> BTreeMap<String, usize> {
    fn level(uses: &Uses, name: &str) -> usize {
        uses.get(name).into_iter().flatten().map(|used| 1 + level(uses, used)).max().unwrap_or(0)
    }
    uses.keys().map(|name| (name.clone(), level(uses, name))).collect()
}

/// The rows of the picture, the highest level first. Each row is sorted by the mean place of what it uses and of who uses
/// it, a few times over, so that few arrows cross.
fn rows(uses: &Uses) -> Vec<Vec<String>> {
    let levels = levels(uses);
    let top = levels.values().copied().max().unwrap_or(0);
    let of_level =
        |level: usize| levels.iter().filter(move |(_, l)| **l == level).map(|(name, _)| name.clone());
    let mut rows: Vec<Vec<String>> = (0..=top).rev().map(|level| of_level(level).collect()).collect();
    let arrows = needed(uses);
    for _ in 0..12 {
        let places = places(&rows);
        for row in &mut rows {
            let mean = |name: &String| {
                let near: Vec<f64> = arrows
                    .iter()
                    .filter_map(|[from, to]| match (from == name, to == name) {
                        (true, _) => Some(places[to][0]),
                        (_, true) => Some(places[from][0]),
                        _ => None,
                    })
                    .collect();
                near.iter().sum::<f64>() / near.len().max(1) as f64
            };
            row.sort_by(|a, b| mean(a).total_cmp(&mean(b)));
        }
    }
    rows
}

/// The middle of each box.
fn places(rows: &[Vec<String>]) -> BTreeMap<String, [f64; 2]> {
    let widest = rows.iter().map(Vec::len).max().unwrap_or(0) as f64;
    let step = [BOX[0] + GAP[0], BOX[1] + GAP[1]];
    let mut places = BTreeMap::new();
    for (down, row) in rows.iter().enumerate() {
        for (across, name) in row.iter().enumerate() {
            let x = (across as f64 + 0.5 + 0.5 * (widest - row.len() as f64)) * step[0];
            places.insert(
                name.clone(),
                [MARGIN + x - 0.5 * GAP[0], MARGIN + down as f64 * step[1] + 0.5 * BOX[1]],
            );
        }
    }
    places
}

/// Goes on to a point, leaving and arriving upright.
fn curve(path: &mut String, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) {
    let bend = 0.45 * (y1 - y0);
    write!(path, "C{x0} {} {x1} {} {x1} {y1}", y0 + bend, y1 - bend).expect("a string");
}

fn picture(uses: &Uses) -> String {
    let rows = rows(uses);
    let places = places(&rows);
    let across =
        rows.iter().map(Vec::len).max().unwrap_or(0) as f64 * (BOX[0] + GAP[0]) - GAP[0] + 2.0 * MARGIN;
    let down = rows.len() as f64 * (BOX[1] + GAP[1]) - GAP[1] + 2.0 * MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{across}\" height=\"{down}\" viewBox=\"0 0 {across} {down}\" \
         font-family=\"sans-serif\" font-size=\"14\">\n<title>The crates and what they use</title>\n\
         <defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" \
         orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#667\"/></marker></defs>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
    // How many arrows pass each gap already.
    let mut passed: BTreeMap<(usize, i64), u32> = BTreeMap::new();
    for [from, to] in needed(uses) {
        let ([x0, y0], [x1, y1]) = (places[&from], places[&to]);
        let mut at = [x0, y0 + 0.5 * BOX[1]];
        let mut path = format!("M{x0} {}", at[1]);
        for (row, y) in rows.iter().map(|row| (row, places[&row[0]][1])).filter(|(_, y)| y0 < *y && *y < y1) {
            // Between the boxes of a row, never behind one; side by side where several take the same gap.
            let straight = x0 + (x1 - x0) * (y - y0) / (y1 - y0);
            let beside = row
                .iter()
                .flat_map(|name| [-0.5, 0.5].map(|side| places[name][0] + side * (BOX[0] + GAP[0])));
            let gap = beside.min_by(|a, b| (a - straight).abs().total_cmp(&(b - straight).abs()));
            let gap = gap.expect("a row has a box");
            let before = passed.entry((y as usize, gap as i64)).or_default();
            let x = gap - 6.0 + 4.0 * f64::from(*before);
            *before += 1;
            curve(&mut path, at, [x, y - 0.5 * BOX[1]]);
            at = [x, y + 0.5 * BOX[1]];
            write!(path, "V{}", at[1]).expect("a string");
        }
        curve(&mut path, at, [x1, y1 - 0.5 * BOX[1]]);
        writeln!(svg, "<path d=\"{path}\" fill=\"none\" stroke=\"#99a\" marker-end=\"url(#tip)\"/>")
            .expect("a string");
    }
    for (name, [x, y]) in &places {
        let [left, top] = [x - 0.5 * BOX[0], y - 0.5 * BOX[1]];
        writeln!(
            svg,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" rx=\"6\" fill=\"#eef3fb\" stroke=\"#3b6ea5\"/>\
             <text x=\"{x}\" y=\"{}\" text-anchor=\"middle\" fill=\"#123\">{name}</text>",
            BOX[0],
            BOX[1],
            y + 5.0
        )
        .expect("a string");
    }
    svg + "</svg>\n"
}

#[test]
fn the_picture_of_the_crates_is_true() {
    let (path, drawn) = (root().join("docs/crates.svg"), picture(&ours()));
    if std::env::var_os("UPDATE_PICTURE").is_some() {
        std::fs::write(&path, &drawn).expect("docs/crates.svg");
    }
    let shown = std::fs::read_to_string(path).unwrap_or_default();
    assert!(shown == drawn, "docs/crates.svg shows other arrows: run scripts/architecture");
}

#[test]
fn arrows_that_follow_from_others_are_left_out() {
    let uses: Uses = [("a", vec!["b", "c"]), ("b", vec!["c"]), ("c", vec![])]
        .into_iter()
        .map(|(name, uses)| (name.to_owned(), uses.into_iter().map(str::to_owned).collect()))
        .collect();
    assert_eq!(needed(&uses), [["a", "b"], ["b", "c"]].map(|arrow| arrow.map(str::to_owned)));
    assert_eq!(rows(&uses), [["a"], ["b"], ["c"]].map(|row| row.map(str::to_owned).to_vec()));
}

/// The README and the architecture page name every crate.
#[test]
fn every_crate_is_on_the_maps() {
    for page in ["README.md", "docs/architecture.md"] {
        let text = std::fs::read_to_string(root().join(page)).expect("a page");
        for name in ours().keys() {
            assert!(text.contains(&format!("`{name}`")), "{page} does not name `{name}`");
        }
    }
}

#[test]
fn the_readme_is_short() {
    let lines = std::fs::read_to_string(root().join("README.md")).expect("a page").lines().count();
    assert!(lines <= 130, "{lines} lines");
}
