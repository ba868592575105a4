"""The exceptions of the package: one class for each cause.

Every exception is a `ToposlamError`. Those about an explorer, an `ExplorerError`, also give the start at
which it failed and the number of moves that it had made.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .failures import Failure
    from .markers import Marker
    from .worlds import World


class ToposlamError(Exception):
    """Something that this package reports."""

    def __init__(self, message: str, /) -> None:
        super().__init__(message)
        self.message = message

    def __str__(self) -> str:
        return self.message


class InternalError(ToposlamError):
    """A bug in this package."""


class MissingLibraryError(ToposlamError, ImportError):
    """An optional library is not installed."""


class FrozenError(ToposlamError, AttributeError):
    """A value that cannot be changed was to be changed."""


# Names and sizes


class UnknownMarkerError(ToposlamError, ValueError):
    """There is no kind of marker with this name."""


class UnknownClassError(ToposlamError, ValueError):
    """There is no class of worlds with this name."""


class UnknownAlgorithmError(ToposlamError, ValueError):
    """There is no algorithm with this name."""


class SizeError(ToposlamError, ValueError):
    """A number of edges is too small, or too large."""


class UnusedOptionError(ToposlamError, TypeError):
    """An option has no effect beside the others."""


class ShardError(ToposlamError, ValueError):
    """A text is not a shard `i/n`, or reports are not of disjoint shards of one check."""


class OtherCheckError(ToposlamError, ValueError):
    """A report is not one of an earlier check of the same class and marker."""


class ContradictionError(ToposlamError, ValueError):
    """No world, of any size, explains a walk; or its vertices have too many doors."""


class MapTooLargeError(ToposlamError):
    """A map has more darts than a bound allows."""


class PictureError(ToposlamError):
    """A picture cannot be made."""


class LogError(ToposlamError, ValueError):
    """A log cannot be read or checked."""


# Worlds


class WorldError(ToposlamError, ValueError):
    """Something is not a world."""


class WorldFileError(WorldError):
    """A file is not a world file."""


class WorldTypeError(WorldError, TypeError):
    """A value of this type cannot be a world."""


class NoEmbeddingError(WorldError):
    """A graph has no clockwise order of its edges."""


class MissingEdgeError(WorldError):
    """One end of an edge is missing, or leads to nothing."""


class RepeatedEdgeError(WorldError):
    """Neighbours describe a loop or parallel edges, which need doors."""


class NotConnectedError(WorldError):
    """A world is not connected."""


class NoEdgeError(WorldError):
    """A world has no edge."""


class NotSimpleError(WorldError):
    """A world has a loop or parallel edges."""


class PermutationError(WorldError):
    """Two permutations are not those of a world."""


class NoStartError(WorldError):
    """A world has no start, and none is given."""


class UnknownStartError(WorldError):
    """A start is not in its world."""


class RenamedVertexWarning(UserWarning):
    """A vertex has another name than its text: no name in a world file has all of its letters."""


# Markers


class MarkerFunctionError(ToposlamError):
    """A marker's function raised an exception, returned something that is not hashable, or does not give the
    same each time, and for the same pose in each copy of a world."""


# Explorers


class ExplorerError(ToposlamError):
    """An explorer failed.

    `start` is the start, as a text, and `moves` the number of moves made by then. An error that `explore`
    raises has the whole run, its `failure`.
    """

    def __init__(self, message: str, /, start: str | None = None, moves: int | None = None) -> None:
        super().__init__(message)
        self.start = start
        self.moves = moves
        self.failure: Failure | None = None

    def __str__(self) -> str:
        place = [] if self.start is None else [f"start {self.start}"]
        if self.moves is not None:
            place.append(f"after {self.moves} move{'' if self.moves == 1 else 's'}")
        return f"{', '.join(place)}: {self.message}" if place else self.message

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.message, self.start, self.moves), self.__dict__


class NotAnExplorerError(ExplorerError, TypeError):
    """An explorer cannot be called with a robot."""


class DoorTypeError(ExplorerError, TypeError):
    """A door is not a number."""


class NoSuchDoorError(ExplorerError, ValueError):
    """An explorer took a door that its vertex does not have."""


class NoMarkerError(ExplorerError):
    """An explorer picked up a marker that is not there, or dropped one that it does not carry."""


class UnknownActionError(ExplorerError, ValueError):
    """A text is no action of a robot."""


class NotPossibleError(ExplorerError):
    """A marking aid does not have an action, or its string is too short."""


class LimitError(ExplorerError):
    """An explorer reached a limit. Whether it would have ended well is not known."""


class OutOfMovesError(LimitError):
    """An explorer made more moves than are allowed."""


class OutOfTimeError(LimitError):
    """An explorer took more time than is allowed."""


class EndedRunError(ExplorerError):
    """An explorer moved a robot of a run that has ended."""


class RaisedError(ExplorerError):
    """An explorer raised an exception. That is the `__cause__`, unless the error comes from another
    process."""


class NoAnswerError(ExplorerError):
    """An explorer returned None."""


class AnswerError(ExplorerError):
    """An explorer returned something that is not a map and a pose."""


class WrongMapError(ExplorerError):
    """An explorer's map is not its world."""


class WrongPoseError(ExplorerError):
    """An explorer's map is right, and the robot is elsewhere."""


class GuessedError(ExplorerError):
    """An explorer's map is right, and its walk does not determine the world: it makes the same walk in
    another world, and returns the same map. `other` is that world."""

    _walk: tuple[World, Marker, tuple[int | str, ...]] | None = None
    _found: tuple[World | None, bool] | None = None

    def _search(self) -> tuple[World | None, bool]:
        if self._found is None:
            from .worlds import other_world

            self._found = (None, False) if self._walk is None else other_world(*self._walk)
        return self._found

    @property
    def other(self) -> World | None:
        """The smallest other world with the same run; its start is that of the run. None while the run is
        not known."""
        return self._search()[0]

    @property
    def other_is_smallest(self) -> bool:
        """Whether the search has shown that no smaller one exists. It ends after a number of steps."""
        return self._search()[1]


class NotPicklableError(ToposlamError, TypeError):
    """An explorer cannot be sent to another process."""


class WorkerLostError(ToposlamError):
    """A worker process of a check ended before its result."""
