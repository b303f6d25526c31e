"""Environments: what the libraries ask of them, the same on any number of copies and threads, and bad input."""

import importlib.util
import pathlib
import pickle
import warnings

import echelon
import gymnasium
import numpy as np
import pytest
from echelon import EchelonError, RenderingError, Scene, SceneError
from echelon.envs import (
    ActionError,
    FormationEnv,
    FormationParallelEnv,
    FormationVectorEnv,
    LawPolicy,
    RecordVideo,
    Scatter,
    Task,
    output_feedback,
)
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode
from pettingzoo.test import parallel_api_test, parallel_seed_test, render_test
from pettingzoo.utils.conversions import parallel_to_aec

SCENE = Scene.load("seven-v").set({"time.duration": 2, "expect": {}})
SCATTERED = Task(scatter=Scatter())
SMALL = {"view": "top", "size": (160, 90)}


@pytest.fixture(autouse=True)
def strict():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def drive(env, steps, seed=None):
    """What an environment comes to under actions that depend on the step alone."""
    env.reset(seed=seed)
    for step in range(steps):
        action = np.sin(0.1 * step + np.arange(12)) * 0.05
        env.step(np.broadcast_to(action, env.action_space.shape))
    return env


class TestLibraries:
    def test_pettingzoo_finds_no_fault(self):
        parallel_api_test(FormationParallelEnv(SCENE, SCATTERED), num_cycles=300)
        parallel_seed_test(lambda: FormationParallelEnv(SCENE, SCATTERED))
        # It asks for a window before it looks for the modes that there are.
        make = lambda render_mode: parallel_to_aec(
            FormationParallelEnv(SCENE, SCATTERED, render_mode=None if render_mode == "human" else render_mode, **SMALL))
        render_test(make)

    @pytest.mark.parametrize("followers", [None, "robot-3"])
    def test_gymnasium_finds_no_fault(self, followers):
        env = gymnasium.make("echelon/Formation-v0", scene=SCENE, task=SCATTERED, followers=followers)
        check_env(env.unwrapped, skip_render_check=True)
        env = gymnasium.make("echelon/Formation-v0", scene=SCENE, render_mode="rgb_array", **SMALL)
        env.reset(seed=1)
        assert env.render().shape == (90, 160, 3)

    def test_gymnasium_makes_vectors(self):
        envs = gymnasium.make_vec("echelon/Formation-v0", num_envs=3, vectorization_mode="vector_entry_point", scene=SCENE)
        observations, _ = envs.reset(seed=1)
        assert isinstance(envs.unwrapped, FormationVectorEnv) and observations in envs.observation_space


class TestDeterminism:
    def test_copies_and_threads_do_not_count(self):
        count = 40
        alone = [drive(FormationEnv(SCENE, SCATTERED), 30, seed=7 + copy).digest for copy in range(count)]
        assert len(set(alone)) == count
        for copies, threads in [(1, None), (5, 1), (count, 1), (count, 2), (count, 3), (count, None)]:
            envs = FormationVectorEnv(SCENE, SCATTERED, copies, threads=threads)
            assert drive(envs, 30, seed=7).digests == alone[:copies]

    def test_every_episode_depends_on_seed_and_number(self):
        def episodes(count):
            env = FormationEnv(SCENE, SCATTERED)
            return [drive(env, 5, seed=3 if episode == 0 else None).digest for episode in range(count)]

        assert len(set(episodes(4))) == 4 and episodes(4) == episodes(4)

    def test_vector_and_single_environments_go_through_the_same_episodes(self):
        envs, env = FormationVectorEnv(SCENE, SCATTERED, 2), FormationEnv(SCENE, SCATTERED)
        observations, _ = envs.reset(seed=5)
        observation, _ = env.reset(seed=6)
        ends, ended = 0, False
        for _ in range(450):
            assert (observations[1] == observation).all()
            if ended:
                observation, _ = env.reset()
                reward, ended = 0.0, False
                observations, rewards, terminated, truncated, _ = envs.step(np.zeros(envs.action_space.shape))
            else:
                observations, rewards, terminated, truncated, _ = envs.step(np.zeros(envs.action_space.shape))
                observation, reward, over, out, _ = env.step(np.zeros(12))
                ended = over or out
                ends += ended
            assert rewards[1] == pytest.approx(reward, abs=1e-15) and ended == (terminated[1] or truncated[1])
        assert ends >= 2


