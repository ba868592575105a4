"""Explorers, checked on every start."""

import contextlib
import dataclasses
import math
import multiprocessing
import os
import pickle
import random
import re
import signal
import threading
import time

import pytest
from depth_first import depth_first

import toposlam as ts
from toposlam import errors


def test_a_depth_first_explorer_maps_every_start():
    """The numbers of starts are those of `toposlam check`."""
    report = ts.check(depth_first, edges=range(1, 6))
    assert [size.starts for size in report.sizes] == [2, 10, 74, 706, 8162]
    assert (report.verdict, report.failed, report.failures) == ("holds", 0, ())
    # Certificate totals of all starts.
    assert [size.certificate for size in report.sizes] == [2, 22, 266, 3625, 55411]
    assert report.vs_certificate > 1


@pytest.mark.parametrize("cls, starts", [("simple", [1, 3, 9, 32]), ("corridor", [1, 3, 8])])
def test_the_classes(cls, starts):
    report = ts.check(depth_first, edges=range(1, len(starts) + 1), cls=cls)
    assert report.verdict == "holds"
    assert report.starts == report.mapped


def test_a_generator_is_an_explorer():
    def path(robot):
        """Right on paths that begin at their end."""
        degrees = [robot.percept.degree]
        percept = yield 0
        degrees.append(percept.degree)
        while percept.degree == 2:
            percept = yield 1
            degrees.append(percept.degree)
        last = len(degrees) - 1
        lists = {0: [1], last: [last - 1]}
        lists.update({v: [v - 1, v + 1] for v in range(1, last)})
        return {v: lists[v] for v in sorted(lists)}, (last, 0)

    chain = ts.World.load("worlds/chain-5.toml")
    run = ts.explore(chain, algorithm=path)
    assert run.moves == run.certificate == 5
    report = ts.check(path, edges=[1, 2], cls="simple")
    assert (report.starts, report.mapped) == (3, 2)


@pytest.mark.parametrize("processes", [2, 3])
def test_the_report_does_not_depend_on_the_number_of_processes(processes):
    alone = ts.check(wrong_sometimes, edges=[3, 4])
    together = ts.check(wrong_sometimes, edges=[3, 4], processes=processes)
    assert repr(alone) == repr(together)
    assert [str(failure) for failure in alone.failures] == [str(f) for f in together.failures]
    assert [f.world for f in alone.failures] == [f.world for f in together.failures]
    assert alone.sizes == together.sizes


def wrong_sometimes(robot):
    """Wrong where the start has degree 2."""
    map_, pose = depth_first(robot)
    if len(map_[0]) == 2:
        return {0: [1], 1: [0]}, (0, 0)
    return map_, pose


def test_shards_together_are_the_whole_check_in_any_order():
    whole = ts.check(wrong_sometimes, edges=[3, 4], keep_going=True)
    shards = [ts.check_shard(s, wrong_sometimes, edges=[3, 4]) for s in ts.shards(5)]
    assert shards[0].verdict in ("not known", "violated")
    random.Random(1).shuffle(shards)
    merged = ts.merge(pickle.loads(pickle.dumps(shards)))
    assert merged.is_complete and merged.sizes == whole.sizes
    assert [str(f) for f in merged.failures] == [str(f) for f in whole.failures]
    assert ts.merge(shards[:4]).verdict == "violated"
    right = [ts.check_shard(s, depth_first, edges=3) for s in ts.shards(3)]
    assert ts.merge(right[:2]).verdict == "not known"
    assert ts.merge(right).verdict == "holds"
    with pytest.raises(errors.ShardError, match="twice"):
        ts.merge([right[0], right[0]])
    with pytest.raises(errors.ShardError, match="one check"):
        ts.merge([right[0], shards[1]])
    other_limit = ts.check_shard("3/3", depth_first, edges=3, max_moves=70)
    with pytest.raises(errors.ShardError, match="one check"):
        ts.merge([*right[:2], other_limit])
    other_time = ts.check_shard("3/3", depth_first, edges=3, seconds=3)
    with pytest.raises(errors.ShardError, match="one check"):
        ts.merge([*right[:2], other_time])
    other_version = dataclasses.replace(right[2], version="0.0.1")
    with pytest.raises(errors.ShardError, match="one check"):
        ts.merge([*right[:2], other_version])
    with pytest.raises(errors.ShardError):
        ts.merge([])


