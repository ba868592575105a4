"""Marking aids that move; docs/aids.md defines them."""

import pytest
from depth_first import depth_first

import toposlam as ts
from toposlam import errors

RING = "worlds/cycle-3.toml"


def robot(aid):
    return ts.World.load(RING).robot(aid)


def test_a_robot_sees_which_of_its_markers_are_here():
    sent = robot("movable-2-distinct")
    assert sent.percept.marker == "first+second"
    assert sent.act("pick-up-2").marker == "first"
    assert sent.go(1).marker is None
    assert sent.act("drop-2").marker == "second"
    assert sent.actions == ["pick-up-2", 1, "drop-2"] and sent.moves == 1
    with pytest.raises(errors.NoMarkerError):
        sent.act("drop-2")


def test_a_robot_lays_a_string_and_sees_through_which_doors_it_runs():
    sent = robot("string-1")
    assert sent.percept.marker == {"doors": [], "fixed_end": True, "free_end": False, "hand": None}
    assert sent.go(1).marker == {"doors": [0], "fixed_end": False, "free_end": False, "hand": 0}
    with pytest.raises(errors.NotPossibleError):
        sent.go(1)
    assert sent.act("drop").marker == {"doors": [0], "fixed_end": False, "free_end": True, "hand": None}


def test_a_robot_sends_another_one_and_knows_where_it_is():
    sent = robot("team-2")
    assert sent.percept.marker == {"robots": [{"place": "here", "along": 0}]}
    assert sent.act("send-2:1").marker == {"robots": [{"place": "elsewhere", "degree": 2}]}
    assert sent.go(1).marker == {"robots": [{"place": "here", "along": 0}]}
    # The other robot's move counts, too.
    assert sent.moves == 2


@pytest.mark.parametrize("action", ["", "pick", "drop-x", "send-2", "2"])
def test_a_text_that_is_no_action_is_an_error(action):
    with pytest.raises(errors.UnknownActionError):
        robot("movable").act(action)


def test_an_aid_does_not_have_the_actions_of_another():
    with pytest.raises(errors.NotPossibleError):
        robot("movable").act("send-2:1")


def test_one_vertex_hides_what_has_no_front():
    # Four darts around one vertex; they are joined in two ways.
    planar, other = (
        ts.World.from_permutations(opposite, [1, 2, 3, 0], 0) for opposite in ([1, 0, 3, 2], [2, 3, 0, 1])
    )
    for aid in ("movable-4", "movable-2-distinct", "team-3-round"):
        assert ts.compare(planar, other, marker=aid).relation is not None
    for aid in ("movable-directional", "string-1", "team-2"):
        assert ts.compare(planar, other, marker=aid).walk is not None


def test_a_robot_with_binoculars_sees_what_is_near():
    ring = {f"v{at}": [f"v{(at + 4) % 5}", f"v{(at + 1) % 5}"] for at in range(5)}
    sent = ts.World(ring, start=("v0", 0)).robot("binoculars-1")
    assert sent.percept.marker == {"ball": [[(1, 0), (2, 0)], [(0, 0), None], [(0, 1), None]]}
    assert str(sent.percept) == "2 doors, sees 3 junctions: 1 2, 0 -, 0 -"
    pair = ts.counterexample("binoculars-1", cls="simple", edges=5).smallest
    assert (pair.one.edge_count, pair.other.edge_count) == (4, 5)


def test_the_search_takes_an_aid():
    assert ts.counterexample("movable-3", cls="multigraph", edges=3).sizes[1].ambiguous == 2
    assert ts.counterexample("team-2", cls="multigraph", edges=3).smallest is None


def test_an_explorer_for_a_directional_marker_maps_with_one_that_can_be_carried():
    fixed = ts.check(depth_first, edges=3)
    carried = ts.check(depth_first, marker="movable-directional", edges=3)
    assert fixed.verdict == "holds"
    assert [size.moves for size in fixed.sizes] == [size.moves for size in carried.sizes]


def test_nothing_is_claimed_of_a_string_that_is_not_seen():
    leaves = [f"leaf {number}" for number in range(33)]
    star = ts.World({"hub": leaves, **{leaf: ["hub"] for leaf in leaves}}, start=("leaf 0", 0))
    for call in (
        lambda: star.robot("string-1"),
        lambda: ts.compare(star, star, marker="string-1"),
        lambda: ts.explore(star, algorithm="string"),
        lambda: ts.play(star, marker="string-1"),
    ):
        with pytest.raises(errors.SizeError, match="more than 32 doors"):
            call()
    assert ts.explore(star, algorithm="team-2").map.is_isomorphic(star)


def test_a_game_has_any_aid():
    page = ts.play(ts.World.load("worlds/shape-8.toml"), marker="team-2")
    assert '"marker":"team-2"' in page.html
