"""Films and pictures, as notebooks show them."""

from __future__ import annotations

import base64
import html
import os
import tempfile
from pathlib import Path
from typing import Any

from ._errors import RenderingError

# Longer films are named, not shown: a notebook keeps all that it shows in its file.
_MOST_BYTES = 50_000_000


class Film:
    """A film that was written.

    Attributes
    ----------
    path : pathlib.Path
        The file, or the folder of a sequence of pictures.
    frames : int
        Number of frames.
    fps : float
        Frames a second.
    size : tuple of int
        Width and height, pixels.
    adapter : str
        What drew it.
    """

    def __init__(self, path: os.PathLike, frames: int, fps: float, size: list[int], adapter: str) -> None:
        self.path, self.frames, self.fps, self.adapter = Path(path), frames, fps, adapter
        self.size = (size[0], size[1])

    @property
    def duration(self) -> float:
        """Length, s."""
        return self.frames / self.fps

    def __repr__(self) -> str:
        return f"<echelon.Film {str(self.path)!r}: {self.duration:.2f} s, {self.size[0]} x {self.size[1]}>"

    def _repr_html_(self) -> str | None:
        kinds = {".mp4": "video/mp4", ".m4v": "video/mp4", ".webm": "video/webm", ".gif": "image/gif"}
        kind = kinds.get(self.path.suffix.lower())
        if kind is None or not self.path.is_file() or self.path.stat().st_size > _MOST_BYTES:
            return f"<code>{html.escape(repr(self))}</code>"
        data = f"data:{kind};base64,{base64.b64encode(self.path.read_bytes()).decode()}"
        if kind == "image/gif":
            return f'<img src="{data}" width="{self.size[0]}" alt="film">'
        return f'<video src="{data}" width="{self.size[0]}" controls loop></video>'


def still(scene: Any) -> bytes | None:
    """A PNG of a scene at its start; None where there is nothing to draw with."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            [path] = scene.capture(folder, [0.0])
        except RenderingError:
            return None
        return Path(path).read_bytes()
