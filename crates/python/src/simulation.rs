//! A simulation step by step: its state as arrays, changes on the way, copies.

use crate::arguments::{Names, Size};
use crate::error::{EndOfRunError, RunError, busy, not_pickled};
use crate::law::{again, raised};
use crate::numbers::{matrix, pixels};
use crate::picture_cache::PictureCache;
use crate::pictures::{Viewer, looks, of_footage, warn};
use crate::scene::PyScene;
use crate::values::overrides;
use crate::watch::detached;
use metrics::Digest;
use numpy::{PyArray2, PyArray3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use recording::{edge_columns, edge_numbers, robot_columns, robot_numbers};
use rendering::{PictureSpec, Trail};
use scene::Scene;
use simulation::{Simulation, build};
use std::sync::{Mutex, MutexGuard, TryLockError};
use studies::SceneRun;
use vocabulary::{EntityId, FleetInfo, StepRecord};

/// A run that is driven step by step. Everything in it is as of the last sample that was computed.
#[pyclass(name = "Simulation", module = "echelon", frozen)]
pub(crate) struct PySimulation {
    /// Does not change as the run goes.
    fleet: FleetInfo,
    period: f64,
    adapter: String,
    /// In a box: Python's objects are aligned to 16 bytes, and a digest to more.
    driven: Mutex<Box<Driven>>,
}

/// What steps change.
struct Driven {
    /// The scene, with what was applied on the way.
    scene: PyScene,
    simulation: Simulation,
    digest: Digest,
    trail: Trail,
    /// The record before the last, between which pictures are drawn.
    before: StepRecord,
    drawing: PictureCache,
    /// By how much the last sample is later than what was asked for, s.
    ahead: f64,
    /// What its law raised, where that ended it.
    raised: Option<PyErr>,
}

impl Driven {
    /// Computes the next sample; whether there was one.
    fn step(&mut self) -> bool {
        self.before.clone_from(self.simulation.record());
        let Some(record) = self.simulation.next_record() else {
            self.raised = raised().or_else(|| self.raised.take());
            return false;
        };
        self.digest.push(record);
        self.trail.push(record);
        self.ahead = 0.0;
        true
    }

    /// Why nothing more comes.
    fn end(&mut self, py: Python<'_>) -> PyErr {
        let time = self.simulation.record().snapshot.time;
        if let Some(fault) = self.simulation.fault() {
            let Some(raised) = self.raised.take() else { return RunError::new_err(fault.to_string()) };
            let sample = self.simulation.sample();
            let (now, then) = again(py, raised, sample, sample as f64 * self.simulation.period());
            self.raised = Some(then);
            return now;
        }
        let why = if self.simulation.stopped() {
            "robots touched, and the scene stops then"
        } else {
            "all its samples are computed"
        };
        EndOfRunError::new_err(format!(
            "the run has ended at {time} s: {why}; look at `done` before you step"
        ))
    }
}

impl PySimulation {
    pub(crate) fn of(py: Python<'_>, scene: PyScene, mut run: SceneRun, adapter: &str) -> PyResult<Self> {
        crate::cameras::attach(py, &mut run, adapter)?;
        let simulation = run.simulation;
        let fleet = simulation.fleet().clone();
        let mut driven = Driven {
            scene,
            digest: Digest::default(),
            trail: Trail::new(&fleet),
            before: simulation.record().clone(),
            simulation,
            drawing: PictureCache::default(),
            ahead: 0.0,
            raised: None,
        };
        let period = driven.simulation.period();
        // So that there is a state to look at.
        if !py.detach(|| driven.step()) {
            return Err(driven.end(py));
        }
        driven.before.clone_from(driven.simulation.record());
        Ok(Self { fleet, period, adapter: adapter.to_owned(), driven: Mutex::new(Box::new(driven)) })
    }

    /// What is driven, unless another thread has it.
    fn driven(&self) -> PyResult<MutexGuard<'_, Box<Driven>>> {
        match self.driven.try_lock() {
            Ok(driven) => Ok(driven),
            // A panic came out as an exception; the simulation is as that left it.
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(busy()),
        }
    }

    /// Steps until sample number `last` is computed, or the run is over.
    fn run_to(&self, py: Python<'_>, last: u64, progress: Option<Py<PyAny>>) -> PyResult<()> {
        let mut guard = self.driven()?;
        let driven: &mut Driven = &mut guard;
        if driven.simulation.is_over() {
            return Err(driven.end(py));
        }
        let from = driven.simulation.sample();
        let fault = detached(py, progress, last.saturating_sub(from) + 1, |watch| {
            while driven.simulation.sample() <= last && !driven.simulation.is_over() {
                if !driven.step() {
                    break;
                }
                if !watch.goes_on(driven.simulation.sample() - from) {
                    break;
                }
            }
            driven.simulation.fault().is_some()
        })?;
        if fault { Err(guard.end(py)) } else { Ok(()) }
    }
}

