"""The script of docs/cluster.md: worker processes of Dask, one of them killed in the middle."""

import re
import subprocess
import sys
from pathlib import Path

import pytest


def test_the_script_of_the_page_prints_what_the_page_says(tmp_path):
    pytest.importorskip("distributed")
    page = (Path(__file__).parents[2] / "docs" / "cluster.md").read_text(encoding="utf-8")
    script = re.search(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)[1]
    expected = re.search(r"^```text\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)[1]
    (tmp_path / "cluster.py").write_text(script, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "cluster.py"], cwd=tmp_path, capture_output=True, text=True, timeout=180
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == expected, done.stderr
