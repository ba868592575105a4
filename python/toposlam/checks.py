"""Checks an explorer on every start of every small world."""

from __future__ import annotations

import multiprocessing
import pickle
import re
import sys
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from typing import Union

from . import _core
from .errors import (
    ExplorerError,
    LimitError,
    NotPicklableError,
    ShardError,
    SizeError,
    UnknownClassError,
    UnknownMarkerError,
)
from .explorers import MAX_MOVES, SECONDS, Clock, Explorer, check_explorer, judged
from .markers import MARKERS
from .progress import Advance, bar
from .worlds import Picture, World

CLASSES = ("multigraph", "simple", "corridor", "planar")
"""The names of the classes of worlds."""

Edges = Union[int, Iterable[int]]


@dataclass(frozen=True)
class Failure:
    """A start on which an explorer failed, or reached a limit."""

    world: World
    """The world, with the start."""
    error: ExplorerError
    """What is wrong. Its class is the cause."""
    actions: tuple[int | str, ...]
    """What the robot did."""
    number: int
    """The number of the start among those with as many edges."""

    @property
    def moves(self) -> int:
        """The number of moves made."""
        return sum(isinstance(action, int) for action in self.actions)

    def draw(self) -> Picture:
        """The world, with what is wrong below it."""
        text = self.error.message
        moves = f"after {self.moves} move{'' if self.moves == 1 else 's'}"
        caption = f"{moves}: {text if len(text) <= 90 else text[:87] + '...'}"
        return self.world.draw(title=f"fails on {self.world.name}", caption=caption)

    def _repr_svg_(self) -> str:
        return self.draw().svg

    def __str__(self) -> str:
        return str(self.error)


@dataclass(frozen=True)
class SizeReport:
    """The counts of a check for one number of edges."""

    edges: int
    starts: int = 0
    mapped: int = 0
    """The starts that were mapped right."""
    unknown: int = 0
    """The starts on which the explorer reached a limit."""
    moves: int = 0
    """All moves on those starts."""
    max_moves: int = 0
    certificate: int = 0
    """The lengths of the certificates of those starts, added up."""
    below_certificate: int = 0
    """Starts that were mapped right in fewer moves than their certificate has: the explorer guessed."""

    def __add__(self, other: SizeReport) -> SizeReport:
        return SizeReport(
            self.edges,
            self.starts + other.starts,
            self.mapped + other.mapped,
            self.unknown + other.unknown,
            self.moves + other.moves,
            max(self.max_moves, other.max_moves),
            self.certificate + other.certificate,
            self.below_certificate + other.below_certificate,
        )


@dataclass(frozen=True)
class CheckReport:
    """The result of a check."""

    explorer: str
    cls: str
    marker: str
    sizes: tuple[SizeReport, ...]
    failures: tuple[Failure, ...]
    """The first failures, those in the smallest worlds first."""
    limits: tuple[Failure, ...]
    """The first starts on which the explorer reached a limit, in the same order."""
    max_failures: int
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
        """The number of starts that were mapped right."""
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
        """All moves on the starts that were mapped right."""
        return sum(size.moves for size in self.sizes)

    @property
    def mean_moves(self) -> float | None:
        """The mean number of moves on the starts that were mapped right."""
        return self.moves / self.mapped if self.mapped else None

    @property
    def max_moves(self) -> int:
        """The most moves on a start that was mapped right."""
        return max((size.max_moves for size in self.sizes), default=0)

    @property
    def vs_certificate(self) -> float | None:
        """How many times as many moves as the certificates have: 1.0 is the least that any correct explorer
        can reach. None if the marker is not directional."""
        certificate = sum(size.certificate for size in self.sizes)
        return self.moves / certificate if certificate else None

    @property
    def below_certificate(self) -> int:
        """Starts that were mapped right in fewer moves than their certificate has: the explorer guessed, and
        fails in another world."""
        return sum(size.below_certificate for size in self.sizes)

    def merge(self, *others: CheckReport) -> CheckReport:
        """The report of several shards together. The order does not matter."""
        reports = sorted((self, *others), key=lambda report: report.shards)
        shards = tuple(sorted(shard for report in reports for shard in report.shards))
        if len(set(shards)) < len(shards):
            raise ShardError(f"a shard occurs twice: {shards}")
        head = (self.explorer, self.cls, self.marker, self.of, self.max_failures)
        sizes: dict[int, SizeReport] = {size.edges: SizeReport(size.edges) for size in self.sizes}
        for report in reports:
            same = (report.explorer, report.cls, report.marker, report.of, report.max_failures)
            if same != head or [size.edges for size in report.sizes] != list(sizes):
                raise ShardError("the reports are not of one check")
            for size in report.sizes:
                sizes[size.edges] += size

        def first(failures: Iterable[Failure]) -> tuple[Failure, ...]:
            order = sorted(failures, key=lambda failure: (failure.world.edge_count, failure.number))
            return tuple(order[: self.max_failures])

        failures = first(failure for report in reports for failure in report.failures)
        limits = first(limit for report in reports for limit in report.limits)
        return replace(self, sizes=tuple(sizes.values()), failures=failures, limits=limits, shards=shards)

    def __repr__(self) -> str:
        edges = ", ".join(str(size.edges) for size in self.sizes)
        text = f"{self.mapped:,} of {self.starts:,} starts mapped right"
        if self.unknown:
            text += f", {self.unknown:,} not known"
        mean = self.mean_moves
        if mean is not None:
            text += f", {mean:.2f} moves on average, at most {self.max_moves}"
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
    seconds: float | None
    max_failures: int

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
    seconds: float | None,
    max_failures: int,
) -> _Question:
    check_explorer(explorer)
    if cls not in CLASSES:
        raise UnknownClassError(f"{cls!r} is not a class of worlds; they are {', '.join(CLASSES)}")
    if marker not in MARKERS:
        raise UnknownMarkerError(f"{marker!r} is not a marker; they are {', '.join(MARKERS)}")
    for name, value in {"max_moves": max_moves, "max_failures": max_failures}.items():
        if isinstance(value, bool) or not isinstance(value, int) or value < 1:
            raise SizeError(f"{name} is a number from 1, not {value!r}")
    if seconds is not None and not seconds > 0:
        raise SizeError(f"seconds is more than 0, not {seconds!r}")
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
        shards=(index + 1,),
        of=of,
    )


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
    starts = mapped = unknown = total = most = certificates = below = shown = 0

    def visit(start: _core.Start) -> None:
        nonlocal starts, mapped, unknown, total, most, certificates, below, shown
        robot = start.robot(marker, bound)
        error = judged(explorer, start, robot, clock)
        starts += 1
        if error is None:
            moves = robot.moves
            mapped += 1
            total += moves
            most = max(most, moves)
            if with_certificates:
                certificate = start.certificate
                certificates += certificate
                below += moves < certificate
        else:
            is_limit = isinstance(error, LimitError)
            unknown += is_limit
            kept = limits if is_limit else failures
            if len(kept) < question.max_failures:
                kept.append(_failure(question.cls, start, robot, error))
        if advance is not None and starts - shown == 256:
            advance(starts - shown)
            shown = starts

    _core.visit_starts(question.cls, edges, *shard, visit)
    if advance is not None:
        advance(starts - shown)
    return SizeReport(edges, starts, mapped, unknown, total, most, certificates, below)


