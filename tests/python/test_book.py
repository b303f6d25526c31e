"""What the book says of Python is true."""

import os
import pathlib
import re
import subprocess
import sys

import echelon

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "python.md"


def test_the_page_runs_from_top_to_bottom(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = PAGE.read_text(encoding="utf-8")
    names = {}
    blocks = list(re.finditer(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE))
    assert len(blocks) >= 9
    for block in blocks:
        # An error shows its line of the page.
        padding = "\n" * text.count("\n", 0, block.start(1))
        exec(compile(padding + block[1], PAGE, "exec"), names)


def test_everything_public_is_documented():
    for name in echelon.__all__:
        thing = getattr(echelon, name)
        if isinstance(thing, type):
            assert thing.__doc__, name
            # The attributes of classes in Python are described with these.
            own = {k: v for k, v in vars(thing).items() if callable(v) or thing.__module__ == "echelon"}
            for method in own:
                if not method.startswith("_"):
                    assert getattr(thing, method).__doc__, f"{name}.{method}"


def test_the_types_are_those_of_the_extension(tmp_path):
    package = pathlib.Path(echelon.__file__).parent.parent
    env = {**os.environ, "MYPYPATH": str(package)}
    for check in (["mypy.stubtest", "--ignore-disjoint-bases", "echelon._echelon"], ["mypy", "-p", "echelon"]):
        done = subprocess.run([sys.executable, "-m", *check], cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
