//! Claims of figures, checked against the runs. Nothing here is asserted: a claim consists of measured
//! values, and its verdict follows from them.

use crate::trace::Trace;
use crate::words::{quantity, told_apart};
use serde::Serialize;
use vocabulary::math;

/// A measured value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClaimValue {
    /// Of what.
    pub name: String,
    /// SI.
    pub value: f64,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
}

/// A claim about a figure, and its verdict.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureClaim {
    /// Which figure is to show it.
    pub figure: String,
    /// What should be seen.
    pub claim: String,
    /// What the numbers are.
    pub quantity: String,
    /// The numbers, in the order of the claim.
    pub values: Vec<ClaimValue>,
    /// The condition on them.
    pub wanted: String,
    /// Their upper limit, if the condition is one.
    #[serde(skip)]
    pub(crate) limit: Option<f64>,
    /// Whether they meet it.
    pub holds: bool,
}

/// What a claim is about.
#[derive(Debug, Clone, Copy)]
pub struct ClaimSubject<'a> {
    /// Which figure is to show it.
    pub figure: &'a str,
    /// What should be seen.
    pub claim: &'a str,
    /// What the numbers are.
    pub quantity: &'a str,
    /// Their unit; empty where they have none.
    pub unit: &'static str,
}

impl<'a> ClaimSubject<'a> {
    /// What a figure should show of a quantity with a unit.
    pub const fn new(figure: &'a str, claim: &'a str, quantity: &'a str, unit: &'static str) -> Self {
        Self { figure, claim, quantity, unit }
    }
}

/// Differences below this share are rounding.
const ROUNDING: f64 = 1e-9;

impl FigureClaim {
    fn new(about: ClaimSubject<'_>, values: &[(&str, f64)], wanted: String, holds: bool) -> Self {
        let ClaimSubject { figure, claim, quantity, unit } = about;
        let value =
            |(name, value): &(&str, f64)| ClaimValue { name: (*name).to_owned(), value: *value, unit };
        // A run that broke off has nothing to show for a claim.
        let measured = !values.is_empty() && values.iter().all(|(_, value)| value.is_finite());
        Self {
            figure: figure.to_owned(),
            claim: claim.to_owned(),
            quantity: quantity.to_owned(),
            values: values.iter().map(value).collect(),
            wanted,
            limit: None,
            holds: holds && measured,
        }
    }

    /// Every value is larger than the one before.
    pub fn rises(about: ClaimSubject<'_>, values: &[(&str, f64)]) -> Self {
        let up = |w: &[(&str, f64)]| w[1].1 - w[0].1 > ROUNDING * w[0].1.abs();
        let holds = values.len() > 1 && values.windows(2).all(up);
        Self::new(about, values, "rises from each to the next".to_owned(), holds)
    }

    /// Every value is smaller than the one before.
    pub fn falls(about: ClaimSubject<'_>, values: &[(&str, f64)]) -> Self {
        let down = |w: &[(&str, f64)]| w[0].1 - w[1].1 > ROUNDING * w[0].1.abs();
        let holds = values.len() > 1 && values.windows(2).all(down);
        Self::new(about, values, "falls from each to the next".to_owned(), holds)
    }

    /// No value is larger than `limit`.
    pub fn at_most(about: ClaimSubject<'_>, values: &[(&str, f64)], limit: f64) -> Self {
        let holds = values.iter().all(|(_, value)| *value <= limit);
        let wanted = format!("at most {}", quantity(limit, about.unit));
        let claim = Self::new(about, values, wanted, holds);
        Self { limit: Some(limit), ..claim }
    }

    /// The numbers in words, those that differ told apart: `OFB 3.47 mm, RSFB 3.40 mm`.
    pub fn found(&self) -> String {
        let values = self.values.iter().map(|v| v.value).chain(self.limit).collect::<Vec<_>>();
        let texts = told_apart(&values, self.values.first().map_or("", |v| v.unit));
        let each = self.values.iter().zip(&texts).map(|(v, text)| format!("{} {text}", v.name));
        each.collect::<Vec<_>>().join(", ")
    }
}

/// The formation is reached: every follower ends within the band of its scene and stays there.
pub(crate) fn takes_up(figure: &str, run: &Trace) -> Vec<FigureClaim> {
    let claim = "The controller drives each robot to the desired distance and bearing.";
    let band = run.metrics.settling_band;
    let values = |channel: usize| {
        let edges = run.metrics.edges.iter();
        worst(edges.map(|e| (e.follower.as_str(), e.late_peak_error[channel])).collect())
    };
    let quantity = format!("largest error from {} on", quantity(run.late_from(), "s"));
    [("distance", "m"), ("bearing", "rad")]
        .into_iter()
        .enumerate()
        .map(|(channel, (name, unit))| {
            let quantity = format!("{quantity}, {name}");
            let subject = ClaimSubject::new(figure, claim, &quantity, unit);
            FigureClaim::at_most(subject, &values(channel), band[channel])
        })
        .collect()
}

/// Values that a claim lists one by one; of more, the largest.
const LISTED: usize = 6;

fn worst(mut values: Vec<(&str, f64)>) -> Vec<(&str, f64)> {
    if values.len() > LISTED {
        values.sort_by(|a, b| b.1.total_cmp(&a.1));
        values.truncate(LISTED);
    }
    values
}

/// There is no contact.
pub(crate) fn no_contact(figure: &str, run: &Trace) -> FigureClaim {
    let claim = "The formation drives without contact.";
    let subject = ClaimSubject::new(figure, claim, "contacts", "");
    FigureClaim::at_most(subject, &[("contacts", run.metrics.contacts as f64)], 0.0)
}

