"""Progress of long work."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def as_progress(wish: Any, name: str) -> Callable[[int, int], Any] | None:
    """What is called with samples done and in all: `wish` itself, a bar for True, nothing for False.

    A bar needs tqdm; where that is missing, there is none.
    """
    if callable(wish):
        return wish
    if not wish:
        return None
    try:
        from tqdm.auto import tqdm  # type: ignore[import-untyped]
    except ImportError:
        return None
    bar = tqdm(desc=name, unit="samples")

    def show(done: int, total: int) -> None:
        bar.total = total
        bar.update(done - bar.n)
        if done >= total:
            bar.close()

    return show
