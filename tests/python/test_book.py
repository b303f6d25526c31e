"""What the book says of Python is true."""

import os
import pathlib
import re
import subprocess
import sys

import echelon
import echelon.envs

ROOT = pathlib.Path(__file__).parents[2]
PAGE, REFERENCE = ROOT / "docs" / "python.md", ROOT / "docs" / "python-api.md"


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


def test_the_reference_is_up_to_date():
    script = ROOT / "scripts" / "python-reference"
    done = subprocess.run([sys.executable, script, "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_reference_has_everything_public():
    text = REFERENCE.read_text(encoding="utf-8")
    headings = set(re.findall(r"^###+ `([\w.]+)`$", text, re.MULTILINE))
    values = set(re.findall(r"`(\w+)`", " ".join(re.findall(r"^\| (`.+?`) \|", text, re.MULTILINE))))
    for module in (echelon, echelon.envs):
        for name in module.__all__:
            thing = getattr(module, name)
            assert name in (headings if callable(thing) else headings | values), name
            methods = [key for key, value in vars(thing).items() if callable(value)] if isinstance(thing, type) else []
            own = [key for key in methods if not key.startswith("_") and key not in getattr(thing, "_fields", ())]
            # What a class only hands on from another library is that library's to document.
            assert {f"{name}.{key}" for key in own if getattr(thing, key).__doc__} <= headings, name
    anchors = {"".join(c for c in heading.lower() if c.isalnum() or c in "-_") for heading in headings}
    anchors |= {"echelon", "echelonenvs"}
    assert set(re.findall(r"\]\(#(.*?)\)", text)) <= anchors


def test_the_types_are_those_of_the_extension(tmp_path):
    package = pathlib.Path(echelon.__file__).parent.parent
    # mypy finds what is installed by itself, and refuses to be told of it.
    env = dict(os.environ) if package.name == "site-packages" else {**os.environ, "MYPYPATH": str(package)}
    for check in (["mypy.stubtest", "--ignore-disjoint-bases", "echelon._echelon"], ["mypy", "-p", "echelon"]):
        done = subprocess.run([sys.executable, "-m", *check], cwd=tmp_path, env=env, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
