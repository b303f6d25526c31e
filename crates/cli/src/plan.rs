//! `echelon plan`: the ways of lead robots to their goals, without a run.

use crate::Outcome;
use crate::args::SceneArgs;
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::print::{json, say};
use clap::Args;
use figures::{Key, Marker, Plan, PlanDots, PlanNode, PlanOutline, PlanPath, PlanStrip, Rgb, Stroke};
use output::{Place, write_whole};
use rendering::narrowing_colour;
use serde_json::json;
use std::fmt::Write;
use std::path::PathBuf;
use studies::plans::{PlannedWay, plans, recorded_plans};
use studies::{Error, SceneRun};
use vocabulary::{Body, Pose, Solid, counted};

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder for the picture, plan.svg, and the points of the ways, plan.csv; earlier ones are replaced
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Draws what the search looked at, too: where steps ended, and ways that were put aside
    #[arg(long, requires = "out")]
    search: bool,
}

pub(crate) fn plan(args: &PlanArgs) -> Outcome {
    let run = load(&args.scene)?;
    let ways = if args.search { recorded_plans(&run).map_err(Error::from)? } else { plans(&run) };
    if ways.is_empty() {
        let text = format!(
            "{}: nothing is planned in it: no robot that leads has a path of kind \"goal\" or \"tour\"",
            args.scene.scene.display()
        );
        return Err(Failure::Usage(text));
    }
    if let Some(folder) = &args.out {
        let _place = Place::folder(folder)?;
        write_whole(&folder.join("plan.svg"), picture(&run, &ways).svg().as_bytes())?;
        write_whole(&folder.join("plan.csv"), table(&ways).as_bytes())?;
    }
    if args.scene.json {
        json(&json!({ "scene": stem(&args.scene.scene), "ways": ways }));
    } else if !args.scene.quiet {
        for way in &ways {
            say(&line(way, run.scene.time.duration));
        }
    }
    Ok(())
}

fn line(way: &PlannedWay, duration: f64) -> String {
    let shape = match way.narrowest {
        0.0 => "in its shape throughout".to_owned(),
        1.0 => "down to its column".to_owned(),
        share => format!("narrowed by {:.0} % at most", 100.0 * share),
    };
    let yields = match way.yields_to.as_slice() {
        [] => String::new(),
        leads => format!("; yields to {}", leads.join(" and ")),
    };
    let late = if way.begins + way.duration > duration { "; the run ends before it is there" } else { "" };
    format!(
        "{} {}: {:.1} m in {:.1} s from {:.1} s on; {}, {shape}{yields}{late}; {} swept",
        way.lead,
        way.goal.map_or_else(|| "to a stand".to_owned(), |goal| format!("to goal {goal}")),
        way.length,
        way.duration,
        way.begins,
        counted(way.robots.len(), "robot"),
        counted(way.expansions, "step"),
    )
}

/// A row for every robot and point.
fn table(ways: &[PlannedWay]) -> String {
    let mut text = String::from(
        "lead,goal,time_s,way_m,curvature_per_m,speed_m_per_s,narrowing,robot,x_m,y_m,heading_rad\n",
    );
    for way in ways {
        for row in &way.rows {
            for (robot, pose) in way.robots.iter().zip(&row.poses) {
                // Writing to a text cannot fail.
                let _ = writeln!(
                    text,
                    "{},{},{},{},{},{},{},{robot},{},{},{}",
                    way.lead,
                    way.goal.map_or_else(String::new, |goal| goal.to_string()),
                    row.time,
                    row.way,
                    row.curvature,
                    row.speed,
                    row.narrowing,
                    pose.x,
                    pose.y,
                    pose.heading
                );
            }
        }
    }
    text
}

