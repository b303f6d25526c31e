"""Runs: their tables in other libraries, their metrics, their folders."""

import copy
import errno
import json
import pickle
from pathlib import Path

import duckdb
import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from echelon import EchelonError, OutputError, Scene


@pytest.fixture(scope="module")
def run():
    return Scene.load("circle-three").run()


def test_the_run_is_that_of_the_program(run, program, tmp_path):
    told = program("run", "circle-three", "-o", tmp_path / "there")
    assert (run.digest, run.status, run.passed) == (told["digest"], "complete", True)
    run.save(tmp_path / "here", csv=False)
    there, here = tmp_path / "there", tmp_path / "here"
    names = sorted(path.relative_to(there) for path in there.rglob("*") if path.is_file())
    assert names == sorted(path.relative_to(here) for path in here.rglob("*") if path.is_file())
    manifests = [json.loads((folder / "manifest.json").read_text()) for folder in (there, here)]
    commits = [manifest.pop("commit") for manifest in manifests]
    assert manifests[0] == manifests[1]
    # Manifest and log name the commit, which differs where the program was built at another than the extension.
    named = {"manifest.json", "log.mcap"} if commits[0] != commits[1] else set()
    differ = [name for name in map(str, names) if (there / name).read_bytes() != (here / name).read_bytes()]
    assert names and set(differ) <= named, differ
    assert run.metrics == json.loads((there / "metrics.json").read_text())
    assert [e.key for e in run.expectations] == [e["key"] for e in run.metrics["expectations"]]
    assert all(e.met for e in run.expectations)
    with pytest.raises(OutputError, match="force"):
        run.save(here)
    run.save(here, force=True)


def test_other_libraries_take_the_tables(run, tmp_path):
    run.save(tmp_path / "run", log=False)
    for name in ("robots", "edges", "contacts"):
        table = getattr(run, name)
        arrow = pa.table(table)
        stored = pq.read_table(tmp_path / "run" / "tables" / f"{name}.parquet")
        assert arrow.combine_chunks().equals(stored.combine_chunks()) and len(table) == len(stored)
        assert table.columns == stored.column_names
    robots = run.robots
    frame = pl.DataFrame(robots)
    assert frame.shape == (len(robots), len(robots.columns))
    assert pd.DataFrame.from_arrow(robots)["x_m"].tolist() == frame["x_m"].to_list() == robots["x_m"].tolist()
    [[rows]] = duckdb.sql("select count(*) from robots where robot = 'leader'").fetchall()
    assert rows == 1501


def test_columns_are_arrays_and_lists(run):
    edges = run.edges
    assert edges["error_distance_m"].dtype == np.float64 and edges["limited"].dtype == np.bool_
    assert set(edges["follower"]) == {"follower-1", "follower-2"}
    assert len(run.safety) == 0 and "room_m" in run.safety.columns
    with pytest.raises(KeyError, match="no column `x`"):
        edges["x"]
    assert abs(edges["error_distance_m"][-1]) < 1e-2
    assert "edges" in repr(edges) and run.digest in repr(run)


def test_contacts_that_are_open_at_the_end_are_in_the_table(tmp_path):
    run = Scene.load("cars-crash").set({"expect": {}}).run()
    run.save(tmp_path / "run", log=False)
    stored = pq.read_table(tmp_path / "run" / "tables" / "contacts.parquet")
    assert pa.table(run.contacts).combine_chunks().equals(stored.combine_chunks()) and len(stored) > 0


def test_a_failed_expectation_is_no_exception():
    run = Scene.load("circle-three").set({"expect.final_distance_error": 1e-12, "time.duration": 2}).run()
    assert not run.passed and any(e.met is False for e in run.expectations)


def test_progress_is_told():
    told = []
    Scene.load("hundred").set({"time.duration": 2}).run(lambda done, total: told.append((done, total)))
    assert told[-1] == (201, 201) and told == sorted(told)
    Scene.load("circle-three").run(True)

    def fails(done, total):
        raise LookupError("no more")

    with pytest.raises(LookupError, match="no more"):
        Scene.load("circle-three").run(fails)


def test_a_run_plots_its_errors(run):
    upper, lower = run.plot()
    assert upper.get_title() == run.title and len(lower.lines) == 2
    assert run._repr_png_().startswith(b"\x89PNG")


def test_a_run_that_is_there_is_replaced_on_request(tmp_path):
    run = Scene.load("line-three").set({"time.duration": 0.1, "expect": {}}).run()
    run.save(tmp_path / "run")
    with pytest.raises(OutputError) as caught:
        run.save(tmp_path / "run")
    text = f"{tmp_path / 'run'} already holds a run: choose another folder, or give `force=True` to replace it"
    assert str(caught.value) == text
    assert caught.value.filename == str(tmp_path / "run") and caught.value.errno is None
    run.save(tmp_path / "run", force=True)
    (tmp_path / "other").mkdir()
    (tmp_path / "other/notes.txt").write_text("mine")
    with pytest.raises(OutputError, match="holds other files: choose another folder$"):
        run.save(tmp_path / "other", force=True)


def test_a_place_that_cannot_be_written_is_one_exception(tmp_path):
    (tmp_path / "file").write_text("no folder")
    scene = Scene.load("line-three").set({"time.duration": 0.1, "expect": {}})
    run = scene.run()
    below = tmp_path / "file" / "below"
    for writes in (lambda: run.save(below), lambda: scene.capture(below, size="64x64"),
                   lambda: scene.film(below / "film.mp4", size="64x64"), lambda: scene.film(below, size="64x64"),
                   lambda: scene.film(tmp_path, size="64x64"), lambda: run.save(tmp_path / "file")):
        with pytest.raises(OutputError, match="file") as caught:
            writes()
        error = caught.value
        assert isinstance(error, OSError) and isinstance(error, EchelonError)
        assert error.filename.startswith(str(tmp_path)) and error.filename in str(error)
    full = pickle.loads(pickle.dumps(OutputError("no room for a", errno.ENOSPC, "a")))
    assert (str(full), full.errno, full.filename) == ("no room for a", errno.ENOSPC, "a")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no disk that is always full")
def test_a_full_disk_has_the_number_of_the_system(tmp_path):
    scene = Scene.load("line-three").set({"time.duration": 0.1, "expect": {}})
    [picture] = scene.capture(tmp_path, 0.1, size="64x64")
    picture.unlink()
    picture.symlink_to("/dev/full")
    with pytest.raises(OutputError) as caught:
        scene.capture(tmp_path, 0.1, size="64x64")
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, "/dev/full")


def test_what_does_not_pickle_says_what_does(run):
    sim = Scene.load("circle-three").simulation()
    for thing, instead in ((run, "`save` it"), (sim, "`fork` copies it"), (run.edges, "pyarrow")):
        for send in (pickle.dumps, copy.deepcopy):
            with pytest.raises(TypeError, match=f"a {type(thing).__name__} cannot be pickled.*{instead}"):
                send(thing)


def test_arrival_is_expected_of_who_has_goals():
    def found(scene):
        return {expectation.key: expectation for expectation in scene.run().expectations}["arrived"]

    maze = Scene.load("maze-three")
    assert found(maze).met and found(maze).found == "everybody"
    late = found(maze.set({"time.duration": 20}))
    assert not late.met and late.found == "`robot-1` has 29.5 s to go"
    nobody = found(Scene.load("line-three").set({"expect.arrived": True}))
    assert not nobody.met and nobody.found == "no robot has goals"
