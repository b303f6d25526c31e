"""Laws that are functions in Python."""

import traceback

import echelon
import numpy as np
import pytest
from echelon import EDGE_COLUMNS, ROBOT_COLUMNS, Law, LawError, Scene

SCENE = Scene.load("circle-three").set({"expect": {}})
ZERO = np.zeros((2, 2))


def gains(scene):
    """K, β and κ of every follower, each an array of the shape (followers, 2)."""
    robots = {robot["name"]: robot for robot in scene.to_dict()["robots"]}
    laws = [robots[name]["law"] for name in scene.followers]
    return [np.array([law[key] for law in laws]) for key in ("k", "beta", "slope")]


def bend(told, b):
    """−g⁻¹ b (eq 9)."""
    sin, cos = np.sin(told.leader.view_angle), np.cos(told.leader.view_angle)
    across = told.leader.distance * b[:, 1]
    return np.column_stack((cos * b[:, 0] - sin * across, (sin * b[:, 0] + cos * across) / told.own.speed))


def drift(told):
    """d²s^d/dt² + g0 + g_s ds/dt (eqs 10, 11)."""
    distance, v, wanted = told.leader.distance, told.own.speed, told.wanted
    turn = v / distance
    column = np.column_stack((turn * np.cos(told.leader.view_angle), -2 * turn * np.sin(told.leader.view_angle) / distance))
    b = np.column_stack((wanted.distance_acceleration, wanted.bearing_acceleration))
    b[:, 0] -= v**2 / distance
    return b + column * told.leader.distance_rate[:, None]


def feedback(told, k):
    """2 K de/dt + K² e, and e."""
    leader, wanted = told.leader, told.wanted
    turned = wanted.bearing - leader.bearing
    error = np.column_stack((wanted.distance - leader.distance, np.arctan2(np.sin(turned), np.cos(turned))))
    rates = np.column_stack((wanted.distance_rate - leader.distance_rate, wanted.bearing_rate - leader.bearing_rate))
    return 2 * k * rates + k**2 * error, error


def output_feedback(scene):
    """Eq 42 of the paper with the gains of a scene."""
    k, beta, slope = gains(scene)

    def law(told, time, memory):
        i = told.index
        term, error = feedback(told, k[i])
        return bend(told, drift(told) + term + beta[i] * np.tanh(slope[i] * error))

    return law


def full_state(scene):
    """Eq 20 of the paper, which knows the leader's motion."""
    k = gains(scene)[0]

    def law(told, time, memory):
        leader, v, distance = told.leader, told.own.speed, told.leader.distance
        sp, cp, sg, cg = np.sin(leader.bearing), np.cos(leader.bearing), np.sin(leader.view_angle), np.cos(leader.view_angle)
        matrix = np.array([
            [v * (cg * cp + 2 * sg * sp) / distance, cp, -sp * sp / distance, 0 * v, sp],
            [2 * v * cg * sp / distance**2, -sp / distance, -2 * sp * cp / distance**2, 1 + 0 * v, cp / distance],
        ])
        speed, turn = leader.speed, told.frame.turn_rate
        motion = np.array([speed, leader.acceleration, speed**2, told.frame.turn_acceleration, speed * turn])
        return bend(told, drift(told) + feedback(told, k[told.index])[0] + np.einsum("ijn,jn->ni", matrix, motion))

    return law


def apart(one, other):
    """How far two simulations are apart at most on the way to their ends, in m, rad and m/s."""
    columns = [ROBOT_COLUMNS.index(name) for name in ("x_m", "y_m", "heading_rad", "speed_m_s")]
    worst = 0.0
    while not one.done:
        one.step()
        other.step()
        worst = max(worst, np.abs(one.robots - other.robots)[:, columns].max())
    assert other.done
    return worst


def test_output_feedback_in_numpy_drives_as_the_built_in_law():
    assert apart(SCENE.simulation(law=output_feedback(SCENE)), SCENE.simulation()) < 1e-12


def test_a_law_that_knows_the_motion_is_asked_leaders_first():
    scene = Scene.load("seven-v").set({"expect": {}, "law.kind": "full-state"})
    calls = []
    law = full_state(scene)

    def counted(told, time, memory):
        calls.append((time, told.followers))
        return law(told, time, memory)

    own, built_in = scene.simulation(law=Law(counted, knows="motion")), scene.simulation()
    first = [names for time, names in calls if time == 0.0]
    leaders = {follower: leader for leader, follower in own.edge_names}
    asked = set(scene.robots) - set(scene.followers)
    for names in first:
        assert {leaders[name] for name in names} <= asked
        asked |= set(names)
    assert len(first) == 3 and asked == set(scene.robots)
    # A law that is told another motion is apart by millimetres.
    assert apart(own, built_in) < 1e-9


