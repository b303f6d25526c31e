//! Pictures that were drawn elsewhere, as figures: inside SVG, with the poses of all robots beside them.

use crate::draw::{number, quoted};
use crate::figure::{Report, ReportFigure};
use crate::paper::drawn_claims;
use crate::trace::Trace;
use base64::Engine;
use std::fmt::Write;

/// A picture of a run at a time.
#[derive(Debug, Clone)]
pub struct ReportPicture {
    /// File name without its ending.
    pub stem: String,
    /// What is seen.
    pub caption: String,
    /// The file.
    pub png: Vec<u8>,
    /// Pixels.
    pub size: [u32; 2],
    /// s.
    pub time: f64,
}

/// Width of a picture on paper, mm: two columns of a journal.
const WIDTH: f64 = 170.0;

/// Puts a picture of `run` among the figures; numbered ones stand in order.
pub fn add_picture(report: &mut Report, shot: ReportPicture, run: &Trace) {
    let [width, height] = shot.size.map(f64::from);
    let tall = WIDTH * height / width.max(1.0);
    let data = base64::engine::general_purpose::STANDARD.encode(&shot.png);
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{WIDTH}mm\" \
         height=\"{tall:.2}mm\" viewBox=\"0 0 {width} {height}\">\n<image width=\"{width}\" height=\"{height}\" \
         xlink:href=\"data:image/png;base64,{data}\"/>\n</svg>\n"
    );
    let claims = if shot.stem.starts_with(NUMBERED) { drawn_claims(&shot.stem, run) } else { vec![] };
    let item = ReportFigure {
        picture: Some(shot.png),
        ..ReportFigure::new(shot.stem, shot.caption, svg, poses(run, shot.time)).with(claims)
    };
    let after = |other: &ReportFigure| item.stem.starts_with(NUMBERED) && other.stem > item.stem;
    let place = report.items.iter().position(after).unwrap_or(report.items.len());
    report.items.insert(place, item);
}

/// How figures begin that stand in order.
const NUMBERED: &str = "figure-";

fn poses(run: &Trace, time: f64) -> String {
    let sample = run.sample_at(time);
    let mut csv = String::from("time_s,robot,x_m,y_m,heading_rad,speed_m_s\n");
    let now = run.times.get(sample).copied().unwrap_or(time);
    for (member, motions) in run.fleet.robots.iter().zip(&run.robots) {
        let Some(m) = motions.get(sample) else { continue };
        let cells = [m.pose.x, m.pose.y, m.pose.heading, m.speed].map(number).join(",");
        let _ = writeln!(csv, "{},{},{cells}", number(now), quoted(&member.name));
    }
    csv
}
