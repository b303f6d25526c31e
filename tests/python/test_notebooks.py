"""The notebooks of the book run from top to bottom, and show what they promise."""

import json
import os
import pathlib
import re
import time

import nbformat
import pytest
from nbclient import NotebookClient

FOLDER = pathlib.Path(__file__).parents[2] / "docs" / "python"
# Pictures and plots, tables, and films in what each notebook shows.
PROMISED = {"first-film": (4, 3, 1), "own-law": (3, 1, 0), "training": (2, 2, 2)}
LONGEST = 60.0  # s, for all of them


def stored(name):
    return nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)


@pytest.fixture(scope="module")
def executed(tmp_path_factory):
    """Every notebook as it is after all of its cells have run, and how long all of them took, s."""
    # As a reader's kernel is: plots go into the notebook, and nothing of this user's own Jupyter takes part.
    kernel = {key: value for key, value in os.environ.items() if key != "MPLBACKEND"}
    kernel["IPYTHONDIR"] = str(tmp_path_factory.mktemp("ipython"))
    notebooks, begun = {}, time.monotonic()
    for name in PROMISED:
        notebook, folder = stored(name), tmp_path_factory.mktemp(name)
        client = NotebookClient(notebook, timeout=LONGEST, kernel_name="python3", resources={"metadata": {"path": str(folder)}})
        notebooks[name] = client.execute(env=kernel)
    return notebooks, time.monotonic() - begun


def outputs(notebook):
    """The kinds of data that the cells of a notebook show, and what they print."""
    shown = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    data = [output["data"] for output in shown if "data" in output]
    printed = "".join(output["text"] for output in shown if output.get("name") == "stdout")
    return data, printed


def test_there_are_no_others():
    assert {path.stem for path in FOLDER.glob("*.ipynb")} == set(PROMISED)


@pytest.mark.parametrize("name", PROMISED)
def test_notebooks_are_stored_without_outputs(name):
    notebook = stored(name)
    nbformat.validate(notebook)
    for cell in notebook.cells:
        assert not cell.metadata
        if cell.cell_type == "code":
            assert cell.outputs == [] and cell.execution_count is None
    # As Jupyter writes it, so that a notebook that is saved again differs in what was changed only.
    text = (FOLDER / f"{name}.ipynb").read_text(encoding="utf-8")
    assert text == json.dumps(json.loads(text), indent=1, ensure_ascii=False, sort_keys=True) + "\n"


@pytest.mark.parametrize("name", PROMISED)
def test_notebooks_show_what_they_promise(executed, name):
    data, _ = outputs(executed[0][name])
    pages = [one.get("text/html", "") for one in data]
    pictures = sum("image/png" in one for one in data)
    tables = sum("<table" in page for page in pages)
    films = sum(page.startswith('<video src="data:video/mp4;base64,') for page in pages)
    assert (pictures, tables, films) == PROMISED[name]


def test_the_law_in_numpy_is_that_of_the_scene(executed):
    _, printed = outputs(executed[0]["own-law"])
    difference = re.search(r"at most (\S+) m apart", printed)
    assert float(difference[1]) < 1e-12


def test_training_makes_the_formation_better(executed):
    _, printed = outputs(executed[0]["training"])
    better, starts = map(int, re.search(r"better from (\d+) of (\d+) unseen starts", printed).groups())
    assert starts == 64 and better > 0.9 * starts


def test_all_of_them_take_less_than_a_minute(executed):
    assert executed[1] < LONGEST
