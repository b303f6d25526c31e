"""Films of PettingZoo's parallel environments, by Gymnasium's recorder."""

from __future__ import annotations

from typing import Any

import gymnasium
from gymnasium import spaces
from pettingzoo import ParallelEnv  # type: ignore[import-untyped]
from pettingzoo.utils import BaseParallelWrapper  # type: ignore[import-untyped]


class _Together(gymnasium.Env[dict[str, Any], dict[str, Any]]):
    """A parallel environment as one of Gymnasium's, for its wrappers."""

    def __init__(self, env: ParallelEnv[str, Any, Any]) -> None:
        self.env = env
        self.metadata, self.render_mode = env.metadata, env.render_mode
        self.observation_space = spaces.Dict({agent: env.observation_space(agent) for agent in env.possible_agents})
        self.action_space = spaces.Dict({agent: env.action_space(agent) for agent in env.possible_agents})
        self.last: tuple[Any, ...] = ()

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, Any]:
        super().reset(seed=seed)
        return self.env.reset(seed=seed, options=options)

    def step(self, action: dict[str, Any]) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        self.last = self.env.step(action)
        observations, rewards, terminated, truncated, infos = self.last
        return observations, sum(rewards.values()), all(terminated.values()), all(truncated.values()), infos

    def render(self) -> Any:
        return self.env.render()

    def close(self) -> None:
        self.env.close()


class RecordVideo(BaseParallelWrapper):
    """Films episodes of a PettingZoo ``ParallelEnv``; PettingZoo has no recorder of its own.

    Parameters
    ----------
    env : ParallelEnv
        With ``render_mode="rgb_array"``.
    video_folder : str
        Where the films go.
    **options
        Those of `gymnasium.wrappers.RecordVideo`, such as ``episode_trigger`` and ``video_length``.
    """

    def __init__(self, env: ParallelEnv[str, Any, Any], video_folder: str, **options: Any) -> None:
        super().__init__(env)
        self.together = _Together(env)
        self.recorder = gymnasium.wrappers.RecordVideo(self.together, video_folder, **options)

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, Any]:
        """Begins an episode, and its film where it is to have one."""
        return self.recorder.reset(seed=seed, options=options)

    def step(self, actions: dict[str, Any]) -> tuple[Any, Any, Any, Any, Any]:
        """Drives on by one action of every agent."""
        self.recorder.step(actions)
        observations, rewards, terminated, truncated, infos = self.together.last
        return observations, rewards, terminated, truncated, infos

    def close(self) -> None:
        """Finishes the film."""
        self.recorder.close()
