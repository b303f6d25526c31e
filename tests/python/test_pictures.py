"""Pictures and films: the same as the program's."""

import warnings

import numpy as np
import pytest
from echelon import RenderingError, Scene
from PIL import Image

SCENE = Scene.load("circle-three").set({"time.duration": 3, "expect": {}})
SIZE = (320, 180)


def pixels(path):
    return np.asarray(Image.open(path).convert("RGB"))


def test_render_draws_what_capture_draws(program, tmp_path):
    sets = ["--set", "time.duration=3", "--set", "expect={}"]
    program("capture", "circle-three", *sets, "--at", "0,1.5,3", "--size", "320x180", "-o", tmp_path)
    sim = SCENE.simulation()
    views = {}
    for until in (0.0, 1.5, 3.0):
        if until > 0:
            sim.advance(1.5)
        views[until] = sim.render(size=SIZE)
        assert views[until].shape == (180, 320, 3) and views[until].dtype == np.uint8
        assert (views[until] == pixels(tmp_path / f"circle-three-{until:07.3f}.png")).all(), until
    assert (views[0.0] != views[3.0]).any()
    camera = sim.render("camera:follower-1", SIZE)
    assert camera.std() > 5 and (camera != sim.render("top", SIZE)).any()
    assert (sim.render(size=SIZE) == views[3.0]).all() and (sim.fork().render(size=SIZE) == views[3.0]).all()


def test_capture_writes_what_the_program_writes(program, tmp_path):
    sets = ["--set", "time.duration=3", "--set", "expect={}"]
    program("capture", "circle-three", *sets, "--at", "1", "--view", "top", "--size", "320x180", "-o", tmp_path / "there")
    [path] = SCENE.capture(tmp_path / "here", [1.0], view="top", size=SIZE)
    assert path.name == "circle-three-001.000.png"
    assert (pixels(path) == pixels(tmp_path / "there" / path.name)).all()
    with pytest.warns(UserWarning, match="at names 2 times for 1 picture"):
        SCENE.capture(tmp_path / "here", [1, 1], size=(64, 64))


def test_a_film_shows_itself_in_a_notebook(tmp_path):
    scene = SCENE.set({"time.duration": 0.5})
    film = scene.film(tmp_path / "film.mp4", size=SIZE, fps=10)
    assert film.path.stat().st_size > 1000 and (film.frames, film.size) == (5, SIZE)
    assert film._repr_html_().startswith('<video src="data:video/mp4;base64,') and "0.50 s" in repr(film)
    gif = scene.film(tmp_path / "film.gif", view="top", size=(64, 64), fps=4, without=["inset"])
    assert gif._repr_html_().startswith('<img src="data:image/gif')
    assert scene.film(tmp_path / "frames", size=(64, 64), fps=4)._repr_html_().startswith("<code>")
    assert scene._repr_png_().startswith(b"\x89PNG")


def test_a_law_is_filmed(tmp_path):
    scene = SCENE.set({"time.duration": 0.5})
    film = scene.film(tmp_path / "own.mp4", size=(64, 64), law=lambda told, time, memory: np.zeros((len(told), 2)))
    assert film.frames > 0


def test_cameras_on_robots_take_their_pictures():
    scene = Scene.load("vision-circle-three").set({"time.duration": 0.3, "expect": {}})
    sim = scene.simulation()
    sim.advance()
    assert len(scene.run().measurements) > 0
    assert sim.render("camera:follower-1", SIZE, overlay=True).shape == (180, 320, 3)


def test_mistakes_of_pictures_are_value_errors(tmp_path):
    sim = SCENE.simulation()
    for wrong in (lambda: sim.render("sideways"), lambda: sim.render(size=(0, 9)), lambda: sim.render(without=["wings"]),
                  lambda: SCENE.capture(tmp_path, [99.0]), lambda: SCENE.film(tmp_path / "film.mp4", preset="wide"),
                  lambda: SCENE.film(tmp_path / "film.mp4", fps=0), lambda: SCENE.film(tmp_path / "film.xyz")):
        with pytest.raises(ValueError):
            wrong()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert sim.render(size=(64, 64)).shape == (64, 64, 3)


def test_arguments_are_taken_as_people_write_them(tmp_path):
    sim = SCENE.simulation()
    plain = sim.render(size=(64, 48), without=["labels"])
    for size in ("64x48", [64, 48], np.array([64, 48]), " 64 x 48 "):
        assert (sim.render(size=size, without="labels") == plain).all()
    at = {}
    for name, times in (("one", 1), ("array", np.linspace(1, 1, 1)), ("tuple", (1.0,)), ("scalar", np.float64(1))):
        [at[name]] = SCENE.capture(tmp_path / name, times, size="64x48", without="labels")
    assert len({path.name for path in at.values()}) == 1
    assert all((pixels(path) == pixels(at["one"])).all() for path in at.values())
    told = []
    sim.advance(0.1, progress=lambda done, total: told.append(done))
    sim.advance(0.1, progress=True)
    assert told


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"size": 64}, TypeError, r'size is width and height in pixels, such as \(1280, 720\) or "1280x720", not 64'),
        ({"size": "large"}, ValueError, "not 'large'"),
        ({"size": (64, 48, 3)}, ValueError, r"not \(64, 48, 3\)"),
        ({"size": (-64, 48)}, ValueError, r"not \(-64, 48\)"),
        ({"size": (64.5, 48)}, TypeError, "not .64.5, 48."),
        ({"size": range(1000)}, ValueError, r"not range\(0, 1000\)"),
        ({"size": list(range(1000))}, ValueError, r"not list\b"),
        ({"at": "soon"}, TypeError, r"at is times in s, such as 5 or \[0, 2.5, 5\], not 'soon'"),
        ({"at": [1, "soon"]}, TypeError, r"not \[1, 'soon'\]"),
        ({"without": 3}, TypeError, r'without is elements to hide, such as "labels" or \["labels", "inset"\], not 3'),
        ({"without": "wings"}, ValueError, "wings"),
    ],
)
def test_arguments_that_are_none_are_told_with_an_example(options, error, message, tmp_path):
    with pytest.raises(error, match=message):
        SCENE.capture(tmp_path, **options)


def test_without_an_adapter_there_is_one_clear_exception(tmp_path):
    sim = SCENE.simulation(adapter="no such adapter")
    with pytest.raises(RenderingError, match="no such adapter"):
        sim.render()
    with pytest.raises(RenderingError, match="no such adapter"):
        SCENE.capture(tmp_path, adapter="no such adapter")
    with pytest.raises(RenderingError, match="no such adapter"):
        Scene.load("vision-circle-three").run(adapter="no such adapter")
    sim.step()