class TestSpaces:
    @pytest.mark.parametrize("dtype", ["float32", "float64"])
    def test_spaces_are_finite_and_hold_what_is_observed(self, dtype):
        env = FormationEnv("cars-circle-three", Task(dtype=dtype, end_on_contact=False))
        for space in (env.observation_space, env.action_space):
            assert space.dtype == dtype and np.isfinite(space.low).all() and np.isfinite(space.high).all()
        observation, _ = env.reset(seed=0)
        env.action_space.seed(0)
        for _ in range(300):
            assert observation in env.observation_space
            observation, reward, *_ = env.step(env.action_space.sample())
            assert np.isfinite(reward)

    def test_actions_beyond_one_are_cut(self):
        many, one = (FormationVectorEnv(SCENE, Task(), 1) for _ in range(2))
        for envs, action in ((many, 7.0), (one, 1.0)):
            envs.reset(seed=0)
            for _ in range(5):
                envs.step(np.full((1, 12), action))
        assert many.digests == one.digests

    def test_an_action_is_a_share_of_what_the_task_says(self):
        task = Task(acceleration=2.0, turn_rate=0.5, reward=lambda signals: signals.acceleration_m_s2)
        env = FormationEnv(SCENE, task, followers=["robot-2", "robot-5"])
        env.reset(seed=0)
        *_, info = env.step([0.25, 1.0, 0.5, -1.0])
        assert info["rewards"].tolist() == [0.5, 1.0]

    def test_the_residual_of_nothing_is_the_law(self):
        task = Task(residual=True)
        env, sim = FormationEnv(SCENE, task), SCENE.simulation()
        env.reset(seed=SCENE.to_dict().get("seed", 0))
        for _ in range(150):
            env.step(np.zeros(12))
            sim.step()
        signals = env.core.copies.observe()[1][0]
        x, y = echelon.SIGNALS.index("x_m"), echelon.SIGNALS.index("y_m")
        robots = {name: row for name, row in zip(sim.robot_names, sim.robots)}
        for agent, row in zip(env.followers, signals):
            expected = robots[agent][[echelon.ROBOT_COLUMNS.index("x_m"), echelon.ROBOT_COLUMNS.index("y_m")]]
            assert (row[[x, y]] == expected).all()


class TestBaseline:
    # By powers of two scaling rounds nothing, and nothing is cut that the robots do not cut.
    EXACT = Task(acceleration=2.0**20, turn_rate=16.0, dtype="float64", end_on_contact=False)

    def test_the_paper_s_law_as_a_policy_drives_as_the_built_in_law(self):
        scene = Scene.load("circle-three").set({"expect": {}})
        env, sim = FormationEnv(scene, self.EXACT), scene.simulation()
        policy = LawPolicy(output_feedback(scene), env)
        observation, _ = env.reset(seed=0)
        names = ("x_m", "y_m", "heading_rad", "speed_m_s")
        columns = [echelon.ROBOT_COLUMNS.index(name) for name in names]
        own = [echelon.SIGNALS.index(name) for name in names]
        rows = [sim.robot_names.index(agent) for agent in env.followers]
        worst, truncated, steps = 0.0, False, 0
        while not truncated:
            observation, _, terminated, truncated, _ = env.step(policy(observation))
            assert not terminated
            sim.step()
            steps += 1
            at = env.core.copies.observe()[1][0][:, own]
            worst = max(worst, np.abs(at - sim.robots[rows][:, columns]).max())
        assert sim.done and steps == round(scene.duration / scene.period)
        assert worst < 1e-12, worst

    @pytest.mark.parametrize("name", ["seven-v", "law-integral", "cars-circle-three"])
    def test_a_law_as_a_policy_is_that_law_bit_for_bit(self, name):
        scene = Scene.load(name).set({"expect": {}, "time.duration": 3})
        law = output_feedback(scene)
        env, sim = FormationEnv(scene, self.EXACT), scene.simulation(law=law)
        policy, steps = LawPolicy(law, env), round(scene.duration / scene.period)
        env.reset(seed=scene.to_dict().get("seed", 0))
        for _ in range(steps):
            env.step(policy())
        sim.advance((steps - 1) * scene.period)
        assert env.digest == sim.digest

    def test_a_policy_drives_all_copies(self):
        envs = FormationVectorEnv(SCENE, Task(scatter=Scatter(), acceleration=50.0), 3)
        policy = LawPolicy(output_feedback(SCENE), envs)
        observations, _ = envs.reset(seed=1)
        before = np.abs(observations[:, 0])
        for _ in range(190):
            observations, *_ = envs.step(policy(observations))
        assert (np.abs(observations[:, 0]) < before).all()
        # Each with gains of its own.
        gains = np.repeat([1.0, 3.0, 5.0], 6)[:, None] * np.ones(2)
        own = LawPolicy(output_feedback(SCENE, k=gains), envs)
        envs.reset(seed=1)
        assert own().shape == (3, 12)