/// Runs of one scene with their short names, in the order of a comparison.
pub type Compared<'a> = [(&'a str, &'a Trace)];

fn each<'a>(runs: &Compared<'a>, value: impl Fn(&Trace) -> Option<f64>) -> Vec<(&'a str, f64)> {
    runs.iter().map(|(name, run)| (*name, value(run).unwrap_or(f64::NAN))).collect()
}

/// The less a law knows, the more its commands cost: the laws from the one that knows most, the first and the last
/// compared.
pub fn knowing_less_costs(figure: &str, runs: &Compared<'_>, edge: usize) -> Vec<FigureClaim> {
    let claim = "Without knowing its leader's motion, the follower spends more on control (output feedback against full \
                 state).";
    let ends: Vec<_> =
        runs.first().into_iter().chain(runs.last().filter(|_| runs.len() > 1)).copied().collect();
    let applied = |channel: usize| each(&ends, |run| Some(run.efforts.get(edge)?.applied[channel]));
    vec![
        FigureClaim::rises(ClaimSubject::new(figure, claim, "∫|dv/dt| dt", "m/s"), &applied(0)),
        FigureClaim::rises(ClaimSubject::new(figure, claim, "∫|ω| dt", "rad in all"), &applied(1)),
    ]
}

/// The less a law knows, the larger the error that stays; and that of output feedback is small all the same.
pub fn knowing_less_errs(figure: &str, runs: &Compared<'_>, edge: usize) -> Vec<FigureClaim> {
    let claim = "The less a law knows, the larger the error that stays.";
    let settled = each(runs, |run| run.settled(edge));
    let mut claims = vec![FigureClaim::rises(ClaimSubject::new(figure, claim, "settled ‖e‖", ""), &settled)];
    if let Some(last) = settled.last() {
        let claim = "The behaviour under output feedback is quite satisfactory.";
        let band = runs.last().map_or(0.0, |(_, run)| {
            let [distance, bearing] = run.metrics.settling_band;
            math::hypot(distance, bearing)
        });
        let subject = ClaimSubject::new(figure, claim, "settled ‖e‖", "");
        claims.push(FigureClaim::at_most(subject, &[*last], band));
    }
    claims
}

/// As ε falls, commands grow while the observer has not settled. `runs` go from the largest ε to the smallest.
pub fn faster_observers_cost(figure: &str, runs: &Compared<'_>, edge: usize) -> Vec<FigureClaim> {
    let claim = "As ε decreases, the control effort of the transient increases.";
    let of =
        |value: &dyn Fn(&crate::CommandEffort) -> f64| each(runs, |run| run.efforts.get(edge).map(value));
    let until = runs.first().and_then(|(_, run)| run.efforts.get(edge)).map_or(0.0, |e| e.transient);
    let over = |what: &str| format!("{what}, first {}", quantity(until, "s"));
    let about = |quantity, unit| ClaimSubject::new(figure, claim, quantity, unit);
    vec![
        FigureClaim::rises(about(&over("peak |dv/dt| asked for"), "m/s²"), &of(&|e| e.peak_asked[0])),
        FigureClaim::rises(about(&over("∫|dv/dt asked for| dt"), "m/s"), &of(&|e| e.transient_asked[0])),
        FigureClaim::rises(about(&over("∫|ω| dt"), "rad in all"), &of(&|e| e.transient_applied[1])),
    ]
}

/// As ε falls, errors fall: those that stay, and those of the whole run. `runs` go from the largest ε to the smallest.
pub fn faster_observers_err_less(figure: &str, runs: &Compared<'_>, edge: usize) -> Vec<FigureClaim> {
    let claim = "As ε decreases, tracking errors decrease.";
    let about = |quantity, unit| ClaimSubject::new(figure, claim, quantity, unit);
    let (settled, whole) = (each(runs, |run| run.settled(edge)), each(runs, |run| run.over_the_run(edge)));
    vec![
        FigureClaim::falls(about("settled ‖e‖", ""), &settled),
        FigureClaim::falls(about("(∫‖e‖² dt)^½ over the run", "s^½"), &whole),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ABOUT: ClaimSubject<'_> = ClaimSubject { figure: "7", claim: "it falls", quantity: "x", unit: "m" };

    #[test]
    fn what_falls_falls_and_what_rises_does_not() {
        let falling = [("a", 2.0), ("b", 1.0), ("c", 0.5)];
        assert!(FigureClaim::falls(ABOUT, &falling).holds);
        assert!(!FigureClaim::rises(ABOUT, &falling).holds);
        let swapped = [("b", 1.0), ("a", 2.0), ("c", 0.5)];
        assert!(!FigureClaim::falls(ABOUT, &swapped).holds);
        let level = [("a", 1.0), ("b", 1.0 + 1e-13)];
        assert!(!FigureClaim::falls(ABOUT, &level).holds && !FigureClaim::rises(ABOUT, &level).holds);
    }

    #[test]
    fn what_was_not_measured_is_not_so() {
        assert!(!FigureClaim::at_most(ABOUT, &[("a", f64::NAN)], 1.0).holds);
        assert!(!FigureClaim::at_most(ABOUT, &[], 1.0).holds);
        assert!(!FigureClaim::falls(ABOUT, &[("a", 1.0)]).holds);
        assert!(FigureClaim::at_most(ABOUT, &[("a", 1.0)], 1.0).holds);
    }
}
