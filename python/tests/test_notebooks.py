"""The notebooks run from top to bottom."""

import json
import os
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(path.name for path in FOLDER.glob("*.ipynb"))
CARMEN = Path(os.environ.get("TOPOSLAM_CARMEN_LOGS", "/nowhere"))


def test_there_are_three_without_outputs():
    assert [name[0] for name in NOTEBOOKS] == ["1", "2", "3"]
    for name in NOTEBOOKS:
        cells = json.loads((FOLDER / name).read_text(encoding="utf-8"))["cells"]
        assert all(not cell.get("outputs") for cell in cells), name


def test_the_explorer_is_that_of_the_tests():
    explorer = Path(__file__).with_name("depth_first.py").read_text(encoding="utf-8")
    explorer = explorer.split("\n\n\n", 1)[1].strip()
    cells = json.loads((FOLDER / NOTEBOOKS[1]).read_text(encoding="utf-8"))["cells"]
    assert explorer in ["".join(cell["source"]) for cell in cells]
    page = Path(__file__).parents[2] / "docs" / "python.md"
    assert explorer in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_runs(name):
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    if name.startswith("3") and not (CARMEN / "aces.log.gz").exists():
        pytest.skip("TOPOSLAM_CARMEN_LOGS names no folder with aces.log.gz")
    notebook = nbformat.read(FOLDER / name, as_version=4)
    client = nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(FOLDER)}})
    client.execute()
    pictures = [
        output
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if "image/svg+xml" in output.get("data", {})
    ]
    assert pictures
