"""Runs an explorer on a start, and judges its answer.

An explorer is a function of a robot. It senses with `robot.percept`, moves with `robot.go(door)`, and returns
a map and the robot's pose in it, a dart `(vertex, index)` of the map. It may also be a generator: then
`yield door` moves, and gives the percept behind the door.
"""

from __future__ import annotations

import inspect
import threading
import time
from collections.abc import Generator
from types import GeneratorType
from typing import Any, Callable, Union

from . import _core
from .errors import (
    AnswerError,
    EndedRunError,
    ExplorerError,
    GuessedError,
    InternalError,
    NoAnswerError,
    NotAnExplorerError,
    OutOfTimeError,
    RaisedError,
    ToposlamError,
    UnknownStartError,
    WrongMapError,
    WrongPoseError,
)
from .maps import Doors, doors_of, shown
from .threads import raise_in
from .worlds import Dart, World

Answer = Any
"""A map and the robot's pose in it."""

Explorer = Callable[[_core.Robot], Union[Answer, "Generator[int, Any, Answer]"]]
"""An explorer: a function of a robot, or a generator."""


class _TimeIsUp(BaseException):
    """Raised in the thread of an explorer, which cannot catch it by accident."""


class Clock:
    """Stops an explorer that takes too long: `with Clock(10.0) as clock: clock.run(explorer, robot)`."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self._thread = threading.get_ident()
        self._lock = threading.Lock()
        self._runs = 0
        self._running = False
        self._stopped = threading.Event()
        self._watch = threading.Thread(target=self._look, daemon=True)

    def __enter__(self) -> Clock:
        self._watch.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stopped.set()
        self._watch.join()

    def _look(self) -> None:
        seen, since = -1, time.monotonic()
        while not self._stopped.wait(min(self.seconds / 4, 0.5)):
            with self._lock:
                if not self._running or self._runs != seen:
                    seen, since = self._runs, time.monotonic()
                elif time.monotonic() - since > self.seconds:
                    since = time.monotonic()
                    raise_in(self._thread, _TimeIsUp)

    def run(self, explorer: Explorer, robot: _core.Robot) -> Answer:
        """What the explorer returns. Raises `_TimeIsUp` if it takes too long."""
        with self._lock:
            self._runs += 1
            self._running = True
        try:
            return _called(explorer, robot)
        finally:
            with self._lock:
                self._running = False
            # An exception that the clock has raised by now arrives here, and not later.
            for _ in range(4):
                pass


def _called(explorer: Explorer, robot: _core.Robot) -> Answer:
    answer = explorer(robot)
    if isinstance(answer, GeneratorType):
        try:
            door = next(answer)
            while True:
                try:
                    percept = robot.go(door)
                except ExplorerError:
                    # The generator may only clean up.
                    answer.close()
                    raise
                door = answer.send(percept)
        except StopIteration as end:
            return end.value
    return answer


def check_explorer(explorer: object) -> None:
    """Raises an exception if a value cannot be an explorer."""
    if not callable(explorer):
        kind = type(explorer).__name__
        raise NotAnExplorerError(f"an explorer is a function of a robot, not a value of type {kind}")
    if any(map(inspect.iscoroutinefunction, [explorer, type(explorer).__call__])):
        raise NotAnExplorerError("an explorer is not `async`: nothing awaits it; begin it with `def`")


def judged(
    explorer: Explorer, start: _core.Start, robot: _core.Robot, clock: Clock
) -> tuple[ExplorerError | None, Answer]:
    """Runs an explorer, and returns what is wrong, or None, and its answer.

    The run ends with the first action that is not possible, even if the explorer catches the exception.
    """
    answer: Answer = None
    try:
        answer = clock.run(explorer, robot)
        wrong = None if robot.refusal is not None else judge(answer, start, robot)
    except InternalError:
        raise
    except EndedRunError as cause:
        wrong = cause
    except _TimeIsUp as cause:
        wrong = OutOfTimeError(f"it took more than {clock.seconds:g} s{_line(cause)}")
    except (Exception, SystemExit, GeneratorExit) as cause:
        wrong = _raised(cause)
    finally:
        robot.end_run()
    return (wrong if robot.refusal is None else robot.refusal), answer


def _raised(cause: BaseException) -> RaisedError:
    error = RaisedError(f"it raised {type(cause).__name__}: {cause}{_line(cause)}")
    error.__cause__ = cause
    return error


def _line(cause: BaseException) -> str:
    """The line of the explorer where an exception was raised, in brackets."""
    trace, text = cause.__traceback__, ""
    while trace is not None:
        if trace.tb_frame.f_globals.get("__package__") != __package__:
            text = f" (in {trace.tb_frame.f_code.co_name}, line {trace.tb_lineno})"
        trace = trace.tb_next
    return text


def judge(answer: Answer, start: _core.Start, robot: _core.Robot) -> ExplorerError | None:
    """What is wrong with an answer, or None."""
    if answer is None:
        return NoAnswerError("it returned None, and not a map and a pose; is a return missing?")
    if not (isinstance(answer, (tuple, list)) and len(answer) == 2):
        return AnswerError(
            "it returned " + shown(answer) + ", and not a pair of a map and a pose (vertex, index)"
        )
    map_, pose = answer
    try:
        doors, facing, place = _numbers(map_, pose)
    except ToposlamError as cause:
        error = AnswerError(f"its map: {cause.message}")
        error.__cause__ = cause
        return error
    try:
        wrong = start.judge(robot, (doors.degrees, doors.opposite), facing, place)
    except (ValueError, OverflowError) as cause:
        return AnswerError(f"its map: {cause}")
    if wrong is None:
        return None
    kind, text, right = wrong
    if kind == "guessed":
        return GuessedError(text)
    if right is None:
        return WrongMapError(text)
    believed, truly = doors.place(place), doors.place(right)
    return WrongPoseError(
        f"the map is right, but the robot came in by {truly!r} of the map, and not by {believed!r}"
    )


def mapped(answer: Answer, name: str) -> tuple[World, Dart]:
    """The map of an answer that was judged, as a world, and the robot's pose in it."""
    map_, pose = answer
    doors, facing, place = _numbers(map_, pose)
    if isinstance(map_, World):
        world = map_.with_start(map_.darts()[facing])
    else:
        texts = [str(vertex) for vertex in doors.vertices]
        if len(set(texts)) < len(texts) or not all(map(_core.is_name, texts)):
            texts = [f"v{number}" for number in range(len(texts))]
        world = World._of(_core.World.from_doors(doors.degrees, doors.opposite, texts, name, "", facing))
    return world, world.darts()[place]


def _numbers(map_: object, pose: object) -> tuple[Doors, int, int]:
    """The doors of a map, the number of its start and that of the pose."""
    if isinstance(map_, World):
        degrees, opposite = map_._core.doors
        doors = Doors(list(map_.vertices), degrees, opposite)
        facing = map_._core.start or 0
        try:
            place = map_.number(pose)  # type: ignore[arg-type]
        except UnknownStartError as cause:
            raise UnknownStartError(f"the pose {pose!r} is not in the map") from cause
        return doors, facing, place
    doors = doors_of(map_)
    try:
        return doors, 0, doors.number(pose)
    except UnknownStartError as cause:
        raise UnknownStartError(f"the pose {pose!r} is not in the map: {cause.message}") from None
