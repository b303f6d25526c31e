"""Studies on a cluster."""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING, Any

from ._errors import EchelonError
from ._progress import as_progress

if TYPE_CHECKING:
    from ._echelon import Study, Table

_AGAIN = 3


def _part(study: Study, start: int, stop: int, place: str | None, threads: int) -> bytes | None:
    """One part of a study, where a worker makes it: its bytes, or None where they are in a file."""
    part = study.part(start, stop, threads=threads)
    if place is None:
        return part
    _write(place, part)
    return None


def _found(place: str) -> tuple[Any, str]:
    """The file system of a place, and its path there."""
    try:
        import fsspec  # type: ignore[import-untyped]
    except ImportError as error:
        raise ImportError('sweep(…, out=…) needs fsspec: pip install "echelon[dask]"') from error
    files, path = fsspec.core.url_to_fs(place)
    return files, path


def _write(place: str, part: bytes) -> None:
    # Whoever reads sees all of a file or none: a file system writes its name last, or an object as a whole.
    files, path = _found(place)
    files.makedirs(files._parent(path), exist_ok=True)
    draft = f"{path}.{uuid.uuid4().hex}"
    with files.open(draft, "wb") as file:
        file.write(part)
    files.mv(draft, path)


def _read(place: str) -> bytes | None:
    files, path = _found(place)
    if not files.exists(path):
        return None
    with files.open(path, "rb") as file:
        return bytes(file.read())


def sweep(
    study: Study,
    client: Any = None,
    *,
    out: str | None = None,
    chunk: int | None = None,
    threads: int | None = None,
    progress: Any = None,
) -> Table:
    """Makes all runs of a study, on this machine or on a cluster.

    Rows are the same wherever they are made.

    Parameters
    ----------
    study : Study
        What is run.
    client : dask.distributed.Client, optional
        The cluster; without one, all cores of this machine make the runs. Workers need ``echelon[dask]``, of the same version.
        Parts of workers that die are made again by others.
    out : str, optional
        Folder for the parts, as a path or an address that fsspec knows, such as ``s3://bucket/study``; it needs the
        extra ``echelon[dask]``. Parts that are there are not made again.
    chunk : int, optional
        Runs of a part; by default so many that each thread of the cluster makes about eight.
    threads : int, optional
        Threads that make one part; by default one on a cluster, and one for each core without it.
    progress : callable or bool, optional
        Called with runs that have been made and in all; True is a bar.

    Returns
    -------
    Table
        A row for every run, by index.

    Raises
    ------
    EchelonError
        Where the folder has parts of another study.
    """
    if client is None and out is None:
        return study.run(threads=threads, progress=progress)
    runs = study.runs
    if chunk is None:
        at_once = 1 if client is None else max(1, sum(client.nthreads().values()))
        chunk = max(1, min(runs, -(-runs // (8 * at_once))))
    if chunk < 1:
        raise ValueError("a part has one run at least")
    told = as_progress(progress, "runs")
    parts: dict[int, bytes] = {}
    done = 0

    def place(start: int, stop: int) -> str | None:
        return None if out is None else f"{out.rstrip('/')}/{study.fingerprint[:12]}-{start:010}-{stop:010}.parquet"

    def take(start: int, stop: int, part: bytes | None) -> None:
        nonlocal done
        where = place(start, stop)
        if part is None and where is not None:
            part = _read(where)
        if part is None:
            raise EchelonError(f"the part {where} is not there any more")
        parts[start] = part
        done += stop - start
        if told is not None:
            told(done, runs)

    wanted = []
    for start in range(0, runs, chunk):
        stop = min(start + chunk, runs)
        where = place(start, stop)
        there = None if where is None else _read(where)
        if there is None:
            wanted.append((start, stop, where))
        else:
            take(start, stop, there)
    if client is None:
        for start, stop, where in wanted:
            part = study.part(start, stop, threads=threads)
            if where is not None:
                _write(where, part)
            take(start, stop, part)
    else:
        from distributed import as_completed

        sent = client.scatter(study, broadcast=True) if wanted else None
        futures = {
            client.submit(_part, sent, start, stop, where, threads or 1, retries=_AGAIN, pure=False): (start, stop)
            for start, stop, where in wanted
        }
        try:
            for future in as_completed(futures):
                start, stop = futures[future]
                take(start, stop, future.result())
        except BaseException:
            client.cancel(list(futures))
            raise
    return study.joined([parts[start] for start in sorted(parts)])
