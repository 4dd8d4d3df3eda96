"""Makes examples/nameplate.nc: a small name plate, in the style CAM programs emit.

Run `python -m stepmite.nameplate examples/nameplate.nc` to write it anew. Origin is the lower left
corner of the plate, Z0 its surface; millimetres.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

Point = tuple[float, float]
Stroke = list[Point]

WIDTH, HEIGHT, CORNER = 100.0, 30.0, 5.0
SAFE_Z, NEAR_Z = 3.0, 0.5
ENGRAVE_FEED, CONTOUR_FEED, PLUNGE_FEED = 1500, 1800, 900
CUTTER_RADIUS = 1.0
TEXT = "StepMite"
TEXT_ORIGIN, TEXT_HEIGHT = (32.0, 11.0), 10.4


def arc(
    centre: Point, rx: float, ry: float, begin_deg: float, end_deg: float, chords: int
) -> Stroke:
    """Return an elliptical arc as chords, both ends included."""
    points = []
    for index in range(chords + 1):
        angle = math.radians(begin_deg + (end_deg - begin_deg) * index / chords)
        points.append((centre[0] + rx * math.cos(angle), centre[1] + ry * math.sin(angle)))
    return points


# The stroke font: capitals are 1 high, small letters 0.62; each letter is (advance, strokes).
FONT: dict[str, tuple[float, list[Stroke]]] = {
    "S": (
        0.74,
        [arc((0.3, 0.74), 0.27, 0.26, 28, 270, 22) + arc((0.3, 0.24), 0.3, 0.24, 90, -152, 24)[1:]],
    ),
    "t": (
        0.54,
        [
            [(0.2, 0.92), (0.2, 0.2), *arc((0.37, 0.2), 0.17, 0.2, 180, 300, 12)[1:]],
            [(0.02, 0.62), (0.42, 0.62)],
        ],
    ),
    "e": (0.71, [[(0.05, 0.31), *arc((0.3, 0.31), 0.25, 0.31, 0, 312, 36)]]),
    "p": (
        0.76,
        [[(0.07, -0.3), (0.07, 0.62)], arc((0.32, 0.31), 0.25, 0.31, 180, -180, 40)],
    ),
    "M": (
        0.98,
        [[(0.04, 0.0), (0.04, 1.0), (0.41, 0.36), (0.78, 1.0), (0.78, 0.0)]],
    ),
    "i": (0.32, [[(0.08, 0.62), (0.08, 0.0)], arc((0.08, 0.86), 0.05, 0.05, 90, 450, 8)]),
}


def text_strokes() -> list[Stroke]:
    """Return the lettering in plate coordinates."""
    strokes = []
    left, base = TEXT_ORIGIN
    for letter in TEXT:
        advance, shape = FONT[letter]
        for stroke in shape:
            strokes.append([(left + x * TEXT_HEIGHT, base + y * TEXT_HEIGHT) for x, y in stroke])
        left += advance * TEXT_HEIGHT
    return strokes


def mite_strokes(centre: Point = (21.0, 14.6)) -> list[Stroke]:
    """Return the mascot: a mite whose body carries the shaft of a stepper motor."""
    x, y = centre
    strokes = [
        arc((x, y - 0.6), 4.0, 4.8, 90, 450, 44),
        arc((x, y + 4.0), 2.1, 2.6, -8, 188, 16),
        [*arc((x, y - 0.8), 1.9, 1.9, 30, 330, 20), (x + 1.645, y + 0.15)],
        arc((x - 0.8, y + 5.0), 0.3, 0.3, 0, 360, 6),
        arc((x + 0.8, y + 5.0), 0.3, 0.3, 0, 360, 6),
    ]
    for side in (-1, 1):
        for begin, bend, foot in (
            ((3.0, 3.0), (5.6, 6.2), (6.6, 9.4)),
            ((3.9, 0.6), (6.4, 3.4), (8.2, 3.6)),
            ((3.9, -1.8), (6.6, -2.0), (8.2, -4.4)),
            ((2.9, -4.0), (5.4, -5.6), (6.2, -9.2)),
        ):
            leg = bend_through(begin, bend, foot, 7)
            strokes.append([(x + side * dx, y + dy) for dx, dy in leg])
    return strokes


def bend_through(begin: Point, bend: Point, foot: Point, chords: int) -> Stroke:
    """Return a parabola that leaves `begin` towards `bend` and ends at `foot`."""
    points = []
    for index in range(chords + 1):
        u = index / chords
        a, b, c = (1 - u) ** 2, 2 * u * (1 - u), u**2
        points.append(
            (
                a * begin[0] + b * bend[0] + c * foot[0],
                a * begin[1] + b * bend[1] + c * foot[1],
            )
        )
    return points


def rounded_rectangle(inset: float, chords: int) -> Stroke:
    """Return the outline of the plate, moved inwards and closed; begins at the lower edge."""
    radius = CORNER - inset
    left, right, low, high = CORNER, WIDTH - CORNER, CORNER, HEIGHT - CORNER
    points: Stroke = [(WIDTH / 2, inset)]
    for corner, begin in (
        ((right, low), -90),
        ((right, high), 0),
        ((left, high), 90),
        ((left, low), 180),
    ):
        points += arc(corner, radius, radius, begin, begin + 90, chords)
    return [*points, points[0]]


class Post:
    """Writes the program: only words that change, as a post processor does."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self._motion = ""
        self._last: dict[str, str] = {}

    def comment(self, text: str) -> None:
        """Write a comment on a line of its own."""
        self.lines.append(f"({text})")

    def code(self, text: str) -> None:
        """Write a line as it is."""
        self.lines.append(text)

    def go(self, motion: str, feed: int | None = None, **target: float) -> None:
        """Write a move; nothing if it leads nowhere."""
        words = []
        for letter, value in target.items():
            text = f"{letter}{value + 0.0:.3f}".replace("-0.000", "0.000")
            if self._last.get(letter) != text:
                self._last[letter] = text
                words.append(text)
        if not words:
            return
        if motion != self._motion:
            words.insert(0, motion)
            self._motion = motion
        if feed is not None and self._last.get("F") != f"F{feed}":
            self._last["F"] = f"F{feed}"
            words.append(f"F{feed}")
        self.lines.append(" ".join(words))

    def cut(self, stroke: Stroke, depth: float, feed: int) -> None:
        """Go above the start of a stroke, plunge, follow it, retract."""
        self.go("G0", X=stroke[0][0], Y=stroke[0][1])
        self.go("G0", Z=NEAR_Z)
        self.go("G1", PLUNGE_FEED, Z=-depth)
        for x, y in stroke[1:]:
            self.go("G1", feed, X=x, Y=y)
        self.go("G0", Z=SAFE_Z)