#[pymethods]
impl PySimulation {
    /// Computes the next control sample.
    ///
    /// Raises
    /// ------
    /// EndOfRunError
    ///     Where `done` is true.
    /// RunError
    ///     Where the run breaks off or has broken off; a `LawError` where the law gives no commands.
    /// BusyError
    ///     Where another thread is at work on this simulation.
    fn step(&self, py: Python<'_>) -> PyResult<()> {
        let mut guard = self.driven()?;
        let driven: &mut Driven = &mut guard;
        let over = driven.simulation.is_over();
        if over || !py.detach(|| driven.step()) {
            return Err(guard.end(py));
        }
        drop(guard);
        py.check_signals()
    }

    /// Computes all samples of the next seconds, or to the end of the run. Ctrl-C ends it at a sample, and it can go on.
    ///
    /// The last sample is the first that is not before the time asked for. Calls add up: 600 times 1/60 s are 10 s.
    ///
    /// Parameters
    /// ----------
    /// seconds : float, optional
    ///     How much further, s; to the end by default.
    /// progress : bool or callable, optional
    ///     As for `Scene.run`.
    #[pyo3(signature = (seconds=None, *, progress=None))]
    fn advance(
        &self,
        py: Python<'_>,
        seconds: Option<f64>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let progress = match progress {
            None => None,
            wish => {
                let scene = self.driven()?.scene.again();
                scene.progress(py, wish)?
            }
        };
        let (last, asked) = {
            let driven = self.driven()?;
            let (end, now) = (driven.simulation.len() - 1, driven.simulation.record().snapshot.time);
            match seconds {
                None => (end, None),
                Some(seconds) if seconds.is_finite() && seconds >= 0.0 => {
                    let until = now - driven.ahead + seconds;
                    (driven.simulation.sample_at(until).min(end), Some(until))
                }
                Some(seconds) => {
                    let text = format!(
                        "a simulation does not advance by {seconds} s: give a number of seconds, 0 or more"
                    );
                    return Err(PyValueError::new_err(text));
                }
            }
        };
        self.run_to(py, last, progress)?;
        let mut driven = self.driven()?;
        let now = driven.simulation.record().snapshot.time;
        driven.ahead = asked.map_or(0.0, |asked| (now - asked).clamp(0.0, self.period));
        Ok(())
    }

    /// Sets values from the next sample on, as if the scene had a change there; `scene` has it then.
    ///
    /// Parameters
    /// ----------
    /// values : dict
    ///     As for `Scene.set`; of set points, laws, observers, limits and safety filters only.
    ///
    /// Raises
    /// ------
    /// SceneError
    ///     For what cannot change while a run goes.
    fn apply(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let sets: Vec<String> = overrides(values)?.iter().map(ToString::to_string).collect();
        let mut guard = self.driven()?;
        let driven: &mut Driven = &mut guard;
        if driven.simulation.is_over() {
            return Err(driven.end(py));
        }
        let at = driven.simulation.sample() as f64 * self.period;
        let scene = driven.scene.changed(at, &sets)?;
        let checked = scene.scene();
        let setup = py.detach(|| build(checked)).map_err(crate::error::of_scene)?;
        driven.simulation.reschedule(&setup);
        driven.scene = scene;
        Ok(())
    }

    /// A copy that goes on by itself, with a deep copy of the memory of its law. Both come to the same future, bit for bit.
    fn fork(&self, py: Python<'_>) -> PyResult<Self> {
        let driven = self.driven()?;
        let copy = Driven {
            scene: driven.scene.again(),
            simulation: driven.simulation.save(),
            digest: driven.digest.clone(),
            trail: driven.trail.clone(),
            before: driven.before.clone(),
            drawing: PictureCache::default(),
            ahead: driven.ahead,
            raised: driven.raised.as_ref().map(|error| error.clone_ref(py)),
        };
        drop(driven);
        match raised() {
            Some(error) => Err(error),
            None => Ok(Self {
                fleet: self.fleet.clone(),
                period: self.period,
                adapter: self.adapter.clone(),
                driven: Mutex::new(Box::new(copy)),
            }),
        }
    }

