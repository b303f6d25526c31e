//! Many copies of a scene side by side, driven by actions: what the environments in `python/echelon/envs` are made of.

use crate::arguments::Size;
use crate::error::{ActionError, EchelonError, RunError, busy, not_pickled, of_scene};
use crate::numbers::{cube, pixels};
use crate::picture_cache::PictureCache;
use crate::pictures::{Viewer, looks, of_footage, warn};
use crate::scene::PyScene;
use crate::watch::detached;
use footage::{PictureOptions, RenderSetup};
use laws::INPUTS;
use metrics::Digest;
use numpy::{PyArray1, PyArray3, PyReadonlyArray1, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use rendering::{PictureSpec, Trail};
use scene::Scene;
use simulation::{Simulation, build};
use std::sync::{Mutex, MutexGuard, TryLockError};
use studies::copies::{
    ACTION, Agent, Copies, CopyConfig, CopyError, CopyFault, CopySink, CopyStatus, Episode,
    ObservationColumn, Outcome, SIGNALS, StartScatter,
};
use vocabulary::{Command, FleetInfo, StepRecord};

/// Many copies of a scene, whose followers are driven by actions. `echelon.envs` has environments for learning on top of it.
#[pyclass(name = "Copies", module = "echelon._echelon", frozen)]
pub(crate) struct PyCopies {
    scene: Scene,
    count: usize,
    agents: usize,
    columns: usize,
    /// Whether errors say which copy they are of.
    numbered: bool,
    adapter: String,
    copies: Mutex<Copies<CopyMemory>>,
    drawing: Mutex<PictureCache>,
}

/// What is kept of an episode. In a box: it moves with its copy.
struct CopyMemory {
    digest: Box<Digest>,
    drawn: Option<Box<DrawnPast>>,
}

/// What pictures need.
struct DrawnPast {
    fleet: FleetInfo,
    trail: Trail,
}

impl CopySink for CopyMemory {
    fn take(&mut self, record: &StepRecord) {
        self.digest.push(record);
        if let Some(drawn) = &mut self.drawn {
            drawn.trail.push(record);
        }
    }
}

/// Numbers of copies as arrays, and how each goes on.
type Arrays<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray3<f64>>, Bound<'py, PyArray1<u8>>);

/// Rows for what copies come to.
struct Rows {
    observations: Vec<f64>,
    signals: Vec<f64>,
    progress: Vec<CopyStatus>,
}

fn wrong(text: &str) -> PyErr {
    PyValueError::new_err(text.to_owned())
}

/// The robots of these names.
fn robots_called(scene: &Scene, names: &[String]) -> PyResult<Vec<usize>> {
    let known = || scene.robots.iter().map(|robot| &*robot.name).collect::<Vec<_>>().join(", ");
    let unknown = |name: &str| wrong(&format!("there is no robot called `{name}`: there is {}", known()));
    names.iter().map(|name| scene.index_of(name).ok_or_else(|| unknown(name))).collect()
}

/// The followers of these names, with what an action of 1 is for each.
fn agents_called(scene: &Scene, names: &[String], scale: &[[f64; 2]]) -> PyResult<Vec<Agent>> {
    let robots = robots_called(scene, names)?;
    let agent = |((robot, name), [acceleration, turn_rate]): ((usize, &String), &[f64; 2])| {
        let edge = scene.edges().position(|(follower, ..)| follower == name);
        let edge = edge.ok_or_else(|| wrong(&format!("`{name}` follows nobody: agents are followers")))?;
        Ok(Agent { robot, edge, scale: Command { acceleration: *acceleration, turn_rate: *turn_rate } })
    };
    robots.into_iter().zip(names).zip(scale).map(agent).collect()
}

/// The column of that name, where `scale` becomes 1 and nothing is beyond `limit`.
fn column(name: &str, scale: f64, limit: f64) -> PyResult<ObservationColumn> {
    if !(scale > 0.0 && limit > 0.0) {
        return Err(wrong(&format!("the scale and the bound of `{name}` are positive numbers")));
    }
    let column: ObservationColumn = name.parse().map_err(|text: String| wrong(&text))?;
    Ok(column.scaled(scale, limit))
}

impl PyCopies {
    /// The copies, unless another thread has them.
    fn copies(&self) -> PyResult<MutexGuard<'_, Copies<CopyMemory>>> {
        match self.copies.try_lock() {
            Ok(copies) => Ok(copies),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(busy()),
        }
    }

    /// Why copies did not go on.
    fn failed(&self, error: &CopyError) -> PyErr {
        let text = if self.numbered { error.to_string() } else { error.fault.to_string() };
        match &error.fault {
            CopyFault::NotFinite { .. } => ActionError::new_err(text),
            CopyFault::NotRunning(_) => EchelonError::new_err(text),
            CopyFault::Broken(studies::Error::Usage(_) | studies::Error::Build(_)) => of_scene(text),
            CopyFault::Broken(_) => RunError::new_err(text),
        }
    }

    /// What draws pictures with these options, set up; `work` draws.
    fn drawing<T: Send>(
        &self,
        py: Python<'_>,
        fleet: &FleetInfo,
        options: PictureOptions,
        work: impl FnOnce(&mut RenderSetup) -> Result<T, footage::Error> + Send,
    ) -> PyResult<T> {
        let mut drawing = self.drawing.try_lock().map_err(|_| busy())?;
        let drawing = &mut *drawing;
        let notes = Mutex::default();
        let done = detached(py, None, 1, |watch| {
            let viewer = Viewer::new(watch, &notes);
            work(drawing.setup(options, &self.scene, fleet, &self.adapter, &viewer)?)
        })?;
        warn(py, notes)?;
        done.map_err(|error| of_footage(&error))
    }

    fn rows(&self) -> Rows {
        let agents = self.count * self.agents;
        Rows {
            observations: vec![0.0; agents * self.columns],
            signals: vec![0.0; agents * SIGNALS.len()],
            progress: vec![CopyStatus::Blank; self.count],
        }
    }

    fn arrays<'py>(&self, py: Python<'py>, rows: Rows) -> PyResult<Arrays<'py>> {
        let progress = rows.progress.iter().map(|progress| *progress as u8).collect();
        Ok((
            cube(py, rows.observations, [self.count, self.agents, self.columns])?,
            cube(py, rows.signals, [self.count, self.agents, SIGNALS.len()])?,
            PyArray1::from_vec(py, progress),
        ))
    }

    /// Does `work` without the interpreter.
    fn with_rows<'py>(
        &self,
        py: Python<'py>,
        work: impl FnOnce(&mut Copies<CopyMemory>, Outcome<'_>) -> Result<(), CopyError> + Send,
    ) -> PyResult<Arrays<'py>> {
        let mut guard = self.copies()?;
        let copies = &mut *guard;
        let done = py.detach(|| {
            let mut rows = self.rows();
            let Rows { observations, signals, progress } = &mut rows;
            work(copies, Outcome { observations, signals, progress })?;
            Ok(rows)
        });
        drop(guard);
        self.arrays(py, done.map_err(|error| self.failed(&error))?)
    }
}

