"""Checks an explorer on every start of every small world."""

from __future__ import annotations

import multiprocessing
import pickle
import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field, replace
from importlib.metadata import version
from typing import Any

from . import _core
from .enumeration import Edges, check_class, count_starts, sizes_of, start_name
from .errors import (
    ExplorerError,
    LimitError,
    NotPicklableError,
    OtherCheckError,
    OutOfTimeError,
    ShardError,
    WorkerLostError,
    WorldTypeError,
)
from .explorers import Answer, Clock, Explorer, check_explorer, judged
from .failures import Failure, failure_of, place
from .limits import MAX_MOVES, SECONDS, check_limit, check_run_limits, check_unused
from .logs import Table
from .markers import Marker, check_marker, marker_name, sensed
from .progress import Advance, bar
from .worlds import World, world_of


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

    @property
    def failed(self) -> int:
        """The starts on which the explorer failed."""
        return self.starts - self.mapped - self.unknown

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
    cls: str | None
    """The class of the worlds; None if the worlds are given."""
    marker: Marker
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
    worlds: tuple[str, ...] | None = field(default=None, repr=False)
    """The names and the starts that were checked, if the worlds are given."""

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
        return sum(size.failed for size in self.sizes)

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

    def pandas(self) -> Any:
        """The counts as a `pandas.DataFrame`, a row for each number of edges.

        >>> import toposlam as ts
        >>> frame = ts.check(lambda robot: ({0: [1], 1: [0]}, (robot.go(0) and 1, 0)), 1, "simple").pandas()
        >>> frame.to_dict("records")[0]["mean_moves"]
        1.0
        """
        sizes, columns = self.sizes, ("edges", "starts", "mapped", "failed", "unknown", "most_moves")
        table = {name: [getattr(size, name) for size in sizes] for name in columns}
        table["mean_moves"] = [size.moves / size.mapped if size.mapped else None for size in sizes]
        table["vs_certificate"] = [
            size.moves / size.certificate if size.certificate else None for size in sizes
        ]
        return Table(table).pandas()

    def merge(self, *others: CheckReport) -> CheckReport:
        """The report of several shards together. The order does not matter. Raises `ShardError` if a shard
        occurs twice, or the reports are not of one check: of one explorer's name, class, marker, limits and
        version."""
        reports = sorted((self, *others), key=lambda report: report.shards)
        shards = tuple(sorted(shard for report in reports for shard in report.shards))
        if len(set(shards)) < len(shards):
            raise ShardError(f"a shard occurs twice: {shards}")
        sizes: dict[int, SizeReport] = {}
        edges = [size.edges for size in self.sizes]
        for report in reports:
            is_same = self.cls is None or [size.edges for size in report.sizes] == edges
            if report._head() != self._head() or not is_same:
                raise ShardError("the reports are not of one check")
            for size in report.sizes:
                sizes[size.edges] = sizes.get(size.edges, SizeReport(size.edges)) + size

        def first(failures: Iterable[Failure]) -> tuple[Failure, ...]:
            # Worlds that are given are checked in their own order.
            def place(failure: Failure) -> tuple[int, int]:
                return (0 if self.cls is None else failure.world.edge_count, failure.number)

            return tuple(sorted(failures, key=place)[: self.max_failures])

        failures = first(failure for report in reports for failure in report.failures)
        limits = first(limit for report in reports for limit in report.limits)
        listed = None if self.worlds is None else _dealt([report.worlds or () for report in reports])
        return replace(
            self,
            sizes=tuple(sizes[size] for size in sorted(sizes)),
            failures=failures,
            limits=limits,
            shards=shards,
            worlds=listed,
        )

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
        cls = self.cls or "given worlds"
        return f"<CheckReport {self.verdict}: {self.explorer}, {cls}, edges {edges}: {text}>"


@dataclass(frozen=True)
class _Question:
    """A check of an explorer."""

    explorer: Explorer
    edges: tuple[int, ...]
    cls: str | None
    marker: Marker
    max_moves: int
    seconds: float
    max_failures: int
    stop_after: int | None = None
    keep_going: bool = True
    given: Iterable[tuple[int, World]] | None = None
    """Starts with their numbers, in place of all starts of the class."""

    @property
    def name(self) -> str:
        return getattr(self.explorer, "__name__", type(self.explorer).__name__)

    def total(self) -> int | None:
        if self.cls is None or self.given is not None:
            return len(self.given) if isinstance(self.given, tuple) else None
        return count_starts(self.edges, self.cls)

    def cases(self, index: int, of: int) -> Iterator[tuple[_core.Start, World | None]]:
        """The starts of a shard, each with its world if that is given."""
        if self.given is not None:
            for place, (number, world) in enumerate(self.given):
                if place % of == index:
                    yield _core.Start.of(world._core, world.facing(), number), world
        elif self.cls is not None:
            for edges in self.edges:
                for start in _core.Starts("start", self.cls, edges, index, of):
                    yield start, None


