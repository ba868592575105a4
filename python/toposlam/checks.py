"""Checks an explorer on every start of every small world."""

from __future__ import annotations

import multiprocessing
import pickle
import re
import sys
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib.metadata import version
from typing import Union

from . import _core
from .errors import (
    ExplorerError,
    LimitError,
    NotPicklableError,
    OutOfTimeError,
    ShardError,
    SizeError,
    UnknownClassError,
    UnknownMarkerError,
    WorkerLostError,
)
from .explorers import Clock, Explorer, check_explorer, judged
from .failures import Failure, failure_of
from .limits import MAX_MOVES, SECONDS, check_limit, check_run_limits, check_unused
from .markers import MARKERS
from .progress import Advance, bar
from .worlds import World

CLASSES = ("multigraph", "simple", "corridor", "planar")
"""The names of the classes of worlds."""

Edges = Union[int, Iterable[int]]


@dataclass(frozen=True)
class SizeReport:
    """The counts of a check for one number of edges."""

    edges: int
    starts: int = 0
    """The starts that were checked."""
    mapped: int = 0
    """The starts that were mapped correctly, by a walk that is not known to be a guess."""
    unknown: int = 0
    """The starts on which the explorer reached a limit."""
    moves: int = 0
    """All moves on the starts that were mapped correctly."""
    most_moves: int = 0
    """The most moves on a start that was mapped correctly."""
    certificate: int = 0
    """The lengths of the certificates of the starts that were mapped correctly, in moves, added up; 0 if the
    marker is not directional."""

    def __add__(self, other: SizeReport) -> SizeReport:
        return SizeReport(
            self.edges,
            self.starts + other.starts,
            self.mapped + other.mapped,
            self.unknown + other.unknown,
            self.moves + other.moves,
            max(self.most_moves, other.most_moves),
            self.certificate + other.certificate,
        )


@dataclass(frozen=True)
class CheckReport:
    """The result of a check."""

    explorer: str
    """The explorer's name."""
    cls: str
    """The class of the worlds."""
    marker: str
    """The kind of marker of the robot."""
    sizes: tuple[SizeReport, ...]
    """The counts for each number of edges."""
    failures: tuple[Failure, ...]
    """The first failures, those in the smallest worlds first."""
    limits: tuple[Failure, ...]
    """The first starts on which the explorer reached a limit, in the same order."""
    max_failures: int
    """The most failures, and the most starts that reached a limit, that are kept."""
    max_moves: int
    """The most moves, pick-ups and drops of a run."""
    seconds: float
    """The most seconds of a run."""
    version: str
    """The version of the package."""
    shards: tuple[int, ...]
    """The shards that were checked, counted from 1."""
    of: int
    """The number of shards."""

    @property
    def starts(self) -> int:
        """The number of starts that were checked."""
        return sum(size.starts for size in self.sizes)

    @property
    def mapped(self) -> int:
        """The number of starts that were mapped correctly."""
        return sum(size.mapped for size in self.sizes)

    @property
    def unknown(self) -> int:
        """The number of starts on which the explorer reached a limit of moves or of time."""
        return sum(size.unknown for size in self.sizes)

    @property
    def failed(self) -> int:
        """The number of starts on which the explorer failed."""
        return self.starts - self.mapped - self.unknown

    @property
    def is_complete(self) -> bool:
        """Whether every shard was checked."""
        return len(self.shards) == self.of

    @property
    def verdict(self) -> str:
        """`"holds"` or `"violated"`; `"not known"` if no start failed, and shards are missing or a limit was
        reached."""
        if self.failed:
            return "violated"
        is_known = self.is_complete and self.starts and not self.unknown
        return "holds" if is_known else "not known"

    @property
    def moves(self) -> int:
        """All moves on the starts that were mapped correctly."""
        return sum(size.moves for size in self.sizes)

    @property
    def mean_moves(self) -> float | None:
        """The mean number of moves on the starts that were mapped correctly."""
        return self.moves / self.mapped if self.mapped else None

    @property
    def most_moves(self) -> int:
        """The most moves on a start that was mapped correctly."""
        return max((size.most_moves for size in self.sizes), default=0)

    @property
    def vs_certificate(self) -> float | None:
        """The moves divided by those of the certificates. No correct explorer makes fewer moves, so it is
        never below 1.0. None if the marker is not directional, or no start was mapped correctly."""
        certificate = sum(size.certificate for size in self.sizes)
        return self.moves / certificate if certificate else None

    def merge(self, *others: CheckReport) -> CheckReport:
        """The report of several shards together. The order does not matter. Raises `ShardError` if a shard
        occurs twice, or the reports are not of one check: of one explorer's name, class, marker, limits and
        version."""
        reports = sorted((self, *others), key=lambda report: report.shards)
        shards = tuple(sorted(shard for report in reports for shard in report.shards))
        if len(set(shards)) < len(shards):
            raise ShardError(f"a shard occurs twice: {shards}")
        sizes: dict[int, SizeReport] = {size.edges: SizeReport(size.edges) for size in self.sizes}
        for report in reports:
            if report._head() != self._head() or [size.edges for size in report.sizes] != list(sizes):
                raise ShardError("the reports are not of one check")
            for size in report.sizes:
                sizes[size.edges] += size

        def first(failures: Iterable[Failure]) -> tuple[Failure, ...]:
            order = sorted(failures, key=lambda failure: (failure.world.edge_count, failure.number))
            return tuple(order[: self.max_failures])

        failures = first(failure for report in reports for failure in report.failures)
        limits = first(limit for report in reports for limit in report.limits)
        return replace(self, sizes=tuple(sizes.values()), failures=failures, limits=limits, shards=shards)

    def _with_larger(self, other: CheckReport) -> CheckReport:
        """The report with that of larger worlds."""
        kept = self.max_failures
        failures, limits = (self.failures + other.failures)[:kept], (self.limits + other.limits)[:kept]
        return replace(self, sizes=self.sizes + other.sizes, failures=failures, limits=limits)

    def _head(self) -> tuple[object, ...]:
        """What is the same in all shards of a check."""
        limits = (self.max_failures, self.max_moves, self.seconds)
        return (self.explorer, self.cls, self.marker, self.of, *limits, self.version)

    def __repr__(self) -> str:
        edges = ", ".join(str(size.edges) for size in self.sizes)
        text = f"{self.mapped:,} of {self.starts:,} starts mapped correctly"
        if self.unknown:
            text += f", {self.unknown:,} not known"
        mean = self.mean_moves
        if mean is not None:
            text += f", {mean:.2f} moves on average, at most {self.most_moves}"
        if self.vs_certificate is not None:
            text += f", {self.vs_certificate:.2f} times the certificate"
        return f"<CheckReport {self.verdict}: {self.explorer}, {self.cls}, edges {edges}: {text}>"


