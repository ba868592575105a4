"""Worlds that a marker cannot distinguish; numbers from docs/commands.md and the paper."""

import itertools
import os
import re
import signal
import subprocess
import sys
import threading
import time

import pytest

import toposlam as ts
from toposlam import errors

A, B = "worlds/figure-1a.toml", "worlds/figure-1b.toml"


def figure_1():
    return ts.World.load(A), ts.World.load(B)


def test_figure_1_with_an_undirected_marker():
    one, other = figure_1()
    found = ts.compare(one, other, marker="undirected")
    assert not found.is_isomorphic and not found.is_distinguishable
    pairs = set(found.relation)
    assert (one.start, found.start_like) in pairs
    # The relation is a bisimulation: each door leads from a pair to a pair, and the percepts agree.
    for here, there in pairs:
        assert one.degree(here.vertex) == other.degree(there.vertex)
        assert (here.vertex == one.start.vertex) == (there.vertex == other.start.vertex)
        for door in range(one.degree(here.vertex)):
            assert (one.after(here, door), other.after(there, door)) in pairs


def test_figure_1_with_a_directional_marker():
    one, other = figure_1()
    walk = ts.compare(one, other).walk
    robots = [one.robot(), other.robot()]
    senses = [[robot.percept, *(robot.go(door) for door in walk.actions)] for robot in robots]
    assert senses[0][:-1] == senses[1][:-1]
    assert (senses[0][-1], senses[1][-1]) == walk.percepts
    assert walk.percepts[0] != walk.percepts[1]


def test_a_world_and_itself():
    one, _ = figure_1()
    found = ts.compare(one, one)
    assert found.is_isomorphic and found.relation is not None
    for dart, image in found.bijection.items():
        assert found.bijection[one.opposite(dart)] == one.opposite(image)
        assert found.bijection[one.clockwise(dart)] == one.clockwise(image)


def test_the_smallest_worlds_of_each_marker():
    found = ts.counterexample(marker="undirected", cls="simple", edges=8)
    pair = found.smallest
    assert (pair.one.edge_count, pair.other.edge_count) == (6, 6)
    assert pair.compare().relation is not None
    assert "<svg" in pair._repr_svg_()
    assert ts.counterexample(marker="directional", cls="multigraph", edges=4).smallest is None


def test_two_worlds_are_drawn_at_one_height():
    """On one background, with their titles at the same height."""
    one, other = ts.World.load("worlds/chain-5.toml"), ts.World.load("worlds/figure-1a.toml")
    drawn = [world.draw(marker="directional").svg for world in (one, other)]
    sizes = [[float(n) for n in re.search(r'viewBox="0 0 (\S+) (\S+)"', svg).groups()] for svg in drawn]
    assert sizes[0][1] != sizes[1][1]
    both = ts.WorldPair(one, other, "directional").draw().svg
    (width, height), *_ = re.findall(r'viewBox="0 0 (\S+) (\S+)"', both)
    assert float(width) == sizes[0][0] + sizes[1][0] and float(height) == max(sizes[0][1], sizes[1][1])
    assert re.findall(r'translate\((\S+) 0\)">\s*<svg', both) == ["0", f"{sizes[0][0]:g}"]
    assert '<rect width="100%" height="100%"' in both[: both.index("<g ")]


def test_a_marker_of_your_own_that_is_a_known_one():
    def undirected(pose, world):
        return "here" if pose.vertex == world.start.vertex else None

    def directional(pose, world):
        if pose.vertex != world.start.vertex:
            return None
        return (world.start.index - pose.index) % world.degree(pose.vertex)

    for own, name, edges in [(undirected, "undirected", 6), (directional, "directional", 5)]:
        mine, known = (ts.counterexample(m, "simple", edges) for m in (own, name))
        assert mine.sizes == known.sizes
        assert [[w.neighbours for w in group] for group in mine.groups] == [
            [w.neighbours for w in group] for group in known.groups
        ]
    one, other = figure_1()
    assert ts.compare(one, other, marker=undirected).relation is not None
    assert ts.compare(one, other, marker=directional).walk is not None


def test_a_beacon_distinguishes_no_more_than_an_undirected_marker():
    """As model/examples/own_marker.rs, which prints the same numbers for both."""

    def beacon(pose, world):
        if pose.vertex == world.start.vertex:
            return "loud"
        return "faint" if world.start.vertex in world.neighbours[pose.vertex] else None

    found = ts.counterexample(beacon, "simple", 6)
    assert found.sizes == ts.counterexample("undirected", "simple", 6).sizes
    # No sign of it is drawn.
    assert found.smallest.draw().svg == ts.WorldPair(*pair_of(found), "none").draw().svg


def pair_of(found):
    return found.smallest.one, found.smallest.other