def _question(
    explorer: Explorer,
    edges: Edges,
    cls: str | None,
    marker: Marker,
    max_moves: int,
    seconds: float,
    max_failures: int,
) -> _Question:
    check_explorer(explorer)
    if cls is not None:
        check_class(cls)
    check_marker(marker)
    check_limit("max_failures", max_failures)
    check_run_limits(max_moves, seconds)
    wanted = () if cls is None else sizes_of(edges)
    return _Question(explorer, wanted, cls, marker, max_moves, seconds, max_failures)


def given_starts(worlds: Iterable[World]) -> Iterator[tuple[int, World]]:
    """Each start of the worlds, with its number; of a world without a start, all of them."""
    try:
        listed = iter(worlds)
    except TypeError:
        raise WorldTypeError(f"worlds are a list or an iterator of worlds, not {worlds!r}") from None
    number = 0
    for world in listed:
        for start in [world] if world_of(world).start is not None else world.starts():
            yield number, start
            number += 1


def _checked(question: _Question, index: int, of: int, advance: Advance | None) -> CheckReport:
    """The report of one shard, counted from 0."""
    # The fields of `SizeReport` in their order.
    counts = {edges: [0] * 6 for edges in question.edges}
    failures: list[Failure] = []
    limits: list[Failure] = []
    names: list[str] = []
    explorer, marker, bound = question.explorer, question.marker, question.max_moves
    with_certificates = marker == "directional"
    checked = shown = wrong = 0
    with Clock(question.seconds) as clock:
        for start, world in question.cases(index, of):
            robot = start.robot(sensed(marker, start, world), bound)
            error, answer = judged(explorer, start, robot, clock)
            checked += 1
            if world is not None:
                names.append(place(world))
            count = counts.setdefault(start.edges, [0] * 6)
            count[0] += 1
            if error is None:
                moves = robot.moves
                count[1] += 1
                count[3] += moves
                count[4] = max(count[4], moves)
                if with_certificates:
                    count[5] += start.certificate
            else:
                is_limit = isinstance(error, LimitError)
                count[2] += is_limit
                wrong += 1
                kept = limits if is_limit else failures
                if len(kept) < question.max_failures:
                    kept.append(_failure(question, (start, world), robot, (error, answer)))
            if advance is not None and checked - shown == 256:
                advance(checked - shown)
                shown = checked
            is_stuck = isinstance(error, OutOfTimeError) and not question.keep_going
            if is_stuck or (question.stop_after is not None and wrong >= question.stop_after):
                break
    if advance is not None:
        advance(checked - shown)
    return CheckReport(
        explorer=question.name,
        cls=question.cls,
        marker=marker,
        sizes=tuple(SizeReport(edges, *counts[edges]) for edges in sorted(counts)),
        failures=tuple(failures),
        limits=tuple(limits),
        max_failures=question.max_failures,
        max_moves=bound,
        seconds=question.seconds,
        version=version("toposlam"),
        shards=(index + 1,),
        of=of,
        worlds=None if question.given is None else tuple(names),
    )


def _failure(
    question: _Question,
    case: tuple[_core.Start, World | None],
    robot: _core.Robot,
    ended: tuple[ExplorerError, Answer],
) -> Failure:
    start, world = case
    if world is None:
        world = World._of(start.world(start_name(question.cls or "", start)))
    return failure_of(world, ended, robot, question.marker, start.number)


def _dealt(hands: Sequence[Sequence[str]]) -> tuple[str, ...]:
    """What was dealt to several hands, in the order of before."""
    most = max(map(len, hands), default=0)
    return tuple(hand[place] for place in range(most) for hand in hands if place < len(hand))


