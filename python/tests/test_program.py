"""`python -m toposlam`, with the program of a wheel and without it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import toposlam.__main__


def test_the_program_runs_or_the_message_has_what_installs_it():
    module = subprocess.run([sys.executable, "-m", "toposlam", "--version"], capture_output=True, text=True)
    if toposlam.__main__.installed_program():
        assert (module.returncode, module.stderr) == (0, "")
        assert module.stdout.startswith("toposlam 0.")
        wrong = subprocess.run([sys.executable, "-m", "toposlam", "wrong"], capture_output=True, text=True)
        assert (wrong.returncode, wrong.stdout) == (2, "")
    else:
        assert (module.returncode, module.stdout) == (2, "")
        assert "`cargo install --path . --locked` installs it" in module.stderr


@pytest.mark.skipif(os.name != "posix", reason="the program of the test is a shell script")
def test_a_wheel_with_the_program_installs_it(tmp_path):
    pytest.importorskip("wheel")
    info = tmp_path / "toposlam-7" / "toposlam-7.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: toposlam\nVersion: 7\n")
    (info / "WHEEL").write_text("Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
    subprocess.run([sys.executable, "-m", "wheel", "pack", "-d", tmp_path, info.parent], check=True)
    wheel = tmp_path / "toposlam-7-py3-none-any.whl"
    program = tmp_path / "toposlam"
    program.write_text("#!/bin/sh\necho the program\n")
    script = Path(__file__).parents[1] / "add-program"
    python = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    subprocess.run([script, wheel, program, tmp_path / "with"], env=python, check=True, capture_output=True)
    (packed,) = (tmp_path / "with").iterdir()
    assert packed.name == wheel.name
    prefix = tmp_path / "prefix"
    install = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-index",
        "--no-deps",
        "--ignore-installed",
    ]
    subprocess.run([*install, "--prefix", prefix, packed], check=True)
    ran = subprocess.run([prefix / "bin" / "toposlam"], capture_output=True, text=True)
    assert (ran.returncode, ran.stdout) == (0, "the program\n")
