"""Ctrl-C ends long work at once."""

import signal
import subprocess
import sys
import time

import pytest

WORK = {
    "run": "scene.run()",
    "advance": "scene.simulation().advance()",
    "law": "scene.run(law=lambda o, t, m: np.zeros((len(o), 2)))",
    "film": "scene.film(sys.argv[1] + '/film.mp4', size=(320, 180))",
}


def interrupted_after(work, folder):
    """Seconds from Ctrl-C to the exception."""
    code = (
        "import sys, echelon, numpy as np\n"
        "scene = echelon.Scene.load('hundred').set({'time.duration': 2000, 'expect': {}})\n"
        f"print('begins', flush=True)\ntry:\n    {WORK[work]}\nexcept KeyboardInterrupt:\n    print('interrupted', flush=True)\n"
    )
    with subprocess.Popen([sys.executable, "-c", code, folder], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "begins\n"
        time.sleep(2.0)
        process.send_signal(signal.SIGINT)
        asked = time.monotonic()
        line = process.stdout.readline()
        took = time.monotonic() - asked
        process.wait(30)
    assert line == "interrupted\n" and process.returncode == 0
    return took


@pytest.mark.parametrize("work", WORK)
def test_an_interrupt_ends(work, tmp_path):
    # A picture, and the writing of what is kept of a film, are not cut short. Whatever else the machine does only adds.
    most = 3.0 if work == "film" else 0.1
    tries = (interrupted_after(work, tmp_path / str(k)) for k in range(4))
    assert any(took < most for took in tries)