def check(
    explorer: Explorer,
    edges: Edges | None = None,
    cls: str | None = None,
    *,
    worlds: Iterable[World] | None = None,
    marker: Marker = "directional",
    max_moves: int = MAX_MOVES,
    seconds: float = SECONDS,
    max_failures: int = 100,
    stop_after: int | None = None,
    keep_going: bool = False,
    failures_first: CheckReport | None = None,
    processes: int = 1,
    progress: bool | None = None,
) -> CheckReport:
    """Checks an explorer on every start of every world with `edges` edges: a number, or several; 1 to 5
    unless they are given. Or, with `worlds`, on these: on the start of each, or on all starts of a world
    without one.

    After a number of edges with a start that failed or reached a limit, worlds with more edges are not
    checked, and after a start that took too long nothing more, unless `keep_going`. With `stop_after`, the
    check ends after so many starts that failed or reached a limit. All `worlds` that are given are checked,
    whatever their sizes. With `failures_first`, an earlier report, the starts in its `failures` and `limits`
    are checked first. If the explorer still fails there, the result is the report on these starts, which its
    `worlds` name; otherwise all starts are checked.

    `cls` is the class of the worlds, one of `CLASSES`, and `marker` the kind of the robot's marker, one of
    `MARKERS` or a function of your own: see `MarkerFunction`. A map is right if it is isomorphic to the
    world, start to start, and the robot is where the explorer says. A right map after a walk that does not
    determine the world is a guess, which fails: there is another world in which the explorer makes the same
    walk, and returns the same map. With another marker than `"directional"` and `"none"` that is not known,
    and no map is called a guess.

    After `max_moves` moves, pick-ups and drops, or `seconds` seconds for a start (`math.inf` is no limit),
    its result is not known. The report keeps the first `max_failures` failures, and as many starts that
    reached a limit. With several `processes` the report is the same, unless a start takes too long: then each
    process ends by itself. `progress` shows a bar or not; without
    it, on a terminal and in a notebook.

    Raises `NotAnExplorerError`, `SizeError`, `UnknownClassError` or `UnknownMarkerError` for arguments that
    cannot be, `MarkerFunctionError` for a marker's function, `WorldTypeError` for what is not a world,
    `OtherCheckError` if the earlier report is not of such a check, and `UnusedOptionError` for an option
    without effect beside the others; with several processes also `NotPicklableError`, and `WorkerLostError`
    if one of them ends.

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
    if worlds is not None:
        check_unused("with worlds", edges=edges, cls=cls)
    else:
        cls = "multigraph" if cls is None else cls
    edges = range(1, 6) if edges is None else edges
    question = _question(explorer, edges, cls, marker, max_moves, seconds, max_failures)
    if worlds is not None:
        question = replace(question, given=given_starts(worlds))
    check_limit("processes", processes)
    if stop_after is not None:
        check_limit("stop_after", stop_after)
    if processes > 1:
        check_unused("with several processes", stop_after=stop_after)
        _check_picklable(question)
    if failures_first is not None:
        check_unused("with keep_going: all starts are checked", failures_first=keep_going or None)
        again = replace(
            question, given=_failed(failures_first, question), stop_after=stop_after, keep_going=False
        )
        with bar("checking again", "starts", progress, again.total) as advance:
            first = _checked(again, 0, 1, advance)
        if first.mapped < first.starts:
            return first
    if question.given is not None and (processes > 1 or not isinstance(worlds, Iterator)):
        question = replace(question, given=tuple(question.given))
    report, failed = None, 0
    with bar("checking", "starts", progress, question.total) as advance:
        sizes: list[tuple[int, ...]] = [(size,) for size in question.edges]
        for some in sizes or [()]:
            left = None if stop_after is None else stop_after - failed
            one = replace(question, edges=some, stop_after=left, keep_going=keep_going)
            found = _checked(one, 0, 1, advance) if processes == 1 else _in_processes(one, processes, advance)
            report = found if report is None else report._with_larger(found)
            failed = report.starts - report.mapped
            if (failed and not keep_going) or (stop_after is not None and failed >= stop_after):
                break
    assert report is not None  # there is a size
    return report


def _failed(report: CheckReport, question: _Question) -> tuple[tuple[int, World], ...]:
    """The starts of an earlier report that failed or reached a limit, as far as the check has them."""
    if not isinstance(report, CheckReport):
        raise OtherCheckError(f"failures_first is the report of an earlier check, not {report!r}")
    if (report.cls, report.marker) != (question.cls, question.marker):
        of = f"class {report.cls}" if report.cls else "given worlds"
        raise OtherCheckError(
            f"the earlier report is of another check: of {of} with the marker {marker_name(report.marker)}"
        )
    failures = sorted(
        (*report.failures, *report.limits), key=lambda failure: (failure.world.edge_count, failure.number)
    )
    return tuple(
        (failure.number, failure.world)
        for failure in failures
        if question.cls is None or failure.world.edge_count in question.edges
    )


def _check_picklable(question: _Question) -> None:
    for value, name in [(question.explorer, question.name), (question.marker, marker_name(question.marker))]:
        try:
            pickle.dumps(value)
        except Exception as cause:
            text = f"{name} cannot be sent to another process; define it at the top of a module"
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
    marker: Marker = "directional",
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