@dataclass(frozen=True)
class _Question:
    """A check of an explorer."""

    explorer: Explorer
    edges: tuple[int, ...]
    cls: str
    marker: str
    max_moves: int
    seconds: float
    max_failures: int
    stop_after: int | None = None
    keep_going: bool = True

    @property
    def name(self) -> str:
        return getattr(self.explorer, "__name__", type(self.explorer).__name__)

    def total(self) -> int:
        return sum(_core.count_starts(self.cls, edges) for edges in self.edges)


def _edges(edges: Edges) -> tuple[int, ...]:
    try:
        wanted = [edges] if isinstance(edges, int) else list(edges)
    except TypeError:
        wanted = [edges]  # type: ignore[list-item]
    for number in wanted:
        if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= 32:
            raise SizeError(f"a number of edges is from 1 to 32, not {number!r}")
    if not wanted:
        raise SizeError("no number of edges is given: an empty check never holds")
    return tuple(sorted(set(wanted)))


def _question(
    explorer: Explorer,
    edges: Edges,
    cls: str,
    marker: str,
    max_moves: int,
    seconds: float,
    max_failures: int,
) -> _Question:
    check_explorer(explorer)
    if cls not in CLASSES:
        raise UnknownClassError(f"{cls!r} is not a class of worlds; they are {', '.join(CLASSES)}")
    if marker not in MARKERS:
        raise UnknownMarkerError(f"{marker!r} is not a marker; they are {', '.join(MARKERS)}")
    check_limit("max_failures", max_failures)
    check_run_limits(max_moves, seconds)
    wanted = _edges(edges)
    return _Question(explorer, wanted, cls, marker, max_moves, seconds, max_failures)


