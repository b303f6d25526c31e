"""Plots of a run. They need matplotlib."""

from __future__ import annotations

import io
from typing import Any

import numpy as np


def errors(run: Any, axes: Any = None) -> Any:
    """The errors of distance and bearing of every edge over time, on two axes; returns them."""
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("run.plot() needs matplotlib: pip install matplotlib") from error
    if axes is None:
        _, axes = plt.subplots(2, 1, sharex=True, layout="constrained")
    _draw(run, axes)
    return axes


def png(run: Any) -> bytes | None:
    """The plot of `errors` as PNG; None without matplotlib."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        return None
    figure = Figure(layout="constrained")
    _draw(run, figure.subplots(2, 1, sharex=True))
    file = io.BytesIO()
    figure.savefig(file, format="png")
    return file.getvalue()


def _draw(run: Any, axes: Any) -> None:
    edges = run.edges
    time = edges["time_s"]
    names = np.array([f"{leader} → {follower}" for leader, follower in zip(edges["leader"], edges["follower"])])
    distance, bearing = edges["error_distance_m"], np.degrees(edges["error_bearing_rad"])
    upper, lower = axes
    for name in dict.fromkeys(names):
        rows = names == name
        upper.plot(time[rows], distance[rows], label=name)
        lower.plot(time[rows], bearing[rows], label=name)
    upper.set_title(run.title)
    upper.set_ylabel("distance error (m)")
    lower.set_ylabel("bearing error (°)")
    lower.set_xlabel("time (s)")
    if names.size:
        upper.legend()
