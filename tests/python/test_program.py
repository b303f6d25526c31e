"""The program that comes with the module is the program."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest


def started(*arguments, **options):
    return [sys.executable, "-m", "echelon", *map(str, arguments)], {"text": True, "stdout": subprocess.PIPE,
                                                                   "stderr": subprocess.PIPE, **options}


def run(*arguments, **options):
    command, options = started(*arguments, **options)
    return subprocess.run(command, check=False, **options)


@pytest.mark.parametrize("arguments", [["--version"], ["--help"], ["film", "--help"], ["laws"], ["check", "seven-v"], []])
def test_it_says_what_the_program_says(arguments):
    theirs = subprocess.run([os.environ["ECHELON"], *arguments], check=True, text=True, capture_output=True)
    ours = run(*arguments)
    assert (ours.returncode, ours.stdout) == (0, theirs.stdout)


def test_exit_codes_are_those_of_the_program(tmp_path):
    missing = run("run", tmp_path / "missing.toml")
    assert missing.returncode == 2 and "missing.toml" in missing.stderr and "Traceback" not in missing.stderr
    assert run("--no-such-flag").returncode == 2
    unmet = run("run", "line-three", "--no-record", "-q", "--set", "time.duration=0.1",
                "--set", "expect={final_distance_error=0.0001}")
    assert unmet.returncode == 1, unmet.stderr


def test_a_picture_needs_no_display(tmp_path):
    quiet = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR")}
    drawn = run("capture", "line-three", "--at", "1", "--size", "64x36", "-q", "-o", tmp_path / "ours", env=quiet)
    assert (drawn.returncode, drawn.stderr) == (0, "")
    subprocess.run([os.environ["ECHELON"], "capture", "line-three", "--at", "1", "--size", "64x36", "-q", "-o", tmp_path / "theirs"],
                   check=True, env=quiet)
    [ours], [theirs] = (list((tmp_path / folder).glob("*.png")) for folder in ("ours", "theirs"))
    assert ours.name == theirs.name and ours.read_bytes() == theirs.read_bytes()


def test_an_interrupt_leaves_a_readable_run(tmp_path):
    command, options = started("run", "hundred", "--set", "time.duration=2000", "--set", "expect={}", "-o", tmp_path / "run")
    with subprocess.Popen(command, **options) as process:
        while not (tmp_path / "run/tables/edges.parts").is_dir() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=60)
    assert process.returncode == 130 and "Traceback" not in told, told
    assert json.loads((tmp_path / "run/manifest.json").read_text())["status"] == "interrupted"


def test_the_table_of_reliability_has_a_row_for_each_study(tmp_path):
    script = Path(__file__).parents[2] / "scripts" / "reliability"
    command = [sys.executable, script, os.environ["ECHELON"], "1", tmp_path / "studies"]
    done = subprocess.run(command, check=True, text=True, capture_output=True)
    rows = [line for line in done.stdout.splitlines() if line.startswith("| ") and "%" in line]
    assert len(rows) == 16 == len(list((tmp_path / "studies").iterdir()))
    assert all(row.count("(20.65 to 100.00 %)") + row.count("(0.00 to 79.35 %)") == 2 for row in rows)
