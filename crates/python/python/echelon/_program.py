"""The program `echelon`, which the wheel has beside the module."""

from __future__ import annotations

import signal
import sys


def main() -> int:
    """Run the program with the arguments of the command line, and return its exit code."""
    # Python would turn the first Ctrl-C into an exception; the program closes its files and logs instead. What was
    # ignored from the start, as under nohup, stays so.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from ._echelon import program

    return program(["echelon", *sys.argv[1:]])
