"""Each long call returns in a process that is forked after one, and has no threads of its parent."""

import multiprocessing

import pytest
from test_logs import recorded

import toposlam as ts

if "fork" not in multiprocessing.get_all_start_methods():
    pytest.skip("the start method fork is missing on this system", allow_module_level=True)


def a():
    return ts.World.load("worlds/figure-1a.toml")


def beacon(pose, world):
    return "x" if pose.vertex == world.start.vertex else None


CALLS = {
    "certificate": lambda log: a().certificate(),
    "check": lambda log: ts.check(lambda robot: None, edges=1).starts,
    "compare": lambda log: len(ts.compare(a(), a(), marker="undirected").relation),
    "compare, own marker": lambda log: len(ts.compare(a(), a(), marker=beacon).relation),
    "conform": lambda log: ts.conform(log).verdict,
    "counterexample": lambda log: ts.counterexample("none", edges=4).sizes,
    "counterexample, own marker": lambda log: ts.counterexample(beacon, edges=4).sizes,
    "draw": lambda log: a().draw().svg,
    "explore": lambda log: ts.explore(a()).moves,
    "read_log": lambda log: len(ts.read_log(log).events["kind"]),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_call_returns_after_a_fork(name, tmp_path):
    log = tmp_path / "run.jsonl"
    recorded(ts.World.load("worlds/shape-6.toml"), log)
    call = CALLS[name]
    # The same, and one of each kind of work, in the parent.
    expected = [call(log), ts.counterexample("none", edges=4).sizes, ts.conform(log).verdict]
    pipe, end = multiprocessing.Pipe(duplex=False)
    child = multiprocessing.get_context("fork").Process(target=lambda: end.send(call(log)))
    child.start()
    assert pipe.poll(60), f"{name} does not return"
    assert pipe.recv() == expected[0]
    child.join(60)
    assert child.exitcode == 0
