"""The examples of docstrings and of pages print what they say; types are right; code is formatted."""

import doctest
import importlib
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import toposlam

ROOT = Path(__file__).parents[2]
MODULES = [f"toposlam.{info.name}" for info in pkgutil.iter_modules(toposlam.__path__)]


@pytest.mark.parametrize("name", ["toposlam", *MODULES])
def test_examples_of_docstrings(name):
    if name == "toposlam.gym":
        pytest.importorskip("gymnasium")
    assert doctest.testmod(importlib.import_module(name)).failed == 0


def test_examples_of_the_page():
    """The `python` blocks of docs/python.md run in order; the output of its `pycon` blocks is compared."""
    page = "python.md"
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    pytest.importorskip("gymnasium")
    blocks = re.findall(r"^```(python|pycon)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert blocks
    names = {"__name__": "page"}
    (ROOT / "target").mkdir(exist_ok=True)
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner()
    for kind, block in blocks:
        if kind == "python":
            exec(compile(block, page, "exec"), names)
        else:
            test = parser.get_doctest(block, {}, page, page, 0)
            test.globs = names
            runner.run(test, clear_globs=False)
    assert runner.summarize().failed == 0


def test_the_page_lists_all_names_and_markers():
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    names, markers = (
        re.findall(
            r"^\| `([^`]+)` \|", text[text.index(f"\n## {section}\n") :].split("\n## ")[1], re.MULTILINE
        )
        for section in ("All names", "Markers")
    )
    assert sorted(names) == sorted(toposlam.__all__)
    assert tuple(name.strip('"') for name in markers) == toposlam.MARKERS


def run(*arguments, folder=ROOT / "python"):
    command = [sys.executable, "-m", *arguments]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_types_are_strict():
    pytest.importorskip("mypy")
    run("mypy", "toposlam")


def test_the_stub_is_that_of_the_extension_module(tmp_path):
    """That of the installed package: in the folder of its source there is no extension module."""
    pytest.importorskip("mypy")
    configuration = str(ROOT / "python" / "pyproject.toml")
    arguments = ["toposlam._core", "--concise", "--mypy-config-file", configuration]
    run("mypy.stubtest", *arguments, folder=tmp_path)


def test_the_format_is_that_of_ruff():
    pytest.importorskip("ruff")
    run("ruff", "check", ".")
    run("ruff", "format", "--check", ".")


def test_optional_libraries_are_imported_only_when_used():
    code = (
        "import sys, toposlam as ts; "
        "ts.explore(ts.World({1: [2], 2: [1]})); ts.check(lambda robot: None, edges=1, progress=False); "
        "optional = {'gymnasium', 'matplotlib', 'networkx', 'numpy', 'pandas', 'tqdm'}; "
        "print(optional & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "set()", done.stderr
