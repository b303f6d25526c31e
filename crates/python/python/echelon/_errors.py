"""Exceptions of the package."""

from __future__ import annotations

from typing import Any, NamedTuple


class EchelonError(Exception):
    """Base class of the package's own exceptions."""


class SceneFault(NamedTuple):
    """One thing that is wrong with a scene.

    Attributes
    ----------
    file : str
        File it was found in, or ``--set`` for a value that was set.
    line, column : int or None
        Where, both from 1; None where the whole file is meant.
    message : str
        What is wrong and what would be right.
    suggestion : str or None
        The word that may have been meant.
    """

    file: str
    line: int | None
    column: int | None
    message: str
    suggestion: str | None


class SceneError(EchelonError, ValueError):
    """A scene is wrong, or what is set in it.

    Attributes
    ----------
    errors : list of SceneFault
        Everything that is wrong with the text, in its order; empty where the text is right and the scene cannot run.
    file, line, column, suggestion
        Those of the first of them.
    """

    def __init__(self, message: str, errors: list[tuple] | None = None) -> None:
        super().__init__(message)
        self.errors = [SceneFault(*error) for error in errors or []]
        first = self.errors[0] if self.errors else SceneFault("", None, None, message, None)
        self.file, self.line, self.column, self.suggestion = first.file, first.line, first.column, first.suggestion


class RunError(EchelonError, RuntimeError):
    """A run broke off: a number is not finite, or cameras could not take their pictures."""


class LawError(RunError):
    """A law in Python gave no commands. What it raised is the ``__cause__``.

    Attributes
    ----------
    robot : str or None
        The follower, where it is known.
    sample : int
        Number of the control sample, from 0.
    time : float
        Its time, s.
    """

    def __init__(self, message: str, robot: str | None = None, sample: int = 0, time: float = 0.0) -> None:
        super().__init__(message)
        self.robot, self.sample, self.time = robot, sample, time


class EndOfRunError(EchelonError, RuntimeError):
    """The run has ended; there is no further sample."""


class BusyError(EchelonError, RuntimeError):
    """Another thread is at work on the same simulation."""


class ActionError(EchelonError, ValueError):
    """An action of an agent is no finite number, or actions have the wrong shape."""


class OutputError(EchelonError, OSError):
    """A file or folder cannot be written: the disk or its permissions refuse it, something else is there, or another program
    writes it.

    Attributes
    ----------
    filename : str
        The file or folder.
    errno : int or None
        Number of the system's error, as in `errno`; None where something else is there.
    """

    def __init__(self, message: str, errno: int | None = None, filename: str | None = None) -> None:
        super().__init__(message)
        self.errno, self.filename = errno, filename

    def __str__(self) -> str:
        # The message names the file; what OSError makes of the other two would say it again.
        return str(self.args[0])

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.errno, self.filename)


class RenderingError(EchelonError, RuntimeError):
    """There is no adapter to draw with, or it failed."""