def _failure(cls: str, start: _core.Start, robot: _core.Robot, error: ExplorerError) -> Failure:
    name = f"{cls}-{start.edges}-{start.number}"
    core = start.world(name)
    error.start = f"{name} v0:{core.start_text(0).split(':', 1)[1]}"
    error.moves = robot.moves
    return Failure(World._of(core), error, tuple(robot.actions), start.number)


def check(
    explorer: Explorer,
    edges: Edges = range(1, 6),
    cls: str = "multigraph",
    *,
    marker: str = "directional",
    max_moves: int = MAX_MOVES,
    seconds: float | None = SECONDS,
    max_failures: int = 100,
    processes: int = 1,
    progress: bool | None = None,
) -> CheckReport:
    """Checks an explorer on every start of every world with `edges` edges: a number, or several.

    A map is right if it is isomorphic to the world, start to start, and the robot is where the explorer
    says. After `max_moves` moves, or `seconds` seconds for a start, its result is not known. With several
    `processes` the report is the same.

    >>> import toposlam as ts
    >>> def there_and_back(robot):
    ...     return {0: [1], 1: [0]}, (0, 0)
    >>> report = ts.check(there_and_back, edges=[1, 2], cls="simple")
    >>> report.verdict, report.mapped, report.starts, report.below_certificate
    ('violated', 1, 3, 1)
    >>> print(report.failures[0])
    start simple-2-0 v0:v1, after 0 moves: the map is not the world: 1 edges against 2
    """
    question = _question(explorer, edges, cls, marker, max_moves, seconds, max_failures)
    if isinstance(processes, bool) or not isinstance(processes, int) or processes < 1:
        raise SizeError(f"processes is a number from 1, not {processes!r}")
    with bar("checking", "starts", progress, question.total) as advance:
        if processes == 1:
            report = _checked(question, 0, 1, advance)
        else:
            report = _in_processes(question, processes, advance)
    return report


def _in_processes(question: _Question, processes: int, advance: Advance | None) -> CheckReport:
    try:
        pickle.dumps(question.explorer)
    except Exception as cause:
        text = f"{question.name} cannot be sent to another process; define it at the top of a module"
        raise NotPicklableError(f"{text} ({cause})") from cause
    # A forked process has the functions of a notebook. Others import them.
    fork = sys.platform == "linux"
    context = multiprocessing.get_context("fork") if fork else multiprocessing.get_context()
    of = 8 * processes
    with ProcessPoolExecutor(processes, mp_context=context) as pool:
        shards = [pool.submit(_checked, question, index, of, None) for index in range(of)]
        try:
            reports = []
            for done in as_completed(shards):
                reports.append(done.result())
                if advance is not None:
                    advance(reports[-1].starts)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
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
    seconds: float | None = SECONDS,
    max_failures: int = 100,
) -> CheckReport:
    """Checks one of the disjoint shards of a check, for a cluster. `CheckReport.merge` adds the reports up.

    >>> import toposlam as ts
    >>> def there_and_back(robot):
    ...     return {0: [1], 1: [0]}, (0, 0)
    >>> reports = [ts.check_shard(s, there_and_back, edges=1, cls="simple") for s in ts.shards(2)]
    >>> ts.merge(reports).verdict
    'holds'
    """
    parts = re.fullmatch(r"(\d+)/(\d+)", shard) if isinstance(shard, str) else None
    if parts is None or not 1 <= int(parts[1]) <= int(parts[2]):
        raise ShardError(f"{shard!r} is not a shard; write i/n with i from 1 to n, for example '2/4'")
    question = _question(explorer, edges, cls, marker, max_moves, seconds, max_failures)
    return _checked(question, int(parts[1]) - 1, int(parts[2]), None)


def merge(reports: Sequence[CheckReport]) -> CheckReport:
    """The report of several shards together. The order does not matter."""
    listed = list(reports)
    if not listed or not all(isinstance(report, CheckReport) for report in listed):
        raise ShardError("merge needs reports of shards")
    return listed[0].merge(*listed[1:])
