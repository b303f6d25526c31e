//! Scenes: read, changed, checked, run.

use crate::arguments::{Names, Size, Times};
use crate::error::{call_package, of_diagnostics, of_scene};
use crate::law::attach;
use crate::pictures::{Viewer, looks, of_footage, warn};
use crate::run::PyRun;
use crate::simulation::PySimulation;
use crate::values::{overrides, table, to_python};
use crate::watch::detached;
use footage::{CaptureJob, DrawJob, FilmJob, Filmed, Preset};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyString, PyType};
use rendering::{Gpu, GpuCameraRenderer};
use scene::{Loaded, Override, SHIPPED, Scene, SceneText};
use std::path::PathBuf;
use std::sync::Mutex;
use studies::{RecordSource, SceneRun};
use vocabulary::Word;

/// What a text is called that came from no file.
const NO_FILE: &str = "scene";

/// A scene, checked. It does not change: `set` returns another one. It can be pickled.
#[pyclass(name = "Scene", module = "echelon", frozen)]
pub(crate) struct PyScene {
    scene: Scene,
    /// What it was read from, and what was set on top of that.
    text: String,
    path: PathBuf,
    sets: Vec<Override>,
}

impl PyScene {
    fn parse_with(text: String, path: PathBuf, sets: Vec<Override>) -> PyResult<Self> {
        let Loaded { scene, .. } =
            Scene::parse(&text, &path, &sets).map_err(|faults| of_diagnostics(&faults))?;
        Ok(Self { scene, text, path, sets })
    }

    /// This scene with more set on top of it.
    pub(crate) fn with(&self, more: Vec<Override>) -> PyResult<Self> {
        let sets = self.sets.iter().cloned().chain(more).collect();
        Self::parse_with(self.text.clone(), self.path.clone(), sets)
    }

    pub(crate) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// This scene, where at `at` s more is set while it runs.
    pub(crate) fn changed(&self, at: f64, sets: &[String]) -> PyResult<Self> {
        let change = |at: f64, sets: &[String]| {
            let sets = sets.iter().cloned().map(toml::Value::String).collect();
            toml::Table::from_iter([
                ("at".to_owned(), toml::Value::Float(at)),
                ("set".to_owned(), toml::Value::Array(sets)),
            ])
        };
        let own = self.scene.changes.iter().map(|own| change(own.at, &own.set));
        let all = own.chain([change(at, sets)]).map(toml::Value::Table).collect();
        let set = format!("changes={}", toml::Value::Array(all));
        self.with(vec![set.parse().map_err(of_scene::<scene::OverrideError>)?])
    }

    /// What is set on top of its text.
    pub(crate) fn sets(&self) -> &[Override] {
        &self.sets
    }

    /// Its text, with laws in the places of the names of their files, and where it is from.
    pub(crate) fn source(&self) -> PyResult<SceneSource> {
        let mut text = SceneText::parse(&self.text).map_err(of_scene)?;
        text.embed_laws(&self.scene);
        Ok(SceneSource { text: text.text(), path: self.path.clone() })
    }

    /// A second one that is the same.
    pub(crate) fn again(&self) -> Self {
        let Self { scene, text, path, sets } = self;
        Self { scene: scene.clone(), text: text.clone(), path: path.clone(), sets: sets.clone() }
    }

    /// What is called with the progress of work on this scene.
    pub(crate) fn progress(
        &self,
        py: Python<'_>,
        wish: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Option<Py<PyAny>>> {
        let Some(wish) = wish else { return Ok(None) };
        let made = call_package(py, ["_progress", "as_progress"], (wish, self.name()))?;
        Ok((!made.is_none()).then(|| made.unbind()))
    }

    /// Its simulation before the first step, with a law from Python if there is one.
    pub(crate) fn begin(&self, py: Python<'_>, law: Option<&Bound<'_, PyAny>>) -> PyResult<SceneRun> {
        let scene = self.scene.clone();
        let mut run = py.detach(|| SceneRun::new(scene)).map_err(of_scene)?;
        if let Some(law) = law.filter(|law| !law.is_none()) {
            attach(law, &mut run)?;
        }
        Ok(run)
    }
}

/// What a scene was read from.
pub(crate) struct SceneSource {
    pub(crate) text: String,
    pub(crate) path: PathBuf,
}

/// What makes a scene again: a function and its arguments.
type Pickled<'py> = (Bound<'py, PyAny>, (String, PathBuf, Vec<String>));

