"""The whole run of an explorer that failed."""

import pickle
from pathlib import Path

import pytest

import toposlam as ts


def there(robot):
    """Right in a world with one edge."""
    robot.go(0)
    return {"here": ["there"], "there": ["here"]}, ("there", 0)


def back(robot):
    """Right in a chain of two edges from an end, of which it never sees the other one."""
    robot.go(0)
    robot.go(0)
    return {0: [1], 1: [0, 2], 2: [1]}, (0, 0)


CHAIN = ts.World({0: [1], 1: [0, 2], 2: [1]}, name="chain")


def test_a_failure_has_the_whole_run_and_the_map() -> None:
    failure = ts.check(there, edges=2, cls="simple").failures[0]
    assert isinstance(failure.error, ts.errors.WrongMapError)
    assert failure.actions == (0,)
    robot = failure.world.robot()
    assert failure.percepts == (robot.percept, robot.go(0))
    assert failure.map is not None and failure.map.vertices == ("here", "there")
    assert failure.pose == ("there", 0)
    assert failure.other is None
    assert str(failure) in failure.story
    assert "The map that it returned" in failure.story


def test_a_guess_has_the_smallest_other_world() -> None:
    with pytest.raises(ts.errors.GuessedError) as raised:
        ts.explore(CHAIN, algorithm=back)
    error = raised.value
    # Behind the door that it never took there may be one edge more, and nothing smaller than that.
    longer = ts.World({0: [1], 1: [0, 2], 2: [1, 3], 3: [2]})
    assert error.other is not None and error.other.is_isomorphic(longer)
    assert error.other_is_smallest
    assert error.failure is not None and error.failure.other is error.other
    assert "The smallest other world with this run" in error.failure.story


def test_the_run_in_the_other_world_is_the_same() -> None:
    guesses = 0
    for failure in ts.check(back, edges=range(2, 6), keep_going=True, max_failures=1000).failures:

        def right(robot, world=failure.world):
            robot.go(0)
            return dict(world.far_ends), world.after(world.start, 0)

        with pytest.raises(ts.errors.GuessedError) as raised:
            ts.explore(failure.world, algorithm=right)
        other = raised.value.other
        assert other is not None and not other.is_isomorphic(failure.world)
        robots = [world.robot() for world in (failure.world, other)]
        assert robots[0].percept == robots[1].percept
        assert robots[0].go(0) == robots[1].go(0)
        guesses += 1
    assert guesses > 100


def test_a_run_without_a_map_is_shown_alone() -> None:
    def lost(robot):
        robot.go(0)
        robot.go(7)

    failure = ts.check(lost, edges=1, cls="simple").failures[0]
    assert (failure.map, failure.pose, failure.actions) == (None, None, (0,))
    assert "The map" not in failure.story
    assert "fails on" in failure.draw().svg


@pytest.mark.parametrize("explorer", [there, back])
def test_a_failure_is_written_as_a_page_and_as_a_picture(explorer, tmp_path: Path) -> None:
    failure = ts.check(explorer, edges=3, cls="simple").failures[0]
    failure.save(tmp_path / "run.html")
    page = (tmp_path / "run.html").read_text(encoding="utf-8")
    assert page.count('class="panel world"') == 2
    failure.save(tmp_path / "run.svg")
    failure.save(tmp_path / "run.png")
    assert (tmp_path / "run.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ts.errors.PictureError, match=r"ends with \.html, \.svg or \.png"):
        failure.save(tmp_path / "run.txt")


def test_failures_and_their_errors_are_pickled() -> None:
    failure = ts.check(back, edges=2, cls="simple", keep_going=True).failures[-1]
    again = pickle.loads(pickle.dumps(failure))
    assert (again.actions, again.map, again.story) == (failure.actions, failure.map, failure.story)
    with pytest.raises(ts.errors.GuessedError) as raised:
        ts.explore(CHAIN, algorithm=back)
    error = pickle.loads(pickle.dumps(raised.value))
    assert error.other == raised.value.other
    assert error.failure.actions == (0, 0)