/// The ways of all robots over what stands there; the lead's is dark.
fn picture(run: &SceneRun, ways: &[PlannedWay]) -> Plan {
    let colours = rendering::robot_colours(run.simulation.fleet());
    let names: Vec<&str> = run.simulation.fleet().robots.iter().map(|robot| &*robot.name).collect();
    let colour = |name: &str| -> Rgb {
        let index = names.iter().position(|known| *known == name);
        index.and_then(|index| colours.get(index).copied()).unwrap_or([0.3; 3])
    };
    let bodies: Vec<Body> = run.simulation.fleet().robots.iter().map(|robot| robot.body).collect();
    let body = |name: &str| names.iter().position(|known| *known == name).map(|index| bodies[index]);
    let (mut strips, mut dots, mut tracks) = (vec![], vec![], vec![]);
    for way in ways {
        for (k, robot) in way.robots.iter().enumerate() {
            strips.extend(body(robot).into_iter().flat_map(|body| swept(way, k, &body)));
        }
        dots.push(PlanDots { points: way.record.tried.clone(), colour: TRIED });
        tracks.extend(way.record.rejected.iter().map(|points| PlanPath {
            points: points.clone(),
            colour: REJECTED,
            stroke: Stroke::Dashed,
            faint: true,
        }));
        for (k, robot) in way.robots.iter().enumerate().rev() {
            tracks.push(PlanPath {
                points: way
                    .rows
                    .iter()
                    .filter_map(|row| row.poses.get(k))
                    .map(|pose| [pose.x, pose.y])
                    .collect(),
                colour: if k == 0 { [0.1; 3] } else { colour(robot) },
                stroke: Stroke::Solid,
                faint: k > 0,
            });
        }
    }
    let outlines = run.scene.props.iter().map(|prop| PlanOutline {
        points: outline(prop.pose, &prop.solid),
        colour: [0.45; 3],
        // What is found on the way is not in the plan.
        filled: if prop.known { 0.5 } else { 0.0 },
    });
    let goals = ways.iter().filter_map(|way| {
        let [x, y] = way.rows.last()?.poses.first().map(|pose| [pose.x, pose.y])?;
        let name = way.goal.filter(|_| ways.len() > 1).map_or_else(String::new, |goal| goal.to_string());
        Some(PlanNode { at: [x, y], name, radius: 5.0, colour: [0.1; 3], filled: false })
    });
    Plan {
        title: format!("{}: the plan", run.scene.title),
        axes: Some(["x (m)".to_owned(), "y (m)".to_owned()]),
        strips,
        dots,
        tracks,
        outlines: outlines.collect(),
        nodes: goals.collect(),
        keys: keys(ways),
        width: 170.0,
        height: 140.0,
        ..Plan::default()
    }
}

/// Where steps of a search ended, and ways that were put aside.
const TRIED: Rgb = [0.72, 0.74, 0.78];
const REJECTED: Rgb = [0.62, 0.2, 0.45];

/// The ground that robot number `k` of a way sweeps: a strip wherever the formation is about as narrow.
fn swept(way: &PlannedWay, k: usize, body: &Body) -> Vec<PlanStrip> {
    let mut strips: Vec<(i64, PlanStrip)> = vec![];
    for row in &way.rows {
        let Some(pose) = row.poses.get(k) else { continue };
        let at = pose.world_from_body(0.5 * body.wheelbase, 0.0);
        let shade = (row.narrowing * SHADES).round();
        if let Some((_, strip)) = strips.last_mut() {
            strip.points.push(at);
        }
        if strips.last().is_none_or(|(last, _)| *last != shade as i64) {
            let colour = narrowing_colour(shade / SHADES);
            strips.push((shade as i64, PlanStrip { points: vec![at], width: body.width, colour }));
        }
    }
    strips.into_iter().map(|(_, strip)| strip).collect()
}

/// Shades between shape and column.
const SHADES: f64 = 6.0;

/// What colours and strokes stand for.
fn keys(ways: &[PlannedWay]) -> Vec<Key> {
    let key = |name: &str, stroke, marker, colour| Key {
        name: name.to_owned(),
        stroke,
        marker,
        colour: Some(colour),
    };
    let mut keys = vec![key("way of the lead", Stroke::Solid, Marker::None, [0.1; 3])];
    keys.push(key("swept in the shape", Stroke::Solid, Marker::None, narrowing_colour(0.0)));
    if ways.iter().any(|way| way.narrowest > 0.5) {
        keys.push(key("in the column", Stroke::Solid, Marker::None, narrowing_colour(1.0)));
    }
    if ways.iter().any(|way| !way.record.tried.is_empty()) {
        keys.push(key("step of the search", Stroke::None, Marker::Disc, TRIED));
    }
    if ways.iter().any(|way| !way.record.rejected.is_empty()) {
        keys.push(key("way put aside", Stroke::Dashed, Marker::None, REJECTED));
    }
    keys
}

/// Corners of a circle as it is drawn.
const CORNERS: u32 = 32;

fn outline(pose: Pose, solid: &Solid) -> Vec<[f64; 2]> {
    match *solid {
        Solid::Block { size } | Solid::Wedge { size } => [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
            .map(|[x, y]: [f64; 2]| pose.world_from_body(0.5 * x * size[0], 0.5 * y * size[1]))
            .to_vec(),
        Solid::Cylinder { radius, .. } | Solid::Cone { radius, .. } => (0..CORNERS)
            .map(|k| {
                let (sin, cos) =
                    vocabulary::math::sin_cos(std::f64::consts::TAU * f64::from(k) / f64::from(CORNERS));
                [pose.x + radius * cos, pose.y + radius * sin]
            })
            .collect(),
    }
}