class TestEndings:
    def test_time_is_up_at_the_end_of_the_scene(self):
        env = FormationEnv(SCENE.set({"time.duration": 0.1}), Task(end_on_contact=False, samples=3))
        env.reset(seed=0)
        ends = [env.step(np.zeros(12))[2:] for _ in range(4)]
        assert [end[:2] for end in ends] == [(False, False)] * 3 + [(False, True)]
        assert ends[-1][2]["why"] == "time is up"
        with pytest.raises(ResetNeeded, match="come to its end"):
            env.step(np.zeros(12))

    def test_contact_and_error_end_an_episode(self):
        close = SCENE.set({"robots.robot-2.pose": [-0.5, 0, 0]})
        env = FormationEnv(close, Task())
        env.reset(seed=0)
        for _ in range(200):
            *_, reward, terminated, truncated, info = env.step(np.tile([1.0, 0.0], 6))
            if terminated:
                break
        assert "robot-2" in info["why"] and info["rewards"][0] < -10.0
        env = FormationEnv(SCENE, Task(end_on_error=1e-9))
        env.reset(seed=0)
        *_, terminated, truncated, info = env.step(np.zeros(12))
        assert terminated and not truncated and info["why"] == "an error is too large"
        with pytest.raises(ResetNeeded):
            env.step(np.zeros(12))
        env.reset()
        env.step(np.zeros(12))

    def test_a_parallel_episode_ends_for_all(self):
        env = FormationParallelEnv(SCENE.set({"time.duration": 0.01}))
        env.reset(seed=0)
        *_, truncated, infos = env.step(dict.fromkeys(env.agents, np.zeros(2)))
        assert all(truncated.values()) and not env.agents and infos["robot-2"]["why"] == "time is up"
        with pytest.raises(ResetNeeded):
            env.step({})

    def test_autoreset_begins_those_anew_that_have_ended(self):
        scene, zero = SCENE.set({"time.duration": 0.03}), np.zeros((2, 12))
        make = lambda mode: FormationVectorEnv(scene, SCATTERED, 2, autoreset_mode=mode)
        envs = make(AutoresetMode.SAME_STEP)
        first, _ = envs.reset(seed=1)
        for _ in range(2):
            envs.step(zero)
        same, _, _, truncated, infos = envs.step(zero)
        assert truncated.all() and infos["_final_obs"].all() and infos["final_info"]["why"][0] == "time is up"
        assert not (same == first).all() and (np.stack(infos["final_obs"]) != same).any()

        envs = make("NextStep")
        envs.reset(seed=1)
        for _ in range(3):
            observations, _, _, truncated, _ = envs.step(zero)
        assert truncated.all() and (observations == np.stack(infos["final_obs"])).all()
        observations, rewards, _, truncated, _ = envs.step(zero)
        assert not truncated.any() and (rewards == 0).all() and (observations == same).all()

        envs = make("Disabled")
        envs.reset(seed=1)
        for _ in range(3):
            envs.step(zero)
        with pytest.raises(ResetNeeded, match="copy 0"):
            envs.step(zero)
        ended = envs.digests
        envs.reset(options={"reset_mask": np.array([False, True])})
        with pytest.raises(ResetNeeded, match="copy 0"):
            envs.step(zero)
        envs.reset(options={"reset_mask": np.array([True, False])})
        envs.step(zero)
        assert ended != envs.digests