@pytest.mark.parametrize("processes", [1, 2])
def test_larger_worlds_are_not_checked_after_one_that_failed(processes):
    short = ts.check(wrong_sometimes, edges=[1, 2, 3, 4], processes=processes)
    whole = ts.check(wrong_sometimes, edges=[1, 2, 3, 4], processes=processes, keep_going=True)
    assert [size.edges for size in whole.sizes] == [1, 2, 3, 4]
    failing = [size.starts - size.mapped > 0 for size in whole.sizes]
    assert short.sizes == whole.sizes[: failing.index(True) + 1]
    assert len(short.sizes) < 4 and short.verdict == whole.verdict == "violated"
    numbers = [(failure.world.edge_count, failure.number) for failure in whole.failures]
    assert [(failure.world.edge_count, failure.number) for failure in short.failures] == [
        (edges, number) for edges, number in numbers if edges <= len(short.sizes)
    ]


def test_a_check_ends_after_so_many_failures():
    for wanted in [1, 3, 60]:
        report = ts.check(wrong_sometimes, edges=[3, 4], keep_going=True, stop_after=wanted)
        assert report.failed == len(report.failures) == wanted
        assert report.verdict == "violated"
    with pytest.raises(errors.UnusedOptionError, match="stop_after has no effect with several processes"):
        ts.check(wrong_sometimes, edges=3, stop_after=1, processes=2)
    with pytest.raises(errors.SizeError, match="stop_after is a number from 1"):
        ts.check(wrong_sometimes, edges=3, stop_after=0)


def test_an_explorer_that_takes_too_long_is_shown_where_it_was():
    def spin(robot):
        while True:
            pass

    report = ts.check(spin, edges=[2, 3], seconds=0.2)
    (limit,) = report.limits
    assert (report.starts, report.verdict) == (1, "not known")
    line = spin.__code__.co_firstlineno
    assert re.search(rf"more than 0\.2 s \(in spin, line ({line + 1}|{line + 2})\)", str(limit.error))

    # Most of the time of this one is spent in the package.
    def around(robot):
        while True:
            yield 0

    (limit,) = ts.check(around, edges=1, cls="simple", seconds=0.2, max_moves=10**9).limits
    assert re.search(r"more than 0\.2 s( \(in around, line \d+\))?$", str(limit.error))


def test_a_failure_is_drawn_and_can_be_repeated():
    report = ts.check(wrong_sometimes, edges=[2, 3])
    failure = report.failures[0]
    assert failure.world.edge_count == 2
    # The world and the map that was returned, side by side.
    assert failure.draw().svg.count("<svg") == 3 and str(failure).startswith(
        "start multigraph-2-6 v0:e0, after"
    )
    with pytest.raises(type(failure.error)) as raised:
        ts.explore(failure.world, algorithm=wrong_sometimes)
    assert raised.value.message == failure.error.message
    again = pickle.loads(pickle.dumps(failure))
    assert str(again) == str(failure) and again.world == failure.world


def test_the_number_of_failures_that_are_kept():
    report = ts.check(wrong_sometimes, edges=[3, 4], max_failures=3)
    together = ts.check(wrong_sometimes, edges=[3, 4], max_failures=3, processes=2)
    assert len(report.failures) == len(together.failures) == 3
    assert [str(f) for f in report.failures] == [str(f) for f in together.failures]
    assert report.failed == together.failed > 3


