"""Simulations step by step: states, changes, copies, what they refuse."""

import math
import threading

import echelon
import numpy as np
import pytest
from echelon import EDGE_COLUMNS, ROBOT_COLUMNS, EndOfRunError, Scene, SceneError

SCENE = Scene.load("circle-three").set({"time.duration": 4, "expect": {}})


def test_a_simulation_comes_to_the_digest_of_the_run():
    run, sim = SCENE.run(), SCENE.simulation()
    assert (sim.time, sim.sample, sim.done, sim.period) == (0.0, 0, False, 0.01)
    while not sim.done:
        sim.step()
    assert sim.digest == run.digest and sim.time == pytest.approx(4.0)
    sim = SCENE.simulation()
    sim.advance(1.0)
    assert sim.time == pytest.approx(1.0) and sim.sample == 100
    sim.advance()
    assert sim.done and sim.digest == run.digest


def test_states_are_the_rows_of_the_tables():
    run, sim = SCENE.run(), SCENE.simulation()
    sim.advance(2.0)
    assert sim.robots.shape == (3, len(ROBOT_COLUMNS)) and sim.robots.dtype == np.float64
    assert sim.edges.shape == (2, len(EDGE_COLUMNS))
    assert sim.robot_names == SCENE.robots
    assert sim.edge_names == [("leader", "follower-1"), ("leader", "follower-2")]
    for names, rows, table in ((ROBOT_COLUMNS, sim.robots, run.robots), (EDGE_COLUMNS, sim.edges, run.edges)):
        at = np.isclose(table["time_s"], sim.time)
        for column, name in enumerate(names):
            assert (table[name][at] == rows[:, column]).all(), name


def test_apply_is_a_change_of_the_scene():
    sim = SCENE.simulation()
    sim.advance(1.0)
    sim.apply({"robots.follower-1.distance": 1.5})
    sim.advance(0.5)
    sim.apply({"law.k": [3, 3]})
    sim.advance()
    assert sim.edges[0, EDGE_COLUMNS.index("set_distance_m")] == 1.5
    assert sim.scene.run().digest == sim.digest != SCENE.run().digest
    with pytest.raises(EndOfRunError):
        sim.apply({"law.k": 4})


@pytest.mark.parametrize(
    "values",
    [{"time.duration": 9}, {"robots": []}, {"robots.leader.path.speed": 2}, {"robots.zoe.distance": 2}, {"law.x": 1}],
)
def test_apply_refuses_what_cannot_change(values):
    sim = SCENE.simulation()
    before = sim.digest
    with pytest.raises(SceneError):
        sim.apply(values)
    sim.step()
    assert sim.scene == SCENE and sim.digest != before


def test_a_fork_goes_on_by_itself():
    sim = SCENE.simulation()
    sim.advance(1.0)
    fork = sim.fork()
    fork.apply({"robots.follower-1.distance": 1.0})
    fork.advance()
    sim.advance()
    assert sim.digest == SCENE.run().digest != fork.digest
    done = sim.fork()
    assert done.done and done.digest == sim.digest
    with pytest.raises(EndOfRunError, match="ended at 4"):
        done.step()
    with pytest.raises(EndOfRunError):
        sim.advance(1.0)


@pytest.mark.parametrize("seconds", [-1, math.nan, math.inf])
def test_time_goes_forward(seconds):
    with pytest.raises(ValueError, match="0 or more"):
        SCENE.simulation().advance(seconds)


def test_two_threads_are_told_apart():
    sim = Scene.load("hundred").simulation()
    begun, raised = threading.Event(), []

    def advance():
        try:
            sim.advance(progress=lambda done, total: begun.set())
        except BaseException as error:
            raised.append(error)

    thread = threading.Thread(target=advance)
    thread.start()
    assert begun.wait(10)
    with pytest.raises(echelon.BusyError, match="another thread"):
        sim.step()
    with pytest.raises(echelon.BusyError):
        _ = sim.robots
    thread.join()
    assert not raised and sim.done


def test_the_interpreter_is_free_while_the_core_works():
    sim = Scene.load("hundred").simulation()
    thread = threading.Thread(target=sim.advance)
    thread.start()
    counted = 0
    while thread.is_alive():
        counted += 1
    assert counted > 1000 and sim.done


def test_a_number_that_is_not_finite_is_a_run_error():
    wild = SCENE.set({"law.kind": "full-state", "law.k": 20, "time.period": 0.5}).simulation()
    try:
        wild.advance()
    except echelon.RunError as error:
        assert "finite" in str(error)
    assert wild.done


def test_times_to_advance_by_add_up():
    sim = Scene.load("circle-three").simulation()
    for _ in range(300):
        sim.advance(1 / 60)
    assert sim.time == pytest.approx(5.0, abs=1e-9)
    for _ in range(10):
        sim.advance(0.004)
    assert sim.time == pytest.approx(5.04, abs=1e-9)
    sim.advance(0)
    assert sim.time == pytest.approx(5.04, abs=1e-9)
    # A step is asked for as it is.
    sim.advance(0.001)
    sim.step()
    sim.advance(0.01)
    assert sim.time == pytest.approx(5.07, abs=1e-9)
    # A fork owes what its original owes.
    sim.advance(0.004)
    fork = sim.fork()
    sim.advance(0.006)
    fork.advance(0.006)
    assert sim.time == fork.time == pytest.approx(5.08, abs=1e-9)


def test_a_simulation_at_work_can_be_looked_at():
    sim = Scene.load("circle-three").simulation()
    seen = []

    def look(done, total):
        seen.append(repr(sim))

    sim.advance(1.0, progress=look)
    assert seen and all("at work" in text for text in seen)
    assert "of 15 s" in repr(sim)