    /// A picture of this moment, the same that ``echelon capture`` draws.
    ///
    /// Parameters
    /// ----------
    /// view : str, optional
    ///     As for `Scene.capture`; ``"camera:NAME"`` is what that robot sees.
    /// size, without, overlay, inset_camera
    ///     As for `Scene.capture`.
    ///
    /// Returns
    /// -------
    /// ndarray of uint8
    ///     Height × width × 3: red, green, blue.
    ///
    /// Raises
    /// ------
    /// RenderingError
    ///     Where there is no adapter to draw with.
    #[pyo3(signature = (view=None, size=None, *, without=None, overlay=false, inset_camera=None))]
    fn render<'py>(
        &self,
        py: Python<'py>,
        view: Option<String>,
        size: Option<Size>,
        without: Option<Names>,
        overlay: bool,
        inset_camera: Option<String>,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let options = looks(view, size, without, overlay, inset_camera);
        let mut guard = self.driven()?;
        let driven: &mut Driven = &mut guard;
        let notes = Mutex::default();
        let drawn = detached(py, None, 1, |watch| {
            let Driven { scene, simulation, trail, before, drawing, .. } = driven;
            let viewer = Viewer::new(watch, &notes);
            let setup = drawing.setup(options, scene.scene(), &self.fleet, &self.adapter, &viewer)?;
            // As `capture` draws the moment of a sample.
            let record = StepRecord::between(before, simulation.record(), 1.0);
            let spec = PictureSpec::new(trail, &record, &setup.layout, &setup.style);
            setup.renderer.draw(spec).map_err(footage::Error::from)
        })?;
        drop(guard);
        warn(py, notes)?;
        pixels(py, &drawn.map_err(|error| of_footage(&error))?)
    }

    /// The scene with what was applied on the way: its run comes to the same states.
    #[getter]
    fn scene(&self) -> PyResult<PyScene> {
        Ok(self.driven()?.scene.again())
    }

    /// Time of the last sample, s.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.driven()?.simulation.record().snapshot.time)
    }

    /// Number of the last sample, from 0.
    #[getter]
    fn sample(&self) -> PyResult<u64> {
        Ok(self.driven()?.simulation.sample() - 1)
    }

    /// Control period, s.
    #[getter]
    fn period(&self) -> f64 {
        self.period
    }

    /// Whether the run is over: its last sample is computed, or it broke off.
    #[getter]
    fn done(&self) -> PyResult<bool> {
        Ok(self.driven()?.simulation.is_over())
    }

    /// Of the trajectory so far.
    #[getter]
    fn digest(&self) -> PyResult<String> {
        Ok(self.driven()?.digest.text())
    }

    /// Names of the robots, in the order of the rows of `robots`.
    #[getter]
    fn robot_names(&self) -> Vec<&str> {
        self.fleet.robots.iter().map(|robot| &*robot.name).collect()
    }

    /// Leader and follower of every edge as they are now, in the order of the rows of `edges`. The leader is None where the
    /// follower follows nobody.
    #[getter]
    fn edge_names(&self) -> PyResult<Vec<(Option<String>, String)>> {
        let driven = self.driven()?;
        let record = driven.simulation.record();
        let name = |robot: usize| self.fleet.name(EntityId::Robot(robot)).to_owned();
        let edges = self.fleet.edges.iter().enumerate();
        Ok(edges
            .map(|(k, own)| (record.edge(&self.fleet, k).map(|edge| name(edge.leader)), name(own.follower)))
            .collect())
    }

    /// State of the robots at the last sample.
    ///
    /// Returns
    /// -------
    /// ndarray of float64
    ///     Robots × columns; `echelon.ROBOT_COLUMNS` names the columns, which end in their units.
    #[getter]
    fn robots<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let numbers = robot_numbers(self.driven()?.simulation.record());
        matrix(py, numbers, robot_columns().len())
    }

    /// State of the edges at the last sample.
    ///
    /// Returns
    /// -------
    /// ndarray of float64
    ///     Edges × columns; `echelon.EDGE_COLUMNS` names the columns, which end in their units. Flags are 0 or 1. Rows of edges
    ///     whose follower follows nobody are NaN.
    #[getter]
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let numbers = edge_numbers(&self.fleet, self.driven()?.simulation.record());
        matrix(py, numbers, edge_columns().len())
    }

    #[expect(clippy::unused_self, reason = "pickle asks an object")]
    fn __reduce__(&self) -> PyResult<()> {
        Err(not_pickled(
            "a Simulation",
            "send its `scene`, which has what was applied on the way, and begin there with `scene.simulation()`; `fork` copies \
             it in this process",
        ))
    }

    fn __repr__(&self) -> String {
        // Who looks for what is wrong sees that it is at work, and no error.
        let Ok(driven) = self.driven() else {
            return format!("<echelon.Simulation of {}: at work>", self.fleet.title);
        };
        let Scene { title, time, .. } = driven.scene.scene();
        let now = driven.simulation.record().snapshot.time;
        format!("<echelon.Simulation of {title}: {now:.2} of {} s>", time.duration)
    }
}
