"""A page on which a person is the robot."""

from __future__ import annotations

import html
import os
from pathlib import Path

from . import _core
from .enumeration import check_random
from .errors import PictureError, UnknownMarkerError
from .limits import check_unused
from .worlds import World, world_of


class Page:
    """A page for a browser: one document that needs no network. A notebook shows it."""

    __slots__ = ("html",)

    html: str

    def __init__(self, html: str) -> None:
        self.html = html

    def _repr_html_(self) -> str:
        document = html.escape(self.html)
        return f'<iframe srcdoc="{document}" width="100%" height="900" style="border: 0"></iframe>'

    def __repr__(self) -> str:
        return f"<Page, {len(self.html)} characters of HTML>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a .html file."""
        file = Path(path)
        if file.suffix not in (".html", ".htm"):
            raise PictureError(f"{file}: the name of a page ends with .html")
        file.write_text(self.html, encoding="utf-8")


def play(
    world: World | None = None,
    marker: str = "directional",
    *,
    cls: str | None = None,
    edges: int | None = None,
    seed: int | None = None,
) -> Page:
    """Returns a page on which you are the robot: you map a world from its percepts, and it judges your map.

    Without a world, the page has random ones of the class `cls` ("corridor") with `edges` edges (6), chosen
    by `seed` (1). `marker` is the name of a marking aid.

    Raises `WorldTypeError` for what is not a world, `NoStartError` if it has no start, `UnknownMarkerError`,
    `UnknownClassError`, `SizeError`, or `UnusedOptionError`.

    >>> import toposlam as ts
    >>> page = ts.play(ts.World.load("worlds/figure-1a.toml"), marker="undirected")
    >>> page.save("target/play.html")
    """
    if not isinstance(marker, str):
        raise UnknownMarkerError(f"the marker of a game is a name, not {marker!r}")
    if world is not None:
        check_unused("with a world", cls=cls, edges=edges, seed=seed)
        given = world_of(world)
        return Page(_core.world_page(given._core, given.facing(), marker))
    edges = 6 if edges is None else edges
    seed = 1 if seed is None else seed
    check_random(edges, seed)
    return Page(_core.random_page("corridor" if cls is None else cls, edges, seed, marker))