class TestBadInput:
    def test_actions_name_who_they_are_of(self):
        env = FormationEnv(SCENE)
        env.reset(seed=0)
        action = np.zeros(12)
        action[3] = np.nan
        with pytest.raises(ActionError, match="^the turn rate of `robot-3` is NaN"):
            env.step(action)
        with pytest.raises(ActionError, match=r"actions are \(5,\); they are numbers of the shape \(12,\): acc"):
            env.step(np.zeros(5))
        with pytest.raises(ActionError):
            env.step("left")
        env.step(np.zeros(12))
        envs = FormationVectorEnv(SCENE, num_envs=2)
        envs.reset(seed=0)
        actions = np.zeros((2, 12))
        actions[1, 0] = np.inf
        with pytest.raises(ActionError, match="^copy 1: the acceleration of `robot-2` is inf"):
            envs.step(actions)
        with pytest.raises(ActionError, match=r"actions are \(12,\); they are numbers of the shape \(2, 12\)"):
            envs.step(np.zeros(12))
        parallel = FormationParallelEnv(SCENE)
        parallel.reset(seed=0)
        actions = dict.fromkeys(parallel.agents, np.zeros(2))
        with pytest.raises(ActionError, match="`robot-4` has no action"):
            parallel.step({agent: action for agent, action in actions.items() if agent != "robot-4"})
        with pytest.raises(ActionError, match="`robot-2`.*shape"):
            parallel.step(actions | {"robot-2": np.zeros(3)})
        with pytest.raises(ActionError, match="`robot-6`"):
            parallel.step(actions | {"robot-6": np.array([np.nan, 0])})
        with pytest.raises(ActionError, match="no agent `zoe`"):
            parallel.step(actions | {"zoe": np.zeros(2)})

    def test_a_step_needs_a_reset(self):
        for env, action in ((FormationEnv(SCENE), np.zeros(12)), (FormationVectorEnv(SCENE), np.zeros((1, 12))),
                            (FormationParallelEnv(SCENE), {})):
            with pytest.raises(ResetNeeded, match="reset"):
                env.step(action)
        with pytest.raises(EchelonError):
            FormationEnv(SCENE).core.observe()

    def test_an_environment_alone_does_not_speak_of_copies(self):
        task = Task(samples=10, reward=lambda signals: signals.effort * (np.nan if signals.x_m[0, 0] > 0.05 else 1.0))
        short = SCENE.set({"time.duration": 0.1})
        drawn = FormationEnv(SCENE, render_mode="rgb_array", size=(64, 48))
        ended, rewarded = FormationEnv(short, Task(samples=10)), FormationEnv(SCENE, task)
        zero = np.zeros(12)
        for env in (drawn, ended, rewarded):
            if env is not drawn:
                env.reset(seed=0)
        for fails in (lambda: drawn.step(zero), drawn.render, lambda: drawn.core.observe(), lambda: drawn.core.copies.told(),
                      lambda: [ended.step(zero) for _ in range(20)], lambda: ended.step(np.zeros(3)),
                      lambda: ended.step({}), lambda: ended.step([[1], [2, 3]]), lambda: [rewarded.step(zero) for _ in range(99)]):
            with pytest.raises((EchelonError, ResetNeeded, ValueError)) as caught:
                fails()
            assert "cop" not in str(caught.value), caught.value

    def test_what_cannot_draw_is_said_where_it_is_made(self):
        for make in (FormationEnv, FormationParallelEnv, FormationVectorEnv):
            with pytest.raises(RenderingError, match="no such adapter"):
                make(SCENE, render_mode="rgb_array", adapter="no such adapter")
            with pytest.raises(ValueError, match="sideways"):
                make(SCENE, render_mode="rgb_array", view="sideways")
            with pytest.raises(ValueError, match="size is width and height"):
                make(SCENE, render_mode="rgb_array", size=(64,))
            # Nothing is drawn without it.
            make(SCENE, adapter="no such adapter")
            env = make(SCENE, render_mode="rgb_array", size="64x48")
            env.reset(seed=0)
            assert np.shape(env.render())[-3:] == (48, 64, 3)
        with pytest.raises(TypeError, match="^an environment cannot be pickled.*in the process that uses it"):
            pickle.dumps(FormationEnv(SCENE))

    @pytest.mark.parametrize(
        ("make", "message"),
        [
            (lambda: FormationEnv(SCENE, followers="zoe"), "no follower called `zoe`"),
            (lambda: FormationEnv(SCENE, followers=["robot-1"]), "no follower called `robot-1`"),
            (lambda: FormationEnv(SCENE, Task(observation=("leader.distanse",))), "leader.distance,"),
            (lambda: FormationEnv(SCENE, render_mode="human"), "no window"),
            (lambda: FormationEnv(SCENE.set({"time.mode": "continuous"})), "sampled"),
            (lambda: FormationVectorEnv(SCENE, num_envs=0), "from 1 on, not 0"),
            (lambda: FormationVectorEnv(SCENE, num_envs=2).reset(seed=[1]), "2 copies and 1 seeds"),
            (lambda: Task(samples=0), "samples is a positive"),
            (lambda: Task(bound=np.inf), "finite"),
            (lambda: Task(dtype="int8"), "float32"),
            (lambda: Task(scales={"own.speed": 0.0}), "own.speed"),
            (lambda: Task(observation="own.speed"), "tuple"),
            (lambda: Scatter(heading=-1), "heading of a scatter"),
            (lambda: LawPolicy(echelon.Law(lambda *_: 0, knows="motion"), FormationEnv(SCENE)), "motion"),
            (lambda: LawPolicy(output_feedback(SCENE), FormationEnv(SCENE, Task(residual=True))), "added"),
        ],
    )
    def test_what_an_environment_cannot_be(self, make, message):
        with pytest.raises(ValueError, match=message):
            make()

    def test_starts_without_room(self):
        crowded = Task(scatter=Scatter(position=0.001))
        env = FormationEnv(SCENE.set({"robots.robot-2.pose": [-0.45, 0, 0]}), crowded)
        with pytest.raises(SceneError, match="`robot-2` has no room"):
            env.reset(seed=0)


