"""Studies of many runs, on this machine and on a cluster."""

import os
import pickle
import signal
import socket
import subprocess
import sys
import time

import distributed
import fsspec
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


@pytest.fixture
def bucket(tmp_path, monkeypatch):
    """The folder that holds the objects of `s3://studies`, which a server on this machine serves to whoever signs requests."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    keys = {"ACCESS_KEY": "echelon", "SECRET_KEY": "a key that nobody needs to guess"}
    place = {"AWS_ACCESS_KEY_ID": keys["ACCESS_KEY"], "AWS_SECRET_ACCESS_KEY": keys["SECRET_KEY"],
             "AWS_ENDPOINT_URL": f"http://127.0.0.1:{port}", "AWS_DEFAULT_REGION": "us-east-1", "NO_PROXY": "127.0.0.1"}
    for name, value in place.items():
        monkeypatch.setenv(name, value)
    command = [sys.executable, "-m", "nanio", "serve", "--host", "127.0.0.1", "--port", str(port),
               "--data-dir", tmp_path / "objects"]
    own = {f"NANIO_{name}": value for name, value in keys.items()}
    with open(tmp_path / "server.txt", "w") as told, subprocess.Popen(
        command, env={**os.environ, **own}, stdout=told, stderr=told,
    ) as server:
        try:
            until = time.monotonic() + 60
            while True:
                assert server.poll() is None and time.monotonic() < until, (tmp_path / "server.txt").read_text()
                with socket.socket() as asked:
                    if asked.connect_ex(("127.0.0.1", port)) == 0:
                        break
                time.sleep(0.05)
            fsspec.filesystem("s3").mkdir("studies")
            yield tmp_path / "objects" / "studies"
        finally:
            # File systems keep the address of the server, and are kept themselves.
            fsspec.get_filesystem_class("s3").clear_instance_cache()
            server.terminate()


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
    assert values["seed"] == str(ours["seed"][7]) and float(values["law.k"]) == ours["law.k"][7]
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


def test_a_folder_for_parts_needs_fsspec(study, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "fsspec", None)
    with pytest.raises(ImportError, match=r"echelon\[dask\]"):
        echelon.sweep(study, out=str(tmp_path / "parts"))


def test_a_bucket_holds_the_parts_that_were_made(study, bucket, monkeypatch):
    whole = echelon.sweep(study, out="s3://studies/first", chunk=7)
    same(whole, study.run())
    files = sorted(bucket.glob("first/*"))
    assert len(files) == 5 and all(file.suffix == ".parquet" for file in files)
    # One that is missing is made, and the others are as they were.
    files[2].unlink()
    kept = [file.stat().st_mtime_ns for file in files[:2] + files[3:]]
    same(echelon.sweep(study, out="s3://studies/first/", chunk=7), whole)
    assert sorted(bucket.glob("first/*")) == files
    assert [file.stat().st_mtime_ns for file in files[:2] + files[3:]] == kept
    # What is no part is not taken for one.
    fsspec.filesystem("s3").pipe_file(f"studies/first/{files[2].name}", b"spoilt")
    with pytest.raises(echelon.EchelonError):
        echelon.sweep(study, out="s3://studies/first", chunk=7)
    # Whoever has no key is not let in.
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "another key")
    fsspec.get_filesystem_class("s3").clear_instance_cache()
    with pytest.raises(PermissionError):
        echelon.sweep(study, out="s3://studies/second", chunk=7)
    assert not (bucket / "second").exists()


def test_workers_write_into_a_bucket(study, bucket, tmp_path):
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                                  local_directory=str(tmp_path)) as cluster, distributed.Client(cluster) as client:
        whole = echelon.sweep(study, client, out="s3://studies/first", chunk=4)
    same(whole, study.run())
    files = sorted(bucket.glob("first/*"))
    assert len(files) == 8
    # Without the cluster nothing is left to be made.
    kept = [file.stat().st_mtime_ns for file in files]
    same(echelon.sweep(study, out="s3://studies/first", chunk=4), whole)
    assert [file.stat().st_mtime_ns for file in sorted(bucket.glob("first/*"))] == kept


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
