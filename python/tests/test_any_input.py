"""Nothing that is passed in makes the extension module panic: every exception is one of this package, or a
TypeError of Python's own."""

import json
import random
from pathlib import Path

import pytest

import toposlam as ts
from toposlam import errors

ALLOWED = (errors.ToposlamError, TypeError)
JUNK = [
    None,
    True,
    -1,
    0,
    1,
    7,
    2**31,
    2**64,
    0.5,
    float("nan"),
    "",
    "x",
    "x:a",
    b"\xff",
    (),
    [],
    {},
    ("x", 0),
]


def attempt(function, *arguments, **options):
    """Calls a function; an exception that is not allowed fails the test."""
    try:
        return function(*arguments, **options)
    except errors.InternalError:
        raise
    except ALLOWED:
        return None


def junk(draw):
    """A value of any shape."""
    kind = draw.randrange(6)
    if kind == 0:
        return [junk(draw) for _ in range(draw.randrange(4))]
    if kind == 1:
        return {draw.randrange(4): junk(draw) for _ in range(draw.randrange(4))}
    if kind == 2:
        return tuple(junk(draw) for _ in range(draw.randrange(3)))
    return draw.choice(JUNK)


def almost_a_map(draw):
    """A dict of neighbours or far ends in which something may be wrong."""
    if draw.random() < 0.5:
        name = draw.choice(["figure-1a", "theta-torus", "shape-6", "two-loops-torus"])
        ends = {v: list(ends) for v, ends in ts.World.load(f"worlds/{name}.toml").far_ends.items()}
        if draw.random() < 0.7:
            draw.choice(list(ends.values())).append(junk(draw))
        return ends
    count = draw.randrange(1, 5)
    if draw.random() < 0.5:
        return {v: [draw.randrange(count) for _ in range(draw.randrange(4))] for v in range(count)}
    return {
        v: [(draw.randrange(count), draw.randrange(-1, 3)) for _ in range(draw.randrange(4))]
        for v in range(count)
    }


@pytest.mark.parametrize("seed", range(4))
def test_any_world(seed):
    draw = random.Random(seed)
    made = 0
    for _ in range(1500):
        value = almost_a_map(draw) if draw.random() < 0.7 else junk(draw)
        world = attempt(ts.World, value)
        if isinstance(world, ts.World):
            made += 1
            assert world.edge_count >= 1
            attempt(world.with_start, junk(draw))
            attempt(world.after, junk(draw), draw.randrange(9))
        images = [draw.randrange(-1, 5) for _ in range(draw.randrange(6))]
        attempt(ts.World.from_permutations, images, junk(draw))
        attempt(ts.World.from_permutations, images, [draw.randrange(4) for _ in images])
    assert made > 10


@pytest.mark.parametrize("seed", range(2))
def test_any_answer_and_any_action(seed):
    draw = random.Random(seed)

    def explorer(robot):
        for _ in range(draw.randrange(4)):
            robot.go(draw.choice([0, 0, 0, 1, 1, 2, *JUNK]))
        if draw.random() < 0.1:
            draw.choice([robot.pick_up, robot.drop])()
        map_ = draw.choice([almost_a_map(draw), {0: [1], 1: [0]}])
        answer = (map_, (draw.randrange(3), draw.randrange(2)))
        return answer if draw.random() < 0.7 else junk(draw)

    report = ts.check(explorer, edges=[3, 4], max_failures=10_000, keep_going=True)
    assert report.starts == 780
    assert len(report.failures) == report.failed
    assert all(isinstance(failure.error, errors.ExplorerError) for failure in report.failures)
    kinds = {type(failure.error) for failure in report.failures}
    assert {errors.AnswerError, errors.NoSuchDoorError, errors.DoorTypeError, errors.WrongMapError} <= kinds


def test_any_bytes(tmp_path):
    draw = random.Random(5)
    worlds = [Path(f"worlds/{name}.toml").read_bytes() for name in ["figure-1a", "theta-torus", "shape-6"]]
    line = json.dumps({"degree": 3, "marker": 0, "door": 1, "stamp": 1.0}).encode() + b"\n"
    for number in range(300):
        data = bytearray(draw.choice([*worlds, 4 * line]))
        for _ in range(draw.randrange(1, 4)):
            at = draw.randrange(len(data))
            data[at : at + draw.randrange(3)] = bytes(draw.randrange(256) for _ in range(draw.randrange(3)))
        file = tmp_path / f"{number % 7}.{draw.choice(['toml', 'json', 'pc', 'ec', 'log'])}"
        file.write_bytes(data)
        attempt(ts.World.load_all, file)
        attempt(ts.read_log, file)
        attempt(ts.conform, file, driver="anyone", marker="none")


def test_any_argument():
    world = ts.World.load("worlds/figure-1a.toml")
    for value in JUNK:
        for function in [ts.explore, ts.compare, ts.World.load, ts.read_log, ts.conform, ts.check]:
            with pytest.raises(ALLOWED):
                function(value)
        attempt(ts.explore, world, value)
        attempt(ts.explore, world, lambda robot: None, max_moves=value, seconds=value)
        attempt(ts.conform, "worlds", world, max_edges=value)
        attempt(ts.compare, world, world, value)
        attempt(ts.counterexample, value, "simple", 2)
        attempt(ts.counterexample, "none", value, 2)
        attempt(ts.check_shard, value, lambda robot: None)
        attempt(world.robot, value)
        attempt(world.robot, max_moves=value)
        attempt(world.robot().go, value)
        attempt(world.draw, marker=value)
        attempt(world.draw, title=value)
        attempt(world.walk, world.start, value)
        attempt(ts.check, lambda robot: None, worlds=value)
        attempt(ts.check, lambda robot: None, worlds=[value])
        attempt(ts.check, lambda robot: None, 1, failures_first=value)
        attempt(ts.check, lambda robot: None, 1, marker=value)
        attempt(ts.starts, value)
        attempt(ts.worlds, 2, value)
        attempt(ts.random_world, value)
        attempt(ts.random_world, 2, "simple", value)
        attempt(ts.Trail, value)
        attempt(ts.Trail(world.robot().percept).step, value, world.robot().percept)
        attempt(ts.Trail(world.robot().percept).step, 0, value)
        attempt(ts.shards, value)
        attempt(ts.merge, value)
        attempt(ts.merge, [value])
