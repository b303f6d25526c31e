from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from ._film import Film
from ._law import Law
from ._run import Expectation

__all__ = [
    "EDGE_COLUMNS",
    "INPUTS",
    "KNOWLEDGE",
    "ROBOT_COLUMNS",
    "SIGNALS",
    "Copies",
    "Run",
    "Scene",
    "Simulation",
    "Study",
    "Table",
    "__version__",
    "program",
    "scenes",
]
__version__: str
ROBOT_COLUMNS: list[str]
EDGE_COLUMNS: list[str]
INPUTS: list[tuple[str, str, str]]
KNOWLEDGE: list[str]
SIGNALS: list[str]

def scenes() -> dict[str, str]:
    """The scenes that come with the package."""

def program(arguments: list[str]) -> int:
    """Runs the program `echelon` with these arguments, of which the first is its name, and returns its exit code.

    Help, and arguments that are none, end the process.
    """

@final
class Scene:
    """A scene, checked. It does not change: `set` returns another one. It can be pickled."""
    @classmethod
    def load(cls, source: str | PathLike[str] | Mapping[str, Any]) -> Scene:
        """Reads and checks a scene.

        Parameters
        ----------
        source : path, str or dict
            A scene file; the name of a scene that ships, see `scenes`; the text of a scene, which has more than one line; or a
            dictionary with the keys of a scene file. NumPy arrays are lists in it, and what is None is left out.

        Raises
        ------
        SceneError
            Everything that is wrong, each with file, line and column.
        """
    def set(self, values: Mapping[str, Any]) -> Scene:
        """A new scene in which values are set; this one stays as it is, as with methods of pandas.

        Parameters
        ----------
        values : dict
            Dotted paths and values, such as ``{"law.k": 3, "robots.follower-1.distance": 1.5}``. Robots go by their names or
            numbers. A dictionary as a value takes the place of a whole table.

        Raises
        ------
        SceneError
            Where there is no such key, or the value is out of its range.
        """
    def to_toml(self) -> str:
        """The scene as TOML with every default written out; it loads again to an equal scene."""
    def to_dict(self) -> dict[str, Any]:
        """The scene as a dictionary with every default written out; it loads again to an equal scene."""
    def check(self) -> list[str]:
        """Builds the scene without running it.

        Returns
        -------
        list of str
            What deserves a look, such as changes that come after the end of the run.

        Raises
        ------
        SceneError
            Where the scene cannot run.
        """
    def run(
        self,
        progress: bool | Callable[[int, int], Any] | None = None,
        *,
        law: Law | Callable[..., Any] | None = None,
        adapter: str = "auto",
    ) -> Run:
        """Runs the scene to its end. Ctrl-C ends it at once.

        Parameters
        ----------
        progress : bool or callable, optional
            True shows a bar, which needs tqdm; a function is called with the samples done and in all.
        law : Law or callable, optional
            Decides in the place of the followers' own laws.
        adapter : str, optional
            Graphics adapter for cameras on robots, as ``echelon doctor`` calls it.

        Raises
        ------
        RunError
            Where the run breaks off. An expectation that is not met is no exception: see `Run.passed`.
        LawError
            Where the law gives no commands.
        """
    def simulation(self, *, law: Law | Callable[..., Any] | None = None, adapter: str = "auto") -> Simulation:
        """A simulation to be driven step by step; its first sample, at time 0, is computed.

        Parameters
        ----------
        law : Law or callable, optional
            Decides in the place of the followers' own laws.
        adapter : str, optional
            Graphics adapter for cameras on robots and for `Simulation.render`.
        """
    def capture(
        self,
        folder: str | PathLike[str],
        at: float | Iterable[float] | None = None,
        *,
        view: str | None = None,
        size: tuple[int, int] | str | None = None,
        without: str | Iterable[str] | None = None,
        overlay: bool = False,
        inset_camera: str | None = None,
        law: Law | Callable[..., Any] | None = None,
        adapter: str = "auto",
        progress: bool | Callable[[int, int], Any] | None = None,
    ) -> list[Path]:
        """Writes pictures of a run, as ``echelon capture`` does.

        Parameters
        ----------
        folder : path
            Where they go; it may hold others.
        at : float or list of float, optional
            Times, s; the end of the run by default.
        view : str, optional
            Such as ``"snake"``, ``"top"``, ``"orbit"``, ``"follow:NAME"``, ``"camera:NAME"``, or several joined by ``+``; that of
            the scene by default.
        size : tuple of int or str, optional
            Width and height, pixels, such as ``(1280, 720)`` or ``"1280x720"``; those of the scene by default.
        without : str or list of str, optional
            Elements to hide, such as ``["labels", "inset"]``.
        overlay : bool, optional
            In views through cameras, draws what was detected.
        inset_camera : str, optional
            The robot whose camera image is shown in a corner.
        law, adapter, progress
            As for `run`.

        Returns
        -------
        list of pathlib.Path
            The files, in the order of time.

        Raises
        ------
        RenderingError
            Where there is no adapter to draw with.
        OutputError
            Where a picture cannot be written.
        """
    def film(
        self,
        path: str | PathLike[str],
        *,
        view: str | None = None,
        size: tuple[int, int] | str | None = None,
        fps: float | None = None,
        preset: str | None = None,
        fresh: bool = False,
        ffmpeg: bool = False,
        without: str | Iterable[str] | None = None,
        overlay: bool = False,
        inset_camera: str | None = None,
        law: Law | Callable[..., Any] | None = None,
        adapter: str = "auto",
        progress: bool | Callable[[int, int], Any] | None = None,
    ) -> Film:
        """Films the scene, as ``echelon film`` does. A film that was interrupted is resumed.

        Parameters
        ----------
        path : path
            The film: .mp4, .m4v or .gif, or others where ffmpeg is installed; without an extension a folder of pictures.
        fps : float, optional
            Frames per second of simulation time.
        preset : {"talk", "paper", "social"}, optional
            Measures, cards and, where the scene has no storyboard, shots for a purpose.
        fresh : bool, optional
            Starts over instead of resuming.
        ffmpeg : bool, optional
            Encodes with the ffmpeg on PATH.
        view, size, without, overlay, inset_camera, law, adapter, progress
            As for `capture`.

        Returns
        -------
        Film
            Which shows itself in a notebook.

        Raises
        ------
        RenderingError
            Where there is no adapter to draw with.
        OutputError
            Where the film cannot be written, or another program writes it.
        """
    @property
    def name(self) -> str:
        """The name of its file, or its own where it ships."""
    @property
    def title(self) -> str:
        """What pictures and reports call it."""
    @property
    def description(self) -> str:
        """What it is about."""
    @property
    def duration(self) -> float:
        """Length of the run, s."""
    @property
    def period(self) -> float:
        """Control period, s."""
    @property
    def robots(self) -> list[str]:
        """Names of all robots."""
    @property
    def followers(self) -> list[str]:
        """Names of the robots that follow another one."""