def test_followers_that_are_not_named_keep_their_laws():
    seen = []

    def straight(told, time, memory):
        seen.append(told.followers)
        return np.zeros((len(told), 2))

    sim, built_in = SCENE.simulation(law=Law(straight, followers=["follower-2"])), SCENE.simulation()
    sim.advance(5.0)
    built_in.advance(5.0)
    assert all(names == ["follower-2"] for names in seen) and len(seen) == 501
    assert (sim.edges[0] == built_in.edges[0]).all() and (sim.edges[1] != built_in.edges[1]).any()
    assert (sim.robots[2, ROBOT_COLUMNS.index("turn_rate_rad_s")]) == 0.0


def test_a_law_is_told_what_law_files_are_told():
    names = {name for name, _, _ in echelon.INPUTS}

    def law(told, time, memory):
        assert len(told) == 2 and told.followers == SCENE.followers and told.period == 0.01
        assert (told.meets == (time == 0.0)).all() and told.index.tolist() == [0, 1]
        for group in ("own", "leader", "wanted"):
            for name in dir(getattr(told, group)):
                assert f"{group}.{name}" in names
        assert told.leader.distance.shape == (2,) and told.wanted.distance.dtype == np.float64
        with pytest.raises(AttributeError, match='knows="motion"'):
            _ = told.leader.speed
        with pytest.raises(AttributeError, match="distance"):
            _ = told.leader.distanse
        return ZERO

    SCENE.set({"time.duration": 0.1}).run(law=law)


def test_memory_belongs_to_a_simulation_and_is_copied_with_it():
    def law(told, time, memory):
        memory["sum"][told.index] += told.wanted.distance - told.leader.distance
        memory["calls"] = memory.get("calls", 0) + 1
        return np.column_stack((memory["sum"], 0 * memory["sum"]))

    start = {"sum": np.zeros(2)}
    sim = SCENE.simulation(law=Law(law, memory=start))
    sim.advance(0.5)
    fork = sim.fork()
    sim.advance(0.5)
    fork.advance(0.5)
    assert sim.digest == fork.digest and (start["sum"] == 0).all()
    again = SCENE.simulation(law=Law(law, memory=start))
    again.advance(1.0)
    assert again.digest == sim.digest


def test_apply_leaves_the_law():
    sim = SCENE.simulation(law=lambda told, time, memory: ZERO)
    sim.apply({"robots.follower-1.distance": 1.0})
    sim.advance(1.0)
    assert sim.edges[0, EDGE_COLUMNS.index("set_distance_m")] == 1.0
    assert (sim.edges[:, EDGE_COLUMNS.index("asked_turn_rate_rad_s")] == 0).all()


def test_a_law_that_raises_is_named_with_its_sample():
    def law(told, time, memory):
        if time > 0.055:
            raise LookupError("no map")
        return np.zeros((len(told), 2))

    sim = SCENE.simulation(law=Law(law, followers=["follower-1"]))
    with pytest.raises(LawError, match=r"law `law` at sample 6 \(0.06 s\), `follower-1`: LookupError: no map") as caught:
        sim.advance()
    error = caught.value
    assert isinstance(error.__cause__, LookupError) and error.__cause__.__traceback__ is not None
    assert (error.robot, error.sample) == ("follower-1", 6) and error.time == pytest.approx(0.06)
    assert sim.done and sim.sample == 5
    fork = sim.fork()
    for goes_on in (sim.step, sim.advance, lambda: sim.apply({"law.k": 3}), fork.step):
        with pytest.raises(LawError, match="no map") as again:
            goes_on()
        other = again.value
        assert other is not error and other.__cause__ is error.__cause__
        assert (other.robot, other.sample, other.time) == (error.robot, error.sample, error.time)
        # The traceback ends where the law was asked, and does not grow from one time to the next.
        frames, first = (traceback.extract_tb(one.__traceback__) for one in (other, error))
        assert frames[-1] == first[-1] and len(frames) <= 3, frames
    with pytest.raises(LawError, match="sample 6"):
        SCENE.run(law=law)


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (None, "returned nothing"),
        ("left", r"no real numbers \(str\)"),
        ([[1, 2], [3]], "no real numbers"),
        ([["1", "2"], ["3", "4"]], "no real numbers"),
        (np.zeros((2, 2), dtype=complex), "an array of complex128"),
        (np.zeros((2, 3)), r"shape \(2, 3\), not \(2, 2\)"),
        (np.zeros(4), "column_stack"),
        (np.array([[0, 0], [0, np.nan]]), "`follower-2`: the turn rate is nan"),
        (np.array([[np.inf, 0], [0, 0]]), "`follower-1`: the acceleration is inf"),
    ],
)
def test_answers_that_are_no_commands(answer, message):
    with pytest.raises(LawError, match=message):
        SCENE.run(law=lambda told, time, memory: answer)


