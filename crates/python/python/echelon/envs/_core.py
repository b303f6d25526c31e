"""What all environments share: copies of a scene, their seeds, and how a step is judged."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from .._echelon import Copies, Scene
from .._errors import ActionError
from ._task import Signals, Task

# How copies go on, as `Copies.step` says it.
_RUNNING, _STOPPED = 1, 3
_WHY = {0: "has not begun: call reset() first", 2: "has come to its end: call reset()",
        3: "has stopped at a contact: call reset()"}
# Seeds are drawn from as many.
_SEEDS = 2**63


class Step(NamedTuple):
    """What a step of all copies comes to."""

    observations: NDArray[Any]
    """Copies × agents × numbers."""
    rewards: NDArray[np.float64]
    """Copies × agents."""
    terminated: NDArray[np.bool_]
    """Per copy."""
    truncated: NDArray[np.bool_]
    """Per copy."""
    signals: Signals


class Core:
    """Copies of a scene with a task; `numbered` where errors say which copy they are of."""

    def __init__(
        self,
        scene: Scene | str | os.PathLike[str] | Mapping[str, Any],
        task: Task | None,
        copies: int,
        followers: str | Iterable[str] | None,
        render_mode: str | None,
        view: str | None,
        size: Sequence[int] | str | None,
        threads: int | None = None,
        adapter: str = "auto",
        numbered: bool = False,
    ) -> None:
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f'render_mode is None or "rgb_array", not {render_mode!r}: there is no window')
        if not (task is None or isinstance(task, Task)):
            raise TypeError(f"`task` is an echelon.envs.Task, not {task!r}: name other arguments, as in num_envs=64")
        self.scene = scene if isinstance(scene, Scene) else Scene.load(scene)
        self.task = task or Task()
        everything = self.scene.to_dict()
        if everything["time"]["mode"] == "continuous":
            raise ValueError('actions are taken at samples: set time.mode to "sampled"')
        self.agents = _agents(self.scene, followers)
        robots = {robot["name"]: robot for robot in everything["robots"]}
        columns = self.task.columns(everything)
        scale = [self.task.action_scale(robots[name]) for name in self.agents]
        scatter = self.task.scatter
        scattered: list[str] = []
        if scatter is not None:
            scattered = list(self.scene.followers if scatter.robots is None else scatter.robots)
        self.count = copies
        self.scale = np.array(scale)
        self.interval = self.scene.period * self.task.samples
        self.copies = Copies(
            self.scene, copies, agents=self.agents, columns=columns, scale=scale, residual=self.task.residual,
            samples=self.task.samples, scattered=scattered,
            scatter=(scatter.position, scatter.heading) if scatter else (0.0, 0.0),
            drawn=render_mode is not None, threads=threads, adapter=adapter, numbered=numbered)
        self._numbered = numbered
        self._view, self._size = view, size
        if render_mode is not None:
            self.copies.prepare(view, size)
        self._render_mode = render_mode
        self._seeds: list[int | None] = [None] * copies
        self._numbers = [0] * copies
        self.progress = np.zeros(copies, dtype=np.uint8)
        self.ended = np.zeros(copies, dtype=np.bool_)
        self.fresh = np.ones(copies, dtype=np.bool_)
        self.dtype = np.dtype(self.task.dtype)
        self._idle = np.zeros(copies, dtype=np.bool_)

    def observation_box(self, shape: tuple[int, ...]) -> spaces.Box:
        """The space of observations of that shape."""
        bound = self.task.bound
        return spaces.Box(-bound, bound, shape, self.dtype.type)

    def action_box(self, shape: tuple[int, ...]) -> spaces.Box:
        """The space of actions of that shape."""
        return spaces.Box(-1.0, 1.0, shape, self.dtype.type)

    def reset(self, mask: NDArray[np.bool_], seeds: Sequence[int | None], drawn: np.random.Generator) -> None:
        """Begins an episode in the copies of `mask`, with new seeds where there are some; `drawn` makes up those that miss."""
        for copy in np.flatnonzero(mask).tolist():
            if (seed := seeds[copy]) is not None:
                self._seeds[copy], self._numbers[copy] = int(seed), 0
            elif self._seeds[copy] is None:
                self._seeds[copy], self._numbers[copy] = int(drawn.integers(_SEEDS)), 0
            else:
                self._numbers[copy] += 1
        self.copies.reset([seed if reset else None for seed, reset in zip(self._seeds, mask)], self._numbers)
        self.progress[mask] = _RUNNING
        self.ended[mask] = False
        self.fresh[mask] = True

    def observe(self) -> NDArray[Any]:
        """What all agents observe, copies × agents × numbers."""
        return self.copies.observe()[0].astype(self.dtype, copy=False)

    def step(self, actions: Any, idle: NDArray[np.bool_] | None = None) -> Step:
        """Drives the copies on that are not `idle` by one action, copies × agents × 2."""
        idle = self._idle if idle is None else idle
        if (self.ended & ~idle).any() or (self.progress != _RUNNING).any():
            self._refuse(idle)
        observations, numbers, self.progress = self.copies.step(self._actions(actions), idle)
        self.fresh &= idle
        signals = Signals(numbers, self.scale, self.interval)
        rewards = self._rewards(signals)
        terminated = self.progress == _STOPPED
        if self.task.end_on_contact:
            terminated |= signals.touches.any(axis=-1)
        if np.isfinite(self.task.end_on_error):
            terminated |= (np.abs(signals.error_distance_m) > self.task.end_on_error).any(axis=-1)
        truncated = (self.progress != _RUNNING) & ~terminated
        if idle.any():
            rewards[idle], terminated[idle], truncated[idle] = 0.0, False, False
        self.ended = terminated | truncated
        return Step(observations.astype(self.dtype, copy=False), rewards, terminated, truncated, signals)

    def _rewards(self, signals: Signals) -> NDArray[np.float64]:
        rewards = self.task.rewards(signals)
        if not np.isfinite(rewards).all():
            copy, agent = (int(index) for index in np.argwhere(~np.isfinite(rewards))[0])
            raise ValueError(f"{self._of(copy)}the reward of `{self.agents[agent]}` is {rewards[copy, agent]}: it has to be a number")
        return rewards

    def _of(self, copy: int) -> str:
        """What an error of a copy begins with."""
        return f"copy {copy}: " if self._numbered else ""

    def _actions(self, actions: Any) -> NDArray[np.float64]:
        shape = (self.count, len(self.agents), 2)
        try:
            given = np.ascontiguousarray(actions, dtype=np.float64)
            return given.reshape(shape)
        except (TypeError, ValueError):
            raise ActionError(f"actions are {_shape(actions)}; they are numbers of the shape {self._wanted()}: acceleration and "
                              "turn rate of each follower") from None

    def _wanted(self) -> tuple[int, ...]:
        """The shape of actions, as whoever gives them sees it."""
        numbers = 2 * len(self.agents)
        return (self.count, numbers) if self._numbered else (numbers,)

    def _refuse(self, idle: NDArray[np.bool_]) -> None:
        for copy in np.flatnonzero(~idle).tolist():
            progress = int(self.progress[copy])
            if progress != _RUNNING:
                raise ResetNeeded(f"{self._of(copy)}the episode {_WHY[progress]}")
            if self.ended[copy]:
                raise ResetNeeded(f"{self._of(copy)}the episode {_WHY[2]}")

    def why(self, step: Step, copy: int) -> str | None:
        """What ended the episode of a copy; None where it goes on."""
        if step.truncated[copy]:
            return "time is up"
        if not step.terminated[copy]:
            return None
        touching = [name for name, touches in zip(self.agents, step.signals.touches[copy]) if touches]
        return f"{', '.join(touching)} touched something" if touching else "an error is too large"

    def render(self, copy: int) -> NDArray[np.uint8]:
        """A picture of a copy."""
        if not self.progress[copy]:
            raise ResetNeeded(f"{self._of(copy)}the episode {_WHY[0]}")
        return self.copies.render(copy, self._view, self._size)

    @property
    def fps(self) -> float:
        """Actions per second of simulation time."""
        return 1.0 / self.interval


def _shape(actions: Any) -> str:
    """What an error says of actions that do not fit."""
    try:
        return str(np.shape(actions)) if isinstance(actions, (np.ndarray, Sequence)) and not isinstance(actions, str) \
            else type(actions).__name__
    except ValueError:
        return "rows of several lengths"


def _agents(scene: Scene, followers: str | Iterable[str] | None) -> list[str]:
    if followers is None:
        names = scene.followers
    else:
        names = [followers] if isinstance(followers, str) else list(followers)
    if not names:
        raise ValueError("nobody follows: there is no agent")
    for name in names:
        if name not in scene.followers:
            raise ValueError(f"there is no follower called `{name}`: the followers are {', '.join(scene.followers)}")
    return names
