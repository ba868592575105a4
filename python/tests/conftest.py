"""What the tests share."""

import os
import signal
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(Path(__file__).parent))

# A shell that starts the tests in the background ignores Ctrl-C in them. Then Python would not raise
# KeyboardInterrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True)
def in_the_repository(monkeypatch):
    """Paths like worlds/figure-1a.toml are relative to the repository."""
    monkeypatch.chdir(ROOT)


@pytest.fixture
def required():
    """Skips a test without a program, unless `TOPOSLAM_PYTHON` is `required`."""

    def skip(reason):
        if os.environ.get("TOPOSLAM_PYTHON") == "required":
            pytest.fail(reason)
        pytest.skip(reason)

    return skip
