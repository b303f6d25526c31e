//! A scene with the run built from it: checking a change builds the run, which is then passed on.

use scene::Scene;
use simulation::{BuildError, Setup};
use std::cell::Cell;
use std::sync::Arc;

thread_local! {
    static BUILDS: Cell<u64> = const { Cell::new(0) };
}

/// A scene and its built run.
#[derive(Debug)]
pub struct CheckedScene {
    scene: Arc<Scene>,
    setup: Setup,
    /// The scene that it was compared with, and the overrides that lead from that to this one.
    before: Option<Arc<Scene>>,
    set: Vec<String>,
}

impl CheckedScene {
    /// Builds the run of a scene, for another to change to: see [`simulation::build_change`].
    ///
    /// # Errors
    /// [`BuildError`] for a scene that cannot run.
    pub fn new(scene: Arc<Scene>) -> Result<Self, BuildError> {
        let setup = build_change(&scene)?;
        Ok(Self { scene, setup, before: None, set: Vec::new() })
    }

    /// Keeps the overrides `set` that lead from `before` to this scene.
    pub(crate) fn compared(self, before: Arc<Scene>, set: Vec<String>) -> Self {
        Self { before: Some(before), set, ..self }
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Its built run.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The overrides that lead from `before` to this scene. Reuses an earlier comparison: while a run is paused, every
    /// change of a sample is compared with the scene of the sample before.
    ///
    /// # Errors
    /// As [`Scene::sets_to`].
    pub(crate) fn set_from(&self, before: &Arc<Scene>) -> Result<Vec<String>, Vec<String>> {
        match &self.before {
            Some(known) if Arc::ptr_eq(known, before) => Ok(self.set.clone()),
            _ => before.sets_to(&self.scene),
        }
    }
}

/// Builds the run of a scene, and counts it.
///
/// # Errors
/// [`BuildError`] for a scene that cannot run.
pub(crate) fn build(scene: &Scene) -> Result<Setup, BuildError> {
    BUILDS.set(BUILDS.get() + 1);
    simulation::build(scene)
}

/// Builds the run of a scene that another one changes to, and counts it.
///
/// # Errors
/// [`BuildError`] for a scene that cannot run.
pub(crate) fn build_change(scene: &Scene) -> Result<Setup, BuildError> {
    BUILDS.set(BUILDS.get() + 1);
    simulation::build_change(scene)
}

/// Number of runs that this thread has built.
pub fn builds() -> u64 {
    BUILDS.get()
}
