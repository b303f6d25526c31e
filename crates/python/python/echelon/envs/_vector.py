"""Many copies of a scene, stepped in Rust on all cores."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from .._echelon import Scene
from ._core import Core, Step
from ._task import Task


class FormationVectorEnv(VectorEnv[NDArray[Any], NDArray[Any], NDArray[Any]]):
    """A Gymnasium vector environment: many copies of a `FormationEnv`, stepped in Rust on all cores.

    Copy i after ``reset(seed=s)`` comes to the same, bit for bit, as a `FormationEnv` after ``reset(seed=s + i)``, whatever the
    number of copies and threads.

    Parameters
    ----------
    scene, task, followers, render_mode, view, size, adapter
        As for `FormationEnv`.
    num_envs : int
        Number of copies.
    autoreset_mode : AutoresetMode or str
        When a copy that has ended begins its next episode: at the next step, whose action it ignores; at the same step, where
        ``infos["final_obs"]`` has the last observation; or when `reset` is called with ``options={"reset_mask": …}``.
    threads : int, optional
        Threads that share the work; one per processor by default.

    Notes
    -----
    ``infos["rewards"]`` has the rewards of all followers, copies × followers.
    """

    metadata = {"render_modes": ["rgb_array"], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        scene: Scene | str | os.PathLike[str] | Mapping[str, Any],
        task: Task | None = None,
        num_envs: int = 1,
        *,
        followers: str | Iterable[str] | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        render_mode: str | None = None,
        view: str | None = None,
        size: Sequence[int] | str | None = None,
        threads: int | None = None,
        adapter: str = "auto",
    ) -> None:
        if not (isinstance(num_envs, (int, np.integer)) and num_envs > 0):
            raise ValueError(f"num_envs is a number of copies from 1 on, not {num_envs!r}")
        self.core = Core(scene, task, int(num_envs), followers, render_mode, view, size, threads, adapter, numbered=True)
        self.num_envs, self.render_mode = num_envs, render_mode
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {**self.metadata, "render_fps": self.core.fps, "autoreset_mode": self.autoreset_mode}
        agents = len(self.core.agents)
        self.single_observation_space = self.core.observation_box((agents * len(self.core.task.observation),))
        self.single_action_space = self.core.action_box((agents * 2,))
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    @property
    def followers(self) -> list[str]:
        """Whom the agent drives in each copy."""
        return list(self.core.agents)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[Any], dict[str, Any]]:
        """Begins an episode in all copies, or in some.

        Parameters
        ----------
        seed : int or list, optional
            Copy i gets ``seed + i``, or its own of a list.
        options : dict, optional
            ``"reset_mask"``: an array of bool, the copies to begin anew.

        Returns
        -------
        observations : ndarray
            Copies × (followers · numbers).
        infos : dict
        """
        super().reset(seed=seed if isinstance(seed, int) else None)
        if seed is None:
            seeds: Sequence[int | None] = [None] * self.num_envs
        elif isinstance(seed, (int, np.integer)):
            seeds = [int(seed) + copy for copy in range(self.num_envs)]
        else:
            seeds = seed
        if len(seeds) != self.num_envs:
            raise ValueError(f"there are {self.num_envs} copies and {len(seeds)} seeds")
        self.core.reset(_mask(options, self.num_envs), seeds, self.np_random)
        return self._flat(self.core.observe()), {}

    def step(
        self, actions: Any
    ) -> tuple[NDArray[Any], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Drives all copies on by one action, copies × (followers · 2).

        Raises
        ------
        ActionError
            Where actions have another shape or are not finite; copy and follower are named.
        gymnasium.error.ResetNeeded
            Where an episode has ended or has not begun.
        """
        core, idle = self.core, None
        if self.autoreset_mode == AutoresetMode.NEXT_STEP and core.ended.any():
            idle = core.ended.copy()
            core.reset(idle, [None] * self.num_envs, self.np_random)
        step = core.step(actions, idle)
        infos: dict[str, Any] = {"rewards": step.rewards, "_rewards": np.ones(self.num_envs, dtype=np.bool_)}
        observations = self._flat(step.observations)
        if self.autoreset_mode == AutoresetMode.SAME_STEP and core.ended.any():
            observations = self._begin_anew(step, observations, infos)
        return observations, step.rewards.mean(axis=-1), step.terminated, step.truncated, infos

    def _begin_anew(self, step: Step, last: NDArray[Any], infos: dict[str, Any]) -> NDArray[Any]:
        """Begins the next episode of the copies that have ended; returns what all observe then."""
        ended = self.core.ended.copy()
        infos["final_obs"], infos["_final_obs"] = np.full(self.num_envs, None, dtype=object), ended
        why = np.full(self.num_envs, None, dtype=object)
        for copy in np.flatnonzero(ended).tolist():
            infos["final_obs"][copy] = last[copy].copy()
            why[copy] = self.core.why(step, copy)
        infos["final_info"] = {"rewards": step.rewards.copy(), "_rewards": ended, "why": why, "_why": ended}
        infos["_final_info"] = ended
        self.core.reset(ended, [None] * self.num_envs, self.np_random)
        return self._flat(self.core.observe())

    def _flat(self, observations: NDArray[Any]) -> NDArray[Any]:
        return observations.reshape(self.num_envs, -1)

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """A picture of every copy; None without ``render_mode="rgb_array"``."""
        return None if self.render_mode is None else tuple(self.core.render(copy) for copy in range(self.num_envs))

    @property
    def digests(self) -> list[str]:
        """Of the trajectories of the episodes of all copies."""
        return self.core.copies.digests


def _mask(options: dict[str, Any] | None, count: int) -> NDArray[np.bool_]:
    if options is None or "reset_mask" not in options:
        return np.ones(count, dtype=np.bool_)
    mask = options["reset_mask"]
    if not isinstance(mask, np.ndarray) or mask.shape != (count,) or mask.dtype != np.bool_ or not mask.any():
        raise ValueError(f'options["reset_mask"] is an array of {count} bool, one of them True')
    return mask