def test_the_percepts_have_the_values_of_the_function():
    def distance(pose, world):
        return "here" if pose.vertex == world.start.vertex else "elsewhere"

    one, other = (ts.World.load(f"worlds/{name}.toml") for name in ("chain-5", "cycle-4"))
    walk = ts.compare(one, other, marker=distance).walk
    assert walk.actions == () and [percept.degree for percept in walk.percepts] == [1, 2]
    assert [percept.marker for percept in walk.percepts] == ["here", "here"]


def test_a_marker_function_that_is_no_function_of_what_a_robot_knows():
    one, other = ts.World.load("worlds/figure-1a.toml"), ts.World.load("worlds/figure-1b.toml")
    numbers = itertools.count()

    def at_first_door(pose, world):
        return pose.index == 0 and pose.vertex == world.start.vertex

    for marker, text in [
        (lambda pose, world: next(numbers), "gives .*, and then "),
        (lambda pose, world: pose.vertex == "a", "in a copy"),
        (lambda pose, world: pose.vertex == "v0", "in a copy"),
        (lambda pose, world: world.vertices[0] == pose.vertex, "in a copy"),
        (at_first_door, "in a copy"),
    ]:
        with pytest.raises(errors.MarkerFunctionError, match=text):
            ts.counterexample(marker, cls="simple", edges=4)
        with pytest.raises(errors.MarkerFunctionError, match=text):
            ts.compare(one, other, marker=marker)
    # The names of the caller are those of the worlds that are compared.
    with pytest.raises(
        errors.MarkerFunctionError, match=r"pose x:0 in <World figure-1a.* gives True, and False"
    ):
        ts.compare(one, other, marker=lambda pose, world: pose.vertex == "x")


def test_the_words_for_a_directed_edge_are_those_of_the_protocol():
    robot = ts.World.load("worlds/cycle-4.toml").robot("directed-edge")
    seen = {robot.go(door).marker for door in [1, 1, 1, 1, 0, 1, 1, 1, 1]}
    assert seen == {None, "along", "against"}


@pytest.mark.parametrize(
    "marker, kind, text",
    [
        ("chalk", errors.UnknownMarkerError, "`chalk` is not a marking aid"),
        (lambda pose, world: 1 / 0, errors.MarkerFunctionError, "ZeroDivisionError"),
        (lambda pose, world: [], errors.MarkerFunctionError, "unhashable"),
        (lambda: 1, errors.MarkerFunctionError, "positional argument"),
        (7, errors.MarkerFunctionError, "a name or a function"),
    ],
)
def test_what_is_not_a_marker(marker, kind, text):
    with pytest.raises(kind, match=text):
        ts.counterexample(marker, "simple", 3)
    with pytest.raises(kind, match=text):
        ts.compare(*figure_1(), marker=marker)


@pytest.mark.parametrize(
    "cls, edges, kind",
    [
        ("tree", 3, errors.UnknownClassError),
        ("simple", 0, errors.SizeError),
        ("simple", 99, errors.SizeError),
        ("simple", "3", errors.SizeError),
        ("simple", 2.5, errors.SizeError),
    ],
)
def test_what_cannot_be_searched(cls, edges, kind):
    with pytest.raises(kind):
        ts.counterexample("none", cls, edges)


@pytest.mark.skipif(os.name != "posix", reason="Ctrl-C is a signal on POSIX")
def test_ctrl_c_ends_a_marker_function_that_never_ends():
    def endless(pose, world):
        while True:
            pass

    for search in [lambda: ts.counterexample(endless, "simple", 3), lambda: ts.compare(*figure_1(), endless)]:
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        begun = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            search()
        assert time.monotonic() - begun < 10


@pytest.mark.skipif(os.name != "posix", reason="Ctrl-C is a signal on POSIX")
def test_a_long_search_lets_other_threads_run_and_ends_at_ctrl_c():
    """The search would take hours."""
    code = (
        "import threading, time, toposlam as ts\n"
        "ticks = []\n"
        "def tick():\n"
        "    while True: time.sleep(0.01); ticks.append(1)\n"
        "threading.Thread(target=tick, daemon=True).start()\n"
        "print('ready', flush=True)\n"
        "try: ts.counterexample('undirected', 'multigraph', 12)\n"
        "except KeyboardInterrupt: print('stopped', len(ticks) > 20)\n"
    )
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        begun = time.monotonic()
        assert process.stdout.readline() == "stopped True\n"
        assert time.monotonic() - begun < 10
        assert process.wait(10) == 0


def test_progress_is_shown_if_it_is_wanted(capsys):
    pytest.importorskip("tqdm")
    ts.counterexample("none", "simple", 6, progress=True)
    assert "searching" in capsys.readouterr().err
    ts.counterexample("none", "simple", 6, progress=False)
    assert capsys.readouterr().err == ""
    assert threading.active_count() < 10
