//! Study files: which runs of a scene a study has.
//!
//! A study varies keys of a scene, as overrides do: each has [`Values`], and there is a run for every combination of them, which is
//! called a cell. Numbers with a distribution are drawn so many times in each cell, and every run is repeated with so many
//! seeds.

mod faults;
mod read;
mod values;

pub use faults::StudyFault;
pub use values::{Distribution, ValueScale, Values, ValuesError, WrittenNumber, value_text};

use crate::{Diagnostics, Override};
use std::path::Path;
use vocabulary::words;

words! {
    /// How numbers are drawn that have a distribution.
    pub enum Sampling = Independent {
        /// Each by itself.
        Independent = "independent",
        /// So that each of as many equal shares of every distribution has one number.
        LatinHypercube = "latin-hypercube",
        /// Evenly in all distributions at once: a Sobol sequence with Owen's scrambling.
        Sobol = "sobol",
    }
}

/// A key of a scene that a study varies.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyParameter {
    /// Path of the key, as in an override: `law.k`.
    pub key: String,
    /// What it becomes.
    pub values: Values,
}

/// How far followers start from where their scene puts them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FollowerScatter {
    /// Radius of the disc in which a follower starts, uniformly distributed, m.
    pub position: f64,
    /// Largest turn of its heading to either side, uniformly distributed, rad.
    pub heading: f64,
}

/// The runs of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// What it is about.
    pub title: String,
    /// The file of the scene, or the name of one that ships.
    pub scene: String,
    /// Seed of everything that differs from run to run.
    pub seed: u64,
    /// Runs of every combination, each with a seed of its own.
    pub seeds: u64,
    /// How often numbers with a distribution are drawn in every cell.
    pub samples: u64,
    /// How they are drawn.
    pub sampling: Sampling,
    /// Overrides of all runs.
    pub set: Vec<Override>,
    /// What differs between runs, in the order of the file.
    pub parameters: Vec<StudyParameter>,
    /// Where followers start.
    pub scatter: FollowerScatter,
    /// How long a run may take, s of wall time.
    pub limit: Option<f64>,
}

/// Most runs of a study.
pub const MOST_RUNS: u64 = 1_000_000_000;

impl Study {
    /// The study of one run of a scene, as it is.
    pub fn of_scene(scene: &str, title: &str) -> Self {
        Self {
            title: title.to_owned(),
            scene: scene.to_owned(),
            seed: 1,
            seeds: 1,
            samples: 1,
            sampling: Sampling::default(),
            set: vec![],
            parameters: vec![],
            scatter: FollowerScatter::default(),
            limit: None,
        }
    }

    /// Reads the study at `path`. A table of values is looked for beside it.
    ///
    /// # Errors
    /// Everything that is wrong with the file.
    pub fn load(path: &Path) -> Result<Self, Diagnostics> {
        let text = crate::files::read_text(path).map_err(|fault| Diagnostics::of_file(path, &fault))?;
        read::parse(&text, path)
    }

    /// Reads the text of a study; `path` names it in messages.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn parse(text: &str, path: &Path) -> Result<Self, Diagnostics> {
        read::parse(text, path)
    }

    /// Faults of the study at `path` where it has the keys they name; `None` where it has none of them.
    pub fn located(path: &Path, faults: &[StudyFault]) -> Option<Diagnostics> {
        read::located(&crate::files::read_text(path).ok()?, path, faults)
    }

    /// Whether a file is meant to be a study, and not a scene: it names a scene.
    pub fn is_meant(path: &Path) -> bool {
        let text = crate::files::read_text(path).unwrap_or_default();
        text.parse::<toml::Table>().is_ok_and(|keys| keys.contains_key("scene"))
    }

    /// The study as a file has it, which is read again as an equal one. What stood in a table beside the file stands in it.
    pub fn to_toml(&self) -> String {
        read::written(self)
    }

    /// Combinations of values, without what is drawn.
    pub fn cells(&self) -> u64 {
        let zipped = self.parameters.iter().find_map(|parameter| match &parameter.values {
            Values::Zipped(values) => Some(values.len() as u64),
            _ => None,
        });
        let grids = self.parameters.iter().filter_map(|parameter| match &parameter.values {
            Values::Grid { values, .. } => Some(values.len() as u64),
            _ => None,
        });
        grids.chain(zipped).fold(1, u64::saturating_mul)
    }

    /// Its runs.
    pub fn runs(&self) -> u64 {
        self.cells().saturating_mul(self.samples).saturating_mul(self.seeds)
    }
}
