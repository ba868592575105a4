"""Logs: what they record, and whether they conform."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

import toposlam as ts
from toposlam import errors

CARMEN = Path(os.environ.get("TOPOSLAM_CARMEN_LOGS", "/nowhere"))
needs_logs = pytest.mark.skipif(
    not (CARMEN / "aces.log.gz").exists(), reason="TOPOSLAM_CARMEN_LOGS names no folder with aces.log.gz"
)


def recorded(world, path, change=None):
    """The run of Algorithm 1 in a world as a list of events."""
    run, robot = ts.explore(world), world.robot()
    lines = []
    for step, door in enumerate([*run.actions, None]):
        percept = robot.percept
        marker = -1 if percept.marker is None else percept.marker
        line = {"degree": percept.degree, "marker": marker, "door": door, "stamp": float(step)}
        lines.append({**line, **(change or {}).get(step, {})})
        if door is not None:
            robot.go(door)
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return run


def test_a_run_of_algorithm_1_conforms(tmp_path):
    for name in ["shape-6", "figure-1a", "petersen"]:
        world = ts.World.load(f"worlds/{name}.toml")
        run = recorded(world, tmp_path / "run.jsonl")
        log = ts.read_log(tmp_path / "run.jsonl")
        assert log.format == "events"
        assert log.events["door"][1::2] == list(run.actions)
        assert [row for row in log.events["kind"] if row == "percept"] == ["percept"] * (run.moves + 1)
        report = ts.conform(tmp_path / "run.jsonl", world)
        assert (report.verdict, report.evidence, report.candidates) == ("conforms", "recorded", 1)
        assert report.divergence is None
        assert report.events[0].pose == world.start
        assert report.events[-1].pose == world.walk(world.start, run.actions)
        assert report.determines_world
        assert sum(report.coverage.values()) > 0
        # Without the world, it is found.
        found = ts.conform(tmp_path / "run.jsonl")
        assert found.smallest.is_isomorphic(world)


def test_lines_that_are_not_read_are_a_remark(tmp_path):
    path = tmp_path / "run.jsonl"
    recorded(ts.World.load("worlds/shape-6.toml"), path)
    assert ts.conform(path).remarks == ()
    path.write_text(path.read_text() + '{"kind":"note"}\n' * 2)
    assert ts.conform(path).remarks == ("skipped lines: 2 note",)


def test_a_wrong_percept_diverges(tmp_path):
    world = ts.World.load("worlds/figure-1a.toml")
    recorded(world, tmp_path / "run.jsonl", {3: {"degree": 5}})
    report = ts.conform(tmp_path / "run.jsonl", world)
    assert report.verdict == "diverged"
    assert (report.divergence.event, report.divergence.fault) == (7, "perception")
    assert "event 7" in repr(report)


def test_an_assumed_marker_must_be_seen(tmp_path):
    """As the command: a robot that never perceives a marker does not follow an algorithm that needs one."""
    lines = [{"degree": 1, "marker": -1, "door": 0, "stamp": 0.0}, {"degree": 1, "marker": -1, "stamp": 1.0}]
    (tmp_path / "run.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    with pytest.raises(errors.LogError, match="no percept in it shows a marker, which Algorithm 1 needs"):
        ts.conform(tmp_path / "run.jsonl")
    assert ts.conform(tmp_path / "run.jsonl", driver="anyone", marker="none").verdict == "conforms"
    assert ts.conform(tmp_path / "run.jsonl", marker="directional").verdict == "diverged"


def test_an_undirected_marker_is_seen_with_or_without_a_direction(tmp_path):
    log = tmp_path / "run.jsonl"
    cases = [("0", "0", "conforms"), ("true", "0", "conforms"), ("true", "-1", "diverged")]
    for first, last, verdict in cases:
        log.write_text(
            f'{{"degree":2,"marker":{first},"door":1}}\n{{"degree":1,"marker":false,"door":0}}\n'
            f'{{"degree":2,"marker":{last},"door":1}}\n{{"degree":3,"marker":-1}}\n'
        )
        assert ts.conform(log, driver="anyone", marker="undirected").verdict == verdict


def test_tables_are_those_of_numpy_and_pandas(tmp_path):
    pandas, numpy = pytest.importorskip("pandas"), pytest.importorskip("numpy")
    run = recorded(ts.World.load("worlds/shape-6.toml"), tmp_path / "run.jsonl")
    events = ts.read_log(tmp_path / "run.jsonl").events
    frame = events.pandas()
    assert isinstance(frame, pandas.DataFrame) and len(frame) == events.rows == 2 * run.moves + 1
    report = ts.conform(tmp_path / "run.jsonl").pandas()
    assert report["number"].tolist() == list(range(1, 2 * run.moves + 2))
    assert report["door"].dropna().tolist() == frame["door"].dropna().tolist()
    doors = events.numpy()["door"]
    assert doors.dtype == float and numpy.nansum(doors) == sum(run.actions)


def test_plots(tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    world = ts.World.load("worlds/shape-6.toml")
    recorded(world, tmp_path / "run.jsonl")
    axes = ts.plot_visits(ts.conform(tmp_path / "run.jsonl", world))
    assert sum(bar.get_height() for bar in axes.patches) == ts.explore(world).moves + 1
    axes = ts.plot_visits(ts.conform(tmp_path / "run.jsonl"))
    assert axes.get_xlabel() == "degree"
    from depth_first import depth_first

    axes = ts.plot_costs(ts.check(depth_first, edges=[1, 2, 3]))
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["depth_first", "certificate"]
    assert list(axes.get_lines()[1].get_ydata()) == [1.0, 2.2, 266 / 74]
    assert {1, 2, 3} <= {int(tick) for tick in axes.get_xticks() if tick == int(tick)}
    assert all(tick == int(tick) for tick in axes.get_xticks())
    axes = ts.plot_way(ts.read_log(tmp_path / "run.jsonl"))
    assert axes.get_title() == "run.jsonl"


def test_a_simulated_robot(tmp_path, required):
    program = shutil.which("toposlam")
    if program is None:
        required("there is no program `toposlam` on the path")
    log = tmp_path / "run.mcap"
    command = [program, "simulate", "worlds/shape-6.toml", "--log", str(log)]
    subprocess.run(command, check=True, capture_output=True)
    found = ts.read_log(log)
    assert found.format == "mcap" and found.head["algorithm"] == "folding"
    assert found.scenes.rows > 50 and found.poses.rows > 50
    assert {"hallway", "junction"} <= set(found.scenes["place"])
    report = ts.conform(log, ts.World.load("worlds/shape-6.toml"))
    assert (report.verdict, len(report.events)) == ("conforms", 15)


@needs_logs
def test_a_real_building():
    """The numbers are those of docs/real-logs.md."""
    world = ts.World.load("worlds/real/aces.toml")
    log = ts.read_log(CARMEN / "aces.log.gz")
    assert log.format == "carmen"
    assert 1300 < log.duration < 1400
    assert "<svg" in log.draw().svg
    report = ts.conform(log.path, world, driver="anyone", marker="none")
    assert (report.verdict, report.evidence) == ("conforms", "laser")
    # One visit turned back, and is no visit of its own.
    assert sum(event.kind == "percept" for event in report.events) == 11
    smallest = ts.conform(log.path, driver="anyone", marker="none").smallest
    assert smallest.edge_count == 5
    marked = ts.conform(log.path, driver="anyone", assume_marker=True)
    assert (marked.smallest.edge_count, marked.determines_world) == (8, False)
    with pytest.raises(errors.LogError, match="do not record whether the robot saw its marker"):
        ts.conform(log.path)


@pytest.mark.parametrize("data", [b"\x89MCAP0\r\n", b"#ROSBAG V2.0\n\xff\xff"])
def test_a_log_of_which_only_the_beginning_is_left(tmp_path, data):
    (tmp_path / "log").write_bytes(data)
    log = ts.read_log(tmp_path / "log")
    assert log.truncation is not None and log.events.rows == 0
    with pytest.raises(errors.LogError, match="log: "):
        ts.conform(tmp_path / "log")


@pytest.mark.parametrize("data", [b"", b"hello\n"])
def test_a_file_that_is_not_a_log(tmp_path, data):
    (tmp_path / "log").write_bytes(data)
    for read in [ts.read_log, ts.conform]:
        with pytest.raises(errors.LogError, match="log: "):
            read(tmp_path / "log")


EDGE = ts.World({"a": ["b"], "b": ["a"]})
"""Any world."""


@pytest.mark.parametrize(
    "options, kind",
    [
        ({"driver": "nobody"}, errors.UnknownAlgorithmError),
        ({"marker": "chalk"}, errors.UnknownMarkerError),
        ({"cls": "tree"}, errors.UnknownClassError),
        ({"max_steps": 0}, errors.SizeError),
        ({"max_darts": -3}, errors.SizeError),
        ({"max_edges": -1}, errors.SizeError),
        ({"marker": "undirected"}, errors.LogError),
        ({"corners": True}, errors.UnusedOptionError),
        ({"world": EDGE, "cls": "simple"}, errors.UnusedOptionError),
        ({"world": EDGE, "max_edges": 9}, errors.UnusedOptionError),
        ({"world": EDGE, "max_steps": 9}, errors.UnusedOptionError),
    ],
)
def test_wrong_options(tmp_path, options, kind):
    recorded(ts.World.load("worlds/shape-6.toml"), tmp_path / "run.jsonl")
    with pytest.raises(kind):
        ts.conform(tmp_path / "run.jsonl", **options)


def test_a_log_that_is_not_there():
    with pytest.raises(errors.LogError, match="no such file"):
        ts.read_log("nowhere.mcap")
    with pytest.raises(errors.LogError, match="no such file"):
        ts.conform("nowhere.mcap")


def test_a_library_that_is_missing(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "pandas", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(errors.MissingLibraryError, match="pip install pandas"):
        ts.Table({"a": [1]}).pandas()
    with pytest.raises(errors.MissingLibraryError, match="pip install tqdm"):
        ts.check(lambda robot: None, edges=1, progress=True)
    assert ts.check(lambda robot: None, edges=1).failed == 2
