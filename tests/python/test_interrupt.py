"""Ctrl-C ends long work at once: not the clock counts, which a busy machine delays, but what the work still does."""

import json
import signal
import subprocess
import sys

import pytest

WORK = {
    "run": "scene.run(told)",
    "advance": "scene.simulation().advance(progress=told)",
    "law": "scene.run(law=law)",
    "film": "scene.film(sys.argv[1] + '/film.mp4', size=(320, 180), progress=told)",
}
# Once the work has been looked after a few times, a thread sends what Ctrl-C sends. It counts how often the work comes round
# after that: to `told`, which is called at every look after signals, or to the law, which is called at every sample.
CODE = """
import json, signal, sys, threading, time
import echelon, numpy as np

scene = echelon.Scene.load("hundred").set({"time.duration": 2000, "expect": {}})
rounds, under_way, sent = 0, threading.Event(), {}

def told(*_):
    global rounds
    rounds += 1
    if rounds > 3:
        under_way.set()

def law(o, t, m):
    told()
    return np.zeros((len(o), 2))

def send():
    under_way.wait()
    sent["rounds"], sent["time"] = rounds, time.monotonic()
    signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)

threading.Thread(target=send, daemon=True).start()
try:
    WORK
except KeyboardInterrupt:
    print(json.dumps({"rounds": rounds - sent["rounds"], "seconds": time.monotonic() - sent["time"]}))
"""


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="the system has no signals for threads")
@pytest.mark.parametrize("work", WORK)
def test_an_interrupt_ends(work, tmp_path):
    done = subprocess.run([sys.executable, "-c", CODE.replace("WORK", WORK[work]), tmp_path], capture_output=True, text=True,
                          timeout=120, check=True)
    found = json.loads(done.stdout)
    print(f"{work}: {1000 * found['seconds']:.0f} ms from Ctrl-C to the exception")
    # One more where the work came round between the count and the signal.
    assert found["rounds"] <= 1, found
