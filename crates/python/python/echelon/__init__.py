"""A 3D laboratory for vehicle formations.

A scene describes robots, who follows whom, the control law, sensors and the world. `Scene.load` reads one, `Scene.run`
simulates it to its end, `Scene.simulation` step by step.

>>> import echelon
>>> run = echelon.Scene.load("circle-three").run()
>>> run.status
'complete'

Lengths are in m, angles in rad, times in s. Bearings are taken from the leader's heading, counter-clockwise.

Attributes
----------
ROBOT_COLUMNS, EDGE_COLUMNS : list of str
    Columns of `Simulation.robots` and `Simulation.edges`, whose names end in their units.
INPUTS : list of (str, str, str)
    What a law is told: names, units and meanings.
SIGNALS : list of str
    What rewards are made from, the columns of `echelon.envs.Signals`.
__version__ : str
    Version of the package.
"""

from . import _driver  # noqa: F401  before any driver is loaded
from ._echelon import EDGE_COLUMNS, INPUTS, ROBOT_COLUMNS, SIGNALS, Run, Scene, Simulation, Study, Table, __version__, scenes
from ._errors import (
    BusyError,
    EchelonError,
    EndOfRunError,
    LawError,
    OutputError,
    RenderingError,
    RunError,
    SceneError,
    SceneFault,
)
from ._film import Film
from ._law import Law, Observations
from ._run import Expectation
from ._sweep import sweep

__all__ = [
    "EDGE_COLUMNS",
    "INPUTS",
    "ROBOT_COLUMNS",
    "SIGNALS",
    "BusyError",
    "EchelonError",
    "EndOfRunError",
    "Expectation",
    "Film",
    "Law",
    "LawError",
    "Observations",
    "OutputError",
    "RenderingError",
    "Run",
    "RunError",
    "Scene",
    "SceneError",
    "SceneFault",
    "Simulation",
    "Study",
    "Table",
    "__version__",
    "scenes",
    "sweep",
]
