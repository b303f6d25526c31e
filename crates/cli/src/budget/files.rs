//! A comparison as files: a figure, every number as JSON, and a table for other programs.

use super::picture;
use crate::failure::Failure;
use crate::replaced::{quoted, write_all};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use studies::budget::{Budget, Growth, ObserverChoice};

/// Writes figure, JSON and CSV into `folder`; what was there under their names is replaced.
pub(crate) fn write(folder: &Path, budget: &Budget<'_>, quiet: bool) -> Result<Vec<PathBuf>, Failure> {
    let stem = if budget.constants { "epsilon" } else { "budget" };
    let texts = [
        ("svg", picture::figure(budget).svg()),
        ("json", format!("{:#}\n", as_json(budget))),
        ("csv", as_csv(budget)),
    ];
    write_all(folder, &texts.map(|(ending, text)| (format!("{stem}.{ending}"), text)), quiet)
}

/// Every number, in m, rad and s.
pub(crate) fn as_json(budget: &Budget<'_>) -> Value {
    let edges: Vec<_> = (0..budget.fleet.edges.len()).collect();
    let runs = budget.runs.iter().map(|(case, run)| {
        let constant = match case.observer {
            ObserverChoice::Constant(constant) => constant,
            ObserverChoice::HighGain | ObserverChoice::Unscented => None,
        };
        json!({
            "sensing": case.level.word(),
            "pixel_noise": case.level.pixels(),
            "observer": observer(case.observer),
            "epsilon": constant,
            "adaptive": matches!(case.observer, ObserverChoice::Constant(None)),
            "contacts": run.contacts,
            "duration": run.duration,
            "edges": run.edges,
        })
    });
    let growth = |observer: ObserverChoice, edge: usize, channel: usize| {
        Growth::fit(&budget.curve(edge, observer, |m| Some(m.tracking[channel])))
    };
    let scaling = edges.iter().map(|edge| {
        let (each, all) = budget.camera_as_pixels(*edge);
        let measurements = [0, 1, 2]
            .map(|c| Growth::fit(&budget.curve(*edge, ObserverChoice::HighGain, |m| Some(m.measurements?[c]))));
        let told =
            [0, 1, 2].map(|c| Growth::fit(&budget.curve(*edge, ObserverChoice::HighGain, |m| Some(m.told?[c]))));
        let tracking = |observer: ObserverChoice| [0, 1].map(|c| growth(observer, *edge, c));
        json!({
            "measurements": measurements,
            "told": told,
            "tracking": { "high-gain": tracking(ObserverChoice::HighGain), "unscented": tracking(ObserverChoice::Unscented) },
            "camera_as_pixels": { "distance": each[0], "bearing": each[1], "view_angle": each[2], "all": all },
        })
    });
    let mut value = json!({
        "status": if budget.complete { "complete" } else { "interrupted" },
        "title": budget.scene.title,
        "seed": budget.scene.seed,
        "settled_after": budget.settled_after,
        "adapter": budget.camera.as_ref().ok(),
        "without_camera": budget.camera.as_ref().err(),
        "edges": edges.iter().map(|k| budget.edge(*k)).collect::<Vec<_>>(),
        "runs": runs.collect::<Vec<_>>(),
    });
    if !budget.constants {
        value["scaling"] = scaling.collect();
    }
    value
}

fn observer(observer: ObserverChoice) -> &'static str {
    match observer {
        ObserverChoice::Unscented => "unscented",
        ObserverChoice::HighGain | ObserverChoice::Constant(_) => "high-gain",
    }
}

const COLUMNS: &str = "sensing,pixel_noise_px,observer,epsilon_s,leader,follower,\
measurement_distance_rms_m,measurement_bearing_rms_rad,measurement_view_angle_rms_rad,measurement_distance_rms_share,\
told_distance_rms_m,told_bearing_rms_rad,told_view_angle_rms_rad,\
tracking_distance_rms_m,tracking_bearing_rms_rad,rate_distance_rms_m_s,rate_bearing_rms_rad_s,\
limited_share,in_view_share,measurements_taken,measurements_refused,lost_share\n";

/// A row for every edge of every run; empty where there is no value.
fn as_csv(budget: &Budget<'_>) -> String {
    let mut text = COLUMNS.to_owned();
    for (case, run) in &budget.runs {
        let epsilon = match case.observer {
            ObserverChoice::Constant(Some(epsilon)) => epsilon.to_string(),
            ObserverChoice::Constant(None) => "adaptive".to_owned(),
            ObserverChoice::HighGain | ObserverChoice::Unscented => String::new(),
        };
        for (index, edge) in run.edges.iter().enumerate() {
            let [leader, follower] = budget.edge(index).map(quoted);
            let (sensing, observer) = (case.level.word(), observer(case.observer));
            let _ = write!(
                text,
                "{sensing},{},{observer},{epsilon},{leader},{follower}",
                optional(case.level.pixels())
            );
            let three = |values: Option<[f64; 3]>| [0, 1, 2].map(|c| values.map(|v| v[c]));
            let numbers = three(edge.measurements)
                .into_iter()
                .chain([edge.measurements_relative])
                .chain(three(edge.told))
                .chain(edge.tracking.into_iter().chain(edge.rate_error).map(Some))
                .chain([Some(edge.limited), edge.in_view])
                .chain([edge.taken as f64, edge.refused as f64, edge.lost].map(Some));
            for number in numbers {
                let _ = write!(text, ",{}", optional(number));
            }
            text.push('\n');
        }
    }
    text
}

fn optional(number: Option<f64>) -> String {
    number.map_or_else(String::new, |n| n.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_quoted_where_they_have_to_be() {
        assert_eq!((quoted("ann"), quoted("a,\"b\"")), ("ann".to_owned(), "\"a,\"\"b\"\"\"".to_owned()));
    }
}
