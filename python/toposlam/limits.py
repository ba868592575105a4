"""Checks the limits that a caller gives."""

from __future__ import annotations

from .errors import SizeError, UnusedOptionError

MAX_MOVES = 100_000
"""The most moves, pick-ups and drops of an explorer in a run, unless the caller gives another number."""

SECONDS = 10.0
"""The most seconds of an explorer for a start, unless the caller gives another number; `math.inf` is no
limit."""


def check_limit(name: str, value: object) -> None:
    """Raises a `SizeError` if a value is not a number from 1."""
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value < 2**63:
        raise SizeError(f"{name} is a number from 1, not {value!r}")


def check_run_limits(max_moves: object, seconds: object) -> None:
    """Raises a `SizeError` if these cannot be the limits of a run."""
    check_limit("max_moves", max_moves)
    if isinstance(seconds, bool) or not isinstance(seconds, (int, float)) or not seconds > 0:
        raise SizeError(f"seconds is a number above 0, not {seconds!r}")


def check_unused(why: str, **options: object) -> None:
    """Raises an `UnusedOptionError` if an option without effect is given."""
    for name, value in options.items():
        if value is not None:
            raise UnusedOptionError(f"{name} has no effect {why}")
