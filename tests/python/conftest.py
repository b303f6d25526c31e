"""What the tests share."""

import json
import os
import subprocess

import pytest


@pytest.fixture
def program():
    """Runs the program, with which the module has to agree; returns what it prints as JSON."""

    def run(*arguments, check=True):
        done = subprocess.run([os.environ["ECHELON"], *map(str, arguments), "--json"], capture_output=True, text=True,
                              check=False)
        assert not check or done.returncode in (0, 1), done.stderr
        return json.loads(done.stdout) if done.stdout.strip() else None

    return run
