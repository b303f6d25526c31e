//! The ways that were planned for the lead robots of a scene, as rows.

use crate::SceneRun;
use serde::Serialize;
use simulation::{BuildError, Goals, SearchRecord};
use vocabulary::Pose;

/// The way of a lead robot to one of its goals.
#[derive(Debug, Clone, Serialize)]
pub struct PlannedWay {
    /// Name of the lead robot.
    pub lead: String,
    /// Number of the goal, from 1; `None` where it only comes to a stand.
    pub goal: Option<usize>,
    /// Names of the robots that it is planned for, the lead first.
    pub robots: Vec<String>,
    /// Leads that planned before, whose robots it keeps away from.
    pub yields_to: Vec<String>,
    /// When the lead sets out, s.
    pub begins: f64,
    /// How long it takes, s.
    pub duration: f64,
    /// m.
    pub length: f64,
    /// The narrowest that the formation gets: 0 in its shape, 1 in its column.
    pub narrowest: f64,
    /// Steps that were swept in search of it.
    pub expansions: usize,
    /// The same for the same way, to the last bit.
    pub digest: String,
    /// Points along it.
    #[serde(skip)]
    pub rows: Vec<PlannedRow>,
    /// What the search for it looked at, if that was recorded.
    #[serde(skip)]
    pub record: SearchRecord,
}

/// A point of a way.
#[derive(Debug, Clone)]
pub struct PlannedRow {
    /// From the beginning of the run, s.
    pub time: f64,
    /// Way gone, m.
    pub way: f64,
    /// 1/m, positive to the left.
    pub curvature: f64,
    /// Of the lead, m/s.
    pub speed: f64,
    /// 0 in the shape, 1 in the column.
    pub narrowing: f64,
    /// Of all robots where each keeps its place, the lead first.
    pub poses: Vec<Pose>,
}

/// The ways of all lead robots that have goals, in the order of robots and goals.
pub fn plans(run: &SceneRun) -> Vec<PlannedWay> {
    ways(run, run.simulation.goals())
}

/// The same, planned once more, with what the searches looked at.
///
/// # Errors
/// There is no way.
pub fn recorded_plans(run: &SceneRun) -> Result<Vec<PlannedWay>, BuildError> {
    Ok(ways(run, &simulation::recorded_plans(&run.scene)?))
}

fn ways(run: &SceneRun, goals: &Goals) -> Vec<PlannedWay> {
    let names = &run.simulation.fleet().robots;
    let mut ways = vec![];
    let mut before: Vec<String> = vec![];
    for (lead, motion) in goals.motions() {
        let robots: Vec<String> = motion.robots.iter().map(|robot| names[*robot].name.clone()).collect();
        let column = motion.levels.saturating_sub(1).max(1) as f64;
        for part in motion.parts() {
            let (begins, plan) = (part.begins, &part.plan);
            let row = |point: &simulation::PlanPoint| PlannedRow {
                time: begins + point.time,
                way: point.way,
                curvature: point.curvature,
                speed: point.speed,
                narrowing: point.level / column,
                poses: point.robots.clone(),
            };
            let rows: Vec<PlannedRow> = plan.points.iter().map(row).collect();
            ways.push(PlannedWay {
                lead: names[lead].name.clone(),
                goal: part.goal.map(|goal| goal + 1),
                robots: robots.clone(),
                yields_to: before.clone(),
                begins,
                duration: plan.duration(),
                length: plan.length(),
                narrowest: rows.iter().map(|row| row.narrowing).fold(0.0, f64::max),
                expansions: plan.expansions,
                digest: format!("{:016x}", plan.digest()),
                rows,
                record: plan.record.clone(),
            });
        }
        before.push(names[lead].name.clone());
    }
    ways
}
