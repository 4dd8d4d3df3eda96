"""What `TMC22xx SGTUNE` prints, as numbers and as a picture."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from stepmite.plot import ACCENT, COMMANDED, FAINT, INK, style

HEADER = "SGTUNE"
STALL_COLOUR = "#c8553d"


@dataclass(frozen=True)
class Row:
    """Some 50 ms of a jog."""

    ms: float
    """Since it began."""
    speed: float
    """Units of the axis per minute, at the end of the row."""
    mean: float
    """SG_RESULT over the row, 0 to 510; falls with load."""
    lowest: float
    current_scale: int
    """CS_ACTUAL, 0 to 31."""


@dataclass
class Tuning:
    """All of one SGTUNE."""

    unit: str = "mm"
    rows: list[Row] = field(default_factory=list)
    says: list[str] = field(default_factory=list)
    """The lines behind the rows."""

    @property
    def commands(self) -> list[str]:
        """The proposal, as lines to type."""
        return [line for line in self.says if line.startswith("TMC22xx ")]

    def _proposed(self, word: str) -> float | None:
        for line in self.commands:
            if found := re.fullmatch(rf"TMC22xx {word} \w+,(\d+)(?:,.*)?", line):
                return float(found[1])
        return None

    @property
    def threshold(self) -> float | None:
        """The SG_RESULT at which a stall would be told, 2 * SGTHRS; None: nothing was proposed."""
        sgthrs = self._proposed("SGTHRS")
        return None if sgthrs is None else 2 * sgthrs

    @property
    def least_speed(self) -> float | None:
        """The speed from which on it would be, in units per minute."""
        return self._proposed("STALL")


def row_of(line: str) -> Row | None:
    """Return the row that a line is; None: it is something else."""
    words = line.split()
    if len(words) != 5 or not all(re.fullmatch(r"\d+(\.\d+)?", word) for word in words):
        return None
    ms, speed, mean, lowest, scale = map(float, words)
    return Row(ms, speed, mean, lowest, int(scale))


def parse(lines: list[str]) -> Tuning:
    """Return what the lines of an answer say; what stands before the header is not part of it."""
    tuning = Tuning()
    inside = False
    for line in lines:
        if line.startswith(HEADER):
            inside = True
            found = re.search(r"(\w+)/min", line)
            tuning.unit = found[1] if found else "mm"
        elif inside and (row := row_of(line)):
            tuning.rows.append(row)
        elif inside and line.strip():
            tuning.says.append(line.strip())
    return tuning


def _threshold_line(axes: Axes, tuning: Tuning, *, labelled: bool) -> None:
    if tuning.threshold is None:
        return
    axes.axhline(tuning.threshold, color=STALL_COLOUR, linewidth=1.2, linestyle="--")
    if labelled:
        axes.annotate(
            f"a stall at {tuning.threshold:.0f}, SGTHRS {tuning.threshold / 2:.0f}",
            (1, tuning.threshold),
            xycoords=("axes fraction", "data"),
            xytext=(-4, 4),
            textcoords="offset points",
            ha="right",
            color=STALL_COLOUR,
            fontsize=8,
        )


def draw(tuning: Tuning, title: str, output: Path) -> None:
    """Draw SG_RESULT over time and against speed, with the proposed threshold."""
    seconds = np.array([row.ms / 1000 for row in tuning.rows])
    speed = np.array([row.speed for row in tuning.rows])
    mean = np.array([row.mean for row in tuning.rows])
    lowest = np.array([row.lowest for row in tuning.rows])
    figure = plt.figure(figsize=(10, 6), layout="constrained", facecolor="white")
    places = figure.subplot_mosaic([["load", "map"], ["speed", "map"]], width_ratios=[1.5, 1])
    top = 1.1 * max(mean.max(initial=10), tuning.threshold or 0)

    load = places["load"]
    load.fill_between(seconds, lowest, mean, color=ACCENT, alpha=0.2, linewidth=0)
    load.plot(seconds, mean, color=ACCENT, label="mean")
    load.plot(seconds, lowest, color=ACCENT, linewidth=0.8, label="lowest")
    load.legend(frameon=False, fontsize=8, loc="lower right")
    style(load, "", "SG_RESULT")
    places["speed"].plot(seconds, speed, color=INK)
    style(places["speed"], "time in s", f"speed in {tuning.unit}/min")
    places["speed"].set_ylim(bottom=0)

    against = places["map"]
    against.vlines(speed, lowest, mean, color=FAINT, linewidth=1)
    against.plot(speed, mean, "o", color=ACCENT, markersize=3.5)
    against.plot(speed, lowest, "_", color=ACCENT, markersize=5)
    style(against, f"speed in {tuning.unit}/min", "SG_RESULT")
    against.set_xlim(left=0)
    if tuning.least_speed is not None and tuning.threshold is not None:
        fast = [tuning.least_speed, against.get_xlim()[1]]
        against.fill_between(fast, tuning.threshold, color=COMMANDED, alpha=0.25, linewidth=0)
        against.set_xlim(right=fast[1])
        against.set_title("shaded: where a stall is told", color=INK, fontsize=8)
    for axes in (load, against):
        axes.set_ylim(0, top)
        _threshold_line(axes, tuning, labelled=axes is load)
    figure.suptitle(title, color=INK, fontsize=12, fontweight="bold")
    figure.savefig(output, dpi=110)
    plt.close(figure)
