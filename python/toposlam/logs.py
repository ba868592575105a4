"""Recorded logs: what they contain, and whether they conform to the specification."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import _core
from .errors import LogError
from .limits import check_limit, check_unused
from .progress import bar, library
from .worlds import Dart, Picture, World, world_of


class Table(Mapping[str, "list[Any]"]):
    """Columns of the same length: `table["time"]`. Values that are not recorded are None."""

    __slots__ = ("_columns",)

    def __init__(self, columns: Mapping[str, list[Any]]) -> None:
        self._columns = dict(columns)

    def __getitem__(self, name: str) -> list[Any]:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """The number of rows."""
        return len(next(iter(self._columns.values()), []))

    def pandas(self) -> Any:
        """The table as a `pandas.DataFrame`."""
        return library("pandas", "a table as a DataFrame").DataFrame(self._columns)

    def numpy(self) -> dict[str, Any]:
        """Each column as a numpy array. A column of integers is one of integers; one of numbers and None is
        one of floats, NaN for None; any other is one of objects."""
        numpy = library("numpy", "a table as arrays")

        def array(column: list[Any]) -> Any:
            if all(value is None or isinstance(value, (int, float)) for value in column):
                return numpy.array([float("nan") if value is None else value for value in column])
            values = numpy.empty(len(column), dtype=object)
            for row, value in enumerate(column):
                values[row] = value
            return values

        return {name: array(column) for name, column in self._columns.items()}

    def __repr__(self) -> str:
        return f"<Table of {self.rows} rows: {', '.join(self)}>"


@dataclass(frozen=True)
class Log:
    """A log, read into memory. Times are seconds since its first message."""

    path: Path
    format: str
    """`mcap`, `bag`, `rosbag2`, `db3`, `carmen` or `events`."""
    topics: tuple[tuple[str, str, int], ...]
    """Each topic: its name, its type, and the number of its messages."""
    head: Mapping[str, str]
    """World, start, marker and algorithm, as far as the log records them."""
    truncation: str | None
    """Why the end of the log is missing, if it is."""
    duration: float
    """Seconds from the first message to the last."""
    events: Table
    """Recorded percepts and doors: `time`, `message`, `kind`, `degree`, `percept`, `door`, `text`."""
    scenes: Table
    """Recorded scenes: `time`, `message`, `place`, `doors`, `heading`, `left`, `right`, `marker`; angles in
    radians, lengths in metres, relative to the robot."""
    poses: Table
    """Odometry: `time`, `x`, `y`, `heading`, in metres and radians."""
    _reader: _core.LogReader = field(repr=False)

    def draw(self) -> Picture:
        """What the scans of a laser log hit, and the robot's way."""
        return Picture(_core.log_picture(self._reader, self.path.name))


def read_log(path: str | os.PathLike[str], *, progress: bool | None = None) -> Log:
    """Reads a log: MCAP, a ROS 1 bag, a folder of rosbag2, a CARMEN log, or a list of events.

    `progress` shows a bar or not; without it, on a terminal and in a notebook. Raises `LogError` if the file
    cannot be read.
    """
    reader = _open(path)
    with bar("reading", "messages", progress) as advance:
        tables = reader.tables(advance)
    first, last = reader.times or (0, 0)
    return Log(
        path=Path(path),
        format=reader.format,
        topics=tuple(reader.topics),
        head=reader.head,
        truncation=reader.truncation,
        duration=(last - first) / 1e9,
        events=Table(tables["events"]),
        scenes=Table(tables["scenes"]),
        poses=Table(tables["poses"]),
        _reader=reader,
    )


def _open(path: str | os.PathLike[str]) -> _core.LogReader:
    file = Path(path)
    if not file.exists():
        raise LogError(f"{file}: there is no such file")
    return _core.LogReader(file)


@dataclass(frozen=True)
class LogEvent:
    """An event of a log that was checked."""

    number: int
    """Its number, from 1."""
    time: float
    """Seconds since the first event."""
    kind: str
    """`percept`, `door`, `aside`, `turned-back` or `undecided`."""
    percept: _core.Percept | None
    door: int | None
    pose: Dart | None
    """The robot's pose in the known world, if only one fits."""


@dataclass(frozen=True)
class Divergence:
    """The first event that the specification does not allow."""

    event: int
    """Its number, from 1; one more than there are if an event is missing at the end."""
    cause: str
    """The cause, one word."""
    fault: str
    """The class of the fault: perception, motion, algorithm or log."""
    why: str
    """The condition that is false."""