def _checked(question: _Question, index: int, of: int, advance: Advance | None) -> CheckReport:
    """The report of one shard, counted from 0."""
    sizes = []
    failures: list[Failure] = []
    limits: list[Failure] = []
    with Clock(question.seconds) as clock:
        for edges in question.edges:
            found = (failures, limits)
            sizes.append(_size(question, edges, (index, of), found, (clock, advance)))
    return CheckReport(
        explorer=question.name,
        cls=question.cls,
        marker=question.marker,
        sizes=tuple(sizes),
        failures=tuple(failures),
        limits=tuple(limits),
        max_failures=question.max_failures,
        max_moves=question.max_moves,
        seconds=question.seconds,
        version=version("toposlam"),
        shards=(index + 1,),
        of=of,
    )


class _EnoughError(Exception):
    """As many starts as are wanted failed, or reached a limit."""


def _size(
    question: _Question,
    edges: int,
    shard: tuple[int, int],
    found: tuple[list[Failure], list[Failure]],
    tools: tuple[Clock, Advance | None],
) -> SizeReport:
    clock, advance = tools
    explorer, marker, bound = question.explorer, question.marker, question.max_moves
    with_certificates = marker == "directional"
    failures, limits = found
    starts = mapped = unknown = total = most = certificates = shown = 0

    def visit(start: _core.Start) -> None:
        nonlocal starts, mapped, unknown, total, most, certificates, shown
        robot = start.robot(marker, bound)
        error = judged(explorer, start, robot, clock)
        starts += 1
        if error is None:
            moves = robot.moves
            mapped += 1
            total += moves
            most = max(most, moves)
            if with_certificates:
                certificates += start.certificate
        else:
            is_limit = isinstance(error, LimitError)
            unknown += is_limit
            kept = limits if is_limit else failures
            if len(kept) < question.max_failures:
                kept.append(_failure(question, start, robot, error))
        if advance is not None and starts - shown == 256:
            advance(starts - shown)
            shown = starts
        is_stuck = isinstance(error, OutOfTimeError) and not question.keep_going
        if is_stuck or (question.stop_after is not None and starts - mapped >= question.stop_after):
            raise _EnoughError

    with suppress(_EnoughError):
        _core.visit_starts(question.cls, edges, *shard, visit)
    if advance is not None:
        advance(starts - shown)
    return SizeReport(edges, starts, mapped, unknown, total, most, certificates)


def _failure(question: _Question, start: _core.Start, robot: _core.Robot, error: ExplorerError) -> Failure:
    name = f"{question.cls}-{start.edges}-{start.number}"
    core = start.world(name)
    text = f"{name} v0:{core.start_text(0).split(':', 1)[1]}"
    return failure_of(World._of(core), text, error, robot, question.marker, start.number)


def check(
    explorer: Explorer,
    edges: Edges = range(1, 6),
    cls: str = "multigraph",
    *,
    marker: str = "directional",
    max_moves: int = MAX_MOVES,
    seconds: float = SECONDS,
    max_failures: int = 100,
    stop_after: int | None = None,
    keep_going: bool = False,
    processes: int = 1,
    progress: bool | None = None,
) -> CheckReport:
    """Checks an explorer on every start of every world with `edges` edges: a number, or several.

    After a number of edges with a start that failed or reached a limit, worlds with more edges are not
    checked, and after a start that took too long nothing more, unless `keep_going`. With `stop_after`, the
    check ends after so many starts that failed or reached a limit.

    `cls` is the class of the worlds, one of `CLASSES`, and `marker` the kind of the robot's marker, one of
    `MARKERS`. A map is right if it is isomorphic to the world, start to start, and the robot is where the
    explorer says. A right map after a walk that does not determine the world is a guess, which fails: there
    is another world in which the explorer makes the same walk, and returns the same map. With another
    marker than `"directional"` and `"none"` that is not known, and no map is called a guess.

    After `max_moves` moves, pick-ups and drops, or `seconds` seconds for a start (`math.inf` is no limit),
    its result is not known. The report keeps the first `max_failures` failures, and as many starts that
    reached a limit. With several `processes` the report is the same, unless a start takes too long: then each
    process ends by itself. `progress` shows a bar or not; without
    it, on a terminal and in a notebook.

    Raises `NotAnExplorerError`, `SizeError`, `UnknownClassError` or `UnknownMarkerError` for arguments that
    cannot be; with several processes also `NotPicklableError`, `WorkerLostError` if one of them ends, and
    `UnusedOptionError` for `stop_after`.

    >>> import toposlam as ts
    >>> def there(robot):
    ...     robot.go(0)
    ...     return {0: [1], 1: [0]}, (1, 0)
    >>> report = ts.check(there, edges=[1, 2, 3], cls="simple")
    >>> report.verdict, report.mapped, report.starts
    ('violated', 1, 3)
    >>> print(report.failures[0])
    start simple-2-0 v0:v1, after 1 move: the map is not the world: 1 edge against 2
    """
    question = _question(explorer, edges, cls, marker, max_moves, seconds, max_failures)
    check_limit("processes", processes)
    if stop_after is not None:
        check_limit("stop_after", stop_after)
    if processes > 1:
        check_unused("with several processes", stop_after=stop_after)
        _check_picklable(question)
    report, failed = None, 0
    with bar("checking", "starts", progress, question.total) as advance:
        for size in question.edges:
            left = None if stop_after is None else stop_after - failed
            one = replace(question, edges=(size,), stop_after=left, keep_going=keep_going)
            found = _checked(one, 0, 1, advance) if processes == 1 else _in_processes(one, processes, advance)
            report = found if report is None else report._with_larger(found)
            failed = report.starts - report.mapped
            if (failed and not keep_going) or (stop_after is not None and failed >= stop_after):
                break
    assert report is not None  # there is a size
    return report


