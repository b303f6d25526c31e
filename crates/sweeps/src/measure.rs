//! The numbers of a run that its row has: of several followers or robots the worst.

use metrics::{EdgeMetrics, Metrics, RobotMetrics};

/// A number of a run.
#[derive(Debug, Clone, Copy)]
pub struct RunMeasure {
    /// Its column, which ends in its unit.
    pub column: &'static str,
    /// What it is, with its unit, for axes and tables.
    pub label: &'static str,
    of: fn(&Metrics) -> f64,
}

/// All numbers of a run, in the order of their columns.
pub const MEASURES: [RunMeasure; 24] = [
    RunMeasure {
        column: "final_distance_error_m",
        label: "|distance error| at the end (m)",
        of: |m| worst(m, |e| e.final_error[0].abs()),
    },
    RunMeasure {
        column: "final_bearing_error_rad",
        label: "|bearing error| at the end (rad)",
        of: |m| worst(m, |e| e.final_error[1].abs()),
    },
    RunMeasure {
        column: "rms_distance_error_m",
        label: "RMS distance error (m)",
        of: |m| worst(m, |e| e.rms_error[0]),
    },
    RunMeasure {
        column: "rms_bearing_error_rad",
        label: "RMS bearing error (rad)",
        of: |m| worst(m, |e| e.rms_error[1]),
    },
    RunMeasure {
        column: "peak_distance_error_m",
        label: "largest |distance error| (m)",
        of: |m| worst(m, |e| e.peak_error[0]),
    },
    RunMeasure {
        column: "peak_bearing_error_rad",
        label: "largest |bearing error| (rad)",
        of: |m| worst(m, |e| e.peak_error[1]),
    },
    RunMeasure {
        column: "late_distance_error_m",
        label: "largest late |distance error| (m)",
        of: |m| worst(m, |e| e.late_peak_error[0]),
    },
    RunMeasure {
        column: "late_bearing_error_rad",
        label: "largest late |bearing error| (rad)",
        of: |m| worst(m, |e| e.late_peak_error[1]),
    },
    RunMeasure {
        column: "late_rms_distance_error_m",
        label: "late RMS distance error (m)",
        of: |m| worst(m, |e| e.late_rms_error[0]),
    },
    RunMeasure {
        column: "late_rms_bearing_error_rad",
        label: "late RMS bearing error (rad)",
        of: |m| worst(m, |e| e.late_rms_error[1]),
    },
    RunMeasure {
        column: "iae_distance_m_s",
        label: "∫ |distance error| dt (m s)",
        of: |m| worst(m, |e| e.iae[0]),
    },
    RunMeasure {
        column: "iae_bearing_rad_s",
        label: "∫ |bearing error| dt (rad s)",
        of: |m| worst(m, |e| e.iae[1]),
    },
    RunMeasure { column: "settling_time_s", label: "settling time (s)", of: settling },
    RunMeasure {
        column: "effort_acceleration_m_s",
        label: "∫ |acceleration| dt (m/s)",
        of: |m| worst(m, |e| e.effort[0]),
    },
    RunMeasure {
        column: "effort_turn_rate_rad",
        label: "∫ |turn rate| dt (rad)",
        of: |m| worst(m, |e| e.effort[1]),
    },
    RunMeasure {
        column: "peak_rate_distance_m_s",
        label: "largest |estimated rate of distance| (m/s)",
        of: |m| worst(m, |e| e.peak_rates[0]),
    },
    RunMeasure {
        column: "peak_rate_bearing_rad_s",
        label: "largest |estimated rate of bearing| (rad/s)",
        of: |m| worst(m, |e| e.peak_rates[1]),
    },
    RunMeasure {
        column: "limited",
        label: "share of commands that a limit cut",
        of: |m| worst(m, |e| e.limited),
    },
    RunMeasure { column: "in_view", label: "share of looks that showed the leader", of: in_view },
    RunMeasure {
        column: "filter_moved",
        label: "share of commands that a safety filter moved",
        of: |m| of_robots(m, |r| Some(r.safety.as_ref()?.moved)),
    },
    RunMeasure {
        column: "lift_max_m",
        label: "largest height over the ground (m)",
        of: |m| of_robots(m, |r| Some(r.lift_max)),
    },
    RunMeasure {
        column: "unable",
        label: "robots that can drive no more",
        of: |m| m.robots.iter().filter(|r| r.condition != "able").count() as f64,
    },
    RunMeasure {
        column: "clearance_min_m",
        label: "least clearance (m)",
        of: |m| m.clearance_min.unwrap_or(f64::NAN),
    },
    RunMeasure {
        column: "contact_impulse_max_n_s",
        label: "largest impulse of a contact (N s)",
        of: |m| m.contact_impulse_max,
    },
];

impl RunMeasure {
    /// The number of a run; not a number where the run has none.
    pub fn of(&self, metrics: &Metrics) -> f64 {
        (self.of)(metrics)
    }

    /// The measure of this column.
    pub fn called(column: &str) -> Option<&'static Self> {
        MEASURES.iter().find(|measure| measure.column == column)
    }
}

/// The largest of all edges; NaN where there are none.
fn worst(metrics: &Metrics, of: impl Fn(&EdgeMetrics) -> f64) -> f64 {
    metrics.edges.iter().map(of).fold(f64::NAN, f64::max)
}

/// The largest of the robots that have it; NaN where none has.
fn of_robots(metrics: &Metrics, of: impl Fn(&RobotMetrics) -> Option<f64>) -> f64 {
    metrics.robots.iter().filter_map(of).fold(f64::NAN, f64::max)
}

/// When the last edge settled; NaN if one did not.
fn settling(metrics: &Metrics) -> f64 {
    let edges = metrics.edges.iter().filter(|edge| edge.ended.is_none());
    let times: Option<Vec<f64>> = edges.map(|edge| edge.settling_time).collect();
    times.unwrap_or_default().into_iter().fold(f64::NAN, f64::max)
}

/// The least share of all edges that measure; NaN where none does.
fn in_view(metrics: &Metrics) -> f64 {
    let shares = metrics.edges.iter().filter_map(|edge| Some(edge.measurements.as_ref()?.in_view));
    shares.fold(f64::NAN, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formation_settles_when_its_last_edge_does() {
        let edge = |settling_time| EdgeMetrics { settling_time, ..EdgeMetrics::default() };
        let text = "schema = 1\ntitle = \"t\"\n[time]\nduration = 0.1\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\n\
            path = { kind = \"constant\", speed = 1.0 }\n";
        let scene = scene::Scene::parse(text, "t.toml", &[]).expect("a scene").scene;
        let run = studies::SceneRun::new(scene).expect("a run");
        let mut metrics = studies::run::run(run, None, None, |_| true).expect("judged").metrics;
        let time = |metrics: &Metrics| RunMeasure::called("settling_time_s").expect("a measure").of(metrics);
        assert!(
            time(&metrics).is_nan()
                && RunMeasure::called("limited").expect("a measure").of(&metrics).is_nan()
        );
        metrics.edges = vec![edge(Some(1.0)), edge(Some(3.0)), edge(Some(2.0))];
        assert_eq!(time(&metrics), 3.0);
        metrics.edges.push(edge(None));
        assert!(time(&metrics).is_nan());
    }

    #[test]
    fn columns_are_called_differently() {
        let mut names: Vec<&str> = MEASURES.iter().map(|measure| measure.column).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), MEASURES.len());
    }
}