@dataclass(frozen=True)
class ConformReport:
    """The report on a log."""

    path: Path
    verdict: str
    """`conforms`, `diverged` or `not-known`."""
    evidence: str
    """The source of the events: `recorded`, `scenes`, `pictures` or `laser`."""
    events: tuple[LogEvent, ...]
    divergence: Divergence | None
    coverage: Mapping[str, int]
    """The cases of Algorithm 1, and how often the log covered each."""
    world: World | None
    """The known world; without corners if the events have none."""
    smallest: World | None
    """If no world is known: the smallest world that explains the log."""
    is_smallest: bool
    """Whether all worlds smaller than `smallest` were excluded."""
    determines_world: bool | None
    """Whether no other world explains the log; None if that is not known."""
    candidates: int
    """The number of poses in which the robot may be after the last event that fits."""
    hallways: tuple[int, int, int]
    """The number of moves, of those measured by odometry, and of those compared with earlier ones."""
    remarks: tuple[str, ...]
    """What a reader should know: the log was recorded in another world, goes on from an earlier run, or has
    lines or messages that were skipped."""

    def pandas(self) -> Any:
        """The events as a `pandas.DataFrame`, a row for each."""
        columns = ("number", "time", "kind", "percept", "door", "pose")
        return Table({name: [getattr(event, name) for event in self.events] for name in columns}).pandas()

    def __repr__(self) -> str:
        text = f"{self.path.name}: {self.verdict}, {len(self.events)} events, {self.evidence}"
        if self.divergence is not None:
            text += f"; event {self.divergence.event}: {self.divergence.why}"
        return f"<ConformReport {text}>"


def conform(
    path: str | os.PathLike[str],
    world: World | None = None,
    *,
    driver: str = "algorithm",
    marker: str | None = None,
    assume_marker: bool = False,
    cls: str | None = None,
    corners: bool = False,
    max_edges: int | None = None,
    max_steps: int | None = None,
    max_darts: int | None = None,
    progress: bool | None = None,
) -> ConformReport:
    """Checks a log against the specification, in a known world or with the smallest that explains it.

    `driver` is what chose the doors: `"algorithm"` as the log records it, or else `"algorithm1"` or
    `"folding"`, or `"anyone"`. `marker` is the name of the robot's marking aid, by
    default that of the log; `assume_marker` adds one at the first junction of a
    laser log. With `corners`, the bends of corridors are vertices in a laser log; otherwise they are none in
    the world either.

    Without a world, the search for one is bounded: `cls` is its class (`"multigraph"`), `max_edges` the
    most edges, and `max_steps` (500,000) the most steps. `max_darts` is the most darts of the map that the
    algorithm is allowed; by default it is that of the log, or 1,000. If a bound is reached, the verdict is
    `not-known`. `progress` shows a bar or not; without it, on a terminal and in a notebook.

    Returns the report: the verdict, the events, and the first divergence or the world.

    Raises `LogError` if the log cannot be read or does not record what is needed, `WorldTypeError`,
    `UnknownAlgorithmError`, `UnknownMarkerError`, `UnknownClassError`, `SizeError`, or `UnusedOptionError`
    for an option that has no effect: a bound of the search with a world, or `corners` for a log without a
    laser.
    """
    core = None if world is None else world_of(world)._core
    if world is not None:
        check_unused("with a world", cls=cls, max_edges=max_edges, max_steps=max_steps)
    cls = "multigraph" if cls is None else cls
    max_steps = 500_000 if max_steps is None else max_steps
    limits = {"max_edges": max_edges, "max_steps": max_steps, "max_darts": max_darts}
    for name, value in limits.items():
        if value is not None:
            check_limit(name, value)
    reader = _open(path)
    options = (core, marker, driver, cls, corners, assume_marker, max_edges, max_steps, max_darts)
    with bar("checking", "images and scans", progress) as advance:
        found = _core.conform(reader, *options, advance)
    if corners and found["evidence"] != "laser":
        check_unused("for a log without a laser", corners=corners)
    known = world
    if world is not None and found["evidence"] == "laser" and not corners:
        known = world.without_corners()
    places = [] if known is None else known.darts()
    events = tuple(
        LogEvent(number, time, kind, percept, door, None if pose is None else places[pose])
        for number, (time, kind, percept, door, pose) in enumerate(found["events"], start=1)
    )
    first = found.get("divergence")
    smallest = found.get("smallest")
    return ConformReport(
        path=Path(path),
        verdict=found["verdict"],
        evidence=found["evidence"],
        events=events,
        divergence=first and Divergence(**first),
        coverage=found["coverage"],
        world=known,
        smallest=None if smallest is None else World._of(smallest),
        is_smallest=found.get("is_least", False),
        determines_world=found["determines_world"],
        candidates=found["candidates"],
        hallways=tuple(found["hallways"]),
        remarks=tuple(found["remarks"]),
    )