def _check_picklable(question: _Question) -> None:
    try:
        pickle.dumps(question.explorer)
    except Exception as cause:
        text = f"{question.name} cannot be sent to another process; define it at the top of a module"
        raise NotPicklableError(f"{text} ({cause})") from cause


def _in_processes(question: _Question, processes: int, advance: Advance | None) -> CheckReport:
    # A forked process has the functions of a notebook. Others import them.
    fork = sys.platform == "linux"
    context = multiprocessing.get_context("fork") if fork else multiprocessing.get_context()
    of = 8 * processes
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(processes, mp_context=context)
    try:
        shards = [pool.submit(_checked, question, index, of, None) for index in range(of)]
        reports = []
        for done in as_completed(shards):
            reports.append(done.result())
            if advance is not None:
                advance(reports[-1].starts)
        pool.shutdown()
    except BaseException as cause:
        # After Ctrl-C, nobody waits for the shards that are running.
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in set(multiprocessing.active_children()) - others:
            worker.terminate()
        if isinstance(cause, BrokenProcessPool):
            raise WorkerLostError("a worker process of the check ended before its result") from cause
        raise
    return replace(reports[0].merge(*reports[1:]), shards=(1,), of=1)


def shards(count: int) -> list[str]:
    """The names of the shards of a check: `1/n` to `n/n`.

    >>> import toposlam as ts
    >>> ts.shards(3)
    ['1/3', '2/3', '3/3']
    """
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= 1_000_000:
        raise ShardError(f"a number of shards is from 1 to 1,000,000, not {count!r}")
    return [f"{index}/{count}" for index in range(1, count + 1)]


def check_shard(
    shard: str,
    explorer: Explorer,
    edges: Edges = range(1, 6),
    cls: str = "multigraph",
    *,
    marker: str = "directional",
    max_moves: int = MAX_MOVES,
    seconds: float = SECONDS,
    max_failures: int = 100,
) -> CheckReport:
    """Checks one of the disjoint shards of a check, for a cluster. `CheckReport.merge` adds the reports up.

    The other arguments are those of `check`. Raises what `check` does, and `ShardError` if `shard` is none.

    >>> import toposlam as ts
    >>> def there(robot):
    ...     robot.go(0)
    ...     return {0: [1], 1: [0]}, (1, 0)
    >>> reports = [ts.check_shard(s, there, edges=1, cls="simple") for s in ts.shards(2)]
    >>> ts.merge(reports).verdict
    'holds'
    """
    parts = re.fullmatch(r"(\d+)/(\d+)", shard) if isinstance(shard, str) else None
    if parts is None or not 1 <= int(parts[1]) <= int(parts[2]):
        raise ShardError(f"{shard!r} is not a shard; write i/n with i from 1 to n, for example '2/4'")
    question = _question(explorer, edges, cls, marker, max_moves, seconds, max_failures)
    return _checked(question, int(parts[1]) - 1, int(parts[2]), None)


def merge(reports: Sequence[CheckReport]) -> CheckReport:
    """The report of several shards together. The order does not matter. Raises `ShardError` if they are not
    disjoint shards of one check."""
    listed = list(reports)
    if not listed or not all(isinstance(report, CheckReport) for report in listed):
        raise ShardError("merge needs reports of shards")
    return listed[0].merge(*listed[1:])
