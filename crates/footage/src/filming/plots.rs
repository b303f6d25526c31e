//! What is plotted beside the view: quantities of edges, collected frame by frame.

use rendering::{CurvePanel as Shown, PanelCurve};
use scene::Plot;
use vocabulary::{Edge, FleetInfo, StepRecord, Word};

/// Everything that may be plotted, so far.
pub(super) struct Plots {
    fleet: FleetInfo,
    duration: f64,
    /// Per quantity and edge: [time, value].
    curves: Vec<Vec<Vec<[f64; 2]>>>,
}

impl Plots {
    pub(super) fn new(fleet: &FleetInfo, duration: f64) -> Self {
        Self {
            fleet: fleet.clone(),
            duration,
            curves: vec![vec![vec![]; fleet.edges.len()]; Plot::WORDS.len()],
        }
    }

    /// Takes in the moment of a frame.
    pub(super) fn record(&mut self, record: &StepRecord) {
        let time = record.snapshot.time;
        for ((_, quantity, _), curves) in Plot::WORDS.iter().zip(&mut self.curves) {
            for (index, curve) in curves.iter_mut().enumerate() {
                // While a card stands, so does the time.
                if curve.last().is_none_or(|last| time > last[0]) {
                    let now = record.edge(&self.fleet, index);
                    let now = now.and_then(|edge| value(*quantity, record, index, edge));
                    curve.push([time, now.unwrap_or(f64::NAN)]);
                }
            }
        }
    }

    /// The plots of some quantities.
    pub(super) fn shown(&self, plots: &[Plot]) -> Vec<Shown> {
        plots.iter().filter_map(|plot| self.one(*plot)).collect()
    }

    fn one(&self, plot: Plot) -> Option<Shown> {
        let index = Plot::WORDS.iter().position(|(_, other, _)| *other == plot)?;
        let (label, least, centred) = match plot {
            Plot::DistanceError => ("distance error (m)", 0.02, true),
            Plot::BearingError => ("bearing error (°)", 1.0, true),
            Plot::Speed => ("speed (m/s)", 0.2, false),
            Plot::TurnRate => ("turn rate (rad/s)", 0.2, true),
            Plot::Acceleration => ("acceleration (m/s²)", 0.5, true),
            Plot::Distance => ("distance (m)", 0.2, false),
        };
        let curves = self.fleet.edges.iter().zip(&self.curves[index]);
        let curves = curves.map(|(edge, points)| PanelCurve { robot: edge.follower, points: points.clone() });
        let span = [0.0, self.duration];
        Some(Shown { label: label.to_owned(), span, least, centred, curves: curves.collect() })
    }
}

fn value(plot: Plot, record: &StepRecord, index: usize, edge: Edge) -> Option<f64> {
    let state = record.edges.get(index)?;
    Some(match plot {
        Plot::DistanceError => state.error[0],
        Plot::BearingError => state.error[1].to_degrees(),
        Plot::Speed => record.snapshot.robots.get(edge.follower)?.motion.speed,
        Plot::TurnRate => state.applied.turn_rate,
        Plot::Acceleration => state.applied.acceleration,
        Plot::Distance => state.relative.distance,
    })
}
