"""All starts and all worlds of a class, and starts at random; numbers from the encyclopedia of integer
sequences."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections import Counter

import pytest
from depth_first import depth_first

import toposlam as ts
from toposlam import errors


def test_the_numbers_of_starts_and_worlds_are_published():
    # A000698, rooted maps of any genus; A170946, sensed maps; A006394, simple sensed maps in the plane.
    assert [ts.count_starts(edges) for edges in range(1, 6)] == [2, 10, 74, 706, 8162]
    assert [ts.count_worlds(edges) for edges in range(1, 7)] == [2, 5, 20, 107, 870, 9436]
    assert [ts.count_worlds(edges, "planar") for edges in range(1, 8)] == [1, 1, 3, 5, 15, 52, 213]
    assert ts.count_starts([2, 3]) == 84
    # A000168, rooted maps in the plane.
    assert sum(world.genus == 0 for world in ts.starts(4)) == 378


def test_every_start_is_a_start_of_one_world():
    starts = {start.canonical(): [] for start in ts.worlds(4)}
    for start in ts.starts(4):
        assert start.edge_count == 4 and start.start is not None
        starts[start.canonical()].append(start)
    assert len(starts) == 107
    for world in ts.worlds(4):
        mine = world.starts()
        assert len(mine) == 8 // len(world.automorphisms()) == len(starts[world.canonical()])
        for start in mine:
            assert sum(start.is_isomorphic(other) for other in starts[world.canonical()]) == 1


def test_names_and_sizes_are_those_of_check():
    assert [start.name for start in ts.starts([1, 2], "simple")] == ["simple-1-0", "simple-2-0", "simple-2-1"]
    failure = ts.check(lambda robot: None, edges=2, cls="simple").failures[1]
    assert failure.world == list(ts.starts(2, "simple"))[1]
    assert [world.name for world in ts.worlds(2, "planar")] == ["planar-2-world-0"]


def test_the_first_start_of_many_is_there_at_once():
    begun = time.monotonic()
    for cls in ts.CLASSES:
        assert next(ts.starts(15, cls)).edge_count == 15
        assert next(ts.worlds(15, cls)).edge_count == 15
    assert next(ts.starts(32)).edge_count == 32
    assert time.monotonic() - begun < 5


@pytest.mark.skipif(os.name != "posix", reason="Ctrl-C is a signal on POSIX")
@pytest.mark.parametrize(
    "call",
    [
        lambda: sum(1 for _ in ts.starts(20)),
        lambda: ts.count_starts(20),
        # Not even the first one is found soon.
        lambda: next(ts.starts(32, "simple")),
        lambda: ts.count_worlds(32, "planar"),
    ],
)
def test_ctrl_c_ends_what_would_take_years(call):
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        call()
    assert time.monotonic() - begun < 10


# The worlds on the pages that `toposlam play --edges N --class CLASS --seed N` writes.
PLAYED = [
    (
        5,
        "corridor",
        7,
        [[(1, 0), (2, 0), (3, 0)], [(0, 0), (3, 1), (4, 0)], [(0, 1)], [(0, 2), (1, 1)], [(1, 2)]],
    ),
    (
        5,
        "corridor",
        8,
        [[(1, 0), (2, 0), (3, 0)], [(0, 0)], [(0, 1)], [(0, 2), (4, 0), (5, 0)], [(3, 1)], [(3, 2)]],
    ),
    (4, "multigraph", 3, [[(0, 3), (0, 5), (0, 4), (0, 0), (0, 2), (0, 1), (0, 7), (0, 6)]]),
    (
        6,
        "planar",
        18446744073709551615,
        [
            [(1, 0), (2, 0), (3, 0)],
            [(0, 0), (4, 0)],
            [(0, 1), (4, 1)],
            [(0, 2), (5, 0)],
            [(1, 1), (2, 1)],
            [(3, 1)],
        ],
    ),
]


@pytest.mark.parametrize("edges, cls, seed, played", PLAYED)
def test_a_random_world_is_that_of_play(edges, cls, seed, played):
    world = ts.random_world(edges, cls, seed)
    assert world == ts.World(world, name=world.name) == ts.random_world(edges, cls, seed=seed)
    places = [[(int(vertex[1:]), index) for vertex, index in ends] for ends in world.far_ends.values()]
    assert places == played and world.start == ("v0", 0)


def test_each_start_is_drawn_equally_often():
    """1,000 times one of 74 starts: 13.5 of each on average; the deviation is 3.7."""
    drawn = Counter(ts.random_world(3, seed=seed) for seed in range(1000))
    drawn = Counter(ts.World(world, name="start") for world in drawn.elements())
    assert len(drawn) == 74 and max(drawn.values()) < 13.5 + 4 * 3.7 and min(drawn.values()) >= 1


@pytest.mark.parametrize(
    "arguments, kind, text",
    [
        ((0,), errors.SizeError, "from 1 to 8"),
        ((9,), errors.SizeError, "from 1 to 8 edges, not 9: all starts .* are counted"),
        (([1, 2],), errors.SizeError, "from 1 to 8"),
        ((True,), errors.SizeError, "from 1 to 8"),
        ((3, "tree"), errors.UnknownClassError, "tree"),
        ((3, "simple", -1), errors.SizeError, "seed"),
        ((3, "simple", 2**64), errors.SizeError, "seed"),
        ((3, "simple", 0.5), errors.SizeError, "seed"),
    ],
)
def test_what_cannot_be_drawn(arguments, kind, text):
    with pytest.raises(kind, match=text):
        ts.random_world(*arguments)


@pytest.mark.parametrize("function", [ts.starts, ts.worlds, ts.count_starts, ts.count_worlds])
def test_what_cannot_be_enumerated(function):
    for edges in [0, 33, "3", None, 2.5, [], [3, 0]]:
        with pytest.raises(errors.SizeError):
            function(edges)
    with pytest.raises(errors.UnknownClassError):
        function(3, "tree")


def test_a_check_on_all_worlds_of_a_class_is_the_check_of_the_class():
    whole = ts.check(depth_first, edges=4)
    for worlds in [ts.worlds(4), ts.starts(4), list(ts.worlds(4))]:
        report = ts.check(depth_first, worlds=worlds)
        assert report.sizes == whole.sizes and report.verdict == "holds"
        assert (report.cls, len(report.worlds)) == (None, 706)


def lost_at_a_crossing(robot):
    """Fails where the start has four doors."""
    return depth_first(robot) if robot.percept.degree < 4 else None


def test_a_check_on_given_worlds_names_them():
    figures = [ts.World.load(f"worlds/{name}.toml") for name in ("figure-1a", "shape-6", "figure-1b")]
    report = ts.check(lost_at_a_crossing, worlds=figures)
    assert report.worlds == ("figure-1a x:a", "shape-6 corner:tee", "figure-1b X:A")
    assert [(size.edges, size.starts, size.mapped) for size in report.sizes] == [(6, 1, 1), (8, 2, 0)]
    assert [str(failure) for failure in report.failures] == [
        f"start {start}, after 0 moves: it returned None, and not a map and a pose; is a return missing?"
        for start in ("figure-1a x:a", "figure-1b X:A")
    ]
    assert report.failures[1].world is figures[2]
    together = ts.check(lost_at_a_crossing, worlds=iter(figures), processes=2)
    assert repr(together) == repr(report) and together.worlds == report.worlds
    assert ts.check(lost_at_a_crossing, worlds=figures, stop_after=1).starts == 1
    # A world without a start is checked at all of its starts: those of the wheel are 16 / 4.
    wheel = ts.check(lost_at_a_crossing, worlds=[figures[0].with_start(None)])
    assert (wheel.starts, wheel.failed) == (4, 1)
    assert ts.check(depth_first, worlds=[]).verdict == "not known"


def test_worlds_that_cannot_be_checked():
    for worlds in [7, ts.World.load("worlds/shape-6.toml"), ["worlds/shape-6.toml"]]:
        with pytest.raises(errors.WorldTypeError):
            ts.check(depth_first, worlds=worlds)
    for other in [{"edges": 3}, {"cls": "simple"}]:
        with pytest.raises(errors.UnusedOptionError, match="with worlds"):
            ts.check(depth_first, worlds=[], **other)


def test_the_starts_that_failed_are_checked_first():
    first = ts.check(lost_at_a_crossing, edges=[3, 4], keep_going=True)
    assert first.failed > len([f for f in first.failures if f.world.edge_count == 3]) > 0
    again = ts.check(lost_at_a_crossing, edges=[3, 4], failures_first=first)
    assert again.starts == again.failed == len(first.failures)
    assert [str(f) for f in again.failures] == [str(f) for f in first.failures]
    assert again.worlds[0] == "multigraph-3-0 v0:e0:1"
    assert [f.number for f in again.failures] == [f.number for f in first.failures]
    # Only those with so many edges.
    small = ts.check(lost_at_a_crossing, edges=3, failures_first=first)
    assert 0 < small.starts < again.starts
    # When they are right, all are checked.
    right = ts.check(depth_first, edges=[3, 4], failures_first=again)
    assert (right.verdict, right.starts, right.worlds) == ("holds", 780, None)
    assert repr(right) == repr(ts.check(depth_first, edges=[3, 4]))
    # A start that reached a limit is one of them; and the check may end after the first.
    limited = ts.check(depth_first, edges=3, max_moves=9)
    assert limited.unknown > 1
    still = ts.check(depth_first, edges=3, max_moves=9, failures_first=limited)
    assert (still.verdict, still.starts) == ("not known", limited.unknown)
    assert ts.check(depth_first, edges=3, max_moves=9, failures_first=limited, stop_after=1).starts == 1
    figures = [ts.World.load(f"worlds/{name}.toml") for name in ("figure-1a", "shape-6")]
    given = ts.check(lost_at_a_crossing, worlds=figures)
    assert ts.check(lost_at_a_crossing, worlds=figures, failures_first=given).worlds == ("figure-1a x:a",)
    assert ts.check(depth_first, worlds=figures, failures_first=given).starts == 2


def test_a_report_of_another_check_has_no_failures_to_begin_with():
    report = ts.check(lost_at_a_crossing, edges=2)
    for options in [{"cls": "simple"}, {"marker": "none"}]:
        with pytest.raises(errors.OtherCheckError, match="of class multigraph with the marker directional"):
            ts.check(depth_first, edges=2, failures_first=report, **options)
    with pytest.raises(errors.OtherCheckError, match="not 7"):
        ts.check(depth_first, edges=2, failures_first=7)
    with pytest.raises(errors.UnusedOptionError, match="keep_going"):
        ts.check(depth_first, edges=2, failures_first=report, keep_going=True)


def test_a_check_of_an_iterator_needs_no_memory_for_it():
    """There are more than 10^20 starts; the check ends after the first that fails."""
    report = ts.check(lambda robot: None, worlds=ts.starts(20), stop_after=3)
    assert (report.starts, report.failed) == (3, 3)


def test_an_enumeration_is_used_in_another_process():
    code = (
        "import os, toposlam as ts\n"
        "starts = ts.starts(3)\n"
        "next(starts)\n"
        "child = os.fork()\n"
        "if child == 0: os._exit(sum(1 for _ in starts))\n"
        "print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), sum(1 for _ in starts))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout == "73 73\n", done.stderr
