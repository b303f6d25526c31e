//! Where errors of following come from: a scene runs again and again on the same seed, from followers that know the
//! truth over corners of tags with more and more noise to pictures of cameras, with both observers; or with one
//! observer constant after the other.

mod case;
mod measure;
mod scaling;

pub use case::{BudgetCase, ObserverChoice, SensingLevel, check};
pub use measure::{EdgeErrors, MeasuredRun, measure};
pub use scaling::{Growth, geometric_mean, noise_of};

use crate::{Error, RendererFactory};
use scene::Scene;
use vocabulary::FleetInfo;

/// An error budget, as far as it has come.
#[derive(Debug, Clone)]
pub struct Budget<'a> {
    /// The scene as it is written.
    pub scene: &'a Scene,
    /// Its robots and edges.
    pub fleet: FleetInfo,
    /// Time from which errors count, s.
    pub settled_after: f64,
    /// Whether observer constants are compared instead of ways of sensing.
    pub constants: bool,
    /// What was run, in order.
    pub runs: Vec<(BudgetCase, MeasuredRun)>,
    /// Adapter that drew for the cameras, or why there are no pictures of cameras.
    pub camera: Result<String, String>,
    /// Whether all runs were made.
    pub complete: bool,
}

impl<'a> Budget<'a> {
    /// Of no runs yet; `constants` where observer constants are compared.
    pub fn new(scene: &'a Scene, fleet: FleetInfo, constants: bool) -> Self {
        Self {
            scene,
            fleet,
            settled_after: scene.judging().settled_after,
            constants,
            runs: vec![],
            camera: Err("no camera".to_owned()),
            complete: false,
        }
    }

    /// Runs all `cases`; `go_on` gets the number of cases that are done and of steps of the one under way, and says
    /// whether the work goes on.
    ///
    /// # Errors
    /// [`Error`] where the scene cannot run so, or a run breaks off with a fault.
    pub fn measure(
        &mut self,
        cases: &[BudgetCase],
        renderer: RendererFactory<'_>,
        mut go_on: impl FnMut(usize, u64) -> bool,
    ) -> Result<(), Error> {
        for (index, case) in cases.iter().enumerate() {
            let mut run = case.build(self.scene)?;
            run.attach_cameras(&mut *renderer)?;
            match measure(&mut run, self.settled_after, |step| go_on(index, step))? {
                Some(measured) => self.runs.push((*case, measured)),
                None => return Ok(()),
            }
        }
        self.complete = true;
        Ok(())
    }

    /// Names of leader and follower of an edge.
    pub fn edge(&self, index: usize) -> [&str; 2] {
        self.fleet.edges.get(index).map_or([""; 2], |edge| self.fleet.pair(*edge))
    }

    /// The run of a case, where it has come to that.
    pub fn run(&self, level: SensingLevel, observer: ObserverChoice) -> Option<&MeasuredRun> {
        self.runs.iter().find(|(c, _)| *c == BudgetCase { level, observer }).map(|(_, run)| run)
    }

    /// The noises of corners that were tried, in order, px.
    pub fn pixels(&self) -> Vec<f64> {
        sorted(self.runs.iter().filter_map(|(case, _)| case.level.pixels()))
    }

    /// [pixels, value] of an edge over all noises of corners with an observer; without what has no value.
    pub fn curve(
        &self,
        edge: usize,
        observer: ObserverChoice,
        value: impl Fn(&EdgeErrors) -> Option<f64>,
    ) -> Vec<[f64; 2]> {
        let at = |pixels: f64| {
            let run = self.run(SensingLevel::Pixels(pixels), observer)?;
            Some([pixels, value(run.edges.get(edge)?)?])
        };
        self.pixels().into_iter().filter_map(at).collect()
    }

    /// The noise of corners, px, that an edge's measurements by camera stand for: by distance, bearing, view angle, and
    /// by all.
    pub fn camera_as_pixels(&self, edge: usize) -> ([Option<f64>; 3], Option<f64>) {
        let of = |channel: usize| {
            let run = self.run(SensingLevel::Camera, ObserverChoice::HighGain)?;
            let error = run.edges.get(edge)?.measurements?[channel];
            noise_of(&self.curve(edge, ObserverChoice::HighGain, |m| Some(m.measurements?[channel])), error)
        };
        let each = [0, 1, 2].map(of);
        (each, geometric_mean(&each))
    }
}

/// The runs of a comparison of ways of sensing, in order: the truth, every noise of corners, and pictures where there
/// is a camera; with both observers.
pub fn sensing_cases(pixel_noise: &[f64], camera: bool) -> Vec<BudgetCase> {
    let mut levels: Vec<SensingLevel> =
        sorted(pixel_noise.iter().copied()).into_iter().map(SensingLevel::Pixels).collect();
    levels.extend(camera.then_some(SensingLevel::Camera));
    let with =
        |observer: ObserverChoice| levels.iter().map(move |level| BudgetCase { level: *level, observer });
    let truth = BudgetCase { level: SensingLevel::Truth, observer: ObserverChoice::HighGain };
    [truth].into_iter().chain(with(ObserverChoice::HighGain)).chain(with(ObserverChoice::Unscented)).collect()
}

/// The runs of a comparison of observer constants, s, in order, with the one that follows from the noise; by pictures
/// where there is a camera, else by corners with the noise of the scene.
pub fn epsilon_cases(epsilon: &[f64], camera: bool, scene: &Scene) -> Vec<BudgetCase> {
    let level = if camera { SensingLevel::Camera } else { SensingLevel::Pixels(case::pixel_noise(scene)) };
    let constants = sorted(epsilon.iter().copied()).into_iter().map(Some).chain([None]);
    constants.map(|constant| BudgetCase { level, observer: ObserverChoice::Constant(constant) }).collect()
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}
