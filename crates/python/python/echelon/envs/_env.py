"""One agent for all followers of a scene, or for some."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from .._echelon import Scene
from ._core import Core
from ._task import Task


class FormationEnv(gymnasium.Env[NDArray[Any], NDArray[Any]]):
    """A Gymnasium environment with one agent for all followers of a scene, or for some.

    Parameters
    ----------
    scene : Scene, path, str or dict
        The scene, or what `Scene.load` takes.
    task : Task, optional
        What is observed, done and rewarded.
    followers : str or iterable of str, optional
        Whom the agent drives; all followers by default. The others keep the laws of the scene.
    render_mode : {None, "rgb_array"}
        ``"rgb_array"`` for `render`.
    view, size
        Of pictures, as for `Simulation.render`.
    adapter : str, optional
        Graphics adapter for pictures.

    Attributes
    ----------
    observation_space : Box
        (followers · numbers of an observation,), follower by follower.
    action_space : Box
        (followers · 2,), −1 to 1: acceleration and turn rate, follower by follower.

    Notes
    -----
    The reward is the mean over the followers; ``info["rewards"]`` has that of each. ``info["why"]`` says what ended an
    episode. The episode after ``reset(seed=s)`` depends on `s` alone: on the scene's own starts where the task scatters
    none, and on `s` as the seed of the scene. Further ones depend on `s` and on their number.
    """

    metadata = {"render_modes": ["rgb_array"]}

    def __init__(
        self,
        scene: Scene | str | os.PathLike[str] | Mapping[str, Any],
        task: Task | None = None,
        *,
        followers: str | Iterable[str] | None = None,
        render_mode: str | None = None,
        view: str | None = None,
        size: Sequence[int] | str | None = None,
        adapter: str = "auto",
    ) -> None:
        self.core = Core(scene, task, 1, followers, render_mode, view, size, adapter=adapter)
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": self.core.fps}
        agents = len(self.core.agents)
        self.observation_space = self.core.observation_box((agents * len(self.core.task.observation),))
        self.action_space = self.core.action_box((agents * 2,))

    @property
    def followers(self) -> list[str]:
        """Whom the agent drives."""
        return list(self.core.agents)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[NDArray[Any], dict[str, Any]]:
        """Begins an episode.

        Parameters
        ----------
        seed : int, optional
            For this episode and those that follow.
        options : dict, optional
            None is known.

        Returns
        -------
        observation : ndarray
        info : dict
        """
        super().reset(seed=seed)
        self.core.reset(np.ones(1, dtype=np.bool_), [seed], self.np_random)
        return self.core.observe().reshape(-1), {}

    def step(self, action: Any) -> tuple[NDArray[Any], float, bool, bool, dict[str, Any]]:
        """Drives on by one action.

        Raises
        ------
        ActionError
            Where the action has another shape or is not finite; the follower is named.
        gymnasium.error.ResetNeeded
            Where the episode has ended or has not begun.
        """
        step = self.core.step(action)
        info: dict[str, Any] = {"rewards": step.rewards[0]}
        if step.terminated[0] or step.truncated[0]:
            info["why"] = self.core.why(step, 0)
        reward = float(step.rewards[0].mean())
        return step.observations.reshape(-1), reward, bool(step.terminated[0]), bool(step.truncated[0]), info

    def render(self) -> NDArray[np.uint8] | None:
        """A picture of this moment, height × width × 3; None without ``render_mode="rgb_array"``."""
        return None if self.render_mode is None else self.core.render(0)

    @property
    def digest(self) -> str:
        """Of the trajectory of this episode."""
        return self.core.copies.digests[0]
