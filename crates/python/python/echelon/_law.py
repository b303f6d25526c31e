"""Laws that are functions over arrays."""

from __future__ import annotations

import copy
import difflib
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from ._echelon import INPUTS, KNOWLEDGE
from ._errors import LawError

# Only a law that knows its leaders' motion is told these.
_MOTION = ("leader.speed", "leader.acceleration", "leader.turn_rate", "leader.turn_acceleration", "leader.heading",
           "frame.turn_rate", "frame.turn_acceleration")
_ROWS = {name: row for row, (name, _, _) in enumerate(INPUTS)}
_GROUPS = sorted({name.split(".")[0] for name in _ROWS if "." in name})


class _Group:
    """The observations whose names begin alike, as attributes."""

    __slots__ = ("_knows", "_numbers", "_prefix")

    def __init__(self, prefix: str, numbers: np.ndarray, knows: str) -> None:
        self._prefix, self._numbers, self._knows = prefix, numbers, knows

    def __getattr__(self, name: str) -> np.ndarray:
        full = f"{self._prefix}.{name}"
        row = _ROWS.get(full)
        if row is None:
            raise AttributeError(f"a law is not told `{full}`: there is {', '.join(self.__dir__())}")
        if full in _MOTION and self._knows != "motion":
            raise AttributeError(f"only a law that knows=\"motion\" is told `{full}`; this one knows \"{self._knows}\"")
        return self._numbers[row]

    def __dir__(self) -> list[str]:
        start = self._prefix + "."
        return [name[len(start):] for name in _ROWS if name.startswith(start)]


class Observations:
    """What a law is told, one entry per follower in every array.

    The arrays can be read only. The names are those of law files: `own.speed`, `leader.distance`, `leader.bearing_rate`, `wanted.bearing` and so on;
    `echelon.INPUTS` lists all with their units. `leader` is the one leader of each follower.

    Attributes
    ----------
    own, leader, wanted, frame
        The numbers, each an array of float64 with the shape (followers,).
    followers : list of str
        Names of the followers, in the order of the arrays.
    index : ndarray of int
        Their places among all followers of the law: what a memory of one row per follower is indexed by.
    meets : ndarray of bool
        Whether each meets its leader now: at the first sample, and after the leader was lost or changed.
    period : float
        Control period, s.
    """

    __slots__ = ("followers", "frame", "index", "leader", "meets", "own", "period", "wanted")
    own: _Group
    leader: _Group
    wanted: _Group
    frame: _Group

    def __init__(self, numbers: np.ndarray, followers: list[str], index: np.ndarray, meets: np.ndarray,
                 period: float, knows: str) -> None:
        self.followers, self.index, self.meets, self.period = followers, index, meets, period
        for prefix in _GROUPS:
            setattr(self, prefix, _Group(prefix, numbers, knows))

    def __len__(self) -> int:
        return len(self.followers)


class Law:
    """A control law that is a function in Python.

    Parameters
    ----------
    function : callable
        ``function(observations, time, memory) -> commands``. `observations` is an `Observations`, `time` is in s, and
        `commands` an array of the shape (followers, 2): acceleration in m/s² and turn rate in rad/s.
    followers : iterable of str, optional
        The robots whose commands it decides; all followers by default. The others keep the laws of the scene.
    knows : {"output", "rates", "motion"}
        What it has to know of the leaders. ``"output"``: distance and bearing, whose rates are the estimates of the
        built-in observer; it is called once a sample. ``"rates"``: their true rates. ``"motion"``: also the leader's
        motion of the same sample. The last two are called once per depth of the graph, leaders before followers.
    memory : dict, optional
        What it carries from sample to sample. Every simulation has a deep copy of its own, and so has every fork.
    name : str, optional
        By which pictures and reports call it; that of the function by default.
    """

    def __init__(self, function: Callable[..., Any], *, followers: Iterable[str] | None = None, knows: str = "output",
                 memory: dict[str, Any] | None = None, name: str | None = None) -> None:
        if not callable(function):
            raise TypeError(f"a law is a function of (observations, time, memory), not {type(function).__name__}")
        if not (name is None or isinstance(name, str)):
            raise TypeError(f"the name of a law is a text, not {name!r}")
        _check_knowledge(knows)
        if isinstance(followers, str):
            followers = [followers]
        self.function = function
        self.followers = None if followers is None else list(followers)
        self.knows = knows
        self.memory = {} if memory is None else memory
        self.name = name or getattr(function, "__name__", type(function).__name__)

    def __repr__(self) -> str:
        whose = "all followers" if self.followers is None else ", ".join(self.followers)
        return f"<echelon.Law {self.name!r} of {whose}, knows {self.knows}>"


