"""Every follower of a scene an agent."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.error import ResetNeeded
from gymnasium.utils import seeding
from numpy.typing import NDArray
from pettingzoo import ParallelEnv  # type: ignore[import-untyped]

from .._echelon import Scene
from .._errors import ActionError
from ._core import Core
from ._task import Task


class FormationParallelEnv(ParallelEnv[str, NDArray[Any], NDArray[Any]]):
    """A PettingZoo environment in which every follower of a scene is an agent, or some are.

    Parameters
    ----------
    scene, task, render_mode, view, size, adapter
        As for `FormationEnv`.
    followers : str or iterable of str, optional
        Who are agents; all followers by default. The others keep the laws of the scene.

    Notes
    -----
    An agent's observation is an array of (numbers of an observation,), its action one of (2,): acceleration and turn rate,
    −1 to 1. An episode ends for all agents together; ``infos[agent]["why"]`` says what ended it. `state` is what all agents
    observe, agents × numbers.
    """

    metadata = {"render_modes": ["rgb_array"], "name": "echelon_formation_v0", "is_parallelizable": True}

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
        self.possible_agents = list(self.core.agents)
        self.agents: list[str] = []
        numbers = (len(self.core.task.observation),)
        self.observation_spaces = {agent: self.core.observation_box(numbers) for agent in self.possible_agents}
        self.action_spaces = {agent: self.core.action_box((2,)) for agent in self.possible_agents}
        self._random: np.random.Generator | None = None

    def observation_space(self, agent: str) -> spaces.Box:
        """The space of an agent's observations."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Box:
        """The space of an agent's actions."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[Any]], dict[str, dict[str, Any]]]:
        """Begins an episode; see `FormationEnv.reset`."""
        if seed is not None or self._random is None:
            self._random = seeding.np_random(seed)[0]
        self.core.reset(np.ones(1, dtype=np.bool_), [seed], self._random)
        self.agents = list(self.possible_agents)
        return dict(zip(self.agents, self.core.observe()[0])), {agent: {} for agent in self.agents}

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        dict[str, NDArray[Any]], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]
    ]:
        """Drives on by one action of every agent.

        Raises
        ------
        ActionError
            Where an agent has no action, or one that has another shape or is not finite; it is named.
        gymnasium.error.ResetNeeded
            Where the episode has ended or has not begun.
        """
        agents = self.agents
        if not agents:
            raise ResetNeeded("there is no agent: the episode has ended or has not begun; call reset()")
        step = self.core.step(self._together(actions))
        terminated, truncated = bool(step.terminated[0]), bool(step.truncated[0])
        why = {"why": self.core.why(step, 0)} if terminated or truncated else {}
        if why:
            self.agents = []
        return (
            dict(zip(agents, step.observations[0])),
            dict(zip(agents, step.rewards[0].tolist())),
            dict.fromkeys(agents, terminated),
            dict.fromkeys(agents, truncated),
            {agent: dict(why) for agent in agents},
        )

    def _together(self, actions: Mapping[str, Any]) -> NDArray[np.float64]:
        """The actions of all agents, 1 × agents × 2."""
        together = np.empty((1, len(self.agents), 2))
        for index, agent in enumerate(self.agents):
            if agent not in actions:
                raise ActionError(f"`{agent}` has no action: every agent has one")
            try:
                together[0, index] = actions[agent]
            except (TypeError, ValueError):
                raise ActionError(f"the action of `{agent}` is two numbers, acceleration and turn rate, and not of the shape "
                                  f"{np.shape(actions[agent])}") from None
        unknown = [agent for agent in actions if agent not in self.action_spaces]
        if unknown:
            raise ActionError(f"there is no agent `{unknown[0]}`: the agents are {', '.join(self.agents)}")
        return together

    def state(self) -> NDArray[Any]:
        """What all agents observe, agents × numbers."""
        return self.core.observe()[0]

    def render(self) -> NDArray[np.uint8] | None:
        """A picture of this moment, height × width × 3; None without ``render_mode="rgb_array"``."""
        return None if self.render_mode is None else self.core.render(0)

    def close(self) -> None:
        """Nothing is left open."""

    @property
    def digest(self) -> str:
        """Of the trajectory of this episode."""
        return self.core.copies.digests[0]