def test_what_a_law_is_told_can_be_read_only():
    def law(told, time, memory):
        told.leader.distance[0] = 0.0

    with pytest.raises(LawError, match="ValueError: assignment destination is read-only"):
        SCENE.run(law=law)


def test_laws_that_a_scene_cannot_have():
    zero = lambda told, time, memory: ZERO
    for law, error in [
        (3, TypeError),
        (Law(zero, followers=["zoe"]), ValueError),
        (Law(zero, followers=["leader"]), ValueError),
    ]:
        with pytest.raises(error):
            SCENE.run(law=law)
    with pytest.raises(echelon.SceneError, match="several leaders"):
        Scene.load("two-leaders").run(law=zero)
    with pytest.raises(echelon.SceneError, match="continuous"):
        SCENE.set({"time.mode": "continuous"}).run(law=zero)


def test_an_interrupt_in_a_law_is_one_once():
    def law(told, time, memory):
        if time > 0.025:
            raise KeyboardInterrupt
        return ZERO

    sim = SCENE.simulation(law=law)
    with pytest.raises(KeyboardInterrupt):
        sim.advance()
    for _ in range(2):
        with pytest.raises(LawError, match=r"interrupted at sample 3 \(0.03 s\)") as caught:
            sim.step()
        assert isinstance(caught.value.__cause__, KeyboardInterrupt)


def test_what_a_law_raised_is_not_the_fault_of_the_next_work(tmp_path):
    def law(told, time, memory):
        raise LookupError("no map")

    def fails(done, total):
        raise ValueError("no more")

    # Both raise: `progress` is called at the end of the run that the law breaks off.
    with pytest.raises(ValueError, match="no more"):
        SCENE.run(fails, law=law)
    with pytest.raises(ValueError, match="not within the run"):
        SCENE.capture(tmp_path, 99.0)


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"knows": "motoin"}, ValueError, r'"output", "rates" or "motion", not \'motoin\': did you mean "motion"\?'),
        ({"knows": "foo"}, ValueError, r'"output", "rates" or "motion", not \'foo\'$'),
        ({"knows": 3}, ValueError, "not 3"),
        ({"name": 3}, TypeError, "name of a law"),
    ],
)
def test_what_a_law_cannot_be_is_said_where_it_is_made(options, error, message):
    with pytest.raises(error, match=message):
        Law(lambda told, time, memory: ZERO, **options)
    law = Law(lambda told, time, memory: ZERO)
    law.knows = "everything"
    with pytest.raises(ValueError, match="everything"):
        SCENE.run(law=law)


def test_a_memory_that_cannot_be_copied_is_said_by_fork():
    sim = SCENE.simulation(law=Law(lambda told, time, memory: (memory.setdefault("g", (i for i in ())), ZERO)[1]))
    with pytest.raises(TypeError, match="generator"):
        sim.fork()
    sim.step()


def test_a_law_may_not_step_its_own_simulation():
    holder = []

    def law(told, time, memory):
        if holder:
            holder[0].step()
        return ZERO

    sim = SCENE.simulation(law=law)
    holder.append(sim)
    with pytest.raises(LawError, match="BusyError"):
        sim.step()


def test_followers_with_sensors_are_met_when_they_see_their_leader():
    # Followers that lose sight of their leader brake by themselves, and are met anew.
    scene = Scene.load("vision-dropout").set({"expect": {}, "sensing.kind": "geometric", "time.duration": 3})
    met = []

    def law(told, time, memory):
        met.extend((time, name) for name, meets in zip(told.followers, told.meets) if meets)
        return np.zeros((len(told), 2))

    scene.simulation(law=law).advance()
    assert {name for _, name in met} == set(scene.followers)
