"""The picture of the demo: path from above, a close look, speed over time."""

from __future__ import annotations

import itertools
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from stepmite.plot import ACCENT, AXIS_COLOURS, COMMANDED, FAINT, INK, draw_axis, style
from stepmite.trace import AxisTrace, Floats, merge, path_speed

DEPTHS = [0.01, 0.225, 0.3, 0.5, 1.25, 2.0, 2.5]
DEPTH_NAMES = ["0.2", "0.25", "0.35", "0.8", "1.6", "2.4"]
DEPTH_COLOURS = ["#8fd0c1", "#4fb0a5", "#0b7a75", "#f0b429", "#e0732b", "#b23a48"]
ZOOM = (50.42, 14.14, 51.14, 15.0)
"""The close look: left, low, right, high in mm."""


def draw(traces: list[AxisTrace], commanded: Floats, output: Path) -> None:
    """Draw the demo's picture; `traces` are X, Y, Z, `commanded` the corners in mm."""
    path = merge(traces)
    points = path.units()
    figure = plt.figure(figsize=(13, 11), layout="constrained", facecolor="white")
    rows = figure.subplot_mosaic(
        [["path", "path"], ["zoom", "speed"], ["zoom", "X"], ["zoom", "Y"], ["zoom", "Z"]],
        height_ratios=[4.6, 1.5, 0.8, 0.8, 0.8],
        width_ratios=[1.0, 1.7],
    )
    _draw_plate(rows["path"], figure, points, commanded)
    _draw_zoom(rows["zoom"], points, commanded)
    _draw_speed(rows["speed"], traces)
    begin, end = int(path.time_ns[0]), int(path.time_ns[-1])
    for trace in traces:
        draw_axis(rows[trace.name], trace, begin, end)
        rows[trace.name].axhline(0, color=FAINT, linewidth=0.6, zorder=0)
    for name in ("speed", "X", "Y"):
        rows[name].tick_params(labelbottom=False)
    rows["Z"].set_xlabel("time in s", color=INK)
    figure.suptitle(
        "StepMite: a name plate, rebuilt from the step edges of the emulated board",
        color=INK,
        fontsize=15,
        fontweight="bold",
    )
    figure.savefig(output, dpi=110)
    plt.close(figure)


def _cut_pieces(points: Floats) -> tuple[Floats, Floats]:
    """Return the pieces of the path below the surface and the depth of each, in mm."""
    depth = -np.minimum(points[:-1, 2], points[1:, 2])
    under = np.maximum(points[:-1, 2], points[1:, 2]) <= 0
    pieces = np.stack([points[:-1, :2], points[1:, :2]], axis=1)
    return pieces[under], depth[under]


def _draw_plate(axes: Axes, figure: Figure, points: Floats, commanded: Floats) -> None:
    travel = points.copy()
    travel[points[:, 2] <= 0] = np.nan
    axes.plot(travel[:, 0], travel[:, 1], color=FAINT, linewidth=0.7, linestyle=(0, (4, 3)))
    wanted, _ = _cut_pieces(commanded)
    axes.add_collection(
        LineCollection(list(wanted), colors=COMMANDED, linewidths=6.5, alpha=0.5, capstyle="round")
    )
    pieces, depth = _cut_pieces(points)
    shades = LineCollection(
        list(pieces),
        cmap=ListedColormap(DEPTH_COLOURS),
        norm=BoundaryNorm(DEPTHS, len(DEPTH_COLOURS)),
        linewidths=1.8,
        capstyle="round",
    )
    shades.set_array(depth)
    axes.add_collection(shades)
    axes.add_patch(
        Rectangle(ZOOM[:2], ZOOM[2] - ZOOM[0], ZOOM[3] - ZOOM[1], fill=False, ec=INK, lw=1.2)
    )
    axes.annotate(
        "close look below",
        xy=(ZOOM[2], ZOOM[1]),
        xytext=(57, 6.2),
        color=INK,
        fontsize=9,
        arrowprops={"arrowstyle": "-", "color": INK, "linewidth": 0.8},
    )
    axes.set_xlim(-4, 104)
    axes.set_ylim(-4, 34)
    axes.set_aspect("equal")
    style(axes, "X in mm", "Y in mm")
    bar = figure.colorbar(shades, ax=axes, shrink=0.85, pad=0.01, aspect=18)
    middles = [(low + high) / 2 for low, high in itertools.pairwise(DEPTHS)]
    bar.set_ticks(middles, labels=DEPTH_NAMES)
    bar.set_label("depth of cut in mm", color=INK)
    bar.outline.set_visible(False)
    axes.legend(
        handles=[
            Line2D([], [], color=COMMANDED, alpha=0.5, linewidth=6.5, label="commanded"),
            Line2D([], [], color=DEPTH_COLOURS[2], linewidth=1.8, label="from the step edges"),
            Line2D([], [], color=FAINT, linewidth=1, linestyle=(0, (4, 3)), label="travel"),
        ],
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=3,
        frameon=False,
        labelcolor=INK,
    )


def _draw_zoom(axes: Axes, points: Floats, commanded: Floats) -> None:
    wanted, _ = _cut_pieces(commanded)
    axes.add_collection(
        LineCollection(list(wanted), colors=COMMANDED, linewidths=14, alpha=0.4, capstyle="round")
    )
    axes.add_collection(LineCollection(list(wanted), colors="#c9751f", linewidths=1.4))
    left, low, right, high = ZOOM
    near = (points[:, 2] <= 0) & (np.abs(points[:, 0] - left) < 2)
    axes.plot(*points[near, :2].T, ".", color=DEPTH_COLOURS[2], markersize=4.5, markeredgewidth=0)
    corners = wanted.reshape(-1, 2)
    axes.plot(*corners.T, "o", color="#c9751f", markersize=6, fillstyle="none")
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)
    axes.set_aspect("equal")
    style(axes, "X in mm", "Y in mm")
    axes.set_title(
        "close look: dots are motor positions, 12.5 \u00b5m apart;\nrings are commanded corners",
        color=INK,
        fontsize=10,
        loc="left",
    )


def _draw_speed(axes: Axes, traces: list[AxisTrace]) -> None:
    times, speed = path_speed(traces)
    axes.fill_between(times, speed, color=ACCENT, alpha=0.18, linewidth=0)
    axes.plot(times, speed, color=AXIS_COLOURS["X"], linewidth=0.7)
    axes.set_xlim(0, times[-1])
    axes.set_ylim(0)
    style(axes, "", "along the path\nin mm/s")
    axes.set_title("speed", color=INK, fontsize=10, loc="left")
