//! A study with the scene it is of: what it takes to make any of its runs.

use crate::design::{Design, RunPoint};
use crate::error::Error;
use crate::experiment_run::ExperimentRun;
use crate::row::RunRow;
use scene::{Diagnostics, Loaded, Override, Role, Scene, Study, StudyFault, Values, value_text};
use std::path::{Path, PathBuf};
use studies::copies::{Episode, StartScatter};
use studies::{PROGRAM, SceneRun};
use xxhash_rust::xxh3::Xxh3;

/// A study with the scene it is of.
#[derive(Debug, Clone)]
pub struct Experiment {
    design: Design,
    /// Text of the scene.
    text: String,
    /// Where it stands; what it names is looked for beside it.
    path: PathBuf,
    fingerprint: String,
}

/// Says whether a run goes on.
pub type GoOn<'a> = &'a dyn Fn() -> bool;

impl Experiment {
    /// Reads the scene of `study`.
    ///
    /// # Errors
    /// [`Error::Study`] for what is wrong with the study itself, [`Error::Scene`] for what is wrong with the scene as it is, or
    /// with the overrides of all runs.
    pub fn new(study: Study) -> Result<Self, Error> {
        let faults = study.faults();
        if !faults.is_empty() {
            return Err(Error::Study(faults));
        }
        let path = PathBuf::from(&study.scene);
        let loaded = Scene::load(&path, &study.set).map_err(Error::Scene)?;
        Ok(Self::of_loaded(study, loaded, path))
    }

    /// As [`Experiment::new`], of the text of a scene; `path` names it in messages, and files are looked for beside it.
    ///
    /// # Errors
    /// As [`Experiment::new`].
    pub fn of_text(study: Study, text: &str, path: PathBuf) -> Result<Self, Error> {
        let faults = study.faults();
        if !faults.is_empty() {
            return Err(Error::Study(faults));
        }
        let loaded = Scene::parse(text, &path, &study.set).map_err(Error::Scene)?;
        Ok(Self::of_loaded(study, loaded, path))
    }

    fn of_loaded(study: Study, loaded: Loaded, path: PathBuf) -> Self {
        let Loaded { text, files, .. } = loaded;
        let mut hash = Xxh3::new();
        // Neither its title nor where the scene lies makes a study another.
        let same = Study { title: String::new(), scene: String::new(), ..study.clone() };
        for part in [PROGRAM, &same.to_toml(), &text] {
            hash.update(part.as_bytes());
            hash.update(&[0]);
        }
        for file in files.iter().skip(1) {
            hash.update(&std::fs::read(file).unwrap_or_default());
            hash.update(&[0]);
        }
        let fingerprint = format!("{:032x}", hash.digest128());
        Self { design: Design::new(study), text, path, fingerprint }
    }

    /// Where the scene stands.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Which run has which values.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// The study.
    pub fn study(&self) -> &Study {
        self.design.study()
    }

    /// Text of the scene, without overrides.
    pub fn scene_text(&self) -> &str {
        &self.text
    }

    /// 32 hexadecimal digits that are others where the study, the scene, a file it names, or the program is another.
    pub fn fingerprint(&self) -> &str {
        &self.fingerprint
    }

    /// Tries the ends of everything that varies, one key after the other: faults name the key and stand where a study's own do.
    pub fn faults(&self) -> Vec<StudyFault> {
        let (study, first) = (self.study(), self.design.point(0));
        let mut faults = vec![];
        for (index, parameter) in study.parameters.iter().enumerate() {
            let ends: Vec<String> = match &parameter.values {
                Values::Grid { values, .. } | Values::Zipped(values) if values.len() > MOST_TRIED => {
                    values.iter().take(1).chain(values.last()).cloned().collect()
                }
                Values::Grid { values, .. } | Values::Zipped(values) => values.clone(),
                Values::Drawn { distribution: scene::Distribution::Normal { mean, .. }, degrees } => {
                    vec![value_text(*mean, *degrees)]
                }
                Values::Drawn {
                    distribution: scene::Distribution::Uniform(ends) | scene::Distribution::LogUniform(ends),
                    degrees,
                } => ends.map(|end| value_text(end, *degrees)).to_vec(),
                Values::Same(_) => vec![],
            };
            for value in ends {
                let mut point = first.clone();
                point.values[index].clone_from(&value);
                let Err(refusal) = self.scene(&point) else { continue };
                let text = format!("`{}` cannot be {value}: {refusal}", parameter.key);
                faults.push(StudyFault { key: Some(parameter.key.clone()), text });
                break;
            }
        }
        faults
    }

    /// The overrides of a run: what `echelon run` needs to make it again.
    ///
    /// # Errors
    /// What is wrong with the scene then.
    pub fn overrides(&self, point: &RunPoint) -> Result<Vec<Override>, String> {
        let mut overrides = self.design.overrides(point)?;
        let scatter = self.study().scatter;
        if scatter.position > 0.0 || scatter.heading > 0.0 {
            let mut scene = self.parsed(&overrides)?;
            let follows = |index: &usize| matches!(scene.robots[*index].role, Role::Follow(_));
            let robots: Vec<usize> = (0..scene.robots.len()).filter(follows).collect();
            let starts =
                StartScatter { robots: robots.clone(), position: scatter.position, heading: scatter.heading };
            let episode = Episode { seed: point.seed, number: 0 };
            starts.scatter(&mut scene, episode).map_err(|error| error.to_string())?;
            for robot in robots.into_iter().map(|index| &scene.robots[index]) {
                let [x, y, heading] =
                    [robot.pose.x, robot.pose.y, robot.pose.heading].map(|v| value_text(v, false));
                let text = format!("robots.{}.pose=[{x}, {y}, {heading}]", robot.name);
                overrides.push(text.parse().map_err(|error: scene::OverrideError| error.to_string())?);
            }
        }
        Ok(overrides)
    }

