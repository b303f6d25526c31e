"""Keeps a graphics driver from printing errors that are none."""

import os
import sys

# Without XDG_RUNTIME_DIR, as in containers and notebooks, Mesa's device selection asks a window system that is not there and
# prints two lines that begin with "error:". This keeps it from asking.
if sys.platform.startswith("linux") and not os.environ.get("XDG_RUNTIME_DIR"):
    os.environ.setdefault("NODEVICE_SELECT", "1")
