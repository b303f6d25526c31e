//! What ran and how it ended.

use metrics::Status;
use serde::{Deserialize, Serialize};
use vocabulary::FleetInfo;

/// `manifest.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of this layout.
    pub format: u32,
    /// Name and version of the program.
    pub program: String,
    /// Commit it was built from, where known.
    pub commit: Option<String>,
    /// Title of the scene.
    pub title: String,
    /// Seed of the run.
    pub seed: u64,
    /// Control period, s.
    pub period: f64,
    /// Length asked for, s.
    pub duration: f64,
    /// Names of the robots.
    pub robots: Vec<String>,
    /// [leader, follower] by name.
    pub edges: Vec<[String; 2]>,
    /// How it ended.
    pub status: Status,
    /// Control samples recorded.
    pub samples: u64,
    /// Digest of the whole trajectory (XXH3, 128 bits); only a complete run's is comparable.
    pub digest: Option<String>,
}

/// The layout this program writes.
pub(crate) const FORMAT: u32 = 2;

impl Manifest {
    /// That of a run of `fleet` of which nothing else is known.
    pub(crate) fn of(fleet: &FleetInfo) -> Self {
        Self {
            format: FORMAT,
            program: "unknown".to_owned(),
            commit: None,
            title: fleet.title.clone(),
            seed: 0,
            period: 0.0,
            duration: fleet.duration,
            robots: fleet.robots.iter().map(|robot| robot.name.clone()).collect(),
            edges: fleet.edges.iter().map(|edge| fleet.pair(*edge).map(str::to_owned)).collect(),
            status: Status::Running,
            samples: 0,
            digest: None,
        }
    }

    /// What is wrong with a run folder of another layout; `None` where this program can read it.
    pub fn other_layout(&self) -> Option<String> {
        (self.format != FORMAT).then(|| {
            format!(
                "is a run of layout {}; this program reads layout {FORMAT}: run its scene.toml again, or read it with \
                 {}, which wrote it",
                self.format, self.program
            )
        })
    }
}