    /// The scene of a run.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn scene(&self, point: &RunPoint) -> Result<Scene, String> {
        self.parsed(&self.overrides(point)?)
    }

    fn parsed(&self, overrides: &[Override]) -> Result<Scene, String> {
        let loaded = Scene::parse(&self.text, &self.path, overrides);
        loaded.map(|loaded| loaded.scene).map_err(|errors| first(&errors))
    }

    /// Says why no run of it can be made, as far as that can be told before the first: what is wrong with the ends of what
    /// varies, and with the scene of the first run.
    ///
    /// # Errors
    /// [`Error::Study`] for values that the scene does not take, [`Error::Usage`] for a scene that cannot run, or with cameras.
    pub fn check(&self) -> Result<(), Error> {
        let faults = self.faults();
        if !faults.is_empty() {
            return Err(Error::Study(faults));
        }
        let told = |text: String| Error::Usage(format!("{}: {text}", self.path.display()));
        let scene = self.scene(&self.design.point(0)).map_err(told)?;
        let run = SceneRun::new(scene).map_err(|error| told(error.to_string()))?;
        if run.simulation.needs_cameras() {
            return Err(told(CAMERAS.to_owned()));
        }
        Ok(())
    }

    /// Begins run `index`, which is then made piece by piece.
    pub fn begin(&self, index: u64) -> ExperimentRun {
        ExperimentRun::new(self, self.design.point(index))
    }

    /// Makes run `index`; `None` where `go_on` said no. `clock` tells seconds since any moment.
    pub fn run(&self, index: u64, clock: &dyn Fn() -> f64, go_on: GoOn<'_>) -> Option<RunRow> {
        let began = clock();
        let limit = self.study().limit.unwrap_or(f64::INFINITY);
        let late = || clock() - began > limit;
        let mut run = self.begin(index);
        run.advance(&|| go_on() && !late());
        let mut row = run.row(late().then_some(limit))?;
        row.wall_time = clock() - began;
        Some(row)
    }
}

/// Most values of a key that are all tried before a study begins.
const MOST_TRIED: usize = 1000;
/// Why a scene with cameras is no scene of a study.
pub const CAMERAS: &str = "its robots take pictures, which takes too long for many runs: calculated tags err alike (set \
    sensing.kind=geometric and sensing.pixel_noise=0.05)";

/// The first thing that is wrong, without the place in a text that nobody wrote.
fn first(errors: &Diagnostics) -> String {
    let more = errors.all().len() - 1;
    let first = errors.all().first().map_or_else(String::new, |first| first.message.clone());
    if more == 0 { first } else { format!("{first} (and {more} more)") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::RowStatus;
    use std::cell::Cell;

    fn experiment(limit: Option<f64>) -> Experiment {
        let set = vec!["time.duration=1".parse().expect("an override")];
        Experiment::new(Study { set, limit, ..Study::of_scene("line-three", "t") }).expect("an experiment")
    }

    #[test]
    fn a_fault_of_the_program_is_a_row() {
        let asked = Cell::new(0);
        let clock = || {
            asked.set(asked.get() + 1);
            assert!(asked.get() != 2, "broken on purpose");
            0.0
        };
        let row = experiment(None).run(0, &clock, &|| true).expect("a row");
        assert_eq!((row.status, row.met), (RowStatus::Panicked, false));
        assert!(row.reason.contains("broken on purpose") && row.digest.is_empty(), "{}", row.reason);
    }

    #[test]
    fn a_run_that_takes_too_long_is_a_row_and_one_that_is_given_up_is_none() {
        let asked = Cell::new(0.0);
        let clock = || asked.replace(asked.get() + 1.0);
        let row = experiment(Some(2.5)).run(0, &clock, &|| true).expect("a row");
        assert_eq!(row.status, RowStatus::Expired);
        assert!(row.failed_time > 0.0 && row.failed_time < 1.0 && row.wall_time > 2.5, "{row:?}");
        assert_eq!(experiment(None).run(0, &|| 0.0, &|| false), None);
        assert_eq!(experiment(None).run(0, &|| 0.0, &|| true).expect("a row").status, RowStatus::Complete);
    }

    #[test]
    fn another_scene_study_or_override_is_another_experiment() {
        let one = experiment(None);
        let of = |study: Study| Experiment::new(study).expect("an experiment").fingerprint().to_owned();
        assert_eq!(of(Study { title: "other".to_owned(), ..one.study().clone() }), one.fingerprint());
        assert_ne!(of(Study { seed: 2, ..one.study().clone() }), one.fingerprint());
        assert_ne!(of(Study { scene: "circle-three".to_owned(), ..one.study().clone() }), one.fingerprint());
    }
}
