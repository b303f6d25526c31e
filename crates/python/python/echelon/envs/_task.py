"""What agents of an environment observe, do and are rewarded for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._echelon import INPUTS, SIGNALS

OBSERVATION = (
    "error.distance",
    "error.bearing",
    "error.distance_rate",
    "error.bearing_rate",
    "own.speed",
    "own.turn_rate",
    "wanted.distance",
    "sin(leader.bearing)",
    "cos(leader.bearing)",
    "sin(leader.view_angle)",
    "cos(leader.view_angle)",
)
"""What an agent observes by default: errors with their rates, its own motion, and where its leader is."""

# A robot whose acceleration has no bound reaches its top speed within this time, s, under the largest action.
_TOP_SPEED_WITHIN = 0.5
_UNITS = {name: unit for name, unit, _ in INPUTS} | {
    "error.distance": "m",
    "error.bearing": "rad",
    "error.distance_rate": "m/s",
    "error.bearing_rate": "rad/s",
}


class Signals:
    """The truth about every agent after a step, from which rewards are made.

    Attributes
    ----------
    error_distance_m, error_bearing_rad : ndarray of float64
        Tracking errors, set point minus truth, copies × agents.
    acceleration_m_s2, turn_rate_rad_s : ndarray of float64
        What was applied.
    speed_m_s, x_m, y_m, heading_rad : ndarray of float64
        Motion and pose in the world.
    touches : ndarray of float64
        1 where it touched a robot, a prop or the ground since the action before, else 0.
    effort : ndarray of float64
        Squares of acceleration and turn rate in units of the largest action, summed.
    interval : float
        Time between two actions, s.
    """

    error_distance_m: NDArray[np.float64]
    error_bearing_rad: NDArray[np.float64]
    acceleration_m_s2: NDArray[np.float64]
    turn_rate_rad_s: NDArray[np.float64]
    speed_m_s: NDArray[np.float64]
    x_m: NDArray[np.float64]
    y_m: NDArray[np.float64]
    heading_rad: NDArray[np.float64]
    touches: NDArray[np.float64]

    def __init__(self, numbers: NDArray[np.float64], scale: NDArray[np.float64], interval: float) -> None:
        for column, name in enumerate(SIGNALS):
            setattr(self, name, numbers[..., column])
        first = SIGNALS.index("acceleration_m_s2")
        share = numbers[..., first:first + 2] / scale
        self.effort = (share * share).sum(axis=-1)
        self.interval = interval


@dataclass(frozen=True)
class Scatter:
    """Random starts: in every episode robots start near where their scene puts them, apart from each other.

    Attributes
    ----------
    position : float
        Radius of the disc in which a start is, uniformly distributed, m.
    heading : float
        Largest turn to either side, uniformly distributed, rad.
    robots : iterable of str, optional
        Which robots; all followers by default.
    """

    position: float = 0.5
    heading: float = 0.3
    robots: Iterable[str] | None = None

    def __post_init__(self) -> None:
        for name in ("position", "heading"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0):
                raise ValueError(f"{name} of a scatter is a number from 0 on, not {value!r}")


@dataclass(frozen=True)
class Task:
    """What agents observe, what their actions mean, what is rewarded, and what ends an episode.

    Attributes
    ----------
    observation : tuple of str
        The numbers of an observation, by the names of `echelon.INPUTS`; ``error.distance``, ``error.bearing`` and their rates;
        ``sin(…)`` and ``cos(…)`` of one. They are what the follower's law is told: where its scene gives it a sensor, estimates.
        Motions of leaders are those of the sample before.
    scales : dict, optional
        What becomes 1, by name, in units of the number. By default lengths are taken in the largest distance of a set point
        of the scene, speeds in the largest top speed, other units follow, and angles are taken in rad.
    bound : float
        Observations are cut at ± this after they are scaled, so that their space is finite.
    acceleration, turn_rate : float, optional
        What an action of 1 is, m/s² and rad/s; actions go from −1 to 1 and are cut there. By default what the robot can do;
        where its acceleration has no bound, its top speed within 0.5 s.
    residual : bool
        Adds actions to what the laws of the scene ask for, in place of replacing them. Limits, and whatever else the scene gives
        a follower beside its law, such as a safety filter, apply in both cases.
    samples : int
        Control samples for which an action holds.
    distance_weight, bearing_weight, effort_weight : float
        The reward of a step is minus the time of the step times (`distance_weight` |distance error in m| + `bearing_weight`
        |bearing error in rad| + `effort_weight` `Signals.effort`) ...
    contact_penalty : float
        ... minus this where the follower touches something.
    reward : callable, optional
        ``reward(signals) -> ndarray``, in place of all that: from `Signals` to copies × agents.
    end_on_contact : bool
        Whether an episode ends where an agent touches something.
    end_on_error : float
        Whether an episode ends where the distance error of an agent is larger than this, m; never by default.
    scatter : Scatter, optional
        Random starts; by default every episode starts as the scene does.
    dtype : str
        Of observations, and of the spaces: "float32" or "float64".
    """

    observation: tuple[str, ...] = OBSERVATION
    scales: Mapping[str, float] = field(default_factory=dict)
    bound: float = 10.0
    acceleration: float | None = None
    turn_rate: float | None = None
    residual: bool = False
    samples: int = 1
    distance_weight: float = 1.0
    bearing_weight: float = 1.0
    effort_weight: float = 0.01
    contact_penalty: float = 10.0
    reward: Callable[[Signals], NDArray[np.float64]] | None = None
    end_on_contact: bool = True
    end_on_error: float = np.inf
    scatter: Scatter | None = None
    dtype: str = "float32"

    def __post_init__(self) -> None:
        if isinstance(self.observation, str) or not self.observation:
            raise ValueError("observation is a tuple of names, one at least")
        positive = {name: getattr(self, name) for name in ("bound", "samples", "end_on_error")}
        positive |= {name: value for name in ("acceleration", "turn_rate") if (value := getattr(self, name)) is not None}
        positive |= {f"scales[{name!r}]": value for name, value in self.scales.items()}
        for name, value in positive.items():
            if not value > 0:
                raise ValueError(f"{name} is a positive number, not {value!r}")
        if not np.isfinite(self.bound):
            raise ValueError("bound is finite: the spaces of observations are")
        if not (self.reward is None or callable(self.reward)):
            raise TypeError(f"reward is a function of signals, not {self.reward!r}")
        if self.dtype not in ("float32", "float64"):
            raise ValueError(f'dtype is "float32" or "float64", not {self.dtype!r}')
        unknown = set(self.scales) - set(self.observation)
        if unknown:
            raise ValueError(f"scales are of what is observed: `{sorted(unknown)[0]}` is not")

    def rewards(self, signals: Signals) -> NDArray[np.float64]:
        """Rewards of a step, copies × agents."""
        if self.reward is not None:
            rewards = np.asarray(self.reward(signals), dtype=np.float64)
            if rewards.shape != signals.touches.shape:
                raise ValueError(f"a reward has the shape of the signals, {signals.touches.shape}, not {rewards.shape}")
            return rewards
        cost = self.distance_weight * np.abs(signals.error_distance_m)
        cost += self.bearing_weight * np.abs(signals.error_bearing_rad)
        cost += self.effort_weight * signals.effort
        return -signals.interval * cost - self.contact_penalty * signals.touches

    def columns(self, scene: dict[str, Any]) -> list[tuple[str, float, float]]:
        """Name, scale and bound of every number of an observation of a scene."""
        robots = scene["robots"]
        length = max([robot["distance"] for robot in robots if robot.get("distance")], default=1.0)
        speed = max(robot["vehicle"]["speed_max"] for robot in robots)
        rate = speed / length
        units = {"m": length, "m/s": speed, "m/s²": speed * rate, "rad": 1.0, "rad/s": rate, "rad/s²": rate * rate,
                 "s": scene["time"]["duration"]}
        return [(name, float(self.scales.get(name, units.get(_UNITS.get(name, ""), 1.0))), self.bound)
                for name in self.observation]

    def action_scale(self, robot: dict[str, Any]) -> tuple[float, float]:
        """What an action of 1 is for a robot of a scene: acceleration, m/s², and turn rate, rad/s."""
        vehicle = robot["vehicle"]
        top = vehicle["speed_max"]
        acceleration = self.acceleration or vehicle.get("acceleration_max", np.inf)
        turn_rate = self.turn_rate or vehicle.get("turn_rate_max", np.inf)
        if not np.isfinite(acceleration):
            acceleration = top / _TOP_SPEED_WITHIN
        if not np.isfinite(turn_rate):
            # A steered vehicle on its tightest bend.
            turn_rate = top * np.tan(vehicle["steering_max"]) / vehicle["wheelbase"]
        return float(acceleration), float(turn_rate)