#[pymethods]
impl PyScene {
    /// Reads and checks a scene.
    ///
    /// Parameters
    /// ----------
    /// source : path, str or dict
    ///     A scene file; the name of a scene that ships, see `scenes`; the text of a scene, which has more than one line; or a
    ///     dictionary with the keys of a scene file. NumPy arrays are lists in it, and what is None is left out.
    ///
    /// Raises
    /// ------
    /// SceneError
    ///     Everything that is wrong, each with file, line and column.
    #[classmethod]
    fn load(_class: &Bound<'_, PyType>, source: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(mapping) = source.cast::<PyMapping>() {
            let text = toml::to_string(&table(mapping, 0)?).map_err(of_scene)?;
            return Self::parse_with(text, PathBuf::from(NO_FILE), vec![]);
        }
        if let Ok(text) = source.cast::<PyString>()
            && text.to_str()?.contains('\n')
        {
            return Self::parse_with(text.to_str()?.to_owned(), PathBuf::from(NO_FILE), vec![]);
        }
        let path: PathBuf = source.extract().map_err(|_: PyErr| {
            let kind = source.get_type().name().map(|name| name.to_string()).unwrap_or_default();
            PyTypeError::new_err(format!(
                "a scene is a file, the name of one that ships, a text or a dictionary, not {kind}"
            ))
        })?;
        let loaded =
            source.py().detach(|| Scene::load(&path, &[])).map_err(|faults| of_diagnostics(&faults))?;
        Ok(Self { scene: loaded.scene, text: loaded.text, path, sets: vec![] })
    }

    #[staticmethod]
    fn _restore(text: String, path: PathBuf, sets: Vec<String>) -> PyResult<Self> {
        let sets = sets.into_iter().map(|set| set.parse()).collect::<Result<_, _>>();
        Self::parse_with(text, path, sets.map_err(of_scene::<scene::OverrideError>)?)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Pickled<'py>> {
        let restore = py.get_type::<Self>().getattr("_restore")?;
        let sets = self.sets.iter().map(ToString::to_string).collect();
        // Another process may stand in another folder, and look for law files and tables from there.
        let path = if self.path.is_file() { std::path::absolute(&self.path)? } else { self.path.clone() };
        Ok((restore, (self.text.clone(), path, sets)))
    }

    /// A new scene in which values are set; this one stays as it is, as with methods of pandas.
    ///
    /// Parameters
    /// ----------
    /// values : dict
    ///     Dotted paths and values, such as ``{"law.k": 3, "robots.follower-1.distance": 1.5}``. Robots go by their names or
    ///     numbers. A dictionary as a value takes the place of a whole table.
    ///
    /// Raises
    /// ------
    /// SceneError
    ///     Where there is no such key, or the value is out of its range.
    fn set(&self, values: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.with(overrides(values)?)
    }

    /// The scene as TOML with every default written out; it loads again to an equal scene.
    fn to_toml(&self) -> String {
        self.scene.to_toml()
    }

    /// The scene as a dictionary with every default written out; it loads again to an equal scene.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let table = self.scene.to_toml().parse().map_err(of_scene::<toml::de::Error>)?;
        to_python(py, &toml::Value::Table(table))
    }

    /// Builds the scene without running it.
    ///
    /// Returns
    /// -------
    /// list of str
    ///     What deserves a look, such as changes that come after the end of the run.
    ///
    /// Raises
    /// ------
    /// SceneError
    ///     Where the scene cannot run.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let run = self.begin(py, None)?;
        let duration = self.scene.time.duration;
        if let Some(beyond) = self.scene.film.beyond(duration) {
            return Err(of_scene(beyond));
        }
        Ok(py.detach(move || run.remarks()))
    }

    /// Runs the scene to its end. Ctrl-C ends it at once.
    ///
    /// Parameters
    /// ----------
    /// progress : bool or callable, optional
    ///     True shows a bar, which needs tqdm; a function is called with the samples done and in all.
    /// law : Law or callable, optional
    ///     Decides in the place of the followers' own laws.
    /// adapter : str, optional
    ///     Graphics adapter for cameras on robots, as ``echelon doctor`` calls it.
    ///
    /// Raises
    /// ------
    /// RunError
    ///     Where the run breaks off. An expectation that is not met is no exception: see `Run.passed`.
    /// LawError
    ///     Where the law gives no commands.
    #[pyo3(signature = (progress=None, *, law=None, adapter="auto"))]
    fn run(
        &self,
        py: Python<'_>,
        progress: Option<Bound<'_, PyAny>>,
        law: Option<&Bound<'_, PyAny>>,
        adapter: &str,
    ) -> PyResult<PyRun> {
        let progress = self.progress(py, progress)?;
        PyRun::of(py, self.begin(py, law)?, progress, adapter)
    }

    /// A simulation to be driven step by step; its first sample, at time 0, is computed.
    ///
    /// Parameters
    /// ----------
    /// law : Law or callable, optional
    ///     Decides in the place of the followers' own laws.
    /// adapter : str, optional
    ///     Graphics adapter for cameras on robots and for `Simulation.render`.
    #[pyo3(signature = (*, law=None, adapter="auto"))]
    fn simulation(
        &self,
        py: Python<'_>,
        law: Option<&Bound<'_, PyAny>>,
        adapter: &str,
    ) -> PyResult<PySimulation> {
        PySimulation::of(py, self.again(), self.begin(py, law)?, adapter)
    }

    /// Writes pictures of a run, as ``echelon capture`` does.
    ///
    /// Parameters
    /// ----------
    /// folder : path
    ///     Where they go; it may hold others.
    /// at : float or list of float, optional
    ///     Times, s; the end of the run by default.
    /// view : str, optional
    ///     Such as ``"snake"``, ``"top"``, ``"orbit"``, ``"follow:NAME"``, ``"camera:NAME"``, or several joined by ``+``; that of
    ///     the scene by default.
    /// size : tuple of int or str, optional
    ///     Width and height, pixels, such as ``(1280, 720)`` or ``"1280x720"``; those of the scene by default.
    /// without : str or list of str, optional
    ///     Elements to hide, such as ``["labels", "inset"]``.
    /// overlay : bool, optional
    ///     In views through cameras, draws what was detected.
    /// inset_camera : str, optional
    ///     The robot whose camera image is shown in a corner.
    /// law, adapter, progress
    ///     As for `run`.
    ///
    /// Returns
    /// -------
    /// list of pathlib.Path
    ///     The files, in the order of time.
    ///
    /// Raises
    /// ------
    /// RenderingError
    ///     Where there is no adapter to draw with.
    /// OutputError
    ///     Where a picture cannot be written.
    #[pyo3(signature = (
        folder, at=None, *, view=None, size=None, without=None, overlay=false, inset_camera=None, law=None,
        adapter="auto", progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn capture(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        at: Option<Times>,
        view: Option<String>,
        size: Option<Size>,
        without: Option<Names>,
        overlay: bool,
        inset_camera: Option<String>,
        law: Option<&Bound<'_, PyAny>>,
        adapter: &str,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Vec<PathBuf>> {
        let picture = looks(view, size, without, overlay, inset_camera);
        let at = at.map_or_else(Vec::new, |Times(times)| times);
        let run = self.begin(py, law)?;
        let draw = DrawJob::of(&self.path, &run, adapter, picture);
        let notes = Mutex::default();
        let (told, progress) = (&notes, self.progress(py, progress)?);
        let captured = detached(py, progress, at.len().max(1) as u64, move |watch| {
            let job = CaptureJob { draw, out: &folder, at: &at, of: &self.path };
            footage::capture(&job, &Viewer::new(watch, told), |gpu| source(run, gpu))
        })?;
        warn(py, notes)?;
        captured.map(|captured| captured.files).map_err(|error| of_footage(&error))
    }

    /// Films the scene, as ``echelon film`` does. A film that was interrupted is resumed.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///     The film: .mp4, .m4v or .gif, or others where ffmpeg is installed; without an extension a folder of pictures.
    /// fps : float, optional
    ///     Frames per second of simulation time.
    /// preset : {"talk", "paper", "social"}, optional
    ///     Measures, cards and, where the scene has no storyboard, shots for a purpose.
    /// fresh : bool, optional
    ///     Starts over instead of resuming.
    /// ffmpeg : bool, optional
    ///     Encodes with the ffmpeg on PATH.
    /// view, size, without, overlay, inset_camera, law, adapter, progress
    ///     As for `capture`.
    ///
    /// Returns
    /// -------
    /// Film
    ///     Which shows itself in a notebook.
    ///
    /// Raises
    /// ------
    /// RenderingError
    ///     Where there is no adapter to draw with.
    /// OutputError
    ///     Where the film cannot be written, or another program writes it.
    #[pyo3(signature = (
        path, *, view=None, size=None, fps=None, preset=None, fresh=false, ffmpeg=false, without=None, overlay=false,
        inset_camera=None, law=None, adapter="auto", progress=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn film<'py>(
        &self,
        py: Python<'py>,
        path: PathBuf,
        view: Option<String>,
        size: Option<Size>,
        fps: Option<f64>,
        preset: Option<&str>,
        fresh: bool,
        ffmpeg: bool,
        without: Option<Names>,
        overlay: bool,
        inset_camera: Option<String>,
        law: Option<&Bound<'py, PyAny>>,
        adapter: &str,
        progress: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let picture = looks(view, size, without, overlay, inset_camera);
        let preset = preset.map(preset_called).transpose()?;
        let run = self.begin(py, law)?;
        let draw = DrawJob::of(&self.path, &run, adapter, picture);
        let job = FilmJob { ffmpeg, fps, preset, fresh, ..FilmJob::of(&run, draw, &path) };
        let notes = Mutex::default();
        let progress = self.progress(py, progress)?;
        let filmed = detached(py, progress, 1, |watch| {
            footage::shoot(job, &Viewer::new(watch, &notes), |gpu| source(run, gpu))
        })?;
        warn(py, notes)?;
        let Filmed { frames, fps, size, adapter, .. } = filmed.map_err(|error| of_footage(&error))?;
        call_package(py, ["_film", "Film"], (path, frames, fps, size, adapter))
    }

    /// The name of its file, or its own where it ships.
    #[getter]
    fn name(&self) -> String {
        scene::scene_name(&self.path)
    }

    /// What pictures and reports call it.
    #[getter]
    fn title(&self) -> &str {
        &self.scene.title
    }

    /// What it is about.
    #[getter]
    fn description(&self) -> &str {
        &self.scene.description
    }

    /// Length of the run, s.
    #[getter]
    fn duration(&self) -> f64 {
        self.scene.time.duration
    }

    /// Control period, s.
    #[getter]
    fn period(&self) -> f64 {
        self.scene.time.period
    }

    /// Names of all robots.
    #[getter]
    fn robots(&self) -> Vec<&str> {
        self.scene.robots.iter().map(|robot| &*robot.name).collect()
    }

    /// Names of the robots that follow another one.
    #[getter]
    fn followers(&self) -> Vec<&str> {
        self.scene.followers().map(|(name, _)| name).collect()
    }

    /// The scene at its start; `None` where there is nothing to draw with.
    fn _repr_png_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        call_package(slf.py(), ["_film", "still"], (slf,))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().scene == self.scene)
    }

    fn __repr__(&self) -> String {
        let Scene { title, robots, time, .. } = &self.scene;
        let robots = vocabulary::counted(robots.len(), "robot");
        format!("<echelon.Scene {:?}: {title}; {robots}, {} s>", self.name(), time.duration)
    }
}

/// The records of a run whose cameras draw on the adapter that draws the pictures.
fn source(mut run: SceneRun, gpu: &Gpu) -> Result<RecordSource, footage::Error> {
    run.attach_cameras(&mut |fleet| {
        let renderer = GpuCameraRenderer::new(gpu, fleet).map_err(|error| error.to_string())?;
        Ok(Box::new(renderer))
    })?;
    Ok(RecordSource::Run(Box::new(run.simulation)))
}

/// The preset of that name.
fn preset_called(name: &str) -> PyResult<Preset> {
    let known = Preset::WORDS.iter().find(|(word, ..)| *word == name).map(|(_, preset, _)| *preset);
    known.ok_or_else(|| {
        let words: Vec<&str> = Preset::WORDS.iter().map(|(word, ..)| *word).collect();
        PyValueError::new_err(format!("there is no preset \"{name}\": there is {}", words.join(", ")))
    })
}

/// The scenes that come with the package.
#[pyfunction]
pub(crate) fn scenes(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for shipped in SHIPPED {
        all.set_item(shipped.name, shipped.title())?;
    }
    Ok(all)
}
