"""Environments for learning: every follower of a scene, or some of them, driven by actions.

`FormationParallelEnv` is a PettingZoo ``ParallelEnv`` in which each follower is an agent. `FormationEnv` is a Gymnasium ``Env``
with one agent for all followers or for some, and `FormationVectorEnv` a ``VectorEnv`` of many copies, which Rust steps on all
cores. A `Task` declares what agents observe, what actions mean, what is rewarded and what ends an episode; it goes for all three.

>>> from echelon.envs import FormationEnv
>>> env = FormationEnv("seven-v")
>>> observation, info = env.reset(seed=1)

Gymnasium makes them by name, too: ``gymnasium.make("echelon/Formation-v0", scene="seven-v")``, and
``gymnasium.make_vec("echelon/Formation-v0", num_envs=64, vectorization_mode="vector_entry_point", scene="seven-v")``.

They need the extra ``echelon[envs]``.
"""

try:
    import gymnasium as _gymnasium
    import pettingzoo as _pettingzoo  # type: ignore[import-untyped]  # noqa: F401
except ImportError as error:
    raise ImportError('echelon.envs needs gymnasium and pettingzoo: pip install "echelon[envs]"') from error

from .._errors import ActionError
from ._env import FormationEnv
from ._parallel import FormationParallelEnv
from ._policy import LawPolicy, output_feedback
from ._task import OBSERVATION, Scatter, Signals, Task
from ._vector import FormationVectorEnv
from ._video import RecordVideo

__all__ = [
    "OBSERVATION",
    "ActionError",
    "FormationEnv",
    "FormationParallelEnv",
    "FormationVectorEnv",
    "LawPolicy",
    "RecordVideo",
    "Scatter",
    "Signals",
    "Task",
    "output_feedback",
]

_NAME = "echelon/Formation-v0"
if _NAME not in _gymnasium.registry:
    _gymnasium.register(
        _NAME,
        entry_point="echelon.envs:FormationEnv",
        vector_entry_point="echelon.envs:FormationVectorEnv",
    )