def _check_knowledge(knows: Any) -> None:
    if knows in KNOWLEDGE:
        return
    *first, last = (f'"{word}"' for word in KNOWLEDGE)
    near = difflib.get_close_matches(str(knows), KNOWLEDGE, 1)
    meant = f": did you mean \"{near[0]}\"?" if near else ""
    raise ValueError(f"a law knows {', '.join(first)} or {last}, not {knows!r}{meant}")


class Caller:
    """A law in one simulation, with its memory."""

    def __init__(self, law: Law, robots: list[str], followers: list[int], period: float, memory: Any) -> None:
        self.law, self.robots, self.followers, self.period, self.memory = law, robots, followers, period, memory
        self.knows, self.name = law.knows, law.name
        self._places = {robot: place for place, robot in enumerate(followers)}

    def fork(self) -> Caller:
        """The same with a memory of its own."""
        return Caller(self.law, self.robots, self.followers, self.period, copy.deepcopy(self.memory))

    def __call__(self, numbers: np.ndarray, robots: list[int], meets: list[bool], time: float, sample: int) -> np.ndarray:
        """The commands of the `robots` at a sample, as an array that is checked."""
        names = [self.robots[robot] for robot in robots]
        index = np.array([self._places[robot] for robot in robots])
        numbers.setflags(write=False)
        told = Observations(numbers, names, index, np.array(meets), self.period, self.knows)

        def fault(text: str, robot: str | None = None) -> LawError:
            whose = f", `{robot}`" if robot else ""
            return LawError(f"law `{self.name}` at sample {sample} ({time:.2f} s){whose}: {text}", robot, sample, time)

        alone = names[0] if len(names) == 1 else None
        try:
            answer = self.law.function(told, time, self.memory)
        except Exception as error:
            raise fault(f"{type(error).__name__}: {error}", alone) from error
        if answer is None:
            raise fault(f"it returned nothing: return an array of the shape ({len(names)}, 2)", alone)
        try:
            # Text would be read as numbers, and complex numbers lose a part.
            commands = np.ascontiguousarray(np.asarray(answer).astype(np.float64, casting="same_kind"))
        except (TypeError, ValueError) as error:
            raise fault(f"it returned no real numbers ({_kind(answer)})", alone) from error
        if commands.shape != (len(names), 2):
            raise fault(
                f"it returned the shape {commands.shape}, not ({len(names)}, 2): one row per follower, acceleration in "
                "m/s² and turn rate in rad/s, as np.column_stack((acceleration, turn_rate)) makes it", alone)
        if not np.isfinite(commands).all():
            row, column = np.argwhere(~np.isfinite(commands))[0]
            what = ("acceleration", "turn rate")[column]
            raise fault(f"the {what} is {commands[row, column]}: a command is finite", names[row])
        return commands


def _kind(answer: Any) -> str:
    """What an error calls what a law returned."""
    return f"an array of {answer.dtype}" if isinstance(answer, np.ndarray) else type(answer).__name__


def caller(law: Any, robots: list[str], followers: list[str], period: float) -> Caller:
    """What asks `law`, a `Law` or a function, in a simulation of `robots`."""
    law = law if isinstance(law, Law) else Law(law)
    # An attribute may have been set since the law was made.
    _check_knowledge(law.knows)
    names = followers if law.followers is None else law.followers
    unknown = [name for name in names if name not in robots]
    if unknown:
        raise ValueError(f"there is no robot called `{unknown[0]}`: the followers are {', '.join(followers)}")
    chosen = [robots.index(name) for name in names]
    return Caller(law, robots, chosen, period, copy.deepcopy(law.memory))


def again(error: BaseException, sample: int, time: float) -> tuple[BaseException, LawError]:
    """What to raise now for an `error` that broke a run off at a sample, and what to hand over whenever it is to go on after that.

    The error itself is kept and never raised: whoever catches an exception has added frames to its traceback, which would hold
    all that is in them as long as the simulation.
    """
    if not isinstance(error, LawError):
        # An interrupt is one once.
        kept = LawError(f"the law was interrupted at sample {sample} ({time:.2f} s)", None, sample, time)
        kept.__cause__ = error
        return error, kept
    raised = LawError(str(error), error.robot, error.sample, error.time)
    raised.__cause__ = error.__cause__
    return raised.with_traceback(error.__traceback__), error
