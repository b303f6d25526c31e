//! A scene with its simulation, before the first step.

use crate::Error;
use scene::Scene;
use simulation::{BuildError, Simulation, build, gates, in_line, too_slow_leads};
use vocabulary::{CameraRenderer, FleetInfo};

/// Name and version of the program, as manifests and pictures carry them.
pub const PROGRAM: &str = concat!("echelon ", env!("CARGO_PKG_VERSION"));

/// The commit that the program is built from, where it is known.
pub const COMMIT: Option<&str> = option_env!("ECHELON_COMMIT");

/// Steps between two reports of how far a run is.
pub const STRIDE: u64 = 16;

/// Makes what draws the pictures of a fleet's cameras; the text says why it cannot.
pub type RendererFactory<'a> = &'a mut dyn FnMut(&FleetInfo) -> Result<Box<dyn CameraRenderer>, String>;

/// A scene with its simulation, before the first step.
pub struct SceneRun {
    /// What runs.
    pub scene: Scene,
    /// Its run.
    pub simulation: Simulation,
}

impl SceneRun {
    /// Builds the simulation of `scene`.
    ///
    /// # Errors
    /// [`BuildError`] where the scene cannot run.
    pub fn new(scene: Scene) -> Result<Self, BuildError> {
        let simulation = Simulation::new(build(&scene)?);
        Ok(Self { scene, simulation })
    }

    /// What deserves a look before the run: what comes too late to take effect, leads that are too slow, gates that are too
    /// narrow, followers that stand in line with both of their leaders.
    pub fn remarks(&self) -> Vec<String> {
        let (simulation, duration) = (&self.simulation, self.scene.time.duration);
        let mut remarks = self.scene.late();
        remarks.extend(self.scene.unused());
        remarks.extend(too_slow_leads(simulation, duration));
        remarks.extend(gates(simulation, duration));
        remarks.extend(in_line(simulation));
        remarks
    }

    /// Gives the cameras of the run what draws for them, if the scene has cameras that take pictures.
    ///
    /// # Errors
    /// [`Error::Camera`] where it cannot be made.
    pub fn attach_cameras(&mut self, renderer: RendererFactory<'_>) -> Result<(), Error> {
        if self.simulation.needs_cameras() {
            let made = renderer(self.simulation.fleet()).map_err(Error::Camera)?;
            self.simulation.attach_cameras(made);
        }
        Ok(())
    }

    /// Runs to the end. `take` gets the simulation after every step, with the number of steps so far, and says whether the run
    /// goes on.
    ///
    /// # Errors
    /// [`Error`] where the run breaks off with a fault.
    pub fn step_through(&mut self, mut take: impl FnMut(&Simulation, u64) -> bool) -> Result<(), Error> {
        let mut steps = 0;
        while self.simulation.next_record().is_some() {
            steps += 1;
            if !take(&self.simulation, steps) {
                return Ok(());
            }
        }
        self.simulation.fault().map_or(Ok(()), |fault| Err(fault.into()))
    }
}

/// How a run of `scene` is recorded: with a log, without CSV tables, into an empty folder; nothing draws on the roll.
#[cfg(not(target_family = "wasm"))]
pub fn run_options(scene: &Scene) -> recording::RunOptions {
    recording::RunOptions {
        csv: false,
        no_log: false,
        roll: recording::log::Roll::default(),
        force: false,
        scene: scene.to_toml(),
        program: PROGRAM.to_owned(),
        commit: COMMIT.map(str::to_owned),
        seed: scene.seed,
        period: scene.time.period,
        judging: scene.judging(),
    }
}
