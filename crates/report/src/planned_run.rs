//! Which runs a set of figures needs.

use crate::trace::Trace;
use crate::variant::{LAWS, Variant, constants_apart, laws_apart, of, short};
use crate::words::quantity;
use scene::{Diagnostics, Scene, shipped};
use vocabulary::LawKind;

/// Which scene a run belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Case {
    /// The paper's straight line.
    Line,
    /// The paper's circle.
    Circle,
    /// Seven robots.
    Seven,
    /// A scene of the user.
    Own,
}

/// A planned run.
#[derive(Debug, Clone)]
pub struct PlannedRun {
    /// Which scene it belongs to.
    pub case: Case,
    /// What differs from that scene.
    pub variant: Variant,
    /// What it is called in tables.
    pub name: String,
    /// The scene to run, changed already.
    pub scene: Scene,
    /// End of what counts as its transient, s.
    pub transient: f64,
}

/// A finished run.
#[derive(Clone)]
pub struct FinishedRun {
    /// Which scene it belongs to.
    pub case: Case,
    /// What differs from that scene.
    pub variant: Variant,
    /// What it did.
    pub trace: Trace,
}

/// The finished run of a case and a variant, if there is one.
pub fn find(runs: &[FinishedRun], case: Case, variant: Variant) -> Option<&Trace> {
    runs.iter().find(|ran| ran.case == case && ran.variant == variant).map(|ran| &ran.trace)
}

/// The paper's two observer constants, and some between them, s.
pub(crate) const CONSTANTS: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];
/// Those that the paper compares, s.
pub(crate) const COMPARED: [f64; 2] = [0.1, 0.001];

/// Observer constants after which the slowest observer of a comparison has settled: what came in has died down to a
/// thousandth (e⁻¹⁰ (1 + 10), a double pole at −1/ε).
const SETTLED: f64 = 10.0;

/// The shipped scenes of the paper's figures, by name.
const SCENES: [(Case, &str); 3] =
    [(Case::Line, "line-three"), (Case::Circle, "circle-three"), (Case::Seven, "seven-v")];

impl Case {
    /// One word for it in the names of runs.
    fn word(self) -> &'static str {
        match self {
            Self::Line => "line, ",
            Self::Circle => "circle, ",
            Self::Seven => "seven, ",
            Self::Own => "",
        }
    }
}

fn job(case: Case, scene: &Scene, variant: Variant, transient: f64) -> PlannedRun {
    let scene = variant.give(scene);
    let law = of(&scene).map_or_else(
        || "no followers".to_owned(),
        |(kind, epsilon)| match kind {
            LawKind::OutputFeedback => format!("{}, ε = {}", short(kind), plain(epsilon)),
            _ => short(kind).to_owned(),
        },
    );
    let name = if variant == Variant::default() { "as written".to_owned() } else { law };
    PlannedRun { case, variant, name: format!("{}{name}", case.word()), scene, transient }
}

/// An observer constant as it is written: `0.001 s`.
pub(crate) fn plain(epsilon: f64) -> String {
    let text = format!("{epsilon}");
    if text.len() > 7 { quantity(epsilon, "s") } else { format!("{text} s") }
}

/// The runs behind the paper's figures, from the scenes that come with the program.
///
/// # Errors
/// Never for scenes as they are shipped; what is wrong with them otherwise.
pub fn paper_runs() -> Result<Vec<PlannedRun>, Diagnostics> {
    let mut jobs = vec![];
    for (case, name) in SCENES {
        let scene = Scene::parse(shipped(name).map_or("", |shipped| shipped.text), name, &[])?.scene;
        if case == Case::Seven {
            jobs.push(job(case, &scene, Variant::epsilon(COMPARED[1]), SETTLED * COMPARED[0]));
            continue;
        }
        let laws = LAWS.into_iter().filter(|kind| *kind != LawKind::OutputFeedback).map(Variant::law);
        let constants = CONSTANTS.into_iter().map(Variant::epsilon);
        jobs.extend(laws.chain(constants).map(|variant| job(case, &scene, variant, SETTLED * COMPARED[0])));
    }
    Ok(jobs)
}

/// Factors on a scene's own ε that it is compared with.
pub(crate) const FACTORS: [f64; 3] = [10.0, 1.0, 0.1];
/// Limits of ε in scenes, s.
const EPSILON_MAX: f64 = 100.0;

/// The observer constants that a scene is compared by, from the largest, s.
pub(crate) fn constants(scene: &Scene) -> Vec<f64> {
    let Some((_, own)) = of(scene) else { return vec![] };
    let round = |epsilon: f64| format!("{epsilon:.6e}").parse().unwrap_or(epsilon);
    let mut all: Vec<f64> = FACTORS.iter().map(|f| round((f * own).min(EPSILON_MAX))).collect();
    all.dedup();
    all
}

/// The runs behind the figures of a scene: as it is written, with each of the three laws, with larger and smaller ε.
pub fn scene_runs(scene: &Scene) -> Vec<PlannedRun> {
    let slowest = constants(scene).first().map_or(0.0, |epsilon| SETTLED * epsilon);
    let transient = slowest.clamp(0.02 * scene.time.duration, 0.25 * scene.time.duration);
    let mut variants = vec![Variant::default()];
    if laws_apart(scene).is_none() {
        variants.extend(LAWS.into_iter().map(Variant::law));
    }
    if constants_apart(scene).is_none() {
        variants.extend(constants(scene).into_iter().map(Variant::epsilon));
    }
    variants.into_iter().map(|variant| job(Case::Own, scene, variant, transient)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_runs_are_two_cases_by_three_laws_and_five_constants_and_seven_robots() {
        let jobs = paper_runs().expect("shipped scenes");
        assert_eq!(jobs.len(), 2 * (2 + 5) + 1);
        assert_eq!(jobs[0].name, "line, FSFB");
        assert!(jobs.iter().any(|job| job.name == "circle, OFB, ε = 0.001 s"));
        assert!(jobs.iter().all(|job| job.transient == 1.0));
    }

    #[test]
    fn what_cannot_be_compared_is_not_run() {
        let scene = |name: &str| {
            let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
            Scene::load(path, &[]).expect("a shipped scene").scene
        };
        assert_eq!(scene_runs(&scene("line-three.toml")).len(), 1 + 3 + 3);
        assert_eq!(scene_runs(&scene("cars-circle-three.toml")).len(), 1 + 3);
        assert_eq!(scene_runs(&scene("vision-circle-three.toml")).len(), 1);
        assert_eq!(scene_runs(&scene("hundred.toml")).len(), 1);
        assert_eq!(constants(&scene("line-three.toml")), [0.01, 0.001, 0.0001]);
    }
}
