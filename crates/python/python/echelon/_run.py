"""What became of a scene's expectations."""

from __future__ import annotations

from typing import NamedTuple


class Expectation(NamedTuple):
    """One expectation of a scene.

    Attributes
    ----------
    key : str
        Its key in the scene's ``[expect]``.
    wanted, found : str
        With units.
    met : bool or None
        None where the run is too short to show it.
    """

    key: str
    wanted: str
    found: str
    met: bool | None


def expectations(rows: list[tuple]) -> list[Expectation]:
    """Rows of the core as named tuples."""
    return [Expectation(*row) for row in rows]
