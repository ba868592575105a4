"""Progress bars, if tqdm is installed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Callable

from .errors import MissingLibraryError

Advance = Callable[[int], object]


def library(name: str, for_what: str) -> Any:
    """An optional library."""
    from importlib import import_module

    try:
        return import_module(name)
    except ImportError as cause:
        text = f"{for_what} needs {name.split('.')[0]}: pip install {name.split('.')[0]}"
        raise MissingLibraryError(text) from cause


def wanted(progress: bool | None) -> bool:
    """Whether to show a bar: if asked for; without an answer on a terminal and in a notebook."""
    if progress is not None:
        return progress
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


@contextmanager
def bar(
    what: str, unit: str, progress: bool | None, total: Callable[[], int | None] = lambda: None
) -> Iterator[Advance | None]:
    """A function that advances a progress bar, or None if there is none."""
    if not wanted(progress):
        yield None
        return
    try:
        tqdm = library("tqdm.auto", "a progress bar")
    except MissingLibraryError:
        if progress:
            raise
        yield None
        return
    with tqdm.tqdm(desc=what, unit=" " + unit, total=total(), leave=False) as shown:
        yield shown.update