@final
class Table:
    """A table of a run, an Arrow stream: ``polars.DataFrame(table)``, ``pyarrow.table(table)`` and, from pandas 3 on,
    ``pandas.DataFrame.from_arrow(table)`` take it as it is; ``table["x_m"]`` is a column.
    """
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The Arrow PyCapsule interface: pandas, polars, DuckDB and pyarrow take the table by it without a copy."""
    @property
    def columns(self) -> list[str]:
        """Names of the columns, which end in their units."""
    def __getitem__(self, column: str, /) -> NDArray[Any] | list[str]:
        """A column: an array of float64, int64 or bool, or a list of str."""
    def __len__(self) -> int:
        """Number of rows."""

@final
class Study:
    """Many runs of a scene that differ. It does not change, and can be pickled."""
    def __new__(
        cls,
        scene: Scene,
        vary: Mapping[str, Any] | None = None,
        *,
        seeds: int = 1,
        samples: int = 1,
        sampling: str = "independent",
        seed: int = 1,
        scatter: Sequence[float] = ...,
        title: str | None = None,
    ) -> Study:
        """Makes a study of a scene.

        Parameters
        ----------
        scene : Scene
            What runs.
        vary : dict, optional
            Keys and their values: a list, or a text such as ``"1..10/19"``, ``"log:0.001..0.1/13"``, ``"zip:1,2,5"``,
            ``"uniform:0..1"``, ``"log-uniform:0.001..0.1"``, ``"normal:5,0.5"`` or ``"=law.k"``.
        seeds : int
            Runs of every combination, each with a seed of its own.
        samples : int
            How often numbers with a distribution are drawn for every combination of the others.
        sampling : {"independent", "latin-hypercube", "sobol"}
            How they are drawn.
        seed : int
            Seed of everything that differs from run to run.
        scatter : (float, float)
            How far followers start from where the scene puts them, m, and how far they are turned, rad.
        title : str, optional
            Title of figures.

        Raises
        ------
        ValueError
            Where keys or values are none, or contradict each other.
        """
    @classmethod
    def load(cls, path: str | PathLike[str]) -> Study:
        """Reads a study file.

        Parameters
        ----------
        path : path
            The file.
        """
    def __reduce__(self) -> tuple[Callable[..., Study], tuple[str, str, Path]]: ...
    @property
    def runs(self) -> int:
        """Runs of the study."""
    def __len__(self) -> int:
        """Runs of the study."""
    @property
    def fingerprint(self) -> str:
        """32 hexadecimal digits that are others where the study, its scene or the program is another."""
    def to_toml(self) -> str:
        """The study as a file has it."""
    def point(self, index: int) -> dict[str, Any]:
        """What one run has that others have not.

        Parameters
        ----------
        index : int
            The run, from 0.

        Returns
        -------
        dict
            ``index``, ``cell``, ``sample``, ``seed``, and ``set``: the overrides that make the run again, as lines of
            ``echelon run --set``.
        """
    def run(
        self,
        start: int = 0,
        stop: int | None = None,
        *,
        threads: int | None = None,
        progress: Callable[[int, int], Any] | bool | None = None,
    ) -> Table:
        """Makes runs and returns their rows: see `echelon.sweep`, which makes those of a cluster, too.

        Parameters
        ----------
        start, stop : int, optional
            The first run, and the one before which to end; by default all.
        threads : int, optional
            By default one for each core.
        progress : callable or bool, optional
            Called with runs that have been made and in all; True is a bar.

        Returns
        -------
        Table
            A row for every run, by index.
        """
    def part(self, start: int, stop: int, *, threads: int | None = None) -> bytes:
        """Makes runs and returns their rows as the bytes of a Parquet file.

        Parameters
        ----------
        start, stop : int
            The first run, and the one before which to end.
        threads : int, optional
            By default one for each core.
        """
    def joined(self, parts: list[bytes]) -> Table:
        """Joins the bytes of Parquet files of rows.

        Parameters
        ----------
        parts : list of bytes
            As `part` returns them, in any order.

        Returns
        -------
        Table
            A row for every run in them, by index.

        Raises
        ------
        EchelonError
            Where one is of another study, or a run is there twice.
        """

@final
class Run:
    """A run of a scene, all of it in memory. Its tables have the columns of those in a run folder, and are Arrow streams."""
    @property
    def robots(self) -> Table:
        """Poses and speeds: a row per robot and sample."""
    @property
    def edges(self) -> Table:
        """Set points, errors, commands and estimates: a row per edge and sample."""
    @property
    def contacts(self) -> Table:
        """Contacts, a row each."""
    @property
    def props(self) -> Table:
        """Where the props are that can move: a row per prop and sample."""
    @property
    def measurements(self) -> Table:
        """What followers measured, a row per measurement."""
    @property
    def safety(self) -> Table:
        """What safety filters did: a row per robot that has one and sample."""
    @property
    def laws(self) -> Table:
        """What law files carry and show: a row per quantity and sample."""
    @property
    def events(self) -> Table:
        """What happened to the formation, a row per event."""
    @property
    def metrics(self) -> dict[str, Any]:
        """Errors, effort, clearance, contacts, certificates and expectations: what ``metrics.json`` holds."""
    @property
    def expectations(self) -> list[Expectation]:
        """What became of the expectations of the scene."""
    @property
    def passed(self) -> bool:
        """Whether no expectation was missed."""
    @property
    def digest(self) -> str:
        """Of the trajectory: the same for runs that are the same bit for bit, whatever ran them."""
    @property
    def status(self) -> str:
        """``"complete"``, ``"stopped"`` before its time, or ``"interrupted"``."""
    @property
    def duration(self) -> float:
        """Time of the last sample, s."""
    @property
    def title(self) -> str:
        """The title of the scene."""
    def plot(self, axes: Any = None) -> Any:
        """Plots the errors of every edge over time. It needs matplotlib.

        Parameters
        ----------
        axes : pair of matplotlib axes, optional
            For distance and bearing; new ones by default.

        Returns
        -------
        pair of matplotlib axes
        """
    def save(
        self, folder: str | PathLike[str], *, csv: bool = False, log: bool = True, force: bool = False
    ) -> None:
        """Writes the run folder that ``echelon run`` writes.

        Parameters
        ----------
        folder : path
            A new or empty folder.
        csv : bool, optional
            Also writes the tables as CSV.
        log : bool, optional
            Writes ``log.mcap``, which other tools open.
        force : bool, optional
            Replaces an earlier run in the folder.

        Raises
        ------
        OutputError
            Where the folder holds something, or cannot be written.
        """

@final
class Simulation:
    """A run that is driven step by step. Everything in it is as of the last sample that was computed."""
    def step(self) -> None:
        """Computes the next control sample.

        Raises
        ------
        EndOfRunError
            Where `done` is true.
        RunError
            Where the run breaks off or has broken off; a `LawError` where the law gives no commands.
        BusyError
            Where another thread is at work on this simulation.
        """
    def advance(
        self, seconds: float | None = None, *, progress: bool | Callable[[int, int], Any] | None = None
    ) -> None:
        """Computes all samples of the next seconds, or to the end of the run. Ctrl-C ends it at a sample, and it can go on.

        The last sample is the first that is not before the time asked for. Calls add up: 600 times 1/60 s are 10 s.

        Parameters
        ----------
        seconds : float, optional
            How much further, s; to the end by default.
        progress : bool or callable, optional
            As for `Scene.run`.
        """
    def apply(self, values: Mapping[str, Any]) -> None:
        """Sets values from the next sample on, as if the scene had a change there; `scene` has it then.

        Parameters
        ----------
        values : dict
            As for `Scene.set`; of set points, laws, observers, limits and safety filters only.

        Raises
        ------
        SceneError
            For what cannot change while a run goes.
        """
    def fork(self) -> Simulation:
        """A copy that goes on by itself, with a deep copy of the memory of its law. Both come to the same future, bit for bit."""
    def render(
        self,
        view: str | None = None,
        size: tuple[int, int] | str | None = None,
        *,
        without: str | Iterable[str] | None = None,
        overlay: bool = False,
        inset_camera: str | None = None,
    ) -> NDArray[np.uint8]:
        """A picture of this moment, the same that ``echelon capture`` draws.

        Parameters
        ----------
        view : str, optional
            As for `Scene.capture`; ``"camera:NAME"`` is what that robot sees.
        size, without, overlay, inset_camera
            As for `Scene.capture`.

        Returns
        -------
        ndarray of uint8
            Height × width × 3: red, green, blue.

        Raises
        ------
        RenderingError
            Where there is no adapter to draw with.
        """
    @property
    def scene(self) -> Scene:
        """The scene with what was applied on the way: its run comes to the same states."""
    @property
    def time(self) -> float:
        """Time of the last sample, s."""
    @property
    def sample(self) -> int:
        """Number of the last sample, from 0."""
    @property
    def period(self) -> float:
        """Control period, s."""
    @property
    def done(self) -> bool:
        """Whether the run is over: its last sample is computed, or it broke off."""
    @property
    def digest(self) -> str:
        """Of the trajectory so far."""
    @property
    def robot_names(self) -> list[str]:
        """Names of the robots, in the order of the rows of `robots`."""
    @property
    def edge_names(self) -> list[tuple[str | None, str]]:
        """Leader and follower of every edge as they are now, in the order of the rows of `edges`. The leader is None where the
        follower follows nobody.
        """
    @property
    def robots(self) -> NDArray[np.float64]:
        """State of the robots at the last sample.

        Returns
        -------
        ndarray of float64
            Robots × columns; `echelon.ROBOT_COLUMNS` names the columns, which end in their units.
        """
    @property
    def edges(self) -> NDArray[np.float64]:
        """State of the edges at the last sample.

        Returns
        -------
        ndarray of float64
            Edges × columns; `echelon.EDGE_COLUMNS` names the columns, which end in their units. Flags are 0 or 1. Rows of edges
            whose follower follows nobody are NaN.
        """

@final
class Copies:
    """Many copies of a scene, whose followers are driven by actions. `echelon.envs` has environments for learning on top of it."""
    def __new__(
        cls,
        scene: Scene,
        count: int,
        *,
        agents: Sequence[str],
        columns: Sequence[tuple[str, float, float]],
        scale: Sequence[tuple[float, float]],
        residual: bool = False,
        samples: int = 1,
        scattered: Sequence[str] = ...,
        scatter: Sequence[float] = ...,
        drawn: bool = False,
        threads: int | None = None,
        adapter: str = "auto",
        numbered: bool = True,
    ) -> Copies:
        """Makes copies none of which has an episode yet.

        Parameters
        ----------
        scene : Scene
            What is copied.
        count : int
            Number of copies.
        agents : list of str
            Followers that are driven by actions; the others keep their laws.
        columns : list of (str, float, float)
            What each agent observes: a name of `INPUTS`, ``error.distance``, ``error.bearing``, ``error.distance_rate`` or
            ``error.bearing_rate``, or ``sin(…)`` or ``cos(…)`` of one; what becomes 1; and the bound on what comes out.
        scale : list of (float, float)
            Per agent, what an action of 1 is: acceleration, m/s², and turn rate, rad/s.
        residual : bool, optional
            Adds actions to what the scene's laws ask for.
        samples : int, optional
            Control samples for which an action holds.
        scattered : list of str, optional
            Robots that start elsewhere in every episode.
        scatter : (float, float), optional
            Within how many m and rad.
        drawn : bool, optional
            Keeps what pictures show of the past.
        threads : int, optional
            Threads that share the work; one per processor by default.
        adapter : str, optional
            Graphics adapter for `render`.
        numbered : bool, optional
            Whether errors say which copy they are of.
        """
    def reset(self, seeds: Sequence[int | None], numbers: Sequence[int]) -> None:
        """Begins an episode in those copies that have a seed.

        Parameters
        ----------
        seeds : list of int or None
            Per copy.
        numbers : list of int
            Per copy: the number of the episode since the copy got its seed, from 0. Starts and noise depend on the two alone.
        """
    def step(
        self, actions: NDArray[np.float64], idle: NDArray[np.bool_]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.uint8]]:
        """Drives all copies on by one action, but for those that are idle.

        Parameters
        ----------
        actions : ndarray of float64
            Copies × agents × 2: acceleration and turn rate, each −1 to 1 and cut there.
        idle : ndarray of bool
            Per copy.

        Returns
        -------
        observations : ndarray of float64
            Copies × agents × columns.
        signals : ndarray of float64
            Copies × agents × `SIGNALS`: the truth.
        progress : ndarray of uint8
            Per copy: 1 goes on, 2 has come to its last sample, 3 has stopped at a contact.

        Raises
        ------
        ActionError
            Where an action is no finite number; it names the agent.
        """
    def observe(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.uint8]]:
        """What all agents observe as they stand; returns what `step` does."""
    def told(self) -> NDArray[np.float64]:
        """What the laws of all agents are told as they stand.

        Returns
        -------
        ndarray of float64
            `INPUTS` × copies × agents.
        """
    def prepare(self, view: str | None = None, size: Iterable[int] | str | None = None) -> None:
        """Sets up what `render` draws with, so that an adapter, a view or a size that cannot be is told before any episode.

        Parameters
        ----------
        view, size
            As for `Simulation.render`.
        """
    def render(
        self, copy: int, view: str | None = None, size: Iterable[int] | str | None = None
    ) -> NDArray[np.uint8]:
        """A picture of a copy as it stands.

        Parameters
        ----------
        copy : int
            Its number.
        view, size
            As for `Simulation.render`.

        Returns
        -------
        ndarray of uint8
            Height × width × 3: red, green, blue.
        """
    @property
    def digests(self) -> list[str]:
        """Of the trajectory of every copy, as far as its agents have decided; an empty text before its first episode."""
