"""Studies of many runs, on this machine and on a cluster."""

import os
import pickle
import signal

import distributed
import numpy as np
import pandas as pd
import pytest

import echelon

SHORT = {"time.duration": 1}


def rows(table):
    """All columns that do not depend on how fast a machine is."""
    return {name: table[name] for name in table.columns if name != "wall_time_s"}


def same(a, b):
    a, b = rows(a), rows(b)
    assert list(a) == list(b)
    for name, column in a.items():
        np.testing.assert_array_equal(np.asarray(column), np.asarray(b[name]), name)


@pytest.fixture
def study():
    scene = echelon.Scene.load("line-three").set(SHORT)
    return echelon.Study(scene, {"law.k": "4..6/3", "law.beta": [1, 2]}, seeds=5, scatter=(0.2, 0.1))


def test_rows_are_those_of_the_program(study, program, tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(study.to_toml())
    program("sweep", file, "-o", tmp_path / "folder")
    theirs = pd.read_parquet(tmp_path / "folder" / "runs.parquet")
    ours = study.run()
    assert len(study) == study.runs == len(ours) == len(theirs) == 30
    for name, column in rows(ours).items():
        np.testing.assert_array_equal(np.asarray(column), theirs[name].to_numpy(), name)
    assert ours["index"].dtype == np.int64 and ours["met"].dtype == bool
    # A row is a run that can be made again.
    point = study.point(7)
    values = dict(line.split("=", 1) for line in point["set"] if not line.startswith("robots."))
    assert values["seed"] == str(ours["seed"][7]) and values["law.k"] == ours["law.k"][7]
    again = program("run", "line-three", "--no-record", *(part for line in point["set"] for part in ("--set", line)))
    assert again["digest"] == ours["digest"][7]


def test_parts_are_joined_in_any_order(study):
    whole = study.run(threads=1)
    parts = [study.part(start, start + 10) for start in (20, 0, 10)]
    same(study.joined(parts), whole)
    same(pickle.loads(pickle.dumps(study)).run(), whole)
    with pytest.raises(echelon.EchelonError, match="twice"):
        study.joined([parts[0], parts[0]])
    other = echelon.Study(echelon.Scene.load("line-three"), {"law.k": [4, 5]})
    with pytest.raises(echelon.EchelonError, match="another study"):
        other.joined(parts)


def test_what_is_no_study_is_said(study):
    scene = echelon.Scene.load("line-three")
    for vary, wanted in [
        ({"law.k": "3..1/4"}, "does not rise"),
        ({"law.kk": [1, 2]}, "law.kk"),
        ({"law.k": [-1]}, "cannot be -1"),
        ({"law.k": "=law.beta"}, "not varied"),
    ]:
        with pytest.raises(ValueError, match=wanted):
            echelon.Study(scene, vary)
    with pytest.raises(ValueError, match="sobol"):
        echelon.Study(scene, sampling="sobel")
    with pytest.raises(ValueError, match="seeds and samples"):
        echelon.Study(scene, seeds=0)
    with pytest.raises(echelon.SceneError, match="pictures"):
        echelon.Study(echelon.Scene.load("vision-seven-v"))
    with pytest.raises(IndexError, match="no range"):
        study.run(5, 50)


def test_a_folder_holds_the_parts_that_were_made(study, tmp_path):
    out = str(tmp_path / "parts")
    told = []
    whole = echelon.sweep(study, out=out, chunk=7, progress=lambda done, total: told.append((done, total)))
    same(whole, study.run())
    files = sorted(os.listdir(out))
    assert len(files) == 5 and told[-1] == (30, 30)
    os.remove(os.path.join(out, files[2]))
    kept = os.stat(os.path.join(out, files[0])).st_mtime_ns
    same(echelon.sweep(study, out=out, chunk=7), whole)
    assert os.stat(os.path.join(out, files[0])).st_mtime_ns == kept
    assert sorted(os.listdir(out)) == files


def test_a_cluster_makes_the_same_rows_though_a_worker_dies(tmp_path):
    scene = echelon.Scene.load("line-three").set({"time.duration": 30})
    study = echelon.Study(scene, {"law.k": "4..6/10"}, seeds=12)
    with distributed.LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None,
                                  local_directory=str(tmp_path)) as cluster, distributed.Client(cluster) as client:
        workers = [found.pid for found in cluster.workers.values()]
        assert len(workers) == 3
        killed = []

        def progress(done, total):
            if done >= total // 4 and not killed:
                os.kill(workers[0], signal.SIGKILL)
                killed.append(done)

        made = echelon.sweep(study, client, chunk=3, progress=progress)
    assert killed and killed[0] < study.runs
    same(made, study.run())
