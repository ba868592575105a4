"""Plots by matplotlib, which is imported only here."""

from __future__ import annotations

from collections import Counter
from typing import Any

from .checks import CheckReport
from .logs import ConformReport, Log
from .progress import library


def _axes(axes: Any) -> Any:
    if axes is not None:
        return axes
    return library("matplotlib.pyplot", "a plot").subplots()[1]


def plot_way(log: Log, axes: Any = None) -> Any:
    """The robot's way by odometry, in metres; returns the axes."""
    axes = _axes(axes)
    axes.plot(log.poses["x"], log.poses["y"], linewidth=1)
    axes.set(xlabel="x (m)", ylabel="y (m)", title=log.path.name, aspect="equal")
    return axes


def plot_visits(report: ConformReport, axes: Any = None) -> Any:
    """How often the robot was at each vertex of the known world, or at junctions of each degree; returns the
    axes."""
    axes = _axes(axes)
    visits = [event for event in report.events if event.kind == "percept"]
    if report.world is not None:
        counts = Counter(event.pose.vertex for event in visits if event.pose is not None)
        names = [vertex for vertex in report.world.vertices if counts[vertex]]
        axes.set(xlabel="vertex")
    else:
        degrees = Counter(event.percept.degree for event in visits if event.percept is not None)
        counts = Counter({str(degree): count for degree, count in degrees.items()})
        names = [str(degree) for degree in sorted(degrees)]
        axes.set(xlabel="degree")
    axes.bar(names, [counts[name] for name in names])
    axes.set(ylabel="visits", title=report.path.name)
    return axes


def plot_costs(*reports: CheckReport, axes: Any = None) -> Any:
    """The mean number of moves of explorers by the number of edges, and that of the certificates; returns the
    axes."""
    axes = _axes(axes)
    for report in reports:
        sizes = [size for size in report.sizes if size.mapped]
        edges = [size.edges for size in sizes]
        axes.plot(edges, [size.moves / size.mapped for size in sizes], "o-", label=report.explorer)
    sizes = [size for size in reports[0].sizes if size.mapped and size.certificate] if reports else []
    if sizes:
        means = [size.certificate / size.mapped for size in sizes]
        axes.plot([size.edges for size in sizes], means, "k--", label="certificate")
    axes.set(xlabel="edges", ylabel="mean moves")
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.legend()
    return axes