def test_a_guess_fails():
    def guess(robot):
        return {0: [(1, 0)], 1: [(0, 0)]}, (0, 0)

    report = ts.check(guess, edges=[1])
    assert (report.verdict, report.mapped, report.failed) == ("violated", 0, 2)
    kinds = {type(failure.error) for failure in report.failures}
    assert kinds == {errors.GuessedError, errors.WrongMapError}
    with pytest.raises(errors.GuessedError, match="another world in which it makes the same walk"):
        ts.explore(ts.World({0: [1], 1: [0]}), algorithm=guess)
    # Without a marker it is one, too; with an undirected marker that is not known.
    edge = {"edges": 1, "cls": "simple"}
    assert type(ts.check(guess, marker="none", **edge).failures[0].error) is errors.GuessedError
    assert ts.check(guess, marker="undirected", **edge).verdict == "holds"


def test_a_guess_may_be_longer_than_the_certificate():
    """From an end of a chain to its middle and back, three times: the other end is never seen."""

    def back_and_forth(robot):
        for _ in range(6):
            robot.go(0)
        return {0: [1], 1: [0, 2], 2: [1]}, (0, 0)

    chain = ts.World({0: [1], 1: [0, 2], 2: [1]})
    assert len(chain.certificate()) == 2
    with pytest.raises(errors.GuessedError):
        ts.explore(chain, algorithm=back_and_forth)


def catches_a_limit(robot):
    try:
        while True:
            robot.go(0)
    except Exception:
        return {0: [1], 1: [0]}, (0, 0)


def raises_after_a_limit(robot):
    try:
        while True:
            robot.go(0)
    except errors.OutOfMovesError:
        raise KeyError("gave up") from None


def yields_after_a_limit(robot):
    while True:
        with contextlib.suppress(BaseException):
            yield 0


@pytest.mark.parametrize("explorer", [catches_a_limit, raises_after_a_limit, yields_after_a_limit])
def test_a_limit_is_one_even_if_the_explorer_catches_it(explorer):
    report = ts.check(explorer, edges=1, cls="simple", max_moves=20)
    assert (report.verdict, report.failed, report.unknown) == ("not known", 0, 1)
    error = report.limits[0].error
    assert (type(error), error.moves) == (errors.OutOfMovesError, 20)
    assert "not known on" in report.limits[0].draw().svg


def test_a_door_that_does_not_exist_ends_the_run():
    def careful(robot):
        with contextlib.suppress(Exception):
            robot.go(7)
        with contextlib.suppress(Exception):
            robot.go(0)
        return {0: [1], 1: [0]}, (1, 0)

    error = ts.check(careful, edges=1, cls="simple").failures[0].error
    assert (type(error), error.moves) == (errors.NoSuchDoorError, 0)
    # By hand, a robot goes on.
    robot = ts.World({0: [1], 1: [0]}).robot()
    with pytest.raises(errors.NoSuchDoorError):
        robot.go(7)
    assert robot.go(0).degree == 1


def test_pick_ups_and_drops_are_limited_as_moves_are():
    def plays(robot):
        while True:
            robot.pick_up()
            robot.drop()

    report = ts.check(plays, edges=1, cls="simple", marker="movable", max_moves=9)
    assert (report.verdict, len(report.limits[0].actions)) == ("not known", 9)


def test_an_explorer_cannot_raise_a_limit_of_its_own():
    def claims(robot):
        raise errors.OutOfTimeError("I say so")

    assert type(ts.check(claims, edges=1).failures[0].error) is errors.RaisedError


@pytest.mark.parametrize("exception", [SystemExit, GeneratorExit])
def test_an_explorer_that_ends_the_program_fails(exception):
    def quits(robot):
        raise exception("done")

    error = ts.check(quits, edges=1).failures[0].error
    assert type(error) is errors.RaisedError and exception.__name__ in error.message


def quits_python(robot):
    import os

    os._exit(3)


def test_a_worker_that_ends_has_an_error_of_its_own():
    with pytest.raises(errors.WorkerLostError, match="a worker process"):
        ts.check(quits_python, edges=1, processes=2)


def rests(robot):
    time.sleep(60)


