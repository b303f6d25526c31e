"""Laws as policies: what learning is compared with."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._echelon import Scene
from .._law import Law, Observations
from ._core import Core


class LawPolicy:
    """A law as a policy of an environment: calling it gives the actions of this moment.

    Parameters
    ----------
    law : Law or callable
        ``law(observations, time, memory) -> commands``, as for `Scene.run`; it knows ``"output"``. In a `FormationVectorEnv` it
        is told the followers of all copies, one copy after the other, and `Observations.index` has their places among the
        followers of their copy. `time` is that of the first copy.
    env : FormationEnv, FormationVectorEnv or FormationParallelEnv
        Not residual. What its law asks for is cut at what an action of 1 is.

    Notes
    -----
    A law that keeps a memory from sample to sample keeps it across episodes, too; `Observations.meets` is true where one begins.
    """

    def __init__(self, law: Law | Callable[..., Any], env: Any) -> None:
        self.law = law if isinstance(law, Law) else Law(law)
        self.env = env.unwrapped
        core: Core = self.env.core
        if self.law.knows != "output":
            raise ValueError(f'a policy knows "output"; this law knows "{self.law.knows}"')
        if core.task.residual:
            raise ValueError("the actions of this environment are added to its laws: a law as a policy takes their place")
        self.memory = copy.deepcopy(self.law.memory)
        self._names = list(core.agents) * core.count
        self._index = np.tile(np.arange(len(core.agents)), core.count)

    def commands(self) -> NDArray[np.float64]:
        """What the law asks for, copies × followers × 2: acceleration, m/s², and turn rate, rad/s."""
        core: Core = self.env.core
        numbers = core.copies.told().reshape(-1, len(self._names))
        meets = np.repeat(core.fresh, len(core.agents))
        told = Observations(numbers, self._names, self._index, meets, core.scene.period, self.law.knows)
        asked = np.asarray(self.law.function(told, float(numbers[0, 0]), self.memory), dtype=np.float64)
        return asked.reshape(core.count, len(core.agents), 2)

    def __call__(self, observation: Any = None) -> Any:
        """The actions of this moment, in the shape that the environment takes; `observation` is not looked at."""
        core: Core = self.env.core
        actions = (self.commands() / core.scale).clip(-1.0, 1.0)
        if hasattr(self.env, "possible_agents"):
            return dict(zip(core.agents, actions[0]))
        return actions.reshape(self.env.action_space.shape)


def output_feedback(
    scene: Scene, *, k: Any = None, beta: Any = None, slope: Any = None
) -> Callable[[Observations, float, dict[str, Any]], NDArray[np.float64]]:
    """The paper's output feedback law (eq 42) in NumPy.

    Parameters
    ----------
    scene : Scene
        Whose gains it has.
    k, beta, slope : array, optional
        Other gains, (2,), (followers, 2), or (copies · followers, 2): K in 1/s, β in m/s² and rad/s², κ in 1/m and 1/rad, each
        for distance and bearing.

    Returns
    -------
    callable
        A law, as `Scene.run` and `LawPolicy` take it.
    """
    robots = {robot["name"]: robot for robot in scene.to_dict()["robots"]}
    own = [robots[name]["law"] for name in scene.followers]

    def gains(name: str, other: Any) -> NDArray[np.float64]:
        values = np.array([law[name] for law in own]) if other is None else np.asarray(other, dtype=np.float64)
        return np.broadcast_to(values, (len(own), 2)) if values.ndim == 1 else values

    k, beta, slope = gains("k", k), gains("beta", beta), gains("slope", slope)

    def law(told: Observations, time: float, memory: dict[str, Any]) -> NDArray[np.float64]:
        leader, wanted, v = told.leader, told.wanted, told.own.speed
        pick = lambda gain: gain if len(gain) == len(told) else gain[told.index]
        turned = wanted.bearing - leader.bearing
        error = np.column_stack((wanted.distance - leader.distance, np.arctan2(np.sin(turned), np.cos(turned))))
        rates = np.column_stack((wanted.distance_rate - leader.distance_rate, wanted.bearing_rate - leader.bearing_rate))
        sin, cos = np.sin(leader.view_angle), np.cos(leader.view_angle)
        turn = v / leader.distance
        column = np.column_stack((turn * cos, -2 * turn * sin / leader.distance))
        b = np.column_stack((wanted.distance_acceleration - turn * v, wanted.bearing_acceleration))
        b += column * leader.distance_rate[:, None]
        b += 2 * pick(k) * rates + pick(k) ** 2 * error + pick(beta) * np.tanh(pick(slope) * error)
        across = leader.distance * b[:, 1]
        return np.column_stack((cos * b[:, 0] - sin * across, (sin * b[:, 0] + cos * across) / v))

    law.__name__ = "output feedback"
    return law
