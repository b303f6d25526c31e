"""Scenes: read, changed, refused."""

import copy
import pickle

import echelon
import numpy as np
import pytest
from echelon import Scene, SceneError

TEXT = """schema = 1
title = "Two robots"
[[robots]]
name = "ann"
pose = [0.0, 0.0, 0.0]
path = { kind = "circle", speed = 1.0, turn_rate = 0.3 }
[[robots]]
name = "bob"
pose = [-2.0, -1.0, 0.0]
leader = "ann"
distance = 2.0
bearing = "-135 deg"
"""


def test_scenes_lists_what_ships():
    shipped = echelon.scenes()
    assert list(shipped)[:2] == ["circle-three", "line-three"] and len(shipped) > 50
    assert all(Scene.load(name).title == title for name, title in list(shipped.items())[:5])


def test_a_scene_comes_from_a_name_a_file_a_text_and_a_dictionary(tmp_path):
    path = tmp_path / "two.toml"
    path.write_text(TEXT)
    scene = Scene.load(path)
    assert (scene.name, scene.title, scene.robots, scene.followers) == ("two", "Two robots", ["ann", "bob"], ["bob"])
    assert scene == Scene.load(str(path)) == Scene.load(TEXT)
    table = {
        "schema": 1,
        "title": "Two robots",
        "robots": [
            {"name": "ann", "pose": np.zeros(3), "path": {"kind": "circle", "speed": np.float64(1), "turn_rate": 0.3}},
            {"name": "bob", "pose": (-2.0, -1.0, 0.0), "leader": "ann", "distance": 2.0, "bearing": "-135 deg",
             "number": None},
        ],
    }
    assert Scene.load(table) == scene
    assert Scene.load(scene.to_toml()) == scene == Scene.load(scene.to_dict())
    assert scene.to_dict()["robots"][1]["distance"] == 2.0
    assert "Two robots" in repr(scene)


def test_set_returns_a_new_scene():
    scene = Scene.load("circle-three")
    changed = scene.set({"law.k": 3, "time.duration": np.float64(2)})
    assert scene.duration == 15.0 and changed.duration == 2.0
    assert changed.to_dict()["robots"][1]["law"]["k"] == [3.0, 3.0]
    assert changed != scene and scene.set({}) == scene
    again = changed.set({"title": 'a "b" = c', "robots.follower-1.distance": 1.5})
    assert again.title == 'a "b" = c' and again.duration == 2.0
    assert pickle.loads(pickle.dumps(again)) == again


def test_a_scene_is_the_same_in_a_process_that_stands_elsewhere(tmp_path, monkeypatch):
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes/own.csv").write_text("t,v,omega\n0,1,0\n5,1,0.1\n")
    text = TEXT.replace('"circle", speed = 1.0, turn_rate = 0.3', '"table", file = "own.csv"')
    (tmp_path / "scenes/own.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    scene = Scene.load("scenes/own.toml").set({"time.duration": 2})
    sent = pickle.dumps(scene)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert pickle.loads(sent) == scene and pickle.loads(sent).name == "own"
    assert copy.deepcopy(Scene.load("circle-three")) == Scene.load("circle-three")


def test_everything_that_is_wrong_is_reported_at_once(tmp_path):
    path = tmp_path / "wrong.toml"
    path.write_text(TEXT.replace("distance = 2.0", "distanse = 2.0").replace("speed = 1.0", "speed = -1.0"))
    with pytest.raises(SceneError, match="distanse") as caught:
        Scene.load(path)
    error = caught.value
    assert isinstance(error, echelon.EchelonError) and isinstance(error, ValueError)
    assert len(error.errors) >= 2 and error.errors[0].file == str(path)
    assert (error.file, error.line, error.column) == error.errors[0][:3]
    [typo] = [fault for fault in error.errors if "distanse" in fault.message]
    assert (typo.line, typo.column, typo.suggestion) == (11, 1, "distance")


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: Scene.load("circle-tree"), "circle-three"),
        (lambda: Scene.load("circle-three").set({"law.gain": 3}), "gain"),
        (lambda: Scene.load("circle-three").set({"": 3}), "not an override"),
        (lambda: Scene.load("circle-three").set({"robots.zoe.distance": 3}), "zoe"),
        (lambda: Scene.load({"schema": 1}), "title|robot"),
        (lambda: Scene.load("circle-three").set({"time.duration": float("nan")}), "duration|number"),
    ],
)
def test_mistakes_are_scene_errors(wrong, message):
    with pytest.raises(SceneError, match=message):
        wrong()


def test_values_of_other_types_are_type_errors():
    scene = Scene.load("circle-three")
    for values in ([1], {1: 2}, {"law.k": object()}, "law.k=3"):
        with pytest.raises(TypeError):
            scene.set(values)
    for source in (3, None, ["circle-three"]):
        with pytest.raises(TypeError, match="name of one that ships"):
            Scene.load(source)
    nested = []
    nested.append(nested)
    with pytest.raises(TypeError, match="deep"):
        scene.set({"law.k": nested})


def test_check_says_what_comes_too_late():
    scene = Scene.load("circle-three")
    assert scene.check() == []
    late = scene.set({"changes": [{"at": 99.0, "set": ["robots.follower-1.distance=1.5"]}]})
    assert "99" in late.check()[0]
    with pytest.raises(SceneError, match="storyboard|film|shot"):
        scene.set({"film.shots": [{"to": 99.0}]}).check()