#[pymethods]
#[expect(clippy::needless_pass_by_value, reason = "pyo3 hands over values")]
impl PyCopies {
    /// Makes copies none of which has an episode yet.
    ///
    /// Parameters
    /// ----------
    /// scene : Scene
    ///     What is copied.
    /// count : int
    ///     Number of copies.
    /// agents : list of str
    ///     Followers that are driven by actions; the others keep their laws.
    /// columns : list of (str, float, float)
    ///     What each agent observes: a name of `INPUTS`, ``error.distance``, ``error.bearing``, ``error.distance_rate`` or
    ///     ``error.bearing_rate``, or ``sin(…)`` or ``cos(…)`` of one; what becomes 1; and the bound on what comes out.
    /// scale : list of (float, float)
    ///     Per agent, what an action of 1 is: acceleration, m/s², and turn rate, rad/s.
    /// residual : bool, optional
    ///     Adds actions to what the scene's laws ask for.
    /// samples : int, optional
    ///     Control samples for which an action holds.
    /// scattered : list of str, optional
    ///     Robots that start elsewhere in every episode.
    /// scatter : (float, float), optional
    ///     Within how many m and rad.
    /// drawn : bool, optional
    ///     Keeps what pictures show of the past.
    /// threads : int, optional
    ///     Threads that share the work; one per processor by default.
    /// adapter : str, optional
    ///     Graphics adapter for `render`.
    /// numbered : bool, optional
    ///     Whether errors say which copy they are of.
    #[new]
    #[pyo3(signature = (
        scene, count, *, agents, columns, scale, residual=false, samples=1, scattered=vec![], scatter=[0.0, 0.0], drawn=false,
        threads=None, adapter="auto", numbered=true
    ))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn __new__(
        scene: &PyScene,
        count: usize,
        agents: Vec<String>,
        columns: Vec<(String, f64, f64)>,
        scale: Vec<[f64; 2]>,
        residual: bool,
        samples: u64,
        scattered: Vec<String>,
        scatter: [f64; 2],
        drawn: bool,
        threads: Option<usize>,
        adapter: &str,
        numbered: bool,
    ) -> PyResult<Self> {
        let scene = scene.scene().clone();
        if count == 0 || samples == 0 || agents.is_empty() || scale.len() != agents.len() {
            return Err(wrong(
                "copies need one copy, agent and sample at least, and a scale for every agent",
            ));
        }
        let [position, heading] = scatter;
        let one = |(name, scale, limit): &(String, f64, f64)| column(name, *scale, *limit);
        let config = CopyConfig {
            agents: agents_called(&scene, &agents, &scale)?,
            columns: columns.iter().map(one).collect::<PyResult<_>>()?,
            residual,
            samples,
            scatter: StartScatter { robots: robots_called(&scene, &scattered)?, position, heading },
            caption: Some(if residual { "law and actions" } else { "actions" }.to_owned()),
        };
        let pool = threads.map(|threads| ThreadPoolBuilder::new().num_threads(threads).build());
        let pool = pool.transpose().map_err(|error| wrong(&error.to_string()))?;
        let sink = move |fleet: &FleetInfo| CopyMemory {
            digest: Box::default(),
            drawn: drawn.then(|| Box::new(DrawnPast { fleet: fleet.clone(), trail: Trail::new(fleet) })),
        };
        Ok(Self {
            count,
            agents: agents.len(),
            columns: columns.len(),
            numbered,
            adapter: adapter.to_owned(),
            copies: Mutex::new(Copies::new(scene.clone(), config, count, pool, sink)),
            scene,
            drawing: Mutex::default(),
        })
    }

    /// Begins an episode in those copies that have a seed.
    ///
    /// Parameters
    /// ----------
    /// seeds : list of int or None
    ///     Per copy.
    /// numbers : list of int
    ///     Per copy: the number of the episode since the copy got its seed, from 0. Starts and noise depend on the two alone.
    fn reset(&self, py: Python<'_>, seeds: Vec<Option<u64>>, numbers: Vec<u64>) -> PyResult<()> {
        if seeds.len() != self.count || numbers.len() != self.count {
            return Err(PyValueError::new_err(format!(
                "there are {} copies: give a seed and a number for each",
                self.count
            )));
        }
        let episode = |(seed, number): (Option<u64>, u64)| seed.map(|seed| Episode { seed, number });
        let episodes: Vec<_> = seeds.into_iter().zip(numbers).map(episode).collect();
        let mut guard = self.copies()?;
        let copies = &mut *guard;
        py.detach(|| copies.reset(&episodes)).map_err(|error| self.failed(&error))
    }

    /// Drives all copies on by one action, but for those that are idle.
    ///
    /// Parameters
    /// ----------
    /// actions : ndarray of float64
    ///     Copies × agents × 2: acceleration and turn rate, each −1 to 1 and cut there.
    /// idle : ndarray of bool
    ///     Per copy.
    ///
    /// Returns
    /// -------
    /// observations : ndarray of float64
    ///     Copies × agents × columns.
    /// signals : ndarray of float64
    ///     Copies × agents × `SIGNALS`: the truth.
    /// progress : ndarray of uint8
    ///     Per copy: 1 goes on, 2 has come to its last sample, 3 has stopped at a contact.
    ///
    /// Raises
    /// ------
    /// ActionError
    ///     Where an action is no finite number; it names the agent.
    fn step<'py>(
        &self,
        py: Python<'py>,
        actions: PyReadonlyArray3<'py, f64>,
        idle: PyReadonlyArray1<'py, bool>,
    ) -> PyResult<Arrays<'py>> {
        let wanted = [self.count, self.agents, ACTION];
        if actions.shape() != wanted || idle.shape() != [self.count] {
            return Err(ActionError::new_err(format!(
                "actions have the shape {:?}, and not {wanted:?}: copies, agents, 2",
                actions.shape()
            )));
        }
        let contiguous = |_| PyValueError::new_err("actions are arrays without gaps");
        let (actions, idle) = (actions.as_slice().map_err(contiguous)?, idle.as_slice().map_err(contiguous)?);
        self.with_rows(py, |copies, outcome| copies.step(actions, idle, outcome))
    }

    /// What all agents observe as they stand; returns what `step` does.
    fn observe<'py>(&self, py: Python<'py>) -> PyResult<Arrays<'py>> {
        self.with_rows(py, Copies::observe)
    }

    /// What the laws of all agents are told as they stand.
    ///
    /// Returns
    /// -------
    /// ndarray of float64
    ///     `INPUTS` × copies × agents.
    fn told<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let told = self.copies()?.told().map_err(|error| self.failed(&error))?;
        cube(py, told, [INPUTS.len(), self.count, self.agents])
    }

    /// Sets up what `render` draws with, so that an adapter, a view or a size that cannot be is told before any episode.
    ///
    /// Parameters
    /// ----------
    /// view, size
    ///     As for `Simulation.render`.
    #[pyo3(signature = (view=None, size=None))]
    fn prepare(&self, py: Python<'_>, view: Option<String>, size: Option<Size>) -> PyResult<()> {
        let scene = &self.scene;
        let setup = py.detach(|| build(scene)).map_err(of_scene)?;
        let simulation = Simulation::new(setup);
        self.drawing(py, simulation.fleet(), looks(view, size, None, false, None), |_| Ok(()))
    }

    /// A picture of a copy as it stands.
    ///
    /// Parameters
    /// ----------
    /// copy : int
    ///     Its number.
    /// view, size
    ///     As for `Simulation.render`.
    ///
    /// Returns
    /// -------
    /// ndarray of uint8
    ///     Height × width × 3: red, green, blue.
    #[pyo3(signature = (copy, view=None, size=None))]
    fn render<'py>(
        &self,
        py: Python<'py>,
        copy: usize,
        view: Option<String>,
        size: Option<Size>,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let guard = self.copies()?;
        let copies = &*guard;
        let drawn = copies.copy(copy).and_then(|(_, kept)| kept.drawn.as_ref());
        let (Some(drawn), Some(record)) = (drawn, copies.outlook(copy)) else {
            let text =
                format!("copy {copy} has no picture: make the copies with drawn=True, and reset them first");
            return Err(EchelonError::new_err(text));
        };
        let mut trail = drawn.trail.clone();
        let fleet = drawn.fleet.clone();
        drop(guard);
        trail.push(&record);
        let picture = self.drawing(py, &fleet, looks(view, size, None, false, None), |setup| {
            let spec = PictureSpec::new(&trail, &record, &setup.layout, &setup.style);
            setup.renderer.draw(spec).map_err(footage::Error::from)
        })?;
        pixels(py, &picture)
    }

    #[expect(clippy::unused_self, reason = "pickle asks an object")]
    fn __reduce__(&self) -> PyResult<()> {
        Err(not_pickled("an environment", "make the environment in the process that uses it"))
    }

    /// Of the trajectory of every copy, as far as its agents have decided; an empty text before its first episode.
    #[getter]
    fn digests(&self) -> PyResult<Vec<String>> {
        let copies = self.copies()?;
        let digest = |copy| copies.copy(copy).map_or_else(String::new, |(_, kept)| kept.digest.text());
        Ok((0..self.count).map(digest).collect())
    }
}
