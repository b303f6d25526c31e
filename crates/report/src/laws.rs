//! Figures that compare laws and observer constants, the same for the paper's scenes and for any other.

use crate::claim::{
    Compared, faster_observers_cost, faster_observers_err_less, knowing_less_costs, knowing_less_errs,
};
use crate::draw::{EdgeCurve, Magnify, errors, inputs};
use crate::figure::ReportFigure;

/// The four figures of comparisons, and how much of the start they magnify, s.
pub(crate) struct LawComparison<'a> {
    pub(crate) runs: &'a Compared<'a>,
    pub(crate) edge: usize,
    pub(crate) start: f64,
    /// Which way, such as `straight line`.
    pub(crate) of: &'a str,
}

/// What the grey and the part on the left mean.
fn reading(start: f64) -> String {
    format!("Left: the first {start} s, magnified (shaded on the right).")
}

impl LawComparison<'_> {
    fn follower(&self) -> &str {
        self.runs.first().map_or("", |(_, run)| run.follower(self.edge))
    }

    fn curves(&self) -> Vec<EdgeCurve<'_>> {
        EdgeCurve::compared(self.runs, self.edge)
    }

    pub(crate) fn laws_inputs(&self, stem: &str) -> ReportFigure {
        let caption = format!(
            "Inputs of {} under full state feedback (FSFB, eq 20), robust state feedback (RSFB, eq 22) and output feedback \
             (OFB, eq 42), {}. Grey: beyond the bounds. {}",
            self.follower(),
            self.of,
            reading(self.start)
        );
        let drawn = inputs(&self.curves(), Magnify::First(self.start));
        drawn.item(stem, caption).with(knowing_less_costs(stem, self.runs, self.edge))
    }

    pub(crate) fn laws_errors(&self, stem: &str) -> ReportFigure {
        let caption = format!(
            "Tracking error of {} under the three laws, {}; below, its size on a logarithmic axis, where what stays can be \
             told apart.",
            self.follower(),
            self.of
        );
        let drawn = errors(&self.curves(), Magnify::No);
        drawn.item(stem, caption).with(knowing_less_errs(stem, self.runs, self.edge))
    }

    pub(crate) fn constants_inputs(&self, stem: &str) -> ReportFigure {
        let caption = format!(
            "Inputs of {} under output feedback with different observer constants ε, {}. Grey: beyond the bounds. {}",
            self.follower(),
            self.of,
            reading(self.start)
        );
        let drawn = inputs(&self.curves(), Magnify::First(self.start));
        drawn.item(stem, caption).with(faster_observers_cost(stem, self.runs, self.edge))
    }

    pub(crate) fn constants_errors(&self, stem: &str) -> ReportFigure {
        let caption = format!(
            "Tracking error of {} under output feedback with different observer constants ε, {}.",
            self.follower(),
            self.of
        );
        let drawn = errors(&self.curves(), Magnify::No);
        drawn.item(stem, caption).with(faster_observers_err_less(stem, self.runs, self.edge))
    }
}
