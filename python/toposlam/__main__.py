"""`python -m toposlam`: the program `toposlam`, if this installation has it."""

import os
import subprocess
import sys
from importlib.metadata import files
from pathlib import Path
from typing import Optional

NAMES = ("toposlam", "toposlam.exe")
NO_PROGRAM = """\
toposlam: this installation does not have the program, because it was built from the sources.
Wheels of a release have it.
In a clone of the repository, `cargo install --path . --locked` installs it.
"""


def installed_program() -> Optional[Path]:
    """The program that was installed with this package."""
    named = (Path(str(file.locate())) for file in files("toposlam") or () if file.name in NAMES)
    return next((path for path in named if path.is_file()), None)


def main() -> int:
    """Runs the program with the arguments of this one, and returns its exit code."""
    program = installed_program()
    if program is None:
        sys.stderr.write(NO_PROGRAM)
        return 2
    command = [str(program), *sys.argv[1:]]
    if os.name == "posix":
        os.execv(command[0], command)
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
