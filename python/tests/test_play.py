"""The page on which a person is the robot."""

import html
import json
import re

import pytest

import toposlam as ts
from toposlam import errors


def data(page):
    (text,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page.html)
    return json.loads(text)


def test_a_page_has_the_world_from_each_of_its_starts():
    # The planar wheel has a rotation by a quarter: its 16 darts are 4 starts.
    world = ts.World.load("worlds/figure-1a.toml")
    page = ts.play(world, marker="undirected")
    found = data(page)
    assert found["marker"] == "undirected"
    assert [game["name"] for game in found["games"]] == ["figure-1a"] * 4
    assert found["games"][0]["start"] == [0, 0]
    assert found["games"][0]["walks"] == []
    assert [len(ends) for ends in found["games"][0]["world"]] == [4, 3, 3, 3, 3]


def test_a_page_of_random_worlds_is_that_of_the_seed():
    page = ts.play(cls="multigraph", edges=3, seed=5)
    assert page.html == ts.play(cls="multigraph", edges=3, seed=5).html
    assert page.html != ts.play(cls="multigraph", edges=3, seed=6).html
    games = data(page)["games"]
    assert {sum(map(len, game["world"])) for game in games} == {6}
    # The certificate is the shortest of the walks.
    for game in games:
        moves = [len(walk["actions"]) for walk in game["walks"]]
        assert moves[0] == min(moves)


def test_a_notebook_shows_the_page_and_it_can_be_saved(tmp_path):
    page = ts.play(edges=2)
    (document,) = re.findall(r'^<iframe srcdoc="([^"]*)"', page._repr_html_())
    assert html.unescape(document) == page.html
    page.save(tmp_path / "play.html")
    assert (tmp_path / "play.html").read_text(encoding="utf-8") == page.html
    with pytest.raises(errors.PictureError, match=r"play\.txt: the name of a page ends with \.html"):
        page.save(tmp_path / "play.txt")


@pytest.mark.parametrize(
    ("error", "options"),
    [
        (errors.WorldTypeError, {"world": "worlds/figure-1a.toml"}),
        (errors.UnknownMarkerError, {"marker": "flag"}),
        (errors.UnknownMarkerError, {"marker": len}),
        (errors.UnknownClassError, {"cls": "large"}),
        (errors.SizeError, {"edges": 9}),
        (errors.SizeError, {"edges": 0}),
        (errors.SizeError, {"seed": -1}),
        (errors.UnusedOptionError, {"world": ts.World({0: [1], 1: [0]}), "edges": 3}),
    ],
)
def test_what_cannot_be_played_is_an_error(error, options):
    with pytest.raises(error):
        ts.play(**options)