@pytest.mark.skipif(os.name != "posix", reason="Ctrl-C is a signal on POSIX")
def test_ctrl_c_does_not_wait_for_running_shards():
    threading.Timer(1, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        ts.check(rests, edges=1, processes=2, seconds=math.inf)
    for worker in multiprocessing.active_children():
        worker.join(10)
    assert time.monotonic() - begun < 20


def test_the_marker_of_a_failure_is_kept():
    def counts(robot):
        return {0: [1], 1: [0]}, (0, robot.percept.marker)

    failure = ts.check(counts, edges=1, cls="simple", marker="undirected").failures[0]
    assert failure.marker == "undirected"
    again = {"algorithm": counts, "marker": failure.marker}
    with pytest.raises(type(failure.error), match="no door 1"):
        ts.explore(failure.world, **again)
    assert failure.draw().svg != failure.world.draw(marker="directional").svg
    directional = dataclasses.replace(failure, marker="directional")
    assert failure.draw().svg != directional.draw().svg


EXPLORERS = [
    (lambda robot: None, errors.NoAnswerError, "returned None", 0),
    (lambda robot: 7, errors.AnswerError, "returned 7", 0),
    (lambda robot: {0: [1], 1: [0]}, errors.AnswerError, "pair of a map and a pose", 0),
    (lambda robot: ({0: [1]}, (0, 0)), errors.AnswerError, "neither a vertex", 0),
    (lambda robot: ({0: [1], 1: []}, (0, 0)), errors.AnswerError, "does not list 0 back", 0),
    (lambda robot: ({0: [1], 1: [0]}, (2, 0)), errors.AnswerError, "no vertex 2", 0),
    (lambda robot: ({0: [1], 1: [0]}, (0, 1)), errors.AnswerError, "no door 1", 0),
    (lambda robot: ({0: [1], 1: [0]}, None), errors.AnswerError, "pair", 0),
    (lambda robot: ({0: [1], 1: [0]}, (1, 0)), errors.WrongPoseError, r"by \(0, 0\) of the map", 0),
    (lambda robot: (ts.World({0: [1], 1: [0]}), "v:w"), errors.AnswerError, "pose 'v:w'", 0),
    (lambda robot: ({0: [1, 2], 1: [0], 2: [0]}, (0, 0)), errors.WrongMapError, "not the world", 0),
    (
        lambda robot: robot.go(7),
        errors.NoSuchDoorError,
        "door 7 was taken at a vertex with 1 door",
        0,
    ),
    (lambda robot: robot.go(-1), errors.NoSuchDoorError, "door -1", 0),
    (lambda robot: robot.go(10**30), errors.NoSuchDoorError, "door 1000", 0),
    (lambda robot: robot.go("1"), errors.DoorTypeError, "not '1'", 0),
    (lambda robot: robot.go(None), errors.DoorTypeError, "not None", 0),
    (lambda robot: robot.go(0.5), errors.DoorTypeError, "not 0.5", 0),
    (lambda robot: robot.go(0).nothing, errors.RaisedError, "AttributeError", 1),
    (lambda robot: 1 / 0, errors.RaisedError, "ZeroDivisionError", 0),
    (lambda robot: robot.drop(), errors.NoMarkerError, "no marker that it could drop", 0),
    (lambda robot: setattr(robot, "moves", 3), errors.RaisedError, "AttributeError", 0),
    (lambda robot: setattr(robot, "speed", 3), errors.RaisedError, "AttributeError", 0),
    (lambda: None, errors.RaisedError, "TypeError", 0),
]


@pytest.mark.parametrize("explorer, kind, text, moves", EXPLORERS)
def test_every_mistake_has_an_error_of_its_own_with_start_and_step(explorer, kind, text, moves):
    report = ts.check(explorer, edges=1, cls="simple")
    assert (report.verdict, report.starts) == ("violated", 1)
    error = report.failures[0].error
    assert type(error) is kind
    assert error.start == "simple-1-0 v0:v1" and error.moves == moves
    assert re.search(text, error.message), error.message
    assert str(error).startswith(f"start simple-1-0 v0:v1, after {moves} move")
    with pytest.raises(kind, match="after"):
        ts.explore(ts.World({0: [1], 1: [0]}), algorithm=explorer)


def test_a_robot_of_an_earlier_run_does_nothing():
    kept = []

    def explorer(robot):
        kept.append(robot)
        kept[0].go(0)
        return {0: [1], 1: [0]}, (1, 0)

    report = ts.check(explorer, edges=[1, 2], cls="simple")
    (first, *_) = report.failures
    assert report.mapped == 1 and type(first.error) is errors.EndedRunError
    assert "robot of an earlier run was kept" in str(first.error)


def test_an_explorer_is_not_async():
    async def explorer(robot):
        return {0: [1], 1: [0]}, (1, 0)

    class Explorer:
        async def __call__(self, robot):
            return {0: [1], 1: [0]}, (1, 0)

    for wrong in [explorer, Explorer()]:
        with pytest.raises(errors.NotAnExplorerError, match="not `async`"):
            ts.check(wrong, edges=1)


def test_generators_fail_like_functions():
    def seven(robot):
        yield 7

    def nothing(robot):
        yield 0

    def stubborn(robot):
        while True:
            with contextlib.suppress(Exception):
                yield 7

    kinds = [errors.NoSuchDoorError, errors.NoAnswerError, errors.NoSuchDoorError]
    for explorer, kind in zip([seven, nothing, stubborn], kinds):
        assert type(ts.check(explorer, edges=1).failures[0].error) is kind


def test_an_explorer_that_never_ends():
    def walks(robot):
        while True:
            robot.go(0)

    def swallows(robot):
        while True:
            with contextlib.suppress(Exception):
                robot.go(0)

    def thinks(robot):
        while True:
            pass

    def recurses(robot):
        return recurses(robot)

    report = ts.check(walks, edges=1, max_moves=50)
    # With more moves it might have ended well.
    assert (report.verdict, report.failed, report.unknown) == ("not known", 0, report.starts)
    error = report.limits[0].error
    assert type(error) is errors.OutOfMovesError and error.moves == 50
    for explorer, kind in [(swallows, errors.OutOfMovesError), (thinks, errors.OutOfTimeError)]:
        begun = time.monotonic()
        report = ts.check(explorer, edges=1, cls="simple", max_moves=50, seconds=0.3)
        assert report.verdict == "not known" and not report.failures
        assert type(report.limits[0].error) is kind
        assert time.monotonic() - begun < 5
    error = ts.check(recurses, edges=1).failures[0].error
    assert type(error) is errors.RaisedError and "RecursionError" in error.message
    # What comes after is not disturbed.
    assert ts.check(depth_first, edges=[1, 2, 3]).verdict == "holds"


def test_the_cause_of_an_exception_is_kept():
    def raises(robot):
        raise KeyError("lost")

    error = ts.check(raises, edges=1).failures[0].error
    assert isinstance(error.__cause__, KeyError)
    assert "KeyError: 'lost' (in raises, line " in error.message


def test_ctrl_c_in_an_explorer_ends_the_check():
    def impatient(robot):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ts.check(impatient, edges=3)


@pytest.mark.parametrize(
    "arguments, kind",
    [
        ({"explorer": 7}, errors.NotAnExplorerError),
        ({"explorer": None}, errors.NotAnExplorerError),
        ({"edges": 0}, errors.SizeError),
        ({"edges": 33}, errors.SizeError),
        ({"edges": "5"}, errors.SizeError),
        ({"edges": 2.0}, errors.SizeError),
        ({"edges": []}, errors.SizeError),
        ({"edges": True}, errors.SizeError),
        ({"cls": "tree"}, errors.UnknownClassError),
        ({"marker": "chalk"}, errors.UnknownMarkerError),
        ({"max_moves": 0}, errors.SizeError),
        ({"max_failures": -1}, errors.SizeError),
        ({"seconds": 0}, errors.SizeError),
        ({"seconds": "10"}, errors.SizeError),
        ({"seconds": math.nan}, errors.SizeError),
        ({"max_moves": 10**30}, errors.SizeError),
        ({"processes": 0}, errors.SizeError),
        ({"processes": 2, "explorer": lambda robot: None}, errors.NotPicklableError),
    ],
)
def test_wrong_arguments(arguments, kind):
    with pytest.raises(kind):
        ts.check(**{"explorer": depth_first, "edges": 1, **arguments})


@pytest.mark.parametrize("shard", ["0/3", "4/3", "1", "a/b", None, 3, "1/0", "1/2/3", "-1/3"])
def test_what_is_not_a_shard(shard):
    with pytest.raises(errors.ShardError):
        ts.check_shard(shard, depth_first, edges=1)


def test_the_algorithms_of_the_package():
    world = ts.World.load("worlds/shape-8.toml")
    moving = ["movable", "movable-2-distinct", "movable-directional", "string", "string-1", "team-3"]
    for algorithm in ["algorithm1", "folding", *moving]:
        run = ts.explore(world, algorithm=algorithm)
        assert run.map.is_isomorphic(world)
        is_move = [isinstance(action, int) or action.startswith("send") for action in run.actions]
        assert run.moves == sum(is_move)
        assert algorithm in moving or run.moves >= run.certificate
        assert run.story.startswith("World shape-8.")
        assert "<svg" in run._repr_svg_()
    with pytest.raises(errors.UnknownAlgorithmError, match="`magic` is not an algorithm"):
        ts.explore(world, algorithm="magic")
    with pytest.raises(errors.NotSimpleError):
        ts.explore(ts.World.load("worlds/theta-plane.toml"), algorithm="movable")
    with pytest.raises(errors.MapTooLargeError, match="more than 3 darts"):
        ts.explore(world, max_darts=3)
    with pytest.raises(errors.NotAnExplorerError):
        ts.explore(world, algorithm=3)
    with pytest.raises(errors.SizeError):
        ts.explore(world, max_darts="many")
    assert ts.explore(world, algorithm="movable").certificate is None
    torus = ts.World.load("worlds/theta-torus.toml")
    assert ts.explore(torus, algorithm="string").map.is_isomorphic(torus)


@pytest.mark.parametrize(
    "algorithm, options, kind",
    [
        ("folding", {"max_moves": 5}, errors.UnusedOptionError),
        ("folding", {"seconds": 1}, errors.UnusedOptionError),
        ("folding", {"marker": "none"}, errors.UnusedOptionError),
        (depth_first, {"max_darts": 3}, errors.UnusedOptionError),
        (depth_first, {"max_moves": -1}, errors.SizeError),
        (depth_first, {"seconds": 0}, errors.SizeError),
        (depth_first, {"seconds": "10"}, errors.SizeError),
        (depth_first, {"marker": "chalk"}, errors.UnknownMarkerError),
    ],
)
def test_wrong_options_of_a_run(algorithm, options, kind):
    with pytest.raises(kind):
        ts.explore(ts.World.load("worlds/shape-6.toml"), algorithm, **options)


def test_what_is_not_a_world():
    world = ts.World.load("worlds/shape-6.toml")
    for wrong in [
        lambda: ts.explore("worlds/figure-1a.toml"),
        lambda: ts.compare("a", "b"),
        lambda: ts.compare(world, None),
        lambda: ts.conform("log", {0: [1], 1: [0]}),
        lambda: world.is_isomorphic(7),
    ]:
        with pytest.raises(errors.WorldTypeError, match=r"World\.load"):
            wrong()
    for max_moves in [-1, "3", 2**64]:
        with pytest.raises(errors.SizeError):
            world.robot(max_moves=max_moves)


def test_the_moves_of_algorithm_1_are_those_of_the_robot():
    """An explorer that replays the doors of Algorithm 1 and returns its map is right."""
    world = ts.World.load("worlds/figure-1b.toml")
    run = ts.explore(world)

    def replay(robot):
        for door in run.actions:
            robot.go(door)
        return run.map, run.pose

    mine = ts.explore(world, algorithm=replay)
    assert mine.moves == run.moves
    # The map and the pose are those that were returned.
    assert (mine.map, mine.pose) == (run.map, run.pose)


def test_the_run_of_an_explorer_has_its_map_pose_and_story():
    world = ts.World.load("worlds/shape-6.toml")
    run = ts.explore(world, algorithm=depth_first)
    assert run.map.is_isomorphic(world)
    # The robot is where its actions lead.
    end = world.walk(world.start, run.actions)
    assert run.map.with_start(run.pose).is_isomorphic(world.with_start(end))
    rows = [line.split(maxsplit=3) for line in run.story.splitlines()[1:]]
    assert rows[0] == ["0", "corner:1", "2", "doors, marker along door 0"]
    pose = world.start
    for number, (door, row) in enumerate(zip(run.actions, rows[1:]), start=1):
        pose = world.after(pose, door)
        assert row[:3] == [str(number), str(door), f"{pose.vertex}:{pose.index}"]
        assert row[3].startswith(f"{world.degree(pose.vertex)} door")
    assert rows[run.moves + 1] == []
    assert "<svg" in run._repr_svg_()

    # Vertices whose texts are no names, or are the same, get numbers.
    def odd(robot):
        robot.go(0)
        return {"1": [1], 1: ["1"]}, (1, 0)

    assert ts.explore(ts.World({0: [1], 1: [0]}), algorithm=odd).pose == ("v1", 0)

    def carries(robot):
        robot.pick_up()
        robot.drop()
        robot.go(0)
        return {0: [1], 1: [0]}, (1, 0)

    carried = ts.explore(ts.World({"a": ["b"], "b": ["a"]}), algorithm=carries, marker="movable")
    actions = [line.split()[1] for line in carried.story.splitlines()[2:5]]
    assert actions == ["pick-up", "drop", "0"]


def compass(pose, world):
    """A directional marker as a function."""
    if pose.vertex != world.start.vertex:
        return None
    return (world.start.index - pose.index) % world.degree(pose.vertex)


def test_a_marker_of_your_own_that_is_the_directional_one():
    """The explorer makes the same moves; guesses are not detected, and there are no certificates."""
    whole = ts.check(depth_first, edges=[3, 4])
    mine = ts.check(depth_first, edges=[3, 4], marker=compass)
    assert mine.verdict == "holds" and mine.marker is compass
    counts = [dataclasses.replace(size, certificate=0) for size in whole.sizes]
    assert list(mine.sizes) == counts and mine.vs_certificate is None
    together = ts.check(depth_first, edges=[3, 4], marker=compass, processes=2)
    assert repr(together) == repr(mine)
    world = ts.World.load("worlds/figure-1b.toml")
    for start in map(world.with_start, world.darts()):
        run, known = (ts.explore(start, depth_first, marker=m) for m in (compass, "directional"))
        assert (run.actions, run.map, run.pose) == (known.actions, known.map, known.pose)
        assert run.certificate is None and "doors, marker 0\n" in run.story
        assert ts.check(depth_first, worlds=[start], marker=compass).moves == run.moves


def test_a_robot_senses_the_values_of_a_marker_function():
    world = ts.World.load("worlds/figure-1a.toml")

    def names(pose, at):
        return ("loud", pose.index == at.start.index) if pose.vertex == at.start.vertex else None

    robot = world.robot(names)
    assert robot.percept == ts.OwnPercept(4, ("loud", True))
    assert robot.go(1) == ts.OwnPercept(3, None)
    assert robot.go(0) == ts.OwnPercept(4, ("loud", False))
    assert "marker ('loud', False)" in repr(robot)
    with pytest.raises(errors.NoMarkerError):
        robot.pick_up()
    for wrong, text in [
        (lambda pose, at: pose.vertex, "in a copy"),
        (lambda pose, at: 1 / 0, "ZeroDivisionError"),
        (lambda pose, at: [], "unhashable"),
    ]:
        for call in [
            lambda marker=wrong: world.robot(marker),
            lambda marker=wrong: ts.explore(world, depth_first, marker=marker),
            lambda marker=wrong: ts.check(depth_first, edges=2, marker=marker),
            lambda marker=wrong: ts.check(depth_first, worlds=[world], marker=marker),
        ]:
            with pytest.raises(errors.MarkerFunctionError, match=text):
                call()
    with pytest.raises(errors.UnusedOptionError, match="marker has no effect with an algorithm"):
        ts.explore(world, "folding", marker=names)
    with pytest.raises(errors.NotPicklableError, match="names cannot be sent"):
        ts.check(depth_first, edges=1, marker=names, processes=2)
    failure = ts.check(lambda robot: None, edges=1, marker=names).failures[0]
    assert failure.draw().svg == dataclasses.replace(failure, marker="none").draw().svg


def test_reports_are_frames():
    pytest.importorskip("pandas")
    report = ts.check(wrong_sometimes, edges=[3, 4], keep_going=True)
    frame = report.pandas()
    assert frame["starts"].tolist() == [74, 706]
    assert frame["failed"].sum() == report.failed and frame["mapped"].sum() == report.mapped
    assert (frame["mean_moves"] * frame["mapped"]).sum() == pytest.approx(report.moves)
    found = ts.counterexample("undirected", "simple", 6)
    assert found.pandas().iloc[-1].tolist() == [6, 306, 6]


def test_a_map_that_is_a_world_has_its_own_start():
    world = ts.World.load("worlds/figure-1a.toml").with_start(("a", 1))
    walk = world.certificate()

    def knows(robot):
        for door in walk:
            robot.go(door)
        return world, world.walk(world.start, walk)

    assert ts.explore(world, algorithm=knows).moves == len(walk)
    elsewhere = world.with_start(("x", 0))
    with pytest.raises(errors.WrongMapError, match="its start is at another place"):
        ts.explore(world, algorithm=lambda robot: (elsewhere, elsewhere.start))


def test_a_map_may_be_that_of_the_protocol():
    """Lists of lists, as in docs/protocol.md."""

    def there(robot):
        robot.go(0)
        return [[[1, 0]], [[0, 0]]], [1, 0]

    assert ts.check(there, edges=1, cls="simple").verdict == "holds"


def test_a_map_may_have_vertices_of_any_kind():
    networkx = pytest.importorskip("networkx")
    _, grid = networkx.check_planarity(networkx.grid_2d_graph(2, 3))
    world = ts.World(grid, start=((0, 1), 0))
    walk = world.certificate()

    def knows(robot):
        for door in walk:
            robot.go(door)
        vertex, index = world.walk(world.start, walk)
        return world, (next(v for v in grid if str(v) == vertex), index)

    assert ts.explore(world, algorithm=knows).moves == len(walk)


@pytest.mark.parametrize("algorithm, mean", [("algorithm1", 7.296), ("folding", 7.093)])
def test_the_mean_moves_of_the_algorithms_on_all_starts(algorithm, mean):
    """Simple worlds with 5 edges; the means are those that a prototype of both had."""
    moves = [ts.explore(world, algorithm=algorithm).moves for world in ts.starts(5, "simple")]
    assert len(moves) == 108
    assert round(sum(moves) / len(moves), 3) == mean


def test_a_map_that_is_a_planar_embedding():
    pytest.importorskip("networkx")
    world = ts.World.load("worlds/shape-6.toml")
    first = world.start.vertex
    order = [first, *(vertex for vertex in world.vertices if vertex != first)]
    lists = {vertex: world.neighbours[vertex] for vertex in order}
    turned = lists[first][world.start.index :] + lists[first][: world.start.index]
    embedding = ts.World({**lists, first: turned}).to_networkx()
    walk = world.certificate()

    def knows(robot):
        for door in walk:
            robot.go(door)
        vertex, index = ts.World(embedding).walk((first, 0), walk)
        return embedding, (vertex, index)

    assert ts.explore(world, algorithm=knows).moves == len(walk)