def bore(post: Post, centre: Point, diameter: float, depths: list[float]) -> None:
    """Cut a hole as a helix of chords and one level round at the bottom."""
    radius = diameter / 2 - CUTTER_RADIUS
    chords = 16
    ring = arc(centre, radius, radius, 0, 360, chords)
    post.go("G0", X=ring[0][0], Y=ring[0][1])
    post.go("G0", Z=NEAR_Z)
    post.go("G1", PLUNGE_FEED, Z=0.0)
    above = 0.0
    for depth in [*depths, depths[-1]]:
        for index, (x, y) in enumerate(ring[1:], start=1):
            z = -(above + (depth - above) * index / chords)
            post.go("G1", CONTOUR_FEED, X=x, Y=y, Z=z)
        above = depth
    post.go("G0", Z=SAFE_Z)


def program() -> list[str]:
    """Return the lines of the whole program."""
    post = Post()
    for text in (
        "StepMite name plate",
        "made by stepmite.nameplate",
        f"stock {WIDTH:g} x {HEIGHT:g} x 2.2 mm, zero: lower left corner, top of stock",
        "T1 engraving bit 30 deg and 2 mm end mill, no tool change",
    ):
        post.comment(text)
    post.code("G90")
    post.go("G0", Z=SAFE_Z)
    post.code("M3")
    post.code("G4 P500")
    post.comment("operation 1: border, depth 0.2")
    post.cut(rounded_rectangle(2.2, 8), 0.2, CONTOUR_FEED)
    post.comment("operation 2: mascot, depth 0.25")
    for stroke in mite_strokes():
        post.cut(stroke, 0.25, ENGRAVE_FEED)
    post.comment("operation 3: lettering, depth 0.35")
    for stroke in text_strokes():
        post.cut(stroke, 0.35, ENGRAVE_FEED)
    post.comment("operation 4: holes 4.2 mm")
    for centre in ((7.5, HEIGHT / 2), (WIDTH - 7.5, HEIGHT / 2)):
        bore(post, centre, 4.2, [1.1, 2.4])
    post.comment("operation 5: outline, three passes")
    outline = rounded_rectangle(-CUTTER_RADIUS, 12)
    for depth in (0.8, 1.6, 2.4):
        post.comment(f"pass at {depth:g}")
        post.cut(outline, depth, 2400)
    post.code("M5")
    post.go("G0", X=0.0, Y=0.0)
    post.comment("end")
    return post.lines


if __name__ == "__main__":
    Path(sys.argv[1]).write_text("\n".join(program()) + "\n", encoding="ascii")