class TestVideo:
    def test_single_vector_and_parallel_environments_are_filmed(self, tmp_path):
        scene, task = SCENE.set({"time.duration": 0.5}), Task(samples=5)
        env = gymnasium.wrappers.RecordVideo(
            FormationEnv(scene, task, render_mode="rgb_array", **SMALL), str(tmp_path / "single"))
        drive(env, 5, seed=0)
        env.close()
        envs = gymnasium.wrappers.vector.RecordVideo(
            FormationVectorEnv(scene, task, 2, render_mode="rgb_array", **SMALL), str(tmp_path / "vector"))
        drive(envs, 5, seed=0)
        envs.close()
        parallel = RecordVideo(FormationParallelEnv(scene, task, render_mode="rgb_array", **SMALL), str(tmp_path / "parallel"))
        parallel.reset(seed=0)
        while parallel.agents:
            parallel.step(dict.fromkeys(parallel.agents, np.zeros(2)))
        parallel.close()
        for folder in ("single", "vector", "parallel"):
            [film] = (tmp_path / folder).glob("*.mp4")
            assert film.stat().st_size > 1000

    def test_pictures_show_what_happens(self):
        env = FormationEnv(SCENE, Task(samples=10), render_mode="rgb_array", **SMALL)
        env.reset(seed=0)
        before = env.render()
        assert (before == env.render()).all()
        for _ in range(5):
            env.step(np.tile([1.0, 0.3], 6))
        after, digest = env.render(), env.digest
        assert (before != after).any() and env.digest == digest
        again = drive(FormationEnv(SCENE, Task(samples=10)), 0, seed=0)
        for _ in range(5):
            again.step(np.tile([1.0, 0.3], 6))
        assert again.digest == digest


def test_the_example_trains_a_chain():
    path = pathlib.Path(__file__).parents[2] / "crates" / "python" / "examples" / "train_chain.py"
    spec = importlib.util.spec_from_file_location("train_chain", path)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    scene, task = example.chain().set({"time.duration": 5}), Task(scatter=Scatter(0.3, 0.3), end_on_contact=False)
    trained = example.train(scene, task, 3, np.random.default_rng(0), tell=lambda text: None)
    tests = FormationVectorEnv(scene, task, 16)
    unseen = [example.UNSEEN + test for test in range(16)]
    before, after = (example.returns(tests, scene, gains, unseen) for gains in (example.PAPER, trained))
    assert (after > before).mean() > 0.9, (before.mean(), after.mean())


def test_everything_public_is_documented():
    for name in echelon.envs.__all__:
        thing = getattr(echelon.envs, name)
        if callable(thing):
            own = {"": thing} | {k: v for k, v in vars(thing).items() if callable(v) and not k.startswith("_")}
            assert all(member.__doc__ for member in own.values()), name


def test_rewards_are_numbers_and_tasks_are_tasks():
    env = FormationVectorEnv("circle-three", num_envs=2, task=Task(reward=lambda signals: signals.effort * np.nan))
    env.reset(seed=1)
    with pytest.raises(ValueError, match="^copy 0: the reward of `follower-1` is nan"):
        env.step(env.action_space.sample())
    with pytest.raises(TypeError, match="reward is a function of signals, not 'x'"):
        Task(reward="x")
    with pytest.raises(TypeError, match="num_envs=64"):
        FormationVectorEnv("circle-three", 64)
