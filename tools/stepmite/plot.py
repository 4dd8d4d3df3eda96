"""Pictures from step edges: the path from above, speed and acceleration over time."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from stepmite.derivatives import Course, along_axes, along_path
from stepmite.follow import follow
from stepmite.gcode import AXES, read_blocks, read_lines
from stepmite.path import build
from stepmite.plan import Machine
from stepmite.trace import (
    AxisPins,
    AxisTrace,
    Edges,
    Floats,
    TraceError,
    axis_trace,
    merge,
    path_speed,
)

INK, FAINT, COMMANDED, ACCENT = "#22303c", "#c9d1d9", "#f2b880", "#0b6e99"
AXIS_COLOURS = {"X": "#0b6e99", "Y": "#c8553d", "Z": "#588b3f", "A": "#8a5a9e"}


def style(axes: Axes, xlabel: str, ylabel: str) -> None:
    """Give one diagram the common look."""
    axes.set_xlabel(xlabel, color=INK)
    axes.set_ylabel(ylabel, color=INK)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=8)
    axes.grid(color=FAINT, linewidth=0.4, alpha=0.6)
    axes.set_axisbelow(True)


def commanded_path(lines: list[str]) -> Floats:
    """Return the corners of a program and points on its arcs, shape (points, 4), from zero."""
    corners = [np.zeros((1, 4))]
    here = (0.0,) * 4
    for block in read_blocks(lines):
        if block.kind == "move":
            count = 1 if block.arc is None else max(2, int(abs(block.arc.sweep) * 20))
            parts = [n / count for n in range(1, count + 1)]
            if block.arc is None:
                corners.append(np.array([block.target]))
            else:
                places = [block.arc.position(here, block.target, part) for part in parts]
                corners.append(np.array(places))
            here = block.target
    return np.concatenate(corners)


def draw_commanded(axes: Axes, corners: Floats, width: float = 5.0) -> None:
    """Draw the commanded path as a broad band under what the motors did."""
    axes.plot(
        corners[:, 0],
        corners[:, 1],
        color=COMMANDED,
        linewidth=width,
        solid_capstyle="round",
        solid_joinstyle="round",
        alpha=0.55,
        label="commanded",
    )


def draw_path(axes: Axes, points: Floats, depth: Floats | None, width: float = 1.0) -> None:
    """Draw the path of the motors from above; with `depth` (Z in mm) cuts are coloured by it."""
    if depth is None:
        axes.plot(points[:, 0], points[:, 1], color=ACCENT, linewidth=width, label="from edges")
        return
    above = np.maximum(depth[:-1], depth[1:]) > 0
    pieces = np.stack([points[:-1, :2], points[1:, :2]], axis=1)
    axes.add_collection(LineCollection(list(pieces[above]), colors=FAINT, linewidths=0.6))
    shades = LineCollection(
        list(pieces[~above]), cmap="viridis_r", linewidths=width, capstyle="round"
    )
    shades.set_array(-depth[1:][~above])
    axes.add_collection(shades)
    axes.autoscale_view()
    if axes.figure is not None and not above.all():
        bar = axes.figure.colorbar(shades, ax=axes, shrink=0.8, pad=0.01)
        bar.set_label("depth below zero in mm", color=INK, size=8)
        bar.ax.tick_params(colors=INK, labelsize=8)


def draw_speed(axes: Axes, traces: list[AxisTrace]) -> None:
    """Draw the speed along the path over time."""
    times, speed = path_speed(traces)
    axes.fill_between(times, speed, color=ACCENT, alpha=0.18, linewidth=0)
    axes.plot(times, speed, color=ACCENT, linewidth=0.7)
    axes.set_xlim(0, times[-1])
    axes.set_ylim(0)
    style(axes, "time in s", "speed along\nthe path in mm/s")


def draw_axis(axes: Axes, trace: AxisTrace, begin_ns: int, end_ns: int) -> None:
    """Draw the speed of one axis over time."""
    window = 10_000_000
    middles = np.arange(begin_ns, end_ns + window, window // 2)
    change = trace.position_at(middles + window // 2) - trace.position_at(middles - window // 2)
    speed = change / trace.pins.steps_per_unit / (window / 1e9)
    colour = AXIS_COLOURS.get(trace.name, ACCENT)
    axes.plot((middles - begin_ns) / 1e9, speed, color=colour, linewidth=0.7)
    axes.set_xlim(0, (end_ns - begin_ns) / 1e9)
    unit = "deg/s" if trace.name == "A" else "mm/s"
    style(axes, "", f"{trace.name} in {unit}")


def draw_acceleration(axes: Axes, traces: list[AxisTrace], window: int = 25_000_000) -> None:
    """Draw the acceleration of each axis over time, mean values over the window."""
    begin = min(trace.step_ns[0] for trace in traces)
    end = max(trace.step_ns[-1] for trace in traces)
    middles = np.arange(begin, end, window // 5)
    for trace in traces:
        before, here, after = (trace.position_at(middles + shift) for shift in (-window, 0, window))
        bend = (after - 2 * here + before) / trace.pins.steps_per_unit / (window / 1e9) ** 2
        colour = AXIS_COLOURS.get(trace.name, ACCENT)
        axes.plot((middles - begin) / 1e9, bend, color=colour, linewidth=0.7, label=trace.name)
    axes.set_xlim(0, (end - begin) / 1e9)
    axes.legend(fontsize=8, frameon=False, loc="upper right", ncols=len(traces))
    style(axes, "time in s", "acceleration\nin mm/s²")


def course_of(traces: list[AxisTrace], lines: list[str] | None) -> Course:
    """Return speed to jerk along the path: exact in corners if the recording follows `lines`."""
    if lines is not None:
        scale = [1.0] * 4
        for trace in traces:
            scale[AXES.index(trace.name)] = trace.pins.steps_per_unit
        path = build(read_blocks(lines), Machine(), (scale[0], scale[1], scale[2], scale[3]))
        try:
            return along_path(follow(path, traces))
        except TraceError:
            pass  # another machine or another program: only the axes are known
    return along_axes(traces)


def draw_course(axes: Axes, course: Course, name: str, values: Floats, colour: str) -> None:
    """Draw one value along the path over time."""
    axes.fill_between(course.time_s, values, color=colour, alpha=0.15, linewidth=0)
    axes.plot(course.time_s, values, color=colour, linewidth=0.7)
    axes.set_xlim(0, course.time_s[-1])
    usual = 1.5 * float(np.percentile(np.abs(values), 98))
    if 0 < 2 * usual < np.abs(values).max():
        axes.set_ylim(-usual, usual)  # a corner at speed would leave nothing else to see
    style(axes, "time in s", name)


def figure_of(
    traces: list[AxisTrace], corners: Floats | None, course: Course, title: str = ""
) -> Figure:
    """Draw everything `stepmite plot` shows."""
    path = merge(traces)
    points = path.units()
    rows = 5 + len(traces)
    heights = [4.0, 1.2] + [0.8] * len(traces) + [1.2] * 3
    figure, diagrams = plt.subplots(
        rows, 1, figsize=(11, 3 + 1.6 * rows), height_ratios=heights, layout="constrained"
    )
    figure.get_layout_engine().set(w_pad=0.12, h_pad=0.08)
    figure.suptitle(title, color=INK, size=11)
    if corners is not None and len(traces) >= 2:
        draw_commanded(diagrams[0], corners)
    depth = points[:, path.names.index("Z")] if "Z" in path.names else None
    if len(traces) >= 2:
        draw_path(diagrams[0], points, depth)
        diagrams[0].set_aspect("equal")
        style(diagrams[0], f"{path.names[0]} in mm", f"{path.names[1]} in mm")
    else:
        diagrams[0].plot(path.time_ns / 1e9, points[:, 0], color=ACCENT, linewidth=1)
        style(diagrams[0], "time in s", path.names[0])
    draw_speed(diagrams[1], traces)
    begin, end = int(path.time_ns[0]), int(path.time_ns[-1])
    for axes, trace in zip(diagrams[2:-3], traces, strict=True):
        draw_axis(axes, trace, begin, end)
    draw_acceleration(diagrams[-3], traces)
    draw_course(
        diagrams[-2],
        course,
        "acceleration along\nthe path in mm/s²",
        course.acceleration,
        AXIS_COLOURS["Z"],
    )
    jerk = course.jerk / 1000
    draw_course(diagrams[-1], course, "jerk along\nthe path in m/s³", jerk, AXIS_COLOURS["A"])
    return figure


def plot_file(edges: Path, axes: list[str], output: Path, gcode: Path | None) -> None:
    """Carry out `stepmite plot`; TraceError if there is nothing to draw."""
    recording = Edges.read(edges)
    pins = [AxisPins.parse(text) for text in axes]
    pins.sort(key=lambda pin: AXES.find(pin.name[0]))
    traces = [axis_trace(recording, pin) for pin in pins]
    still = [trace.name for trace in traces if len(trace.step_ns) == 0]
    traces = [trace for trace in traces if len(trace.step_ns)]
    if not traces:
        raise TraceError(f"{edges}: no steps on the pins of {', '.join(still)}")
    lines = read_lines(gcode) if gcode is not None else None
    corners = commanded_path(lines) if lines is not None else None
    figure = figure_of(
        traces,
        corners,
        course_of(traces, lines),
        edges.name if gcode is None else f"{edges.name}, {gcode.name}",
    )
    figure.savefig(output, dpi=130)
    plt.close(figure)
